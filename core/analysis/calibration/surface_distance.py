"""How far places lie before a skin, along their own normals: unbiased where the skin is noisy (ours).

The nearest place of a rough skin is its nearest bump; where the normal meets it, bumps and hollows even out.
A triangle cuts the corner of a round skin: by how much, the curvature of the predicted skin tells, which has
no noise of this scan.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from core.geometry.closest_point import centroids, nearest_on, shares
from core.geometry.mesh import Faces, Flags, Floats, Indices, Mesh, Points

REACH = 40.0
"""Skin that is further away than this is none that a place could be compared with [mm]."""

_NEAR = 8  # triangles whose middles are nearest, among which the nearest is looked for
_ROUNDS = 4
_SLANT = 0.35  # a skin more slanted than this against the normal tells no distance along it [1]
_EASED = 3  # rounds in which normals are taken together with their neighbours
_MET = 0.3  # how far from the skin the place that was found may lie [mm]


class WornSkin:
    """The skin of a scan [mm], to be asked how far places lie before it.

    ``noise`` [mm] is the standard deviation of its vertices along each axis.
    """

    def __init__(self, mesh: Mesh, noise: float = 0.0) -> None:
        self.mesh, self.noise = mesh, noise

    @cached_property
    def facing(self) -> Points:
        """Where it looks at its vertices, as roughly as matters to tell front from back, (n, 3) [1].

        A fine skin with noise has normals of all sorts: those of neighbours are taken together.
        """
        ways, corners = self.mesh.vertex_normals, self.mesh.faces.T
        for _ in range(_EASED):
            sums = ways[corners].sum(axis=0)
            ways = np.stack(
                [
                    sum(np.bincount(corner, sums[:, axis], len(ways)) for corner in corners)
                    for axis in range(3)
                ],
                axis=1,
            )
            ways /= np.maximum(np.linalg.norm(ways, axis=1), 1e-12)[:, None]
        return ways

    @cached_property
    def _middles(self) -> cKDTree:
        return cKDTree(centroids(self.mesh), compact_nodes=False, balanced_tree=False)

    def gaps(self, places: Points, normals: Points, curved: Floats | None = None) -> Floats:
        """Return how far ``places`` lie before the skin along unit ``normals``, both (k, 3), shape (k,) [mm].

        Negative behind it; not a number where there is no skin within reach, or none that faces that way.
        Where the skin is ``curved`` (k,) [1/mm] it stands before its triangles, and is taken to.
        """
        gap = np.zeros(len(places))
        for _ in range(_ROUNDS):
            face, away = self._nearest(places - gap[:, None] * normals)
            facing = np.einsum("ij,ij->i", self.mesh.face_normals[face], normals)
            way = places - self.mesh.vertices[self.mesh.faces[face, 0]]
            ahead = np.einsum("ij,ij->i", self.mesh.face_normals[face], way)
            gap = ahead / np.where(np.abs(facing) > _SLANT, facing, np.nan)
            gap = np.where(np.abs(gap) < REACH, gap, np.nan)
            unknown = np.isnan(gap)
            gap[unknown] = 0.0
        hit = places - gap[:, None] * normals
        _, away = self._nearest(hit)
        if curved is not None:
            gap = gap - curved * self._room(face, hit)
        return np.where(unknown | (away > _MET) | (facing < _SLANT), np.nan, gap)

    def _room(self, face: Indices, hit: Points) -> Floats:
        """Return by how much a skin of curvature 1 stands before its triangles at ``hit``, (k,) [mm^2].

        Exact for a paraboloid: half the mean square of how far the corners are away, each by its share.
        """
        corners = self.mesh.vertices[self.mesh.faces[face]]
        away = ((corners - hit[:, None]) ** 2).sum(axis=2)
        return np.asarray(0.5 * (shares(corners, hit) * away).sum(axis=1))

    def _nearest(self, places: Points) -> tuple[Indices, Floats]:
        """Return the nearest face to each place and how far away it is, shapes (k,) and (k,) [mm]."""
        count = min(_NEAR, len(self.mesh.faces))
        near = np.asarray(self._middles.query(places, np.arange(1, count + 1))[1])
        corners = self.mesh.vertices[self.mesh.faces[near.ravel()]]
        asked = np.repeat(places, count, axis=0)
        away = np.linalg.norm(nearest_on(corners, asked) - asked, axis=1).reshape(-1, count)
        best = away.argmin(axis=1), np.arange(len(places))
        return near[best[1], best[0]], away[best[1], best[0]]


def curvature(places: Points, normals: Points, corners: Faces) -> Floats:
    """Return the mean curvature of a skin at ``places`` (r, 3) [mm], shape (r,) [1/mm]; positive if round.

    From how ``normals`` (r, 3) turn along the edges of its triangles, ``corners`` (3, a).
    """
    turned, squares = np.zeros(len(places)), np.zeros(len(places))
    for start, end in zip(corners, np.roll(corners, 1, axis=0), strict=True):
        way, turn = places[end] - places[start], normals[end] - normals[start]
        for at in (start, end):
            turned += np.bincount(at, np.einsum("ij,ij->i", way, turn), len(places))
            squares += np.bincount(at, np.einsum("ij,ij->i", way, way), len(places))
    return turned / np.maximum(squares, 1e-12)


def cells(places: Points, size: float) -> Indices:
    """Return the number of the cube of a ``size`` [mm] in which each place (k, 3) lies, shape (k,)."""
    at = np.floor(places / size).astype(np.int64)
    return np.asarray(np.unique(at, axis=0, return_inverse=True)[1]).ravel()


def known(gaps: Floats) -> Flags:
    """Tell where there is a skin, shape (k,)."""
    return np.asarray(~np.isnan(gaps))
