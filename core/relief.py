"""Where the breasts stand out of the trunk: the crease under them, their poles, and the nipples on them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import LinearNDInterpolator
from scipy.ndimage import correlate, gaussian_filter, maximum_filter, maximum_filter1d, uniform_filter1d
from scipy.spatial import ConvexHull

from core.errors import LandmarkError
from core.mesh import Floats, Indices, Mesh, Points, unit
from core.trunk import Survey

CELL = 5.0
"""Cell of the reach map across the body [mm]."""

SIDES = (1.0, -1.0)
"""Sign of x of the left and of the right side."""


@dataclass(frozen=True, eq=False)
class Anchor:
    """The crease under both breasts, coarsely: ``z`` lies some 10-20 mm under the fold [mm].

    ``kink`` is how far the body comes forward above it on the weaker side, and ``middle_kink`` on the centre
    line [mm]; ``half_width`` is that of the trunk [mm].
    """

    z: float
    kink: float
    middle_kink: float
    half_width: float


def reach_map(survey: Survey, half_width: float) -> tuple[Floats, Floats]:
    """Return how far the trunk reaches forward, shape (levels, columns) [mm], and x of the columns.

    NaN where there is no front. Smoothed by 8 mm.
    """
    columns = np.arange(-np.ceil(half_width / CELL), np.ceil(half_width / CELL) + 1) * CELL
    row, p = survey.row, survey.samples
    middle, depth = 0.5 * (survey.front + survey.back), survey.back - survey.front
    column = np.rint((p[:, 0] - survey.middle - columns[0]) / CELL).astype(np.int64)
    front = (p[:, 1] < (middle - 0.05 * depth)[row]) & (column >= 0) & (column < len(columns))
    reach = np.full((len(survey.z), len(columns)), -np.inf)
    np.maximum.at(reach, (row[front], column[front]), -p[front, 1])
    return _smoothed(reach, (8.0 / survey.step, 8.0 / CELL)), columns


def _smoothed(grid: Floats, sigma: tuple[float, float]) -> Floats:
    known = np.isfinite(grid)
    weight = gaussian_filter(known.astype(float), sigma, mode="nearest")
    value = gaussian_filter(np.where(known, grid, 0.0), sigma, mode="nearest")
    return np.asarray(np.where(weight > 0.2, value / np.maximum(weight, 0.2), np.nan))


def find_anchor(survey: Survey) -> Anchor:
    """Return the level where the body kinks forward on both sides and not in the middle.

    Raises LandmarkError if there is no trunk or no such level. Source: ours.
    """
    half_width, usable = survey.trunk()
    reach, x = reach_map(survey, half_width)
    up = round(30.0 / survey.step)
    kink = np.full_like(reach, np.nan)
    kink[up:-up] = reach[2 * up :] - reach[up:-up] - np.maximum(0.0, reach[: -2 * up] - reach[up:-up])
    calm = uniform_filter1d(
        np.where(np.isnan(kink), -100.0, kink), round(20.0 / CELL), axis=1, mode="nearest"
    )
    lateral = (np.abs(x) > 0.28 * half_width) & (np.abs(x) < 0.85 * half_width)
    wide = round(24.0 / survey.step) | 1
    sides = [maximum_filter1d(calm[:, lateral & (s * x > 0)].max(axis=1), wide) for s in SIDES]
    both = np.minimum(*sides)
    middle = np.where(np.isnan(kink), -100.0, kink)[:, np.abs(x) < 0.12 * half_width].max(axis=1)
    value = np.where(usable, both - 0.8 * np.clip(middle, 0.0, 40.0), -np.inf)
    best = int(np.argmax(value))
    return Anchor(float(survey.z[best]), float(both[best]), float(middle[best]), half_width)


@dataclass(frozen=True, eq=False)
class Pole:
    """The point of one breast that stands out most from the trunk under it, shape (3,) [mm].

    ``prominence`` is how far [mm]; ``inside`` is False if the search ended at its border.
    """

    position: Points
    prominence: float
    inside: bool


def find_poles(survey: Survey, anchor: Anchor) -> tuple[Pole, Pole]:
    """Return the poles of the left and the right breast.

    Prominence is measured from the convex outline of the trunk under the breasts, after the body has been
    narrowed to the width of the back there. Raises LandmarkError without a chest. Source: ours.
    """
    near = (survey.samples[:, 2] > anchor.z - 25.0) & (survey.samples[:, 2] < anchor.z + 130.0)
    p, row = survey.samples[near], survey.row[near]
    x = p[:, 0] - survey.middle
    depth = 0.5 * (survey.front + survey.back)[row] - p[:, 1]
    under = (survey.z > anchor.z - 45.0) & (survey.z < anchor.z - 10.0) & (survey.tape > 0.0)
    if not under.any() or survey.z[0] > anchor.z - 12.0:
        raise LandmarkError(
            "The trunk under the breasts is missing.", "Open a scan that shows the whole trunk."
        )
    width = float(np.median(survey.half_width[under]))
    window = (depth > 0.0) & (np.abs(x) > 0.17 * width) & (np.abs(x) < max(1.25 * width, width + 35.0))
    azimuth = np.degrees(np.arctan2(np.abs(x), depth))
    prominence = _prominence(survey, anchor, p, row)
    left, right = (
        _pole(p[part], azimuth[part], prominence[part], anchor)
        for part in (window & (s * x > 0.0) for s in SIDES)
    )
    return left, right


def _prominence(survey: Survey, anchor: Anchor, p: Points, row: Indices) -> Floats:
    base = survey.level_at(anchor.z - 12.0)
    hull = ConvexHull(survey.samples[survey.row == base][:, :2]).equations
    back = survey.back_width()
    shrink = np.clip(back[base] / back, 0.7, 1.0)[row]
    flat = np.column_stack([survey.middle + (p[:, 0] - survey.middle) * shrink, p[:, 1]])
    return np.asarray((flat @ hull[:, :2].T + hull[:, 2]).max(axis=1))


def _pole(p: Points, azimuth: Floats, prominence: Floats, anchor: Anchor) -> Pole:
    """Find the pole among the points of one side: the highest summit over azimuth and height, centred."""
    if len(p) < 200:
        raise LandmarkError("The front of the chest is missing.", "Open a scan that shows the whole bust.")
    high = p[:, 2] - anchor.z
    score = prominence - 0.6 * (np.maximum(azimuth - 52.0, 0.0) + np.maximum(18.0 - azimuth, 0.0))
    score -= 0.15 * np.maximum(high - 85.0, 0.0)
    cells = (np.floor((high + 25.0) / 5.0).astype(np.int64), np.floor(azimuth / 3.0).astype(np.int64))
    grid = np.full((31, 30), -np.inf)
    np.maximum.at(grid, cells, score)
    grid = _smoothed(grid, (1.2, 0.9))
    grid = np.where(np.isnan(grid), -np.inf, grid)
    summit = grid == maximum_filter(grid, (9, 7), mode="nearest")
    inner = summit[cells] & (azimuth < 66.0) & (high < 122.0)
    allowed = inner if inner.any() else (azimuth < 60.0) & (high < 100.0)
    top = p[np.argmax(np.where(allowed, grid[cells], -np.inf))]
    near = np.flatnonzero(((p - top) ** 2).sum(axis=1) < 25.0**2)
    best = near[np.argsort(prominence[near])[-len(near) // 2 :]]
    return Pole(p[best].mean(axis=0), float(prominence[best].mean()), bool(inner.any()))


NEAR = 24.0
"""A nipple is looked for so far from the pole [mm]."""

GRID = 2.0
"""Cell of the height map [mm]."""

RING = (9.0, 22.0)
"""Inner and outer radius of the ring that a relief is measured against [mm]."""


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
        """The surface point at the pole, shape (3,) [mm]."""
        return np.asarray(self.points[len(self.points) // 2, len(self.points) // 2])

    def nearest(self, point: Points) -> Points:
        """Return the surface point of the grid nearest to ``point``, shape (3,) [mm]."""
        return np.asarray(self.points.reshape(-1, 3)[np.nanargmin(((self.points - point) ** 2).sum(axis=-1))])


def breast_patch(mesh: Mesh, pole: Points) -> Patch:
    """Lay a grid over the surface round ``pole``, shape (3,) [mm], and measure the relief on it."""
    near = ((mesh.vertices - pole) ** 2).sum(axis=1)
    axis = unit(mesh.vertex_normals[near < 30.0**2].sum(axis=0))
    across = unit(np.cross([0.0, 0.0, 1.0], axis))
    frame = np.stack([across, np.cross(axis, across), axis])
    reach = NEAR + RING[1] + 8.0
    seen = (near < (2.0 * reach) ** 2) & (mesh.vertex_normals @ axis > 0.1)
    local = (mesh.vertices[seen] - pole) @ frame.T
    t = np.arange(-np.ceil(reach / GRID), np.ceil(reach / GRID) + 1) * GRID
    u, v = np.meshgrid(t, t)
    height = LinearNDInterpolator(local[:, :2], local[:, 2])(u, v)
    return Patch(pole + np.stack([u, v, height], axis=-1) @ frame, np.hypot(u, v), _relief(height))


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
    basis = np.stack([np.ones_like(u), u, v, u * u, u * v, v * v], axis=1)
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

    ``relief`` is how far it stands out [mm]; ``ratio`` is that over the next best spot of the same breast;
    ``clarity`` is that over the roughness of the breast; ``offset`` is its distance from the pole [mm].
    """

    position: Points
    relief: float
    ratio: float
    clarity: float
    offset: float

    @property
    def sure(self) -> bool:
        """Whether the spot stands out enough for a nipple: the farther from the pole, the more it must."""
        far = max(self.offset - 4.0, 0.0)
        return self.relief > 0.9 + 0.06 * far and self.ratio > (1.35 if far > 6.0 else 1.0)


def find_nipples(left: Patch, right: Patch) -> tuple[Nipple | None, Nipple | None]:
    """Return the spots that stand out most as a pair, near the poles and alike on both sides.

    None where nothing stands out. Source: ours.
    """
    spots = [_spots(patch) for patch in (left, right)]
    if not (spots[0] and spots[1]):
        return (spots[0][0] if spots[0] else None, spots[1][0] if spots[1] else None)
    mirror = np.array([-1.0, 1.0, 1.0])

    def worth(a: Nipple, b: Nipple) -> float:
        apart = float(np.linalg.norm((a.position - left.centre) - mirror * (b.position - right.centre)))
        return _worth(a) + _worth(b) - 0.5 * (max(apart - 6.0, 0.0) / 9.0) ** 2

    return max(((a, b) for a in spots[0] for b in spots[1]), key=lambda pair: worth(*pair))


def _worth(spot: Nipple) -> float:
    rough = max(spot.relief / spot.clarity, 0.3)
    return min(spot.relief, 3.0) / rough - 0.5 * (max(spot.offset - 4.0, 0.0) / 8.0) ** 2


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
        spots.append(
            Nipple(_centre(patch, row, column), top, ratio, top / rough, patch.distance[row, column])
        )
    return sorted(spots, key=_worth, reverse=True)


def _centre(patch: Patch, row: int, column: int) -> Points:
    """Return the centre of the upper half of a summit, on the surface, shape (3,) [mm]."""
    rows, columns = np.indices(patch.relief.shape)
    close = np.hypot(rows - row, columns - column) * GRID <= 9.0
    weight = np.where(
        close, np.maximum(np.nan_to_num(patch.relief) - 0.5 * patch.relief[row, column], 0.0), 0.0
    )
    return np.asarray(np.average(patch.points[weight > 0.0], axis=0, weights=weight[weight > 0.0]))
