"""Targets of the lower trunk: figures as they are measured, their slopes, and lengths that reach them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from slopes import doubled, slope
from whole_trunk import trunk_stages, wearing

from core.analysis.inverse_design.profile_quantities import profile_name
from core.analysis.inverse_design.quantities import LOWER_TARGETS, reading
from core.analysis.inverse_design.quantity import Goal
from core.analysis.inverse_design.solve import InverseResult, solve_targets
from core.errors import UserError
from core.geometry.mesh import Points
from core.measurements.lower_trunk import lower_before_after
from core.pipeline.build import Stages, build
from core.pipeline.solve import solve

SLINGS = {"sling-left": 0.95, "sling-right": 0.95, "buttock-lift-left": 0.97, "buttock-lift-right": 0.97}
GIRDLE = {"mid-bust": 0.97, "waist": 0.97, "belly-panel": 0.95, "hip": 0.98, **SLINGS}


@pytest.fixture(scope="module")
def stages() -> Stages:
    return wearing(GIRDLE, volume="exact")


def solved_points(stages: Stages) -> Points:
    return np.concatenate(solve(stages).region_points)


def value(stages: Stages, name: str, points: Points) -> float:
    return reading(stages, name)(points).value


@pytest.mark.parametrize("name", [*LOWER_TARGETS, "lift", profile_name("0", 150.0)])
def test_slopes_are_those_of_differences(stages: Stages, name: str) -> None:
    twice = doubled(stages)
    here, free = solved_points(stages), np.concatenate([~each.control.fixed for each in stages.regions])
    way = np.random.default_rng(4).normal(size=here.shape) * free[:, None]
    read = reading(twice, name)
    expected = float(slope(lambda t: read(here + t * way).value, 1e-4))
    assert np.sum(read(here).slopes * way) == pytest.approx(expected, rel=1e-6)


def test_figures_are_those_of_measures_and_landmarks(stages: Stages) -> None:
    solution = solve(stages)
    assert stages.lower is not None
    assert solution.lower is not None
    points = np.concatenate(solution.region_points)
    girths = lower_before_after(stages.lower, solution.lower.control_points)
    for name in ("waist", "belly", "hip"):
        before, after = girths[name]
        assert value(stages, f"{name} girth", stages.rest_points) == pytest.approx(before.tape_mm, abs=0.3)
        assert value(stages, f"{name} girth", points) == pytest.approx(after.tape_mm, abs=0.3)
    fold = stages.lower.landmarks.position("gluteal_fold_left")
    near = int(np.linalg.norm(stages.body.mesh.vertices - fold, axis=1).argmin())
    rise = solution.body.vertices[near] - stages.body.mesh.vertices[near]
    assert value(stages, "fold lift left", points) == pytest.approx(rise[2], abs=0.01)
    both = [value(stages, f"buttock out {side}", points) for side in ("left", "right")]
    assert value(stages, "buttock out", points) == pytest.approx(sum(both) / 2.0)


def solved_from_rest(result: InverseResult, stages: Stages, name: str) -> float:
    """Return a figure of the design that was found, solved anew from the original shape."""
    again = build(result.design, stages)
    return value(again, name, solved_points(again))


def test_targets_of_both_regions_are_reached_together(stages: Stages) -> None:
    waist, bust = (value(stages, name, stages.rest_points) for name in ("waist girth", "girth"))
    wanted = [Goal("waist girth", waist - 40.0), Goal("fold lift", 4.0), Goal("girth", bust - 5.0)]
    found = solve_targets(stages, wanted)
    assert found.reachable
    for goal in wanted:
        assert solved_from_rest(found, stages, goal.name) == pytest.approx(goal.value, abs=0.06)
    for name in ("sling", "buttock-lift"):  # linked pairs stay pairs
        assert found.design.ratio(f"{name}-left") == found.design.ratio(f"{name}-right")


def test_a_limit_of_pressure_holds_for_lines_of_both_regions(stages: Stages) -> None:
    waist, bust = (value(stages, name, stages.rest_points) for name in ("waist girth", "girth"))
    wanted = [Goal("waist girth", waist - 60.0), Goal("girth", bust - 5.0)]
    found = solve_targets(stages, wanted, most_kpa=3.0)
    assert not found.reachable
    assert "waist" in found.at_pressure_limit
    assert max(found.pressure.values()) < 3.0
    assert set(found.pressure) == found.design.all_active_lines()


def test_lines_of_a_region_that_nothing_is_asked_of_keep_their_lengths(stages: Stages) -> None:
    waist = value(stages, "waist girth", stages.rest_points) - 20.0
    found = solve_targets(stages, [Goal("waist girth", waist)])
    assert found.reachable
    assert found.design.lines == stages.design.lines
    bust = value(stages, "girth", stages.rest_points) - 5.0
    found = solve_targets(stages, [Goal("girth", bust)])
    assert found.reachable
    assert found.design.lower == stages.design.lower


def test_without_the_region_its_targets_are_refused() -> None:
    bust = build(replace(trunk_stages().design, lower=None), trunk_stages())
    with pytest.raises(UserError, match="Activate a line of waist, hips or seat"):
        reading(bust, "waist girth")
