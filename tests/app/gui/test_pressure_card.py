"""What is said of contact pressure beside the cut list: words, lights, the small scale, in two languages."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import pytest
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QApplication

from app.gui.features.garment.pressure_card import PressureCard
from app.gui.features.maps.color_bar import BAR
from app.gui.features.maps.legend import Legend
from app.gui.theme.stylesheet import tokens_of
from app.i18n.catalog import use_language
from app.presenters.maps import map_kinds, ramp_of
from app.presenters.pressure import pressure_summary, pressure_views, rating_limits, side_text
from core.document.design import Design, ScanSource
from core.garment.body_location import SHOULDERS, SIDES
from core.garment.pressure import AMBER, GREEN, RED, pressure_limits
from core.garment.pressure_list import PressureList, PressureRow
from core.messages import Message

DESIGN = Design(ScanSource("anna.ply")).with_line("mid-bust", 0.8)
ROW = PressureRow(
    *("mid-bust", "mid-bust", "Picot edge 10 mm", 10.0, 1.0, 1.23, 9.2, 2.44, 18.3, "back left", 341.7),
    place=(1.0, 2.0, 341.7),
    light=AMBER,
    force_n=5.5,
    bridged_mm=89.0,
)
LISTED = PressureList((ROW,), {})


@pytest.fixture
def card(qapp: QApplication) -> PressureCard:
    card = PressureCard(rating_limits())
    card.resize(300, 400)
    return card


def test_a_row_tells_its_largest_pressure_and_more_where_it_is_pointed_at() -> None:
    view = pressure_views(LISTED, DESIGN, stale=False)["mid-bust"]
    assert (view.kpa, view.light, view.word, view.stale) == ("2.4", AMBER, "snug", False)
    assert view.tip.splitlines()[:3] == [
        "Maximum 2.4 kPa · 18 mmHg, back left, 342 mm above the lowest point of the scan",
        "Mean on the skin 1.2 kPa · 9 mmHg",
        "Total force on the skin 5.5 N",
    ]
    assert view.tip.endswith(pressure_limits().lights[AMBER].en)
    stale = pressure_views(LISTED, DESIGN, stale=True)["mid-bust"]
    assert (stale.kpa, stale.light, stale.word, stale.stale) == ("2.4", "", "", True)


def test_a_line_that_is_not_known_says_why() -> None:
    row = PressureRow("mid-bust", "mid-bust", "", notes=(Message("Slack: no contact pressure."),))
    view = pressure_views(PressureList((row,), {}), DESIGN, stale=False)["mid-bust"]
    assert (view.kpa, view.light, view.tip) == ("", "", "Slack: no contact pressure.")
    summary = pressure_summary(PressureList((row,), {}), DESIGN)
    assert (summary.largest, summary.says) == ("", "No active line with known tension presses on the skin.")
    assert pressure_summary(None, DESIGN).says == "Computed when the solver has converged."


def test_the_card_says_how_much_where_and_what_that_means(card: PressureCard) -> None:
    card.show_summary(pressure_summary(LISTED, DESIGN), faint=False)
    assert (card.largest.text(), card.light.word, card.place.text()) == (
        "2.4 kPa · 18 mmHg",
        "snug",
        "Mid-bust, back left",
    )
    assert card.says.text() == pressure_limits().lights[AMBER].en
    card.show_summary(pressure_summary(PressureList((), {}), DESIGN), faint=False)
    assert card.largest.isHidden()
    assert card.place.isHidden()
    assert card.scale.isHidden()
    assert not card.says.isHidden()


def test_figures_of_a_former_shape_are_faint_and_have_no_light(card: PressureCard) -> None:
    card.show_summary(pressure_summary(LISTED, DESIGN), faint=True)
    assert card.light.isHidden()
    assert not card.place.isEnabled()
    assert card.largest.property("tone") == "faint"
    card.show_summary(pressure_summary(LISTED, DESIGN), faint=False)
    assert not card.light.isHidden()
    assert card.place.isEnabled()
    assert card.largest.property("tone") == ""


def test_a_light_is_a_word_too(card: PressureCard) -> None:
    for light, word in ((GREEN, "gentle"), (AMBER, "snug"), (RED, "too tight")):
        listed = PressureList((replace(ROW, light=light),), {})
        card.show_summary(pressure_summary(listed, DESIGN), faint=False)
        assert (card.light.word, card.light.accessibleName()) == (word, word)


def test_limits_stand_a_third_apart_and_what_is_far_beyond_stands_at_the_end(card: PressureCard) -> None:
    scale = card.scale
    scale.resize(300, scale.sizeHint().height())
    ends = [scale.x_of(kpa) for kpa in (0.0, 2.0, 4.0, 6.0)]
    assert [b - a for a, b in pairwise(ends)] == pytest.approx([96.0] * 3)
    assert scale.x_of(80.0) == ends[-1] < scale.width()
    scale.show_marks((("Mid-bust", "#123456", 3.0), ("Waist", "#654321", 80.0)), faint=False)
    image = scale.grab().toImage()
    ratio = image.devicePixelRatio()
    for kpa, colour in ((3.0, "#123456"), (80.0, "#654321")):
        seen = image.pixelColor(round(scale.x_of(kpa) * ratio), round(8 * ratio))
        assert seen == QColor(colour)
    assert "Waist 80.0 kPa" in scale.accessibleName()


def test_the_legend_marks_the_limits_in_their_tones(qapp: QApplication) -> None:
    legend = Legend(map_kinds())
    stops = ramp_of("pressure", 0.0, 5.0, "#DFD5CA").stops

    def away(name: str, kpa: float, tone: str) -> int:
        """How far the colours at a limit are from a tone, at the nearest pixel."""
        legend.show_map(name)
        legend.show_range(0.0, 5.0, stops, False)
        image = legend.bar.grab().toImage()
        x, y = (round(at * image.devicePixelRatio()) for at in (BAR.center().x(), legend.bar.y_of(kpa)))
        wanted = QColor(tone).getRgb()
        seen = [image.pixelColor(x, y + row).getRgb() for row in (-2, -1, 0, 1, 2)]
        return min(sum(abs(a - b) for a, b in zip(each, wanted, strict=True)) for each in seen)

    tokens = tokens_of(legend)
    for kpa, tone in ((2.0, tokens.warn), (4.0, tokens.bad)):
        assert away("pressure", kpa, tone) < 30 < away("strain", kpa, tone)


def test_all_of_it_is_said_in_japanese() -> None:
    english = rating_limits(), [side_text(side) for side in (*SIDES, *SHOULDERS)]
    use_language("ja")
    limits, sides = rating_limits(), [side_text(side) for side in (*SIDES, *SHOULDERS)]
    assert len(set(sides)) == len(sides)
    assert not set(sides) & set(english[1])
    assert not set(limits.words) & set(english[0].words)
    assert all("。" in each for each in (*limits.sources, *limits.left_out))
    assert len(limits.sources) == len(pressure_limits().sources) + len(pressure_limits().doubts)
    assert "繊維学会誌" in " ".join(limits.sources)
    assert not any(word in " ".join(limits.sources) for word in ("Gakkaishi", "Senshoshi", "abstract"))
    view = pressure_views(LISTED, DESIGN, stale=False)["mid-bust"]
    assert view.word == "きつめ"
    assert "左後ろ" in view.tip
