"""The main window, the composition root: it makes all parts, and connects features with each other."""

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

from app.gui.actions import Actions
from app.gui.context import AppContext, Navigation, Selection
from app.gui.features.batch.controller import BatchController
from app.gui.features.convergence.controller import ConvergenceController
from app.gui.features.cups.card import CupCard
from app.gui.features.cups.controller import CupsController
from app.gui.features.diagnosis.assessment import AssessmentController
from app.gui.features.diagnosis.controller import DiagnosisController
from app.gui.features.export.controller import ExportController
from app.gui.features.garment.controller import GarmentController
from app.gui.features.garment.elastic_assignment import ElasticAssignmentController
from app.gui.features.garment.elastics_controller import ElasticsController
from app.gui.features.garment.panel import GarmentPanel
from app.gui.features.garment.pressure_controller import PressureController
from app.gui.features.help.controller import HelpController
from app.gui.features.help.crash_handler import CrashHandler
from app.gui.features.help.safe_mode import SafeMode
from app.gui.features.landmarks.controller import LandmarksController
from app.gui.features.landmarks.panel import LandmarksPanel
from app.gui.features.lines.add_lines import AddLinesController
from app.gui.features.lines.band_drag import BandDragController
from app.gui.features.lines.controller import LinesController, LineSources
from app.gui.features.lines.draw_tool import LineDrawTool
from app.gui.features.lines.limits_controller import LimitsController
from app.gui.features.lines.panel import LinesPanel
from app.gui.features.lines.path_tool import LinePathTool
from app.gui.features.lines.presets import PresetsController
from app.gui.features.maps.controller import MapsController
from app.gui.features.measurements.controller import MeasurementsController
from app.gui.features.measurements.custom_measures import CustomMeasuresController
from app.gui.features.measurements.panel import MeasurementsPanel
from app.gui.features.model.controller import ModelController
from app.gui.features.model.panel import ModelPanel, ModelRow
from app.gui.features.pattern.controller import PatternController
from app.gui.features.pattern.panel import PatternPanel
from app.gui.features.pattern.pieces_view import PiecesView
from app.gui.features.preferences.controller import PreferencesController
from app.gui.features.project.autosave import AutosaveController
from app.gui.features.project.controller import ProjectController
from app.gui.features.project.recovery import RecoveryController
from app.gui.features.project.start_controller import StartController
from app.gui.features.report.controller import ReportController
from app.gui.features.scan.controller import ScanController
from app.gui.features.scan.panel import ScanPanel
from app.gui.features.scan_comparison.controller import ScanComparisonController
from app.gui.features.sections.controller import SectionsController
from app.gui.features.symmetry.controller import SymmetryController
from app.gui.features.target_shape.controller import TargetShapeController
from app.gui.features.uncertainty.controller import UncertaintyController
from app.gui.features.variants.controller import VariantsController
from app.gui.features.variants.history import HistoryController, HistoryPanel
from app.gui.features.variants.panel import VariantsPanel
from app.gui.features.variants.table import VariantTableController
from app.gui.features.view.controller import ViewController
from app.gui.features.view.image_export import ImageExportController
from app.gui.frame_dispatch import FrameDispatch, ThrottledDispatch
from app.gui.layout import Inspector, Layout
from app.gui.plots.convergence_panel import ConvergencePanel
from app.gui.progress_controller import ProgressController
from app.gui.session.gc_control import GarbageCollection
from app.gui.session.jobs import Jobs
from app.gui.session.notifications import Notifications
from app.gui.session.session import Session
from app.gui.shortcuts import keys_of_parts
from app.gui.status_bar import StatusBar
from app.gui.step_navigation import StepNavigation
from app.gui.title_bar import TitleBar
from app.gui.tour import Tour
from app.gui.viewport.view_area import ViewArea
from app.gui.widgets.basic import OverlayCard
from app.gui.widgets.coach_mark import CoachMark
from app.gui.widgets.first_paint import lay_out
from app.gui.widgets.navigation_row import NavigationRow
from app.gui.widgets.notification_bar import NotificationBar
from app.gui.widgets.value_edit import forget_refused
from app.i18n.catalog import tr
from app.presenters.status import facts
from app.presenters.zones import taken_up_texts
from core.pipeline.live_solver import Frame
from core.pipeline.warnings import controlled_volume


class MainWindow(QMainWindow):
    """The window of one session."""

    def __init__(self, session: Session) -> None:
        super().__init__()
        self.session = session
        session.setParent(self)
        self.setWindowTitle("Busk")
        self.setMinimumSize(1180, 700)
        self.resize(1600, 1000)
        self.setAcceptDrops(True)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._make_parts(session)
        self._make_controllers()
        self._state_order()
        self._connect_window()
        self._connect_view()
        self._connect_features()
        self.actions_.strip.setChecked(True)
        self.actions_.inspector.setChecked(True)
        self.navigation.show_step("lines")
        self.project_controller.show_title()

    def _make_parts(self, session: Session) -> None:
        """Make the panels, their places, and the context of the controllers."""
        self.jobs = Jobs(self)
        self.view = ViewArea(self.jobs)
        self.undo_group = QUndoGroup(self)  # what is asked for has steps of its own
        self.undo_group.addStack(session.undo_stack)
        self.undo_group.setActiveStack(session.undo_stack)
        do = self.actions_ = Actions(self, self.undo_group, self.view.tool_actions)
        self.top = TitleBar(do.bar, do.undo, do.redo, do.export_any)
        self.rail, self.notices = StepNavigation(), NotificationBar()
        self.strip, self.status = ConvergencePanel(), StatusBar()
        self.scan, self.landmarks = ScanPanel(), LandmarksPanel()
        self.lines, self.result, self.garment = LinesPanel(), MeasurementsPanel(), GarmentPanel()
        self.pattern, self.pieces = PatternPanel(), PiecesView()
        self.model, self.door, self.cups = ModelPanel(), ModelRow(), CupCard()
        self.lines.cards.addWidget(self.cups)
        self.ask_door = NavigationRow(
            tr("Target shape"), tr("Set target positions; Busk computes the line lengths")
        )
        self.history, self.variants, self.inspector = HistoryPanel(), VariantsPanel(), Inspector()
        self.lines_page = QStackedWidget()  # the lines, or what is asked for in their place
        self._fill_inspector()
        self.notifications = Notifications(session, self.notices)
        self.navigation, self.selection = Navigation(self), Selection(self.view.selected_line, self)
        self.context = AppContext(
            session, self.jobs, do, self.notifications, self.navigation, self.selection, self.view
        )
        self.layout_ = Layout(self)
        self.pages = self.layout_.pages

    def _make_controllers(self) -> None:
        """Make the controllers; menus hold their actions in this order."""
        self._make_document()
        self._make_variants()
        self._make_result()
        self._make_view()
        self._make_outputs()
        self._make_lines()
        self._make_garment()
        self._make_target_shape()
        self.pattern_controller = PatternController(self.context, self.pattern, self.pieces)
        self._collect_carriers()
        self._make_help()
        self.preferences_controller = PreferencesController(self.context, self.project_controller.may_leave)
        self.rail.add_tool("gear-six", self.preferences_controller.open)
        self.crash_handler = CrashHandler(self.context, self.rescue)
        self.view_controller = ViewController(self.context, self.variants_controller.show_side_by_side)
        self.garbage_collection = GarbageCollection(self)

    def _make_document(self) -> None:
        """Make what opens, judges and saves a document."""
        context = self.context
        self.progress_controller = ProgressController(context, self.notices, self.status)
        self.limits_controller = LimitsController(context, self.lines)
        self.landmarks_controller = LandmarksController(context, self.landmarks)
        self.pressure_controller = PressureController(context, self.garment)
        self.assessment_controller = AssessmentController(context, self.pressure_controller)
        self.diagnosis_controller = DiagnosisController(context, self.assessment_controller.of)
        project = self.project_controller = ProjectController(context, self.assessment_controller.level_of)
        self.scan_controller = ScanController(context, self.scan, project.may_leave)
        self.model_controller = ModelController(context, self.model, self.door)
        self.autosave_controller = AutosaveController(context, project)
        self.recovery_controller = RecoveryController(context, project, self.autosave_controller)

    def _make_view(self) -> None:
        """Make maps, sections and the start page, which are seen in the view or in its place."""
        context = self.context
        self.maps_controller = MapsController(
            context, self.pressure_controller, self.symmetry_controller, self.scan_comparison_controller
        )
        self.sections_controller = SectionsController(
            context,
            self.uncertainty_controller.of,
            lambda plane: self.target_shape_controller.drawing.in_plane(plane),  # noqa: PLW0108 (made later)
        )
        self.start_controller = StartController(
            context, self.project_controller, Tour(self), lambda: self.session.stuck is not None
        )

    def _make_outputs(self) -> None:
        """Make plots, pictures, exports and the report."""
        context = self.context
        self.convergence_controller = ConvergenceController(context, self.strip)
        self.image_export_controller = ImageExportController(context)
        self.export_controller = ExportController(context, self.assessment_controller.of)
        self.report_controller = ReportController(context, self.uncertainty_controller.on_sheet)
        self.top.add_primary(self.report_controller.action)
        self.batch_controller = BatchController(context, self.project_controller.may_leave)
        self.status.place(self.batch_controller.indicator)
        for page in (self.start_controller.page, self.report_controller.page):
            self.pages.addWidget(page)
        self.project_controller.pending += [
            self.landmarks_controller.put_down,
            self.report_controller.page.tell_name,
        ]

    def _make_lines(self) -> None:
        """Make the list of lines, and the tools that edit them."""
        context, panel = self.context, self.lines
        sources = LineSources(
            self.limits_controller.leeways,
            self.pressure_controller.of_active,
            lambda *of: self.target_shape_controller.around.is_tried_on(*of),  # noqa: PLW0108 (made later)
        )
        self.lines_controller = LinesController(context, panel, sources)
        self.add_lines_controller = AddLinesController(context, panel)
        self.draw_tool = LineDrawTool(context, panel, self.add_lines_controller)
        self.path_tool = LinePathTool(context, panel, self.draw_tool.begin_again)
        self.presets_controller = PresetsController(context, panel)
        self.cups_controller = CupsController(context, self.cups)
        self.band_drag_controller = BandDragController(
            context,
            panel,
            self.lines_controller.commit_length,
            lambda: self.draw_tool.at_work or self.path_tool.at_work,
        )

    def _make_garment(self) -> None:
        """Make the cut list, and the elastics of lines."""
        context = self.context
        self.garment_controller = GarmentController(
            context, self.garment, lambda: self.pressure_controller.shown
        )
        self.elastic_assignment_controller = ElasticAssignmentController(context, self.garment)
        self.elastics_controller = ElasticsController(context, self.garment)

    def _make_target_shape(self) -> None:
        """Make the targets."""
        self.target_shape_controller = TargetShapeController(self.context, self.lines_page, self.undo_group)

    def _collect_carriers(self) -> None:
        """Collect what drags something: meanwhile nothing is waited for."""
        self.progress_controller.add_carriers(
            self.landmarks_controller,
            self.band_drag_controller,
            self.sections_controller,
            self.target_shape_controller.handles,
            self.pattern_controller.editing,
        )

    def _make_help(self) -> None:
        """Make the help, with its buttons below the steps."""
        parts = {
            "steps": self.rail,
            "view": self.view,
            "section": self.sections_controller.panel,
            "report": self.report_controller.page,
            "convergence": self.strip,
            "notifications": self.notices,
            "scan": self.scan,
            "landmarks": self.landmarks,
            "lines": self.lines,
            "result": self.result,
            "garment": self.garment,
            "model": self.model,
            "pattern": self.pattern,
        }
        pages = {self.report_controller.page: "report", self.start_controller.page: ""}
        help_ = self.help_controller = HelpController(self.context, parts, keys_of_parts, pages)
        self.rail.add_tool("search", help_.palette)
        tool = self.rail.add_tool("question", help_.menu)
        help_.menu.triggered.connect(lambda: help_.show_menu(tool))

    def _make_variants(self) -> None:
        """Make what compares variants and goes back to former results."""
        context, assess = self.context, self.assessment_controller.of
        self.history_controller = HistoryController(context, self.history, assess)
        self.variants_controller = VariantsController(context, assess)
        self.top.place(self.variants_controller.segment)
        self.top.place(self.variants_controller.button)
        self.variant_table_controller = VariantTableController(
            context, self.variants, self.variants_controller, self.pressure_controller.of, assess
        )

    def _make_result(self) -> None:
        """Make what is shown at the step Result, in the panel of measures and in its place."""
        context, panel = self.context, self.result
        self.uncertainty_controller = UncertaintyController(
            context, panel, lambda: self.sections_controller.is_on or self.report_controller.is_open
        )
        self.measurements_controller = MeasurementsController(
            context, panel, lambda: self.uncertainty_controller.shown
        )
        self.custom_measures_controller = CustomMeasuresController(context, panel)
        self.symmetry_controller = SymmetryController(context, panel, self.uncertainty_controller.of)
        self.scan_comparison_controller = ScanComparisonController(context)
        panel.feet.addWidget(self.uncertainty_controller.card)
        panel.cards.addWidget(self.symmetry_controller.card)
        panel.doors.addWidget(self.scan_comparison_controller.door)
        self.inspector.add("worn", self.scan_comparison_controller.page)

    def _state_order(self) -> None:
        """State in which order frames, opened documents and the Esc key reach their receivers."""
        self.throttled = self._throttled_receivers()
        self.frames = self._frame_receivers()
        self.opened = self._document_receivers()
        self.session.frame_ready.connect(self.frames.show_frame)
        self.session.opened.connect(self.opened.show_frame)
        self.layout_.closers = (
            self.report_controller.close,
            self.target_shape_controller.leave,
            self._close_panel,
            self.view.close_comparison,
            self.result.unmark,
        )

    def _throttled_receivers(self) -> ThrottledDispatch:
        """Return the receivers of a frame that may wait while the solver iterates."""
        return ThrottledDispatch(
            [
                self.model_controller.show_frame,
                self.lines_controller.show_frame,
                self.cups_controller.show_frame,
                self._show_status,
                self.assessment_controller.show_frame,
                self.convergence_controller.show_frame,
                self.measurements_controller.show_frame,
            ],
            self,
        )

    def _frame_receivers(self) -> FrameDispatch:
        """Return the receivers of every frame, in order."""
        return FrameDispatch(
            [
                self.limits_controller.follow,
                self.diagnosis_controller.follow,
                self.landmarks_controller.follow,
                self.notifications.show_frame,
                self.scan_controller.show_frame,
                self.view.show_frame,
                self.throttled.show_frame,
                lambda _: self.pressure_controller.follow(),
                lambda _: self.symmetry_controller.follow(),
                lambda _: self.scan_comparison_controller.follow(),
                lambda _: self.uncertainty_controller.follow(),
                self.export_controller.show_frame,
                lambda _: self.report_controller.follow(),
                self.garment_controller.follow,
                lambda _: self.history_controller.note(),
                lambda _: self.variant_table_controller.follow(),
                lambda _: self.project_controller.follow_opening(),
                self.convergence_controller.mark_edit,
                # What the view shows of a frame is there before it is coloured and cut.
                lambda _: self.maps_controller.follow(),
                lambda _: self.sections_controller.follow(),
                self.pattern_controller.follow,
            ],
            self,
        )

    def _document_receivers(self) -> FrameDispatch:
        """Return the receivers of the first frame of an opened document, in order."""
        return FrameDispatch(
            [
                self.project_controller.show_opened,
                self.scan_controller.show_opened,
                lambda _: self.report_controller.forget(),
                lambda _: self.garment_controller.forget(),
                lambda _: self.autosave_controller.show_opened(),
                lambda _: self.recovery_controller.show_opened(),
                lambda _: self.history_controller.show_opened(),
                lambda _: self.variants_controller.close_side_by_side(),
                lambda _: self.start_controller.show_opened(),
            ],
            self,
        )

    def _connect_window(self) -> None:
        """Connect the parts of the window with each other."""
        do, layout, session = self.actions_, self.layout_, self.session
        session.failed.connect(lambda _: self.throttled.repeat() if session.failure is not None else None)
        session.undo_stack.indexChanged.connect(lambda _: forget_refused())
        self.navigation.page_shown.connect(self._show_page)
        do.quit.triggered.connect(self.close)
        do.inspector.triggered.connect(layout.show_inspector)
        do.alone.triggered.connect(layout.show_alone)
        do.full_screen.triggered.connect(layout.show_full_screen)
        do.next_pane.triggered.connect(layout.next_pane)
        do.reset_layout.triggered.connect(layout.reset)
        for step, action in do.steps.items():
            action.triggered.connect(lambda _=False, step=step: layout.go_on_in(step))
        self.model.closed.connect(lambda: layout.go_on_in("lines"))
        project = self.project_controller
        project.titled.connect(self.show_title)
        project.save_state.connect(self.status.set_saved)

    def _connect_view(self) -> None:
        """Connect the view with its tools, and with what is selected."""
        view, selection = self.view, self.selection
        view.tools.view_chosen.connect(view.viewport.set_view)
        view.tools.fit_requested.connect(view.viewport.frame_all)
        view.tools.toggled.connect(view.set_layer)
        view.compare.way_chosen.connect(view.compare_by)
        view.compare.toggled.connect(view.set_layer)
        view.viewport.band_clicked.connect(selection.select_line)
        selection.line_selected.connect(self.garment.select)
        selection.line_selected.connect(view.select_line)
        maps, sections = self.maps_controller, self.sections_controller
        maps.chosen.connect(sections.show_map)
        for each in (
            self.symmetry_controller,
            self.scan_comparison_controller,
            self.cups_controller,
            self.view_controller,
        ):
            maps.chosen.connect(each.show_map)
            each.map_requested.connect(maps.choose)
        self.view_controller.material_shown.connect(maps.refresh)
        self.preferences_controller.material_chosen.connect(self.view_controller.choose_material)
        self.symmetry_controller.changed.connect(maps.refresh)
        self.pressure_controller.changed.connect(maps.refresh)
        self.pressure_controller.place_requested.connect(maps.look_at_most)
        self.scan_comparison_controller.compared.connect(maps.refresh)
        self.landmarks.landmark_selected.connect(sections.follow_landmark)
        for follow in (maps.follow, sections.follow):
            self.lines.visibility_changed.connect(lambda *_, follow=follow: follow())

    def _connect_features(self) -> None:
        """Connect features with each other: none of them knows another."""
        scan, landmarks = self.scan_controller, self.landmarks_controller
        scan.found.connect(landmarks.show_found)
        scan.checked.connect(landmarks.show_unclear)
        scan.incomplete_shown.connect(landmarks.show_stuck)
        landmarks.upright_requested.connect(scan.stand_upright)
        self.scan.open_requested.connect(self.project_controller.open)
        self.project_controller.opening.connect(self.lines.show_opening)
        uncertainty, symmetry, result = self.uncertainty_controller, self.symmetry_controller, self.result
        self.sections_controller.switched.connect(uncertainty.follow)
        uncertainty.changed.connect(self.measurements_controller.show_spread)
        uncertainty.changed.connect(self.sections_controller.show_spread)
        uncertainty.changed.connect(self.report_controller.follow)
        uncertainty.changed.connect(symmetry.follow)
        uncertainty.summarized.connect(result.show_summary)
        result.summary_clicked.connect(lambda: result.bring(uncertainty.card))
        result.opened.connect(uncertainty.follow)
        result.opened.connect(symmetry.open)
        self.report_controller.action.triggered.connect(uncertainty.follow)
        self.custom_measures_controller.tried.connect(self.measurements_controller.try_out)
        for follow in (
            self.assessment_controller.refresh,
            self.variant_table_controller.follow,
            self.lines_controller.show_rows,
        ):
            self.pressure_controller.changed.connect(follow)
        self.assessment_controller.assessed.connect(self.strip.set_verdict)
        self.strip.why_requested.connect(self.diagnosis_controller.ask)
        self.limits_controller.changed.connect(self.lines_controller.show_rows)
        self.lines.elastic_requested.connect(self.elastic_assignment_controller.show)
        target_shape = self.target_shape_controller
        symmetry.targets_proposed.connect(target_shape.begin)
        self.ask_door.clicked.connect(lambda _: target_shape.begin())
        target_shape.closed.connect(self.lines_controller.show_rows)
        target_shape.presets_requested.connect(self.presets_controller.show_menu)
        self.lines_page.currentChanged.connect(lambda at: self.recovery_controller.set_aside(at > 0))
        self.start_controller.page.guide_requested.connect(self.help_controller.show_first_steps)

    def _show_status(self, frame: Frame) -> None:
        self.status.set_volume(*controlled_volume(frame))
        self.status.set_taken_up(*taken_up_texts(frame))
        self.status.set_facts(facts(frame, self.session.failure is None))

    def _close_panel(self) -> bool:
        """Leave a panel that takes the place of another one; returns whether one did."""
        panels = {"model": self.model.closed, "worn": self.scan_comparison_controller.page.closed}
        left = panels.get(self.navigation.panel)
        if left is not None:
            left.emit()
        return left is not None

    def _show_page(self, page: QWidget | None) -> None:
        """Highlight no step and offer no variants where the start page hides what they are about."""
        at_start = page is self.start_controller.page
        self.variants_controller.set_shown(not at_start)
        self.rail.set_current("" if at_start else self.navigation.step)

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
        self.inspector.add("result", self.result, tr("Measurements"))
        self.inspector.add("garment", self.garment, tr("Garment"))
        self.inspector.add("variants", self.variants, tr("Variants"))
        self.inspector.add("pattern", self.pattern)
        self.inspector.add("history", self.history, tr("History"))
        self.inspector.add("model", self.model)

    def show_title(self, name: str, unsaved: bool) -> None:
        """Show the name of the document."""
        self.top.set_title(name, unsaved)
        self.setWindowTitle(f"{name}{'*' if unsaved else ''} - Busk" if name else "Busk")

    def is_settled(self) -> bool:
        """Return whether the session's design is solved to the end and shown."""
        return self.session.is_converged

    def tell_graphics(self, why: str) -> None:
        """Show once why safe mode is on, if it is, and record when the view has been drawn."""
        self.safe_mode = SafeMode(self.context, why)

    def rescue(self) -> str:
        """Keep the design aside after a fault; returns where, or an empty text if it was not kept."""
        return self.autosave_controller.rescue()

    def end(self) -> None:
        """Close without a question; what is not saved stays where it is kept aside, for the next start."""
        self.autosave_controller.leaves = True
        self.close()

    def focusNextPrevChild(self, next: bool) -> bool:  # noqa: N802
        """Move the keyboard focus in reading order."""
        return self.layout_.next_stop(next)

    def event(self, event: QEvent) -> bool:
        """Lay out what is to be painted; keep keys typed in a card from acting on the view."""
        if event.type() == QEvent.Type.UpdateRequest:
            lay_out()
        if isinstance(event, QKeyEvent) and event.type() == QEvent.Type.ShortcutOverride:
            plain = event.modifiers() in (Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.KeypadModifier)
            if plain and event.text().strip() and event.text().isprintable() and self._has_card():
                event.accept()
                return True
        return super().event(event)

    def _has_card(self) -> bool:
        cards = self.findChildren(OverlayCard)
        return any(card.isVisible() and not isinstance(card, CoachMark) for card in cards)

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802
        """Press a button by Enter too; Esc closes overlays."""
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
            self.project_controller.open_file(files[0])

    def closeEvent(self, event: QCloseEvent) -> None:  # noqa: N802
        """Confirm changes; then end solver, background work and 3D view before the window."""
        may_close = self.project_controller.may_leave, self.batch_controller.may_quit
        if not self.autosave_controller.leaves and not all(each() for each in may_close):
            event.ignore()
            return
        self.layout_.keep()
        # The solver may be in the middle of reading a scan: nobody has to watch the window wait for it.
        self.hide()
        self.batch_controller.close()
        self.throttled.close()
        self.history_controller.close()
        self.recovery_controller.close()
        self.jobs.close()
        self.session.close()
        self.autosave_controller.close()
        self.view.close_view()
        self.garbage_collection.close()
        self.crash_handler.close()
        event.accept()
