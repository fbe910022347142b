"""What is still being typed while the result is asked for: Apply takes it, and no row is laid twice."""

from __future__ import annotations

import pytest
from ask_tools import answered, type_wish, wear
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from window_tools import Script, run_bodiless, settled

from app.gui.main_window import MainWindow
from app.gui.widgets.value_edit import ValueEdit
from core.analysis.inverse_design.quantity import Goal

pytestmark = pytest.mark.usefixtures("empty_house")


def half_typed(window: MainWindow, key: str, text: str) -> ValueEdit:
    """Type over a field and stay in it."""
    field = window.target_shape_controller.card.wishes[key].field
    field.setFocus()
    field.selectAll()
    QTest.keyClicks(field, text)
    assert field.hasFocus()
    return field


def click(button: object) -> None:
    QTest.mouseClick(button, Qt.MouseButton.LeftButton)


def is_applied_as_it_is_typed(window: MainWindow) -> Script:
    desk, card = window.target_shape_controller, window.target_shape_controller.card
    desk.begin()
    yield answered(window)
    half_typed(window, "out", "-5")
    assert card.apply.isEnabled(), "it need not be entered first"
    type_wish(window, "out", "-5")
    yield answered(window)
    assert (card.answer.text(), card.answer.property("tone")) == ("All targets reached.", "ok")
    field = half_typed(window, "out", "-4")
    assert card.answer.property("tone") == "faint", "it answers what is typed over"
    QTest.keyClick(field, Qt.Key.Key_Escape)
    assert card.answer.property("tone") == "ok"
    half_typed(window, "out", "-4")
    click(card.apply)
    yield lambda: not desk.is_open
    yield settled(window)
    assert window.session.undo_stack.undoText() == "Targets: Bust point, forward −4.0 mm"
    window.session.undo_stack.undo()
    yield settled(window)


def is_not_applied_unseen_where_it_cannot_be_had(window: MainWindow) -> Script:
    desk, card, before = (
        window.target_shape_controller,
        window.target_shape_controller.card,
        window.session.design,
    )
    desk.begin()
    yield answered(window)
    half_typed(window, "out", "40")
    click(card.apply)
    yield answered(window)
    assert desk.is_open, "what is nearest is seen first"
    assert card.answer.text().startswith("Not reachable")
    assert window.session.design is before
    half_typed(window, "out", "--")
    click(card.apply)
    assert desk.is_open
    assert card.wishes["out"].field.refused, "what is no figure is said to be none"
    desk.leave()
    assert desk.goals() == (Goal("out", 40.0),), "what was left is not asked for"
    yield settled(window)


def rows(window: MainWindow) -> int:
    """Return how many rows of wishes are to be seen, whoever keeps them."""
    fields = window.target_shape_controller.card.findChildren(ValueEdit)
    return sum(field.isVisible() for field in fields)


def is_laid_once(window: MainWindow) -> Script:
    desk, card = window.target_shape_controller, window.target_shape_controller.card
    for _ in range(2):
        desk.begin()
        yield answered(window)
        half_typed(window, "lift", "2")
        click(card.hand.button("profile"))
        yield answered(window)
        assert desk.wishes["lift"] == 2.0, "what was typed is asked for"
        assert list(card.wishes) == ["lift", "out", "profile left", "pressure"]
        assert rows(window) == 3
        click(card.hand.button("apex"))
        half_typed(window, "apex lift", "3")
        click(card.wishes["apex out"].remove)
        assert desk.wishes["apex lift"] == 3.0
        half_typed(window, "lift", "7")
        desk.drop("lift")  # the row goes with what is typed in it
        assert "lift" not in desk.wishes
        yield answered(window)
        assert rows(window) == len([row for row in card.wishes.values() if row.field.isVisible()])
        desk.leave()
        yield settled(window)


def leaves_the_keyboard_where_it_was_pressed(window: MainWindow) -> Script:
    desk, card = window.target_shape_controller, window.target_shape_controller.card
    desk.begin()
    yield answered(window)
    assert card.wishes["lift"].field.hasFocus()
    click(card.hand.button("apex"))
    yield answered(window)
    assert card.hand.button("apex").hasFocus(), "a space would not open a menu"
    desk.leave()
    yield settled(window)


def takes_no_letters(window: MainWindow) -> Script:
    desk = window.target_shape_controller
    desk.begin()
    yield answered(window)
    field = half_typed(window, "lift", "2.5a")
    assert field.text() == "2.5"
    QTest.keyClicks(field, " mm")
    assert field.text() == "2.5 mm"
    desk.leave()
    yield settled(window)


def test_what_is_still_typed_counts() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        yield wear(window)
        window.layout_.give_up()
        window.activateWindow()
        yield window.isActiveWindow
        yield from is_applied_as_it_is_typed(window)
        yield from is_not_applied_unseen_where_it_cannot_be_had(window)
        yield from is_laid_once(window)
        yield from leaves_the_keyboard_where_it_was_pressed(window)
        yield from takes_no_letters(window)

    run_bodiless([], script)
