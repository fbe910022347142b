"""Places on triangles, against trimesh and by hand."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from core.mesh import Mesh
from core.proximity import nearest_place, pairs_around, pairs_within

RANDOM = np.random.default_rng(12)
SOUP = Mesh(RANDOM.normal(scale=20.0, size=(90, 3)), np.arange(90).reshape(30, 3))
POINTS = RANDOM.normal(scale=30.0, size=(200, 3))


def every_distance() -> np.ndarray:
    """Distances of all points to all triangles by trimesh, shape (200, 30)."""
    corners = np.tile(SOUP.vertices[SOUP.faces], (len(POINTS), 1, 1))
    points = np.repeat(POINTS, len(SOUP.faces), axis=0)
    places = trimesh.triangles.closest_point(corners, points)
    return np.linalg.norm(places - points, axis=1).reshape(len(POINTS), -1)


def test_distances_and_places_agree_with_trimesh():
    pairs = pairs_within(POINTS, SOUP, np.full(30, np.inf))
    assert len(pairs.point) == 200 * 30
    distance2, place = nearest_place(pairs, SOUP)
    assert np.sqrt(distance2).reshape(200, 30) == pytest.approx(every_distance(), abs=1e-9)
    spot = np.einsum("ij,ijk->ik", place, SOUP.vertices[SOUP.faces[pairs.triangle]])
    assert np.linalg.norm(spot - POINTS[pairs.point], axis=1) == pytest.approx(np.sqrt(distance2), abs=1e-9)
    assert place.min() >= -1e-12
    assert place.sum(axis=1) == pytest.approx(1.0)


def test_frame_coordinates_give_the_point_back():
    pairs = pairs_within(POINTS, SOUP, np.full(30, np.inf))
    v0, v1, v2 = np.moveaxis(SOUP.vertices[SOUP.faces[pairs.triangle]], 1, 0)
    in_plane = v0 + pairs.u[:, None] * (v1 - v0) + pairs.v[:, None] * (v2 - v0)
    back = in_plane + pairs.h[:, None] * SOUP.face_normals[pairs.triangle]
    assert np.abs(back - POINTS[pairs.point]).max() < 1e-9


@pytest.mark.parametrize("spread", [0.0, 15.0])
def test_no_triangle_that_matters_is_missing(spread):
    distance = every_distance()
    pairs = pairs_around(POINTS, SOUP, spread)
    found = np.zeros(distance.shape, dtype=bool)
    found[pairs.point, pairs.triangle] = True
    matters = distance**2 <= distance.min(axis=1, keepdims=True) ** 2 + spread**2
    assert found[matters].all()
    assert found.mean() < 0.9
    assert (np.diff(pairs.point) >= 0).all()


def test_triangles_without_a_plane_pair_with_nothing():
    needle = Mesh(
        np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 0, 3], [0, 1, 3]])
    )
    assert set(pairs_around(POINTS, needle).triangle.tolist()) == {2}
    assert set(pairs_within(POINTS, needle, np.full(3, 1e3)).triangle.tolist()) == {2}
