"""What the way of a line leaves out to be quick, and that nothing is lost by it."""

from dataclasses import replace

import numpy as np
import pytest

import core.analysis.length_limits.limits
from core.analysis.length_limits.bracketing import _worth_a_look
from core.analysis.length_limits.criteria import COSTLY
from core.analysis.length_limits.limits import limits_of
from core.analysis.length_limits.samples import Length, Sample, extrapolate, nearest
from core.document.lines import ActiveLine
from core.garment.elastic_library import find_elastic
from core.mechanics.solver_comparison import shape_of
from core.pipeline.build import build
from core.pipeline.solve import exact_equilibrium


def stops_with(margin, ratios):
    """Stops of which the margin of "vibrating" is known, and how often it was asked for."""
    asked = []

    def look(found):
        asked.append(found)
        return margin(found)

    return [Sample(Length(ratio, 0.0), ratio, {"vibrating": look}) for ratio in ratios], asked


def test_a_margin_that_runs_straight_is_looked_at_three_times() -> None:
    stops, asked = stops_with(lambda ratio: 0.08 + 0.05 * ratio, np.linspace(0.5, 1.0, 21))
    assert [stop.length.ratio for stop in _worth_a_look(stops, "vibrating")] == [0.5, 0.75, 1.0]
    assert len(asked) == 3


def test_where_a_margin_vanishes_neighbours_are_looked_at() -> None:
    stops, asked = stops_with(lambda ratio: ratio - 0.66, np.linspace(0.5, 1.0, 21))
    seen = [stop.length.ratio for stop in _worth_a_look(stops, "vibrating")]
    assert {0.65, 0.675} <= {round(ratio, 3) for ratio in seen}
    assert len(asked) < 10


@pytest.mark.parametrize("middle", [0.58, 0.66, 0.71, 0.86])
def test_a_dip_between_the_first_looks_is_found(middle: float) -> None:
    stops, _ = stops_with(lambda ratio: 3.0 * (ratio - middle) ** 2 - 0.002, np.linspace(0.5, 1.0, 21))
    looked = _worth_a_look(stops, "vibrating")
    assert any(stop.shows("vibrating") for stop in looked)
    assert not looked[0].shows("vibrating")


def test_the_nearest_stops_lie_round_a_length() -> None:
    stops, _ = stops_with(float, [0.8, 0.85, 0.9, 0.95, 1.0])

    def found(ratio, count):
        return [stop.length.ratio for stop in nearest(stops, ratio, count)]

    assert found(0.87, 2) == [0.85, 0.9]
    assert found(0.81, 3) == [0.8, 0.85, 0.9]
    assert found(1.2, 3) == [0.9, 0.95, 1.0]
    assert found(0.9, 9) == [0.8, 0.85, 0.9, 0.95, 1.0]


def walked(stages, name, monkeypatch):
    """The limits of a line, and the walk that told them."""
    walks = []

    class Noted(core.analysis.length_limits.limits.LineSearch):
        def __init__(self, *given):
            super().__init__(*given)
            walks.append(self)

    monkeypatch.setattr(core.analysis.length_limits.limits, "LineSearch", Noted)
    return limits_of(stages, name, through=False), walks[0]


def test_the_way_of_an_elastic_takes_long_strides_and_few_costly_looks(built, monkeypatch) -> None:
    stages = built("person")
    design = replace(stages.design, lines=(ActiveLine("mid-bust", 0.9), ActiveLine("full-bust", 0.95)))
    stages = build(design.with_elastic("mid-bust", find_elastic("strap 15")), stages)
    limits, walk = walked(stages, "mid-bust", monkeypatch)
    way = limits.rest.ratio - limits.evaluated.short.ratio
    assert way > 0.4
    assert len(walk.stops) < way / 0.025 * 0.7
    looked = {sign: sum(sign in stop.known for stop in walk.stops) for sign in COSTLY}
    assert looked["vibrating"] == 3
    assert looked["pressing"] <= 8
    begins = limits.below("pressing")
    assert begins is not None
    three = [stop for stop in walk.stops if abs(stop.length.ratio - 0.7) < 0.1][:3]
    way_on = extrapolate(three, 0.7).points
    there = walk.solve_near(0.7, three[0].found)
    assert np.abs(way_on - there.found.points).max() < 0.1, "strides are as long as guesses are good"


@pytest.mark.parametrize(
    ("sample", "contact", "sign"), [("mannequin", "glued", "overstrained"), ("person", "sliding", "strained")]
)
def test_zones_are_those_of_the_volume_that_a_design_holds(built, sample, contact, sign) -> None:
    """Held by the control mesh, strain begins up to half a percent away from there."""
    stages = built(sample)
    design = replace(stages.design, dense_volume=True, line_contact=contact, volume="exact")
    dense = build(replace(design, lines=(ActiveLine("full-bust", 1.0),)), stages)
    begins = limits_of(dense, "full-bust", through=False).onsets[sign].ratio
    for ratio, shown in ((begins - 1e-3, True), (begins + 1e-3, False)):
        tried = build(replace(design, lines=(ActiveLine("full-bust", ratio),)), dense)
        points = tried.model.tensegric.expand(exact_equilibrium(tried).state.moved)
        assert getattr(shape_of(tried.model).quality(points), sign) == shown
    plain = build(replace(dense.design, dense_volume=False), dense)
    assert abs(limits_of(plain, "full-bust", through=False).onsets[sign].ratio - begins) > 1.5e-3
