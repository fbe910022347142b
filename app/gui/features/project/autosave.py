"""Nothing is lost: what is not saved is kept aside, found after a crash, and projects are not overwritten
unknowingly.
"""

from __future__ import annotations

import logging
import time
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Qt, QTimer
from PySide6.QtGui import QGuiApplication

from app.gui.features.project.controller import ProjectController
from app.gui.features.project.recent_files import day_of
from app.gui.session.background_save import BackgroundSave
from app.gui.session.project_lock import ProjectLock
from app.gui.session.project_thumbnail import project_picture
from app.gui.session.settings import get_setting
from app.i18n.catalog import tr
from core.document.document import Document
from core.document.storage.project_file import ScanFile, Stamp
from core.document.storage.recovery import Recovery
from core.errors import UserError

if TYPE_CHECKING:
    from pathlib import Path

    from app.gui.context import AppContext


_ASIDE, _HELD = "kept aside", "held"
"""Causes of notices: the recovery copy cannot be written; another window has the project open."""


class AutosaveController(QObject):
    """Keep the document aside while it is not saved, and the project to itself.

    The recovery folder is this window's own as long as it runs; it goes when the window closes in order.
    Where the window ``leaves`` without a question, it stays if anything is not saved.
    """

    def __init__(self, context: AppContext, project: ProjectController) -> None:
        super().__init__(context.session)
        self._context, self._project = context, project
        self._session = context.session
        self._recovery: Recovery | None = None
        self._kept: Document | None = None
        self._told = False
        self.leaves = False
        self._lock = ProjectLock()
        self._writing = BackgroundSave(self)
        self._clock = QTimer(self, singleShot=True)
        self._clock.timeout.connect(self.keep)
        self._session.saved.connect(lambda _: self.show_saved())
        self._session.design_changed.connect(lambda _: self.note())
        self._session.undo_stack.cleanChanged.connect(lambda _: self.note())

    def note(self) -> None:
        """Record an edit or a save."""
        if not self._session.unsaved:
            self._forget()
        elif self._session.document is not self._kept and not self._clock.isActive():
            self._clock.start(round(1000 * float(get_setting("autosave"))))

    def keep(self) -> None:
        """Keep the document aside, in a passing thread; again until there is a picture of it."""
        session, view = self._session, self._context.view
        document, frame = session.document, session.frame
        if document is None or frame is None or not session.unsaved:
            return
        if self._writing.at_work:
            self._clock.start(1000)
            return
        picture = self._picture()
        pictured = picture or not view.isVisible() or session.failure is not None  # there will be none of it
        whole = document if pictured else None
        told = document, frame.stages.scan, session.name, session.path, picture, session.stamp
        self._writing.run(partial(self._write, *told), partial(self._note_kept, whole))

    def rescue(self) -> str:
        """Keep the document aside at once, whatever has happened; returns where, or "" if it was not kept."""
        try:
            self._writing.wait()
            session = self._session
            if session.document is None or session.frame is None:
                return ""
            scan = session.frame.stages.scan
            self._write(session.document, scan, session.name, session.path, None, session.stamp)
            return str(self._recovery.folder) if self._recovery is not None else ""
        except Exception:
            logging.exception("the document could not be kept aside")
            return ""

    def show_opened(self) -> None:
        """Lock the opened project, and discard the recovery data of the previous one."""
        self._forget()
        self._hold_project()
        self.note()

    def show_saved(self) -> None:
        """Lock the saved project, and continue with later edits."""
        if self._session.path != self._lock.path:
            self._hold_project()
        self.note()

    def adopt(self, recovery: Recovery) -> None:
        """Continue in the folder that the present document was restored from."""
        self._writing.wait()
        if self._recovery is not None:
            self._recovery.remove()
        self._clock.stop()
        self._recovery, self._kept = recovery, self._session.document

    def close(self) -> None:
        """Let nothing stay behind: whoever closes a window in order has saved, or does not want to."""
        self._clock.stop()
        self._writing.wait()
        if self._recovery is not None and self.leaves and self._session.unsaved:
            self._recovery.leave()
        elif self._recovery is not None:
            self._recovery.remove()
        self._lock.release()

    def _forget(self) -> None:
        self._clock.stop()
        self._kept = None
        # What is being written is forgotten as soon as it is there: the window waits for no disk.
        if self._recovery is not None and not self._writing.at_work:
            self._recovery.clear()

    def _write(
        self,
        document: Document,
        scan: ScanFile,
        name: str,
        path: Path | None,
        picture: bytes | None,
        stamp: Stamp | None,
    ) -> None:
        if self._recovery is None:
            self._recovery = Recovery.new()
        self._recovery.save(document, scan, name, path, picture, stamp)

    def _note_kept(self, document: Document | None, fault: Exception | None) -> None:
        self._kept = document if fault is None else None
        if fault is None:
            self._told = False
            self._context.notifications.withdraw(_ASIDE)
            self.note()
            return
        logging.error("the document could not be kept aside", exc_info=fault)
        if not self._told:
            text = (fault.message, fault.hint) if isinstance(fault, UserError) else (str(fault), "")
            self._context.notifications.warn(*text, topic=_ASIDE)
        self._told = True
        self._clock.start(60_000)

    def _picture(self) -> bytes | None:
        """Return a picture of the view, unless a hand or a run would have to wait for it."""
        view, frame = self._context.view, self._session.frame
        if frame is None or not view.isVisible() or not self._context.session.is_converged:
            return None
        if QGuiApplication.mouseButtons() != Qt.MouseButton.NoButton:
            return None
        picture = view.viewport.picture(labels=False, fine=False)
        return project_picture(picture, self._project.level_of(frame))

    def _hold_project(self) -> None:
        self._context.notifications.withdraw(_HELD)
        since = self._lock.take(self._session.path)
        if since is None:
            return
        sentence = tr("{name} is already open in another window ({time}).")
        self._context.notifications.show(
            "warn",
            sentence.format(name=self._session.name, time=day_of(since, time.time())),
            tr("The last save overwrites the other one."),
            ((tr("Open as copy"), self._detach), (tr("Open anyway"), _do_nothing)),
            lasting=True,
            topic=_HELD,
        )

    def _detach(self) -> None:
        self._session.detach()
        self._project.show_title()


def _do_nothing() -> None:
    """Do nothing: the notice closes."""
