"""The template of the lower trunk: counts, borders, symmetry, zones, lines, and texts that are none."""

from __future__ import annotations

import json
from collections import Counter
from importlib import resources

import numpy as np
import pytest

from core.control_mesh.lower_template import FOLD_ROW, HALF, parse_lower_template, read_lower_template
from core.errors import FitError
from core.geometry.mesh import Mesh

TEMPLATE = read_lower_template()
TEXT = (resources.files("resources") / "templates" / "lower.json").read_text(encoding="utf-8")
CLOSED = {"under-bust-whole", "above-waist", "waist", "below-waist", "belly", "high-hip", "hip", "under-hip"}


def test_it_has_three_borders_and_is_wound_one_way() -> None:
    assert (len(TEMPLATE.row), len(TEMPLATE.faces), int((~TEMPLATE.fixed).sum())) == (273, 500, 174)
    rng = np.random.default_rng(1)
    mesh = Mesh(rng.normal(size=(273, 3)), TEMPLATE.faces)
    assert sorted(map(len, mesh.boundary_loops)) == [13, 13, 22]
    halves = np.concatenate([TEMPLATE.faces[:, [k, k - 2]] for k in range(3)])
    assert len(np.unique(halves, axis=0)) == len(halves)  # no two triangles run along an edge the same way


def test_triangles_and_zones_are_mirrored() -> None:
    mirrored = {frozenset(face) for face in TEMPLATE.mirror[TEMPLATE.faces].tolist()}
    assert mirrored == {frozenset(face) for face in TEMPLATE.faces.tolist()}
    count = Counter(TEMPLATE.zone_names[zone] for zone in TEMPLATE.zone)
    assert count["seat-left"] == count["seat-right"] > 0
    left = (TEMPLATE.zone == TEMPLATE.zone_names.index("seat-left"))[:, None] & (
        np.abs(TEMPLATE.column[TEMPLATE.faces]) != HALF
    )
    assert (TEMPLATE.column[TEMPLATE.faces][left] > 0).all()


def test_closed_lines_come_back_and_both_sides_are_mirrored() -> None:
    paths = TEMPLATE.paths
    for name, path in paths.items():
        opening = name.startswith(("leg-opening", "high-leg"))
        assert (path[0] == path[-1]) == (name in CLOSED or opening), name
        if name.endswith("-left"):
            other = paths[name.replace("-left", "-right")]
            assert [int(TEMPLATE.mirror[point]) for point in path] == list(other)


def test_lines_that_act_run_over_points_that_move() -> None:
    for name, path in TEMPLATE.paths.items():
        assert (name == "under-bust-whole") == bool(TEMPLATE.fixed[list(path)].all()), name


def test_every_row_of_the_trunk_is_named_by_its_place() -> None:
    for row, column in ((0, -10), (5, 0), (FOLD_ROW, HALF)):
        point = TEMPLATE.point(row, column)
        assert (TEMPLATE.row[point], TEMPLATE.column[point]) == (row, column)
    assert TEMPLATE.loop(0, FOLD_ROW)[0] == TEMPLATE.loop(1, FOLD_ROW)[0] == TEMPLATE.crotch


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"rows": []}, "the rows must be"),
        ({"front_parts": [0, 0.2, 0.1, 0.5, 0.7, 0.9, 1]}, "the columns cross"),
        ({"depths": [[1.0] * 12] * 7}, "map of depths"),
        ({"lines": {"waist": {"row": 30}}}, "line waist leaves the mesh"),
        ({"zones": []}, "a cell is in no zone"),
        ({"leg_back": "x"}, "ValueError"),
    ],
)
def test_a_text_that_is_no_template_is_refused(change: dict[str, object], said: str) -> None:
    with pytest.raises(FitError, match=said):
        parse_lower_template(json.dumps({**json.loads(TEXT), **change}))
