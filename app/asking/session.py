"""The session: the document, the solver that follows it, and the files it comes from and goes to."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

from PySide6.QtCore import QObject, QTimer, Signal

from app.asking.edit import Edit
from app.asking.editing import Editing
from app.asking.solving import Solving
from core.design import Design, ScanSource
from core.document import Document
from core.errors import UserError
from core.live import Failure, Frame
from core.pipeline import StuckError
from core.project import is_project, open_project, save_project


class Session(Editing):
    """What the window shows and asks.

    Verbs (open, preview, commit, save ...) are called by the window; what follows is told by signals.
    ``working`` tells the work in hand and the share done; ``asked`` hands out the StuckError of a scan
    that was opened and cannot go on before somebody says how it stands or places its landmarks.
    """

    opened = Signal(object)
    frame_ready = Signal(object)
    asked = Signal(object)
    working = Signal(str, float)
    saved = Signal(str)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.frame: Frame | None = None
        self.path: Path | None = None
        self._opening: tuple[Document, Path | None, int] | None = None
        self._oldest = 0
        self._revision = 0
        self._solving = Solving(self)
        self._solving.answered.connect(self._answer)
        self._solving.refused.connect(self._fail)
        self._solving.working.connect(self.working)

    @property
    def name(self) -> str:
        """What the document is called: the project's or the scan's name."""
        if self.path is not None:
            return self.path.stem
        return Path(self.design.scan.name).stem if self.design else ""

    def open(self, path: str) -> None:
        """Open a project or a scan; the present design stays until the new one has a first frame."""
        try:
            self.open_document(
                open_project(path)
                if is_project(path)
                else Document.of(Design(ScanSource(str(Path(path).absolute()))))
            )
        except UserError as error:
            # At start nobody listens yet: the window hears it once the event loop runs.
            QTimer.singleShot(0, self, partial(self.failed.emit, error))

    def open_design(self, design: Design) -> None:
        """Open a design that has no file of its own yet, such as the sample."""
        self.open_document(Document.of(design))

    def open_document(self, document: Document) -> None:
        """Open a document; the present one stays until the new one has a first frame."""
        if self._opening is not None:
            self._solving.cancel()
        scan = document.design.scan
        self._preview, path = None, Path(scan.path) if scan.member else None
        self._opening = (document, path, self._solving.submit(document.design, fresh=True))

    def save(self, path: str, picture: bytes | None) -> bool:
        """Save the project with its scan; returns whether it worked."""
        if self.document is None or self.frame is None:
            return False
        try:
            save_project(path, self.document, self.frame.stages.scan, picture)
        except UserError as error:
            self.failed.emit(error)
            return False
        self.path = Path(path).absolute()
        self.undo_stack.setClean()
        self.saved.emit(str(self.path))
        return True

    def cancel(self) -> None:
        """Let go of what is being read or built; what stood before stays."""
        if self._opening is None and not self._solving.at_work:
            return
        self._solving.cancel()
        opening, self._opening = self._opening, None
        if self.document is None or self.frame is None:
            return
        stack, shown = self.undo_stack, self.frame.stages.design
        undone = stack.command(stack.index()) if opening is None and stack.canRedo() else None
        if isinstance(undone, Edit) and undone.after.design is shown:
            stack.redo()
        elif opening is not None or not self._take_back():
            self._submit(self.document.design)

    def set_pace(self, turns_per_second: float | None) -> None:
        """Make turns no faster than this, so that each can be seen, or as fast as they go."""
        self._solving.set_pace(turns_per_second)

    def close(self) -> None:
        """Stop the solver, and wait until it has ended."""
        self._solving.close()

    def _try(self, design: Design, fresh: bool) -> bool:
        if self._opening is None:
            self._solving.submit(design, fresh)
        return self._opening is None

    def _submit(self, design: Design, fresh: bool = False) -> None:
        # While another document is being opened its frame must be the next: edits of the old one wait.
        if self._opening is None:
            self._revision = self._solving.submit(design, fresh)

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

    def _answer(self, frame: Frame) -> None:
        if frame.revision < self._oldest:
            return
        if self._opening is not None:
            if frame.revision < self._opening[2]:
                return
            self._adopt(frame)
        self.frame = frame
        self.frame_ready.emit(frame)

    def _adopt(self, frame: Frame) -> None:
        if self._opening is None:
            return
        self.document, self.path, self._oldest = self._opening
        self._opening = None
        self.frame = frame
        self.undo_stack.clear()
        self.opened.emit(frame)
        self.design_changed.emit(self.document.design)

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
