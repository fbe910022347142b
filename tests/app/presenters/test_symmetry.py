"""What the card of left and right says: sides, what is done first, and what is not told of a doubtful run."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.i18n.catalog import using_language
from app.presenters.samples import sample_design
from app.presenters.symmetry import (
    SymmetryView,
    balance_result_texts,
    has_balance_targets,
    map_note,
    symmetry_view,
)
from core.analysis.inverse_design.quantity import Goal
from core.analysis.inverse_design.solve import InverseResult
from core.analysis.symmetry.compare import BeforeAfter, SideDifference, compare_sides
from core.control_mesh.template import read_template
from core.document.line_notation import ready_made_lines
from core.document.lines import LineSettings
from core.document.split_lines import split
from core.measurements.mirrored_surface import SkinGap
from core.measurements.uncertain_value import SOURCES, OutputUncertainties, Uncertainty
from core.pipeline.build import Stages, build

TEMPLATE = read_template("168")


@pytest.fixture(scope="module")
def person() -> Stages:
    return build(sample_design("person").with_line("mid-bust", 0.97))


@pytest.fixture(scope="module")
def told(person: Stages) -> BeforeAfter:
    return compare_sides(person, person.control.mesh.vertices)


def test_each_figure_names_the_side_that_is_more(person: Stages) -> None:
    left = SideDifference(2.04, 0.3, -0.04, SkinGap(1.0, 3.0, "left", 0, 41.0, 12.0, 1.0))
    summary = symmetry_view(BeforeAfter(left, replace(left, higher=-1.2), ()), person)
    views = {view.title: view for view in summary.views}
    assert summary.says == "Bust points: right 1.2 mm higher."
    assert (views["Height [mm]"].before, views["Height [mm]"].after) == (
        "L 2.0",
        "R 1.2",
    )
    assert views["Height [mm]"].shares == pytest.approx((0.204, -0.12))
    assert views["Lateral offset [mm]"].after == "0.0"
    assert views["Excess volume [ml]"].after == "L 29", "what the legend of the map tells, all in all"
    assert "left 41 ml, right 12 ml" in map_note(BeforeAfter(left, left, ()), True)
    assert views["Mean distance [mm]"].shares == (None, None)
    none = symmetry_view(BeforeAfter(left, replace(left, skin=None), ()), person).views
    assert next(view for view in none if view.title == "Mean distance [mm]").after == "–"


def test_a_difference_within_the_error_is_said_to_be_none(person: Stages) -> None:
    now = SideDifference(-2.0, 3.0, 0.0, None)
    offs = {"after:asymmetry_height": 5.9, "after:asymmetry_forward": 1.2}

    def told(higher: float, out: float) -> SymmetryView:
        doubts = {key: Uncertainty({"scan": 0.5 * off}) for key, off in offs.items()}
        spread = OutputUncertainties(doubts, np.zeros(0), 0.2, 2.0, SOURCES, {}, "sliding")
        there = replace(now, higher=higher, further_out=out)
        return symmetry_view(BeforeAfter(there, there, ()), person, spread=spread)

    both = told(-2.0, 3.0)
    assert both.says == "Bust points: right 2.0 ± 5.9 mm higher, left 3.0 ± 1.2 mm further forward."
    assert [(view.off, view.within) for view in both.views[:3]] == [
        ("± 5.9", True),
        ("± 1.2", False),
        ("", False),
    ]
    assert "No significant difference." in both.views[0].tip
    assert (
        told(-2.0, 0.1).says
        == "Bust points: right 2.0 ± 5.9 mm higher. No significant difference in position."
    )


def test_of_a_doubtful_run_only_before_is_told(person: Stages, told: BeforeAfter) -> None:
    summary = symmetry_view(told, person, "It vibrates.")
    assert not summary.possible
    assert summary.hint == "It vibrates."
    assert summary.says == "Bust points before: right 11.8 mm higher.", "no word of it is of now"
    assert {view.after for view in summary.views} == {"–"}
    assert summary.views[0].before == "R 11.8"


def test_the_hint_says_what_is_parted_first_or_what_is_lacking(person: Stages, told: BeforeAfter) -> None:
    design = person.design
    for line in ready_made_lines(TEMPLATE)["straps"]:
        design = design.with_custom_line(line).with_line(line.name, 0.95)
    summary = symmetry_view(told, build(design, person))
    assert summary.hint == "Balancing unlinks left and right: Mid-bust, Straps."
    assert summary.possible
    halves = symmetry_view(told, build(split(person.design, TEMPLATE, "mid-bust"), person))
    assert (halves.hint, halves.possible) == ("", True)
    locked = person.design.with_line_settings(LineSettings("mid-bust", locked=True))
    summary = symmetry_view(told, build(locked, person))
    assert "activate a line on one side" in summary.hint
    assert not summary.possible


def test_the_legend_tells_ml_of_what_is_shown(told: BeforeAfter) -> None:
    assert map_note(None, after=True) == ""
    skin = told.before.skin
    assert skin is not None
    after = replace(told.after, skin=replace(skin, left_more=3.2, right_more=7.9))
    both = BeforeAfter(told.before, after, ())
    assert map_note(both, after=True).endswith("left 3 ml, right 8 ml")
    assert map_note(both, after=False).endswith(
        f"left {skin.left_more:.0f} ml, right {skin.right_more:.0f} ml"
    )


def evened(**changes: object) -> InverseResult:
    """The answer of a design whose left breast sits lower."""
    reached = {"left higher": -2.7, "left further out": -3.6, "lift": 4.2}
    design = sample_design("person")
    for name, ratio in (("strap right", 0.999), ("mid-bust left", 0.999), ("mid-bust right", 0.95)):
        design = design.with_line(name, ratio)
    at_end = ("strap right", "mid-bust left")
    plain = InverseResult(
        design, reached, False, 2.7, at_end, (), (), True, True, {}, 4.0, (), 1.0, 3, longest=0.999
    )
    return replace(plain, **changes)


EVEN = (Goal("left higher", 0.0), Goal("left further out", 0.0), Goal("lift", 6.9))
BY_TURNS = (
    "Values of the exact solution, which conserves the volume of each breast. Iterations conserve "
    "the combined volume: in Measurements, lengths may differ by up to 1 mm and volumes by 10 to 20 ml."
)
NOW = {"left higher": -11.5, "left further out": -0.1, "lift": 6.9, "out": 1.2}


def test_what_makes_it_even_is_told_from_where_to_where_with_its_price() -> None:
    assert has_balance_targets(EVEN)
    assert not has_balance_targets(EVEN[2:])
    said, price, why = balance_result_texts(evened(), EVEN, NOW, {"out": -3.0})
    assert said.splitlines() == [
        "Not reachable. Closest result:",
        "Right higher: 11.5 → 2.7 mm",
    ]
    assert price == (
        "Trade-off: Right further forward 0.1 → 3.6 mm, Bust point lift +6.9 → +4.2 mm, Bust "
        "point, forward +1.2 → −3.0 mm"
    )
    assert why == (
        "Stopped at a limit: Strap (right): longest length, 99.9 %; Mid-bust (left): longest length, "
        f"99.9 %; skin strain limit of 20 %.\n{BY_TURNS}"
    )
    with using_language("ja"):
        said, _, why = balance_result_texts(evened(), EVEN, NOW, {"out": -3.0})
        assert said.splitlines()[1] == "右が高い：11.5 → 2.7 mm"
        assert "ストラップ（右）：最長の長さ" in why


def test_a_side_that_changes_is_named_and_what_is_even_has_none() -> None:
    turned = evened(reached={"left higher": 2.0, "left further out": 0.0}, reachable=True)
    said, price, why = balance_result_texts(turned, EVEN[:2], NOW, {"lift": 6.9, "out": 1.2})
    assert said.splitlines() == [
        "All targets reached.",
        "Right higher 11.5 mm → Left higher 2.0 mm",
        "Right further forward: 0.1 → 0.0 mm",
    ]
    assert (price, why) == ("", BY_TURNS), "turns keep the volume of both breasts together, and end elsewhere"
    for same in ({"volume": "exact"}, {"volume_of": "both"}):
        exact = replace(turned, design=replace(turned.design, **same))
        assert balance_result_texts(exact, EVEN[:2], NOW, {"lift": 6.9, "out": 1.2})[2] == ""
    said, price, why = balance_result_texts(evened(agreed=False), EVEN, NOW, {"out": 1.2})
    assert said.startswith("Closest result:\n")
    assert price.startswith("Trade-off: ")
    assert why.startswith("The iteration over lengths, elastics and contact pressure did not converge.")
