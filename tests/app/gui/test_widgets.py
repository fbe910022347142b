"""The widgets answer hand and keyboard as promised, and say everything in full in both languages."""

from __future__ import annotations

from dataclasses import replace

import pytest
from gallery import Mock
from PySide6.QtCore import QEvent, QPointF, Qt
from PySide6.QtGui import QMouseEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QLabel, QPushButton
from pytestqt.qtbot import QtBot

from app.gui.features.lines.panel import LinesPanel
from app.gui.features.lines.row import LineView
from app.gui.features.lines.slider import LONGEST, SHORTEST, LengthSlider
from app.i18n.catalog import use_language
from core.analysis.length_limits.zones import LengthLimits, Reason, Zone

pytestmark = pytest.mark.usefixtures("light_theme")

WAIST = LineView("waist", "Waist", "#7A1F2E", 1.0, 400.0, 396.0, True, True, 700.0)
RED_BELOW_97 = LengthLimits(
    "waist",
    (
        Zone("red", 0.5, 0.97, (Reason("folded", 0.5, 0.97),)),
        Zone("amber", 0.97, 0.99, (Reason("strained", 0.5, 0.99),)),
        Zone("green", 0.99, 1.0),
        Zone("slack", 1.0, 1.3, (Reason("slack", 1.0, 1.3),)),
    ),
)
RIBS = LineView("under-bust", "Under-bust", "#5A3F94", 1.0, 390.0, None, False, True, 745.0)


def hold(slider: LengthSlider, kind: QEvent.Type, x: float) -> None:
    """Press, move or release the left button at ``x``."""
    at = QPointF(x, 11.0)
    button = Qt.MouseButton.NoButton if kind is QEvent.Type.MouseMove else Qt.MouseButton.LeftButton
    held = Qt.MouseButton.NoButton if kind is QEvent.Type.MouseButtonRelease else Qt.MouseButton.LeftButton
    event = QMouseEvent(kind, at, slider.mapToGlobal(at), button, held, Qt.KeyboardModifier.NoModifier)
    QApplication.sendEvent(slider, event)


@pytest.fixture
def slider(qtbot: QtBot) -> LengthSlider:
    result = LengthSlider()
    qtbot.addWidget(result)
    result.resize(346, 28)  # the groove is 320 pixels long, 10 to a percent
    result.show()
    return result


def heard(slider: LengthSlider) -> list[tuple[str, float]]:
    """Return the list that fills with what the slider says."""
    said: list[tuple[str, float]] = []
    slider.previewed.connect(lambda ratio: said.append(("previewed", ratio)))
    slider.committed.connect(lambda ratio: said.append(("committed", ratio)))
    slider.cancelled.connect(lambda: said.append(("cancelled", slider.ratio())))
    return said


def test_a_drag_previews_and_commits_once(slider: LengthSlider) -> None:
    said = heard(slider)
    hold(slider, QEvent.Type.MouseButtonPress, 216.0)  # on the edge of the handle: it does not jump
    for x in (206.0, 186.0, 166.0):
        hold(slider, QEvent.Type.MouseMove, x)
    hold(slider, QEvent.Type.MouseButtonRelease, 166.0)
    assert said == [
        ("previewed", pytest.approx(0.99)),
        ("previewed", pytest.approx(0.97)),
        ("previewed", pytest.approx(0.95)),
        ("committed", pytest.approx(0.95)),
    ]


def test_escape_puts_a_dragged_length_back(slider: LengthSlider) -> None:
    said = heard(slider)
    hold(slider, QEvent.Type.MouseButtonPress, 213.0)
    hold(slider, QEvent.Type.MouseMove, 163.0)
    QTest.keyClick(slider, Qt.Key.Key_Escape)
    hold(slider, QEvent.Type.MouseMove, 153.0)
    hold(slider, QEvent.Type.MouseButtonRelease, 153.0)
    assert said == [("previewed", pytest.approx(0.95)), ("cancelled", 1.0)]


def test_a_press_without_a_move_says_nothing(slider: LengthSlider) -> None:
    said = heard(slider)
    hold(slider, QEvent.Type.MouseButtonPress, 213.0)
    hold(slider, QEvent.Type.MouseButtonRelease, 213.0)
    assert said == []


def test_new_values_do_not_pull_the_handle_out_of_the_hand(slider: LengthSlider) -> None:
    hold(slider, QEvent.Type.MouseButtonPress, 213.0)
    hold(slider, QEvent.Type.MouseMove, 163.0)
    slider.set_ratio(1.05)
    assert slider.ratio() == pytest.approx(0.95)


@pytest.mark.parametrize(
    ("key", "held", "ratio"),
    [
        (Qt.Key.Key_Left, Qt.KeyboardModifier.NoModifier, 0.989),
        (Qt.Key.Key_Plus, Qt.KeyboardModifier.NoModifier, 0.991),
        (Qt.Key.Key_Right, Qt.KeyboardModifier.ShiftModifier, 1.0),
        (Qt.Key.Key_Left, Qt.KeyboardModifier.AltModifier, 0.9899),
        (Qt.Key.Key_Backspace, Qt.KeyboardModifier.NoModifier, 1.0),
    ],
)
def test_a_key_commits_once(
    slider: LengthSlider, key: Qt.Key, held: Qt.KeyboardModifier, ratio: float
) -> None:
    slider.set_ratio(0.99)
    said = heard(slider)
    QTest.keyClick(slider, key, held)
    assert said == [("committed", pytest.approx(ratio))]


def test_a_groove_that_a_typed_length_widened_keeps_still_under_the_hand(slider: LengthSlider) -> None:
    slider.set_ratio(0.7)
    wide = slider.ends()
    assert wide[0] < 0.7
    x = slider.x_of(0.7)
    hold(slider, QEvent.Type.MouseButtonPress, x)
    hold(slider, QEvent.Type.MouseMove, slider.x_of(0.85))
    hold(slider, QEvent.Type.MouseButtonRelease, slider.x_of(0.85))
    slider.set_ratio(0.85)  # as the view does with the new design
    QTest.keyClick(slider, Qt.Key.Key_Right, Qt.KeyboardModifier.ShiftModifier)
    slider.set_ratio(0.86)
    assert (slider.ratio(), slider.ends()) == (pytest.approx(0.86), wide)
    slider.set_ratio(0.9)  # typed, or undone
    assert slider.ends() == (SHORTEST, LONGEST)


def test_the_slider_keeps_its_range(slider: LengthSlider) -> None:
    slider.set_ratio(0.8)
    said = heard(slider)
    QTest.keyClick(slider, Qt.Key.Key_Left)
    assert (said, slider.ratio()) == ([], 0.8)


@pytest.fixture
def lines(qtbot: QtBot) -> LinesPanel:
    result = LinesPanel()
    qtbot.addWidget(result)
    result.set_lines([WAIST, RIBS])
    result.resize(364, 700)
    result.show()
    return result


def test_a_typed_length_is_committed_for_its_line(lines: LinesPanel, qtbot: QtBot) -> None:
    field = lines.rows["waist"].percent
    field.setFocus()
    field.selectAll()
    QTest.keyClicks(field, "-6%")
    with qtbot.waitSignal(lines.length_committed) as said:
        QTest.keyClick(field, Qt.Key.Key_Return)
    assert said.args == ["waist", pytest.approx(0.94)]
    assert (field.text(), lines.rows["waist"].millimetres.text()) == ("94.0", "376.0")


def test_a_length_beyond_the_slider_can_be_typed(lines: LinesPanel, qtbot: QtBot) -> None:
    row = lines.rows["waist"]
    row.percent.setFocus()
    row.percent.selectAll()
    QTest.keyClicks(row.percent, "60")
    with qtbot.waitSignal(lines.length_committed) as said:
        QTest.keyClick(row.percent, Qt.Key.Key_Return)
    assert said.args == ["waist", pytest.approx(0.6)]
    lines.set_lines([replace(WAIST, ratio=0.6), RIBS])
    slider = row.slider
    assert (row.percent.text(), slider.ratio()) == ("60.0", 0.6)
    assert slider.x_of(0.6) > slider.x_of(slider._ends[0]), "it does not stand at the end as if that were it"
    lines.set_lines([replace(WAIST, ratio=0.95), RIBS])
    assert (slider.ratio(), slider._ends) == (0.95, (SHORTEST, LONGEST))


def test_nonsense_is_marked_and_not_committed(lines: LinesPanel, qtbot: QtBot) -> None:
    field = lines.rows["waist"].percent
    field.setFocus()
    field.selectAll()
    with qtbot.assertNotEmitted(lines.length_committed):
        QTest.keyClicks(field, "40")
        QTest.keyClick(field, Qt.Key.Key_Return)
    assert field.property("wrong") is True
    QTest.keyClick(field, Qt.Key.Key_Escape)
    assert (field.text(), field.property("wrong")) == ("100.0", False)


def test_rows_stay_while_values_change(lines: LinesPanel) -> None:
    row = lines.rows["waist"]
    lines.set_lines([LineView("waist", "Waist", "#7A1F2E", 0.95, 400.0, 381.9, True, True, 700.0), RIBS])
    assert lines.rows["waist"] is row
    lines.select("waist")
    said = [label.text() for label in row.findChildren(QLabel) if label.isVisible()]
    assert any(text.startswith("+1.9") for text in said), "reached minus set"
    assert any("95.0 % of the front length, side to side" in text for text in said)
    assert any("680.0 of 700.0 mm (97.1 %)" in text for text in said)


def test_the_numbers_of_a_dragged_line_stay_with_the_hand(lines: LinesPanel) -> None:
    row = lines.rows["waist"]
    hold(row.slider, QEvent.Type.MouseButtonPress, row.slider.x_of(1.0))
    hold(row.slider, QEvent.Type.MouseMove, row.slider.x_of(0.95))
    lines.set_lines([replace(WAIST, ratio=0.97), RIBS])
    assert row.percent.text() == "95.0"
    hold(row.slider, QEvent.Type.MouseButtonRelease, row.slider.x_of(0.95))
    lines.set_lines([replace(WAIST, ratio=0.97), RIBS])
    assert row.percent.text() == "97.0"


@pytest.mark.parametrize(("ratio", "tone"), [(1.0, ""), (0.984, "warn"), (0.96, "bad"), (0.992, "")])
def test_a_gap_has_the_tone_of_the_groove_at_its_length(lines: LinesPanel, ratio: float, tone: str) -> None:
    view = LineView("waist", "Waist", "#7A1F2E", ratio, 400.0, 398.0, True, True, 700.0)
    lines.set_lines([replace(view, leeway=RED_BELOW_97), RIBS])
    lines.select("waist")
    shown = [each for each in lines.rows["waist"].findChildren(QLabel) if each.isVisible()]
    gap = next(each for each in shown if each.text().startswith(("+", "−")))
    assert (gap.property("tone") or "") == tone
    assert any("no tension" in each.text() for each in shown) == (ratio == 1.0)


def test_the_key_of_an_elastic_line_has_the_tone_of_its_pressure(lines: LinesPanel) -> None:
    pressing = Zone("amber", 0.5, 0.97, (Reason("pressing", 0.5, 0.97),))
    leeway = LengthLimits("waist", (pressing, Zone("green", 0.97, 1.3)), pressure_known=True)
    elastic = replace(WAIST, ratio=0.9, elastic="Power-net", leeway=leeway, pressed="4.2 kPa", tone="bad")
    lines.set_lines([elastic, RIBS])
    lines.select("waist")
    key = lines.rows["waist"].details._key
    assert key.rows["amber"][1].property("tone") == "bad", "as the verdict, which is red"
    assert key.pressure.isHidden(), "its pressure has a place of its own"


def test_arrows_go_from_line_to_line_and_enter_into_the_number(lines: LinesPanel, qtbot: QtBot) -> None:
    waist = lines.rows["waist"]
    lines.activateWindow()
    qtbot.waitUntil(lines.isActiveWindow)
    waist.slider.setFocus()
    lines.select("waist")
    with qtbot.waitSignal(lines.selected) as said:
        QTest.keyClick(waist.slider, Qt.Key.Key_Down)
    assert said.args == ["under-bust"]
    lines.select("waist")
    waist.slider.setFocus()
    QTest.keyClick(waist.slider, Qt.Key.Key_Return)
    assert waist.percent.hasFocus()
    assert waist.percent.selectedText() == "100.0"
    QTest.keyClicks(waist.percent, "97")
    QTest.keyClick(waist.percent, Qt.Key.Key_Return)
    assert waist.slider.hasFocus()
    assert waist.slider.ratio() == pytest.approx(0.97)


def test_a_measured_line_has_no_slider(lines: LinesPanel) -> None:
    row = lines.rows["under-bust"]
    assert row.slider.isHidden()
    assert row.percent.isHidden()
    said = [label.text() for label in row.findChildren(QLabel) if label.isVisible()]
    assert any("Garment tab" in each for each in said)
    assert "390.0 mm" in said


def test_lines_are_chosen_by_key_and_hidden_by_the_menu(lines: LinesPanel, qtbot: QtBot) -> None:
    with qtbot.waitSignal(lines.selected) as said:
        QTest.keyClick(lines, Qt.Key.Key_Down)
    assert said.args == ["waist"]
    with qtbot.waitSignal(lines.visibility_changed) as said:
        lines.do("hide")
    assert said.args == ["waist", False]
    with qtbot.assertNotEmitted(lines.selected):
        lines.select("under-bust")


@pytest.mark.parametrize("language", ["en", "ja"])
@pytest.mark.parametrize("page", ["scan", "landmarks", "lines", "result", "model"])
def test_nothing_is_cut_off_in_the_smallest_window(qtbot: QtBot, language: str, page: str) -> None:
    use_language(language)
    window = Mock(page, vibrating=True)
    qtbot.addWidget(window)
    window.inspector.setFixedWidth(340)
    window.resize(1180, 700)
    window.show()
    QApplication.processEvents()
    assert (window.width(), window.height()) == (1180, 700)
    cut = [
        each.text()
        for each in (*window.findChildren(QLabel), *window.findChildren(QPushButton))
        if each.isVisible() and (each.width() < needed(each)[0] or each.height() < needed(each)[1])
    ]
    assert cut == []
    right = window.inspector.mapToGlobal(window.inspector.rect().bottomRight()).x()
    for each in window.inspector.currentWidget().findChildren(QLabel):
        assert not each.isVisible() or each.mapToGlobal(each.rect().bottomRight()).x() <= right


def needed(widget: QLabel | QPushButton) -> tuple[int, int]:
    """Return the width and height that all of its text takes."""
    if isinstance(widget, QLabel) and widget.wordWrap():
        return 0, widget.heightForWidth(widget.width())
    if isinstance(widget, QPushButton):
        text = widget.fontMetrics().size(0, widget.text())
        return text.width() + 4, text.height()
    return widget.sizeHint().width(), widget.sizeHint().height()
