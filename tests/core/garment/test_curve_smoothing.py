"""A line as it is worn: smooth, on the skin, round the back, and straighter the wider its band is."""

import numpy as np
import pytest

from core.garment.curve_smoothing import STEP, LocalPlanes, centre_line
from core.geometry.mesh import Mesh
from core.geometry.plane_sections import arc_length

RADIUS = 120.0


def cylinder(count: int = 180) -> Mesh:
    """An open cylinder of height 200 mm round the z axis, with triangles about 4 mm wide."""
    turn = np.arange(count) * 2 * np.pi / count
    z = np.linspace(0.0, 200.0, 51)
    ring = RADIUS * np.stack([np.sin(turn), -np.cos(turn)], axis=1)
    vertices = np.concatenate([np.column_stack([ring, np.full(count, height)]) for height in z])
    a = (np.arange(50)[:, None] * count + np.arange(count)).ravel()
    b = (np.arange(50)[:, None] * count + (np.arange(count) + 1) % count).ravel()
    low = np.stack([a, b, b + count], axis=1)
    return Mesh(vertices, np.concatenate([low, np.stack([a, b + count, a + count], axis=1)]))


def around(start: float, end: float, count: int, z: float = 100.0) -> np.ndarray:
    turn = np.radians(np.linspace(start, end, count))
    return np.stack([RADIUS * np.sin(turn), -RADIUS * np.cos(turn), np.full(count, z)], axis=1)


def test_a_band_round_a_cylinder_is_as_long_as_the_cylinder_is_round():
    front, back = around(-90, 90, 7), around(90, 270, 40)
    line = centre_line(front, LocalPlanes(cylinder()), back)
    length = arc_length(np.concatenate([line.points, line.points[:1]]))[-1]
    assert line.closed
    assert length == pytest.approx(2 * np.pi * RADIUS, rel=2e-3)
    assert np.hypot(*line.points[:, :2].T) == pytest.approx(RADIUS, abs=0.3)
    assert (line.part < 0).mean() == pytest.approx(0.5, abs=0.02)
    assert line.lift == pytest.approx(0.0, abs=1e-9)


def test_places_lie_evenly_and_normals_point_outward():
    line = centre_line(around(-80, 80, 6), LocalPlanes(cylinder()))
    steps = np.linalg.norm(np.diff(line.points, axis=0), axis=1)
    assert not line.closed
    assert steps == pytest.approx(STEP, rel=0.1)
    assert np.einsum("ij,ij->i", line.normals[:, :2], line.points[:, :2]) == pytest.approx(RADIUS, rel=0.02)


def test_a_wide_band_lies_straighter_than_a_thread_over_a_path_with_a_kink():
    path = around(-60, 60, 13)
    path[6, 2] += 6.0
    surface = LocalPlanes(cylinder())
    thread, band = (centre_line(path, surface, width=width) for width in (0.0, 20.0))
    assert np.ptp(band.points[:, 2]) < 0.7 * np.ptp(thread.points[:, 2])
    assert np.abs(band.points[:, 2] - 100.0).max() < 6.0 + 0.4 * 20.0


def test_a_line_follows_the_body_that_moves():
    mesh = cylinder()
    surface = LocalPlanes(mesh)
    line = centre_line(around(-80, 80, 6), surface)
    moved = surface.displacement_weights(line.points) @ np.tile([3.0, -2.0, 1.0], (len(mesh.vertices), 1))
    np.testing.assert_allclose(moved, np.tile([3.0, -2.0, 1.0], (len(line.points), 1)), atol=1e-12)
