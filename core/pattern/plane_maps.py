"""Maps of a curved surface into the plane: slopes in triangles, band storage, conformal and rigid maps."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy import sparse
from scipy.sparse.csgraph import reverse_cuthill_mckee

from core.geometry.mesh import Faces, Floats, Indices, Points, half_edges
from core.mechanics.banded_matrix import Band, Solve

_FLAT = 1e-8
"""The least area of a triangle in parts of its longest side squared [1]: a thread has no slopes."""

Numbers = npt.NDArray[Any]
"""Real or complex numbers; places in the plane, x + iy [mm]."""

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
        both = np.concatenate([sides, sides[:, ::-1]]).T
        graph = sparse.csr_array((np.ones(2 * len(sides)), both), (count, count))
        place = np.empty(count, dtype=np.int64)
        place[reverse_cuthill_mckee(graph, symmetric_mode=True)] = np.arange(count)
        reach = axes * int(np.abs(place[sides[:, 0]] - place[sides[:, 1]]).max()) + axes - 1
        whole = axes * place[:, None] + np.arange(axes)
        corners = whole[faces].reshape(len(faces), 3 * axes)
        row, column = corners[:, :, None], corners[:, None, :]
        below = np.flatnonzero(row >= column)
        at = (column * (reach + 1) + row - column).ravel()[below]
        return cls(Band(whole.ravel(), reach), at, below)

    def lower(self, blocks: Numbers) -> Numbers:
        """Return the lower band of the sum of ``blocks``."""
        return _gathered(self.at, blocks.ravel()[self.below], self.band.size * (self.band.reach + 1))

    @cached_property
    def diagonal(self) -> Indices:
        """Return where the diagonal lies in the lower band, by coordinate."""
        return np.asarray(self.band.place * (self.band.reach + 1))

    def factor(self, lower: Numbers) -> Solve:
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


def conformal_map(places: Points, faces: Faces, slopes: TriangleSlopes, band: PlaneBand) -> Floats:
    """Return places in the plane, (p, 2) [mm], whose angles are nearly those on the surface.

    ``band`` has one axis. Source: B. Levy et al., "Least Squares Conformal Maps", 2002, in complex numbers.
    Two points far from each other are held.
    """
    first = int(np.linalg.norm(places - places.mean(axis=0), axis=1).argmax())
    away = np.linalg.norm(places - places[first], axis=1)
    held = np.array([first, int(away.argmax())])
    hats = slopes.slopes[..., 0] + 1j * slopes.slopes[..., 1]
    blocks = slopes.areas[:, None, None] * hats.conj()[:, :, None] * hats[:, None]
    flat = np.zeros(len(places), dtype=np.complex128)
    flat[held[1]] = away[held[1]]
    pull = _gathered(faces, np.einsum("mij,mj->mi", blocks, flat[faces]), len(flat))
    is_held = np.zeros(len(flat), dtype=bool)
    is_held[held] = True
    blocks[is_held[faces]] = 0.0
    blocks.transpose(0, 2, 1)[is_held[faces]] = 0.0
    lower = band.lower(blocks)
    lower[band.diagonal[held]] = 1.0
    pull[held] = -flat[held]
    return _plane(band.factor(lower)(-pull))


def jacobians(flat: Floats, faces: Faces, slopes: TriangleSlopes) -> Floats:
    """Return the gradients of plane coordinates ``flat`` (p, 2) in the frames of triangles, (m, 2, 2)."""
    return np.asarray(flat[faces].transpose(0, 2, 1) @ slopes.slopes)


def rotations(jacobian: Floats) -> tuple[Floats, Floats]:
    """Return cosine and sine of the nearest rotations of ``jacobian`` (m, 2, 2), each (m,)."""
    cosine = jacobian[:, 0, 0] + jacobian[:, 1, 1]
    sine = jacobian[:, 1, 0] - jacobian[:, 0, 1]
    length = np.maximum(np.hypot(cosine, sine), 1e-12)
    return cosine / length, sine / length


def rigid_map(
    faces: Faces, slopes: TriangleSlopes, flat: Floats, band: PlaneBand, turns: int = _RIGID_TURNS
) -> Floats:
    """Return places in the plane near ``flat`` (p, 2) [mm], each triangle as rigid as possible.

    ``band`` has one axis. Source: L. Liu et al., "A Local/Global Approach to Mesh Parameterization", 2008.
    """
    flat = flat * np.sqrt(slopes.areas.sum() / max(_plane_area(flat, faces), 1e-12))
    weighted = slopes.slopes * slopes.areas[:, None, None]
    lower = band.lower(weighted @ slopes.slopes.transpose(0, 2, 1))
    lower[band.diagonal] *= 1.0 + 1e-12
    lower[band.diagonal[0]] *= 2.0  # holds the piece in its place
    solve = band.factor(lower)
    anchor = 0.5 * lower[band.diagonal[0]] * flat[0]
    # In complex numbers the nearest rotation has the direction of the sum of slopes times places.
    corners, shape = (faces.ravel(), np.arange(0, faces.size + 1, 3)), (len(faces), len(flat))
    hats, pulls = (slopes.slopes[..., 0] - 1j * slopes.slopes[..., 1], weighted @ np.array([1.0, 1j]))
    turning = sparse.csr_array((hats.ravel(), *corners), shape=shape)
    gathering = sparse.csr_array((pulls.ravel(), *corners), shape=shape).T
    for _ in range(turns):
        turned: Numbers = np.asarray(turning @ _complex(flat))
        pull = _plane(np.asarray(gathering @ (turned / np.maximum(np.abs(turned), 1e-12))))
        pull[0] += anchor
        flat = solve(pull)
    return flat


def _complex(flat: Floats) -> Numbers:
    return np.asarray(np.ascontiguousarray(flat).view(np.complex128)[:, 0])


def _plane(places: Numbers) -> Floats:
    return np.asarray(places.view(np.float64).reshape(-1, 2))


def _gathered(rows: Indices, values: Numbers, count: int) -> Numbers:
    """Return the sum of ``values`` at each of the ``rows``, (count,)."""
    rows, values = rows.ravel(), values.ravel()
    if np.iscomplexobj(values):
        return np.asarray(_gathered(rows, values.real, count) + 1j * _gathered(rows, values.imag, count))
    return np.bincount(rows, values, count).astype(np.float64, copy=False)


def _plane_area(flat: Floats, faces: Faces) -> float:
    a, b, c = (flat[faces[:, k]] for k in range(3))
    return float(0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]).sum())
