"""The lower trunk beside the bust: it leaves the bust alone, and its shapes, volumes and iterations hold."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
from whole_trunk import trunk_stages, wearing

from core.analysis.length_limits.limits import all_limits, limits_of
from core.control_mesh.lower_template import HIP_ROW, read_lower_template
from core.document.design import Design, ScanSource
from core.document.lower_trunk import LowerTrunk
from core.garment.curve_smoothing import LocalPlanes, centre_line
from core.garment.elastic_library import find_elastic
from core.garment.pressure import pressure_limits, pressures
from core.geometry.mesh import Floats
from core.landmarks.torso.girths import girth_at
from core.mechanics.solver_comparison import SolverComparison
from core.pipeline.build import Stages, build
from core.pipeline.frame import make_frame
from core.pipeline.model_stages import line_targets
from core.pipeline.region_solvers import RegionSolvers
from core.pipeline.solve import Solution, solve
from core.pipeline.warnings import warnings

TEMPLATE = read_lower_template()
BOTH = {"mid-bust": 0.97, "waist": 0.9}
SLINGS = {"sling-left": 0.9, "sling-right": 0.9, "buttock-lift-left": 0.95, "buttock-lift-right": 0.95}
CINCHER = {"above-waist": 0.97, "waist": 0.94, "below-waist": 0.96}
ROUTES: tuple[Mapping[str, float], ...] = (
    {"waist": 0.8},
    {"under-hip": 0.93},
    {"belly-panel": 0.8, "low-belly-panel": 0.8},
    {"belly-cross-left": 0.9, "belly-cross-right": 0.9},
    {"leg-opening-left": 0.9, "leg-opening-right": 0.9},
    {**CINCHER, **SLINGS, "hip": 0.95},
)
GIRDLE = {
    **dict.fromkeys(("above-waist", "below-waist", "belly", "under-hip"), 0.95),
    **dict.fromkeys(("waist", "high-hip", "hip"), 0.98),
    **dict.fromkeys(("belly-panel", "low-belly-panel"), 0.96),
    **{f"{each}-{side}": 0.975 for each in ("sling", "leg-opening") for side in ("left", "right")},
}


def moves(solution: Solution) -> Floats:
    """Return how the control points of the lower trunk went, (n, 3) [mm]."""
    assert solution.lower is not None
    return solution.lower.control_points - solution.lower.stages.control.mesh.vertices


def girth_change(solution: Solution, name: str) -> float:
    """Return how much longer a tape at the height of a landmark is [mm]."""
    assert solution.stages.lower is not None
    z = solution.stages.lower.landmarks.levels[name]
    return girth_at(solution.body, z).tape_mm - girth_at(solution.stages.body.mesh, z).tape_mm


@pytest.fixture(scope="module")
def cinched() -> Solution:
    return solve(wearing(BOTH))


def test_the_bust_is_solved_as_without_it_to_the_last_bit(cinched: Solution) -> None:
    bust = replace(cinched.stages.design, lower=None)
    without = solve(build(bust, trunk_stages()))
    np.testing.assert_array_equal(without.control_points, cinched.control_points)
    assert without.records == cinched.records
    assert without.lower is None


def test_without_a_length_nothing_moves() -> None:
    bare = solve(wearing({"waist": 1.0}))
    assert np.abs(moves(bare)).max() < 1e-9
    np.testing.assert_allclose(bare.body.vertices, bare.stages.body.mesh.vertices, atol=1e-6)


def test_a_shorter_waist_narrows_the_waist_and_leaves_the_seat(cinched: Solution) -> None:
    assert cinched.lower is not None
    assert cinched.lower.verdict.iterations <= 8
    assert -60.0 < girth_change(cinched, "waist") < -40.0
    assert abs(girth_change(cinched, "hip")) < 6.0
    outward = np.einsum("ij,ij->i", moves(cinched), cinched.lower.stages.control.mesh.vertex_normals)
    seat = (TEMPLATE.row >= 6) & (TEMPLATE.row <= HIP_ROW + 1) & (np.abs(TEMPLATE.column) > 6)
    assert outward[seat].max() < 1.0


def test_no_triangle_of_the_body_flips(cinched: Solution) -> None:
    for solution in (cinched, solve(wearing(SLINGS))):
        before, after = solution.stages.body.mesh.face_normals, solution.body.face_normals
        assert np.einsum("ij,ij->i", before, after).min() > 0.0


def test_slings_lift_fold_and_seat() -> None:
    lifted = moves(solve(wearing(SLINGS)))
    fold = [TEMPLATE.point(9, column) for column in (9, -9)]
    assert lifted[fold, 2].min() > 6.0
    hung = moves(solve(wearing({name: SLINGS[name] for name in SLINGS if name.startswith("sling")})))
    seat = [TEMPLATE.point(HIP_ROW, column) for column in (9, -9)]
    assert hung[seat, 1].min() > 1.5  # the seat is pushed back


def test_each_zone_keeps_its_volume_but_for_the_share_of_the_waist(cinched: Solution) -> None:
    lower = cinched.lower
    assert lower is not None
    change = lower.stages.model.volume.zone_volumes(lower.control_points) - lower.stages.model.rest_zones
    assert change[0] < -50_000.0  # taken up inside
    np.testing.assert_allclose(change[1:], 0.0, atol=1e-3)
    whole = solve(wearing({"waist": 0.9}, waist_kept=1.0)).lower
    none = solve(wearing({"waist": 0.9}, waist_kept=0.0)).lower
    assert whole is not None
    assert none is not None
    assert abs(whole.last.error_ml) < 1e-6
    lost = none.stages.model.volume.zone_volumes(none.control_points) - none.stages.model.rest_zones
    # Zones beside it that keep their volume push back: somewhat more than half goes inside.
    assert 0.5 < change[0] / lost[0] < 0.7


@pytest.mark.parametrize("lines", ROUTES, ids="+".join)
def test_every_route_is_found_in_few_steps(lines: Mapping[str, float]) -> None:
    lower = solve(wearing(lines)).lower
    assert lower is not None
    assert lower.verdict.motion == "settled"
    assert lower.verdict.iterations <= 8


@pytest.mark.parametrize("lines", [BOTH, CINCHER, SLINGS], ids=["waist", "cincher", "slings"])
def test_the_adaptive_control_ends_where_the_exact_answer_is(lines: Mapping[str, float]) -> None:
    stages = wearing(lines, volume="adaptive")
    settled = solve(stages).lower
    assert settled is not None
    assert settled.verdict.motion == "settled"
    run, exact = solve(stages, turns=600), solve(wearing(lines))
    assert run.lower is not None
    assert np.abs(moves(run) - moves(exact)).max() < 0.02
    last = np.array([record.zones for record in run.lower.records[-10:]])
    assert np.ptp(last, axis=0).max() < 1e-5


@pytest.mark.parametrize(
    "settings",
    [{}, {"line_hold": "held"}, {"member_law": "co-rotated"}],
    ids=["springs", "held", "co-rotated"],
)
def test_a_girdle_of_many_bands_settles_near_the_exact_answer(settings: Mapping[str, str]) -> None:
    settled = solve(wearing(GIRDLE, volume="adaptive", **settings)).lower
    exact = solve(wearing(GIRDLE, **settings)).lower
    assert settled is not None
    assert exact is not None
    assert exact.verdict.motion == settled.verdict.motion == "settled"
    assert np.abs(settled.control_points - exact.control_points).max() < 0.5
    if not settings:
        assert settled.verdict.iterations < 250


def test_the_conventional_control_swings_only_beyond_its_limit() -> None:
    for factor, motion in ((0.97, "settled"), (1.05, "vibrating")):
        lower = wearing({"waist": 0.97}, volume="conventional").lower
        assert lower is not None
        targets = replace(line_targets(lower.design, lower), gain=factor * lower.gain_limit)
        comparison = SolverComparison(lower.model, targets)
        for _ in range(300):
            comparison.advance()
        found = comparison.runs["conventional"].verdict.motion
        assert found in ((motion,) if factor < 1.0 else (motion, "diverging"))


def test_both_regions_are_shown_in_one_frame_and_only_the_changed_one_runs_anew() -> None:
    stages = wearing(BOTH)
    solvers = RegionSolvers(stages)
    frame = make_frame(1, stages, solvers)
    assert frame.lower is not None
    assert len(frame.points) == len(stages.skin.vertices)
    reshaped = stages.skin.body(frame.region_points)
    np.testing.assert_allclose(frame.points, reshaped.vertices[stages.skin.vertices], atol=1e-9)
    after = build(stages.design.with_line("waist", 0.95), stages)
    bust = solvers.bust.exact
    solvers.retarget(after)
    assert solvers.bust.exact is bust
    assert make_frame(2, after, solvers).lower.lengths["waist"] > frame.lower.lengths["waist"]  # type: ignore[union-attr]


def test_a_scan_that_ends_above_the_legs_keeps_its_bust_and_says_why(built: object) -> None:
    person: Stages = built("person")  # type: ignore[operator]
    stages = build(replace(person.design, lower=LowerTrunk()).with_line("waist", 0.9), person)
    assert stages.lower is None
    assert stages.control is person.control
    assert stages.lower_problem is not None
    assert any("lower trunk" in str(each) for each in warnings(stages))
    again = build(stages.design.with_line("waist", 0.95), stages)
    assert again.lower_problem is stages.lower_problem  # it is not sought anew at each step of a slider


def test_a_design_of_two_regions_is_not_that_of_one() -> None:
    design = Design(ScanSource("a.ply"), lower=LowerTrunk())
    assert not design.with_line("waist", 0.9).is_bare
    assert not design.with_line("waist", 0.9).is_equivalent(design)
    assert design.with_line("waist", 0.9).with_lines_reset().is_bare


def test_the_limits_of_a_lower_line_are_those_of_its_own_region() -> None:
    stages = wearing({"mid-bust": 0.97, "waist": 0.95})
    limits = limits_of(stages, "waist")
    assert limits.present is not None
    assert limits.present.ratio == 0.95
    strained = limits.onsets["strained"]
    assert strained is not None
    assert strained.ratio < 0.9
    assert {found.line.name for found in all_limits(stages)} >= {"mid-bust", "waist"}
    free = limits_of(wearing({"waist": 0.95}), "waist").onsets["strained"]
    assert free is not None
    assert free.ratio == strained.ratio, "what the bust wears does not matter"


def test_lines_of_both_sides_of_an_even_body_are_equally_long() -> None:
    lower = trunk_stages().lower
    assert lower is not None
    surface = LocalPlanes(lower.body.mesh)
    long = {}
    for line in lower.model.lines:
        route = lower.routes[line.name]
        laid = centre_line(route.path, surface, route.back, 20.0, sewn=route.sewn).points
        long[line.name] = line.rest_length, np.linalg.norm(np.diff(laid, axis=0), axis=1).sum()
    pairs = [name.removesuffix("-left") for name in long if name.endswith("-left")]
    for name in pairs:
        assert long[f"{name}-left"] == pytest.approx(long[f"{name}-right"], abs=1.0), name


def test_a_lower_line_of_elastic_is_limited_by_its_pressure() -> None:
    base, elastic = wearing({"waist": 0.95, "hip": 0.97}), find_elastic("Waistband, soft 25 mm")
    stages = build(base.design.with_elastic("waist", elastic), base)
    limits = limits_of(stages, "waist")
    end = limits.below("pressing")
    assert limits.pressure_known
    assert end is not None
    for ratio, beyond in ((end.ratio - 0.002, True), (end.ratio + 0.002, False)):
        there = solve(build(stages.design.with_line("waist", ratio), stages)).lower
        assert there is not None
        pressed = pressures(there.stages, there.control_points)
        assert (pressed["waist"].largest > pressure_limits().red_kpa) == beyond
    assert not limits_of(stages, "hip").pressure_known, "no elastic: its newtons are estimates"
