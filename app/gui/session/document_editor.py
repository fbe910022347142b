"""Editing: the document and its undo stack. Nothing else changes them; every edit has a name."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import reduce
from typing import Any

from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QUndoCommand, QUndoStack

from app.i18n.catalog import number, tr
from app.presenters.model_options import control_text
from core.document.design import Design
from core.document.document import Document
from core.document.lines import CustomLine
from core.errors import UserError

PAUSE = 1.0
"""Seconds between two edits of one thing after which they are two in the history; a wheel turns faster."""


class EditCommand(QUndoCommand):
    """One edit: the document before and after. The first redo after a drag keeps the run that the preview
    began.

    Edits of the same ``what``, such as one line's length, that follow one another quickly become one.
    """

    def __init__(
        self,
        session: DocumentEditor,
        before: Document,
        after: Document,
        text: str,
        shown: bool,
        what: str = "",
    ) -> None:
        super().__init__(text)
        self._session = session
        self.before = before
        self.after = after
        self.is_solved = False
        self._solved: list[tuple[Document, str]] = []
        self._shown = shown
        self._in_place = False
        self._what = what
        self._made = time.monotonic()

    def id(self) -> int:
        """Return a number that edits have in common that may become one."""
        return hash(self._what) & 0x3FFFFFFF if self._what else -1

    def mergeWith(self, other: QUndoCommand) -> bool:  # noqa: N802 - Qt's name
        """Take in the edit that follows, if it goes on with this one."""
        if (
            not isinstance(other, EditCommand)
            or other._what != self._what
            or other._made - self._made > PAUSE
        ):
            return False
        if self.is_solved:
            self._solved.append((self.after, self.text()))
        self.after, self._made, self.is_solved = other.after, other._made, False
        self.setText(other.text())
        # There and back again is no edit.
        self.setObsolete(self.after == self.before)
        return True

    def split(self) -> EditCommand | None:
        """End this edit at its last solved step; returns the rest as an edit of its own, if both exist.

        The edit that is returned is in place: its first redo changes nothing.
        """
        if not self._solved:
            return None
        after, text = self._solved.pop()
        rest = EditCommand(self._session, after, self.after, self.text(), shown=False)
        rest._in_place = True
        self.after, self.is_solved = after, True
        self.setText(text)
        return rest

    def redo(self) -> None:
        """Make the edit."""
        if self._in_place:
            self._in_place = False
        elif self._shown:
            self._shown = False
            self._session.settle_preview(self.after)
        else:
            self._session.take_step(self.after)

    def undo(self) -> None:
        """Undo the edit."""
        self._session.take(self.before)


class DocumentEditor(QObject):
    """The part of a session that edits.

    ``document`` is what is committed, ``design`` its shown variant; while something is dragged the solver
    works on a preview that no one else sees. ``failed`` carries why an edit was refused.
    """

    design_changed = Signal(object)
    failed = Signal(object)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.undo_stack = QUndoStack(self)
        self.document: Document | None = None
        self._preview: Design | None = None
        self._told = False
        self._revision = self._step = 0

    @property
    def design(self) -> Design | None:
        """Return the variant that is shown, if a document is open."""
        return self.document.design if self.document is not None else None

    def preview_line(self, name: str, ratio: float) -> None:
        """Show a length while it is dragged; nothing is committed."""
        # As when it is let go: at its rest length a line is off.
        worn = None if is_original_length(ratio) else ratio
        if self.design is not None:
            # A locked line stays as it is; letting it go says why.
            with suppress(UserError):
                self.preview(self.design.with_linked(name, worn))

    def preview(self, design: Design) -> None:
        """Show what would be while something is dragged; nothing is committed."""
        fresh = self._preview is None
        if self.design is not None and self._try(design, fresh):
            self._told = self._told and not fresh
            self._preview = design

    def cancel_preview(self) -> None:
        """Restore the committed lengths."""
        if self.design is not None and self._preview is not None:
            self._preview = None
            self._submit(self.design)

    def go_on(self) -> None:
        """Make more turns of the design that is shown, which came nearer to rest but not there."""
        if self.design is not None and self._preview is None:
            self._submit(self.design)

    def commit_line(self, name: str, title: str, ratio: float) -> None:
        """Set a line's length as one undo step; at its rest length it is off: it does not pull."""
        if self.design is None:
            return
        worn = None if is_original_length(ratio) else ratio
        text = tr("{line} deactivated") if worn is None else tr("{line} {percent} %")
        sentence = text.format(line=title, percent=number(100.0 * ratio, 1))
        self.edit(lambda design: design.with_linked(name, worn), sentence, what=f"length of {name}")

    def reset_lines(self) -> None:
        """Take every line off: the body as scanned."""
        self.edit(Design.with_lines_reset, tr("Reset all lines"))

    def choose_control(self, control: str) -> None:
        """Choose the volume control."""
        self.change({"volume": control}, control_text(control))

    def choose_template(self, template: str) -> None:
        """Choose the control mesh by its number of polygons."""
        self.edit(
            lambda design: design.with_template(template), tr("Control mesh {count}").format(count=template)
        )

    def change(self, changes: Mapping[str, Any], text: str) -> None:
        """Change settings of the design as one undo step."""
        turned = all(isinstance(value, float) for value in changes.values())
        what = f"values of {sorted(changes)}" if turned else ""
        self.edit(lambda design: design.with_settings(changes), text, what)

    def add_own_lines(self, lines: Sequence[CustomLine], text: str) -> None:
        """Add lines of the designer's own."""
        self.edit(lambda design: reduce(Design.with_custom_line, lines, design), text)

    def reset_landmarks(self, names: Sequence[str], text: str) -> None:
        """Let landmarks that were placed by hand be found again, as one undo step."""
        self.edit(lambda design: reduce(lambda d, name: d.with_placed(name, None), names, design), text)

    def take(self, document: Document) -> None:
        """Make ``document`` the present one, as the undo stack asks."""
        self._replace(document)
        self.design_changed.emit(document.design)

    def take_step(self, document: Document) -> None:
        """Make ``document`` the present one by a step forward, which a refusal may take back."""
        self._replace(document)
        self._step = self._revision
        self.design_changed.emit(document.design)

    def settle_preview(self, document: Document) -> None:
        """Commit what the preview already shows: its run goes on without a break."""
        self.document = document
        self._submit(document.design)
        self._step = self._revision
        self.design_changed.emit(document.design)

    def edit(self, edit: Callable[[Design], Design], text: str, what: str = "") -> None:
        """Make an edit that the design may refuse: then all that is shown goes back to what is.

        Quick edits of the same ``what`` are one step.
        """
        if self.design is None:
            return
        try:
            after = edit(self.design)
        except UserError as error:
            self.failed.emit(error)
            self.design_changed.emit(self.design)
        else:
            self._commit(after, text, what)

    def show_variant(self, name: str) -> None:
        """Show another variant of the design; one that is not there yet begins as the shown one is."""
        if self.document is not None and name != self.document.shown:
            self._push(self.document.with_shown(name), tr("Variant {name}").format(name=name))

    def go_back(self, document: Document, text: str) -> None:
        """Restore a document derived from this one, as one undo step."""
        self._push(document, text)

    def remove_variant(self, name: str) -> None:
        """Remove a variant of the design; the last one stays."""
        if self.document is not None:
            self._push(self.document.without(name), tr("Variant {name} removed").format(name=name))

    def _replace(self, document: Document) -> None:
        self._preview, before = None, self.design
        self.document = document
        alike = before is not None and before.is_equivalent(document.design)
        self._submit(document.design, fresh=not alike)

    def _last_edit(self) -> EditCommand | None:
        """Return the edit that made the present document, if one did."""
        edit = self.undo_stack.command(self.undo_stack.index() - 1) if self.undo_stack.canUndo() else None
        return edit if isinstance(edit, EditCommand) and edit.after == self.document else None

    def _take_back(self) -> bool:
        """Undo the step that was submitted last, and only that; redo makes it again.

        Of quick edits that became one, those that were solved stay. Returns whether there was such a step:
        an undo, or what follows from taking back, is none.
        """
        edit = self._last_edit()
        if edit is None or self._step != self._revision:
            return False
        # What is pushed takes the place of all that can be redone: then the whole step goes back.
        rest = edit.split() if not self.undo_stack.canRedo() else None
        if rest is not None:
            saved = self.undo_stack.isClean()
            self.undo_stack.push(rest)
            if saved:
                self.undo_stack.resetClean()  # the file holds more than the entry that stays
        self.undo_stack.undo()
        return True

    def _commit(self, after: Design, text: str, what: str = "") -> None:
        if self.document is None:
            return
        if after != self.document.design:
            self._push(self.document.with_design(after), text, what)
        elif self._preview is not None:
            self._preview = None
            self._submit(self.document.design)

    def _push(self, after: Document, text: str, what: str = "") -> None:
        previewing, self._preview = self._preview is not None, None
        self._told = self._told and previewing  # what was refused in a drag that is over is no news of this
        if self.document is not None and after != self.document:
            # A drag is an entry of its own, however soon it follows another.
            what = "" if previewing else what
            self.undo_stack.push(EditCommand(self, self.document, after, text, previewing, what))

    def _submit(self, design: Design, fresh: bool = False) -> None:
        """Have a committed design solved; ``_revision`` is that of the request."""
        raise NotImplementedError

    def _try(self, design: Design, fresh: bool) -> bool:
        """Have a preview solved; returns whether this is the moment for it."""
        raise NotImplementedError


def is_original_length(ratio: float) -> bool:
    """Return whether a ratio is shown as 100 %: a line there is inactive."""
    return abs(ratio - 1.0) < 5e-6
