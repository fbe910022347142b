"""Places on the skin: the nearest ones, which way it faces there, and the course of lines on it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse
from scipy.spatial import cKDTree

from core.control_mesh.embedding import Grid
from core.geometry.closest_point import Frames, centroid_tree, centroids, nearest_faces, neighbourhoods
from core.geometry.mesh import Flags, Floats, Indices, Mesh, Points, incidence, unit

CANDIDATES = 24
"""The nearest place is looked for on so many triangles whose centres are near."""


@dataclass(frozen=True, eq=False)
class SurfaceProjector:
    """Part of a body's skin; what it takes to look places up on it is prepared once."""

    mesh: Mesh

    @cached_property
    def _vertices(self) -> cKDTree:
        return cKDTree(self.mesh.vertices, compact_nodes=False, balanced_tree=False)

    @cached_property
    def _centres(self) -> cKDTree:
        return centroid_tree(self.mesh)

    @cached_property
    def vertex_areas(self) -> Floats:
        """Return the area of the triangles round each vertex, shape (n,) [mm^2]."""
        return np.asarray(incidence(self.mesh.faces, len(self.mesh.vertices)) @ self.mesh.face_areas)

    def normals_at(self, places: Points) -> Points:
        """Return the normals of the nearest vertices of the skin, as ``places``, shape (..., 3) [1]."""
        return np.asarray(self.mesh.vertex_normals[self._vertices.query(places)[1]])

    def project(self, places: Points) -> Points:
        """Return the nearest places of the skin, as ``places``, shape (k, 3) [mm]."""
        return nearest_faces(self.mesh, places, self._centres, CANDIDATES)[1]


_SPREAD = 30.0  # triangles further than the nearest by this are not looked at [mm]
_STEPS = 8  # of Newton's; the third is exact to a thousandth of a millimetre
_ROUNDS = 60  # from the skin to the normal and back; where both are square to each other the first is enough
_SETTLED = 1e-5  # such a round no longer changes the height [mm]
_AROUND = 80.0  # skin further than this from a place of the mesh does not lie over it [mm]
_INSIDE = -1e-6  # barycentric coordinates down to this are those of a place within a triangle


@dataclass(frozen=True, eq=False)
class MeshPositions:
    """Places on a control mesh: ``cells`` (k, 2) by row and column, and how ``far`` they are out of it, (k,).

    ``far`` [1] is 0 within the mesh; beyond its border, in parts of a triangle.
    """

    cells: Floats
    far: Floats

    @property
    def inside(self) -> Flags:
        """Return which positions are within the mesh, shape (k,)."""
        return np.asarray(self.far < 1e-3)


def locate_on_mesh(mesh: Mesh, grid: Grid, points: Points) -> MeshPositions:
    """Return where places of the skin, shape (k, 3) [mm], are on a control ``mesh`` at rest.

    Of several triangles whose normals lead there, the nearest is taken.
    """
    frames = Frames.of(mesh)
    corners, weights = np.zeros((len(points), 3), dtype=np.int64), np.zeros((len(points), 3))
    for rows, triangles in neighbourhoods(points, mesh, spread=_SPREAD):
        start = np.stack(frames.coordinates(points[rows], triangles), axis=2)
        found = _along_normals(mesh, triangles, points[rows], start)
        shares = np.concatenate([1.0 - found[..., :1] - found[..., 1:2], found[..., :2]], axis=2)
        out = np.maximum(_INSIDE - shares.min(axis=2), 0.0)
        # Within a triangle the lowest counts, outside of all the least far.
        worth = np.where(out > 0.0, 1e6 * (1.0 + out), np.abs(found[..., 2]))
        best = np.nan_to_num(worth, nan=np.inf).argmin(axis=0), np.arange(len(rows))
        corners[rows], weights[rows] = mesh.faces[triangles[best[0]]], shares[best]
    far = np.where(grid.covers(corners), np.maximum(-weights.min(axis=1), 0.0), 1.0)
    weights = np.clip(weights, 0.0, None)
    weights /= np.maximum(weights.sum(axis=1, keepdims=True), 1e-12)
    return MeshPositions(grid.places(corners, weights), far)


def _along_normals(mesh: Mesh, triangles: Indices, points: Points, start: Floats) -> Floats:
    """Return u, v [1] and height [mm] of each point over each triangle, (c, k, 3), ``start`` being near.

    A point is v0 + u e1 + v e2 + h n, the normal n going evenly from corner to corner.
    """
    corners, normals = mesh.vertices[mesh.faces[triangles]], mesh.vertex_normals[mesh.faces[triangles]]
    sides, turns = (np.stack([of[:, 1] - of[:, 0], of[:, 2] - of[:, 0]], axis=2) for of in (corners, normals))
    found = start.copy()
    for _ in range(_STEPS):
        flat, height = found[..., :2], found[..., 2, None]
        normal = normals[:, None, 0] + np.einsum("cxs,cks->ckx", turns, flat)
        place = corners[:, None, 0] + np.einsum("cxs,cks->ckx", sides, flat) + height * normal
        slope = np.concatenate(
            [sides[:, None] + height[..., None] * turns[:, None], normal[..., None]], axis=3
        )
        slope[np.abs(np.linalg.det(slope)) < 1e-9] = np.eye(3)  # a triangle that no step leads to
        found = found - np.linalg.solve(slope, (place - points)[..., None])[..., 0]
        found = np.clip(found, -1e3, 1e3)
    return found


def points_on_skin(skin: Mesh, mesh: Mesh, weights: sparse.csr_array) -> Points:
    """Return the places of the ``skin``, (k, 3), over those of a ``mesh`` with ``weights`` (k, n)."""
    places, normals = weights @ mesh.vertices, weights @ mesh.vertex_normals
    size = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = unit(normals) if size.all() else normals
    near = _near(skin, places)
    tree = cKDTree(centroids(near))
    height, found, left = np.zeros(len(places)), places.copy(), np.arange(len(places))
    for _ in range(_ROUNDS):
        _, found[left] = nearest_faces(near, places[left] + height[left, None] * normals[left], tree)
        now = np.einsum("kx,kx->k", found[left] - places[left], normals[left])
        moved, height[left] = np.abs(now - height[left]), now
        left = left[moved >= _SETTLED]
        if not len(left):
            break
    return found


def _near(skin: Mesh, places: Points) -> Mesh:
    """Return the part of a skin that may lie over ``places``."""
    away = cKDTree(places).query(centroids(skin), distance_upper_bound=_AROUND)[0]
    faces = skin.faces[np.isfinite(away)]
    return Mesh(skin.vertices, faces if len(faces) else skin.faces)
