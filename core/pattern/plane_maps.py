"""Maps of a curved surface into the plane: slopes in triangles, band storage, conformal and rigid maps."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import reverse_cuthill_mckee

from core.geometry.mesh import Faces, Floats, Indices, Points, half_edges
from core.mechanics.banded_matrix import Band, Solve

_FLAT = 1e-8
"""The least area of a triangle in parts of its longest side squared [1]: a thread has no slopes."""

_RIGID_TURNS = 12
"""Turns of the rigid map: more change the points by less than their distance from each other."""


@dataclass(frozen=True, eq=False)
class TriangleSlopes:
    """Areas (m,) [mm^2] of triangles in space and the slopes of their three hat functions, (m, 3, 2) [1/mm].

    Slopes are in a plane frame of each triangle, whose first axis is its side 0-1; seen from outside it is
    right-handed.
    """

    areas: Floats
    slopes: Floats


def triangle_slopes(places: Points, faces: Faces) -> TriangleSlopes:
    """Return areas and slopes of ``faces`` (m, 3) with corners at ``places`` (p, 3) [mm]."""
    a, b, c = (places[faces[:, k]] for k in range(3))
    one, two = b - a, c - a
    length = np.linalg.norm(one, axis=1)
    longest = np.maximum(length, np.linalg.norm(two, axis=1))
    along = np.einsum("ij,ij->i", one, two) / np.maximum(length, 1e-300)
    height = np.linalg.norm(np.cross(one, two), axis=1) / np.maximum(length, 1e-300)
    height = np.maximum(height, 2.0 * _FLAT * longest**2 / np.maximum(length, 1e-300))
    double = length * height
    zero = np.zeros_like(double)
    x = np.stack([-height, height, zero], axis=1)
    y = np.stack([along - length, -along, length], axis=1)
    return TriangleSlopes(0.5 * double, np.stack([x, y], axis=2) / double[:, None, None])


@dataclass(frozen=True, eq=False)
class PlaneBand:
    """Where blocks of triangles go in the band of a symmetric matrix, ``axes`` coordinates a point.

    ``band`` is the order of coordinates; entry e of all blocks (m, 3 axes, 3 axes), those ``below`` the
    diagonal, goes to ``at`` of the lower band.
    """

    band: Band
    at: Indices
    below: Indices

    @classmethod
    def of(cls, faces: Faces, count: int, axes: int) -> PlaneBand:
        """Order ``count`` points (Cuthill and McKee), so that corners of ``faces`` lie near each other."""
        sides = half_edges(faces)
        graph = sparse.coo_array((np.ones(len(sides)), sides.T), (count, count))
        place = np.empty(count, dtype=np.int64)
        symmetric = sparse.csr_array(graph + graph.T)
        place[reverse_cuthill_mckee(symmetric, symmetric_mode=True)] = np.arange(count)
        reach = axes * int(np.abs(place[sides[:, 0]] - place[sides[:, 1]]).max()) + axes - 1
        whole = axes * place[:, None] + np.arange(axes)
        corners = whole[faces].reshape(len(faces), 3 * axes)
        row, column = corners[:, :, None], corners[:, None, :]
        below = np.flatnonzero(row >= column)
        at = (column * (reach + 1) + row - column).ravel()[below]
        return cls(Band(whole.ravel(), reach), at, below)

    def lower(self, blocks: Floats) -> Floats:
        """Return the lower band of the sum of ``blocks``."""
        size = self.band.size * (self.band.reach + 1)
        return np.bincount(self.at, blocks.ravel()[self.below], size).astype(np.float64, copy=False)

    @cached_property
    def diagonal(self) -> Indices:
        """Return where the diagonal lies in the lower band, by coordinate."""
        return np.asarray(self.band.place * (self.band.reach + 1))

    def factor(self, lower: Floats) -> Solve:
        """Return a solver of the matrix with this ``lower`` band, its diagonal raised until there is one.

        Raises FloatingPointError if the matrix is not finite.
        """
        raised = 1e-7 * float(np.abs(lower[self.diagonal]).mean())
        if not np.isfinite(raised):
            raise FloatingPointError("a matrix that is not finite")
        while (solve := self.band.cholesky(lower)) is None:
            lower[self.diagonal] += raised
            raised *= 30.0
        return solve


def conformal_map(places: Points, faces: Faces, slopes: TriangleSlopes) -> Floats:
    """Return places in the plane, (p, 2) [mm], whose angles are nearly those on the surface.

    Source: B. Levy et al., "Least Squares Conformal Maps", 2002. Two points far from each other are held.
    """
    first = int(np.linalg.norm(places - places.mean(axis=0), axis=1).argmax())
    away = np.linalg.norm(places - places[first], axis=1)
    second = int(away.argmax())
    gx, gy = slopes.slopes[..., 0], slopes.slopes[..., 1]
    same = gx[:, :, None] * gx[:, None] + gy[:, :, None] * gy[:, None]
    turn = gy[:, :, None] * gx[:, None] - gx[:, :, None] * gy[:, None]
    parts = np.empty((len(faces), 3, 2, 3, 2))
    parts[:, :, 0, :, 0] = parts[:, :, 1, :, 1] = same * slopes.areas[:, None, None]
    parts[:, :, 0, :, 1] = turn * slopes.areas[:, None, None]
    parts[:, :, 1, :, 0] = -parts[:, :, 0, :, 1]
    held = np.array([2 * first, 2 * first + 1, 2 * second, 2 * second + 1])
    flat = np.zeros(2 * len(places))
    flat[2 * second] = away[second]
    rows = (2 * faces[:, :, None] + np.arange(2)).reshape(-1, 6)
    blocks = parts.reshape(-1, 6, 6)
    pull = _gathered(rows, np.einsum("mij,mj->mi", blocks, flat[rows]), len(flat))
    is_held = np.zeros(len(flat), dtype=bool)
    is_held[held] = True
    blocks[is_held[rows]] = 0.0
    blocks.transpose(0, 2, 1)[is_held[rows]] = 0.0
    band = PlaneBand.of(faces, len(places), 2)
    lower = band.lower(blocks)
    lower[band.diagonal[held]] = 1.0
    pull[held] = -flat[held]
    flat = band.factor(lower)(-pull)
    return np.asarray(flat.reshape(-1, 2))


def jacobians(flat: Floats, faces: Faces, slopes: TriangleSlopes) -> Floats:
    """Return the gradients of plane coordinates ``flat`` (p, 2) in the frames of triangles, (m, 2, 2)."""
    return np.asarray(flat[faces].transpose(0, 2, 1) @ slopes.slopes)


def rotations(jacobian: Floats) -> tuple[Floats, Floats]:
    """Return cosine and sine of the nearest rotations of ``jacobian`` (m, 2, 2), each (m,)."""
    cosine = jacobian[:, 0, 0] + jacobian[:, 1, 1]
    sine = jacobian[:, 1, 0] - jacobian[:, 0, 1]
    length = np.maximum(np.hypot(cosine, sine), 1e-12)
    return cosine / length, sine / length


def rigid_map(faces: Faces, slopes: TriangleSlopes, flat: Floats, turns: int = _RIGID_TURNS) -> Floats:
    """Return places in the plane near ``flat`` (p, 2) [mm], each triangle as rigid as possible.

    Source: L. Liu et al., "A Local/Global Approach to Mesh Parameterization", 2008.
    """
    scale = np.sqrt(slopes.areas.sum() / max(_plane_area(flat, faces), 1e-12))
    flat = flat * scale
    band = PlaneBand.of(faces, len(flat), 1)
    weighted = slopes.slopes * slopes.areas[:, None, None]
    blocks = weighted @ slopes.slopes.transpose(0, 2, 1)
    lower = band.lower(blocks)
    lower[band.diagonal] *= 1.0 + 1e-12
    lower[band.diagonal[0]] *= 2.0  # holds the piece in its place
    solve = band.factor(lower)
    anchor = 0.5 * lower[band.diagonal[0]] * flat[0]
    for _ in range(turns):
        cosine, sine = rotations(jacobians(flat, faces, slopes))
        turned = (
            cosine[:, None] * weighted[..., 0] - sine[:, None] * weighted[..., 1],
            sine[:, None] * weighted[..., 0] + cosine[:, None] * weighted[..., 1],
        )
        pull = np.stack([_gathered(faces, each, len(flat)) for each in turned], axis=1)
        pull[0] += anchor
        flat = solve(pull)
    return flat


def _gathered(rows: Indices, values: Floats, count: int) -> Floats:
    """Return the sum of ``values`` at each of the ``rows``, (count,)."""
    return np.bincount(rows.ravel(), values.ravel(), count).astype(np.float64, copy=False)


def _plane_area(flat: Floats, faces: Faces) -> float:
    a, b, c = (flat[faces[:, k]] for k in range(3))
    return float(0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]).sum())
