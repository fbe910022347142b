"""Buttock points and gluteal folds, found on the back of the lower trunk."""

from __future__ import annotations

import numpy as np

from core.geometry.mesh import SIGNS, Floats
from core.geometry.plane_sections import arc_length, curvature
from core.landmarks.lower_trunk.outline_profiles import FINE, back, crossings, heights, peak, smoothed
from core.landmarks.lower_trunk.sections import STEP, LowerSection, LowerSections
from core.landmarks.types import SIDES, Landmark
from core.messages import Message

SEAT = 0.6
"""Buttock points are sought up to this part of the way from crotch to under-bust [1]. Source: measured."""

NEAR_MIDDLE = 15.0
"""The cleft is nearer to the middle than this [mm]: no buttock point lies there. Ours."""

FLAT_TOP = 1.0
"""The height of a buttock point is the mean of skin within this of the hindmost [mm]. Source: measured."""

HIGH_SEAT = 125.0
"""Higher above the crotch the most backward skin is that of the flank [mm, at scale 1]. Source: measured."""

ASIDE = np.array([-16.0, -8.0, 0.0, 8.0, 16.0])
"""Sagittal profiles through a fold, so far from the buttock point [mm]. Source: measured on bodies."""

USUAL_FOLD, FREE, SLOPE = 22.0, 15.0, 0.00012
"""A fold lies about so far below the crotch [mm]; beyond the second [mm] each mm costs curvature [1/mm^2]."""

FOLD_RANGE = 85.0
"""Folds are sought so far above and below their usual place [mm]. Ours."""

BELOW_POINT = 20.0
"""A fold lies at least this far below the buttock point [mm]. Ours."""

EVEN = 8.0
"""The mean curvature is smoothed over this height [mm]. Source: measured with noise."""

BETWEEN_THIGHS = 5.0
"""A leg nearer to the middle than this touches the other [mm]: it is pressed out of shape. Ours."""

CREASE = 0.009
"""A less curved hollow is no crease [1/mm]. Source: measured on bodies."""

NOT_SHOWN = Message("The scan does not show the gluteal fold: approximate.")
"""The rule of a fold whose place is a guess."""


def buttock_point(sections: LowerSections, side: int, low: float, scale: float) -> Landmark:
    """Return the most backward point of a side (0 left), from the crotch at ``low`` [mm] up."""
    z = heights(low + 4.0, low + SEAT * (sections.top - low), STEP)
    places = np.array([_hindmost(section, sections.middle, side) for section in sections.many(z.tolist())])
    fine = heights(float(z[0]), float(z[-1]), 0.5)
    depth = np.interp(fine, z, smoothed(places[:, 1], STEP, STEP))
    at = float(fine[depth > np.nanmax(depth) - FLAT_TOP].mean())
    x, y = _middle_of_hindmost(sections.at(at), sections.middle, side)
    inside = z[0] + 8.0 < at < z[-1] - 8.0
    usual = at - low < HIGH_SEAT * scale
    rule = Message("Most backward point of the side.")
    if not usual or not inside:
        rule = Message("Flat seat: the most backward point of the side lies on the flank.")
    return Landmark(f"buttock_{SIDES[side]}", np.array([x, y, at]), 0.8 if inside and usual else 0.4, rule)


def _hindmost(section: LowerSection, middle: float, side: int) -> tuple[float, float]:
    """Return x and y of the hindmost skin of one side of a trunk [mm]; NaN without a trunk."""
    if section.trunk is None:
        return np.nan, np.nan
    own = section.trunk[SIGNS[side] * (section.trunk[:, 0] - middle) > NEAR_MIDDLE]
    if len(own) == 0:
        return np.nan, np.nan
    x, y, _ = own[np.argmax(own[:, 1])]
    return float(x), float(y)


def _middle_of_hindmost(section: LowerSection, middle: float, side: int) -> tuple[float, float]:
    """Return the middle of the skin that is hindmost within ``FLAT_TOP``: a single vertex is chance."""
    x, y = _hindmost(section, middle, side)
    if section.trunk is None or np.isnan(x):
        return x, y
    own = section.trunk[SIGNS[side] * (section.trunk[:, 0] - middle) > NEAR_MIDDLE]
    flat = own[own[:, 1] > y - FLAT_TOP, 0]
    x = 0.5 * float(flat.min() + flat.max())
    return x, float(crossings(section.trunk, x)[-1])


def gluteal_fold(sections: LowerSections, side: int, low: float, point: Landmark) -> Landmark:
    """Return the gluteal fold under the buttock ``point`` of a side (0 left), the crotch at ``low`` [mm]."""
    name = f"gluteal_fold_{SIDES[side]}"
    usual, x = low - USUAL_FOLD, float(point.position[0])
    bottom = max(usual - FOLD_RANGE, sections.bottom + 2.0)
    z = heights(bottom - 20.0, min(usual + FOLD_RANGE, float(point.position[2])) + 20.0)
    depth = back(sections.many(z.tolist()), x + ASIDE, side)
    bend = np.stack([_hollow(z, column) for column in depth.T], axis=1)
    enough = np.isfinite(bend).sum(axis=1) >= 3
    mean = np.full(len(z), np.nan)
    mean[enough] = np.nanmean(bend[enough], axis=1)
    mean = smoothed(mean, FINE, EVEN)
    mean[(z < bottom) | (z > min(usual + FOLD_RANGE, float(point.position[2]) - BELOW_POINT))] = np.nan
    score = mean - SLOPE * np.maximum(np.abs(z - usual) - FREE, 0.0)
    middle = depth[:, len(ASIDE) // 2]
    curve = np.stack([np.full(len(z), x), middle, z], axis=1)[np.isfinite(middle)]
    if not np.isfinite(score).any() or len(curve) == 0:
        place = np.array([x, float(point.position[1]), usual])
        return Landmark(name, place, 0.1, NOT_SHOWN)
    best = int(np.nanargmax(score))
    level, _ = peak(z, score)
    place = np.array([x, np.interp(level, curve[:, 2], curve[:, 1]), level])
    sharp, edge = float(mean[best]), np.isnan(score[max(best - 2, 0) : best + 3]).any()
    if _thighs_touch(sections.at(level), sections.middle):
        return Landmark(name, place, 0.35, Message("The thighs touch under the fold: approximate."), curve)
    if edge or sharp < CREASE:
        return Landmark(name, place, 0.35, Message("No crease under the buttock: approximate."), curve)
    return Landmark(name, place, 0.7, Message("Sharpest hollow under the buttock."), curve)


def _thighs_touch(section: LowerSection, middle: float) -> bool:
    """Return whether a leg comes so near to the middle that the skin between the thighs is not known."""
    inner = [
        (SIGNS[side] * (leg[:, 0] - middle)).min() for side, leg in enumerate(section.legs) if leg is not None
    ]
    return bool(inner) and min(inner) < BETWEEN_THIGHS


def _hollow(z: Floats, depth: Floats) -> Floats:
    """Return how hollow a profile is behind, shape (k,) [1/mm], at even heights ``z``; NaN where unknown."""
    known = np.flatnonzero(np.isfinite(depth))
    if len(known) < 12:
        return np.full(len(z), np.nan)
    curve = np.stack([z[known], depth[known]], axis=1)[::-1]
    along = arc_length(curve)
    even = np.arange(0.0, along[-1], FINE)
    down, out = (smoothed(np.interp(even, along, values), FINE) for values in curve.T)
    bend = np.interp(along, even, curvature(-down, out))
    result = np.full(len(z), np.nan)
    result[known[::-1]] = bend
    return result
