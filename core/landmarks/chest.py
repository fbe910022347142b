"""Poles of the breasts on the trunk."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import maximum_filter
from scipy.spatial import ConvexHull, QhullError

from core.errors import LandmarkError
from core.geometry.mesh import SIGNS, Floats, Indices, Points
from core.landmarks.anchor import ABOVE, LOWEST, Anchor, reach_map, smoothed
from core.landmarks.torso.cross_sections import TorsoSections
from core.messages import Message

BELOW = 25.0
"""A pole is looked for so far below the anchor [mm], and up to the highest breast."""

BESIDE = 0.17
"""And further from the middle than this part of the half width of the trunk: the breastbone is no breast."""

OUTWARD, PAIRED = 8.0, 40.0
"""A breast is where the body reaches furthest in a direction so far outward of the front [degrees]: the place
lies between the foremost one and the nipple. That of each side lies so near to that of both together [mm]."""

USUAL, STRAYING = (18.0, 52.0), 0.6
"""A pole usually lies so far round the trunk from the front [degrees]; a degree more must be paid by so much
prominence [mm], as the side of the trunk and an arm stand out too."""

HIGH, RISING = 85.0, 0.15
"""Each mm over this height above the anchor [mm] must be paid by so much prominence [mm]: shoulders."""

FARTHEST, HIGHEST = 66.0, 122.0
"""A summit so far round [degrees] or so high [mm] is the border of the search and no breast."""

TALL, TURN = 5.0, 3.0
"""Cell of the map of prominence: height [mm] and bearing [degrees]."""

SUMMIT = 40.0
"""A summit so far from where the breast reaches forward [mm] is not that of the breast."""

TOP = 25.0
"""The pole is the middle of what stands out most so near to the summit [mm]."""


@dataclass(frozen=True, eq=False)
class Pole:
    """The point of one breast that stands out most from the trunk under it, shape (3,) [mm].

    ``prominence`` is how far [mm]; ``inside`` is False if nothing stands out most near where the breast
    reaches ``forward``, shape (3,) [mm]: then that is its pole. ``side`` is 1 left and -1 right.
    """

    position: Points
    prominence: float
    inside: bool
    forward: Points
    side: float

    @property
    def outward(self) -> Points:
        """Return the direction in which the breast reaches furthest, shape (3,) [1]."""
        turn = np.radians(OUTWARD)
        return np.array([self.side * np.sin(turn), -np.cos(turn), 0.0])


def forward_places(survey: TorsoSections, anchor: Anchor) -> tuple[Points, Points]:
    """Return where the left and the right breast reach furthest forward, each (3,) [mm].

    They are looked for as a mirrored pair: first where both sides together reach furthest, then on each side
    near there. Raises LandmarkError without a front of the chest. Source: ours.
    """
    reach, x = reach_map(survey, anchor.half_width)
    high = survey.z - anchor.z
    rows = np.flatnonzero((high > LOWEST) & (high < ABOVE))
    columns = np.flatnonzero((x > BESIDE * anchor.half_width) & (x < anchor.half_width))
    both = (columns, len(x) - 1 - columns)
    turn, known = np.radians(OUTWARD), np.nan_to_num(reach, nan=-np.inf)
    out = x[columns] * np.sin(turn) - RISING * np.maximum(high[rows] - HIGH, 0.0)[:, None]
    left, right = (known[rows][:, side] * np.cos(turn) + out for side in both)
    if not (left.size and np.isfinite(left + right).any()):
        raise LandmarkError(
            Message("The front of the chest is missing."),
            Message("Open a scan that includes the whole bust."),
        )
    row, column = np.unravel_index(np.argmax(left + right), left.shape)
    away = np.hypot((high[rows] - high[rows][row])[:, None], x[columns] - x[columns][column])
    places = []
    for side, own in zip(both, (left, right), strict=True):
        k, m = np.unravel_index(np.argmax(np.where(away < PAIRED, own, -np.inf)), own.shape)
        at = rows[k], side[m]
        places.append(np.array([survey.middle + x[at[1]], -known[at], survey.z[at[0]]]))
    return places[0], places[1]


def find_poles(survey: TorsoSections, anchor: Anchor) -> tuple[Pole, Pole]:
    """Return the poles of the left and the right breast.

    Prominence is measured from the convex outline of the trunk under the breasts, after the body has been
    narrowed to the width of the back there. Raises LandmarkError without a chest. Source: ours.
    """
    near = (survey.samples[:, 2] > anchor.z - BELOW) & (survey.samples[:, 2] < anchor.z + ABOVE)
    p, row = survey.samples[near], survey.row[near]
    x = p[:, 0] - survey.middle
    depth = 0.5 * (survey.front + survey.back)[row] - p[:, 1]
    under = (survey.z > anchor.z - 45.0) & (survey.z < anchor.z - 10.0) & (survey.tape > 0.0)
    if not under.any() or survey.z[0] > anchor.z - 12.0:
        raise _no_base()
    width = float(np.median(survey.half_width[under]))
    window = (depth > 0.0) & (np.abs(x) > BESIDE * width) & (np.abs(x) < max(1.25 * width, width + 35.0))
    azimuth = np.degrees(np.arctan2(np.abs(x), depth))
    prominence = np.full(len(p), -np.inf)
    prominence[window] = _prominence(survey, anchor, p[window], row[window])
    left, right = (
        _pole(p[part], azimuth[part], prominence[part], anchor, place, side)
        for side, place in zip(SIGNS, forward_places(survey, anchor), strict=True)
        for part in [window & (side * x > 0.0)]
    )
    return left, right


def _no_base() -> LandmarkError:
    return LandmarkError(
        Message("The trunk below the breasts is missing."),
        Message("Open a scan that includes the whole trunk."),
    )


def _prominence(survey: TorsoSections, anchor: Anchor, p: Points, row: Indices) -> Floats:
    shown = np.unique(survey.row)  # a gap all round leaves levels without skin
    base = shown[np.argmin(np.abs(survey.z[shown] - (anchor.z - 12.0)))]
    try:
        hull = ConvexHull(survey.samples[survey.row == base][:, :2]).equations
    except (QhullError, ValueError):  # nothing there, or a line
        raise _no_base() from None
    back = survey.back_width()
    shrink = np.clip(back[base] / back, 0.7, 1.0)[row]
    flat = np.column_stack([survey.middle + (p[:, 0] - survey.middle) * shrink, p[:, 1]])
    return np.asarray((hull[:, :2] @ flat.T + hull[:, 2:]).max(axis=0))


def _pole(
    p: Points, azimuth: Floats, prominence: Floats, anchor: Anchor, forward: Points, side: float
) -> Pole:
    """Find the pole among the points of one side: the highest summit near the ``forward`` place, centred."""
    if len(p) < 200:
        raise LandmarkError(
            Message("The front of the chest is missing."),
            Message("Open a scan that includes the whole bust."),
        )
    high = p[:, 2] - anchor.z
    score = prominence - STRAYING * np.abs(azimuth - np.clip(azimuth, *USUAL))
    score -= RISING * np.maximum(high - HIGH, 0.0)
    shape = (round((BELOW + ABOVE) / TALL), round(90.0 / TURN))
    cells = (np.floor((high + BELOW) / TALL).astype(np.int64), np.floor(azimuth / TURN).astype(np.int64))
    cells = (np.clip(cells[0], 0, shape[0] - 1), np.clip(cells[1], 0, shape[1] - 1))  # rounding at the border
    grid = np.full(shape, -np.inf)
    np.maximum.at(grid, cells, score)
    grid = smoothed(grid, (1.2, 0.9))
    grid = np.where(np.isnan(grid), -np.inf, grid)
    summit = grid == maximum_filter(grid, (9, 7), mode="nearest")
    apart = np.linalg.norm(p - forward, axis=1)
    inner = summit[cells] & (azimuth < FARTHEST) & (high < HIGHEST) & (apart < SUMMIT)
    top = p[np.argmax(np.where(inner, grid[cells], -np.inf)) if inner.any() else np.argmin(apart)]
    near = np.flatnonzero(((p - top) ** 2).sum(axis=1) < TOP**2)
    best = near[np.argsort(prominence[near])[-len(near) // 2 :]]
    place = p[best].mean(axis=0) if inner.any() else top
    return Pole(place, float(prominence[best].mean()), bool(inner.any()), forward, side)
