"""Ways over the skin are the shortest ones, from place to place."""

import numpy as np
import pytest
import trimesh

from core.errors import LineError
from core.geodesic import SkinWays
from core.mesh import Mesh

BALL = trimesh.creation.icosphere(subdivisions=4, radius=100.0)


def length(way: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(way, axis=0), axis=1).sum())


def test_a_way_over_a_ball_is_an_arc() -> None:
    ways = SkinWays(Mesh(np.asarray(BALL.vertices), np.asarray(BALL.faces)))
    start, end = np.array([100.0, 0.0, 0.0]), np.array([0.0, 60.0, 80.0])
    way = ways.way(start, end)
    assert np.array_equal(way[[0, -1]], [start, end])
    assert length(way) == pytest.approx(50.0 * np.pi, rel=0.01)
    assert np.linalg.norm(way, axis=1) == pytest.approx(100.0, rel=0.01)
    assert length(ways.way(start, start + np.array([0.0, 0.5, 0.0]))) == pytest.approx(0.5)


def test_there_is_no_way_from_one_part_to_another() -> None:
    apart = np.asarray(BALL.vertices) + np.array([300.0, 0.0, 0.0])
    faces = np.asarray(BALL.faces)
    two = Mesh(np.concatenate([BALL.vertices, apart]), np.concatenate([faces, faces + len(apart)]))
    with pytest.raises(LineError, match="no way over the skin"):
        SkinWays(two).way(np.array([100.0, 0.0, 0.0]), np.array([400.0, 0.0, 0.0]))


def test_a_skin_that_branches_cannot_be_drawn_on() -> None:
    points = np.array([[0, 0, 0], [0, 0, 9], [9, 0, 0], [-9, 0, 0], [0, 9, 0]], dtype=float)
    with pytest.raises(LineError, match="cannot be drawn on"):
        SkinWays(Mesh(points, np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4]])))
