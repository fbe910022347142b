"""The start page at work: when it is shown, what its cards do, and files that are dropped on the context."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QDragEnterEvent

from app.gui.features.project.controller import ProjectController
from app.gui.features.project.recent_files import forget_file, project_views, remember_file
from app.gui.features.project.start_page import DropVeil, StartPage
from app.gui.widgets.file_dialogs import ask_open
from app.i18n.catalog import tr
from app.presenters.samples import FIRST_SAMPLE, SAMPLES, STRAP, dressed_sample, sample_path
from core.document.storage.recovery import recovery_folder

if TYPE_CHECKING:
    from app.gui.context import AppContext


class Tour(Protocol):
    """A tour through the window."""

    @property
    def place(self) -> int:
        """Return the index of the shown step, from 0; -1 without a tour."""
        ...

    def begin(self) -> None:
        """Start with the first step."""
        ...

    def begin_when_settled(self) -> None:
        """Start once the opened body has converged."""
        ...

    def end(self) -> None:
        """End the tour for good."""
        ...


class StartController(QObject):
    """Show the start page in the place of the work, and the work again once a file is being opened.

    ``is_incomplete`` returns whether a scan is shown that cannot go on.
    """

    def __init__(
        self, context: AppContext, project: ProjectController, tour: Tour, is_incomplete: Callable[[], bool]
    ) -> None:
        super().__init__(context.session)
        self._context, self._project, self._is_incomplete = context, project, is_incomplete
        self.page = StartPage()
        self.tour = tour
        self.veil = DropVeil(context.window)
        context.window.installEventFilter(self)
        self._connect()
        text = tr("Start with a scan or continue a recent project")
        context.actions.add("file", tr("Start page"), "Ctrl+Shift+N", text, do=self.show_page)
        context.actions.add(
            "help", tr("Tour"), tip=tr("Show the main parts of the window step by step"), do=self.take_tour
        )

    def _connect(self) -> None:
        session, page, project = self._context.session, self.page, self._project
        session.working.connect(self.show_work)
        session.failed.connect(lambda _: self.show_failure())
        session.requested.connect(lambda _: self.leave_page())
        page.open_requested.connect(project.open)
        page.sample_requested.connect(project.open_sample)
        page.tour_requested.connect(self.take_tour)
        page.project_chosen.connect(project.open_file)
        page.locate_requested.connect(self.locate)
        page.forget_requested.connect(self.forget)
        page.closed.connect(self.leave_page)

    def show_page(self) -> None:
        """Show the start page; what is open stays as it is."""
        context = self._context
        if self.tour.place >= 0:
            self.tour.end()
        self.page.set_document(context.session.name if context.session.frame is not None else "")
        self.page.set_projects(project_views())
        context.navigation.show_page(self.page)
        self.page.zone.choose.setFocus()

    def leave_page(self) -> None:
        """Show the work again."""
        self._context.navigation.close_page(self.page)

    def show_work(self, what: str, _share: float) -> None:
        """Leave the page as soon as a body is being read: its progress is shown beside the view."""
        if what:
            self.leave_page()

    def show_failure(self) -> None:
        """Show the start page where nothing else can be shown; the notice is above it."""
        if self._context.session.frame is None and not self._is_incomplete():
            self.show_page()
        else:
            self.leave_page()

    def show_opened(self) -> None:
        """Record what was opened, unless it is a sample."""
        self.leave_page()
        session = self._context.session
        if session.path is not None:
            remember_file(str(session.path))
            return
        if session.design in [dressed_sample(name) for name in SAMPLES]:
            # As soon as the view has framed the body that is new to it.
            session.frame_ready.connect(self._show_lift, Qt.ConnectionType.SingleShotConnection)
        scan = session.design.scan if session.design is not None else None
        # A scan that was kept aside goes with its folder.
        passing = (sample_path("").parent, recovery_folder())
        if scan is not None and not scan.member and not {*Path(scan.path).parents} & {*passing}:
            remember_file(scan.path)

    def _show_lift(self) -> None:
        """Show from near by what the bra of a sample does, against the original body."""
        view = self._context.view
        self._context.selection.select_line("")
        view.set_layer("ghost", True)
        view.viewport.frame_points(view.viewport.scene.bands.spine(STRAP)[0])

    def take_tour(self) -> None:
        """Start the tour on the open document, or else on the sample."""
        context = self._context
        if context.session.frame is None:
            self._project.open_sample(FIRST_SAMPLE)
            self.tour.begin_when_settled()
        else:
            self.leave_page()
            self.tour.begin()

    def locate(self, path: str) -> None:
        """Prompt for the new place of a missing file, and open it."""
        found = ask_open(self._context.window)
        if found:
            forget_file(path)
            self._project.open_file(found)

    def forget(self, path: str) -> None:
        """Take a file off the list."""
        forget_file(path)
        self.page.set_projects(project_views())

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
        """Show over the whole window what dropping a file will do."""
        if isinstance(event, QDragEnterEvent) and event.type() == QEvent.Type.DragEnter:
            files = [url.fileName() for url in event.mimeData().urls() if url.isLocalFile()]
            if files:
                self.veil.show_for(files[0])
        elif event.type() in (QEvent.Type.DragLeave, QEvent.Type.Drop):
            self.veil.hide()
        return False
