"""The project file: opened, saved, and never left without a question about unsaved changes."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from app.gui.features.project.recent_files import fill_recent_menu, picture_of, remember_file
from app.gui.session.project_thumbnail import project_picture
from app.gui.widgets.file_dialogs import ask_about_changes, ask_open, ask_overwrite, ask_save, remember_folder
from app.gui.widgets.notification_bar import FILES
from app.i18n.catalog import tr
from app.presenters.samples import dressed_sample
from core.document.design import Design
from core.document.storage.project_file import is_project, is_protected
from core.pipeline.live_solver import Frame

if TYPE_CHECKING:
    from app.gui.context import AppContext


class ProjectController(QObject):
    """Open and save the document.

    ``titled`` carries its name and whether it is unsaved, ``save_state`` when it was saved, ``opening`` the
    name of the file that is being opened, empty once it is. ``level_of``
    returns the level of the overall verdict of a frame; each of ``pending`` completes an edit that is being
    made, such as a name that is being typed, before the document is saved or left.
    """

    titled = Signal(str, bool)
    save_state = Signal(str)
    opening = Signal(str)

    def __init__(self, context: AppContext, level_of: Callable[[Frame], str]) -> None:
        super().__init__(context.session)
        self._context, self._session = context, context.session
        self.level_of = level_of
        self.pending: list[Callable[[], object]] = []
        self._chosen = self._opening = ""
        self._connect()

    def _connect(self) -> None:
        session, do = self._session, self._context.actions
        session.design_changed.connect(self.show_title)
        session.undo_stack.cleanChanged.connect(self.show_title)
        session.saving.connect(self._show_saving)
        session.saved.connect(self._show_saved)
        session.not_saved.connect(lambda error: self._context.notifications.error(error, FILES))
        do.open.triggered.connect(self.open)
        do.save.triggered.connect(self.save)
        do.save_as.triggered.connect(self.save_as)
        do.recent.aboutToShow.connect(lambda: fill_recent_menu(do.recent, self.open_file))
        for name, action in do.samples.items():
            action.triggered.connect(lambda _=False, sample=name: self.open_sample(sample))

        for changed in (session.working, session.failed, session.requested):
            changed.connect(lambda *_: self.follow_opening())

    # -- what is shown

    def follow_opening(self) -> None:
        """Show the stored picture of what is being opened, until it is open, refused or cancelled."""
        path = self._session.opening
        if path == self._opening:
            return
        self._opening = path
        self.opening.emit(Path(path).name if path else "")
        stored = picture_of(Path(path)) if path and is_project(path) else None
        self._context.view.cover.show_picture(stored)

    def show_opened(self, frame: Frame) -> None:
        """Show a document that has just been opened."""
        context = self._context
        context.actions.enable_document()
        self.show_title()
        self.save_state.emit("")
        if self._is_chosen_scan(frame.stages.design):
            context.navigation.show_step("scan")
        context.selection.select_line(context.selection.line)
        context.navigation.focus_panel()

    def show_title(self) -> None:
        """Show the document's name, with a mark while it is unsaved."""
        self.titled.emit(self._session.name, not self._session.undo_stack.isClean())

    def _show_saving(self, saving: bool) -> None:
        self.save_state.emit(tr("Saving…") if saving else "")

    def _show_saved(self, path: str) -> None:
        """Show when the project was saved."""
        remember_file(path)
        self._context.notifications.withdraw(FILES)
        without = self._session.trial is not None
        text = tr("Saved {time} (pending targets not included)") if without else tr("Saved {time}")
        self.save_state.emit(text.format(time=time.strftime("%H:%M")))
        self.show_title()

    # -- files

    def open(self) -> None:
        """Prompt for a file and open it."""
        self.open_file(ask_open(self._context.window))

    def open_file(self, path: str) -> None:
        """Open a project, or a scan, which shows the Scan step: unit and front are to be checked."""
        if path and self.may_leave():
            remember_folder("opened", path)
            self._chosen = path
            self._session.open(path)

    def open_sample(self, name: str) -> None:
        """Open one of the sample bodies."""
        if self.may_leave():
            self._session.open_design(dressed_sample(name))

    def save(self) -> bool:
        """Save the project, asking for a place the first time; returns whether it is being saved."""
        self.complete_edits()
        path = self._session.path
        if path is None:
            return self.save_as()
        if (protected := is_protected(path)) or self._session.changed_elsewhere:
            answer = ask_overwrite(self._context.window, self._session.name, protected)
            if answer != "overwrite":
                return answer == "elsewhere" and self.save_as()
        return self._session.save(str(path), self._preview())

    def save_as(self) -> bool:
        """Prompt for a file and save the project; returns whether saving has begun."""
        self.complete_edits()
        kinds = f"{tr('Projects')} (*.busk)"
        name = str(self._session.path or f"{self._session.name}.busk")
        path = ask_save(self._context.window, tr("Save as"), name, kinds, ".busk")
        return bool(path) and self._session.save(path, self._preview())

    def may_leave(self) -> bool:
        """Confirm unsaved changes; returns whether the document may be closed. Waits for a save."""
        self.complete_edits()
        if self._session.finish_saving():
            return True
        answer = ask_about_changes(self._context.window, self._session.name)
        return self.save() and self._session.finish_saving() if answer == "save" else answer == "discard"

    def complete_edits(self) -> None:
        """Complete the edits that are being made: of a pin moved by keys, of a name being typed."""
        for complete in self.pending:
            complete()

    def _is_chosen_scan(self, design: Design) -> bool:
        """Return, once, whether a design is the scan that the user has just chosen, and no project."""
        chosen, self._chosen = self._chosen, ""
        scan = design.scan
        return bool(chosen) and not scan.member and Path(scan.path) == Path(chosen).absolute()

    def _preview(self) -> bytes:
        """Return a small picture of the view, for the project file."""
        frame = self._session.frame
        level = self.level_of(frame) if frame is not None else ""
        return project_picture(self._context.view.viewport.picture(labels=False), level)
