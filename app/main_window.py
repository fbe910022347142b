"""The main window: it puts the parts in their places and holds the one list of connections between them."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QCloseEvent, QDragEnterEvent, QDropEvent, QResizeEvent
from PySide6.QtWidgets import QHBoxLayout, QMainWindow, QStackedWidget, QVBoxLayout, QWidget

from app.actions import Actions
from app.asking.housekeeping import Housekeeping
from app.asking.session import Session
from app.desks.desk import Desk
from app.desks.line_maker import LineMaker
from app.desks.recent import fill_recent_menu
from app.desks.scan_desk import ScanDesk
from app.dress.parts import hairline
from app.panels.landmarks import LandmarksPanel
from app.panels.lines import LinesPanel
from app.panels.model import ModelDoor, ModelPanel
from app.panels.notice import NoticeBar
from app.panels.rail import Rail
from app.panels.result import ResultPanel
from app.panels.scan import ScanPanel
from app.panels.status import StatusBar
from app.panels.top_bar import TopBar
from app.showing.convergence import Strip
from app.view_area import ViewArea

NARROW, WIDE = 340, 364
"""Width of the inspector in windows narrower and wider than 1400 pixels."""


class MainWindow(QMainWindow):
    """The window of one session. It shows what the session says, and asks the session."""

    def __init__(self, session: Session) -> None:
        super().__init__()
        self.session = session
        session.setParent(self)
        self.setWindowTitle("Busk")
        self.setMinimumSize(1180, 700)
        self.resize(1600, 1000)
        self.setAcceptDrops(True)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.view = ViewArea()
        self.actions_ = Actions(self, session.undo_stack)
        self.menus = self.actions_.menu_bar(self.view.tools.actions_by_name)
        self.top = TopBar(self.menus, self.actions_.undo, self.actions_.redo, self.actions_.export)
        self.rail, self.notices, self.strip, self.status = Rail(), NoticeBar(), Strip(), StatusBar()
        self.scan, self.landmarks = ScanPanel(), LandmarksPanel()
        self.lines, self.result = LinesPanel(), ResultPanel()
        self.model, self.door = ModelPanel(), ModelDoor()
        self.inspector = QStackedWidget()
        self._lay_out()
        self.scan_desk = ScanDesk(self)
        self.desk = Desk(self)
        self.line_maker = LineMaker(self)
        self.housekeeping = Housekeeping(self)
        self._connect()

    def _lay_out(self) -> None:
        lines = QWidget()
        column = QVBoxLayout(lines)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(self.lines, 1)
        column.addWidget(self.door)
        for panel in (self.scan, self.landmarks, lines, self.result, self.model):
            self.inspector.addWidget(panel)
        middle = QVBoxLayout()
        middle.setSpacing(0)
        for part, stretch in ((self.notices, 0), (self.view, 1), (self.strip, 0)):
            middle.addWidget(part, stretch)
        across = QHBoxLayout()
        across.setSpacing(0)
        across.addWidget(self.rail)
        across.addLayout(middle, 1)
        across.addWidget(hairline(vertical=True))
        across.addWidget(self.inspector)
        central = QWidget()
        down = QVBoxLayout(central)
        down.setContentsMargins(0, 0, 0, 0)
        down.setSpacing(0)
        down.addWidget(self.top)
        down.addLayout(across, 1)
        down.addWidget(self.status)
        self.setCentralWidget(central)
        self.inspector.setFixedWidth(WIDE)

    def _connect(self) -> None:
        """Connect everything: the session to the desk, the parts to the session, the actions to both."""
        session, desk, scan_desk = self.session, self.desk, self.scan_desk
        session.opened.connect(desk.show_opened)
        session.frame_ready.connect(desk.show_frame)
        session.design_changed.connect(desk.show_design)
        session.failed.connect(desk.show_failure)
        session.asked.connect(scan_desk.show_stuck)
        session.working.connect(scan_desk.show_work)
        session.saved.connect(desk.show_saved)
        session.undo_stack.cleanChanged.connect(desk.show_title)

        self.rail.step_chosen.connect(desk.go_to)
        self.lines.length_previewed.connect(session.preview_line)
        self.lines.length_committed.connect(desk.commit_line)
        self.lines.drag_cancelled.connect(lambda _: session.cancel_preview())
        self.lines.selected.connect(desk.select_line)
        self.lines.visibility_changed.connect(desk.set_line_visible)
        self.lines.reset_all.connect(session.reset_lines)
        self.strip.control_chosen.connect(session.choose_control)
        self.lines.add_asked.connect(self.line_maker.show_menu)
        self.lines.removed.connect(self.line_maker.remove)
        self.door.clicked.connect(desk.show_model)
        self.model.left.connect(lambda: desk.go_to("lines"))
        self.model.changed.connect(session.change)
        self.scan.open_asked.connect(desk.open)
        self.scan.told.connect(scan_desk.tell)
        self.scan.front_asked.connect(scan_desk.ask)
        self.landmarks.landmark_selected.connect(desk.select_landmark)
        self.landmarks.reset_asked.connect(scan_desk.reset_landmarks)
        self.landmarks.place_asked.connect(scan_desk.put_pin)

        self._connect_view()
        self._connect_actions()

    def _connect_view(self) -> None:
        desk, scan_desk, view = self.desk, self.scan_desk, self.view
        view.viewport.band_clicked.connect(desk.select_line)
        view.viewport.pin_pressed.connect(desk.select_landmark)
        view.viewport.pin_moved.connect(view.drag_landmark)
        view.viewport.pin_released.connect(scan_desk.place_landmark)
        view.busy.cancelled.connect(scan_desk.cancel)
        view.question.answered.connect(scan_desk.answer)
        view.question.left.connect(scan_desk.leave_question)
        view.tools.view_chosen.connect(view.viewport.set_view)
        view.tools.fit_asked.connect(view.viewport.frame_all)
        view.tools.toggled.connect(view.set_layer)
        view.tools.picture_asked.connect(desk.save_picture)
        view.compare.after_chosen.connect(view.set_after)

    def _connect_actions(self) -> None:
        session, desk, view, do = self.session, self.desk, self.view, self.actions_
        do.open.triggered.connect(desk.open)
        do.save.triggered.connect(desk.save)
        do.save_as.triggered.connect(desk.save_as)
        do.export.triggered.connect(desk.export)
        do.cancel.triggered.connect(self.scan_desk.cancel)
        do.quit.triggered.connect(self.close)
        do.reset.triggered.connect(session.reset_lines)
        do.flip.triggered.connect(lambda: view.set_after(not view.after))
        do.strip.toggled.connect(lambda on: self.strip.set_folded(not on))
        self.strip.folded.connect(lambda folded: do.strip.setChecked(not folded))
        do.own_line.triggered.connect(self.line_maker.ask)
        do.model.triggered.connect(desk.show_model)
        do.about.triggered.connect(desk.about)
        do.recent.aboutToShow.connect(lambda: fill_recent_menu(do.recent, desk.open_file))
        for name, action in do.samples.items():
            action.triggered.connect(lambda _=False, sample=name: desk.open_sample(sample))
        for group, ask in (
            (do.add_lines, self.line_maker.add),
            (do.controls, session.choose_control),
            (do.templates, session.choose_template),
            (do.themes, desk.choose_theme),
            (do.languages, desk.choose_language),
        ):
            for name, action in group.items():
                action.triggered.connect(lambda _=False, ask=ask, name=name: ask(name))

    def is_settled(self) -> bool:
        """Tell whether the session's design is solved to the end and shown."""
        frame, design = self.session.frame, self.session.design
        return frame is not None and frame.stages.design is design and not frame.at_work

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802
        """Give the view more room in a narrow window."""
        super().resizeEvent(event)
        self.inspector.setFixedWidth(WIDE if self.width() >= 1400 else NARROW)

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:  # noqa: N802
        """Take files that are dragged onto the window."""
        if any(url.isLocalFile() for url in event.mimeData().urls()):
            event.acceptProposedAction()

    def dropEvent(self, event: QDropEvent) -> None:  # noqa: N802
        """Open a file that is dropped."""
        files = [url.toLocalFile() for url in event.mimeData().urls() if url.isLocalFile()]
        if files:
            event.setDropAction(Qt.DropAction.CopyAction)
            event.accept()
            self.desk.open_file(files[0])

    def closeEvent(self, event: QCloseEvent) -> None:  # noqa: N802
        """Ask about changes; then solver, background work and 3D view end before the window does."""
        if not self.desk.may_leave():
            event.ignore()
            return
        # The solver may be in the middle of reading a scan: nobody has to watch the window wait for it.
        self.hide()
        self.desk.close()
        self.scan_desk.close()
        self.session.close()
        self.view.close_view()
        self.housekeeping.close()
        event.accept()
