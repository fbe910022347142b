"""Distances between a smooth predicted skin and a noisy scan, both ways, without bias (ours)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from core.geometry.closest_point import barycentric, centroid_tree, nearest_faces
from core.geometry.mesh import Faces, Flags, Floats, Indices, Mesh, Points

REACH = 40.0
"""Skin that is further away than this is none that a place could be compared with [mm]."""

CANDIDATES = 8
"""The nearest triangle is looked for among so many whose centroids are nearest."""

_ROUNDS = 4
_SLANT = 0.35  # a skin more slanted than this against the normal tells no distance along it [1]
_EASED = 3  # rounds in which normals are taken together with their neighbours
_MET = 0.3  # how far from the skin the place that was found may lie [mm]


class ScanSurface:
    """The skin of a scan [mm], to be asked how far places lie before it.

    ``noise`` [mm] is the standard deviation of its vertices along each axis.
    """

    def __init__(self, mesh: Mesh, noise: float = 0.0) -> None:
        self.mesh, self.noise = mesh, noise

    @cached_property
    def vertex_directions(self) -> Points:
        """Return approximate outward directions at the vertices, (n, 3) [1].

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
        return centroid_tree(self.mesh)

    def gaps(self, places: Points, normals: Points, curved: Floats | None = None) -> Floats:
        """Return how far ``places`` lie before the skin along unit ``normals``, both (k, 3), shape (k,) [mm].

        Negative behind it; not a number where there is no skin within reach, or none that faces that way.
        Where the skin is ``curved`` (k,) [1/mm] it stands before its triangles, and is taken to.
        """
        gap = np.zeros(len(places))
        for _ in range(_ROUNDS):
            face, _ = self._nearest(places - gap[:, None] * normals)
            facing = np.einsum("ij,ij->i", self.mesh.face_normals[face], normals)
            way = places - self.mesh.vertices[self.mesh.faces[face, 0]]
            ahead = np.einsum("ij,ij->i", self.mesh.face_normals[face], way)
            gap = ahead / np.where(np.abs(facing) > _SLANT, facing, np.nan)
            gap = np.where(np.abs(gap) < REACH, gap, np.nan)
            unknown = np.isnan(gap)
            gap[unknown] = 0.0
        hit = places - gap[:, None] * normals
        away = np.linalg.norm(self._nearest(hit)[1] - hit, axis=1)
        if curved is not None:
            vertices, corners = self.mesh.vertices, self.mesh.faces[face]
            parts = barycentric(vertices[corners], hit)
            # The normals of a skin of curvature 1 turn by as much as its places are apart.
            gap = gap - curved * heights_over_chords(vertices, vertices, corners, parts)
        return np.where(unknown | (away > _MET) | (facing < _SLANT), np.nan, gap)

    def _nearest(self, places: Points) -> tuple[Indices, Points]:
        return nearest_faces(self.mesh, places, self._middles, CANDIDATES)


def heights_over_chords(places: Points, normals: Points, corners: Faces, parts: Floats) -> Floats:
    """Return by how much a round skin stands before its triangles, shape (k,) [mm].

    Exact for a paraboloid: its height over the chord of each two of the ``corners`` (k, 3), by how the
    ``normals`` (r, 3) of ``places`` (r, 3) [mm] turn. ``parts`` (k, 3) are barycentric coordinates.
    """
    height = np.zeros(len(corners))
    for start, end in ((0, 1), (1, 2), (2, 0)):
        a, b = corners[:, start], corners[:, end]
        turn = np.einsum("ij,ij->i", normals[b] - normals[a], places[b] - places[a])
        height += 0.5 * parts[:, start] * parts[:, end] * turn
    return height


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


def grid_cells(places: Points, size: float) -> Indices:
    """Return the number of the cube of a ``size`` [mm] in which each place (k, 3) lies, shape (k,)."""
    at = np.floor(places / size).astype(np.int64)
    return np.asarray(np.unique(at, axis=0, return_inverse=True)[1]).ravel()


def is_valid(gaps: Floats) -> Flags:
    """Return where the distance is to a surface and not to a hole, shape (k,)."""
    return np.asarray(~np.isnan(gaps))


_BESIDE, _SLANT_TO_FOOT = (
    1.0,
    0.5,
)  # a foot this far from below a point [mm], and by the way to it, is no foot [1]


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
        stands = (np.abs(ahead) < REACH) & (beside < _BESIDE + _SLANT_TO_FOOT * np.abs(ahead))
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
