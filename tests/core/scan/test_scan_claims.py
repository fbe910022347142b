"""Claims that a small example holds: units in doubt, mirrored parts, lids over edges, less sure marks."""

from __future__ import annotations

import numpy as np
import pytest
from scan_files import VOLUME, gltf

from core.geometry.mesh import Mesh
from core.scan.orientation.unit_detection import estimate_unit
from core.scan.readers.registry import read_triangles
from core.scan.repair.holes import fill_small_holes


@pytest.mark.parametrize(
    ("girth", "unit", "other"),
    [(60.0, "cm", "inch"), (59.3, "inch", "cm"), (90.0, "cm", None), (900.0, "mm", None)],
)
def test_a_unit_is_in_doubt_where_another_gives_a_rare_body(girth, unit, other):
    """60 cm is a slim body, 60 inch a very stout one."""
    size = estimate_unit(girth)
    assert (size.unit, size.is_certain) == (unit, other is None)
    assert (f"may also be {other}" in str(size.reason)) == (other is not None)


def test_a_part_that_its_node_mirrors_still_looks_outward():
    half = 0.5**0.5
    nodes = [
        {"children": [1, 2], "translation": [0, 0, 1], "scale": [-2, 2, 2]},
        {"mesh": 0, "rotation": [half, 0, 0, half]},
        {"mesh": 1, "matrix": [1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1]},
    ]
    house = Mesh(*read_triangles("house.glb", gltf(binary=True, nodes=nodes)))
    assert house.vertices[:, 0].min() == -2.0
    assert house.enclosed_volume((-1.0, 1.0, 1.0)) == pytest.approx(VOLUME, abs=1e-5)


def test_a_lid_that_would_double_an_edge_is_left_out():
    """A flat lid over two triangles has their common edge as well: three faces and four would meet there."""
    kite = np.array([[0.0, -2.0, 0.0], [9.0, 0.0, 0.0], [0.0, 2.0, 0.0], [-9.0, 0.0, 0.0]])
    sheet = Mesh(kite, np.array([[0, 1, 2], [0, 2, 3]]))
    assert fill_small_holes(sheet)[1:] == (0, 0)
