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
    _connect_plots(window)
    _connect_maps(window)


def _connect_work(window: MainWindow) -> None:
    job_desk = window.job_desk
    window.session.working.connect(job_desk.show_work)
    window.lines_desk.leeways = window.limits_desk.leeways
    window.jobs.changed.connect(job_desk.show)
    window.view.busy.cancelled.connect(job_desk.cancel)
    window.status.job_cancelled.connect(job_desk.cancel)
    window.actions_.cancel.triggered.connect(job_desk.cancel)


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
    session.design_changed.connect(lambda *_: window.worn_desk.follow())
    session.failed.connect(lambda *_: window.pressure_desk.found.emit())
    uncertainty, symmetry, result = window.uncertainty_controller, window.symmetry_controller, window.result
    uncertainty.changed.connect(window.measures_desk.show_spread)
    uncertainty.changed.connect(window.section_desk.show_spread)
    uncertainty.changed.connect(window.report_desk.follow)
    uncertainty.changed.connect(symmetry.follow)
    uncertainty.summarized.connect(result.show_summary)
    result.summary_clicked.connect(lambda: result.bring(uncertainty.card))
    result.opened.connect(uncertainty.follow)
    result.opened.connect(symmetry.open)
    symmetry.targets_proposed.connect(window.ask_desk.begin)
    symmetry.map_asked.connect(window.map_desk.choose)
    window.report_desk.action.triggered.connect(window.uncertainty_controller.follow)
    session.design_changed.connect(lambda *_: window.report_desk.follow())
    session.failed.connect(lambda *_: window.report_desk.follow())
    session.failed.connect(lambda _: window.throttled.repeat() if session.failure is not None else None)
    session.failed.connect(window.doctor_desk.refuse)
    session.failed.connect(scan_desk.show_refused)
    session.asked.connect(scan_desk.show_stuck)


def _connect_project(window: MainWindow) -> None:
    project = window.project_controller
    project.titled.connect(window.show_title)
    project.save_state.connect(window.status.set_saved)


def _connect_safe(window: MainWindow) -> None:
    session, safe, history = window.session, window.keeping_desk, window.history_desk
    stack = session.undo_stack
    stack.indexChanged.connect(lambda _: forget_refused())
    session.saved.connect(safe.show_saved)
    session.design_changed.connect(safe.note)
    session.design_changed.connect(history.show_snapshots)
    session.design_changed.connect(window.variant_desk.show_variants)
    for changed in (session.design_changed, window.variant_desk.solved):
        changed.connect(lambda *_: window.variant_figures.follow())
    window.pressure_desk.found.connect(window.verdict_desk.refresh)
    window.pressure_desk.found.connect(window.variant_figures.follow)
    stack.cleanChanged.connect(safe.note)
    stack.indexChanged.connect(history.show_edits)
    window.history.jumped.connect(history.jump)
    window.history.restored.connect(history.restore)


def _connect_panels(window: MainWindow) -> None:
    session, project, scan_desk = window.session, window.project_controller, window.scan_desk
    window.lines.opened.connect(window.lines_desk.show_rows)
    window.pressure_desk.found.connect(window.lines_desk.show_rows)
    window.lines.length_previewed.connect(session.preview_line)
    window.lines.length_committed.connect(window.lines_desk.commit_length)
    window.lines.drag_cancelled.connect(lambda _: session.cancel_preview())
    window.lines.selected.connect(window.selection.select_line)
    window.lines.visibility_changed.connect(window.lines_desk.set_visible)
    window.lines.decided.connect(window.lines_desk.decide)
    window.lines.reset_all.connect(session.reset_lines)
    window.strip.control_chosen.connect(session.choose_control)
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
    session, project, start = window.session, window.project_controller, window.start_desk
    for changed in (session.working, session.failed, session.asked):
        changed.connect(lambda *_: window.opening_desk.follow())
    session.working.connect(start.show_work)
    session.failed.connect(start.show_failure)
    session.asked.connect(start.leave_page)
    start.page.open_asked.connect(project.open)
    start.page.sample_asked.connect(project.open_sample)
    start.page.tour_asked.connect(start.take_tour)
    start.page.guide_asked.connect(window.help.show_first_steps)
    start.page.project_chosen.connect(project.open_file)
    start.page.locate_asked.connect(start.locate)
    start.page.forget_asked.connect(start.forget)
    start.page.left.connect(start.leave_page)


def _connect_plots(window: MainWindow) -> None:
    plots = window.plot_desk
    window.strip.export_asked.connect(plots.export)
    window.strip.quantity_chosen.connect(plots.keep_quantity)
    plots.slow.toggled.connect(plots.set_slow)


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
    view.tools.picture_asked.connect(window.picture_desk.save)
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
    maps.changed.connect(window.worn_desk.follow)
    window.symmetry_controller.changed.connect(maps.refresh)
    window.landmarks.landmark_selected.connect(section.follow_landmark)
    view.viewport.pin_pressed.connect(section.follow_landmark)
    # What the view shows of a frame is there before it is painted and cut.
    for shown in (view.compared, window.lines.visibility_changed):
        shown.connect(lambda *_: maps.follow())
        shown.connect(lambda *_: section.follow())


def _connect_actions(window: MainWindow) -> None:
    session, do = window.session, window.actions_
    do.export.triggered.connect(window.export_desk.export_body)
    do.export_any.triggered.connect(window.export_desk.show)
    do.quit.triggered.connect(window.close)
    do.reset.triggered.connect(session.reset_lines)
    _connect_layout(window)
    do.strip.toggled.connect(lambda on: window.strip.set_folded(not on))
    window.strip.folded.connect(lambda folded: do.strip.setChecked(not folded))
    do.draw_line.triggered.connect(window.line_drawing.begin)
    do.own_line.triggered.connect(window.line_maker.ask)
    for group, ask in (
        (do.add_lines, window.line_maker.add),
        (do.themes, lambda theme: window.preferences.choose("theme", theme)),
        (do.languages, lambda language: window.preferences.choose("language", language)),
    ):
        for name, action in group.items():
            action.triggered.connect(lambda _=False, ask=ask, name=name: ask(name))


def _connect_layout(window: MainWindow) -> None:
    do, layout = window.actions_, window.layout_
    do.inspector.triggered.connect(layout.show_inspector)
    do.alone.triggered.connect(layout.show_alone)
    do.full_screen.triggered.connect(layout.show_full_screen)
    do.next_pane.triggered.connect(layout.next_pane)
    do.reset_layout.triggered.connect(layout.reset)
    for step, action in do.steps.items():
        action.triggered.connect(lambda _=False, step=step: layout.go_on_in(step))
