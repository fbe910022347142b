"""The session: the document, the solver that follows it, and the files it comes from and goes to."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from PySide6.QtCore import QObject, QTimer, Signal

from app.gui.session.background_save import BackgroundSave
from app.gui.session.document_editor import DocumentEditor, EditCommand
from app.gui.session.solver_bridge import SolverBridge
from core.document.design import Design, ScanSource, new_design
from core.document.document import Document
from core.document.storage.backups import backup_before_write
from core.document.storage.project_file import (
    ScanFile,
    Stamp,
    file_stamp,
    is_project,
    open_project,
    save_project,
)
from core.document.storage.recovery import RecoveredDocument
from core.errors import TissueError, UserError
from core.messages import Message, join
from core.pipeline.build import IncompleteBuildError
from core.pipeline.live_solver import Failure, Frame


@dataclass(frozen=True)
class _Opening:
    """A document on its way in."""

    document: Document
    path: Path | None
    stamp: Stamp | None
    unsaved: bool
    revision: int
    remark: UserError | None = None

    @property
    def is_new(self) -> bool:
        """Return whether it is a scan on which nothing was decided yet."""
        return self.path is None and not self.unsaved and self.document.design.is_bare


class Session(DocumentEditor):
    """What the window shows and asks.

    Verbs (open, preview, commit, save ...) are called by the window; what follows is told by signals.
    ``working`` tells the work in hand and the share done; ``requested`` hands out the IncompleteBuildError
    of a scan
    that was opened and cannot go on before somebody says how it stands or places its landmarks; ``saving``
    says that a project is being written, or no longer, and ``not_saved`` why this has failed. ``failure`` is
    why the frame is not that of the present document, and stays so until something else is requested.
    ``trial`` is a design that is previewed as a proposal, until it is applied or rejected; ``stuck`` what
    keeps a scan that is shown from being a document, never while a document is open; ``remark`` says what of
    the document is not as usual since it was opened.
    """

    opened = Signal(object)
    frame_ready = Signal(object)
    requested = Signal(object)
    working = Signal(str, float)
    saving = Signal(bool)
    saved = Signal(str)
    not_saved = Signal(object)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.frame: Frame | None = None
        self.failure: Failure | None = None
        self.path: Path | None = None
        self.stamp: Stamp | None = None
        self.trial: Design | None = None
        self.stuck: IncompleteBuildError | None = None
        self.remark: UserError | None = None
        self._opening: _Opening | None = None
        self._saving = BackgroundSave(self)
        self._oldest = 0
        self._solving = SolverBridge(self)
        self._solving.answered.connect(self._answer)
        self._solving.refused.connect(self._fail)
        self._solving.working.connect(self.working)

    @property
    def name(self) -> str:
        """Return the name of the project or of the scan."""
        if self.path is not None:
            return self.path.stem
        return Path(self.design.scan.name).stem if self.design else ""

    @property
    def opening(self) -> str:
        """Return the file of the document that is on its way in, or an empty text."""
        opening = self._opening
        return "" if opening is None else str(opening.path or opening.document.design.scan.path)

    def open(self, path: str) -> None:
        """Open a project or a scan; the present design stays until the new one has a first frame."""
        try:
            self.open_document(
                open_project(path)
                if is_project(path)
                else Document.single(new_design(ScanSource(str(Path(path).absolute()))))
            )
        except UserError as error:
            # At start nobody listens yet: the window hears it once the event loop runs.
            QTimer.singleShot(0, self, partial(self.failed.emit, error))

    def open_design(self, design: Design) -> None:
        """Open a design that has no file of its own yet, such as the sample."""
        self.open_document(Document.single(design))

    def open_document(self, document: Document, path: Path | None = None, unsaved: bool = False) -> None:
        """Open a document; the present one stays until the new one has a first frame.

        Unless told otherwise its project is the file that its scan lies in. One that is ``unsaved`` counts as
        changed from the first.
        """
        scan = document.design.scan
        path = path or (Path(scan.path) if scan.member and not unsaved else None)
        self._open(document, path, file_stamp(path), unsaved)

    def restore(self, kept: RecoveredDocument) -> None:
        """Open what was kept of a window that did not close in order, unsaved; its project counts as changed
        if it was saved since.
        """
        self._open(kept.document, kept.project, kept.stamp, unsaved=True)

    @property
    def is_answered(self) -> bool:
        """Return whether the frame answers what was asked last; after an undo it may be an older one."""
        return self.frame is not None and self.frame.revision >= self._revision

    @property
    def is_converged(self) -> bool:
        """Return whether the present design is solved to the end and shown."""
        frame = self.frame
        return (
            frame is not None
            and frame.stages.design is self.design
            and self.is_answered
            and not frame.is_running
        )

    @property
    def is_at_rest(self) -> bool:
        """Return whether what is shown is solved to the end: the present design, or the proposal."""
        frame, trial = self.frame, self.trial
        on_trial = frame is not None and trial is not None and frame.stages.design is trial
        return self.is_converged or (on_trial and frame is not None and not frame.is_running)

    @property
    def unsaved(self) -> bool:
        """Return whether there is something to lose."""
        return not self.undo_stack.isClean() or self._saving.at_work

    @property
    def changed_elsewhere(self) -> bool:
        """Return whether the project's file is no longer what was opened or saved here last."""
        return self.path is not None and file_stamp(self.path) not in (None, self.stamp)

    def save(self, path: str, picture: bytes | None) -> bool:
        """Start saving the project; returns whether it started. ``saved`` or ``not_saved`` follows."""
        if self.document is None or self.frame is None:
            return False
        target, document, scan = Path(path).absolute(), self.document, self.frame.stages.scan
        # Only then it is known whether the save before this one has left anything unsaved.
        self._saving.wait()
        stack = self.undo_stack
        told = partial(self._saved, target, stack.isClean())
        self._saving.run(partial(_write, target, document, scan, picture), told)
        # Edits that follow are not in the file.
        stack.setClean()
        self.saving.emit(True)
        return True

    def finish_saving(self) -> bool:
        """Wait until the project is written; returns whether nothing is left to save."""
        self._saving.wait()
        return not self.unsaved

    def detach(self) -> None:
        """Continue with a copy without a file; the project is unchanged."""
        self._saving.wait()
        self.path = self.stamp = None
        self.undo_stack.resetClean()

    def _saved(self, path: Path, clean: bool, fault: Exception | None) -> None:
        if fault is not None:
            # What was all in another file before is there still.
            if not clean:
                self.undo_stack.resetClean()
            self.saving.emit(False)
            self.not_saved.emit(fault)
            return
        self.path, self.stamp = path, file_stamp(path)
        self.saved.emit(str(path))

    def cancel(self) -> None:
        """Release what is being read or built; what stood before stays."""
        if self._opening is None and not self._solving.at_work:
            return
        self._solving.cancel()
        opening, self._opening = self._opening, None
        if self.document is None or self.frame is None:
            return
        stack, shown = self.undo_stack, self.frame.stages.design
        undone = stack.command(stack.index()) if opening is None and stack.canRedo() else None
        if isinstance(undone, EditCommand) and undone.after.design is shown:
            stack.redo()
        elif opening is not None or not self._take_back():
            self._submit(self.document.design)

    def set_pace(self, turns_per_second: float | None) -> None:
        """Make turns no faster than this, so that each can be seen, or as fast as they go."""
        self._solving.set_pace(turns_per_second)

    def close(self) -> None:
        """Stop the solver, and wait until it has ended, and the last file is written."""
        self._solving.close()
        self._saving.wait()
        # A stack with edits tells its own end too, when nobody is there any more to hear it.
        self.undo_stack.blockSignals(True)

    def _open(self, document: Document, path: Path | None, stamp: Stamp | None, unsaved: bool) -> None:
        if self._opening is not None:
            self._solving.cancel()
        self._preview = None
        revision = self._solving.submit(document.design, fresh=True)
        self._opening = _Opening(document, path, stamp, unsaved, revision)

    def _open_on_net(self, design: Design, problem: UserError) -> None:
        """Open a scan that solid tissue cannot be computed on; ``remark`` says so."""
        self.open_design(replace(design, tissue="net"))
        assert self._opening is not None
        said = join((problem.message, Message("The net is used as tissue.")))
        remark = UserError(said, Message("To use solid tissue, fill the holes at the Scan step."))
        self._opening = replace(self._opening, remark=remark)

    def _try(self, design: Design, fresh: bool) -> bool:
        if self._opening is None:
            self._solving.submit(design, fresh)
        return self._opening is None

    def _submit(self, design: Design, fresh: bool = False) -> None:
        opening, self._opening = self._opening, None
        if opening is not None:
            # The other document would take this edit away with it, and nobody was asked about that.
            self._solving.cancel()
        self._revision = self._solving.submit(design, fresh)
        if opening is not None:
            name = opening.path.name if opening.path else opening.document.design.scan.name
            text = Message("{name} was not opened because the current design was edited.", name=name)
            self.failed.emit(UserError(text, Message("Open the file again when the edit is finished.")))

    def _answer(self, frame: Frame) -> None:
        if frame.revision < self._oldest:
            return
        if self._opening is not None:
            if frame.revision < self._opening.revision:
                return
            self._adopt(frame)
        self.frame = frame
        if self.failure is not None and frame.revision >= self.failure.revision:
            self.failure = None
        edit = self._last_edit()
        if edit is not None and frame.revision == self._revision:
            edit.is_solved = True
        self.frame_ready.emit(frame)

    def _adopt(self, frame: Frame) -> None:
        if self._opening is None:
            return
        # What is being written still is the document that goes: its file is not the new one's.
        self._saving.wait()
        opening, self._opening = self._opening, None
        self.document, self.path, self.stamp = opening.document, opening.path, opening.stamp
        self._revision = self._oldest = opening.revision
        self.frame, self.remark = frame, opening.remark
        self.undo_stack.clear()
        if opening.unsaved:
            self.undo_stack.resetClean()
        self.opened.emit(frame)
        self.design_changed.emit(self.document.design)

    def _fail(self, failure: Failure) -> None:
        if self._opening is not None and failure.revision >= self._opening.revision:
            opening, self._opening = self._opening, None
            if isinstance(failure.error, TissueError) and opening.is_new:
                self._open_on_net(opening.document.design, failure.error)
                return
            if self.design is not None:
                self._submit(self.design)
            stuck = failure.error
            if isinstance(stuck, IncompleteBuildError) and (self.design is None or stuck.kind == "unsure"):
                self.requested.emit(stuck)
                return
        elif failure.revision < self._revision:
            return  # of what was tried before the last decision, which has an answer of its own
        elif not failure.is_rejection:
            self.failure = failure  # nothing that was decided is to blame: all of it stays
        elif failure.revision > self._revision and self._preview is not None:
            # One notice for a drag is enough, however far it goes on.
            told, self._told = self._told, True
            if told:
                return
        elif failure.revision == self._revision:
            # What is added to a design that cannot be solved is not to blame for it.
            lost = self.failure is not None and self.failure.is_rejection
            if lost or not self._take_back():
                self.failure = failure
            told, self._told = self._told, False
            if told:
                return
        self.failed.emit(failure.error)


def _write(path: Path, document: Document, scan: ScanFile, picture: bytes | None) -> None:
    with backup_before_write(path):
        save_project(path, document, scan, picture)
