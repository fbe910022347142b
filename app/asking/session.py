"""The session: the one place that changes the design. It owns the undo stack and the solver, and answers by
signals.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial, reduce
from pathlib import Path
from typing import Any

from PySide6.QtCore import QObject, QTimer, Signal
from PySide6.QtGui import QUndoStack

from app.asking.edit import Edit
from app.wording.model_choices import control_words
from app.wording.words import number, tr
from core.design import Design, OwnLine, ScanSource
from core.errors import UserError
from core.export import write_frame
from core.live import Failure, Frame, LiveSolver
from core.mesh import Points
from core.pipeline import StuckError
from core.placing import in_file
from core.project import is_project, open_project, save_project

FRAME_INTERVAL = 16
"""Milliseconds between two looks at the solver."""


class Session(QObject):
    """What the window shows and asks.

    Verbs (open, preview, commit, save ...) are called by the window; what follows is told by signals.
    ``design`` is what is committed; while a slider is dragged the solver works on a preview that no one else
    sees. ``working`` tells the work in hand and the share done; ``asked`` hands out the StuckError of a scan
    that was opened and cannot go on before somebody says how it stands or places its landmarks.
    """

    design_changed = Signal(object)
    opened = Signal(object)
    frame_ready = Signal(object)
    failed = Signal(object)
    asked = Signal(object)
    working = Signal(str, float)
    saved = Signal(str)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.undo_stack = QUndoStack(self)
        self.design: Design | None = None
        self.frame: Frame | None = None
        self.path: Path | None = None
        self._work = self._work_told = ("", 1.0)
        self._preview: Design | None = None
        self._told = False
        self._opening: tuple[Design, Path | None, int] | None = None
        self._oldest = 0
        self._revision = 0
        self._solver = LiveSolver(self._hear)
        self._clock = QTimer(self, interval=FRAME_INTERVAL)
        self._clock.timeout.connect(self._look)
        self._clock.start()

    @property
    def name(self) -> str:
        """What the document is called: the project's or the scan's name."""
        if self.path is not None:
            return self.path.stem
        return Path(self.design.scan.name).stem if self.design else ""

    def open(self, path: str) -> None:
        """Open a project or a scan; the present design stays until the new one has a first frame."""
        try:
            self.open_design(
                open_project(path) if is_project(path) else Design(ScanSource(str(Path(path).absolute())))
            )
        except UserError as error:
            # At start nobody listens yet: the window hears it once the event loop runs.
            QTimer.singleShot(0, self, partial(self.failed.emit, error))

    def open_design(self, design: Design) -> None:
        """Open a design: of a project, or one that has no file of its own yet, such as the sample."""
        if self._opening is not None:
            self._solver.cancel()
        self._preview, path = None, Path(design.scan.path) if design.scan.member else None
        self._opening = (design, path, self._solver.submit(design, fresh=True))

    def preview_line(self, name: str, ratio: float) -> None:
        """Show a length while it is dragged; nothing is committed."""
        if self.design is not None and self._opening is None:
            fresh = self._preview is None
            self._told = self._told and not fresh
            # As when it is let go: at its rest length a line is off.
            self._preview = self.design.with_line(name, None if at_rest_length(ratio) else ratio)
            self._solver.submit(self._preview, fresh)

    def cancel_preview(self) -> None:
        """Go back to the committed lengths."""
        if self.design is not None and self._preview is not None:
            self._preview = None
            self._submit(self.design)

    def commit_line(self, name: str, title: str, ratio: float) -> None:
        """Set a line's length as one undo step; at its rest length it is off: it does not pull."""
        if self.design is None:
            return
        worn = None if at_rest_length(ratio) else ratio
        text = tr("{line} off") if worn is None else tr("{line} {percent} %")
        self._commit(
            self.design.with_line(name, worn), text.format(line=title, percent=number(100.0 * ratio, 1))
        )

    def reset_lines(self) -> None:
        """Take every line off: the body as scanned."""
        self.change({"lines": ()}, tr("Reset to scan"))

    def choose_control(self, control: str) -> None:
        """Choose the volume control."""
        self.change({"volume": control}, control_words(control))

    def choose_template(self, template: str) -> None:
        """Choose the control mesh by its number of polygons."""
        self._edit(
            lambda design: design.with_template(template), tr("Control mesh {count}").format(count=template)
        )

    def change(self, changes: Mapping[str, Any], text: str) -> None:
        """Change fields of the design as one undo step."""
        self._edit(lambda design: replace(design, **changes), text)

    def add_own_lines(self, lines: Sequence[OwnLine], text: str) -> None:
        """Add lines of the designer's own."""
        self._edit(lambda design: reduce(Design.with_own_line, lines, design), text)

    def remove_own_line(self, name: str, title: str) -> None:
        """Remove a line of the designer's own."""
        self._edit(lambda design: design.without_own_line(name), tr("{line} removed").format(line=title))

    def place_landmark(self, name: str, title: str, position: Points) -> None:
        """Place a landmark, shape (3,) [mm] on the body at rest; all that follows from it is made anew."""
        if self.frame is not None:
            place = in_file(position, self.frame.stages.body.pose.file_to_mm)
            self._edit(lambda design: design.with_placed(name, place), tr("{name} placed").format(name=title))

    def reset_landmarks(self, names: Sequence[str], text: str) -> None:
        """Let landmarks that were placed by hand be found again, as one undo step."""
        self._edit(lambda design: reduce(lambda d, name: d.with_placed(name, None), names, design), text)

    def save(self, path: str, picture: bytes | None) -> bool:
        """Save the project with its scan; returns whether it worked."""
        if self.design is None or self.frame is None:
            return False
        try:
            save_project(path, self.design, self.frame.stages.scan, picture)
        except UserError as error:
            self.failed.emit(error)
            return False
        self.path = Path(path).absolute()
        self.undo_stack.setClean()
        self.saved.emit(str(self.path))
        return True

    def export_body(self, path: str) -> bool:
        """Write the body as it is shown; returns whether it worked."""
        if self.frame is None:
            return False
        try:
            write_frame(path, self.frame)
        except UserError as error:
            self.failed.emit(error)
            return False
        return True

    def cancel(self) -> None:
        """Let go of what is being read or built; what stood before stays."""
        if self._opening is None and not self._work[0]:
            return
        self._solver.cancel()
        self._work = ("", 1.0)
        opening, self._opening = self._opening, None
        if self.design is None or self.frame is None:
            return
        stack, shown = self.undo_stack, self.frame.stages.design
        undone = stack.command(stack.index()) if opening is None and stack.canRedo() else None
        if isinstance(undone, Edit) and undone.after is shown:
            stack.redo()
        elif opening is not None or not self._take_back():
            self._submit(self.design)

    def close(self) -> None:
        """Stop the clock and the solver, and wait until it has ended."""
        self._clock.stop()
        self._solver.stop()

    def take(self, design: Design) -> None:
        """Make ``design`` the present one, as the undo stack asks."""
        self._preview = None
        self.design = design
        self._submit(design, fresh=True)
        self.design_changed.emit(design)

    def settle_preview(self, design: Design) -> None:
        """Commit what the preview already shows: its run goes on without a break."""
        self.design = design
        self._submit(design)
        self.design_changed.emit(design)

    def _submit(self, design: Design, fresh: bool = False) -> None:
        # While another document is being opened its frame must be the next: edits of the old one wait.
        if self._opening is None:
            self._revision = self._solver.submit(design, fresh)

    def _edit(self, edit: Callable[[Design], Design], text: str) -> None:
        """Make an edit that the design may refuse: then all that is shown goes back to what is."""
        if self.design is None:
            return
        try:
            after = edit(self.design)
        except UserError as error:
            self.failed.emit(error)
            self.design_changed.emit(self.design)
        else:
            self._commit(after, text)

    def _commit(self, after: Design, text: str) -> None:
        previewing, self._preview = self._preview is not None, None
        if after != self.design and self.design is not None:
            self.undo_stack.push(Edit(self, self.design, after, text, shown=previewing))
        elif previewing and self.design is not None:
            self._submit(self.design)

    def _hear(self, what: str, share: float) -> None:
        # Called in the solver's thread: only the attribute is set, the clock tells the window.
        self._work = what, share

    def _look(self) -> None:
        if self._work != self._work_told:
            self._work_told = self._work
            self.working.emit(*self._work_told)
        answer = self._solver.latest()
        if isinstance(answer, Failure):
            self._fail(answer)
        elif answer is not None and answer.revision >= self._oldest:
            if self._opening is not None:
                if answer.revision < self._opening[2]:
                    return
                self._adopt(answer)
            self.frame = answer
            with self._solver.held():
                self.frame_ready.emit(answer)

    def _adopt(self, frame: Frame) -> None:
        if self._opening is None:
            return
        self.design, self.path, self._oldest = self._opening
        self._opening = None
        self.frame = frame
        self.undo_stack.clear()
        self.opened.emit(frame)
        self.design_changed.emit(self.design)

    def _fail(self, failure: Failure) -> None:
        if self._opening is not None and failure.revision >= self._opening[2]:
            self._opening = None
            if self.design is not None:
                self._submit(self.design)
            stuck = failure.error
            if isinstance(stuck, StuckError) and (self.design is None or stuck.kind == "unsure"):
                self.asked.emit(stuck)
                return
        elif failure.revision > self._revision and self._preview is not None:
            # One notice for a drag is enough, however far it goes on.
            told, self._told = self._told, True
            if told:
                return
        elif failure.revision == self._revision and self._take_back():
            told, self._told = self._told, False
            if told:
                return
        self.failed.emit(failure.error)

    def _take_back(self) -> bool:
        """Let an edit that cannot be carried out leave the history as if it had not been made."""
        edit = self.undo_stack.command(self.undo_stack.index() - 1) if self.undo_stack.canUndo() else None
        if not isinstance(edit, Edit) or edit.after is not self.design:
            return False
        before = edit.before
        edit.setObsolete(True)
        # Qt drops an obsolete command without undoing it.
        self.undo_stack.undo()
        self.take(before)
        return True


def at_rest_length(ratio: float) -> bool:
    """Tell whether a ratio is 100 % as it is shown: a line there is off."""
    return abs(ratio - 1.0) < 5e-6
