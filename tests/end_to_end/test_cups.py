"""Cups in the real window: chosen, shaped, seen as cloth, mapped, and taken back."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from window_tools import Script, run_undrawn, settled

from app.gui.main_window import MainWindow
from app.presenters.bust_shift import bust_shift
from app.rendering.appearance import appearance_of, rgb
from core.garment.cup_fit import WornCups
from tests.end_to_end.test_model_options import choose

pytestmark = pytest.mark.usefixtures("empty_house")


def pulled(window: MainWindow, key: str, value: float) -> None:
    """Drag the handle of a slider of the card to a value, as a hand does."""
    slider = window.cups.rows[key].slider
    middle = slider.height() // 2
    start, end = (QPoint(round(slider.x_of(each)), middle) for each in (slider.amount(), value))
    QTest.mousePress(slider, Qt.MouseButton.LeftButton, pos=start)
    for step in range(1, 6):
        QTest.mouseMove(slider, start + (end - start) * step / 5)
    QTest.mouseRelease(slider, Qt.MouseButton.LeftButton, pos=end)


def lifted(window: MainWindow) -> float:
    return bust_shift(window.session.frame).mean.up


def test_cups_are_chosen_shaped_and_taken_back(person: Path) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        session, card, undo = window.session, window.cups, window.session.undo_stack
        window.model_controller.show()
        choose(window, "tissue", "net")
        window.navigation.show_panel("lines")
        undo.clear()
        assert "from net to solid" in card.notes.text()
        assert not card._body.isVisible()
        card.kind.button("moulded").click()
        assert (session.design.cup.kind, session.design.tissue) == ("moulded", "solid")
        assert undo.undoText() == "Cups: Moulded"
        yield settled(window)
        assert lifted(window) > 3.0
        assert card._body.isVisible()
        assert "net" not in card.notes.text()
        assert [row.isVisible() for row in card.rows.values()] == [True] * 3 + [False] * 3
        before = lifted(window)
        a_drag_is_one_step(window)
        keys_and_typing(window)
        yield settled(window)
        assert lifted(window) > before + 1.0
        rows = [[part.text() for part in row] for row in card.table.rows]
        assert [row[0] for row in rows][:4] == ["Cup − breast volume", "Support", "Wire size", "Wire force"]
        assert rows[0][1][0] in "+\N{MINUS SIGN}"
        while undo.index() > 1:
            window.actions_.undo.trigger()
        window.actions_.undo.trigger()
        assert (session.design.cup, session.design.tissue) == (None, "net")
        assert card.kind.button("").isChecked()

    run_undrawn([str(person)], script)


def a_drag_is_one_step(window: MainWindow) -> None:
    session, undo = window.session, window.session.undo_stack
    pulled(window, "lift", 30.0)
    assert session.design.cup.lift == pytest.approx(30.0, abs=1.0)
    assert undo.index() == 2
    assert undo.undoText() == f"Cups: Lift {session.design.cup.lift:.0f} mm"


def keys_and_typing(window: MainWindow) -> None:
    session, undo = window.session, window.session.undo_stack
    slider, edit = window.cups.rows["forward"].slider, window.cups.rows["forward"].edit
    for _ in range(3):
        QTest.keyClick(slider, Qt.Key.Key_Right)
    assert session.design.cup.forward == 8.0
    assert undo.index() == 3, "steps in quick succession are one"
    edit.selectAll()
    QTest.keyClicks(edit, "99")
    QTest.keyClick(edit, Qt.Key.Key_Return)
    assert edit.refused
    assert session.design.cup.forward == 8.0
    edit.selectAll()
    QTest.keyClicks(edit, "6.5")
    QTest.keyClick(edit, Qt.Key.Key_Return)
    assert session.design.cup.forward == 6.5
    window.cups.wire.click()
    assert undo.undoText() == "Underwire added"


def test_cloth_and_pressure_of_cups_are_seen_and_hidden(person: Path) -> None:
    def script(window: MainWindow) -> Script:
        yield lambda: window.is_settled() and window.view.is_shaded
        scene = window.view.viewport.scene
        assert not scene.cups.is_shown
        window.maps_controller.choose("pressure")
        bare = scene.body.colours.copy()
        window.maps_controller.choose("")
        clay = scene.body.colours.copy()
        assert (bare == clay).all(), "without cups nothing presses on the skin"
        window.cups_controller.kinds["sewn"].trigger()
        assert window.session.design.cup.kind == "sewn"
        yield settled(window)
        assert scene.cups.is_shown
        for hide, show in (
            (lambda: window.view.set_layer("bands", False), lambda: window.view.set_layer("bands", True)),
            (lambda: window.view.set_after(False), lambda: window.view.set_after(True)),
            (lambda: window.maps_controller.choose("pressure"), lambda: window.maps_controller.choose("")),
        ):
            hide()
            assert not scene.cups.is_shown
            show()
            assert scene.cups.is_shown
        window.cups.look.click()
        assert window.maps_controller.name == "pressure"
        zero = rgb(appearance_of(scene.dark, scene.material).clay)
        painted = (np.abs(scene.body._map - zero) > 1.0).any(axis=1)
        assert 0.01 < painted.mean() < 0.3
        covered = WornCups(window.session.frame.stages).share > 0.5
        assert painted[covered].mean() > 0.5 > 5.0 * painted[~covered].mean()
        yield from the_list_counts_cups(window)
        window.cups.kind.button("").click()
        yield settled(window)
        assert not scene.cups.is_shown
        assert (scene.body.colours == clay).all()

    run_undrawn([str(person)], script)


def the_list_counts_cups(window: MainWindow) -> Script:
    window.navigation.show_panel("garment")
    pressures = window.pressure_controller
    yield lambda: pressures.shown is not None
    assert [row.line for row in pressures.shown.rows] == ["cup left", "cup right"]
    assert pressures.shown.highest.max_kpa > 0.1
    maps = window.maps_controller
    maps.look_at_most()
    (pinned,) = maps.pinned
    assert pinned.line == ""
    place = window.view.viewport.scene.body.shown_points[pinned.at]
    assert np.linalg.norm(place - pressures.shown.highest.place) < 25.0
    window.navigation.show_panel("lines")
