"""Drawing a profile in a small window, with a camera that flies: from its side, over the tools, and back."""

from __future__ import annotations

import numpy as np
import pytest
from ask_tools import answered, drag, type_wish, wear
from window_tools import Script, run_undrawn, settled

from app.gui.main_window import MainWindow
from core.analysis.inverse_design.quantity import Goal

pytestmark = pytest.mark.usefixtures("empty_house")


def handles(window: MainWindow) -> list:
    return window.target_shape_controller.handles.profile.handles["profile left"]


def landed(window: MainWindow) -> bool:
    viewport = window.view.viewport
    return viewport.heading == viewport.view and not viewport._glide.running


def room_below(window: MainWindow) -> int:
    """Return how far the lowest handle of the profile is over the tools [px]."""
    view = window.view
    low = max(handle.mapTo(view, handle.rect().bottomLeft()).y() for handle in handles(window))
    return view.floating.seen(view.tools).top() - low


def over_the_tools(window: MainWindow) -> bool:
    """Whether all handles of the profile can be taken."""
    seen = all(handle.isVisible() and handle.y() >= 0 for handle in handles(window))
    return seen and room_below(window) > 0


def is_drawn_from_its_side(window: MainWindow) -> Script:
    desk, viewport = window.target_shape_controller, window.view.viewport
    viewport.motion = True
    viewport.set_view("three-quarter")
    yield lambda: landed(window)
    viewport.setFocus()
    before = viewport.view
    desk.begin()
    yield answered(window)
    desk.card.hand._buttons["profile"].click()
    yield answered(window)
    yield lambda: landed(window)
    assert viewport.view.name == "left"
    assert viewport.view.parallel, "the curve lies on the outline of the body"
    assert not window.view.tools.actions_by_name["perspective"].isChecked()
    yield lambda: over_the_tools(window)
    desk.card.cancel.click()
    yield lambda: landed(window)
    assert viewport.view == before, "the camera is back"
    assert window.view.tools.actions_by_name["perspective"].isChecked()
    assert window.focusWidget() is viewport, "the next space flips the body"
    viewport.motion = False
    yield settled(window)


def is_not_dragged_from_elsewhere(window: MainWindow) -> Script:
    desk, viewport = window.target_shape_controller, window.view.viewport
    desk.begin()
    yield answered(window)
    desk.drawing.begin("left")
    yield answered(window)
    viewport.set_view("three-quarter")
    drag(handles(window)[1], -10, -19)
    assert viewport.view.name == "left", "the view turns first"
    assert desk.goals() == ()
    drag(handles(window)[1], -4, -4)
    yield answered(window)
    assert len(desk.goals()) > 10
    assert {goal.name for goal in desk.goals()} <= set(desk.answer.now), "it is known how far it was off"
    assert over_the_tools(window)
    # Who has turned the view himself keeps it.
    viewport.set_view("front")
    desk.leave()
    assert viewport.view.name == "front"
    assert not viewport.view.parallel
    yield settled(window)


def is_taken_back_step_by_step(window: MainWindow) -> Script:
    desk, do, design = window.target_shape_controller, window.actions_, window.session.design
    steps = window.session.undo_stack.index()
    desk.begin()
    yield answered(window)
    assert do.undo.text() == "Undo Wear them", "nothing is asked for yet"
    type_wish(window, "lift", "4")
    yield answered(window)
    assert do.undo.text() == "Undo Bust point lift"
    desk.drawing.begin("left")
    yield answered(window)
    drag(handles(window)[1], -4, -4)
    drag(handles(window)[2], 3, 0)
    wished = desk.goals()
    do.undo.trigger()
    assert desk.drawn["profile left"].manual_handles == {1}, "the last drag is taken back"
    do.undo.trigger()
    assert desk.goals() == (Goal("lift", 4.0),)
    do.undo.trigger()
    assert not desk.drawn
    assert desk.handles.kind == "bust"
    do.undo.trigger()
    assert desk.goals() == ()
    assert not do.undo.isEnabled(), "what is asked for leaves the design alone"
    for _ in range(4):
        do.redo.trigger()
    assert desk.goals() == wished
    assert desk.handles.kind == "profile"
    yield answered(window)
    # The design edited meanwhile is what undo means next; the wishes stay.
    window.session.edit(lambda each: each.with_line("mid-bust", 0.96), "Shorter")
    assert do.undo.text() == "Undo Shorter"
    do.undo.trigger()
    assert desk.goals() == wished
    yield answered(window)
    desk.leave()
    assert window.session.design == design
    assert window.session.undo_stack.index() == steps
    assert do.undo.text() == "Undo Wear them"
    yield settled(window)


def is_the_skin_as_long_as_it_is_free(window: MainWindow) -> Script:
    desk = window.target_shape_controller
    desk.begin()
    yield answered(window)
    desk.drawing.begin("left")
    yield answered(window)
    assert "Drag the handles of the curve" in desk.card.hint.text()
    was = desk.drawn["profile left"].base
    type_wish(window, "out", "-4")
    yield answered(window)
    assert "Drag the handles of the curve" in desk.card.hint.text(), "it tells what the dots are"
    curve = desk.handles.profile._curves["profile left"]
    assert np.abs(curve._wished - curve._reached).max() < 0.01
    now = desk.drawn["profile left"].base
    assert np.abs(np.interp(was[:, 0], *now.T) - was[:, 1]).max() > 1.0, "the body has moved"
    section = window.sections_controller
    section.set_on(True)
    section.go_through("left")
    assert section.panel.keys._roles == ["before", "after"]
    drag(handles(window)[1], -4, -4)
    yield answered(window)
    assert desk.card.hint.isHidden()
    # The section through the same place has it too.
    section.refresh()
    (wished,) = section.panel.plot._drawn.curves["wished"]
    assert wished == pytest.approx(desk.drawn["profile left"].curve[:, ::-1])
    assert section.panel.keys._roles == ["before", "after", "wished"]
    section.go_through("right")
    assert section.panel.keys._roles == ["before", "after"]
    section.go_through("left")
    desk.leave()
    yield settled(window)
    section.refresh()
    assert section.panel.keys._roles == ["before", "after"]


def test_a_profile_is_drawn_from_its_side_and_taken_back() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        yield wear(window)
        window.layout_.give_up()
        yield from is_drawn_from_its_side(window)
        yield from is_not_dragged_from_elsewhere(window)
        yield from is_taken_back_step_by_step(window)
        yield from is_the_skin_as_long_as_it_is_free(window)

    run_undrawn([], script)
