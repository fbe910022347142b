"""The leeway of a line: zones of all its lengths, what makes them so, and what they are against runs."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from core.analysis.length_limits.limits import Length, Limits, Span, limits_of
from core.analysis.length_limits.zones import LengthLimits, Reason, length_limits_of, to_length_limits
from core.document.lines import ActiveLine
from core.garment.elastic_library import find_elastic
from core.garment.pressure import pressure_limits, pressures
from core.garment.tension import line_tensions
from core.mechanics.constraint_lines import RATIO_LIMITS
from core.mechanics.exact_solution import solve_exact
from core.mechanics.iteration import LineTargets, iterate
from core.pipeline.build import Stages, build
from core.pipeline.model_stages import line_targets


def dressed(built, sample="mannequin", elastic=None, **lines) -> Stages:
    """A sample with these lines worn; ``elastic`` for the mid-bust line; other words are of the design."""
    stages = built(sample)
    ratios = {name.replace("_", "-"): lines.pop(name) for name in ("mid_bust", "full_bust") if name in lines}
    worn = tuple(ActiveLine(name, ratio) for name, ratio in sorted(ratios.items(), reverse=True))
    design = replace(stages.design, lines=tuple(sorted(worn, key=lambda line: line.name)), **lines)
    if elastic:
        design = design.with_elastic("mid-bust", find_elastic(elastic))
    return build(design, stages)


def span(short, long):
    return Span(Length(short, 400.0 * short), Length(long, 400.0 * long))


def limits_that(built, shows, looked=(0.8, 1.05), **more) -> Limits:
    line = next(line for line in built("mannequin").model.lines if line.name == "mid-bust")
    return Limits(line, None, (), shows, Length(1.0, 400.0), span(*looked), **more)


def tones(found: LengthLimits):
    return [(zone.tone, round(zone.short, 4), round(zone.long, 4)) for zone in found.zones]


def reason(found: LengthLimits | None, why: str) -> Reason:
    assert found is not None
    return next(each for zone in found.zones for each in zone.reasons if each.why == why)


def test_zones_follow_from_what_shows_where(built):
    shows = {"strained": (span(0.8, 0.94),), "folded": (span(0.8, 0.85),), "slack": (span(1.0, 1.05),)}
    found = to_length_limits(limits_that(built, shows))
    assert tones(found) == [
        ("red", 0.5, 0.85),
        ("amber", 0.85, 0.94),
        ("green", 0.94, 1.0),
        ("slack", 1.0, 1.3),
    ]
    assert found.red_below == 0.85
    assert [found.at(ratio).tone for ratio in (0.4, 0.9, 0.94, 1.0, 1.2)] == [
        "red",
        "amber",
        "green",
        "green",
        "slack",
    ]
    assert found.at(0.9).reasons == (Reason("strained", 0.5, 0.94),)
    assert [each.why for each in found.at(0.7).reasons] == ["folded", "strained"]


def test_a_reason_that_comes_and_goes_is_told_where_it_is(built):
    found = to_length_limits(limits_that(built, {"vibrating": (span(0.88, 0.92),)}))
    assert tones(found) == [("green", 0.5, 0.88), ("amber", 0.88, 0.92), ("green", 0.92, 1.3)]
    assert found.red_below is None


def test_what_swings_under_any_control_is_not_told_of_the_conventional_one_too(built):
    shows = {"vibrating": (span(0.88, 0.92),), "restless": (span(0.86, 0.94),)}
    found = to_length_limits(limits_that(built, shows))
    assert tones(found) == [("green", 0.5, 0.86), ("amber", 0.86, 0.94), ("green", 0.94, 1.3)]
    assert found.at(0.9).reasons == (Reason("restless", 0.86, 0.94),)


def test_after_the_first_red_all_is_red(built):
    shows = {"overstrained": (span(0.8, 0.82), span(0.86, 0.9)), "strained": (span(0.8, 0.95),)}
    found = to_length_limits(limits_that(built, shows))
    assert tones(found)[0] == ("red", 0.5, 0.9)
    assert to_length_limits(limits_that(built, shows, last=Length(0.8, 320.0))).red_below == 0.9


def test_what_is_red_at_rest_may_be_mended_by_a_shorter_line(built):
    shows = {"overstrained": (span(0.8, 0.85), span(0.97, 1.05)), "strained": (span(0.8, 1.05),)}
    found = to_length_limits(limits_that(built, shows))
    assert [tone for tone, *_ in tones(found)] == ["red", "amber", "red"]
    assert found.red_below == 0.85
    assert found.at(1.0).reasons[0].others
    assert found.at(0.9).reasons[0].is_independent


def test_no_balance_is_red_and_none_at_all_has_no_zones(built):
    found = to_length_limits(limits_that(built, {"strained": ()}, last=Length(0.83, 330.0)))
    assert tones(found) == [("red", 0.5, 0.83), ("green", 0.83, 1.3)]
    assert found.at(0.6).reasons[0].why == "unreachable"
    nowhere = replace(limits_that(built, {}), rest=None, evaluated=None, found=False)
    assert to_length_limits(nowhere) is None


@pytest.mark.parametrize("contact", ["glued", "sliding"])
@pytest.mark.parametrize("sample", ["mannequin", "person"])
def test_zones_cover_all_lengths_once(built, sample, contact):
    found = length_limits_of(dressed(built, sample, mid_bust=0.95, line_contact=contact), "full-bust")
    assert (found.zones[0].short, found.zones[-1].long) == RATIO_LIMITS
    for one, other in pairwise(found.zones):
        assert one.long == other.short
        assert one.tone != other.tone


def swings(stages: Stages, name: str, ratio: float) -> float:
    """How the flip-flop of the conventional volume error grows over 200 late turns, made from rest [1]."""
    lines = tuple(
        ActiveLine(each.name, ratio if each.name == name else each.ratio) for each in stages.design.lines
    )
    stages = build(replace(stages.design, lines=lines), stages)
    targets = LineTargets(line_targets(stages.design, stages).ratios, "conventional", stages.gain)
    made = iterate(stages.model, lambda: targets, turns=900)
    flips = np.abs(np.diff([record.error for _, record in made], 2))
    return float(flips[-20:].mean() / flips[-220:-200].mean())


@pytest.mark.parametrize(
    ("sample", "words"),
    [
        ("mannequin", {"mid_bust": 0.9, "full_bust": 0.998}),
        ("person", {"mid_bust": 0.9, "full_bust": 0.998, "line_hold": "held"}),
        ("person", {"mid_bust": 0.9, "full_bust": 0.98, "member_law": "co-rotated"}),
        ("mannequin", {"mid_bust": 0.9, "full_bust": 1.04, "line_contact": "sliding", "gain": 1.53}),
    ],
)
def test_turns_swing_where_it_is_told_and_not_a_percent_away(built, sample, words):
    stages = dressed(built, sample, **words)
    found = limits_of(stages, "mid-bust")
    ends = [
        (end.ratio, side)
        for each in found.shows["vibrating"]
        for end, side in ((each.short, -1.0), (each.long, 1.0))
        if found.evaluated.short.ratio < end.ratio < found.evaluated.long.ratio
    ]
    assert ends
    for ratio, calm in ends:
        assert swings(stages, "mid-bust", ratio - 0.012 * calm) > 0.99
        assert swings(stages, "mid-bust", ratio + 0.012 * calm) < 0.9


def rests(stages: Stages, ratio: float) -> bool:
    """Whether turns of the adaptive control, with the mid-bust line at this length, come to rest."""
    stages = build(stages.design.with_line("mid-bust", ratio), stages)
    targets = LineTargets(line_targets(stages.design, stages).ratios)
    return any(made.step < 1e-6 for _, made in iterate(stages.model, lambda: targets, turns=1000))


def test_lines_that_act_one_turn_late_are_amber_where_turns_never_rest(built):
    words = {"mid_bust": 0.95, "full_bust": 0.93, "line_force": "explicit", "line_contact": "sliding"}
    stages = dressed(built, "person", **words, line_stiffness=1.0)
    found = length_limits_of(stages, "mid-bust")
    end = reason(found, "restless").long
    assert found.at(end - 0.01).tone != "green"
    assert not rests(stages, end - 0.01)
    assert rests(stages, end + 0.012)


def test_lines_far_too_stiff_to_act_one_turn_late_are_green_nowhere(built):
    words = {"mid_bust": 0.95, "full_bust": 0.93, "line_force": "explicit"}
    found = length_limits_of(dressed(built, "person", **words), "mid-bust")
    assert "green" not in [zone.tone for zone in found.zones]
    assert reason(found, "restless").is_independent
    soft = length_limits_of(dressed(built, "person", **words, line_stiffness=0.2), "mid-bust")
    assert "green" in [zone.tone for zone in soft.zones]


def test_a_band_of_elastic_is_amber_where_it_presses_beyond_the_red_light(built):
    stages = dressed(built, "person", elastic="strap 15", mid_bust=0.9)
    found = length_limits_of(stages, "mid-bust")
    end = reason(found, "pressing").long
    assert found.pressure_known
    for ratio, beyond in ((end - 0.001, True), (end + 0.001, False)):
        there = build(stages.design.with_line("mid-bust", ratio), stages)
        balance = solve_exact(there.model, line_targets(there.design, there).ratios)
        pressed = pressures(there, there.model.tensegric.expand(balance.state.moved))
        assert (pressed["mid-bust"].largest > pressure_limits().red_kpa) == beyond
    assert not length_limits_of(stages, "full-bust").pressure_known


def test_lines_of_elastic_pull_at_each_length_as_they_would_be_built(built):
    stages = dressed(built, "person", elastic="strap 15", mid_bust=0.9, full_bust=0.95)
    found = limits_of(stages, "full-bust").onsets["strained"]
    there = build(stages.design.with_line("full-bust", found.ratio), stages)
    balance = solve_exact(there.model, line_targets(there.design, there).ratios)
    line = next(line for line in there.model.lines if line.name == "full-bust")
    points = there.model.tensegric.expand(balance.state.moved)
    assert line.length(points) == pytest.approx(found.reached, abs=1e-3)


def test_an_elastic_round_skin_that_stays_takes_no_zones_from_the_others(built):
    """The under-bust line moves nothing, and has a curve all the same: one that no other line comes to."""
    one = dressed(built, "person", elastic="strap 15", mid_bust=0.9)
    two = build(one.design.with_line("under-bust", 0.97).with_elastic("under-bust", find_elastic("plush 12")))
    assert not next(line for line in two.model.lines if line.name == "under-bust").constrains
    assert tones(length_limits_of(two, "mid-bust")) == tones(length_limits_of(one, "mid-bust"))


@pytest.mark.parametrize("hold", ["spring", "held"])
def test_a_line_longer_than_what_it_lies_on_is_slack(built, hold):
    """A shorter full-bust line takes length from below the mid-bust line, which would have to push."""
    stages = dressed(built, "person", full_bust=0.85, line_hold=hold)
    end = reason(length_limits_of(stages, "mid-bust"), "slack")
    assert end.short < 0.99
    assert end.others
    for ratio, pushes in ((end.short - 0.002, False), (end.short + 0.002, True)):
        there = build(stages.design.with_line("mid-bust", ratio), stages)
        balance = solve_exact(there.model, line_targets(there.design, there).ratios)
        tension = line_tensions(there, there.model.tensegric.expand(balance.state.moved))["mid-bust"]
        assert (tension.mean < 0.0) == pushes


def test_strain_that_goes_and_comes_within_a_stride_is_found(built):
    """Between two strained lengths 5 % apart lie calm ones, by a hair: 80.02 % of an edge's length."""
    stages = dressed(built, "mannequin", mid_bust=0.906, full_bust=0.998)
    spans = limits_of(stages, "full-bust", through=False).shows["strained"]
    assert len(spans) == 2
    assert spans[0].long.ratio == pytest.approx(0.952, abs=0.002)
    assert spans[1].short.ratio == pytest.approx(0.989, abs=0.002)
