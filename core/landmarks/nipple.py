"""The surface of one breast seen from in front of it, and what stands out of it in small."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.ndimage import binary_dilation, correlate, label, maximum_filter
from scipy.sparse.linalg import spsolve
from scipy.spatial import Delaunay, QhullError

from core.errors import LandmarkError
from core.geometry.mesh import Flags, Floats, Mesh, Points, quadric_terms, unit
from core.landmarks.anchor import smoothed
from core.landmarks.chest import Pole
from core.messages import Message

GRID = 2.0
"""Cell of the height map [mm]."""

RING = (9.0, 22.0)
"""Inner and outer radius of the ring that a relief is measured against [mm]."""

WIDE = 24.0
"""So far from the pole [mm] a patch shows the relief, and its rings lie wholly on it."""

HIDES, BEHIND = 5.0, 20.0
"""Skin hides what lies so far behind it [mm], in cells of this edge and next to them [mm]."""

STEEP = 2.5
"""Where a breast hangs over, the height falls to the skin behind it more steeply than this [1]."""

FINER, CALM = 25.0, 3.0
"""The place that reaches furthest is taken from the patch so near to the coarse one [mm], smoothed by so many
cells."""

BUMP = 3
"""How round a bump is, is told by its relief so many cells about its summit."""


@dataclass(frozen=True, eq=False)
class BreastPatch:
    """A breast seen along the normal at its pole, over a square grid.

    ``points`` are the surface points, shape (g, g, 3) [mm]; ``distance`` is how far they lie from the pole,
    seen along the normal, shape (g, g) [mm]; ``relief`` is how far a spot stands out of the smooth surface
    round it, shape (g, g) [mm], NaN where that is unknown. ``forward`` is where the breast reaches furthest
    forward and a little outward, shape (3,) [mm]; ``side`` is 1 for the left breast and -1 for the right one.
    """

    points: Points
    distance: Floats
    relief: Floats
    forward: Points
    side: float

    @property
    def centre(self) -> Points:
        """Return the surface point at the pole, shape (3,) [mm]."""
        return np.asarray(self.points[len(self.points) // 2, len(self.points) // 2])

    def nearest(self, point: Points) -> Points:
        """Return the surface point of the grid nearest to ``point``, shape (3,) [mm]."""
        return np.asarray(self.points.reshape(-1, 3)[np.nanargmin(((self.points - point) ** 2).sum(axis=-1))])

    def project(self, place: Points) -> Points:
        """Return the surface point nearest to ``place``, between the grid's points too, shape (3,) [mm]."""
        away = ((self.points - place) ** 2).sum(axis=-1)
        row, column = divmod(int(np.nanargmin(away)), away.shape[1])
        at = self.points[row, column]
        tangents = np.stack([self._slope(row, column, 0), self._slope(row, column, 1)], axis=1)
        if not np.isfinite(tangents).all():
            return np.asarray(at)
        share = np.linalg.lstsq(tangents, place - at, rcond=None)[0]
        return np.asarray(at + tangents @ np.clip(share, -1.0, 1.0))

    def _slope(self, row: int, column: int, axis: int) -> Points:
        """Return the step of the surface from one point of the grid to the next along an axis, (3,) [mm]."""
        line = self.points[:, column] if axis == 0 else self.points[row]
        at = row if axis == 0 else column
        low, high = max(at - 1, 0), min(at + 1, len(line) - 1)
        return np.asarray((line[high] - line[low]) / (high - low))

    def normal(self, row: int, column: int, cells: int) -> Points:
        """Return which way the surface looks at a cell, over so many cells to each side, unit, shape (3,)."""
        last = len(self.points) - 1
        low, high = (np.clip([row + k, column + k], 0, last) for k in (-cells, cells))
        across = self.points[row, high[1]] - self.points[row, low[1]]
        along = self.points[high[0], column] - self.points[low[0], column]
        return unit(np.cross(across, along))

    def roundness(self, row: int, column: int) -> float:
        """Return how round the bump at a cell is: 1 for a spot, 0 for an edge.

        The less of its two principal curvatures over the greater; 0 too where they are unknown.
        """
        near = self.relief[row - BUMP : row + BUMP + 1 : BUMP, column - BUMP : column + BUMP + 1 : BUMP]
        if near.shape != (3, 3) or np.isnan(near).any():
            return 0.0
        twice = near[1, 1] * 2.0
        mixed = 0.25 * (near[2, 2] + near[0, 0] - near[0, 2] - near[2, 0])
        bends = ((near[2, 1] + near[0, 1] - twice, mixed), (mixed, near[1, 2] + near[1, 0] - twice))
        most, least = np.linalg.eigvalsh(np.array(bends))
        return float(max(least / most, 0.0)) if most < 0.0 else 0.0

    def ring(self, place: Points, radius: float) -> Points:
        """Return a closed curve on the surface round ``place``, ``radius`` [mm] off, shape (k, 3) [mm]."""
        t = np.linspace(0.0, 2.0 * np.pi, 37)
        size = len(self.points) - 1
        at = np.unravel_index(np.nanargmin(((self.points - place) ** 2).sum(axis=-1)), self.distance.shape)
        rows, columns = (
            np.clip(np.rint(k + radius / GRID * wave(t)).astype(int), 0, size)
            for k, wave in zip(at, (np.sin, np.cos), strict=True)
        )
        ring = self.points[rows, columns]
        return np.asarray(ring[np.isfinite(ring).all(axis=1)])


def breast_patch(mesh: Mesh, pole: Pole) -> BreastPatch:
    """Sample the surface around the ``pole`` of a breast on a grid, and measure the relief on it.

    Raises LandmarkError if there is no surface.
    """
    near = ((mesh.vertices - pole.position) ** 2).sum(axis=1)
    axis = unit(mesh.vertex_normals[near < 30.0**2].sum(axis=0))
    across = unit(np.cross([0.0, 0.0, 1.0], axis))
    frame = np.stack([across, np.cross(axis, across), axis])
    reach = WIDE + RING[1] + 8.0
    seen = (near < (2.0 * reach) ** 2) & (mesh.vertex_normals @ axis > 0.1)
    local = (mesh.vertices[seen] - pole.position) @ frame.T
    local = in_front(local[(np.abs(local[:, :2]) < reach + 10.0).all(axis=1)])
    t = np.arange(-np.ceil(reach / GRID), np.ceil(reach / GRID) + 1) * GRID
    u, v = np.meshgrid(t, t)
    height = _height(local, np.stack([u, v], axis=-1))
    if not np.isfinite(height).any():
        raise LandmarkError(
            Message("The surface of a breast is missing, or its points are too sparse."),
            Message("Open a scan that includes the whole bust."),
        )
    own = _hanging_together(height)
    points = pole.position + np.stack([u, v, np.where(own, height, np.nan)], axis=-1) @ frame
    relief = np.where(own, _relief(_carried_on(height, own)), np.nan)
    return BreastPatch(points, np.hypot(u, v), relief, _furthest(points, pole), pole.side)


def in_front(surface: Points) -> Points:
    """Return the points of ``surface``, shape (n, 3) [mm], that no other sheet of the skin hides."""
    if not len(surface):
        return surface
    row, column = np.floor((surface[:, :2] - surface[:, :2].min(axis=0)) / HIDES).astype(np.int64).T
    front = np.full((row.max() + 1, column.max() + 1), -np.inf)
    np.maximum.at(front, (row, column), surface[:, 2])
    return np.asarray(surface[surface[:, 2] > maximum_filter(front, 3)[row, column] - BEHIND])


def _hanging_together(height: Floats) -> Flags:
    """Return which cells of a height map belong to the breast in its middle: no steep step lies between."""
    slope = np.hypot(*np.gradient(np.nan_to_num(height, nan=0.0), GRID))
    pieces, _ = label(slope < STEEP)
    middle = len(height) // 2
    own = pieces == pieces[middle, middle]
    if not pieces[middle, middle]:
        return np.ones(height.shape, dtype=bool)
    return np.asarray(binary_dilation(own) | np.isnan(height))


def _carried_on(height: Floats, own: Flags) -> Floats:
    """Return a height map that goes on over cells that are not its ``own``, bent as little as can be."""
    beyond = ~own
    if not beyond.any():
        return height
    size = len(height)
    line = sparse.diags_array([1.0, -2.0, 1.0], offsets=[0, 1, 2], shape=(size - 2, size))
    whole = sparse.eye_array(size)
    bends = sparse.vstack([sparse.kron(line, whole), sparse.kron(whole, line)]).tocsc()
    free = np.flatnonzero(beyond)
    known = np.where(beyond, 0.0, np.nan_to_num(height)).ravel()
    part = bends[:, free]
    known[free] = spsolve(part.T @ part, -(part.T @ (bends @ known)))
    return np.asarray(np.where(np.isnan(height), np.nan, known.reshape(height.shape)))


def _furthest(points: Points, pole: Pole) -> Points:
    """Return the point of a grid that reaches furthest, near where the breast does, shape (3,) [mm]."""
    calm = smoothed(np.nan_to_num(points @ pole.outward, nan=-np.inf), (CALM, CALM))
    near = ((points - pole.forward) ** 2).sum(axis=-1) < FINER**2
    near &= np.isfinite(calm) & np.isfinite(points[..., 0])
    return np.asarray(
        points[np.unravel_index(np.argmax(np.where(near, calm, -np.inf)), near.shape)]
        if near.any()
        else pole.forward
    )


def _height(surface: Points, places: Points) -> Floats:
    """Return the third coordinate of ``surface``, shape (n, 3), over ``places``, (..., 2); NaN beside it."""
    try:
        flat = Delaunay(surface[:, :2])
    except (QhullError, ValueError):  # fewer than three points, or all on a line
        return np.full(places.shape[:-1], np.nan)
    at = flat.find_simplex(places)
    form, start = flat.transform[at, :2], flat.transform[at, 2]
    share = np.einsum("...ij,...j->...i", form, places - start)
    share = np.concatenate([share, 1.0 - share.sum(axis=-1, keepdims=True)], axis=-1)
    height = (share * surface[flat.simplices[at], 2]).sum(axis=-1)
    return np.asarray(np.where(at >= 0, height, np.nan))


def _relief(height: Floats) -> Floats:
    spot, slope_u, slope_v = relief_kernels(GRID)
    known = np.nan_to_num(height)
    steep = [correlate(known, kernel, mode="constant") for kernel in (slope_u, slope_v)]
    relief = correlate(known, spot, mode="constant") / np.sqrt(1.0 + steep[0] ** 2 + steep[1] ** 2)
    hole = maximum_filter(np.isnan(height), len(spot), mode="constant", cval=1)
    return np.asarray(np.where(hole, np.nan, relief))


def relief_kernels(cell: float, core: float = 3.0, ring: tuple[float, float] = RING) -> tuple[Floats, ...]:
    """Return weights over a height map that compare a spot with the quadric through the ring round it.

    The first gives the mean height of the spot (Gaussian of width ``core`` [mm]) over the quadric: zero for
    any quadric surface. The other two give the slope of the quadric. Source: ours.
    """
    reach = int(ring[1] // cell)
    t = np.arange(-reach, reach + 1) * cell
    u, v = (a.ravel() for a in np.meshgrid(t, t))
    r = np.hypot(u, v)
    basis = quadric_terms(u, v)
    on_ring = (r >= ring[0]) & (r <= ring[1])
    fit = np.zeros((6, len(u)))
    fit[:, on_ring] = np.linalg.pinv(basis[on_ring])
    spot = np.exp(-0.5 * (r / core) ** 2) * (r < 3.0 * core)
    spot /= spot.sum()
    shape = (len(t), len(t))
    return tuple(kernel.reshape(shape) for kernel in (spot - (spot @ basis) @ fit, fit[1], fit[2]))
