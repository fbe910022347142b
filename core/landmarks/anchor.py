"""The crease under both breasts, coarsely: where the body comes forward over it to the bust."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter, maximum_filter1d, uniform_filter1d

from core.geometry.mesh import SIGNS, Flags, Floats, Indices
from core.landmarks.torso.cross_sections import TorsoSections

CELL = 5.0
"""Cell of the reach map across the body [mm]."""

KINK = 8.0
"""Over a fold the body comes forward by this at least [mm]."""

LONE = 0.35
"""A side that comes forward by less than this part of the other has no breast: its ribs do so too [1]."""

LATERAL = 0.28, 0.85
"""The breasts stand out between these parts of the half width of the trunk: further out it is the side of the
chest that comes forward under an arm-pit [1]."""

CHEST, BELLY = 3.0, 2.0
"""Under the bust the body falls back by more than the first [mm], over a belly forward by the second."""

CHIN = 20.0
"""What comes forward in the middle as well is a bust in a bra, unless elsewhere both sides alone come forward
by so much more [mm]: then it is a chin that hangs over the chest."""

NIPPLE, UNDER, DEEP = 25.0, 25.0, 150.0
"""The crease lies further under the summit of the bust than the first, and not further than the third; under
the hollow below the bust it lies no further than the second [mm]."""

LOWEST, ABOVE = 10.0, 130.0
"""Breasts lie further above the anchor than the first, the highest one no further than the second [mm]."""


@dataclass(frozen=True, eq=False)
class Anchor:
    """The crease under both breasts, coarsely: ``z`` lies some 10-20 mm under the fold [mm].

    ``kink`` is how far the body comes forward above it on the weaker side, and ``middle_kink`` on the centre
    line [mm]; ``half_width`` is that of the trunk [mm]; ``lone`` tells that only one side comes forward.
    ``ridge`` is how far the middle stands out over both sides where these do most: cloth spans from breast to
    breast, and one bump is highest in its middle [mm].
    """

    z: float
    kink: float
    middle_kink: float
    half_width: float
    lone: bool = False
    ridge: float = -np.inf


def reach_map(survey: TorsoSections, half_width: float) -> tuple[Floats, Floats]:
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
    return smoothed(reach, (8.0 / survey.step, 8.0 / CELL)), columns


def smoothed(grid: Floats, sigma: tuple[float, float]) -> Floats:
    """Return ``grid`` smoothed by a Gaussian over what is finite in it; NaN where nearly nothing is."""
    known = np.isfinite(grid)
    weight = gaussian_filter(known.astype(float), sigma, mode="nearest")
    value = gaussian_filter(np.where(known, grid, 0.0), sigma, mode="nearest")
    return np.asarray(np.where(weight > 0.2, value / np.maximum(weight, 0.2), np.nan))


def find_anchor(survey: TorsoSections) -> Anchor:
    """Return the level under the bust where the body kinks forward most on both sides.

    Raises LandmarkError if there is no trunk or no such level. Source: ours.
    """
    half_width, usable = survey.trunk()
    reach, x = reach_map(survey, half_width)
    up = round(30.0 / survey.step)
    kink = np.full_like(reach, np.nan)
    kink[up:-up] = reach[2 * up :] - reach[up:-up] - np.maximum(0.0, reach[: -2 * up] - reach[up:-up])
    lateral = (np.abs(x) > LATERAL[0] * half_width) & (np.abs(x) < LATERAL[1] * half_width)
    halves = [lateral & (s * x > 0) for s in SIGNS]
    front = np.maximum(*(_largest(reach[:, half]) for half in halves))
    under = _under_summit(front, survey.z, usable)
    calm = uniform_filter1d(
        np.where(np.isnan(kink), -100.0, kink), round(20.0 / CELL), axis=1, mode="nearest"
    )
    wide = round(24.0 / survey.step) | 1
    sides = [maximum_filter1d(calm[:, half].max(axis=1), wide) for half in halves]
    both = np.minimum(*sides)
    central = np.abs(x) < 0.12 * half_width
    middle = np.where(np.isnan(kink), -100.0, kink)[:, central].max(axis=1)

    def best_over(sides: Floats) -> int:
        plain = np.where(usable, sides - 0.8 * np.maximum(middle, 0.0), -np.inf)
        best, own = int(np.argmax(plain)), int(np.argmax(np.where(under, sides, -np.inf)))
        return own if under[own] and sides[own] > KINK and plain[own] > plain[best] - CHIN else best

    either = np.maximum(*sides)
    best, only = best_over(both), best_over(either)
    lone = bool(both[best] < max(KINK, LONE * either[only]))
    if lone:
        both, best = either, only
    kinks = float(both[best]), float(middle[best])
    ridge = _ridge(front, _largest(reach[:, central]), survey.z - survey.z[best])
    return Anchor(float(survey.z[best]), *kinks, half_width, lone, ridge)


def _largest(reach: Floats) -> Floats:
    """Return the furthest reach of each level, shape (levels,) [mm]; -inf where there is no front."""
    return np.asarray(np.where(np.isnan(reach), -np.inf, reach).max(axis=1, initial=-np.inf))


def _ridge(front: Floats, middle: Floats, high: Floats) -> float:
    """Return how far the ``middle`` of the chest stands out over its sides [mm], where these do most."""
    chest = (high > LOWEST) & (high < ABOVE)
    top = int(np.argmax(np.where(chest, front, -np.inf)))
    return float(middle[top] - front[top]) if np.isfinite(front[top]) else -np.inf


def _under_summit(front: Floats, z: Floats, usable: Flags) -> Flags:
    """Return which levels lie under the bust: from its summit down to where the body comes forward again.

    ``front`` is how far the chest reaches forward beside its middle, shape (levels,) [mm]. The first summit
    from above is the bust, however much a belly stands out below it. Without a summit there is no such level.
    """
    rows = np.flatnonzero(usable & np.isfinite(front))[::-1]
    summit = _turning(front, rows, CHEST)
    if summit is None:
        return np.zeros(len(z), dtype=bool)
    lower = rows[rows < summit]
    hollow = _turning(-front, lower, BELLY)
    low = z[summit] - DEEP if hollow is None else max(z[summit] - DEEP, z[hollow] - UNDER)
    return np.asarray(usable & (z < z[summit] - NIPPLE) & (z > low))


def _turning(value: Floats, rows: Indices, least: float) -> int | None:
    """Return the first of ``rows`` after which ``value`` falls by more than ``least`` [mm]; None if none."""
    if not len(rows):
        return None
    top = np.maximum.accumulate(value[rows])
    fallen = np.flatnonzero(value[rows] < top - least)
    return int(rows[np.argmax(value[rows[: fallen[0]]])]) if len(fallen) else None
