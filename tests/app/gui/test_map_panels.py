"""The legend of a map and the panel of a section, as a designer's hand uses them."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.gui.features.maps.color_bar import BAR
from app.gui.features.maps.legend import Legend
from app.gui.features.sections.panel import STEPS, SectionPanel
from app.gui.plots.section_plot import SectionDrawing, SectionPlot, grid_step
from app.gui.widgets.value_edit import read_number
from app.presenters.bust_shift import BustShift, BustStep
from app.presenters.maps import MAPS, automatic_range, map_kinds, ramp_of, section_text, sides_text
from app.rendering.appearance import rgb
from core.measurements.uncertain_value import SOURCES, OutputUncertainties, Uncertainty


@pytest.fixture
def legend(qapp: QApplication) -> Legend:
    legend = Legend(map_kinds())
    legend.show_map("displacement")
    legend.show_range(-10.0, 10.0, ramp_of("displacement", -10.0, 10.0, "#DFD5CA").stops, False)
    return legend


def heard(signal: object) -> list[object]:
    told: list[object] = []
    signal.connect(lambda *values: told.append(values if len(values) != 1 else values[0]))  # type: ignore[attr-defined]
    return told


def test_figures_are_read_with_sign_unit_and_full_width_digits() -> None:
    assert [read_number(text) for text in ("12", "+3,5 mm", "−7", "１２", "- 4", "mm", "", "1e5x9")] == [
        12.0,
        3.5,
        -7.0,
        12.0,
        -4.0,
        None,
        None,
        None,
    ]


def test_where_there_is_little_room_the_legend_still_says_what_the_sign_means(legend: Legend) -> None:
    legend.set_size("small")
    assert not legend.note.isHidden()
    assert legend.note.text() == "+ outward  − inward"
    legend.show_map("strain")
    assert legend.note.isHidden()
    assert "of the control mesh" in legend.title.toolTip()
    legend.set_size("folded")
    legend.show_map("sides")
    assert (legend.note.isHidden(), legend.bar.isHidden()) == (True, True)
    assert legend.title.toolTip().endswith("+ protrudes beyond the other side")


def test_a_typed_end_sets_both_ends_where_values_go_both_ways(legend: Legend) -> None:
    told = heard(legend.range_set)
    legend.high.setText("4 mm")
    legend.high.setModified(True)
    QTest.keyClick(legend.high, Qt.Key.Key_Return)
    assert told == [(-4.0, 4.0)]
    legend.show_map("strain")
    legend.show_range(0.0, 20.0, ramp_of("strain", 0.0, 20.0, "#DFD5CA").stops, False)
    for field, text in ((legend.low, "5"), (legend.high, "0")):
        field.setText(text)
        field.setModified(True)
        QTest.keyClick(field, Qt.Key.Key_Return)
    assert told[1:] == [(5.0, 20.0)]  # an empty range is none
    assert legend.high.text() == "20.0"


def test_an_end_is_dragged_and_a_double_click_frees_it(legend: Legend) -> None:
    told, freed = heard(legend.range_set), heard(legend.range_freed)
    top = BAR.topLeft().toPoint() + QPoint(4, 4)
    QTest.mousePress(legend.bar, Qt.MouseButton.LeftButton, pos=top)
    QTest.mouseMove(legend.bar, top + QPoint(0, 40))
    QTest.mouseRelease(legend.bar, Qt.MouseButton.LeftButton, pos=top + QPoint(0, 40))
    low, high = told[-1]  # type: ignore[misc]
    assert low == -high
    assert 5.0 < high < 9.9  # pulled down, the colours end sooner
    QTest.mouseDClick(legend.bar, Qt.MouseButton.LeftButton, pos=top)
    assert len(freed) == 1
    assert legend.bar.y_of(0.0) == pytest.approx(BAR.center().y())
    assert legend.bar.y_of(99.0) == pytest.approx(BAR.top())


def test_ranges_are_round_and_colours_start_at_the_material() -> None:
    assert automatic_range("displacement", np.array([-4.2, 1.0, np.nan])) == (-5.0, 5.0)
    assert automatic_range("strain", np.array([0.0, 11.0])) == (0.0, 15.0)
    assert automatic_range("sides", np.array([0.1])) == (-5.0, 5.0)
    assert automatic_range("pull", np.empty(0)) == (0.0, 100.0)
    assert automatic_range("pressure", np.array([1.2, np.nan])) == (0.0, 5.0)  # both limits are seen
    assert automatic_range("pressure", np.array([11.2])) == (0.0, 15.0)
    for name in MAPS:
        low, high = automatic_range(name, np.array([8.0]))
        assert ramp_of(name, low, high, "#8F949B")(np.zeros(1))[0] == pytest.approx(rgb("#8F949B"))


def test_a_section_tells_how_far_the_bust_points_went() -> None:
    move = BustShift(BustStep(4.0, -1.5), BustStep(-3.0, 2.5))
    assert section_text("x", "left", move) == "Bust point left: 4.0 mm up, 1.5 mm back"
    assert section_text("x", "right", move) == "Bust point right: 3.0 mm down, 2.5 mm forward"
    both = "Bust points: 0.5 mm up, 0.5 mm forward (left 4.0 mm up, right 3.0 mm down)"
    assert section_text("z", "left", move) == both
    alike = BustShift(BustStep(4.0, -1.5), BustStep(4.4, -1.1))
    assert section_text("y", "left", alike) == "Bust points: 4.2 mm up, 1.3 mm back"


def test_a_section_tells_how_far_that_may_be_off() -> None:
    move = BustShift(BustStep(4.0, -1.5), BustStep(4.4, 2.5))
    doubts = {
        key: Uncertainty({"scan": sd}) for key, sd in (("lift left", 0.6), ("out left", 0.02), ("lift", 6.0))
    }
    spread = OutputUncertainties(doubts, np.zeros(0), 0.2, 2.0, SOURCES, {}, "sliding")
    said = section_text("x", "left", move, spread).replace("\N{NO-BREAK SPACE}", " ")
    assert said == "Bust point left: 4.0 ± 1.2 mm up, 1.5 ± 0.1 mm back"
    assert section_text("x", "right", move, spread) == "Bust point right: 4.4 mm up, 2.5 mm forward"
    said = section_text("z", "left", move, spread).replace("\N{NO-BREAK SPACE}", " ")
    assert said.startswith("Bust points: 4.2 ± 12 mm up, 0.5 mm forward")


def test_sides_are_compared_in_words() -> None:
    pair = (np.array([200.0, 300.0]), np.array([198.5, 304.0]))
    assert sides_text("x", [pair]).endswith("the other side: 4.0 mm up, 1.5 mm back")
    level = [(np.array([80.0, -200.0]), np.array([80.0, -203.0])), (np.array([-80.0, -200.0]),) * 2]
    assert sides_text("z", level) == "Apex left, relative to right: 3.0 mm forward"
    assert sides_text("y", []) == ""


def test_both_axes_of_the_plot_are_alike_and_the_wheel_keeps_the_place(qapp: QApplication) -> None:
    plot = SectionPlot()
    plot.resize(300, 200)
    home = np.array([[100.0, 200.0], [200.0, 400.0]])
    plot.show_curves(SectionDrawing({"before": [home]}, (), home), again=True)
    low, high = plot.to_pixels(home)
    assert abs(high[0] - low[0]) * 2.0 == pytest.approx(abs(high[1] - low[1]))  # a millimetre is a millimetre
    assert plot.to_mm(QPointF(*low)) == pytest.approx(home[0])
    plot.show()
    told = heard(plot.pointed)
    QTest.mouseMove(plot, QPoint(120, 90))
    assert told
    assert told[-1] == pytest.approx(plot.to_mm(QPointF(120, 90)))
    QTest.mousePress(plot, Qt.MouseButton.LeftButton, pos=QPoint(120, 90))
    QTest.mouseMove(plot, QPoint(150, 90))
    QTest.mouseRelease(plot, Qt.MouseButton.LeftButton, pos=QPoint(150, 90))
    assert plot.to_pixels(home)[0] == pytest.approx(low + np.array([30.0, 0.0]))
    plot.show_curves(SectionDrawing({"before": [home]}, (), home), again=False)
    assert plot.to_pixels(home)[0] == pytest.approx(
        low + np.array([30.0, 0.0])
    )  # a new frame leaves it where it is
    QTest.mouseDClick(plot, Qt.MouseButton.LeftButton, pos=QPoint(10, 10))
    assert plot.to_pixels(home)[0] == pytest.approx(low)
    plot.close()
    assert [grid_step(least) for least in (0.2, 1.2, 2.0, 7.0, 30.0)] == [1.0, 2.0, 2.0, 10.0, 50.0]


def test_the_plane_is_moved_by_slider_and_by_figure(qapp: QApplication) -> None:
    panel = SectionPanel()
    moved = heard(panel.moved)
    panel.show_plane("x", 104.6, -190.0, 190.0)
    assert moved == []
    assert panel.place.text() == "104.6"
    panel.slider.setValue(round(50.5 * STEPS))
    panel.place.setText("−20,5")
    panel.place.setModified(True)
    QTest.keyClick(panel.place, Qt.Key.Key_Return)
    assert moved == [50.5, -20.5]
