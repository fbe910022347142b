"""The outline of a trunk: how wide and deep it is at each level, and how far its front and back stand out."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.ndimage import gaussian_filter, label, mean

from core.geometry.mesh import Flags, Floats, Indices, Points

TYPICAL_GIRTH = 860.0
"""A trunk girth [mm] that makes file units into mm well enough to tell up from down."""

STEP = 1.4
"""Distance of the levels and of the columns of the reach [grains]."""

GAP = 3
"""Air between trunk and arm is at least this wide [grains]."""

SUNK = 0.25
"""A level whose middle lies deeper than this share of its depth, in front and at the back, is two legs."""

SLIM = 0.25
"""A level slimmer than this share of most of the skin [1] is no body: a neck is wider, a pole is not."""

NECK, BASE = 0.35, 0.8
"""What is slimmer than the one, over what is wider than the other, is a stand: no head is that wide [1]."""

POLE = 40.0
"""A pole shows at least this much of its length [mm of a typical trunk]; torn rings of skin are lower."""

MERGED = 1.3
"""Arms that lie beside a level of the trunk and are one with it at the next make that wider by this [1]."""

BESIDE = 5
"""Arms lie beside the trunk at so many levels in a row at least; at an edge of the scan only at some."""

SECTORS = 6
"""A level with skin in all of so many directions from its middle goes round, as that of a pole does."""


@dataclass(frozen=True, eq=False)
class Silhouette:
    """A trunk, arms taken out, at k levels square to an axis and c columns across [file units].

    Shape (k,): ``z``, half ``width``, its ends in depth ``low`` and ``high``, NaN where there is no trunk;
    whether ``arms`` lie beside it, and whether there are only ``legs``. Shape (k, c): how far ``front`` and
    ``back`` stand out, NaN where nothing is. ``cell`` is the distance of levels and columns; ``own``, shape
    (n,), tells which points are trunk, or between the arms; ``closed``, shape (k,), where it goes all round.
    """

    cell: float
    z: Floats
    width: Floats
    low: Floats
    high: Floats
    arms: Flags
    legs: Flags
    front: Floats
    back: Floats
    own: Flags
    closed: Flags

    @cached_property
    def half_width(self) -> float:
        """Return half width of the trunk proper, without merged arms; NaN if there is none."""
        return self._reference(self.width)

    @cached_property
    def girth(self) -> Floats:
        """Girth of an ellipse as wide and deep as the trunk at each level, shape (k,); source: Ramanujan."""
        a, b = self.width, 0.5 * (self.high - self.low)
        return np.pi * (3.0 * (a + b) - np.sqrt((3.0 * a + b) * (a + 3.0 * b)))

    @cached_property
    def main_girth(self) -> float:
        """Return the girth of the trunk proper; NaN if there is none."""
        return self._reference(self.girth)

    @cached_property
    def mm(self) -> float:
        """Return millimetres in a file unit, if the trunk is as stout as most."""
        return TYPICAL_GIRTH / self.main_girth

    @cached_property
    def stoutness(self) -> float:
        """Return the width of the trunk proper over its depth [1]."""
        width, depth = self.width[self.proper], (self.high - self.low)[self.proper]
        return float(2.0 * np.median(width) / max(float(np.median(depth)), 1e-9 * self.half_width))

    @cached_property
    def proper(self) -> Flags:
        """Return levels that are trunk: not neck, not head, not merged with arms."""
        with np.errstate(invalid="ignore"):
            share = self.width / self.half_width
            return (share > 0.6) & (share < 1.3) & (self.girth > 0.7 * self.main_girth)

    @cached_property
    def across(self) -> Floats:
        """Return the distance of each column from the middle, shape (c,) [half widths of the trunk]."""
        count = self.front.shape[1]
        return np.asarray(np.abs(np.arange(count) - count // 2) * self.cell / self.half_width)

    @cached_property
    def height(self) -> Floats:
        """Return the height of each level over the lowest, shape (k,) [mm of a typical trunk]."""
        return np.asarray((self.z - self.z[0]) * self.mm)

    @cached_property
    def slim(self) -> Flags:
        """Return levels too slim for a body, even for its neck: a pole that it stands on, or nothing."""
        width = np.sort(self.width[np.isfinite(self.width)])
        total = np.cumsum(width)
        usual = (
            width[np.searchsorted(total, 0.5 * total[-1])] if len(width) else np.inf
        )  # by area, not height
        return ~(self.width > SLIM * usual)

    @cached_property
    def stand(self) -> float:
        """Return the level under which there is no body but the pole that it stands on; -inf without one."""
        proper = np.flatnonzero(self.proper)
        with np.errstate(invalid="ignore"):
            thin = (self.width < NECK * self.half_width) & np.logical_or.accumulate(
                self.width > BASE * self.half_width
            )
        slim = (thin | self.slim & np.isfinite(self.width))[: proper[len(proper) // 2]]
        runs, count = label(slim)
        lengths = np.bincount(runs)[1:] * self.cell * self.mm
        whole = mean(self.closed[: len(slim)], runs, np.arange(count) + 1) if count else lengths
        poles = np.flatnonzero((lengths >= POLE) & (whole > 0.5))
        if len(poles) == 0:
            return -np.inf
        return float(self.z[np.flatnonzero(runs == poles[-1] + 1)[-1]] + 0.5 * self.cell)

    def _reference(self, value: Floats) -> float:
        own = ~self.slim & ~self._merged()
        width = self.width[own]
        if len(width) == 0:
            return float("nan")
        upper = np.median(width[width >= np.median(width)])
        with np.errstate(invalid="ignore"):
            return float(np.percentile(value[own & (self.width <= 1.25 * upper)], 70))

    def _merged(self) -> Flags:
        """Tell at which levels the arms are one with the trunk: next to some where they lie beside it."""
        merged = np.zeros(len(self.z), dtype=bool)
        for way in (slice(None), slice(None, None, -1)):
            width, arms, here = self.width[way], self.arms[way], merged[way]
            for at in np.flatnonzero((width[1:] > MERGED * width[:-1]) & arms[:-1] & ~arms[1:]):
                beside = slice(at + 1 - BESIDE, at + 1)
                if at + 1 >= BESIDE and arms[beside].all():
                    slimmer = ~(width[at + 1 :] > MERGED * np.median(width[beside]))
                    here[at + 1 :] |= np.cumsum(slimmer) == 0
        return merged

    def turned(self, up: int, back: int) -> Silhouette:
        """Return the same trunk with z and depth taken along these signs (+1 or -1)."""
        low, high = (self.low, self.high) if back > 0 else (-self.high, -self.low)
        front, rear = (self.front, self.back) if back > 0 else (self.back, self.front)
        return replace(
            self,
            z=up * self.z[::up],
            width=self.width[::up],
            low=low[::up],
            high=high[::up],
            arms=self.arms[::up],
            legs=self.legs[::up],
            closed=self.closed[::up],
            front=front[::up],
            back=rear[::up],
        )


def silhouette(points: Points, grain: float) -> Silhouette | None:
    """Read the trunk off ``points``, shape (n, 3), with mirror plane x = 0 and z up; None without a trunk."""
    cell = STEP * grain
    row = np.floor((points[:, 2] - points[:, 2].min()) / cell).astype(np.int64)
    rows = int(row.max()) + 1
    z = points[:, 2].min() + (np.arange(rows) + 0.5) * cell
    own = _own(points, row, rows, grain)
    core = own & (np.abs(points[:, 0]) < 1.2 * grain)
    low, high = _ends(points[own, 1], row[own], rows)
    fore, rear = _ends(points[core, 1], row[core], rows)
    sunk = np.fmin(fore - low, high - rear)  # in a hollow, or under a hole, only one side of the middle is
    legs = ~(sunk < SUNK * (high - low))
    trunk = own & ~legs[row]
    beside = np.bincount(row[~trunk], minlength=rows) > 0
    mine, level = points[trunk], row[trunk]
    low, high = _ends(mine[:, 1], level, rows)
    left, right = _ends(mine[:, 0], level, rows)
    half = 0.5 * (right - left)
    nothing = np.empty((rows, 0))
    closed = _goes_round(mine, level, rows)
    bare = Silhouette(cell, z, half, low, high, beside, legs & beside, nothing, nothing, own, closed)
    if not (bare.half_width > 0.0 and bare.main_girth > 0.0 and bare.proper.any()):
        return None
    front, back = (_reach(mine * [1.0, sign, 1.0], level, bare, sign) for sign in (1.0, -1.0))
    return replace(bare, front=front, back=back)


def _ends(values: Floats, row: Indices, rows: int) -> tuple[Floats, Floats]:
    """Return the least and the largest of the values in each row, NaN if there are none."""
    low, high = np.full(rows, np.inf), np.full(rows, -np.inf)
    np.minimum.at(low, row, values)
    np.maximum.at(high, row, values)
    empty = low > high
    return np.where(empty, np.nan, low), np.where(empty, np.nan, high)


def _goes_round(points: Points, row: Indices, rows: int) -> Flags:
    """Tell in which rows points lie in all directions from the middle, shape (rows,)."""
    x, y = (points[:, k] - 0.5 * np.add(*_ends(points[:, k], row, rows))[row] for k in (0, 1))
    sector = np.floor((np.arctan2(y, x) / (2.0 * np.pi)) * SECTORS).astype(np.int64) % SECTORS
    taken = np.zeros((rows, SECTORS), dtype=bool)
    taken[row, sector] = True
    return np.asarray(taken.all(axis=1))


def _own(points: Points, row: Indices, rows: int, grain: float) -> Flags:
    """Return which points belong to the trunk: at each level those up to the first gap from the middle."""
    side = (points[:, 0] < 0.0).astype(np.int64)
    column = np.floor(np.abs(points[:, 0]) / grain).astype(np.int64)
    count = int(column.max()) + 1
    taken = np.zeros((2, rows, count + GAP), dtype=bool)
    taken[side, row, column] = True
    near = taken[..., :count]
    for k in range(1, GAP):
        near = near | taken[..., k : count + k]
    end = np.where(near.all(axis=-1), count, np.argmin(near, axis=-1))
    return np.asarray((column < end[side, row]) & (end.min(axis=0) > 0)[row])


def _reach(points: Points, row: Indices, trunk: Silhouette, sign: float) -> Floats:
    """Return how far the side that faces -y stands out, shape (levels, columns), NaN if unknown."""
    half = int(np.ceil(1.1 * trunk.half_width / trunk.cell))
    column = np.rint(points[:, 0] / trunk.cell).astype(np.int64) + half
    limit = 0.5 * sign * (trunk.low + trunk.high) - 0.05 * (trunk.high - trunk.low)
    own = (points[:, 1] < limit[row]) & (column >= 0) & (column <= 2 * half)
    reach = np.full((len(trunk.z), 2 * half + 1), -np.inf)
    np.maximum.at(reach, (row[own], column[own]), -points[own, 1])
    known = np.isfinite(reach)
    weight = gaussian_filter(known.astype(np.float64), 1.0, mode="constant")
    total = gaussian_filter(np.where(known, reach, 0.0), 1.0, mode="constant")
    return np.where(weight > 0.3, total / np.maximum(weight, 0.3), np.nan)
