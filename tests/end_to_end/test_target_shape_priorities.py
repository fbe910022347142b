"""Priorities, inactive lines and conflicts on the card of targets; keys that are typed while it is open."""

from __future__ import annotations

import pytest
from ask_tools import answered, wear
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from window_tools import Script, run_bodiless, settled

from app.gui.main_window import MainWindow
from core.analysis.inverse_design.quantity import Goal

pytestmark = pytest.mark.usefixtures("empty_house")


def names_the_conflict_and_follows_priorities(window: MainWindow) -> Script:
    yield settled(window)
    yield wear(window)
    desk, card = window.target_shape_controller, window.target_shape_controller.card
    desk.begin([Goal("out", -6.0), Goal("girth", 874.0)])
    yield answered(window)
    first = dict(desk.answer.reply.reached)
    assert "conflicts with" in card.changes.text()
    card.wishes["out"].prioritized.emit("high")
    yield answered(window)
    assert abs(desk.answer.reply.reached["out"] + 6.0) < abs(first["out"] + 6.0)
    assert card.wishes["out"].priority.text() == "Priority: High"
    window.undo_group.undo()
    yield answered(window)
    assert desk.answer.reply.reached == pytest.approx(first, abs=0.01)
    # Keys that are typed while the card is open are no commands of the view.
    window.layout_.give_up()
    heading = window.view.viewport.heading
    window.view.viewport.setFocus(Qt.FocusReason.OtherFocusReason)
    for key in (Qt.Key.Key_6, Qt.Key.Key_0, Qt.Key.Key_3):
        QTest.keyClick(window.view.viewport, key)
    assert window.view.viewport.heading == heading
    desk.leave()
    desk.begin([Goal("out", -6.0, "high"), Goal("girth", 874.0)])
    assert [goal.priority for goal in desk.goals()] == ["high", "normal"]
    yield answered(window)
    desk.leave()
    # A line that is off is switched on where it helps, and only if it may be.
    window.session.edit(lambda d: d.with_line("full-bust", None), "Off")
    yield settled(window)
    desk.begin([Goal("girth", 858.0)])
    yield answered(window)
    assert desk.answer.reply.design.active_lines() == {"mid-bust"}
    assert "Full bust" in card.optional.toolTip()
    card.optional.click()
    yield answered(window)
    assert "full-bust" in desk.answer.reply.design.active_lines()
    assert "Activated: Full bust." in card.changes.text()
    desk.leave()
    yield settled(window)


def test_conflicts_are_named_and_priorities_followed() -> None:
    def script(window: MainWindow) -> Script:
        yield from names_the_conflict_and_follows_priorities(window)

    run_bodiless([], script)
