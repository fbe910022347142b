"""Belly, buttock points and gluteal folds are dragged on the body while the result is asked for."""

from __future__ import annotations

import numpy as np
import pytest
from ask_tools import answered, drag
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from window_tools import Script, run_undrawn, settled

from app.gui.main_window import MainWindow
from app.presenters.samples import sample_path
from core.garment.presets import find_preset
from core.measurements.lower_trunk import lower_subjects

pytestmark = pytest.mark.usefixtures("empty_house")

LOWER = {"belly", "buttock_left", "buttock_right", "gluteal_fold_left", "gluteal_fold_right"}


def seen(window: MainWindow) -> set[str]:
    """Return the names of the handles that are visible."""
    handles = window.target_shape_controller.handles.by_name
    return {name for name, handle in handles.items() if handle.isVisible()}


def millimetres(window: MainWindow) -> float:
    """Return how many millimetres of the body a pixel shows."""
    viewport = window.view.viewport
    return 2.0 * viewport.view.half_height / viewport.height()


def drags_a_fold(window: MainWindow) -> Script:
    """From behind a fold goes up, and nothing else; applied, the landmark has risen by as much."""
    target, viewport = window.target_shape_controller, window.view.viewport
    assert seen(window) == {"belly"}, "the seat is behind the body"
    viewport.set_view("back")
    assert seen(window) == LOWER - {"belly"}
    fold = target.handles.by_name["gluteal_fold_left"]
    now = target.handles._missing(window.session.frame, "gluteal_fold_left")
    assert not now.any(), "nothing is wished"
    assert not {"fold lift", "fold lift left"} & set(target.wishes)
    drag(fold, 30, -8)
    yield answered(window)
    assert set(target.wishes) == {"waist girth", "hip girth", "fold lift"}, "it goes neither out nor aside"
    before = target.answer.now["fold lift"]
    assert target.wishes["fold lift"] - before == pytest.approx(8.0 * millimetres(window), rel=0.15)
    assert target.card.wishes["fold lift"].result.text(), "the row tells what came of it"
    QTest.keyClick(fold, Qt.Key.Key_Down)
    yield answered(window)
    window.actions_.undo.trigger()
    yield answered(window)
    wish = target.wishes["fold lift"]
    assert wish - before == pytest.approx(8.0 * millimetres(window), rel=0.15), "a step of keys is undone"
    reached = target.answer.reply.reached["fold lift"]
    target.apply()
    yield settled(window)
    assert not seen(window)
    assert "Gluteal fold lift" in window.session.undo_stack.undoText()
    lower = window.session.frame.lower
    rest, after = lower_subjects(lower.stages, lower.control_points)
    names = ("gluteal_fold_left", "gluteal_fold_right")
    rise = np.mean([after.places[name][2] - rest.places[name][2] for name in names])
    # The landmark follows the smoothed skin, the target the vertex that is nearest to it.
    assert rise == pytest.approx(reached, abs=0.5)
    window.session.undo_stack.undo()
    yield settled(window)


def drags_a_buttock_of_one_side(window: MainWindow) -> Script:
    """From the right the back is on the left: to the left is out; unlinked, the other side is free."""
    target, viewport = window.target_shape_controller, window.view.viewport
    target.begin()
    yield answered(window)
    viewport.set_view("right")
    assert seen(window) == {"belly", "buttock_right", "gluteal_fold_right"}
    target.card.link.click()
    now = target.handles
    assert now.by_name["buttock_right"].accessibleName() == "Handle: Buttock point right"
    drag(now.by_name["buttock_right"], -6, 0)
    yield answered(window)
    step = target.wishes["buttock out right"] - target.answer.now["buttock out right"]
    assert step == pytest.approx(6.0 * millimetres(window), rel=0.15)
    assert {name for name in target.wishes if "buttock" in name} == {"buttock out right"}
    # Esc gives back what was wished while it is in the hand.
    before = dict(target.wishes)
    drag(now.by_name["buttock_right"], 0, -20, drop=False)
    assert "buttock lift right" in target.wishes
    window.progress_controller.cancel()
    assert target.wishes == before
    yield answered(window)


def turns_to_the_side_for_the_belly(window: MainWindow) -> Script:
    """From the front the only way of the belly points at the eye: it is looked at from the side first."""
    target, viewport = window.target_shape_controller, window.view.viewport
    viewport.set_view("front")
    belly = target.handles.by_name["belly"]
    drag(belly, 10, 0)
    assert "belly out" not in target.wishes
    yield lambda: viewport.view.name == "left"
    drag(belly, 6, 0)
    yield answered(window)
    step = target.wishes["belly out"] - target.answer.now["belly out"]
    assert step == pytest.approx(-6.0 * millimetres(window), rel=0.15), "to the right is back"
    assert target.handles._missing(window.session.frame, "belly")[1] == pytest.approx(
        target.answer.then["belly out"] - target.wishes["belly out"], abs=0.05
    )
    QTest.keyClick(belly, Qt.Key.Key_Up)
    assert target.wishes["belly out"] - target.answer.now["belly out"] == pytest.approx(step)
    target.leave()
    yield lambda: viewport.view.name == "front"
    yield settled(window)


def test_belly_and_seat_are_dragged() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.layout_.give_up()
        target = window.target_shape_controller
        window.session.edit(lambda d: d.with_line("mid-bust", 0.97), "Bust alone")
        yield settled(window)
        window.view.viewport.set_view("front")
        target.begin()
        yield answered(window)
        assert seen(window) == {"bust_left", "bust_right"}, "below no line is worn"
        target.leave()
        window.session.edit(lambda d: d.with_line("mid-bust", None), "Nothing")
        window.presets_controller.wear(find_preset("butt lifter"))
        yield settled(window)
        target.begin()
        yield answered(window)
        yield from drags_a_fold(window)
        yield from drags_a_buttock_of_one_side(window)
        yield from turns_to_the_side_for_the_belly(window)

    run_undrawn([str(sample_path("trunk"))], script)
