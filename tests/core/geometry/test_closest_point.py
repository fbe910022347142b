"""Places on triangles, against trimesh and by hand."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from core.geometry.closest_point import Frames, centroids, nearest_on, neighbourhoods
from core.geometry.mesh import Mesh

RANDOM = np.random.default_rng(12)
CENTRES = np.repeat(RANDOM.normal(scale=60.0, size=(30, 3)), 3, axis=0)
SOUP = Mesh(CENTRES + RANDOM.normal(scale=10.0, size=(90, 3)), np.arange(90).reshape(30, 3))
POINTS = RANDOM.normal(scale=60.0, size=(700, 3))
ALL = np.arange(30)


def places_by_trimesh() -> np.ndarray:
    """Nearest places of all points on all triangles by trimesh, shape (30, 700, 3)."""
    corners = np.repeat(SOUP.vertices[SOUP.faces], len(POINTS), axis=0)
    points = np.tile(POINTS, (30, 1))
    return trimesh.triangles.closest_point(corners, points).reshape(30, -1, 3)


def in_space(u: np.ndarray, v: np.ndarray, h: np.ndarray | float = 0.0) -> np.ndarray:
    v0, v1, v2 = (SOUP.vertices[SOUP.faces[:, k], None] for k in range(3))
    h = np.broadcast_to(h, u.shape)
    return (
        v0 + u[..., None] * (v1 - v0) + v[..., None] * (v2 - v0) + h[..., None] * SOUP.face_normals[:, None]
    )


def test_distances_and_places_agree_with_trimesh():
    frames, places = Frames.of(SOUP), places_by_trimesh()
    u, v, h = frames.coordinates(POINTS, ALL)
    distance = np.linalg.norm(places - POINTS, axis=2)
    assert np.sqrt(frames.distance2(POINTS, ALL, h)) == pytest.approx(distance, abs=1e-9)
    at_u, at_v = frames.nearest_place(POINTS, ALL, u, v)
    assert np.abs(in_space(at_u, at_v) - places).max() < 1e-9
    assert min(at_u.min(), at_v.min(), (1.0 - at_u - at_v).min()) >= -1e-12


def test_frame_coordinates_give_the_point_back():
    assert np.abs(in_space(*Frames.of(SOUP).coordinates(POINTS, ALL)) - POINTS).max() < 1e-9


def found(**asked: object) -> np.ndarray:
    """Which triangles are given for which points, shape (30, 700); every point is in one group."""
    given = np.zeros((30, len(POINTS)), dtype=bool)
    seen = []
    for rows, triangles in neighbourhoods(POINTS, SOUP, **asked):
        given[np.ix_(triangles, rows)] = True
        seen += rows.tolist()
    assert sorted(seen) == list(range(len(POINTS)))
    return given


@pytest.mark.parametrize("spread", [0.0, 15.0])
def test_no_triangle_that_matters_is_missing(spread):
    distance = np.linalg.norm(places_by_trimesh() - POINTS, axis=2)
    given = found(spread=spread)
    assert given[distance**2 <= distance.min(axis=0) ** 2 + spread**2].all()
    assert given.mean() < 1.0


def test_no_triangle_within_reach_is_missing():
    reach = np.linspace(20.0, 60.0, 30)
    away = np.linalg.norm(centroids(SOUP)[:, None] - POINTS, axis=2)
    assert found(reach=reach)[away < reach[:, None]].all()
    assert list(neighbourhoods(POINTS, SOUP, reach=np.zeros(30))) == []


def test_triangles_without_a_plane_are_never_given():
    needle = Mesh(
        np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 0, 3], [0, 1, 3]])
    )
    for asked in ({}, {"reach": np.full(3, 1e3)}):
        assert {t for _, given in neighbourhoods(POINTS, needle, **asked) for t in given.tolist()} == {2}
    assert list(neighbourhoods(POINTS, Mesh(needle.vertices, needle.faces[:2]))) == []
    assert list(neighbourhoods(POINTS[:0], needle)) == []


def test_nearest_places_row_by_row_agree_with_trimesh():
    corners, points = np.repeat(SOUP.vertices[SOUP.faces], 200, axis=0), np.tile(POINTS[:200], (30, 1))
    expected = trimesh.triangles.closest_point(corners, points)
    np.testing.assert_allclose(nearest_on(corners, points), expected, atol=1e-9)
    # A triangle without extent is a line or a spot, and points on it are their own nearest places.
    flat = np.array([[(0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (2.0, 0.0, 0.0)], [(1.0, 2.0, 3.0)] * 3])
    asked = np.array([(3.0, 4.0, 0.0), (9.0, 9.0, 9.0)])
    np.testing.assert_allclose(nearest_on(flat, asked), [(3.0, 0.0, 0.0), (1.0, 2.0, 3.0)])
