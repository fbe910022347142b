"""The plots of the strip: what is drawn, zoomed and read of runs that are worked out by hand."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QWidget
from pytestqt.qtbot import QtBot

from app.gui.plots.convergence_panel import ConvergencePanel
from app.gui.plots.live_plot import LivePlot
from app.gui.plots.painting import curve_path
from app.presenters.plots import (
    Curve,
    Event,
    Exact,
    Quantity,
    Track,
    envelope,
    flips_every_turn,
    round_ticks,
    tolerance_of,
)

pytestmark = pytest.mark.usefixtures("light_theme")

ERROR = Quantity("error_percent", "Volume error", "%", 0.4)


@pytest.mark.parametrize(
    ("low", "high", "ticks"),
    [
        (0.0, 4.0, [0, 1, 2, 3, 4]),
        (-0.1, 1.4, [0.0, 0.5, 1.0]),
        (-15.2, -0.6, [-15.0, -10.0, -5.0]),
        (3.0, 3.0, [3.0]),
    ],
)
def test_ticks_are_round(low: float, high: float, ticks: list[float]) -> None:
    assert round_ticks(low, high) == pytest.approx(ticks)


def test_the_envelope_of_a_flip_flop_is_its_two_branches() -> None:
    turns = np.arange(60.0)
    values = 2.0 + 0.01 * turns + (-1.0) ** turns * 0.5
    lower, upper = envelope(values)
    assert upper[1:-1] == pytest.approx(2.5 + 0.01 * turns[1:-1])
    assert lower[1:-1] == pytest.approx(1.5 + 0.01 * turns[1:-1])
    assert (lower <= values).all()
    assert (values <= upper).all()


def test_only_what_flips_every_turn_flips() -> None:
    turns = np.arange(60.0)
    assert flips_every_turn((-1.0) ** turns)
    assert not flips_every_turn(np.exp(-turns / 8))
    assert not flips_every_turn(np.sin(turns / 5)), "a slow swing is no flip-flop"
    assert not flips_every_turn(np.exp(-turns) + 1e-6 * (-1.0) ** turns), "nobody sees the ripple"
    assert not flips_every_turn(np.array([1.0, -1.0, 1.0]))


@pytest.mark.parametrize(
    ("heights", "elements"),
    [
        ([5.0, 6.0, 4.0], "MLL"),
        ([np.nan, 6.0, 4.0], "ML"),
        ([5.0, np.nan, 4.0, 3.0, np.inf], "MML"),
        ([np.nan, np.nan], ""),
        ([], ""),
    ],
)
def test_a_curve_passes_the_finite_points_and_is_broken_at_the_others(
    heights: list[float], elements: str
) -> None:
    points = np.column_stack((0.3 + np.arange(len(heights)), heights))
    path = curve_path(points)
    drawn = [path.elementAt(at) for at in range(path.elementCount())]
    assert "".join("M" if each.isMoveTo() else "L" for each in drawn) == elements
    assert [(each.x, each.y) for each in drawn] == [(x, y) for x, y in points.tolist() if np.isfinite(y)]


def test_a_zigzag_is_drawn_as_an_envelope_once_it_is_dense(qtbot: QtBot) -> None:
    plot = LivePlot([ERROR])
    qtbot.addWidget(plot)
    plot.resize(400, 160)
    plot.show()
    few, many = np.arange(20.0), np.arange(200.0)
    wide, dense = (Curve(turns, (-1.0) ** turns, "warning") for turns in (few, many))
    plot.set_curves([wide])
    assert not plot.drawn_as_envelope(wide)
    plot.set_curves([dense])
    assert plot.drawn_as_envelope(dense)


def test_the_range_only_grows_while_a_line_is_dragged(qtbot: QtBot) -> None:
    plot = LivePlot([ERROR])
    qtbot.addWidget(plot)
    turns = np.arange(10.0)
    plot.set_curves([Curve(turns, np.full(10, 3.0), "main")], tolerance=0.1)
    plot.set_curves([Curve(turns, np.full(10, 0.2), "main")], tolerance=0.1, refit=False)
    assert plot.value_range() == (-0.1, 3.0)
    plot.set_curves([Curve(turns, np.full(10, 0.2), "main")], tolerance=0.1)
    assert plot.value_range() == pytest.approx((-0.15, 0.25)), "widened to the least span about its middle"


def test_broken_numbers_do_not_break_the_plot(qtbot: QtBot) -> None:
    plot = LivePlot([ERROR])
    qtbot.addWidget(plot)
    plot.resize(300, 150)
    plot.show()
    plot.set_curves([Curve(np.arange(4.0), np.array([0.1, np.inf, np.nan, 9.0]), "warning")], exact=0.0)
    plot.grab()
    assert plot.value_range() == (0.0, 9.0)


@pytest.fixture
def strip(qtbot: QtBot) -> ConvergencePanel:
    """Two runs of 101 and 51 turns: percent t/100, ml t/10, bust 2t, apex 3t; the second half of it."""
    result = ConvergencePanel()
    qtbot.addWidget(result)
    result.resize(1100, 172)
    result.show()
    tracks = {}
    for name, last, share in (("adaptive", 100, 1.0), ("conventional", 50, 0.5)):
        turns = np.arange(last + 1.0)
        values = share * turns
        tracks[name] = Track(turns, values / 100, values / 10, 2 * values, 3 * values)
    result.set_events([Event(20.0, "Mid-bust 95.0 %")])
    result.set_run(tracks, "adaptive", Exact(0.0, 0.0, 200.0, 300.0))
    QApplication.processEvents()
    return result


def wheel(widget: QWidget, at: QPointF, notches: int) -> None:
    """Turn the wheel over a place."""
    angle = QPoint(0, 120 * notches)
    no_button, no_key = Qt.MouseButton.NoButton, Qt.KeyboardModifier.NoModifier
    event = QWheelEvent(
        at, widget.mapToGlobal(at), QPoint(), angle, no_button, no_key, Qt.ScrollPhase.NoScrollPhase, False
    )
    QApplication.sendEvent(widget, event)


def test_pointing_reads_every_curve_of_both_plots(strip: ConvergencePanel, qtbot: QtBot) -> None:
    error, height = (plot.canvas for plot in strip.plots)
    with qtbot.waitSignal(strip.error_plot.pointed) as pointed:
        QTest.mouseMove(error, QPoint(round(error.scale().x(20.3)), error.height() // 2))
    assert pointed.args[0] == pytest.approx(20.3, abs=0.5)
    strip.error_plot.pointed.emit(20.3)
    assert [row[:2] for row in error.readout()] == [
        ("iteration", "20"),
        ("Adaptive", "0.20 %"),
        ("Conventional", "0.10 %"),
        ("Exact", "0.00 %"),
        ("Mid-bust 95.0 %", ""),
    ]
    assert [value for _, value, _ in height.readout()] == ["20", "40.00 mm", "20.00 mm", "200.00 mm", ""]
    strip.height_plot.pointed.emit(80.0)
    assert [value for _, value, _ in error.readout()] == ["80", "0.80 %", "0.25 %", "0.00 %"], (
        "a run rests where it is"
    )
    strip.height_plot.pointed.emit(None)
    assert error.readout() == []


def test_the_wheel_zooms_both_plots_about_the_pointer_and_a_drag_shifts_them(strip: ConvergencePanel) -> None:
    error, height = (plot.canvas for plot in strip.plots)
    at = QPointF(error.scale().x(40.0), 20.0)
    for _ in range(4):
        wheel(error, at, 1)
    first, last = error.turns()
    assert height.turns() == (first, last)
    assert last - first == pytest.approx(100.0 / 1.25**4)
    assert error.scale().turn_at(at.x()) == pytest.approx(40.0, abs=0.5), "what is under the pointer stays"
    assert strip.error_plot.value_range()[1] == pytest.approx(last / 100, abs=0.01), "values in view fill it"
    QTest.mousePress(error, Qt.MouseButton.LeftButton, pos=QPoint(200, 30))
    QTest.mouseMove(error, QPoint(100, 30))
    QTest.mouseRelease(error, Qt.MouseButton.LeftButton, pos=QPoint(100, 30))
    assert error.turns()[0] > first + 5.0
    assert error.turns()[1] - error.turns()[0] == pytest.approx(last - first)
    QTest.mouseDClick(height, Qt.MouseButton.LeftButton, pos=QPoint(90, 30))
    assert error.turns() == height.turns() == (0.0, 100.0)


def test_the_keyboard_points_and_zooms_as_the_mouse_does(strip: ConvergencePanel) -> None:
    error = strip.error_plot.canvas
    for key in (Qt.Key.Key_Right, Qt.Key.Key_Left, Qt.Key.Key_Left):
        QTest.keyClick(error, key)
    assert error.readout()[0][1] == "98"
    assert "Adaptive 0.98 %" in error.accessibleDescription()
    QTest.keyClick(error, Qt.Key.Key_Plus)
    assert error.turns()[1] - error.turns()[0] == pytest.approx(80.0)
    QTest.keyClick(error, Qt.Key.Key_Home)
    QTest.keyClick(error, Qt.Key.Key_Escape)
    assert error.turns() == (0.0, 100.0)
    assert error.readout() == []


def test_another_quantity_is_chosen_at_the_title(strip: ConvergencePanel) -> None:
    for plot, name in zip(strip.plots, ("error_ml", "apex_mm"), strict=True):
        next(each for each in plot.title.menu.actions() if not each.isChecked()).trigger()
        assert plot.quantity.name == name
        plot.pointed.emit(20.0)
    assert strip.error_plot.canvas.readout()[1][1] == "2.00 ml"
    assert strip.height_plot.canvas.readout()[1][1] == "60.00 mm"
    assert strip.error_plot.canvas.plotted.tolerance == pytest.approx(1.0), "0.1 % of a litre"
    assert tolerance_of("apex_mm", None) == 0.0


def test_a_run_that_begins_anew_is_shown_whole(strip: ConvergencePanel) -> None:
    strip.show_turns((60.0, 90.0))
    turns = np.arange(30.0)
    strip.set_run({"adaptive": Track(turns, turns, turns, turns, turns)}, "adaptive", None)
    assert strip.error_plot.canvas.turns() == (0.0, 29.0)


@pytest.mark.parametrize(("width", "place"), [(1400, 0), (960, 1), (860, 1)])
def test_the_curves_are_named_all_in_one_place(strip: ConvergencePanel, width: int, place: int) -> None:
    strip.resize(width, 172)
    strip.show()
    QApplication.processEvents()
    legend, other = strip._legends[place], strip._legends[1 - place]
    assert legend.isVisible()
    assert legend.entries == strip.legend
    assert len(legend.entries) == 3
    assert not other.isVisible()
    beside = strip.error_plot.title.width() if place == 0 else 0
    assert beside + legend.width() <= (strip.error_plot.width() if place == 0 else strip.width())
    assert strip.sizeHint().height() == 184, "the plots give way, not the body"
