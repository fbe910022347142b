"""Where targets are in the window: rows keep their places, the bust is in sight, pressures are limited."""

from __future__ import annotations

import math

import pytest
from ask_tools import answered, type_wish, wear
from PySide6.QtCore import QCoreApplication, QEvent, QPoint
from window_tools import Script, run_undrawn, settled

from app.gui.main_window import MainWindow
from core.garment.pressure import pressure_limits

pytestmark = pytest.mark.usefixtures("empty_house")


def places(window: MainWindow) -> dict[str, tuple[int, int, int]]:
    """Return where each row is in the window and how high, and the heading of the columns, once laid out."""
    for _ in range(3):  # a scroll bar that goes asks for another pass
        QCoreApplication.sendPostedEvents(None, QEvent.Type.LayoutRequest)
    card = window.target_shape_controller.card
    parts = {**card.wishes, "heading": card._heading, "add": card.add, "apply": card.apply}
    return {name: (*part.mapTo(window, QPoint()).toTuple(), part.height()) for name, part in parts.items()}


def keeps_its_rows_where_they_are(window: MainWindow) -> Script:
    desk, card = window.target_shape_controller, window.target_shape_controller.card
    desk.begin()
    desk.add("girth")
    yield answered(window)
    before = places(window)
    for key, text in (("lift", "12"), ("girth", "815"), ("out", "-4")):
        type_wish(window, key, text)
        assert places(window) == before, "it is typed"
        yield lambda: bool(card.answer.text())
        yield answered(window)
        assert card.wishes[key].result.text()
        assert places(window) == before, "it is answered"
    assert card.changes.text(), "it is answered at length"
    desk.leave()
    yield settled(window)


def leaves_the_bust_in_sight(window: MainWindow) -> Script:
    desk, view = window.target_shape_controller, window.view
    for width, height in ((1180, 700), (1600, 1000)):
        window.resize(width, height)
        desk.begin()
        yield answered(window)
        over = [view.floating.seen(panel) for panel in (view.tools, view.compare) if panel.isVisible()]
        for handle in desk.handles.by_name.values():
            spot = handle.mapTo(view, handle.rect().center())
            assert handle.isVisible()
            assert view.rect().contains(spot)
            assert not any(room.contains(spot) for room in over)
        window.navigation.show_step("result")
        assert desk.is_open, "measures can be looked at meanwhile"
        window.navigation.show_step("lines")
        assert desk.card.isVisible()
        desk.leave()
    yield settled(window)


def keeps_to_the_limit_of_pressure(window: MainWindow) -> Script:
    """It holds from the beginning, what it costs is told, and off it stays off for this body."""
    desk, card, red = (
        window.target_shape_controller,
        window.target_shape_controller.card,
        pressure_limits().red_kpa,
    )
    desk.all_wishes.limit = None
    desk.begin()
    yield answered(window)
    assert card.wishes["pressure"].field.text() == f"{red:.1f}"
    type_wish(window, "out", "-4")
    yield answered(window)
    limited = desk.answer.reply
    assert max(limited.pressure.values()) < red
    assert "contact pressure limit of 4.0 kPa" in card.answer.text()
    assert "without the contact pressure limit" in card.changes.text()
    card.wishes["pressure"].limit.button("off").click()
    yield answered(window)
    assert desk.answer.reply.miss < limited.miss - 0.5
    assert max(desk.answer.reply.pressure.values()) > red
    assert card.wishes["pressure"].field.text() == ""
    window.undo_group.undo()
    yield answered(window)
    assert desk.answer.reply.reached == pytest.approx(limited.reached, abs=0.01)
    card.wishes["pressure"].limit.button("off").click()
    desk.leave()
    desk.begin()
    assert math.isinf(desk.all_wishes.most_kpa)
    desk.leave()
    yield settled(window)


def test_targets_are_set_beside_the_body() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        yield wear(window)
        window.layout_.give_up()
        yield from keeps_its_rows_where_they_are(window)
        yield from leaves_the_bust_in_sight(window)
        yield from keeps_to_the_limit_of_pressure(window)

    run_undrawn([], script)
