"""The bars around the view: notices, rail, tools, status, and the strip that shows how a run stands."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import pytest
from PySide6.QtCore import QEvent, QObject
from PySide6.QtWidgets import QApplication, QLabel, QPushButton, QWidget
from pytestqt.qtbot import QtBot

from app.gui.features.lines.slider import LengthSlider
from app.gui.plots.convergence_panel import ConvergencePanel
from app.gui.plots.status_chip import SHORTEST_SHOW_MS, StatusChip
from app.gui.status_bar import StatusBar
from app.gui.step_navigation import StepNavigation
from app.gui.theme.stylesheet import tokens_of
from app.gui.viewport.toolbar import VIEWS, CompareTools, ViewTools
from app.gui.widgets.line_widgets import LineChip
from app.presenters.assessment import IDLE
from app.presenters.plots import Exact, Track
from app.presenters.status import TONES
from core.garment.assessment import LEVELS
from core.mechanics.convergence import STATES

pytestmark = pytest.mark.usefixtures("light_theme")


def test_the_rail_says_what_is_chosen_not_what_is_set(qtbot: QtBot) -> None:
    rail = StepNavigation()
    qtbot.addWidget(rail)
    with qtbot.assertNotEmitted(rail.step_chosen):
        rail.set_current("lines")
        rail.set_state("landmarks", "look", 2)
    with qtbot.waitSignal(rail.step_chosen) as said:
        rail.items["landmarks"].click()
    assert said.args == ["landmarks"]
    with pytest.raises(ValueError, match="locked"):
        rail.set_state("scan", "locked")


class Paints(QObject):
    """Counts how often widgets are painted."""

    def __init__(self) -> None:
        super().__init__()
        self.count = 0

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
        self.count += event.type() == QEvent.Type.Paint
        return False


def rail_item() -> tuple[QWidget, Callable[[str], None]]:
    item = StepNavigation().items["lines"]
    item.setParent(None)
    return item, lambda state: item.set_state(state, 0)


def chip() -> tuple[QWidget, Callable[[str], None]]:
    pill = StatusChip()
    return pill, pill.set_state


def line_chip() -> tuple[QWidget, Callable[[str], None]]:
    mark = LineChip()
    return mark, lambda colour: mark.show_line(colour, 12.0, True)


def slider() -> tuple[QWidget, Callable[[str], None]]:
    length = LengthSlider()
    return length, length.set_color


@pytest.mark.parametrize(
    ("made", "one", "other"),
    [
        (rail_item, "done", "available"),
        (chip, "settled", "folded"),
        (line_chip, "#102030", "#405060"),
        (slider, "#102030", "#405060"),
    ],
)
def test_what_is_told_the_same_again_is_not_painted_anew(
    qtbot: QtBot, made: Callable[[], tuple[QWidget, Callable[[str], None]]], one: str, other: str
) -> None:
    widget, tell = made()
    qtbot.addWidget(widget)
    tell(one)
    with qtbot.waitExposed(widget):
        widget.show()
    paints = Paints()
    widget.installEventFilter(paints)
    tell(other)
    qtbot.waitUntil(lambda: paints.count > 0)
    qtbot.wait(2 * SHORTEST_SHOW_MS)
    before = paints.count
    tell(other)
    QApplication.processEvents()
    assert paints.count == before
    widget.removeEventFilter(paints)


def test_every_view_tool_has_name_tip_and_key(qtbot: QtBot) -> None:
    tools = ViewTools()
    qtbot.addWidget(tools)
    assert len({action.shortcut().toString() for action in tools.actions_by_name.values()}) == 16
    assert all(action.text() and action.toolTip() for action in tools.actions_by_name.values())
    with qtbot.waitSignal(tools.view_chosen) as said:
        tools.actions_by_name["back"].trigger()
    assert said.args == ["back"]
    assert [name for name in VIEWS if tools.actions_by_name[name].isChecked()] == ["back"]
    with qtbot.assertNotEmitted(tools.toggled):
        tools.set_shown("bands", True)


def test_the_status_bar_shows_a_job_only_while_it_runs(qtbot: QtBot) -> None:
    bar = StatusBar()
    qtbot.addWidget(bar)
    bar.show()
    bar.set_volume(-0.021, -1.14)
    bar.set_job("Reading scan", 0.4)
    said = [label.text() for label in bar.findChildren(QLabel) if label.isVisible()]
    assert "Reading scan" in said
    assert "Volume −0.02 % (−1.1 ml)" in said
    bar.set_job("")
    bar.set_volume(None)
    said = [label.text() for label in bar.findChildren(QLabel) if label.isVisible()]
    assert "".join(said) == ""


def test_before_and_after_are_asked_for(qtbot: QtBot) -> None:
    tools = CompareTools()
    qtbot.addWidget(tools)
    actions = tools.actions_by_name
    assert {action.shortcut().toString() for action in actions.values()} == {"G", "W", "D"}
    assert all(action.text() and action.toolTip() for action in actions.values())
    with qtbot.assertNotEmitted(tools.way_chosen):
        tools.set_way("wipe")
    assert [name for name in actions if actions[name].isChecked()] == ["wipe"]
    for press, wanted in (
        (next(each for each in tools.findChildren(QPushButton) if each.text() == "Before").click, "before"),
        (actions["side"].trigger, "side"),
        (actions["side"].trigger, "after"),
    ):
        with qtbot.waitSignal(tools.way_chosen) as said:
            press()
        assert said.args == [wanted]


def test_a_chip_does_not_flicker(qtbot: QtBot) -> None:
    chip = StatusChip()
    qtbot.addWidget(chip)
    chip.set_state("stale")
    chip.set_state("vibrating")
    chip.set_state("settled")
    assert chip.state() == "stale"
    qtbot.waitUntil(lambda: chip.state() != "stale")
    assert chip.state() == "settled"
    with pytest.raises(ValueError, match="dancing"):
        chip.set_state("dancing")


def test_a_chip_turns_only_while_it_settles_and_is_seen(qtbot: QtBot) -> None:
    chip = StatusChip()
    qtbot.addWidget(chip)
    chip.set_state("settling")
    qtbot.waitUntil(lambda: chip.state() == "settling")
    assert not chip.spinning()
    chip.show()
    assert chip.spinning()
    chip.hide()
    assert not chip.spinning()


@dataclass(frozen=True)
class Said:
    state: str
    level: str = "bad"
    headline: str = "Do not use"
    numbers: list[tuple[str, str]] = field(default_factory=lambda: [("Volume error", "0.1 %")])
    hint: str = ""
    pace: str = "0.9 s"
    effort: str = "Converged in 1,200 iterations"
    settling: bool = False


def run(values: np.ndarray) -> Track:
    return Track(np.arange(float(len(values))), values, values, values, values)


@pytest.fixture
def strip(qtbot: QtBot) -> ConvergencePanel:
    result = ConvergencePanel()
    qtbot.addWidget(result)
    result.resize(1100, 172)
    result.show()
    return result


def test_the_strip_says_the_verdict(strip: ConvergencePanel, qtbot: QtBot) -> None:
    strip.set_verdict(Said("vibrating"))
    qtbot.waitUntil(lambda: strip.chip.state() == "bad")
    assert strip.chip.accessibleName() == "Do not use"
    said = [label.text() for label in strip.findChildren(QLabel) if label.isVisible()]
    assert {"0.9 s", "Volume error", "0.1 %"} <= set(said)
    assert set(TONES) == {*STATES, "strained", "stale", "paused", *LEVELS, IDLE}


def test_the_strip_says_what_to_do_about_a_fold(strip: ConvergencePanel) -> None:
    strip.set_run({"adaptive": run(np.linspace(0.0, 2.0, 50))}, "adaptive", None)
    high = strip.height()
    strip.set_verdict(Said("folded", hint="The skin folds over. Set Mid-bust longer."))
    assert strip._said.text().startswith("The skin folds over."), "folded away too, the end may be cut off"
    QApplication.processEvents()
    hints = [label for label in strip.findChildren(QLabel) if "Mid-bust longer." in label.text()]
    assert [label.isVisible() for label in hints] == [True, False], "unfolded now, on one line when folded"
    assert strip.height() == high
    strip.set_folded(True)
    assert [label.isVisible() for label in hints] == [False, True]
    assert "Mid-bust longer." in hints[1].toolTip(), "in a narrow window its end is cut"


def test_what_has_no_room_in_the_folded_strip_is_left_out_whole(strip: ConvergencePanel) -> None:
    line = strip._said
    line.show_parts(("Set Mid-bust longer.", "Volume error 0.1 %", "", "Bust point 0.2 mm up"))
    need = line.fontMetrics().horizontalAdvance(line.text())
    seen = {}
    for width in (need, need - 1, 60):
        line.resize(width, 20)
        seen[width] = line.seen()
    assert seen[need] == line.text()
    assert seen[need - 1].endswith("Volume error 0.1 %"), "a figure that is cut is none"
    assert seen[60].startswith("Set")
    assert seen[60].endswith("…")
    assert "0.2 mm up" in line.toolTip()


@pytest.mark.parametrize("settling", [False, True])
def test_the_range_of_the_plots_only_grows_while_a_run_settles_whatever_its_word(
    strip: ConvergencePanel, settling: bool
) -> None:
    for top in (4.0, 2.0):
        strip.set_verdict(Said("overstrained", settling=settling))
        strip.set_run({"adaptive": run(np.linspace(0.0, top, 50))}, "adaptive", None)
    assert strip.error_plot.value_range()[1] == pytest.approx(4.0 if settling else 2.0)


@pytest.mark.parametrize(("state", "token"), [("settled", "accent"), ("vibrating", "warn_mark")])
def test_a_vibrating_run_is_amber(strip: ConvergencePanel, state: str, token: str) -> None:
    strip.set_verdict(Said(state))
    strip.set_run({"conventional": run(np.linspace(0.0, 2.0, 50))}, "conventional", None)
    QApplication.processEvents()
    image = strip.error_plot.grab().toImage()
    wanted = getattr(tokens_of(strip), token).lower()
    names = (image.pixelColor(x, y).name() for x in range(image.width()) for y in range(image.height()))
    assert sum(name == wanted for name in names) > 50


def test_the_strip_folds_to_one_line(strip: ConvergencePanel, qtbot: QtBot) -> None:
    with qtbot.waitSignal(strip.folded) as said:
        strip.set_folded(True)
    assert said.args == [True]
    assert (strip.is_folded(), strip.maximumHeight()) == (True, 36)
    assert not strip.error_plot.isVisible()
    strip.set_folded(False)
    assert strip.minimumHeight() > 100


def test_the_strip_is_empty_before_a_run_and_without_one_track(strip: ConvergencePanel) -> None:
    assert not strip.error_plot.isVisible()
    strip.set_run({"adaptive": run(np.empty(0))}, "adaptive", None)
    assert not strip.error_plot.isVisible()
    strip.set_run({}, "exact", Exact(0.0, 0.0, 12.0, 9.0))
    assert strip.error_plot.isVisible()


def test_the_method_is_asked_for(strip: ConvergencePanel, qtbot: QtBot) -> None:
    with qtbot.assertNotEmitted(strip.control_chosen):
        strip.set_control("adaptive")
    with qtbot.waitSignal(strip.control_chosen) as said:
        next(each for each in strip.findChildren(QPushButton) if each.text() == "Exact").click()
    assert said.args == ["exact"]
