"""Removal of arms from the trunk: arm outlines, necks between arm and trunk, and shoulders."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import minimum_filter
from scipy.spatial.distance import cdist

from core.geometry.mesh import Floats, Indices, Points
from core.geometry.plane_sections import resample

SPACING = 5.0
"""Distance of the points between which a neck is looked for [mm]."""

STEP_OUT = 28.0
"""Where the trunk gets wider on one side by so much from one level to the next, an arm joins it [mm]."""

SLACK = 6.0
"""So much wider than below the armpit may the trunk be above it, on each side [mm]."""

MOST_POINTS = 1000
"""An outline of more points, 5 m long, is that of a torn skin: a trunk with joined arms has at most 300."""

MOST_NECKS = 200
"""At most so many necks of a level are measured closely, the narrowest ones; a body has fewer than 20."""

ASIDE = 62.0, 150.0
"""An arm is joined to the trunk between these azimuths [degrees]."""

LEAST_AREA, MOST_SHARE = 1000.0, 0.6
"""A neck cuts off at least this area [mm^2], and less than this part of the rest of the level [1]."""

LOOSE = 1e-6
"""The quick test of a neck is looser than the exact one by this part [1], for rounding."""


def necks(ring: Points, centre: Points) -> list[tuple[float, float] | None]:
    """Return where a left and a right arm join the trunk: two places along its outline [mm], or None.

    ``ring``, shape (n, 2) [mm], is closed, its last point the first again. The arm lies between the places,
    past the end of the ring if the first is the greater. A neck is the shortest way through the body between
    two places of its outline that cuts off something at the side, as thick as an arm, and thicker than the
    neck. Source: ours.
    """
    at = resample(ring, SPACING)[:-1]
    count = len(at)
    if not 60 <= count <= MOST_POINTS:
        return [None, None]
    length = float(np.linalg.norm(np.diff(ring, axis=0), axis=1).sum())
    away = cdist(at, at)
    near = np.abs(np.arange(count)[:, None] - np.arange(count))
    away[np.minimum(near, count - near) < 10] = np.inf
    first, second = np.nonzero((away == minimum_filter(away, 7, mode="wrap")) & (away < 130.0))
    likely = _likely(at, first, second, centre)
    likely = likely[np.argsort(away[first[likely], second[likely]], kind="stable")[:MOST_NECKS]]
    first, second = first[likely], second[likely]
    doubled = np.concatenate([at, at])
    found: list[list[tuple[float, float, float, float]]] = [[], []]
    for i, j in zip(first.tolist(), second.tolist(), strict=True):
        stop = j if j > i else j + count
        lobe, rest = doubled[i : stop + 1], doubled[stop : i + count + 1]
        if len(lobe) < len(rest):
            side = 0 if lobe[:, 0].mean() > centre[0] else 1
            area = _lobe(lobe, rest, centre, 1.0 - 2.0 * side)
            if area > 0.0:
                found[side].append((float(away[i, j]), area, length * i / count, length * j / count))
    return [_best(side) for side in found]


def _likely(at: Points, first: Indices, second: Indices, centre: Points) -> Indices:
    """Return the chords from place ``first`` to ``second`` of a closed outline that may cut off an arm.

    The first tests of ``_lobe`` for all chords at once, by running sums: a torn outline has thousands.
    """
    count, at, centre = len(at), at - at[0], centre - at[0]
    doubled = np.concatenate([at, at])
    x, y = doubled.T
    sums = np.concatenate([np.zeros((1, 2)), np.cumsum(doubled, axis=0)])
    turns = np.concatenate([[0.0], np.cumsum(x[:-1] * y[1:] - y[:-1] * x[1:])])
    stop = np.where(second > first, second, second + count)
    out = (sums[stop + 1] - sums[first]) / (stop + 1 - first)[:, None] - centre
    azimuth = np.degrees(np.arctan2(np.abs(out[:, 0]), -out[:, 1]))
    chord = x[stop] * y[first] - y[stop] * x[first]
    area, rest = turns[stop] - turns[first] + chord, turns[first + count] - turns[stop] - chord
    small = (stop - first < first + count - stop) & (area * rest > 0.0)
    wide = 0.5 * np.abs(area) > (1.0 - LOOSE) * LEAST_AREA
    part = np.abs(area) < (1.0 + LOOSE) * MOST_SHARE * np.abs(rest)
    aside = (azimuth > (1.0 - LOOSE) * ASIDE[0]) & (azimuth < (1.0 + LOOSE) * ASIDE[1])
    return np.flatnonzero(small & wide & part & aside)


def _best(found: list[tuple[float, float, float, float]]) -> tuple[float, float] | None:
    """Of necks (width, area cut off, two places) nearly as narrow as the narrowest return the inmost."""
    if not found:
        return None
    least = min(found)[0]
    return max((neck for neck in found if neck[0] < 1.6 * least), key=lambda neck: neck[1])[2:]


def _lobe(lobe: Points, rest: Points, centre: Points, side: float) -> float:
    """Return the area of what a chord cuts off [mm^2] if that can be an arm; else 0."""
    out = lobe.mean(axis=0) - centre
    if not ASIDE[0] < np.degrees(np.arctan2(side * out[0], -out[1])) < ASIDE[1]:
        return 0.0
    area, trunk = _area(lobe), _area(rest)
    if area * trunk <= 0.0 or not LEAST_AREA < abs(area) < MOST_SHARE * abs(trunk):
        return 0.0
    chord = lobe[-1] - lobe[0]
    thick = float(np.linalg.norm(chord))
    along = chord / thick
    depth, wide = np.abs((lobe - lobe[0]) @ (-along[1], along[0])).max(), np.ptp(lobe @ along)
    far, width = side * (lobe[:, 0] - centre[0]), float((side * (rest[:, 0] - centre[0])).max())
    fits = wide > 1.05 * thick and depth > 25.0 and thick < 0.8 * np.ptp(rest[:, 1])
    return abs(area) if fits and far.mean() > 0.8 * width and far.max() > width + 12.0 else 0.0


def _area(ring: Points) -> float:
    x, y = (ring - ring[0]).T
    return 0.5 * float(x[:-1] @ y[1:] - y[:-1] @ x[1:])


def shoulder_clip(width: Floats, step: float) -> Floats:
    """Return how wide the trunk may be on one side, shape (k,) [mm]; infinite where no arm is joined to it.

    ``width``, shape (k,) [mm], is how wide it is, from below at this ``step`` [mm], NaN where that is
    unknown. Where it jumps out, an arm has joined it without a neck, until it falls back; a head on a neck is
    none. Source: ours.
    """
    clip = np.full(len(width), np.inf)
    width, span = width.copy(), max(3, round(30.0 / step))
    known = np.flatnonzero(np.isfinite(width))
    typical = float(np.median(width[known])) if len(known) else 0.0
    at = span
    while at < len(known) - 1:
        own = float(np.median(width[known[at - span : at]]))
        if width[known[at]] <= own + STEP_OUT or own < 0.6 * typical:
            at += 1
            continue
        if width[known[at + 1]] <= own + STEP_OUT - 4.0:
            clip[known[at]] = own + SLACK
            width[known[at]] = own
            at += 1
            continue
        end = at
        while end < len(known) and width[known[end]] > own + 15.0:
            end += 1
        after = known[end : end + span]
        left = end < len(known) and width[known[end - 1]] > width[known[end]] + 20.0
        last = float(np.median(width[after])) if left and len(after) else own
        rows = np.arange(known[at], known[end] if end < len(known) else len(width))
        clip[rows] = np.linspace(own, last, len(rows)) + SLACK
        at = end + span
    return clip
