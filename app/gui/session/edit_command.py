"""One edit of the document, as the undo stack keeps it."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from PySide6.QtGui import QUndoCommand

from core.document.document import Document

if TYPE_CHECKING:
    from app.gui.session.document_editor import DocumentEditor

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
        """End this edit at its last solved step; returns what follows as an edit of its own, if both exist.

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
        """Take it back."""
        self._session.take(self.before)
