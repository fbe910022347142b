"""Where points lie seen from triangles: coordinates in their frames, and the nearest place on them.

Points are asked about in groups that lie close together, each with all triangles that matter to it. So every
array is a full table, one row a triangle and one column a point, and no pair needs an index.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.spatial.distance import cdist

from core.mesh import Flags, Floats, Indices, Mesh, Points

_FLAT = 1e-10
"""A triangle whose area is below this part of its longest side squared has no usable frame."""

_GROUP = 256
"""At most so many points form a group: its tables then stay in the cache of the processor."""

Table = tuple[Floats, Floats, Floats]


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


def neighbourhoods(
    points: Points, mesh: Mesh, spread: float = 0.0, reach: Floats | None = None
) -> Iterator[tuple[Indices, Indices]]:
    """Split ``points``, shape (k, 3) [mm], into groups; give rows and the usable triangles that may matter.

    Certain to be there: each triangle at a distance d with d^2 <= d_min^2 + ``spread``^2 [mm], d_min being
    the distance of the point to the nearest triangle; or, if ``reach`` (m,) [mm] is given, each whose
    centroid is nearer than that. Points that none can matter to are in no group.
    """
    good = np.flatnonzero(usable(mesh))
    if not len(good) or not len(points):
        return
    centres = centroids(mesh)[good]
    radii = corner_reach(mesh)[good].max(axis=1) if reach is None else reach[good]
    for rows in _split(points, np.arange(len(points))):
        to_centre = cdist(centres, points[rows])
        # A triangle is never further than its centroid, and never nearer than its furthest corner allows.
        leeway = np.hypot(to_centre.min(axis=0), spread) if reach is None else 0.0
        near = (to_centre <= leeway + radii[:, None]).any(axis=1)
        if near.any():
            yield rows, good[near]


def _split(points: Points, rows: Indices) -> Iterator[Indices]:
    """Halve ``rows`` across their widest extent until all groups are small."""
    if len(rows) <= _GROUP:
        yield rows
        return
    group = points[rows]
    axis = int(np.argmax(np.ptp(group, axis=0)))
    half = len(rows) // 2
    order = np.argpartition(group[:, axis], half)
    yield from _split(points, rows[order[:half]])
    yield from _split(points, rows[order[half:]])


@dataclass(frozen=True, eq=False)
class Frames:
    """The frames of some triangles: corner v0, sides e1, e2 and unit normal n of each."""

    corner: Points
    to_frame: Floats
    gram: Floats

    @classmethod
    def of(cls, mesh: Mesh) -> Frames:
        """Prepare the frames of all triangles; those of unusable ones mean nothing."""
        v0, v1, v2 = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
        e1, e2 = v1 - v0, v2 - v0
        frames = np.stack([e1, e2, mesh.face_normals], axis=2)
        frames[~usable(mesh)] = np.eye(3)
        gram = np.stack([np.einsum("ij,ij->i", a, b) for a, b in ((e1, e1), (e1, e2), (e2, e2))])
        return cls(v0, np.linalg.inv(frames), gram)

    def coordinates(self, points: Points, triangles: Indices) -> Table:
        """Return u, v [1] and h [mm] of each point, v0 + u e1 + v e2 + h n, in each triangle's frame.

        Shapes (k, 3) [mm], (c,) and three of (c, k).
        """
        origin = points[0]  # small figures keep their digits
        to_frame = self.to_frame[triangles]
        start = np.einsum("cij,cj->ci", to_frame, self.corner[triangles] - origin)
        u, v, h = (to_frame[:, axis] @ (points - origin).T - start[:, axis, None] for axis in range(3))
        return u, v, h

    def distance2(self, triangles: Indices, u: Floats, v: Floats, h: Floats) -> Floats:
        """Return the squared distances to the triangles of points with these coordinates, (c, k) [mm^2]."""
        sides = self._sides(triangles, u, v)
        away = np.minimum(np.minimum(next(sides)[0], next(sides)[0]), next(sides)[0])
        away[(u >= 0.0) & (v >= 0.0) & (u + v <= 1.0)] = 0.0
        away += h * h
        return away

    def nearest_place(self, triangles: Indices, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """Return u and v of the places on the triangles nearest to points with these coordinates, (c, k)."""
        inside = (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0)
        best, at_u, at_v = np.where(inside, -1.0, np.inf), u, v
        for away, side_u, side_v in self._sides(triangles, u, v):
            nearer = away < best
            best = np.where(nearer, away, best)
            at_u, at_v = np.where(nearer, side_u, at_u), np.where(nearer, side_v, at_v)
        return at_u, at_v

    def _sides(self, triangles: Indices, u: Floats, v: Floats) -> Iterator[tuple[Floats, Any, Any]]:
        """Give the squared distance in the plane to each side, and where on it the nearest place is."""
        g11, g12, g22 = self.gram[:, triangles, None]
        t = np.clip(u + g12 / g11 * v, 0.0, 1.0)
        yield _length2(self.gram[:, triangles, None], u - t, v), t, 0.0
        t = np.clip(v + g12 / g22 * u, 0.0, 1.0)
        yield _length2(self.gram[:, triangles, None], u, v - t), 0.0, t
        skew = g11 - 2.0 * g12 + g22
        t = np.clip((g22 - g12) / skew * v - (g11 - g12) / skew * (u - 1.0), 0.0, 1.0)
        yield _length2(self.gram[:, triangles, None], u + (t - 1.0), v - t), 1.0 - t, t


def _length2(gram: Floats, u: Floats, v: Floats) -> Floats:
    """Return the squared lengths of u e1 + v e2."""
    g11, g12, g22 = gram
    return np.asarray(u * (g11 * u + 2.0 * g12 * v) + g22 * (v * v))
