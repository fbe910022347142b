"""Gaps in the outline of the trunk, all round it, and how they are bridged after the levels near by."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from core.geometry.level_outlines import BINS
from core.geometry.mesh import Flags, Floats, Indices, Points, unit

BRIDGE = 150.0
"""What is missing on a level is taken from levels not farther away than this [mm]."""

SIDE = 75.0
"""The side of a trunk is not rounder than a circle of this radius [mm]."""

ALL_ROUND = 45.0
"""A strip that is missing all round the trunk is bridged if it is no higher than this [mm]."""

WIDEST = 2.8
"""A gap that no level near by shows is closed straight if it is no wider than this [rad]."""


def gaps(skin: Flags) -> list[Indices]:
    """Return the runs of directions without skin, round the circle; none if there is no skin at all."""
    if skin.all() or not skin.any():
        return []
    start = int(np.argmax(skin))
    missing = (np.flatnonzero(~np.roll(skin, -start)) + start) % BINS
    breaks = np.flatnonzero(np.diff((missing - start) % BINS) > 1) + 1
    return list(np.split(missing, breaks))


def bridge(far: Floats, skin: Flags, shape: Floats, cut: bool) -> Floats:
    """Fill the gaps of one level, shape (BINS,) [mm], after a ``shape`` moved to meet the ends of each gap.

    Where the shape is not known a hole is closed straight, and the side that an arm hides bulges a little.
    In a hole the skin also goes on as it ends, and the mean of both counts; where an arm is ``cut`` off, it
    bends towards that. Source: ours.
    """
    result = far.copy()
    round_ = np.full(BINS, np.nan) if cut else _rounded(far, skin)
    for run in gaps(skin):
        first, last = far[(run[0] - 1) % BINS], far[(run[-1] + 1) % BINS]
        ends = shape[[(run[0] - 1) % BINS, (run[-1] + 1) % BINS]]
        t = np.arange(1, len(run) + 1) / (len(run) + 1)
        turn = (len(run) + 1) * 2.0 * np.pi / BINS
        straight = np.full(len(run), np.nan)
        if turn < WIDEST:
            straight = first * np.sin(t * turn) + last * np.sin((1.0 - t) * turn)
            straight = first * last * np.sin(turn) / straight
        known = not (np.isnan(shape[run]).any() or np.isnan(ends).any())
        bulge = (first**2 + last**2 - 2.0 * first * last * np.cos(turn)) / (8.0 * SIDE)
        result[run] = straight + (3.0 * bulge * t * (1.0 - t) if cut else 0.0)
        if known:
            result[run] = shape[run] + (1.0 - t) ** 2 * (first - ends[0]) + t * t * (last - ends[1])
        if cut:
            result[run] = np.fmin(result[run], straight + bulge)
    return np.where(skin | np.isnan(round_), result, 0.5 * (result + round_))


def bridged_levels(far: Floats, skin: Flags, cut: Flags, z: Floats) -> Floats:
    """Fill the gaps of all levels at heights ``z``, shape (k,) [mm]; ``far`` and ``skin``, shape (k, BINS).

    Each is filled after the nearest levels below and above that show the whole of it. Source: ours.
    """
    result = far.copy()
    seen = skin & np.isfinite(far)
    for k in np.flatnonzero(skin.any(axis=1) & ~skin.all(axis=1)):
        near = np.flatnonzero(np.abs(z - z[k]) <= BRIDGE)
        shape = np.full(BINS, np.nan)
        for run in gaps(skin[k]):
            wide = np.concatenate([[(run[0] - 1) % BINS], run, [(run[-1] + 1) % BINS]])
            whole = near[seen[near][:, wide].all(axis=1)]
            shape[wide] = _between(far[:, wide], z, int(k), whole[whole < k], whole[whole > k])
        result[k] = bridge(far[k], skin[k], shape, bool(cut[k]))
    return result


def over_strips(far: Floats, shown: Flags, z: Floats) -> tuple[Floats, Flags]:
    """Fill levels that show no trunk, shape (k, BINS), where only a strip all round is missing.

    They go on from the levels below to those above, as these change. Also tells which levels are
    ``shown`` then. Source: ours.
    """
    rows = np.flatnonzero(shown)
    result, filled = far.copy(), shown.copy()
    for low, high in pairwise(rows.tolist()):
        strip, most = np.arange(low + 1, high), z[high] - z[low]
        if len(strip) and most <= ALL_ROUND:
            t, rise = ((z[strip] - z[low]) / (z[high] - z[low]))[:, None], far[high] - far[low]
            out = _slope(far, max(low - 2, 0), low) * (high - low) - rise
            back = rise - _slope(far, high, min(high + 2, len(z) - 1)) * (high - low)
            out, back = (np.clip(np.nan_to_num(bend), -most, most) for bend in (out, back))
            result[strip] = far[low] + t * rise + t * (1.0 - t) * ((1.0 - t) * out + t * back)
            filled[strip] = True
    return result, filled


def _slope(far: Floats, low: int, high: int) -> Floats:
    """Return how ``far`` grows a row from one to another, shape (BINS,) [mm]; NaN if they are one."""
    return np.asarray((far[high] - far[low]) / (high - low if high > low else np.nan))


def _between(far: Floats, z: Floats, k: int, below: Indices, above: Indices) -> Floats:
    """Return the shape at level ``k``, shape (b,) [mm], between the nearest below and above it."""
    if not len(below) or not len(above):
        whole = np.append(below[-1:], above[:1])
        return far[whole[0]] if len(whole) else np.full(far.shape[1], np.nan)
    low, high = below[-1], above[0]
    return np.asarray(far[low] + (z[k] - z[low]) / (z[high] - z[low]) * (far[high] - far[low]))


def _rounded(far: Floats, skin: Flags) -> Floats:
    """Fill the gaps of one level, shape (BINS,) [mm], each with a cubic that goes on as its ends do.

    NaN where a gap is too wide for that. Source: ours.
    """
    result = np.full(BINS, np.nan)
    t = np.linspace(0.0, 1.0, 33)[:, None]
    for run in gaps(skin):
        turn = np.arange(-4, len(run) + 4) + 0.5
        line = (run[0] + np.arange(-4, len(run) + 4)) % BINS
        radius = far[line]
        if len(run) * 2.0 * np.pi / BINS > WIDEST or not skin[line[[0, 1, 2, 3, -4, -3, -2, -1]]].all():
            continue
        angle = turn * 2.0 * np.pi / BINS
        at = radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        start, end = at[3], at[-4]
        length = float(np.linalg.norm(end - start))
        out, back = unit(at[3] - at[0]) * length, unit(at[-1] - at[-4]) * length
        curve = (1.0 + 2.0 * t) * (1.0 - t) ** 2 * start + t * (1.0 - t) ** 2 * out
        curve += t * t * (3.0 - 2.0 * t) * end - t * t * (1.0 - t) * back
        bearing = np.arctan2(curve[:, 1], curve[:, 0])
        if (np.diff(bearing) > 0.0).all():
            result[run] = np.interp(angle[4:-4], bearing, np.linalg.norm(curve, axis=1))
    return result


def eroded(skin: Flags) -> Flags:
    """Return ``skin``, shape (.., BINS), without the ends of its runs, which bend towards what was cut."""
    return np.asarray(skin & np.roll(skin, 1, axis=-1) & np.roll(skin, -1, axis=-1))


def bearing_bin(segments: Points, centre: Points) -> Indices:
    """Return the direction in which each segment lies from its centre, shape (s,)."""
    out = 0.5 * (segments[:, 0, :2] + segments[:, 1, :2]) - centre
    bearing = np.arctan2(out[:, 0], -out[:, 1])
    return np.asarray(np.floor((bearing + np.pi) * BINS / (2.0 * np.pi)).astype(np.int64) % BINS)
