"""Suggestions for places that a skin does not show: iliac crest, side seam, leg opening."""

from __future__ import annotations

import numpy as np

from core.geometry.mesh import SIGNS, Points
from core.landmarks.lower_trunk.outline_profiles import crossings, heights
from core.landmarks.lower_trunk.sections import LowerSections
from core.landmarks.types import SIDES, Landmark
from core.messages import Message

STATURE = 4.3
"""Stature over the distance from crotch to under-bust [1]. Source: measured on bodies, 4.1 to 5.2."""

HIP_JOINT, FRONT_HIP, CREST = 0.055, 0.092, 0.122
"""Heights above the crotch of hip joint, front hip point and iliac crest over the stature [1].

Source: ratios of standing women.
"""

SUGGESTED = 0.3
"""The confidence of what no skin shows [1]. Ours."""

BELOW_CROTCH, ABOVE_FRONT = 6.0, 8.0
"""A leg opening runs so far below the crotch, and above half way to the front hip point [mm]. Ours."""

AROUND = 36
"""Points of a leg opening. Ours."""

SEAM_STEP = 20.0
"""Distance of the points of a side seam [mm]. Ours."""

RULES = {
    "iliac_crest": Message("By proportion: the skin does not show the bone."),
    "side_seam": Message("Frontal plane through the middle of the waist."),
    "leg_opening": Message("Curve through crotch, gluteal fold, hip joint and groin."),
}


def iliac_crest(sections: LowerSections, side: int, low: float) -> Landmark | None:
    """Return the suggested crest of a side (0 left), the crotch at ``low`` [mm]; None without a trunk."""
    z = low + CREST * STATURE * (sections.top - low)
    trunk = sections.at(z).trunk
    if trunk is None:
        return None
    place = trunk[np.argmax(SIGNS[side] * trunk[:, 0])]
    return _suggested("iliac_crest", side, np.array([place[0], place[1], z]), np.empty((0, 3)))


def side_seam(sections: LowerSections, side: int, low: float, hip: float, waist: float) -> Landmark | None:
    """Return the suggested side seam at the ``hip`` level [mm], its curve from crotch to under-bust."""
    trunk = sections.at(waist).trunk
    if trunk is None:
        return None
    y = 0.5 * float(trunk[:, 1].min() + trunk[:, 1].max())
    z = np.append(heights(low, sections.top, SEAM_STEP), hip)
    curve = []
    for height, section in zip(z.tolist(), sections.many(z.tolist()), strict=True):
        outline = section.legs[side] if section.trunk is None else section.trunk
        xs = np.empty(0) if outline is None else crossings(outline, y, axis=1)
        if len(xs):
            curve.append([xs[-1] if side == 0 else xs[0], y, height])
    if not curve or curve[-1][2] != hip:
        return None
    return _suggested("side_seam", side, np.array(curve[-1]), np.array(curve[:-1]).reshape(-1, 3))


def leg_opening(sections: LowerSections, side: int, low: float, fold: float) -> Landmark | None:
    """Return the suggested leg opening of a side: its outermost point, its closed curve as evidence.

    Its height runs evenly through four: below the crotch at ``low`` [mm] inside, the ``fold`` behind, the hip
    joint outside, half way to the front hip point in front.
    """
    leg = sections.at(low - BELOW_CROTCH).legs[side]
    if leg is None:
        return None
    stature = STATURE * (sections.top - low)
    groin = low + 0.5 * FRONT_HIP * stature + ABOVE_FRONT
    knots = [low - BELOW_CROTCH, fold, low + HIP_JOINT * stature, groin, low - BELOW_CROTCH]
    turn = 2.0 * np.pi * np.arange(AROUND) / AROUND
    quarter, share = np.divmod(4.0 * np.arange(AROUND) / AROUND, 1.0)
    eased = quarter + 0.5 - 0.5 * np.cos(np.pi * share)
    z = np.interp(eased, np.arange(5.0), knots)
    centre = 0.5 * (leg[:, :2].min(axis=0) + leg[:, :2].max(axis=0))
    out = np.stack([-SIGNS[side] * np.cos(turn), np.sin(turn)], axis=1)
    curve = []
    for way, height, section in zip(out, z.tolist(), sections.many(z.tolist()), strict=True):
        outline = section.legs[side] if section.trunk is None else section.trunk
        place = None if outline is None else _hit(outline, centre, way)
        if place is not None and SIGNS[side] * (place[0] - sections.middle) >= 0.0:
            curve.append([*place, height])
    if len(curve) < AROUND // 2:
        return None
    line = np.array([*curve, curve[0]])
    place = line[np.argmax(SIGNS[side] * line[:, 0])]
    return _suggested("leg_opening", side, place, line)


def _hit(outline: Points, centre: Points, way: Points) -> Points | None:
    """Return where a ray from ``centre`` (2,) along ``way`` (2,) leaves a closed outline, (2,) [mm]."""
    flat = outline[:, :2] - centre
    turned = np.stack([flat @ [-way[1], way[0]], flat @ way, np.zeros(len(flat))], axis=1)
    far = crossings(turned, 0.0)
    return centre + way * far[-1] if len(far) and far[-1] > 0.0 else None


def _suggested(name: str, side: int, place: Points, curve: Points) -> Landmark:
    return Landmark(f"{name}_{SIDES[side]}", place, SUGGESTED, RULES[name], curve)
