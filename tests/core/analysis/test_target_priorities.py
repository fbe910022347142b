"""Targets that conflict: priorities decide, the price is named, inactive lines may be switched on."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import pytest
from shapes import SAMPLES

from app.cli.main import main
from app.cli.output import NOT_CONVERGED
from app.presenters.samples import sample_design
from core.analysis.inverse_design.line_selection import LineSelection, activated, optional_lines
from core.analysis.inverse_design.objective import NEAR, goal_weights
from core.analysis.inverse_design.quantities import tolerance
from core.analysis.inverse_design.quantity import PRIORITIES, Goal
from core.analysis.inverse_design.solve import InverseSolver, solve_targets
from core.analysis.inverse_design.target_requests import goals_of
from core.garment.elastic_library import find_elastic
from core.pipeline.build import Stages, build

SCAN = str(SAMPLES / "mannequin.ply")
AXES = ("--unit", "mm", "--up", "+z", "--front", "-y")


@pytest.fixture(scope="module")
def both() -> Stages:
    """Both lines that move the body are active, and slide."""
    design = replace(sample_design(), volume="exact", line_contact="sliding")
    return build(design.with_line("mid-bust", 1.0).with_line("full-bust", 1.0))


def conflicting(lift: str = "normal", girth: str = "normal") -> list[Goal]:
    return [Goal("lift", 12.0, lift), Goal("girth", 840.0, girth)]


def test_a_higher_priority_brings_its_target_nearer_and_the_other_gives_way(both: Stages) -> None:
    favoured = {
        priority: solve_targets(both, conflicting(lift=priority)).reached
        for priority in ("low", "normal", "high")
    }
    lifts = [favoured[priority]["lift"] for priority in ("low", "normal", "high")]
    girths = [abs(favoured[priority]["girth"] - 840.0) for priority in ("low", "normal", "high")]
    assert lifts == sorted(lifts)
    assert lifts[2] - lifts[0] > 10.0 * NEAR
    assert girths == sorted(girths)


def test_the_priority_of_one_target_or_of_all_alike_changes_nothing(both: Stages) -> None:
    for goals in ([Goal("girth", 840.0)], conflicting()):
        plain = solve_targets(both, goals)
        for priority in PRIORITIES:
            same = solve_targets(both, [replace(goal, priority=priority) for goal in goals])
            assert same.reached == pytest.approx(plain.reached, abs=1e-6)


def test_targets_that_can_all_be_met_are_met_whatever_their_priorities(both: Stages) -> None:
    truth = InverseSolver(build(both.design.with_line("mid-bust", 0.95).with_line("full-bust", 0.97), both))
    values, _ = truth.current_values(["lift", "girth"])
    goals = [Goal("lift", values["lift"], "low"), Goal("girth", values["girth"], "high")]
    assert solve_targets(both, goals).reachable
    assert solve_targets(
        both, [Goal("lift", values["lift"], "high"), Goal("girth", values["girth"], "low")]
    ).reachable


def test_weights_are_priorities_over_tolerances() -> None:
    weights = goal_weights([Goal("lift", 1.0, "low"), Goal("girth", 800.0, "high")])
    expected = PRIORITIES["low"] / tolerance("lift"), PRIORITIES["high"] / tolerance("girth")
    assert weights[0] / weights[1] == pytest.approx(expected[0] / expected[1])
    assert weights.max() == 1.0


def test_a_conflict_names_what_is_reached_alone_and_its_price(both: Stages) -> None:
    solver, goals = InverseSolver(both), conflicting()
    reply = solver.solve(goals)
    conflict = next(each for each in solver.conflicts(reply, goals) if each.name == "lift")
    alone = solve_targets(both, [Goal("lift", 12.0)])
    assert conflict.against == "girth"
    assert conflict.reached == pytest.approx(reply.reached["lift"], abs=1e-4)  # ratios have six decimals
    assert conflict.alone == pytest.approx(alone.reached["lift"], abs=2.0 * NEAR)
    assert conflict.kept == pytest.approx(reply.reached["girth"], abs=1e-4)
    lost = abs(conflict.lost - 840.0) - abs(conflict.kept - 840.0)
    assert conflict.price == pytest.approx(lost / (conflict.alone - conflict.reached), rel=1e-6)
    reached = Goal("girth", reply.reached["girth"])
    again = solver.solve([reached, Goal("lift", reply.reached["lift"])])
    assert solver.conflicts(again, [reached, goals[0]]) == ()


def test_a_target_that_is_no_nearer_alone_has_no_opponent(both: Stages) -> None:
    goals = [Goal("lift", 60.0), Goal("girth", 1200.0)]
    solver = InverseSolver(both)
    for conflict in solver.conflicts(solver.solve(goals), goals):
        assert conflict.against or conflict.alone == pytest.approx(conflict.reached, abs=2.0 * NEAR)


def test_a_line_that_is_off_is_switched_on_only_where_it_helps(both: Stages) -> None:
    start = build(both.design.with_line("full-bust", None), both)
    assert optional_lines(start) == (("full-bust",),)
    goals = [Goal("girth", 840.0)]
    without, solver = solve_targets(start, goals), LineSelection(start, ["full-bust"])
    better = solver.solve(goals)
    assert better.miss < without.miss - 1.0
    assert activated(start.design, better.design) == ("full-bust",)
    near = LineSelection(start, ["full-bust"]).solve([Goal("girth", without.reached["girth"])])
    assert activated(start.design, near.design) == ()
    nothing = build(start.design.with_line("mid-bust", None), start)
    from_nothing = LineSelection(nothing, ["mid-bust", "full-bust"]).solve(goals)
    assert activated(nothing.design, from_nothing.design)


def test_without_a_limit_of_pressure_elastics_may_press_harder(both: Stages) -> None:
    plush, design = find_elastic("plush 12"), both.design
    for name in ("mid-bust", "full-bust"):
        design = design.with_line(name, 0.9).with_elastic(name, plush)
    start = build(design, both)
    goals = [Goal("girth", 840.0)]
    kept, free = (
        InverseSolver(start, most_kpa=1.0).solve(goals),
        InverseSolver(start, most_kpa=math.inf).solve(goals),
    )
    assert max(kept.pressure.values()) < 1.05 < max(free.pressure.values())
    assert not free.at_pressure_limit


def test_the_command_reads_priorities_and_reports_conflicts(capsys: pytest.CaptureFixture[str]) -> None:
    assert goals_of(["lift = 12 mm @ High"]) == (Goal("lift", 12.0, "high"),)
    lines = ("--line", "mid-bust=100%", "--optional", "full-bust", "--pressure", "off")
    wants = ("--target", "lift=12mm@high", "--target", "girth=858mm")
    assert main(["target", SCAN, *AXES, *lines, *wants, "--json"]) == NOT_CONVERGED
    printed = json.loads(capsys.readouterr().out)
    assert printed["figures"]["lift"]["priority"] == "high"
    assert printed["switched_on"] == ["full-bust"]
    assert printed["limit_kpa"] is None
    assert {each["name"] for each in printed["conflicts"]} <= {"lift", "girth"}
    assert printed["conflicts"]
    assert main(["target", SCAN, *AXES, *lines, *wants]) == NOT_CONVERGED
    text = capsys.readouterr().out
    assert text.count("Full bust") >= 2, "as a changed and as an activated line"
    assert "even with no other target" in text


def test_what_the_limit_of_pressure_costs_is_told(both: Stages) -> None:
    solver, goals = LineSelection(both, most_kpa=4.0), [Goal("lift", 3.0)]
    reply = solver.solve(goals)
    free = solver.unlimited(reply, goals)
    assert free is not None
    assert free.miss < reply.miss - 1.0
    assert max(free.pressure.values()) > 4.0 > max(reply.pressure.values())
    met = solver.solve([Goal("lift", reply.reached["lift"])])
    assert solver.unlimited(met, [Goal("lift", reply.reached["lift"])]) is None
