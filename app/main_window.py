"""The main window: it makes the parts and puts them in their places."""

from __future__ import annotations

from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QCloseEvent, QDragEnterEvent, QDropEvent, QKeyEvent, QUndoGroup
from PySide6.QtWidgets import (
    QAbstractButton,
    QApplication,
    QMainWindow,
    QStackedWidget,
    QVBoxLayout,
    QWidget,
)

from app.actions import Actions
from app.asking.housekeeping import Housekeeping
from app.asking.jobs import Jobs
from app.asking.session import Session
from app.desks.desk import Desk
from app.desks.doctor_desk import DoctorDesk
from app.desks.export_desk import ExportDesk
from app.desks.job_desk import JobDesk
from app.desks.landmark_desk import LandmarkDesk
from app.desks.opening_desk import OpeningDesk
from app.desks.picture_desk import PictureDesk
from app.desks.plot_desk import PlotDesk
from app.desks.report_desk import ReportDesk
from app.desks.scan_desk import ScanDesk
from app.desks.start_desk import StartDesk
from app.desks.verdict_desk import VerdictDesk
from app.dress.door import Door
from app.dress.first_paint import lay_out
from app.dress.parts import OverCard
from app.helping.help_desk import HelpDesk
from app.helping.preferences_desk import PreferencesDesk
from app.helping.rescue import Rescue
from app.helping.safe_mode import SafeMode
from app.keeping.even_desk import EvenDesk
from app.keeping.history_desk import HistoryDesk
from app.keeping.keeping_desk import KeepingDesk
from app.keeping.measures_desk import MeasuresDesk
from app.keeping.own_measures_desk import OwnMeasuresDesk
from app.keeping.pressure_desk import PressureDesk
from app.keeping.recovery_desk import RecoveryDesk
from app.keeping.spread_desk import SpreadDesk
from app.keeping.variant_desk import VariantDesk
from app.keeping.variant_figures import VariantFigures
from app.keeping.worn_desk import WornDesk
from app.layout import Layout
from app.lining.ask_desk import AskDesk
from app.lining.band_pull import BandPull
from app.lining.elastic_choice import ElasticChoice
from app.lining.elastics_desk import ElasticsDesk
from app.lining.garment_desk import GarmentDesk
from app.lining.limits_desk import LimitsDesk
from app.lining.line_drawing import LineDrawing
from app.lining.line_maker import LineMaker
from app.lining.line_routing import LineRouting
from app.lining.lines_desk import LinesDesk
from app.lining.preset_desk import PresetDesk
from app.panels.coach_mark import CoachMark
from app.panels.garment import GarmentPanel
from app.panels.history import HistoryPanel
from app.panels.inspector import Inspector
from app.panels.landmarks import LandmarksPanel
from app.panels.lines import LinesPanel
from app.panels.model import ModelDoor, ModelPanel
from app.panels.notice import NoticeBar
from app.panels.rail import Rail
from app.panels.result import ResultPanel
from app.panels.scan import ScanPanel
from app.panels.status import StatusBar
from app.panels.top_bar import TopBar
from app.panels.variants import VariantsPanel
from app.showing.convergence import Strip
from app.view_area import ViewArea
from app.viewing.map_desk import MapDesk
from app.viewing.section_desk import SectionDesk
from app.viewing.view_desk import ViewDesk
from app.wiring import connect
from app.wording.words import tr


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
        self.jobs = Jobs(self)
        self.view = ViewArea(self.jobs)
        self.undo_group = QUndoGroup(self)  # what is asked for has steps of its own
        self.undo_group.addStack(session.undo_stack)
        self.undo_group.setActiveStack(session.undo_stack)
        do = self.actions_ = Actions(self, self.undo_group, self.view.tool_actions)
        self.top = TopBar(do.bar, do.undo, do.redo, do.export_any)
        self.rail, self.notices, self.strip, self.status = Rail(), NoticeBar(), Strip(), StatusBar()
        self.scan, self.landmarks = ScanPanel(), LandmarksPanel()
        self.lines, self.result, self.garment = LinesPanel(), ResultPanel(), GarmentPanel()
        self.model, self.door = ModelPanel(), ModelDoor()
        self.ask_door = Door(
            tr("Ask for the result"), tr("Say where the bust is to be; Busk finds the lengths")
        )
        self.history, self.variants, self.inspector = HistoryPanel(), VariantsPanel(), Inspector()
        self.lines_page = QStackedWidget()  # the lines, or what is asked for in their place
        self._fill_inspector()
        self.layout_ = Layout(self)
        self.pages = self.layout_.pages
        self._make_desks()
        connect(self)

    def _make_desks(self) -> None:
        self.job_desk, self.limits_desk = JobDesk(self), LimitsDesk(self)
        self.landmark_desk, self.scan_desk = LandmarkDesk(self), ScanDesk(self)
        self.desk, self.verdict_desk, self.doctor_desk = Desk(self), VerdictDesk(self), DoctorDesk(self)
        self.keeping_desk, self.recovery_desk = KeepingDesk(self), RecoveryDesk(self)
        self.history_desk, self.variant_desk = HistoryDesk(self, self.history), VariantDesk(self)
        self.variant_figures = VariantFigures(self, self.variants)
        self.measures_desk, self.spread_desk = MeasuresDesk(self, self.result), SpreadDesk(self, self.result)
        self.own_measures_desk = OwnMeasuresDesk(self, self.result)
        self.even_desk, self.worn_desk = EvenDesk(self, self.result), WornDesk(self, self.result)
        self.inspector.add("worn", self.worn_desk.page)
        self.pressure_desk = PressureDesk(self, self.garment)
        self.map_desk, self.section_desk = MapDesk(self), SectionDesk(self)
        self.start_desk, self.plot_desk = StartDesk(self), PlotDesk(self)
        self.opening_desk = OpeningDesk(self)
        self.picture_desk, self.export_desk = PictureDesk(self), ExportDesk(self)
        self.report_desk = ReportDesk(self)
        self.lines_desk, self.line_maker = LinesDesk(self), LineMaker(self)
        self.line_drawing, self.line_routing = LineDrawing(self), LineRouting(self)
        self.preset_desk, self.band_pull = PresetDesk(self), BandPull(self)
        self.garment_desk, self.elastic_choice = GarmentDesk(self, self.garment), ElasticChoice(self)
        self.elastics_desk, self.ask_desk = ElasticsDesk(self), AskDesk(self)
        self.help = HelpDesk(self)
        self.preferences = PreferencesDesk(self)
        self.rescuer = Rescue(self)
        self.view_desk = ViewDesk(self)
        self.housekeeping = Housekeeping(self)

    def _fill_inspector(self) -> None:
        lines = QWidget()
        column = QVBoxLayout(lines)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(self.lines, 1)
        column.addWidget(self.ask_door)
        column.addWidget(self.door)
        lines.setFocusProxy(self.lines)
        self.inspector.add("scan", self.scan)
        self.inspector.add("landmarks", self.landmarks)
        page = self.lines_page
        page.currentChanged.connect(lambda at: page.setFocusProxy(page.widget(at) or lines))
        page.addWidget(lines)
        self.inspector.add("lines", self.lines_page, tr("Lines"))
        self.inspector.add("result", self.result, tr("Measures"))
        self.inspector.add("garment", self.garment, tr("Garment"))
        self.inspector.add("variants", self.variants, tr("Variants"))
        self.inspector.add("history", self.history, tr("History"))
        self.inspector.add("model", self.model)

    def is_settled(self) -> bool:
        """Tell whether the session's design is solved to the end and shown."""
        frame, session = self.session.frame, self.session
        if frame is None or frame.stages.design is not session.design:
            return False
        return session.is_answered and not frame.at_work

    def is_at_rest(self) -> bool:
        """Tell whether what is shown is solved to the end: the session's design, or what is asked for."""
        return self.is_settled() or self.ask_desk.is_tried_on

    def tell_graphics(self, why: str) -> None:
        """Say once why the view is drawn safely, if it is, and notice when it has been drawn."""
        self.safe_mode = SafeMode(self, why)

    def rescue(self) -> str:
        """Keep the design aside after a fault; returns where, or an empty text if it was not kept."""
        return self.keeping_desk.rescue()

    def end(self) -> None:
        """Close without a question; what is not saved stays where it is kept aside, for the next start."""
        self.keeping_desk.leaves = True
        self.close()

    def focusNextPrevChild(self, next: bool) -> bool:  # noqa: N802
        """Lead the keyboard in the order that eyes read, whenever the parts were made."""
        return self.layout_.next_stop(next)

    def event(self, event: QEvent) -> bool:
        """Lay out what is to be painted; keep keys that are typed in a card from acting on the view."""
        if event.type() == QEvent.Type.UpdateRequest:
            lay_out()
        if isinstance(event, QKeyEvent) and event.type() == QEvent.Type.ShortcutOverride:
            plain = event.modifiers() in (Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.KeypadModifier)
            if plain and event.text().strip() and event.text().isprintable() and self._has_card():
                event.accept()
                return True
        return super().event(event)

    def _has_card(self) -> bool:
        cards = self.findChildren(OverCard)
        return any(card.isVisible() and not isinstance(card, CoachMark) for card in cards)

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802
        """Press a button by Enter too; Esc takes away what lies over the work."""
        has, key = QApplication.focusWidget(), event.key()
        if key in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and isinstance(has, QAbstractButton):
            has.click()
        elif key != Qt.Key.Key_Escape or not self.layout_.give_up():
            super().keyPressEvent(event)

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
        if not self.keeping_desk.leaves and not self.desk.may_leave():
            event.ignore()
            return
        self.layout_.keep()
        # The solver may be in the middle of reading a scan: nobody has to watch the window wait for it.
        self.hide()
        self.desk.close()
        self.history_desk.close()
        self.recovery_desk.close()
        self.jobs.close()
        self.session.close()
        self.keeping_desk.close()
        self.view.close_view()
        self.housekeeping.close()
        self.rescuer.close()
        event.accept()
