"""Contact pressure in the real window: the map on the bands, once a run rests and only where it is seen."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLabel
from window_tools import Script, drag, run_bodiless, run_undrawn, settled

import app.gui.features.garment.pressure_controller as desk_module
from app.gui.features.garment.pressure_card import PressureCard
from app.gui.features.maps.band_coloring import BandValues
from app.gui.main_window import MainWindow
from app.presenters.maps import pressure_note
from core.garment.elastic_library import find_elastic
from core.garment.pressure import LEFT_OUT, pressure_limits
from core.garment.pressure_list import PressureList, pressure_list_of
from core.pipeline.warnings import ShownState

pytestmark = pytest.mark.usefixtures("empty_house")


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """The lengths that the mid-bust line was pressed with, one for each time that it was worked out."""
    told: list[float] = []

    def counted(shown: ShownState) -> PressureList:
        told.append(shown.stages.design.ratio("mid-bust"))
        return pressure_list_of(shown)

    monkeypatch.setattr(desk_module, "pressure_list_of", counted)
    return told


def wear(window: MainWindow) -> None:
    """Let the mid-bust line be an elastic at 80 %."""
    picot = find_elastic("picot 10")
    window.session.edit(
        lambda design: design.with_line("mid-bust", 0.8).with_elastic("mid-bust", picot), "Wear it"
    )


def known(window: MainWindow) -> PressureList:
    frame = window.session.frame
    assert frame is not None
    return pressure_list_of(frame)


def pressed(window: MainWindow) -> BandValues:
    return window.maps_controller._on_bands[window.view.beside.bodies[0]]


def colours(window: MainWindow) -> np.ndarray:
    """The colours of the mid-bust line's band."""
    actor = window.view.viewport.scene.plotter.actors["band mid-bust"]
    return np.array(actor.mapper.dataset["Colour"])


def test_the_map_of_pressure_is_worked_out_at_rest_and_where_it_is_seen(asked: list[float]) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.navigation.show_panel("history")
        wear(window)
        yield settled(window)
        yield lambda: not window.jobs.at_work()
        assert asked == [0.95, 0.8], "once for each shape that came to rest: the verdict needs it"
        maps, own = window.maps_controller, colours(window)
        maps.choose("pressure")
        yield lambda: bool(pressed(window).values)
        assert len(asked) == 2, "it is known by then"
        listed = known(window)
        assert pressed(window).values["mid-bust"] == pytest.approx(listed.worn["mid-bust"].kpa)
        assert maps.legend.bar.range_ == (0.0, 5.0)
        assert [value for value, *_ in maps.legend.bar._marks] == [2.0, 4.0]
        a_click_tells_the_value_there(window, listed)
        yield from while_the_body_moves_it_is_that_of_the_former_shape(window, asked)
        assert not np.array_equal(colours(window), own)
        maps.choose("")
        assert np.array_equal(colours(window), own)
        drag(window, "mid-bust", 40)
        yield settled(window)
        yield lambda: not window.jobs.at_work()
        assert len(asked) == 4, "and once for the last"

    run_undrawn([], script)


def a_click_tells_the_value_there(window: MainWindow, listed: PressureList) -> None:
    maps, bands, band = window.maps_controller, window.view.viewport.scene.bands, listed.worn["mid-bust"]
    spine, _ = bands.spine("mid-bust")
    maps.pin(spine[band.peak], "mid-bust")
    (flag,) = maps.flags.flags
    assert flag.text == f"{band.largest:.1f} kPa"
    assert np.linalg.norm(flag.place - band.places[band.peak]) < 4.5
    hollow = int(band.gap.argmax())
    maps.pin(spine[hollow], "mid-bust")
    assert maps.flags.flags[1].text == f"bridges a hollow, {band.gap[hollow]:.0f} mm off the skin"
    maps.choose("pull")
    # Pull is that of the front: only what lies there has one.
    assert len(maps.flags.flags) == int(band.front[band.peak]) + int(band.front[hollow])
    maps.choose("pressure")
    window.view.set_after(False)
    assert maps.flags.flags == (), "at rest nothing presses"
    window.view.set_after(True)
    assert len(maps.flags.flags) == 2


def while_the_body_moves_it_is_that_of_the_former_shape(window: MainWindow, asked: list[float]) -> Script:
    maps, former = window.maps_controller, pressed(window).values["mid-bust"]
    drag(window, "mid-bust", 20, release=False)
    yield lambda: pressed(window).stale
    assert pressed(window).values["mid-bust"] == pytest.approx(former)
    assert maps.flags.flags == ()
    assert maps.legend.note.text().startswith("For the previous shape")
    assert len(asked) == 2
    slider = window.lines.rows["mid-bust"].slider
    QTest.mouseRelease(slider, Qt.MouseButton.LeftButton)
    yield settled(window)
    yield lambda: not pressed(window).stale
    assert len(asked) == 3
    assert pressed(window).values["mid-bust"] == pytest.approx(known(window).worn["mid-bust"].kpa)
    assert len(maps.flags.flags) == 2


def test_variants_side_by_side_are_pressed_in_one_range(asked: list[float]) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        wear(window)
        yield settled(window)
        window.variants_controller.choose("B")
        window.session.commit_line("mid-bust", "Mid-bust", 0.7)
        yield settled(window)
        window.variants_controller.show_side_by_side()
        yield lambda: len(window.view.beside.bodies) == 2
        window.maps_controller.choose("pressure")
        yield lambda: all(window.maps_controller._on_bands[view].values for view in window.view.beside.bodies)
        shown = window.maps_controller._on_bands
        here, there = (shown[view].values["mid-bust"].max() for view in window.view.beside.bodies)
        assert here > 1.2 * there, "B is shorter"
        assert sorted(set(asked)) == [0.7, 0.8, 0.95]
        assert len(asked) == len({*asked}) + 1, "each shape once, but for the variant that is solved anew"

    run_undrawn([], script)


def test_the_legend_says_why_nothing_presses() -> None:
    nothing = PressureList((), {})
    assert pressure_note(nothing, stale=False) == "No active line with known tension presses on the skin."
    assert pressure_note(None, stale=True).startswith("Computed when")


def test_beside_the_cut_list_stands_what_each_line_presses_with(asked: list[float]) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.navigation.show_panel("history")
        wear(window)
        yield settled(window)
        desk, panel, card = window.pressure_controller, window.garment, window.pressure_controller.card
        yield lambda: asked == [0.95, 0.8]
        window.navigation.show_step("result")
        window.navigation.show_panel("garment")
        yield lambda: desk.shown is not None
        assert asked == [0.95, 0.8], "it is not computed twice"
        listed = known(window)
        (row,) = listed.rows
        assert row.max_kpa is not None
        mark = panel.rows["mid-bust"].pressure.view
        assert (mark.kpa, mark.light, mark.word) == (f"{row.max_kpa:.1f}", "green", "gentle")
        assert f"{row.max_kpa:.1f} kPa · {row.max_mmhg:.0f} mmHg" in mark.tip
        assert f"{row.mean_kpa:.1f} kPa · {row.mean_mmhg:.0f} mmHg" in mark.tip
        assert f"Bridges hollows over {row.bridged_mm:.0f} mm" in mark.tip
        assert card.largest.text() == f"{row.max_kpa:.1f} kPa · {row.max_mmhg:.0f} mmHg"
        assert (card.light.light, card.light.word) == ("green", "gentle")
        assert card.place.text() == f"Mid-bust, {row.where}"
        assert f"{listed.force_n:.1f} N" in card.force.text()
        assert card.scale.marks == (("Mid-bust", "#E5536B", row.max_kpa),)
        limits_and_what_is_left_out_are_told(card)
        the_copied_list_has_it_in_the_order_of_the_panel(window, row.max_kpa)
        yield from a_click_turns_to_the_place(window, listed)
        drag(window, "mid-bust", 20, release=False)
        yield lambda: desk.shown is None
        assert panel.rows["mid-bust"].pressure.view.light == "", "of a former shape there is no light"
        assert not card.place.isEnabled()
        QTest.mouseRelease(window.lines.rows["mid-bust"].slider, Qt.MouseButton.LeftButton)
        yield settled(window)
        yield lambda: desk.shown is not None
        assert card.largest.text().startswith(f"{known(window).rows[0].max_kpa:.1f} kPa")
        window.session.commit_line("mid-bust", "Mid-bust", 1.0)
        yield settled(window)
        yield lambda: desk.shown is not None
        assert not card.isVisible()

    run_undrawn([], script)


def test_an_opened_line_of_elastic_tells_what_it_presses_with(asked: list[float]) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        yield lambda: not window.jobs.at_work()
        assert asked == [0.95]
        wear(window)
        yield settled(window)
        window.selection.select_line("mid-bust")
        details = window.lines.rows["mid-bust"].details
        yield lambda: details._pressed.text() != "–"
        assert asked == [0.95, 0.8]
        (row,) = known(window).rows
        assert details._pressed.text() == f"{row.max_kpa:.1f} kPa · gentle"
        assert details._presses.isVisible()
        window.navigation.show_panel("history")
        drag(window, "mid-bust", 20)
        yield settled(window)
        yield lambda: not window.jobs.at_work()
        assert len(asked) == 3
        window.navigation.show_panel("lines")
        yield lambda: details._pressed.text() == f"{known(window).rows[0].max_kpa:.1f} kPa · gentle"

    run_bodiless([], script)


def the_copied_list_has_it_in_the_order_of_the_panel(window: MainWindow, kpa: float) -> None:
    window.garment.copy_requested.emit()
    heading, *rows = (line.split("\t") for line in QGuiApplication.clipboard().text().splitlines())
    at = heading.index("Maximum contact pressure kPa")
    assert [(row[0], row[at]) for row in rows] == [("Mid-bust", f"{kpa:.1f}")]


def limits_and_what_is_left_out_are_told(card: PressureCard) -> None:
    limits = pressure_limits()
    assert limits.sources[0].name in card.limits.text()
    assert "estimate" in card.sure.text()
    assert card.scale._limits.words == ("gentle", "snug", "too tight")
    for fold, sentences in zip(card.folds, ([each.name for each in limits.sources], LEFT_OUT), strict=True):
        shut = {each.text() for each in card.findChildren(QLabel) if each.isVisible()}
        fold.click()
        (words,) = (
            each.text() for each in card.findChildren(QLabel) if each.isVisible() and each.text() not in shut
        )
        assert all(str(sentence) in words for sentence in sentences)


def a_click_turns_to_the_place(window: MainWindow, listed: PressureList) -> Script:
    view, (row,) = window.view.viewport, listed.rows
    view.set_view("back")
    place = np.array(row.place)
    QTest.mouseClick(window.pressure_controller.card.place, Qt.MouseButton.LeftButton)
    yield lambda: bool(window.maps_controller.flags.flags)
    assert window.maps_controller.name == "pressure"
    (flag,) = window.maps_controller.flags.flags
    assert flag.text == f"{row.max_kpa:.1f} kPa"
    assert np.linalg.norm(flag.place - place) < 4.5
    assert not view.scene.hidden(flag.place), "the camera has come round"
    x, y, *_ = view.scene.view.to_picture(place[None], view.width(), view.height())[0]
    assert 0 < x < view.width()
    assert 0 < y < view.height()
    QTest.mouseClick(window.pressure_controller.card.place, Qt.MouseButton.LeftButton)
    assert len(window.maps_controller.flags.flags) == 1, "it is pinned already"
    window.maps_controller.choose("")


def test_pressures_that_cannot_be_computed_are_no_reason_to_wait(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> PressureList:
        raise MemoryError

    def script(window: MainWindow) -> Script:
        yield settled(window)
        pressing = desk_module.pressure_list_of
        monkeypatch.setattr(desk_module, "pressure_list_of", fail)
        drag(window, "mid-bust", -10)
        yield settled(window)
        yield lambda: window.notices.notice() is not None
        view = window.assessment_controller.of(window.session.frame)
        assert (view.level, view.waiting) == ("caution", "")
        assert view.first.startswith("The contact pressure was not computed.")
        assert window.rail.items["result"].state() == "look"
        monkeypatch.setattr(desk_module, "pressure_list_of", pressing)
        drag(window, "mid-bust", -10)
        yield settled(window)
        yield lambda: window.assessment_controller.of(window.session.frame).level == "bad"

    run_bodiless([], script)
