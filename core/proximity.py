"""Where points lie seen from triangles: coordinates in their frames, and the nearest place on them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial.distance import cdist

from core.mesh import Flags, Floats, Indices, Mesh, Points

_FLAT = 1e-10
"""A triangle whose area is below this part of its longest side squared has no usable frame."""


@dataclass(frozen=True, eq=False)
class Pairs:
    """Point-triangle pairs, ordered by point, each with the point's place in the triangle's frame.

    ``point`` and ``triangle`` are the indices, shape (p,). With corner v0, sides e1, e2 and unit normal n
    the point is v0 + u e1 + v e2 + h n; ``u``, ``v`` [1] and ``h`` [mm] have shape (p,).
    """

    point: Indices
    triangle: Indices
    u: Floats
    v: Floats
    h: Floats

    def chosen(self, keep: Flags | Indices) -> Pairs:
        """Return the pairs that ``keep`` selects."""
        return Pairs(self.point[keep], self.triangle[keep], self.u[keep], self.v[keep], self.h[keep])


def usable(mesh: Mesh) -> Flags:
    """Tell which triangles span a plane, shape (m,)."""
    sides = mesh.vertices[np.roll(mesh.faces, -1, axis=1)] - mesh.vertices[mesh.faces]
    return np.asarray(mesh.face_areas > _FLAT * np.einsum("ijk,ijk->ij", sides, sides).max(axis=1))


def centroids(mesh: Mesh) -> Points:
    """Return the centroids of the faces, shape (m, 3) [mm]."""
    return np.asarray(mesh.vertices[mesh.faces].mean(axis=1))


def corner_reach(mesh: Mesh) -> Floats:
    """Return the distances of the corners from the centroid of their face, shape (m, 3) [mm]."""
    return np.asarray(np.linalg.norm(mesh.vertices[mesh.faces] - centroids(mesh)[:, None], axis=2))


def pairs_within(points: Points, mesh: Mesh, reach: Floats) -> Pairs:
    """Pair ``points``, shape (k, 3) [mm], with the usable triangles whose centroid is nearer than ``reach``.

    ``reach`` is one radius for each triangle, shape (m,) [mm].
    """
    near = (cdist(points, centroids(mesh)) < reach) & usable(mesh)
    return _framed(points, mesh, near)


def pairs_around(points: Points, mesh: Mesh, spread: float = 0.0) -> Pairs:
    """Pair ``points``, shape (k, 3) [mm], with every usable triangle that can matter, and some more.

    Certain to be there: each triangle at a distance d with d^2 <= d_min^2 + ``spread``^2 [mm], d_min being
    the distance of the point to the nearest triangle.
    """
    good = usable(mesh)
    to_centroid = np.where(good, cdist(points, centroids(mesh)), np.inf)
    # A triangle is never further than its centroid, and never nearer than its furthest corner allows.
    at_most = to_centroid.min(axis=1, keepdims=True, initial=np.inf)
    at_least = np.maximum(to_centroid - corner_reach(mesh).max(axis=1), 0.0)
    return _framed(points, mesh, at_least <= np.sqrt(at_most**2 + spread**2))


def _framed(points: Points, mesh: Mesh, near: Flags) -> Pairs:
    v0, v1, v2 = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    frames = np.stack([v1 - v0, v2 - v0, mesh.face_normals], axis=2)
    frames[~usable(mesh)] = np.eye(3)
    to_frame = np.linalg.inv(frames)
    point, triangle = np.nonzero(near)
    offset = (points[point] - v0[triangle]).T
    u, v, h = (np.einsum("ij,ji->i", to_frame[triangle, k], offset) for k in range(3))
    return Pairs(point, triangle, u, v, h)


def nearest_place(pairs: Pairs, mesh: Mesh) -> tuple[Floats, Floats]:
    """Return the squared distances to the triangles and the nearest places on them.

    Shapes (p,) [mm^2] and (p, 3) [1]: barycentric coordinates, none negative.
    """
    v0, v1, v2 = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    e1, e2 = v1 - v0, v2 - v0
    g11, g12, g22 = (np.einsum("ij,ij->i", a, b)[pairs.triangle] for a, b in ((e1, e1), (e1, e2), (e2, e2)))
    u, v = pairs.u, pairs.v

    def length2(du: Floats, dv: Floats) -> Floats:
        return np.asarray(g11 * du * du + 2.0 * g12 * du * dv + g22 * dv * dv)

    zero = np.zeros_like(u)
    t1 = np.clip(u + g12 / g11 * v, 0.0, 1.0)
    t2 = np.clip(v + g12 / g22 * u, 0.0, 1.0)
    t3 = np.clip(((1.0 - u) * (g11 - g12) + v * (g22 - g12)) / (g11 - 2.0 * g12 + g22), 0.0, 1.0)
    best = np.where((u >= 0.0) & (v >= 0.0) & (u + v <= 1.0), 0.0, np.inf)
    at_u, at_v = u.copy(), v.copy()
    for side_u, side_v in ((t1, zero), (zero, t2), (1.0 - t3, t3)):
        away = length2(u - side_u, v - side_v)
        nearer = away < best
        best = np.where(nearer, away, best)
        at_u, at_v = np.where(nearer, side_u, at_u), np.where(nearer, side_v, at_v)
    return best + pairs.h**2, np.stack([1.0 - at_u - at_v, at_u, at_v], axis=1)
