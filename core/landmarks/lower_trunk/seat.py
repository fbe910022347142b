"""The seat: buttock points and gluteal folds."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import gaussian_filter1d

from core.geometry.mesh import Floats, Mesh, Points
from core.geometry.plane_sections import arc_length
from core.landmarks.lower_trunk.sections import LowerSection, LowerSections, crossings

SEAT_UP_TO = 0.55
"""The most backward place of the seat lies below this part of the way from crotch to under-bust [1]; ours."""

BESIDE = 15.0
"""The seat begins so far beside the middle [mm]; ours."""

NEAR = 1.0
"""Vertices so near behind the most backward one count as it [mm]; ours."""

OFFSETS = (-16.0, -8.0, 0.0, 8.0, 16.0)
"""Profiles that the fold is read from, beside the buttock point [mm]; ours."""

FINE = 2.0
"""Distance of the levels that a profile is read at [mm]; ours."""

LOWEST = 80.0
"""The fold lies at most so far below the crotch [mm]; ours."""

USUAL, WITHIN, LESS = 22.0, 15.0, 1.2e-4
"""Where the fold usually lies below the crotch [mm], how far from there each place counts alike [mm], and by
how much less each further mm counts [1/mm^2]; ours.
"""

CREASE = 0.012
"""A fold that is bent less than this is a soft hollow [1/mm]; ours."""

SMOOTHING = 8.0
_ARC = 1.0


def buttock_point(mesh: Mesh, sections: LowerSections, crotch: float, sign: float) -> Points:
    """Return the most backward place of one side, +1 the left one, (3,) [mm]."""
    vertices = mesh.vertices
    top = crotch + SEAT_UP_TO * (sections.top - crotch)
    half = np.abs(_trunk_width(sections, 0.5 * (crotch + top)))
    beside = sign * (vertices[:, 0] - sections.middle)
    here = (vertices[:, 2] > crotch) & (vertices[:, 2] < top) & (beside > BESIDE) & (beside < half)
    seat = vertices[here]
    return np.asarray(seat[seat[:, 1] > seat[:, 1].max() - NEAR].mean(axis=0))


def _trunk_width(sections: LowerSections, z: float) -> float:
    trunk = sections.at(z).trunk
    return np.inf if trunk is None else float(np.ptp(trunk[:, 0]) / 2.0)


def gluteal_fold(sections: LowerSections, buttock: Points, crotch: float) -> tuple[Points, float]:
    """Return the place of a fold below a buttock point, (3,) [mm], and how much it is bent there [1/mm]."""
    side = 0 if buttock[0] > sections.middle else 1
    heights = np.arange(max(crotch - LOWEST, sections.bottom + FINE), float(buttock[2]), FINE)
    levels = sections.many(heights)
    bends = np.array([_bend(heights, levels, float(buttock[0]) + each, side) for each in OFFSETS])
    seen = np.isfinite(bends)
    bend = np.where(seen.any(axis=0), np.nansum(bends, axis=0) / np.maximum(seen.sum(axis=0), 1), -np.inf)
    bend[seen.sum(axis=0) < 3] = -np.inf
    away = np.abs(heights - (crotch - USUAL))
    score = bend - LESS * np.maximum(away - WITHIN, 0.0)
    at = int(np.argmax(score))
    y = _back(levels[at], float(buttock[0]), side)
    return np.array([buttock[0], y, heights[at]]), float(bend[at])


def _back(level: LowerSection, x: float, side: int) -> float:
    """Return the most backward y of trunk or leg at ``x`` [mm], NaN where neither is there."""
    outline = level.trunk if level.trunk is not None else level.legs[side]
    found = crossings(outline, x) if outline is not None else np.empty(0)
    return float(found[-1]) if len(found) else np.nan


def _bend(heights: Floats, levels: list[LowerSection], x: float, side: int) -> Floats:
    """Return how hollow the back is at each height in the sagittal plane at ``x``, (k,) [1/mm]; else NaN."""
    y = np.array([_back(level, x, side) for level in levels])
    result = np.full(len(y), np.nan)
    gone = np.flatnonzero(~np.isfinite(y))
    begin = int(gone[-1]) + 1 if len(gone) else 0
    if len(y) - begin < 12:
        return result
    curve = np.column_stack([y[begin:], heights[begin:]])
    along = arc_length(curve)
    even = np.arange(0.0, along[-1], _ARC)
    smooth = np.column_stack([np.interp(even, along, each) for each in curve.T])
    smooth = gaussian_filter1d(smooth, SMOOTHING / _ARC, axis=0, mode="nearest")
    first = np.gradient(smooth, _ARC, axis=0)
    second = np.gradient(first, _ARC, axis=0)
    speed = np.maximum(np.linalg.norm(first, axis=1), 1e-9)
    # going up the back: hollow where the way turns to the back (+y), that is to the right
    turn = (second[:, 0] * first[:, 1] - second[:, 1] * first[:, 0]) / speed**3
    result[begin:] = np.interp(along, even, turn)
    ends = int(2.0 * SMOOTHING / FINE)
    result[begin : begin + ends // 2] = np.nan
    return result
