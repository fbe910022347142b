"""The surface of one breast seen from in front of it: what stands out of it in small, and the nipples."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import correlate, maximum_filter
from scipy.spatial import Delaunay, QhullError

from core.errors import LandmarkError
from core.mesh import MIRROR, Floats, Mesh, Points, quadric_terms, unit

NEAR = 24.0
"""A nipple is looked for so far from the pole [mm]."""

GRID = 2.0
"""Cell of the height map [mm]."""

RING = (9.0, 22.0)
"""Inner and outer radius of the ring that a relief is measured against [mm]."""


AT_POLE, ABOUT = 4.0, 8.0
"""Nipples lie so near to the pole as a rule [mm]; each ``ABOUT`` [mm] further off makes one less likely."""

LEAST, FARTHER = 0.9, 0.06
"""A nipple stands out by more than this [mm], off the pole by so much more for each mm."""

OFF_POLE, RIVALLED = 6.0, 1.35
"""More than this beyond ``AT_POLE`` [mm] it stands out so many times as much as the next best spot."""

UNLIKE, APART = 6.0, 9.0
"""A pair may lie so unlike on their breasts [mm]; each ``APART`` [mm] more makes it less likely."""


@dataclass(frozen=True, eq=False)
class Patch:
    """A breast seen along the normal at its pole, over a square grid.

    ``points`` are the surface points, shape (g, g, 3) [mm]; ``distance`` is how far they lie from the pole,
    seen along the normal, shape (g, g) [mm]; ``relief`` is how far a spot stands out of the smooth surface
    round it, shape (g, g) [mm], NaN where that is unknown.
    """

    points: Points
    distance: Floats
    relief: Floats

    @property
    def centre(self) -> Points:
        """The surface point at the pole, or nearest to it, shape (3,) [mm]."""
        shown = np.isfinite(self.points).all(axis=-1)
        return np.asarray(self.points.reshape(-1, 3)[np.argmin(np.where(shown, self.distance, np.inf))])

    def nearest(self, point: Points) -> Points:
        """Return the surface point of the grid nearest to ``point``, shape (3,) [mm]."""
        return np.asarray(self.points.reshape(-1, 3)[np.nanargmin(((self.points - point) ** 2).sum(axis=-1))])

    def onto(self, place: Points) -> Points:
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


def breast_patch(mesh: Mesh, pole: Points) -> Patch:
    """Lay a grid over the surface round ``pole``, shape (3,) [mm], and measure the relief on it.

    Raises LandmarkError if there is no surface.
    """
    near = ((mesh.vertices - pole) ** 2).sum(axis=1)
    axis = unit(mesh.vertex_normals[near < 30.0**2].sum(axis=0))
    across = unit(np.cross([0.0, 0.0, 1.0], axis))
    frame = np.stack([across, np.cross(axis, across), axis])
    reach = NEAR + RING[1] + 8.0
    seen = (near < (2.0 * reach) ** 2) & (mesh.vertex_normals @ axis > 0.1)
    local = (mesh.vertices[seen] - pole) @ frame.T
    local = local[(np.abs(local[:, :2]) < reach + 10.0).all(axis=1)]
    t = np.arange(-np.ceil(reach / GRID), np.ceil(reach / GRID) + 1) * GRID
    u, v = np.meshgrid(t, t)
    height = _height(local, np.stack([u, v], axis=-1))
    if not np.isfinite(height).any():
        raise LandmarkError(
            "The skin of a breast is missing, or its points are too far apart.",
            "Open a scan that shows the whole bust.",
        )
    return Patch(pole + np.stack([u, v, height], axis=-1) @ frame, np.hypot(u, v), _relief(height))


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


@dataclass(frozen=True, eq=False)
class Nipple:
    """A spot that stands out of the breast: its centre, shape (3,) [mm], and how clearly.

    ``way`` leads to it from the pole, shape (3,) [mm], and ``offset`` is its length seen along the normal
    there [mm]; ``relief`` is how far it stands out [mm]; ``ratio`` is that over the next best spot of the
    same breast; ``clarity`` is that over the roughness of the breast. How sure a spot is of its looks is our
    judgement: its weights were not measured.
    """

    position: Points
    way: Points
    relief: float
    ratio: float
    clarity: float
    offset: float

    @property
    def sure(self) -> bool:
        """Whether the spot stands out enough for a nipple: the farther from the pole, the more it must."""
        far = max(self.offset - AT_POLE, 0.0)
        return self.relief > LEAST + FARTHER * far and self.ratio > (RIVALLED if far > OFF_POLE else 1.0)

    @property
    def clear(self) -> float:
        """How sure (0..1) it is by its looks alone: clear of the roughness and of others, near the pole."""
        single = float(np.clip((self.ratio - 0.9) / 1.2, 0.0, 1.0)) * min(self.clarity / 2.0, 1.0)
        clear = 0.6 * min(self.clarity / 6.0, 1.0) + 0.4 * single
        return clear * float(np.exp(-max(self.offset - 8.0, 0.0) / 15.0))

    @property
    def alone(self) -> float:
        """How sure (0..1) it is without a partner: all else that stands out may lie anywhere."""
        return 0.8 * self.clear * float(np.exp(-max(self.offset - AT_POLE, 0.0) / ABOUT))

    def apart(self, other: Nipple, middle: float) -> float:
        """Return how far it lies from the mirror image of that of the other breast [mm].

        The less of two: pole laid over pole, as breasts differ, or at the ``middle`` of the body, x [mm].
        """
        across = self.position - MIRROR * other.position - (2.0 * middle, 0.0, 0.0)
        return float(min(np.linalg.norm(self.way - MIRROR * other.way), np.linalg.norm(across)))


def find_nipples(left: Patch, right: Patch, middle: float) -> tuple[Nipple | None, Nipple | None]:
    """Return the spots that stand out most as a pair, near the poles and alike on both sides.

    ``middle`` is x of the middle of the body [mm]. None where nothing stands out. Source: ours.
    """
    spots = [_spots(patch) for patch in (left, right)]
    if not (spots[0] and spots[1]):
        return (spots[0][0] if spots[0] else None, spots[1][0] if spots[1] else None)

    def worth(a: Nipple, b: Nipple) -> float:
        return _worth(a) + _worth(b) - 0.5 * (max(a.apart(b, middle) - UNLIKE, 0.0) / APART) ** 2

    return max(((a, b) for a in spots[0] for b in spots[1]), key=lambda pair: worth(*pair))


def _worth(spot: Nipple) -> float:
    """Return how clear a spot is for its place [1]: beyond 3 mm more relief makes no better nipple."""
    rough = max(spot.relief / spot.clarity, 0.3)
    return min(spot.relief, 3.0) / rough - 0.5 * (max(spot.offset - AT_POLE, 0.0) / ABOUT) ** 2


def _spots(patch: Patch) -> list[Nipple]:
    """Return the summits of the relief near the pole, at least 14 mm apart, the best first."""
    r = np.where(np.isnan(patch.relief), -np.inf, patch.relief)
    summits = (r == maximum_filter(r, 2 * round(14.0 / GRID) + 1)) & (patch.distance < NEAR) & (r > 0.0)
    near = r[(patch.distance < NEAR) & np.isfinite(r)]
    rough = 1.48 * float(np.median(np.abs(near - np.median(near)))) + 0.12 if len(near) else np.inf
    spots = []
    for row, column in np.argwhere(summits):
        others = summits.copy()
        others[row, column] = False
        top = r[row, column]
        ratio = top / max(r[others].max(initial=0.0), 0.1)
        place = _centre(patch, row, column)
        way, offset = place - patch.centre, patch.distance[row, column]
        spots.append(Nipple(place, way, top, ratio, top / rough, offset))
    return sorted(spots, key=_worth, reverse=True)


def _centre(patch: Patch, row: int, column: int) -> Points:
    """Return the centre of the upper half of a summit, on the surface, shape (3,) [mm]."""
    rows, columns = np.indices(patch.relief.shape)
    close = np.hypot(rows - row, columns - column) * GRID <= 9.0
    weight = np.where(
        close, np.maximum(np.nan_to_num(patch.relief) - 0.5 * patch.relief[row, column], 0.0), 0.0
    )
    return np.asarray(np.average(patch.points[weight > 0.0], axis=0, weights=weight[weight > 0.0]))
