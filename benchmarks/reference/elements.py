"""Taylor-Hood tetrahedra: quadratic displacements (10 nodes), linear pressures (4 corners).

Source: quadrature of degree 5 with 14 points, Walkington (2000).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import permutations

import numpy as np

from core.geometry.mesh import Faces, Floats, Indices, Points

EDGES = np.array([(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)])
"""Corners of a tetrahedron's edges; the middles of the first three are those of the face 0, 1, 2."""


def quadrature() -> tuple[Floats, Floats]:
    """Return barycentric places (14, 4) [1] and weights (14,) [1] whose sum is the volume 1/6."""
    places, weights = [], []
    for inner, weight in (
        (0.31088591926330061, 0.11268792571801585),
        (0.09273525031089123, 0.07349304311636195),
    ):
        for corner in range(4):
            places.append([1.0 - 3.0 * inner if each == corner else inner for each in range(4)])
            weights.append(weight)
    near, weight = 0.04550370412564965, 0.04254602077708147
    for place in sorted(set(permutations((near, near, 0.5 - near, 0.5 - near)))):
        places.append(list(place))
        weights.append(weight)
    return np.array(places), np.array(weights) / (6.0 * sum(weights))


def quadratic(barycentric: Floats, edges: Indices) -> Floats:
    """Return quadratic shape functions at places (k, c) of simplices with ``edges`` (e, 2), (k, c + e)."""
    corners = barycentric * (2.0 * barycentric - 1.0)
    return np.concatenate([corners, 4.0 * barycentric[:, edges[:, 0]] * barycentric[:, edges[:, 1]]], axis=1)


def quadratic_slopes(barycentric: Floats) -> Floats:
    """Return derivatives of the ten shape functions along the last three coordinates, (k, 3, 10) [1]."""
    count = len(barycentric)
    by_coordinate = np.zeros((count, 4, 10))
    for corner in range(4):
        by_coordinate[:, corner, corner] = 4.0 * barycentric[:, corner] - 1.0
    for number, (one, other) in enumerate(EDGES):
        by_coordinate[:, one, 4 + number] = 4.0 * barycentric[:, other]
        by_coordinate[:, other, 4 + number] = 4.0 * barycentric[:, one]
    return by_coordinate[:, 1:] - by_coordinate[:, :1]


@dataclass(frozen=True, eq=False)
class TetMesh:
    """Quadratic tetrahedra with straight edges: ``nodes`` (n, 3) [mm], corners first, then edge middles.

    ``tetrahedra`` (t, 10): corners and middles of ``EDGES``; ``corner_count`` nodes carry a pressure.
    """

    nodes: Points
    tetrahedra: Indices
    corner_count: int

    @cached_property
    def middle_of(self) -> dict[tuple[int, int], int]:
        """Return the middle node of each edge by its corners, lower first."""
        ends = np.sort(self.tetrahedra[:, EDGES], axis=2).reshape(-1, 2)
        middles = self.tetrahedra[:, 4:].ravel().tolist()
        return {(one, other): middle for (one, other), middle in zip(ends.tolist(), middles, strict=True)}

    def quadratic_faces(self, faces: Faces) -> Indices:
        """Return the corners and the middles of the edges 01, 12, 20 of ``faces`` (m, 3), shape (m, 6)."""
        sides = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2), axis=2)
        middles = [[self.middle_of[one, other] for one, other in each] for each in sides.tolist()]
        return np.concatenate([faces, np.array(middles, dtype=np.int64)], axis=1)


def quadratic_mesh(corners: Points, tetrahedra: Indices) -> TetMesh:
    """Return quadratic tetrahedra over linear ones, (n, 3) [mm] and (t, 4), all of positive volume."""
    sides = corners[tetrahedra[:, 1:]] - corners[tetrahedra[:, :1]]
    inverted = np.linalg.det(sides) < 0.0
    turned = tetrahedra.copy()
    turned[inverted, 2:] = tetrahedra[inverted][:, [3, 2]]
    ends = np.sort(turned[:, EDGES], axis=2).reshape(-1, 2)
    unique, number = np.unique(ends, axis=0, return_inverse=True)
    nodes = np.concatenate([corners, corners[unique].mean(axis=1)])
    return TetMesh(nodes, np.hstack([turned, len(corners) + number.reshape(-1, 6)]), len(corners))
