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

from core.analysis.calibration.surface_distance import CANDIDATES, REACH, curvature, heights_over_chords
from core.geometry.closest_point import barycentric, centroid_tree, nearest_faces
from core.geometry.mesh import Faces, Flags, Floats, Indices, Mesh, Points

_BESIDE, _SLANT = 1.0, 0.5  # a foot this far from below a point [mm], and by the way to it, is no foot [1]


@dataclass(frozen=True, eq=False)
class Projection:
    """Where points stand over a skin, and how far it stands before them, ``gaps`` (k,) [mm].

    ``rows`` (k,) number the points that stand over it at all. Their feet lie between the skin's vertices
    ``corners`` (k, 3) with ``parts`` (k, 3) [1] of each, and it looks along ``normals`` (k, 3) there.
    """

    rows: Indices
    corners: Faces
    parts: Floats
    normals: Points
    gaps: Floats

    def interpolate(self, values: Floats) -> Floats:
        """Return what has ``values`` (r, ...) at the skin's vertices at the feet, shape (k, ...)."""
        return np.asarray(np.einsum("ks,ks...->k...", self.parts, values[self.corners]))


class Surface:
    """A skin to stand over: ``places`` (r, 3) [mm], unit ``normals`` (r, 3), triangles ``corners`` (3, a)."""

    def __init__(self, places: Points, normals: Points, corners: Faces) -> None:
        self.places, self._normals, self._corners = places, normals, corners
        self._mesh = Mesh(places, corners.T)

    @cached_property
    def _middles(self) -> cKDTree:
        return centroid_tree(self._mesh)

    def project(self, points: Points, facing: Points, noise: float = 0.0) -> Projection:
        """Return where ``points`` (n, 3) [mm] of a skin that looks along ``facing`` (n, 3) stand.

        ``noise`` [mm] is the standard deviation of the points along each axis: what it moves along a round
        skin lifts them off it, by noise squared times the mean curvature, and that is taken off.
        """
        rows = self._close(points)
        asked = points[rows]
        face, foot = nearest_faces(self._mesh, asked, self._middles, CANDIDATES)
        corners = self._mesh.faces[face]
        parts = barycentric(self.places[corners], foot)
        normals = np.einsum("ks,ksj->kj", parts, self._normals[corners])
        normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-12)[:, None]
        way = asked - foot
        ahead = np.einsum("ij,ij->i", way, normals)
        beside = np.linalg.norm(way - ahead[:, None] * normals, axis=1)
        stands = (np.abs(ahead) < REACH) & (beside < _BESIDE + _SLANT * np.abs(ahead))
        stands &= np.einsum("ij,ij->i", facing[rows], normals) > 0.0
        rows, corners, parts, normals = (each[stands] for each in (rows, corners, parts, normals))
        gaps = heights_over_chords(self.places, self._normals, corners, parts) - ahead[stands]
        if noise > 0.0:
            gaps = gaps + noise**2 * np.einsum("ks,ks->k", parts, self._curved[corners])
        return Projection(rows, corners, parts, normals, gaps)

    @cached_property
    def _curved(self) -> Floats:
        return curvature(self.places, self._normals, self._corners)

    def _close(self, points: Points) -> Indices:
        low, high = self.places.min(axis=0) - REACH, self.places.max(axis=0) + REACH
        within: Flags = ((points > low) & (points < high)).all(axis=1)
        return np.flatnonzero(within)
