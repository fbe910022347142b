"""Lines drawn below the bust and over both regions: closed rows, one band, its mirror image, its file."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from whole_trunk import trunk_stages, wearing

from core.analysis.inverse_design.line_selection import LineSelection
from core.analysis.inverse_design.quantity import Goal
from core.analysis.length_limits.limits import limits_of
from core.analysis.length_limits.zones import length_limits_of, to_length_limits
from core.control_mesh.embedding import embed, locate_on_grid
from core.control_mesh.fit import ControlMesh
from core.control_mesh.lower_template import read_lower_template
from core.control_mesh.path_snapping import max_deviation
from core.control_mesh.template import read_template
from core.document.design import Design
from core.document.drawn_lines import Laid, both_sides, lay_curve, lines_of, with_new_path
from core.document.line_notation import format_path, parse_line
from core.document.lines import CustomLine
from core.document.serialization import from_json, to_json
from core.errors import LineError
from core.garment.presets import is_active, preset_from, with_preset
from core.geometry.geodesic import SurfacePaths
from core.geometry.mesh import Points
from core.pipeline.active_lines import all_free_lines
from core.pipeline.build import Stages, build
from core.pipeline.solve import solve

LOWER = read_lower_template()
BUST = read_template("168")
Stop = tuple[str, int, int]


@cache
def skin_paths() -> SurfacePaths:
    return SurfacePaths(trunk_stages().body.mesh)


def meshes() -> dict[str, ControlMesh]:
    return {region.fitted.region: region.fitted for region in trunk_stages().regions}


def curve(*stops: Stop) -> list[Points]:
    """The shortest ways over the skin between control points, by region, row and column."""
    places = []
    for region, row, column in stops:
        control = meshes()[region]
        places.append(control.mesh.vertices[(control.row == row) & (control.column == column)][0])
    return [skin_paths().path(*ends) for ends in pairwise(places)]


def laid(*stops: Stop, closed: bool = False, snapped: bool = False) -> Laid:
    return lay_curve(trunk_stages().body.mesh, meshes(), curve(*stops), closed, snapped=snapped)


def banded(ratio: float | None = None) -> Design:
    """The whole trunk with a line from the breast to the belly on both sides."""
    found = laid(("bust", 3, 2), ("lower", 2, 2), ("lower", 5, 1))
    design = trunk_stages().design
    for line in both_sides("line 1", found, design.template):
        design = design.with_custom_line(line)
    return design if ratio is None else design.with_linked("line 1 left", ratio)


def test_places_count_on_round_the_back_and_come_back_to_their_points() -> None:
    grid = LOWER.grid
    points = np.arange(LOWER.crotch)
    places = np.stack([LOWER.row[points], LOWER.column[points]], axis=1).astype(np.float64)
    corners, weights = locate_on_grid(grid, places)
    assert (corners[points, weights.argmax(axis=1)] == points).all()
    np.testing.assert_allclose(weights.max(axis=1), 1.0)
    somewhere = np.random.default_rng(1).uniform([0.0, -10.999], [9.0, 11.0], (500, 2))
    np.testing.assert_allclose(grid.places(*locate_on_grid(grid, somewhere)), somewhere, atol=1e-9)
    round_the_back = embed(grid, [(5.0, 9.5), (5.0, -9.5)])
    assert round_the_back.steps == pytest.approx(3.0), "not 19 columns round the front"
    ring = embed(grid, [(4.0, 0.0), (4.0, 8.0), (4.0, -8.0), (4.0, 0.0)])
    assert ring.steps == pytest.approx(22.0)
    assert abs(ring.weights[[0]] - ring.weights[[-1]]).sum() == 0.0


@pytest.mark.parametrize(
    "stops",
    [
        (("lower", 5, -4), ("lower", 4, 1), ("lower", 5, 5)),
        (("lower", 6, 8), ("lower", 5, 11), ("lower", 6, -8)),
        (("lower", 8, 7), ("lower", 7, 9), ("lower", 3, 9)),
    ],
)
def test_a_curve_below_the_bust_is_laid_where_it_was_drawn(stops: tuple[Stop, ...]) -> None:
    found = laid(*stops)
    assert list(found) == ["lower"]
    assert found["lower"].is_movable
    assert max_deviation(np.concatenate(curve(*stops)), found["lower"].shown) < 1.0
    (line,) = lines_of("line 1", found)
    stages = build(trunk_stages().design.with_custom_line(line).with_line("line 1", 0.95), trunk_stages())
    (model,) = (each for each in stages.lower.model.lines if each.name == "line 1")
    assert model.constrains
    solution = solve(stages)
    assert model.length(solution.region_points[1]) < model.rest_length - 1.0
    np.testing.assert_array_equal(solution.region_points[0], stages.control.mesh.vertices)


def test_a_closed_curve_round_the_body_is_a_whole_band_as_its_row_is() -> None:
    found = laid(*(("lower", 5, column) for column in (0, 4, 8, 11, -8, -4, 0)), closed=True)
    (line,) = lines_of("band", found)
    stages = build(trunk_stages().design.with_custom_line(line), trunk_stages())
    drawn, row = (
        next(one for one in stages.lower.model.lines if one.name == name) for name in ("band", "belly")
    )
    assert drawn.closed
    assert drawn.rest_length == pytest.approx(row.rest_length, rel=0.02)


def test_a_curve_over_both_regions_is_cut_once() -> None:
    found = laid(("bust", 3, 2), ("lower", 2, 2), ("lower", 5, 1))
    assert list(found) == ["bust", "lower"]
    upper, lower = found["bust"].shown, found["lower"].shown
    whole = sum(
        np.linalg.norm(np.diff(piece, axis=0), axis=1).sum()
        for piece in curve(("bust", 3, 2), ("lower", 2, 2), ("lower", 5, 1))
    )
    parts = sum(np.linalg.norm(np.diff(part, axis=0), axis=1).sum() for part in (upper, lower))
    assert parts == pytest.approx(whole, rel=0.01), "nothing twice, nothing lost"
    assert np.linalg.norm(upper[-1] - lower[0]) < 3.0
    with pytest.raises(LineError, match="more than once"):
        laid(("bust", 3, 3), ("lower", 4, 2), ("bust", 3, -3))


def test_a_band_has_one_length_in_whatever_way_it_is_set() -> None:
    design = banded(0.95)
    names = design.linked_lines("line 1 lower right")
    assert names == ("line 1 left", "line 1 right", "line 1 lower left", "line 1 lower right")
    assert {design.ratio(name) for name in names} == {0.95}
    apart = design.with_line_settings(replace(design.line_settings("line 1 left"), linked=False))
    assert apart.with_line("line 1 lower left", 0.9).ratio("line 1 left") == 0.9
    assert apart.with_line("line 1 left", 0.9).ratio("line 1 right") == 0.95
    assert design.with_bust_lines_reset().all_active_lines() == set(), "no half of a band stays"
    assert design.with_lower_lines_reset().all_active_lines() == set()
    assert design.without_custom_line("line 1 lower left").linked_lines("line 1 right") == (
        "line 1 right",
        "line 1 lower right",
    )
    stages = build(design, trunk_stages())
    assert all_free_lines(stages) == (names,)
    assert all_free_lines(stages, kept=["line 1 lower left"]) == ()


def test_a_target_moves_both_parts_of_a_band_alike() -> None:
    stages = build(banded(0.97).with_line("waist", 0.97), wearing({"waist": 0.97}))
    reply = LineSelection(stages).solve([Goal("waist girth", stages_waist(stages) - 8.0)])
    assert reply.reachable
    ratios = {reply.design.ratio(name) for name in stages.design.linked_lines("line 1 left")}
    assert len(ratios) == 1


def stages_waist(stages: Stages) -> float:
    """The girth of the waist as it is."""
    return LineSelection(stages).current_values(["waist girth"])[0]["waist girth"]


def test_a_band_can_go_as_far_as_both_of_its_parts() -> None:
    stages = build(banded(0.95), trunk_stages())
    whole = length_limits_of(stages, "line 1 left")
    parts = [to_length_limits(limits_of(stages, name)) for name in ("line 1 left", "line 1 lower left")]
    assert whole.red_below == pytest.approx(max(part.red_below for part in parts))


def test_it_is_written_saved_and_kept_in_presets() -> None:
    design = banded(0.95)
    assert from_json(to_json(design)) == design
    for line in design.own_lines:
        text = f"{line.name}={format_path(line, LOWER if line.region == 'lower' else BUST)}"
        assert parse_line(text, BUST) == line
    preset = preset_from(design, "Band")
    assert preset.is_for_bust
    assert preset.is_for_lower_trunk
    again = with_preset(trunk_stages().design, preset)
    assert is_active(again, preset)
    assert again.own_lines == design.own_lines
    assert again.all_active_lines() == design.all_active_lines()
    belt = parse_line("belt=r4c9,r4c10,r4c11,r4c-10,r4c-9,lower", BUST)
    assert belt.points == tuple(LOWER.point(4, column) for column in (9, 10, 11, -10, -9))
    for wrong, why in (
        ("a=r4c1,r4c2,lower,shoulder", "below the bust"),
        ("a=r4c1,r4c2,continues b", "cannot continue"),
        ("a=r4c12,r4c2,lower", "no position"),
    ):
        with pytest.raises(LineError, match=why):
            parse_line(wrong, BUST)
    with pytest.raises(LineError, match="cannot continue"):
        trunk_stages().design.with_custom_line(parse_line("a=r4c1,r5c1,lower,continues b", BUST))


def test_a_new_path_stays_in_its_regions_and_leads_the_other_side_too() -> None:
    design = banded(0.95)
    found = laid(("bust", 3, 3), ("lower", 2, 3), ("lower", 5, 2))
    after = with_new_path(design, lines_of("line 1 left", found))
    (_, _, right, lower_right) = (
        next(line for line in after.own_lines if line.name == name)
        for name in ("line 1 left", "line 1 lower left", "line 1 right", "line 1 lower right")
    )
    assert right.places[0] == (3.0, -3.0)
    assert lower_right.places[-1][1] == -2.0
    with pytest.raises(LineError, match="another region"):
        with_new_path(design, [CustomLine("line 1 left", LOWER.paths["belly-panel"], region="lower")])
