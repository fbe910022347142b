"""Stances of a body: for each way it might stand, how much its trunk looks like one with a bust in front."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.ndimage import convolve1d, gaussian_filter, maximum_filter1d, shift

from core.mesh import Flags, Floats, Points
from core.sections import hull_perimeter
from core.symmetry import Cloud, MirrorPlane

TYPICAL_GIRTH = 860.0
"""A trunk girth [mm] that makes file units into mm well enough to tell up from down."""

SHORTEST = 250.0
"""A scan of the upper body is taller than this [mm by a typical girth]; one that lies on its back is not."""

STEP = 1.2
"""Distance of the levels, and side of the cells of the front reach [grains]."""


@dataclass(frozen=True, eq=False)
class Trunk:
    """The trunk, arms taken out, at levels square to an axis [file units]; each shape (k,).

    ``width`` is half the width, ``low`` and ``high`` are the ends in depth, ``arms`` tells that something
    lies beside the trunk; where no level could be read ``width`` is NaN.
    """

    z: Floats
    width: Floats
    girth: Floats
    low: Floats
    high: Floats
    arms: Flags

    @cached_property
    def half_width(self) -> float:
        """Half width of the trunk proper, without merged arms; NaN if there is none."""
        return self._reference(self.width)

    @cached_property
    def main_girth(self) -> float:
        """Girth of the trunk proper; NaN if there is none."""
        return self._reference(self.girth)

    @cached_property
    def stoutness(self) -> float:
        """Width of the trunk proper over its depth [1]."""
        width, depth = self.width[self.proper], (self.high - self.low)[self.proper]
        return float(2.0 * np.median(width) / max(float(np.median(depth)), 1e-9 * self.half_width))

    @cached_property
    def proper(self) -> Flags:
        """Levels that are trunk: not neck, not head, not merged with arms."""
        share = self.width / self.half_width
        return (share > 0.6) & (share < 1.3) & (self.girth > 0.7 * self.main_girth)

    def _reference(self, value: Floats) -> float:
        width = self.width[np.isfinite(self.width)]
        if len(width) == 0:
            return float("nan")
        upper = np.median(width[width >= np.median(width)])
        return float(np.percentile(value[self.width <= 1.25 * upper], 70))

    def turned(self, up: int, back: int) -> Trunk:
        """Return the same trunk with z and depth taken along these signs (+1 or -1)."""
        low, high = (self.low, self.high) if back > 0 else (-self.high, -self.low)
        width, girth, arms = self.width[::up], self.girth[::up], self.arms[::up]
        return Trunk(up * self.z[::up], width, girth, low[::up], high[::up], arms)


@dataclass(frozen=True, eq=False)
class Stance:
    """One way to stand: unit vectors ``left``, ``back``, ``up`` in the file, shape (3,), and its ``score``.

    ``kink`` is the hollow under a bust at both sides, ``middle`` the one in between [mm by a typical girth].
    """

    left: Floats
    back: Floats
    up: Floats
    trunk: Trunk
    residual: float
    kink: float
    middle: float
    score: float

    @property
    def is_body(self) -> bool:
        """Whether this can be an upper body at all."""
        flat = -90.0 <= self.middle <= 0.5 * self.kink
        return self.kink >= 8.0 and self.residual <= 0.3 and flat and 1.0 <= self.trunk.stoutness <= 2.3


def stances(cloud: Cloud, plane: MirrorPlane) -> list[Stance]:
    """Return the four ways to stand with a mirror plane: up or down, facing to or fro. Source: ours."""
    axis = np.eye(3)[plane.up]
    across = np.cross(axis, plane.side)
    local = cloud.points @ np.stack([plane.side, across, axis], axis=1) - [plane.offset, 0.0, 0.0]
    trunk = _trunk(local, cloud.grain)
    if not (trunk.half_width > 0.0 and trunk.main_girth > 0.0 and trunk.proper.any()):
        return []
    found = []
    for up in (1, -1):
        for back in (1, -1):
            turned = trunk.turned(up, back)
            score, kink, middle = _rate(local * [up * back, back, up], turned, cloud.grain)
            score -= 6.0 * plane.residual
            directions = (up * back * plane.side, back * across, up * axis)
            found.append(Stance(*directions, turned, plane.residual, kink, middle, score))
    return found


def _trunk(points: Points, grain: float) -> Trunk:
    """Read the trunk off points whose mirror plane is x = 0 and whose levels are along z."""
    order = np.argsort(points[:, 2])
    points = points[order]
    z = np.arange(points[0, 2], points[-1, 2], STEP * grain)
    first, last = np.searchsorted(points[:, 2], [z - grain, z + grain])
    rows = [_level(points[a:b], 3.0 * grain) for a, b in zip(first, last, strict=True)]
    width, girth, low, high, arms = np.array(rows).reshape(-1, 5).T
    return Trunk(z, width, girth, low, high, arms > 0.0)


def _level(points: Points, gap: float) -> tuple[float, float, float, float, float]:
    """Return half width, girth, both ends in depth and a flag for arms; NaN if a level has no middle."""
    if (np.abs(points[:, 0]) < gap).sum() < 2:
        return (np.nan,) * 5
    ends = []
    for sign in (1.0, -1.0):
        out = np.sort(np.maximum(sign * points[:, 0], 0.0))
        breach = np.flatnonzero(np.diff(out, prepend=0.0) > gap)
        ends.append(float(out[breach[0] - 1]) if len(breach) else float(out[-1]))
    own = points[(points[:, 0] <= ends[0]) & (points[:, 0] >= -ends[1])]
    arms = float(len(own) < len(points))
    return 0.5 * sum(ends), hull_perimeter(own), float(own[:, 1].min()), float(own[:, 1].max()), arms


def _rate(points: Points, trunk: Trunk, grain: float) -> tuple[float, float, float]:
    """Return score [1], kink and middle [mm] of a body that faces -y with z up."""
    mm = TYPICAL_GIRTH / trunk.main_girth
    cell = STEP * grain
    kink = _kinks(_front_reach(points, trunk, cell) * mm, cell * mm)
    x = (np.arange(kink.shape[1]) - kink.shape[1] // 2) * cell / trunk.half_width
    side = (np.abs(x) > 0.28) & (np.abs(x) < 0.85)
    wide = max(1, 2 * round(12.0 / (cell * mm)) + 1)
    left, right = (
        maximum_filter1d(kink[:, side & (sign * x > 0)].max(axis=1, initial=-np.inf), wide)
        for sign in (1, -1)
    )
    both = np.minimum(left, right)
    middle = kink[:, np.abs(x) < 0.12].max(axis=1, initial=-np.inf)
    middle = np.where(np.isfinite(middle), middle, 0.0)
    height = (trunk.z - trunk.z[0]) * mm
    allowed = trunk.proper & (height > 30.0) & (height < height[-1] - 60.0)
    if not (allowed & np.isfinite(both)).any():
        return -np.inf, 0.0, 0.0
    fold = int(np.argmax(np.where(allowed, both - 0.8 * np.clip(middle, 0.0, 40.0), -np.inf)))
    strength, between = float(both[fold]), float(middle[fold])
    score = strength / 10.0 if strength < 25.0 else 2.5 + (min(strength, 60.0) - 25.0) / 20.0
    score -= 0.8 * float(np.clip(between / max(strength, 5.0), 0.0, 1.0))
    score -= 4.0 * max(0.0, 0.25 - height[fold] / height[-1])
    score -= 1.5 * (between < -90.0)
    score -= 3.0 * float(np.clip((SHORTEST - height[-1]) / 60.0, 0.0, 1.0))
    return score + _build(trunk), strength, between


def _build(trunk: Trunk) -> float:
    """Return what the outline of the trunk alone says for this way up [1]."""
    read = np.flatnonzero(np.isfinite(trunk.width))
    end = max(1, len(read) // 6)
    bottom, top = np.median(trunk.width[read[:end]]), np.median(trunk.width[read[-end:]])
    score = 0.8 * float(np.clip(np.log(bottom / max(top, 1e-9)), -1.0, 1.0)) if bottom > 0.0 else -0.8
    merged = trunk.width > 1.3 * trunk.half_width
    free = trunk.arms & trunk.proper
    if merged.any() and free.any():
        score += 0.5 * float(np.sign(trunk.z[merged].mean() - trunk.z[free].mean()))
    return score + (0.5 if 1.05 < trunk.stoutness < 2.3 else -2.5)


def _front_reach(points: Points, trunk: Trunk, cell: float) -> Floats:
    """Return how far the front of the trunk comes forward, shape (levels, columns), NaN where nothing is."""
    row = np.rint((points[:, 2] - trunk.z[0]) / cell).astype(np.int64).clip(0, len(trunk.z) - 1)
    half = int(np.ceil(1.1 * trunk.half_width / cell))
    column = np.rint(points[:, 0] / cell).astype(np.int64) + half
    limit = 0.5 * (trunk.low + trunk.high) - 0.05 * (trunk.high - trunk.low)
    own = (points[:, 1] < limit[row]) & (column >= 0) & (column <= 2 * half)
    reach = np.full((len(trunk.z), 2 * half + 1), -np.inf)
    np.maximum.at(reach, (row[own], column[own]), -points[own, 1])
    known = np.isfinite(reach)
    weight = gaussian_filter(known.astype(np.float64), 1.2, mode="constant")
    total = gaussian_filter(np.where(known, reach, 0.0), 1.2, mode="constant")
    return np.where(weight > 0.3, total / np.maximum(weight, 0.3), np.nan)


def _kinks(reach: Floats, cell: float) -> Floats:
    """Return how far the front stands out 30 mm higher, less how far 30 mm lower [mm]; -inf if unknown.

    ``reach`` and its ``cell`` are in mm here.
    """
    above, below = (shift(reach, (rows, 0.0), order=1, cval=np.nan) for rows in (-30.0 / cell, 30.0 / cell))
    kink = above - reach - np.maximum(0.0, below - reach)
    run = max(1, round(20.0 / cell))
    kink = convolve1d(kink, np.full(run, 1.0 / run), axis=1, mode="constant", cval=np.nan)
    return np.where(np.isfinite(kink), kink, -np.inf)
