"""The one list of connections: who of the window hears whom."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.gui.widgets.inline_edit import forget_refused

if TYPE_CHECKING:
    from app.gui.main_window import MainWindow


def connect(window: MainWindow) -> None:
    """Connect everything: the session to the desks, the parts to the session, the actions to both."""
    _connect_work(window)
    _connect_landmarks(window)
    _connect_session(window)
    _connect_panels(window)
    _connect_view(window)
    _connect_actions(window)
    _connect_start(window)
    _connect_project(window)
    _connect_safe(window)
    _connect_maps(window)


def _connect_work(window: MainWindow) -> None:
    window.lines_desk.leeways = window.limits_desk.leeways


def _connect_landmarks(window: MainWindow) -> None:
    panel, view, landmark_desk = window.landmarks, window.view.viewport, window.landmark_desk
    panel.landmark_selected.connect(landmark_desk.take)
    panel.reset_asked.connect(landmark_desk.reset)
    panel.confirmed.connect(landmark_desk.confirm)
    panel.place_asked.connect(landmark_desk.put_pin)
    panel.keys_asked.connect(landmark_desk.move_by_keys)
    panel.hovered.connect(landmark_desk.hover)
    panel.linked.connect(landmark_desk.link)
    view.pin_pressed.connect(landmark_desk.take)
    view.pin_moved.connect(landmark_desk.carry)
    view.pin_released.connect(landmark_desk.put_down)
    view.pin_hovered.connect(landmark_desk.hover_pin)


def _connect_session(window: MainWindow) -> None:
    session, scan_desk = window.session, window.scan_desk
    uncertainty, symmetry, result = window.uncertainty_controller, window.symmetry_controller, window.result
    uncertainty.changed.connect(window.measurements_controller.show_spread)
    uncertainty.changed.connect(window.section_desk.show_spread)
    uncertainty.changed.connect(window.report_controller.follow)
    uncertainty.changed.connect(symmetry.follow)
    uncertainty.summarized.connect(result.show_summary)
    result.summary_clicked.connect(lambda: result.bring(uncertainty.card))
    result.opened.connect(uncertainty.follow)
    result.opened.connect(symmetry.open)
    window.custom_measures_controller.tried.connect(window.measurements_controller.try_out)
    window.assessment_controller.assessed.connect(window.strip.set_verdict)
    window.strip.why_asked.connect(window.diagnosis_controller.ask)
    window.lines.elastic_asked.connect(window.elastic_assignment_controller.show)
    symmetry.targets_proposed.connect(window.ask_desk.begin)
    symmetry.map_asked.connect(window.map_desk.choose)
    window.report_controller.action.triggered.connect(window.uncertainty_controller.follow)
    session.failed.connect(lambda _: window.throttled.repeat() if session.failure is not None else None)
    session.failed.connect(scan_desk.show_refused)
    session.asked.connect(scan_desk.show_stuck)


def _connect_project(window: MainWindow) -> None:
    project = window.project_controller
    project.titled.connect(window.show_title)
    project.save_state.connect(window.status.set_saved)
    project.opening.connect(window.lines.show_opening)


def _connect_safe(window: MainWindow) -> None:
    window.session.undo_stack.indexChanged.connect(lambda _: forget_refused())
    window.pressure_controller.changed.connect(window.assessment_controller.refresh)
    window.pressure_controller.changed.connect(window.variant_table_controller.follow)


def _connect_panels(window: MainWindow) -> None:
    session, project, scan_desk = window.session, window.project_controller, window.scan_desk
    window.lines.opened.connect(window.lines_desk.show_rows)
    window.pressure_controller.changed.connect(window.lines_desk.show_rows)
    window.lines.length_previewed.connect(session.preview_line)
    window.lines.length_committed.connect(window.lines_desk.commit_length)
    window.lines.drag_cancelled.connect(lambda _: session.cancel_preview())
    window.lines.selected.connect(window.selection.select_line)
    window.lines.visibility_changed.connect(window.lines_desk.set_visible)
    window.lines.decided.connect(window.lines_desk.decide)
    window.lines.reset_all.connect(session.reset_lines)
    window.lines.add_asked.connect(window.line_maker.show_menu)
    window.lines.presets_asked.connect(window.preset_desk.show_menu)
    window.lines.draw_asked.connect(window.line_drawing.begin)
    window.lines.path_asked.connect(window.line_routing.begin)
    window.lines.removed.connect(window.lines_desk.remove)
    window.model.left.connect(lambda: window.layout_.go_on_in("lines"))
    window.scan.open_asked.connect(project.open)
    window.scan.told.connect(scan_desk.tell)
    window.scan.edits.edited.connect(scan_desk.edit)
    window.scan.lean.leaned.connect(scan_desk.lean)
    window.scan.lean.up_chosen.connect(scan_desk.stand_upright)
    window.scan.front_asked.connect(scan_desk.ask)


def _connect_start(window: MainWindow) -> None:
    window.lines_page.currentChanged.connect(lambda at: window.recovery_controller.set_aside(at > 0))
    window.start_controller.page.guide_asked.connect(window.help_controller.show_first_steps)


def _connect_view(window: MainWindow) -> None:
    scan_desk, view = window.scan_desk, window.view
    window.navigation.page_shown.connect(window._show_page)
    selection = window.selection
    for select in (window.lines.select, window.garment.select, view.select_line):
        selection.line_selected.connect(select)
    for select in (window.landmarks.select, view.pins.select):
        selection.landmark_selected.connect(select)
    view.viewport.band_clicked.connect(window.selection.select_line)
    view.question.answered.connect(scan_desk.answer)
    view.question.left.connect(scan_desk.leave_question)
    view.tools.view_chosen.connect(view.viewport.set_view)
    view.tools.fit_asked.connect(view.viewport.frame_all)
    view.tools.toggled.connect(view.set_layer)
    view.compare.way_chosen.connect(view.compare_by)
    view.compare.toggled.connect(view.set_layer)


def _connect_maps(window: MainWindow) -> None:
    maps, section, view = window.map_desk, window.section_desk, window.view
    tools = view.tools.actions_by_name
    tools["map"].triggered.connect(maps.toggle)
    tools["next-map"].triggered.connect(maps.cycle)
    tools["section"].triggered.connect(section.set_on)
    maps.changed.connect(section.refresh)
    maps.changed.connect(lambda: window.symmetry_controller.show_map(maps.name))
    maps.changed.connect(lambda: window.scan_comparison_controller.show_map(maps.name))
    maps.changed.connect(lambda: window.view_controller.show_map(maps.name))
    window.scan_comparison_controller.map_asked.connect(maps.choose)
    window.view_controller.map_chosen.connect(maps.choose)
    window.view_controller.material_shown.connect(maps.refresh)
    window.preferences_controller.material_chosen.connect(window.view_controller.choose_material)
    window.symmetry_controller.changed.connect(maps.refresh)
    window.landmarks.landmark_selected.connect(section.follow_landmark)
    view.viewport.pin_pressed.connect(section.follow_landmark)
    # What the view shows of a frame is there before it is painted and cut.
    for shown in (view.compared, window.lines.visibility_changed):
        shown.connect(lambda *_: maps.follow())
        shown.connect(lambda *_: section.follow())


def _connect_actions(window: MainWindow) -> None:
    session, do = window.session, window.actions_
    do.quit.triggered.connect(window.close)
    do.reset.triggered.connect(session.reset_lines)
    _connect_layout(window)
    do.draw_line.triggered.connect(window.line_drawing.begin)
    do.own_line.triggered.connect(window.line_maker.ask)
    for name, action in do.add_lines.items():
        action.triggered.connect(lambda _=False, name=name: window.line_maker.add(name))


def _connect_layout(window: MainWindow) -> None:
    do, layout = window.actions_, window.layout_
    do.inspector.triggered.connect(layout.show_inspector)
    do.alone.triggered.connect(layout.show_alone)
    do.full_screen.triggered.connect(layout.show_full_screen)
    do.next_pane.triggered.connect(layout.next_pane)
    do.reset_layout.triggered.connect(layout.reset)
    for step, action in do.steps.items():
        action.triggered.connect(lambda _=False, step=step: layout.go_on_in(step))
