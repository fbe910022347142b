"""How far a smooth skin stands before the points of a scan: all of them, each by itself (ours).

A scanner gives many points for each corner of the skin that is predicted, and what noise does to one says
nothing of the next. So every point is asked where it stands, and the more there are the surer the answer.
Between its corners the skin is taken to be as round as its normals say.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from core.analysis.calibration.surface_distance import REACH, curvature
from core.geometry.closest_point import nearest_on, shares
from core.geometry.mesh import Faces, Flags, Floats, Indices, Points

_NEAR = 8  # triangles whose middles are nearest, among which the foot is looked for
_AT_ONCE = 50_000  # points that are asked about in one go: their tables take 100 MB
_BESIDE, _SLANT = 1.0, 0.5  # a foot this far from below a point [mm], and by the way to it, is no foot [1]


@dataclass(frozen=True, eq=False)
class Feet:
    """Where points stand over a skin, and how far it stands before them, ``gaps`` (k,) [mm].

    ``rows`` (k,) number the points that stand over it at all. Their feet lie between the skin's vertices
    ``corners`` (k, 3) with ``parts`` (k, 3) [1] of each, and it looks along ``normals`` (k, 3) there.
    """

    rows: Indices
    corners: Faces
    parts: Floats
    normals: Points
    gaps: Floats

    def of(self, values: Floats) -> Floats:
        """Return what has ``values`` (r, ...) at the skin's vertices at the feet, shape (k, ...)."""
        return np.asarray(np.einsum("ks,ks...->k...", self.parts, values[self.corners]))


class Ground:
    """A skin to stand over: ``places`` (r, 3) [mm], unit ``normals`` (r, 3), triangles ``corners`` (3, a)."""

    def __init__(self, places: Points, normals: Points, corners: Faces) -> None:
        self.places, self._normals = places, normals
        self._corners, self._faces = corners, np.ascontiguousarray(corners.T)

    @cached_property
    def _middles(self) -> cKDTree:
        return cKDTree(self.places[self._faces].mean(axis=1), compact_nodes=False, balanced_tree=False)

    def feet(self, points: Points, facing: Points, noise: float = 0.0) -> Feet:
        """Return where ``points`` (n, 3) [mm] of a skin that looks along ``facing`` (n, 3) stand.

        ``noise`` [mm] is the standard deviation of the points along each axis: what it moves along a round
        skin lifts them off it, by noise squared times the mean curvature, and that is taken off.
        """
        rows = self._close(points)
        asked = points[rows]
        face, foot = self._nearest(asked)
        corners = self._faces[face]
        parts = shares(self.places[corners], foot)
        normals = np.einsum("ks,ksj->kj", parts, self._normals[corners])
        normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-12)[:, None]
        way = asked - foot
        ahead = np.einsum("ij,ij->i", way, normals)
        beside = np.linalg.norm(way - ahead[:, None] * normals, axis=1)
        stands = (np.abs(ahead) < REACH) & (beside < _BESIDE + _SLANT * np.abs(ahead))
        stands &= np.einsum("ij,ij->i", facing[rows], normals) > 0.0
        rows, corners, parts, normals = (each[stands] for each in (rows, corners, parts, normals))
        gaps = self._room(corners, parts) - ahead[stands]
        if noise > 0.0:
            gaps = gaps + noise**2 * np.einsum("ks,ks->k", parts, self._curved[corners])
        return Feet(rows, corners, parts, normals, gaps)

    @cached_property
    def _curved(self) -> Floats:
        return curvature(self.places, self._normals, self._corners)

    def _close(self, points: Points) -> Indices:
        low, high = self.places.min(axis=0) - REACH, self.places.max(axis=0) + REACH
        within: Flags = ((points > low) & (points < high)).all(axis=1)
        return np.flatnonzero(within)

    def _nearest(self, points: Points) -> tuple[Indices, Points]:
        """Return the nearest triangle to each point and the place on it, shapes (k,) and (k, 3) [mm]."""
        if len(points) > _AT_ONCE:
            parts = [self._nearest(each) for each in np.split(points, range(_AT_ONCE, len(points), _AT_ONCE))]
            return np.concatenate([part[0] for part in parts]), np.concatenate([part[1] for part in parts])
        count = min(_NEAR, len(self._faces))
        near = np.asarray(self._middles.query(points, np.arange(1, count + 1))[1])
        asked = np.repeat(points, count, axis=0)
        places = nearest_on(self.places[self._faces[near.ravel()]], asked).reshape(*near.shape, 3)
        best = np.arange(len(points)), ((places - points[:, None]) ** 2).sum(axis=2).argmin(axis=1)
        return near[best], places[best]

    def _room(self, corners: Faces, parts: Floats) -> Floats:
        """Return by how much the round skin stands before its triangles at some feet, (k,) [mm].

        Exact for a paraboloid: its height over the chord of each two corners, by how their normals turn.
        """
        room = np.zeros(len(corners))
        for start, end in ((0, 1), (1, 2), (2, 0)):
            a, b = corners[:, start], corners[:, end]
            turn = np.einsum("ij,ij->i", self._normals[b] - self._normals[a], self.places[b] - self.places[a])
            room += 0.5 * parts[:, start] * parts[:, end] * turn
        return room
