"""What a slider tells of its zones, and that they are there before a run has settled."""

from __future__ import annotations

import threading

import pytest
from PySide6.QtCore import QEvent, QPoint
from PySide6.QtGui import QHelpEvent
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot
from window_tools import PATIENCE, Script, run_main, settled

import app.gui.features.lines.limits_controller
from app.gui.features.lines.limits_legend import LimitsLegend
from app.gui.features.lines.slider import LengthSlider, _zones, wall_of
from app.gui.main_window import MainWindow
from app.gui.widgets.tooltip import set_tip, shown_tip
from app.presenters.length_limits import hint, legend_entries, resistance_reason, short_reason, tone_at
from core.analysis.length_limits.zones import LengthLimits, Reason, Zone

pytestmark = pytest.mark.usefixtures("empty_house", "limits_sought")

STRAINED = Reason("strained", 0.5, 0.939)
FOLDED = Reason("folded", 0.5, 0.86)
SLACK = Reason("slack", 0.981, 1.3, others=True)
LEEWAY = LengthLimits(
    "waist",
    (
        Zone("red", 0.5, 0.86, (FOLDED, STRAINED)),
        Zone("amber", 0.86, 0.939, (STRAINED,)),
        Zone("green", 0.939, 0.981),
        Zone("slack", 0.981, 1.3, (SLACK,)),
    ),
)


def plain(words: str) -> str:
    return words.replace("\N{NO-BREAK SPACE}", " ")


def test_the_hover_tells_zone_number_and_reason() -> None:
    assert plain(hint(LEEWAY, 0.95)).splitlines() == [
        "Green from 93.9 to 98.1 %",
        "Strained below 93.9 %: skin is compressed or stretched by over 20 % in places.",
        "Slack above 98.1 %: tension would be negative, which is not possible for a band.",
        "Contact pressure is not checked: no elastic is chosen.",
    ]
    assert plain(hint(LEEWAY, 0.9)).startswith("Amber from 86.0 to 93.9 %\nStrained below 93.9 %: ")
    assert plain(hint(LEEWAY, 0.7)).splitlines() == [
        "Folded below 86.0 %: a triangle of the control mesh is rotated on its side.",
    ]
    assert (
        plain(hint(LEEWAY, 1.1))
        == "Slack above 98.1 %: tension would be negative, which is not possible for a band."
    )


@pytest.mark.usefixtures("fine_samples")
def test_a_line_that_is_folded_is_told_so_and_its_slider_says_how_far_it_reaches() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        row = window.lines.rows["mid-bust"]
        yield lambda: row.view.leeway is not None and not row.view.stale
        assert "folded" not in plain(legend_entries(row.view.leeway)["red"]), (
            "its slider does not reach there"
        )
        assert row.slider.toolTip().startswith("Set the front length, 80 to 112 % of the original.")
        window.lines_controller.commit_length("mid-bust", 0.55)
        yield settled(window)
        yield lambda: row.view.leeway is not None and not row.view.stale
        frame, leeway = window.session.frame, row.view.leeway
        assert frame is not None
        assert leeway is not None
        assert frame.verdict.display_state == "folded"
        assert leeway.at(0.55).tone == "red"
        assert "folded below 67.7 %".replace(" ", "\N{NO-BREAK SPACE}") in legend_entries(leeway)["red"], (
            "kept together"
        )
        assert (
            plain(legend_entries(leeway)["red"])
            == "Overstrained below 85.8 % \N{MIDDLE DOT} folded below 67.7 %"
        )
        assert "Folded below 67.7 %: a triangle" in plain(hint(leeway, 0.55))
        assert row.slider.toolTip().startswith("Set the front length, 50 to 112 % of the original.")
        row.slider.setSliderDown(True)  # a frame of the length before may still come
        row.slider.setValue(90_000)
        row.slider.committed.emit(0.9)
        yield settled(window)
        yield lambda: row.view.ratio == 0.9
        row.slider.setSliderDown(False)
        assert (row.view.ratio, row.slider.ends()) == (0.9, (0.5, 1.12)), "it keeps still under the hand"
        window.session.undo_stack.undo()
        window.session.undo_stack.undo()
        yield settled(window)
        assert row.slider.ends() == (0.8, 1.12)

    run_main([], script)


def test_where_pressure_is_known_nothing_is_said_of_it_but_where_it_is_too_much() -> None:
    pressing = Zone("amber", 0.5, 0.78, (Reason("pressing", 0.5, 0.78),))
    known = LengthLimits("waist", (pressing, Zone("green", 0.78, 1.3)), pressure_known=True)
    assert plain(hint(known, 0.6)).endswith(
        "Contact pressure too high below 78.0 %: contact pressure of the band exceeds 4 kPa in places."
    )
    assert "not checked" not in hint(known, 0.9)


def test_what_the_other_lines_do_is_told_as_theirs() -> None:
    assert short_reason(Reason("strained", 0.5, 1.3, others=True)) == (
        "strained due to other lines, at any length"
    )
    assert (
        short_reason(Reason("strained", 0.95, 1.3, others=True))
        == "strained above 95.0 % (due to other lines)"
    )
    assert short_reason(Reason("vibrating", 0.88, 0.92)) == "may oscillate from 88.0 to 92.0 %"


def test_an_opened_row_has_a_key_to_its_zones(qtbot: QtBot) -> None:
    assert {tone: plain(words) for tone, words in legend_entries(LEEWAY).items()} == {
        "green": "Valid shape (contact pressure not checked) from 93.9 to 98.1 %",
        "amber": "Strained below 93.9 %",
        "red": "Folded below 86.0 %",
        "slack": "Slack above 98.1 %",
    }
    free = LengthLimits("waist", (Zone("green", 0.5, 1.3),))
    assert legend_entries(free) == {"green": "Valid shape (contact pressure not checked) at any length"}
    shown = LimitsLegend()
    qtbot.addWidget(shown)
    for leeway, ratio, lit in (
        (LEEWAY, 0.9, ("amber", "warn")),
        (LEEWAY, 0.8, ("red", "bad")),
        (free, 0.9, ()),
    ):
        shown.show_leeway(leeway, ratio, stale=False)
        seen = [tone for tone, (_, words) in shown.rows.items() if not words.isHidden()]
        assert seen == list(legend_entries(leeway)), "a zone that the line does not have needs no words"
        tones = {tone: words.property("tone") for tone, (_, words) in shown.rows.items()}
        assert [(tone, value) for tone, value in tones.items() if value] == ([lit] if lit else [])
    shown.show_leeway(LEEWAY, 0.9, stale=True)
    assert {words.property("tone") for _, words in shown.rows.values()} == {"faint"}


def test_the_key_says_where_green_is_no_word_on_pressure(qtbot: QtBot) -> None:
    shown = LimitsLegend()
    qtbot.addWidget(shown)
    green = Zone("green", 0.5, 1.3)
    words = shown.rows["green"][1]
    for known, told in ((False, "Valid shape (contact pressure not checked)"), (True, "Valid shape")):
        shown.show_leeway(LengthLimits("waist", (green,), pressure_known=known), 0.9, stale=False)
        assert words.text() == f"{told} at any length"
        assert shown.pressure.isHidden()
    for pressed, tone, seen in (
        ("1.0 kPa", "ok", ""),
        ("3.0 kPa", "warn", "warn"),
        ("47.7 kPa", "bad", "bad"),
    ):
        shown.show_leeway(LengthLimits("waist", (green,)), 0.9, False, pressed, tone)
        assert shown.pressure.text() == f"Contact pressure: {pressed}"
        assert shown.pressure.property("tone") == tone
        assert words.property("tone") == seen, "a valid shape has no other colour than its pressure"


def test_what_a_line_stands_in_and_why_a_hand_is_held_is_told() -> None:
    assert [tone_at(LEEWAY, ratio) for ratio in (0.8, 0.9, 0.95, 1.1)] == ["bad", "warn", "", ""]
    assert resistance_reason(LEEWAY) == "Cannot be shorter: folded below 86.0 %."
    assert (resistance_reason(None), tone_at(None, 0.9)) == ("", "")


def test_the_groove_shows_what_lies_between_its_ends() -> None:
    assert _zones(LEEWAY, (0.8, 1.12)) == [
        ("red", 0.8, 0.86),
        ("amber", 0.86, 0.939),
        ("green", 0.939, 0.981),
        ("slack", 0.981, 1.12),
    ]
    assert [zone[0] for zone in _zones(LEEWAY, (0.9, 1.12))] == ["amber", "green", "slack"]
    assert (wall_of(LEEWAY, 0.95, 0.8), wall_of(LEEWAY, 0.85, 0.8), wall_of(None, 0.9, 0.8)) == (
        0.86,
        None,
        None,
    )


@pytest.fixture
def slider(qtbot: QtBot) -> LengthSlider:
    slider = LengthSlider()
    set_tip(slider, "keys")
    slider.resize(300, 28)
    qtbot.addWidget(slider)
    slider.show()
    return slider


def hovered(slider: LengthSlider, ratio: float) -> str:
    at = QPoint(round(slider.x_of(ratio)), 10)
    QApplication.sendEvent(slider, QHelpEvent(QEvent.Type.ToolTip, at, slider.mapToGlobal(at)))
    return plain(shown_tip(slider))


def test_a_slider_tells_the_zone_under_the_pointer_and_on_its_handle_the_set_one(
    slider: LengthSlider,
) -> None:
    slider.set_leeway(LEEWAY)
    slider.set_ratio(0.97)
    assert hovered(slider, 0.9).startswith("Amber from")
    assert hovered(slider, 0.978).startswith("Green from"), (
        "the handle reaches a little further than its length"
    )
    assert hovered(slider, 0.9).endswith("\n\nkeys")
    slider.set_leeway(LEEWAY, stale=True)
    assert hovered(slider, 0.9) == "Computing length limits…\n\nkeys", "nothing is told of zones that are old"


def test_zones_follow_an_edit_while_the_model_still_settles(monkeypatch: pytest.MonkeyPatch) -> None:
    """Turns are made so slowly that nothing settles; zones come all the same, the selected first."""
    order: list[str] = []
    work_out = app.gui.features.lines.limits_controller.length_limits_of
    seen = threading.Event()  # the zones of before, faint: new ones may be too quick for a look
    seen.set()

    def noted(stages, name, progress, **how):  # type: ignore[no-untyped-def]
        order.append(name)
        seen.wait(PATIENCE)
        return work_out(stages, name, progress, **how)

    monkeypatch.setattr(app.gui.features.lines.limits_controller, "length_limits_of", noted)

    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.selection.select_line("full-bust")
        row = window.lines.rows["full-bust"]
        yield lambda: row.view.leeway is not None and not row.view.stale
        before = row.view.leeway
        window.session.set_pace(5.0)
        order.clear()
        seen.clear()
        window.session.change({"line_stiffness": 40.0}, "stiffer")
        _, said = row.details._key.rows["green"]
        yield lambda: row.view.stale
        assert said.property("tone") == "faint"
        seen.set()
        yield lambda: row.view.leeway is not before and not row.view.stale
        assert said.property("tone") == ""
        assert not settled(window)()
        yield lambda: not window.lines.rows["mid-bust"].view.stale
        assert order == ["full-bust", "mid-bust"]
        window.session.set_pace(None)

    run_main([], script)
