"""Closest points on triangles, and coordinates in their frames.

Points are asked about in groups that lie close together, each with all triangles that matter to it. So every
array is a full table, one row a triangle and one column a point, and no pair needs an index.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.distance import cdist

from core.geometry.mesh import Flags, Floats, Indices, Mesh, Points

_FLAT = 1e-10
"""A triangle whose area is below this part of its longest side squared has no usable frame."""

_GROUP = 256
"""At most so many points form a group: its tables then stay in the cache of the processor."""

_AT_ONCE = 50_000
"""So many points are looked up in one go: their tables take 100 MB."""

Table = tuple[Floats, Floats, Floats]


def is_usable(mesh: Mesh) -> Flags:
    """Return which triangles span a plane, shape (m,)."""
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
    good = np.flatnonzero(is_usable(mesh))
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
        yield np.sort(rows)  # in the order of memory
        return
    group = points[rows]
    axis = int(np.argmax(np.ptp(group, axis=0)))
    half = len(rows) // 2
    order = np.argpartition(group[:, axis], half)
    yield from _split(points, rows[order[:half]])
    yield from _split(points, rows[order[half:]])


def nearest_on(corners: Points, points: Points) -> Points:
    """Return the place nearest to each of ``points`` (k, 3) on the triangle of its row, (k, 3, 3) [mm].

    Source: the foot on the plane where that lies within the triangle, else the nearest place of its sides.
    (Ours, as loading trimesh for this alone takes longer than fitting a template.)
    """
    sides = np.roll(corners, -1, axis=1) - corners
    ways = points[:, None] - corners
    length2 = np.einsum("ksj,ksj->ks", sides, sides)
    along = np.einsum("ksj,ksj->ks", ways, sides) / np.maximum(length2, 1e-300)
    places = corners + np.clip(along, 0.0, 1.0)[..., None] * sides
    away2 = ((points[:, None] - places) ** 2).sum(axis=2)
    nearest = places[np.arange(len(points)), away2.argmin(axis=1)]
    normal = np.cross(sides[:, 0], sides[:, 1])
    within = (np.einsum("ksj,ksj->ks", np.cross(sides, ways), normal[:, None]) > 0.0).all(axis=1)
    height = np.einsum("kj,kj->k", ways[:, 0], normal) / np.maximum((normal**2).sum(axis=1), 1e-300)
    return np.asarray(np.where(within[:, None], points - height[:, None] * normal, nearest))


def centroid_tree(mesh: Mesh) -> cKDTree:
    """Return a tree of the centroids of the faces, quick to build and for ``nearest_faces`` to search."""
    return cKDTree(centroids(mesh), compact_nodes=False, balanced_tree=False)


def nearest_faces(
    mesh: Mesh, points: Points, tree: cKDTree | None = None, candidates: int = 12
) -> tuple[Indices, Points]:
    """Return the face of ``mesh`` nearest to each of ``points`` (k, 3) [mm], and the place on it, (k, 3).

    It is the nearest of the ``candidates`` whose centroids are nearest: on an even skin of body, of all. The
    ``tree`` holds the centroids, where there is one already.
    """
    tree = cKDTree(centroids(mesh)) if tree is None else tree
    if len(points) > _AT_ONCE:
        parts = np.split(points, range(_AT_ONCE, len(points), _AT_ONCE))
        found = [nearest_faces(mesh, part, tree, candidates) for part in parts]
        return np.concatenate([face for face, _ in found]), np.concatenate([place for _, place in found])
    count = min(candidates, len(mesh.faces))
    near: Indices = np.asarray(tree.query(points, np.arange(1, count + 1))[1], dtype=np.int64)
    corners = mesh.vertices[mesh.faces[near.ravel()]]
    places = nearest_on(corners, np.repeat(points, count, axis=0)).reshape(*near.shape, 3)
    best = np.arange(len(points)), ((places - points[:, None]) ** 2).sum(axis=2).argmin(axis=1)
    return near[best], places[best]


def barycentric(corners: Points, places: Points) -> Floats:
    """Return the barycentric coordinates of places (k, 3) on triangles (k, 3, 3) [mm], shape (k, 3) [1]."""
    a, b, way = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0], places - corners[:, 0]
    aa, bb, ab = (np.einsum("kj,kj->k", p, q) for p, q in ((a, a), (b, b), (a, b)))
    wa, wb = (np.einsum("kj,kj->k", way, p) for p in (a, b))
    area = np.maximum(aa * bb - ab**2, 1e-12)
    u, v = (bb * wa - ab * wb) / area, (aa * wb - ab * wa) / area
    return np.stack([1.0 - u - v, u, v], axis=1)


@dataclass(frozen=True, eq=False)
class Frames:
    """The frames of some triangles, each array of shape (m, 3, 3).

    ``corners``; ``to_frame``, whose rows give u, v and h from corner 0; the unit vectors ``along`` each side
    and ``across`` it, inward in the plane. ``lengths`` of the sides (m, 3) [mm].
    """

    corners: Floats
    to_frame: Floats
    along: Floats
    across: Floats
    lengths: Floats

    @classmethod
    def of(cls, mesh: Mesh) -> Frames:
        """Prepare the frames of all triangles; those of unusable ones mean nothing."""
        corners = mesh.vertices[mesh.faces]
        sides = np.roll(corners, -1, axis=1) - corners
        lengths = np.linalg.norm(sides, axis=2)
        along = sides / np.where(lengths > 0.0, lengths, 1.0)[:, :, None]
        across = np.cross(mesh.face_normals[:, None], along)
        frames = np.stack([sides[:, 0], -sides[:, 2], mesh.face_normals], axis=2)
        frames[~is_usable(mesh)] = np.eye(3)
        return cls(corners, np.linalg.inv(frames), along, across, lengths)

    def coordinates(self, points: Points, triangles: Indices) -> Table:
        """Return u, v [1] and h [mm] of each point, v0 + u e1 + v e2 + h n, in each triangle's frame.

        Shapes (k, 3) [mm], (c,) and three of (c, k).
        """
        start, forms = self.corners[triangles, 0], self.to_frame[triangles]
        u, v, h = (_linear(forms[:, row], start, points) for row in range(3))
        return u, v, h

    def distance2(self, points: Points, triangles: Indices, h: Floats) -> Floats:
        """Return the squared distances of points at heights ``h``, shape (c, k) [mm^2]."""
        (first, in_first), (second, in_second), (third, in_third) = (
            (away, across >= 0.0) for away, across, _ in self._sides(points, triangles)
        )
        away = np.minimum(np.minimum(first, second, out=first), third, out=first)
        away[in_first & in_second & in_third] = 0.0
        away += h * h
        return away

    def nearest_place(
        self, points: Points, triangles: Indices, u: Floats, v: Floats
    ) -> tuple[Floats, Floats]:
        """Return u and v of the nearest places on the triangles to points with these coordinates, (c, k)."""
        nearest = np.where((u >= 0.0) & (v >= 0.0) & (u + v <= 1.0), -1.0, np.inf)
        for side, (away, _, at) in enumerate(self._sides(points, triangles)):
            t = at / self.lengths[triangles, side, None]
            nearer = away < nearest
            nearest = np.where(nearer, away, nearest)
            u = np.where(nearer, (t, 1.0 - t, 0.0)[side], u)
            v = np.where(nearer, (0.0, t, 1.0 - t)[side], v)
        return u, v

    def _sides(self, points: Points, triangles: Indices) -> Iterator[Table]:
        """Give, for each side, the squared distance to it in the plane, that across it, and where on it."""
        for side in range(3):
            start = self.corners[triangles, side]
            along = _linear(self.along[triangles, side], start, points)
            across = _linear(self.across[triangles, side], start, points)
            at = np.clip(along, 0.0, self.lengths[triangles, side, None])
            along -= at
            along *= along
            along += across * across
            yield along, across, at


def _linear(forms: Points, start: Points, points: Points) -> Floats:
    """Return the products of ``forms`` (c, 3) with the ways from ``start`` (c, 3) to each point, (c, k)."""
    origin = points[0]  # small figures keep their digits
    table = forms @ (points - origin).T
    table -= np.einsum("ci,ci->c", forms, start - origin)[:, None]
    return np.asarray(table)
