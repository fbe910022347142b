"""Asking for the result in the window: typed, seen on the body, taken as one step or left without a trace."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from ask_tools import answered, drag, type_wish, wear
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from window_tools import Script, points, run_undrawn, settled

from app.gui.main_window import MainWindow
from core.analysis.inverse_design.quantity import Goal
from core.document.design import Design
from core.document.storage.project_file import open_project
from core.garment.elastic_library import find_elastic

pytestmark = pytest.mark.usefixtures("empty_house")


def figure(words: str) -> float:
    """Return a number as it is written in the window."""
    return float(words.replace("\N{MINUS SIGN}", "-"))


def ratios(design: Design | None) -> dict[str, float]:
    assert design is not None
    return {line.name: line.ratio for line in design.lines}


def is_typed_seen_taken_and_undone_or_left(window: MainWindow) -> Script:
    yield settled(window)
    yield wear(window)
    before, at = window.session.design, points(window).copy()
    window.ask_door.click()
    card = window.target_shape_controller.card
    assert card.isVisible()
    assert list(card.wishes) == ["lift", "out", "pressure"]
    yield answered(window)
    assert card.wishes["out"].field.placeholderText() == "no target"
    assert not card.apply.isEnabled(), "nothing is wished yet"
    assert card.wishes["lift"].field.text() == "", "nothing is asked for yet"
    now = window.target_shape_controller.answer.now["out"]
    assert figure(card.wishes["out"].now.text()) == pytest.approx(now, abs=0.06)
    type_wish(window, "out", "-4")
    yield answered(window)
    assert card.answer.text() == "All targets reached."
    assert "Mid-bust 97.0 → " in card.changes.text() or "Full bust 98.0 → " in card.changes.text()
    result, change = card.wishes["out"].result.text().split(" ")
    assert figure(result) == -4.0
    assert figure(change.strip("()")) == pytest.approx(-4.0 - now, abs=0.11)
    assert window.session.design is before, "seen, not taken"
    assert np.abs(points(window) - at).max() > 0.5
    steps = window.session.undo_stack.count()
    card.apply.click()
    assert not card.isVisible()
    yield settled(window)
    assert window.session.undo_stack.count() == steps + 1
    assert window.session.undo_stack.undoText() == "Targets: Bust point, forward −4.0 mm"
    marks, rest = window.session.frame.exact_marks, window.session.frame.stages.rest_marks
    outs = [
        marks.bust_point_left_out - rest.bust_point_left_out,
        marks.bust_point_right_out - rest.bust_point_right_out,
    ]
    assert np.mean(outs) == pytest.approx(-4.0, abs=0.06)
    window.session.undo_stack.undo()
    yield settled(window)
    assert ratios(window.session.design) == ratios(before)
    # Left, the body is as before.
    window.layout_.give_up()  # the tour of a first start
    for leave in (card.cancel.click, lambda: QTest.keyClick(window, Qt.Key.Key_Escape)):
        window.target_shape_controller.begin([Goal("out", -5.0)])
        yield answered(window)
        assert np.abs(points(window) - at).max() > 0.5
        leave()
        assert not window.target_shape_controller.is_open
        yield settled(window)
        assert np.abs(points(window) - at).max() < 0.01
    assert window.session.undo_stack.count() == steps + 1


def lock(design: Design, name: str) -> Design:
    return design.with_line_settings(replace(design.line_settings(name), locked=True))


def made(design: Design) -> Design:
    plush = find_elastic("plush 12")
    for name in ("mid-bust", "full-bust"):
        design = design.with_line(name, 0.8).with_elastic(name, plush)
    return design


def tells_what_keeps_a_wish_from_being_met(window: MainWindow) -> Script:
    yield settled(window)
    desk, card = window.target_shape_controller, window.target_shape_controller.card
    window.session.reset_lines()
    desk.begin()
    assert not card.apply.isVisible()
    assert card.help_.isVisible()
    assert "choose a preset" in card.hint.text()
    yield wear(window)
    yield answered(window)
    assert card.apply.isVisible()
    desk.add("girth")
    desk.wish("girth", 1200.0)
    yield answered(window)
    assert card.answer.text().startswith("Not reachable. Closest result: Bust girth ")
    assert "Stopped at a limit: Mid-bust: longest length, 99.9 %" in card.answer.text()
    assert set(ratios(desk.answer.reply.design).values()) == {0.999}, "no line is off"
    desk.drop("girth")
    yield answered(window)
    assert card.answer.text() == ""
    # A locked line stays.
    window.session.edit(lambda d: lock(d, "mid-bust"), "Lock it")
    desk.wish("out", -4.0)
    yield answered(window)
    assert card.note.text() == "Locked, not changed: Mid-bust."
    assert desk.answer.reply.design.ratio("mid-bust") == 0.97
    window.session.edit(lambda d: lock(d, "full-bust"), "Lock it too")
    assert "All active lines are locked" in card.hint.text()
    assert card.help_.text() == "Unlock lines", "other lines are not what is missing"
    card.help_.click()
    yield answered(window)
    assert set(ratios(desk.answer.reply.design)) == {"mid-bust", "full-bust"}
    assert card.note.text() == ""
    desk.leave()
    yield settled(window)


def loses_nothing_meanwhile(window: MainWindow, tmp_path: Path) -> Script:
    yield settled(window)
    yield wear(window)
    desk = window.target_shape_controller
    desk.begin([Goal("out", -4.0)])
    yield answered(window)
    first = ratios(desk.answer.reply.design)
    path = str(tmp_path / "meanwhile.busk")
    window.session.save(path, None)
    yield lambda: not window.session.unsaved
    assert ratios(open_project(path).design) == {"mid-bust": 0.97, "full-bust": 0.98}, "what is taken"
    assert window.status._saved.text().endswith("(pending targets not included)")
    # Another edit: asked again from there, the wish as it was.
    window.session.edit(lambda d: d.with_line("mid-bust", None), "Off")
    yield answered(window)
    assert desk.goals() == (Goal("out", -4.0),)
    assert set(ratios(desk.answer.reply.design)) == {"full-bust"} != set(first)
    window.session.undo_stack.undo()
    yield answered(window)
    assert ratios(desk.answer.reply.design) == pytest.approx(first, abs=1e-4)
    # The same lift with less pressure is a wish of its own.
    window.session.edit(made, "Elastics")
    desk.begin()
    yield answered(window)
    before = max(desk.answer.presses.values())
    assert figure(desk.card.wishes["pressure"].now.text()) == pytest.approx(before, abs=0.06)
    type_wish(window, "pressure", "1")
    yield answered(window)
    assert [goal.name for goal in desk.goals()] == ["lift"], "the same, unless another is wished"
    assert max(desk.answer.reply.pressure.values()) < 1.02 < before
    said = desk.card.answer.text()
    assert said.startswith("Contact pressure at most ")
    assert "kPa; result: Bust point lift " in said
    assert desk.card.wishes["lift"].field.text() == "", "it is not what was asked for"
    window.session.undo_stack.setClean()
    window.project_controller.open_sample("person")
    yield lambda: not desk.is_open
    yield settled(window)
    assert window.session.design.scan.name != "mannequin.ply"


def drags_the_bust_point(window: MainWindow) -> Script:
    yield settled(window)
    yield wear(window)
    window.layout_.give_up()
    desk, viewport = window.target_shape_controller, window.view.viewport
    viewport.set_view("left")
    desk.begin()
    yield answered(window)
    left, right = (desk.handles.by_name[f"bust_{side}"] for side in ("left", "right"))
    assert (left.isVisible(), right.isVisible()) == (True, False), "the far one is behind the body"
    now = dict(desk.answer.now)
    # Seen from the left the front is on the left: to the right is in.
    drag(left, 20, -10)
    yield answered(window)
    scale = 2.0 * viewport.view.half_height / viewport.height()
    assert set(desk.wishes) == {"lift", "out"}
    assert desk.wishes["lift"] - now["lift"] == pytest.approx(10.0 * scale, rel=0.15)
    assert desk.wishes["out"] - now["out"] == pytest.approx(-20.0 * scale, rel=0.15)
    assert desk.answer.reply is not None
    assert not desk.answer.question.hurried, "at rest the best lengths are looked for"
    # Straight up is up, and no wish for what was free.
    desk.drop("out")
    desk.add("out")
    yield answered(window)
    drag(left, 1, -20)
    assert desk.wishes["out"] is None
    drag(left, 20, -10)
    yield answered(window)
    # While it is in the hand it answers in a hurry; Esc gives back what was wished.
    desk.wish("lift", 20.0)
    yield answered(window)
    before = dict(desk.wishes)
    drag(left, 0, -30, fine=True, drop=False)
    assert desk.wishes["lift"] - before["lift"] == pytest.approx(3.0 * scale, rel=0.15)
    assert window.actions_.cancel.isEnabled()
    window.progress_controller.cancel()
    assert desk.wishes == before
    yield answered(window)
    # From the front it goes up and down, and nothing else; by keys a millimetre.
    viewport.set_view("front")
    assert right.isVisible()
    drag(right, 40, -10)
    assert desk.wishes["out"] == before["out"]
    raised = desk.wishes["lift"]
    assert raised > before["lift"]
    QTest.keyClick(right, Qt.Key.Key_Down)
    QTest.keyClick(right, Qt.Key.Key_Up, Qt.KeyboardModifier.ShiftModifier)
    assert desk.wishes["lift"] == pytest.approx(raised + 4.0)
    # Set apart, each goes its own way.
    desk.card.link.click()
    QTest.keyClick(right, Qt.Key.Key_Up)
    assert set(desk.wishes) == {"out", "lift right"}
    desk.leave()
    assert not left.isVisible()
    yield settled(window)


def sends_to_apply_or_cancel(window: MainWindow) -> Script:
    """Nothing waits for ever while it is open: measures are of what is seen, the sheet says what to do."""
    yield wear(window)
    desk = window.target_shape_controller
    desk.begin([Goal("out", -4.0)])
    yield answered(window)
    window.report_controller.open()
    assert "Apply or cancel the pending targets" in window.report_controller.page.state.text()
    window.report_controller.leave()
    window.navigation.show_step("result")
    yield lambda: bool(window.result.measured) and not window.result.stale
    assert desk.is_tried_on
    window.navigation.show_step("landmarks")
    assert not desk.is_open, "its handles are of the reshaped body"
    window.navigation.show_step("lines")
    yield settled(window)


def test_the_result_is_asked_for(tmp_path: Path) -> None:
    def script(window: MainWindow) -> Script:
        yield from is_typed_seen_taken_and_undone_or_left(window)
        yield from tells_what_keeps_a_wish_from_being_met(window)
        yield from sends_to_apply_or_cancel(window)
        yield from drags_the_bust_point(window)
        yield from loses_nothing_meanwhile(window, tmp_path)

    run_undrawn([], script)
