"""Ways over the skin are the shortest ones, from place to place."""

from collections.abc import Callable

import numpy as np
import pytest
import trimesh

from core.errors import LineError
from core.geometry.geodesic import SurfacePaths, _with_vertex, shortest_path, split_pinched_vertices
from core.geometry.mesh import Mesh

Pair = tuple[float, float]
Ends = tuple[np.ndarray, ...]

BALL = trimesh.creation.icosphere(subdivisions=4, radius=100.0)


def length(way: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(way, axis=0), axis=1).sum())


def test_a_way_over_a_ball_is_an_arc() -> None:
    ways = SurfacePaths(Mesh(np.asarray(BALL.vertices), np.asarray(BALL.faces)))
    start, end = np.array([100.0, 0.0, 0.0]), np.array([0.0, 60.0, 80.0])
    way = ways.path(start, end)
    assert np.array_equal(way[[0, -1]], [start, end])
    assert length(way) == pytest.approx(50.0 * np.pi, rel=0.01)
    assert np.linalg.norm(way, axis=1) == pytest.approx(100.0, rel=0.01)
    assert length(ways.path(start, start + np.array([0.0, 0.5, 0.0]))) == pytest.approx(0.5)


def sheet(place: Callable[[np.ndarray, np.ndarray], np.ndarray], u: np.ndarray, v: np.ndarray) -> Mesh:
    """Triangles over a grid of two parameters, open all round."""
    number = np.arange(len(u) * len(v)).reshape(len(u), len(v))
    a, b, c, d = (number[i, j].ravel() for i in (S[0], S[1]) for j in (S[0], S[1]))
    places = place(*(each.ravel() for each in np.meshgrid(u, v, indexing="ij")))
    return Mesh(places, np.concatenate([np.stack([a, c, d], axis=1), np.stack([a, d, b], axis=1)]))


S = (slice(None, -1), slice(1, None))


def tube(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    return np.stack([120.0 * np.cos(u), 120.0 * np.sin(u), v], axis=-1)


def cone(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """A cone that is half as wide as its side is long; v is the way from its tip."""
    return np.stack([0.5 * v * np.cos(u), 0.5 * v * np.sin(u), -np.sqrt(0.75) * v], axis=-1)


def ring(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    far = 150.0 + 50.0 * np.cos(v)
    return np.stack([far * np.cos(u), far * np.sin(u), 50.0 * np.sin(v)], axis=-1)


def between(place: Callable[[np.ndarray, np.ndarray], np.ndarray], start: Pair, end: Pair) -> Ends:
    return tuple(place(np.array(u), np.array(v)) for u, v in (start, end))


@pytest.mark.parametrize(("du", "dv"), [(0.0, 150.0), (0.31, 83.0), (1.7, 11.0), (0.9, 0.0), (0.02, 1.0)])
def test_ways_on_cylinder_and_cone_are_straight_when_rolled_out(du: float, dv: float) -> None:
    around = np.linspace(-0.5, 2.6, 90)
    mesh = sheet(tube, around, np.linspace(0.0, 400.0, 81))
    start, end = between(tube, (0.123, 100.7), (0.123 + du, 100.7 + dv))
    assert length(shortest_path(mesh, start, end)) == pytest.approx(np.hypot(120.0 * du, dv), rel=0.002)
    mesh = sheet(cone, around, np.linspace(60.0, 360.0, 81))
    start, end = between(cone, (0.123, 160.7), (0.123 + du, 160.7 + dv))
    a, b = 160.7, 160.7 + dv
    exact = np.sqrt(a * a + b * b - 2.0 * a * b * np.cos(0.5 * du))
    assert length(shortest_path(mesh, start, end)) == pytest.approx(exact, rel=0.002)


def test_ways_on_a_ball_and_a_torus_are_arcs() -> None:
    fine = trimesh.creation.icosphere(subdivisions=5, radius=100.0)
    mesh = Mesh(np.asarray(fine.vertices), np.asarray(fine.faces))
    for seed in range(6):
        start, end = np.random.default_rng(seed).normal(size=(2, 3))
        start, end = (100.0 * each / np.linalg.norm(each) for each in (start, end))
        exact = 100.0 * np.arccos(start @ end / 1e4)
        assert length(shortest_path(mesh, start, end)) == pytest.approx(exact, rel=0.002)
    mesh = sheet(ring, np.linspace(-0.6, 0.9, 60), np.linspace(-2.2, 2.2, 80))
    start, end = between(ring, (0.111, -1.53), (0.111, 1.02))
    assert length(shortest_path(mesh, start, end)) == pytest.approx(50.0 * 2.55, rel=0.002)
    start, end = between(ring, (-0.21, 0.0), (0.31, 0.0))
    assert length(shortest_path(mesh, start, end)) == pytest.approx(200.0 * 0.52, rel=0.002)


def test_a_way_is_that_over_the_whole_skin_though_little_of_it_is_looked_at() -> None:
    fine = trimesh.creation.icosphere(subdivisions=5, radius=100.0)
    mesh = Mesh(np.asarray(fine.vertices) * [1.0, 0.6, 1.4], np.asarray(fine.faces))
    for first, last in np.random.default_rng(1).integers(0, len(mesh.faces), (12, 2)).tolist():
        start, end = (mesh.vertices[mesh.faces[each]].mean(axis=0) for each in (first, last))
        whole = SurfacePaths(_with_vertex(_with_vertex(mesh, start), end))
        np.testing.assert_allclose(shortest_path(mesh, start, end), whole.path(start, end), atol=1e-9)


def test_a_skin_whose_holes_meet_at_a_corner_can_be_walked_on() -> None:
    mesh = sheet(tube, np.linspace(0.0, 2.0, 21), np.linspace(0.0, 200.0, 21))
    middle = mesh.vertices[mesh.faces].mean(axis=1)
    turn = np.arctan2(middle[:, 1], middle[:, 0])
    low = (np.abs(turn - 0.65) < 0.05) & (np.abs(middle[:, 2] - 95.0) < 5.0)
    high = (np.abs(turn - 0.75) < 0.05) & (np.abs(middle[:, 2] - 105.0) < 5.0)
    torn = Mesh(mesh.vertices, mesh.faces[~(low | high)])
    assert (low.sum(), high.sum()) == (2, 2)
    assert len(split_pinched_vertices(torn).vertices) == len(torn.vertices) + 1
    assert split_pinched_vertices(mesh) is mesh
    start, end = between(tube, (0.2, 50.0), (1.2, 150.0))
    way = length(shortest_path(torn, start, end))
    assert np.hypot(120.0, 100.0) * 0.999 < way < np.hypot(120.0, 100.0) + 5.0
    assert length(SurfacePaths(torn).path(start, end)) == pytest.approx(way, rel=0.02)


def test_a_way_goes_round_a_wide_hole_however_far() -> None:
    mesh = sheet(tube, np.linspace(0.0, 3.0, 61), np.linspace(0.0, 400.0, 81))
    middle = mesh.vertices[mesh.faces].mean(axis=1)
    slit = (np.abs(np.arctan2(middle[:, 1], middle[:, 0]) - 1.5) < 0.05) & (middle[:, 2] > 20.0)
    start, end = between(tube, (1.4, 380.0), (1.6, 380.0))
    assert length(shortest_path(Mesh(mesh.vertices, mesh.faces[~slit]), start, end)) > 700.0


def test_there_is_no_way_from_one_part_to_another() -> None:
    apart = np.asarray(BALL.vertices) + np.array([300.0, 0.0, 0.0])
    faces = np.asarray(BALL.faces)
    two = Mesh(np.concatenate([BALL.vertices, apart]), np.concatenate([faces, faces + len(apart)]))
    with pytest.raises(LineError, match="No path over the skin"):
        SurfacePaths(two).path(np.array([100.0, 0.0, 0.0]), np.array([400.0, 0.0, 0.0]))
    with pytest.raises(LineError, match="No path over the skin"):
        shortest_path(two, np.array([100.0, 0.0, 0.0]), np.array([400.0, 0.0, 0.0]))


def test_a_skin_that_branches_cannot_be_drawn_on() -> None:
    points = np.array([[0, 0, 0], [0, 0, 9], [9, 0, 0], [-9, 0, 0], [0, 9, 0]], dtype=float)
    with pytest.raises(LineError, match="cannot be drawn on"):
        SurfacePaths(Mesh(points, np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4]])))
