"""Suggestions of landmarks that the skin does not show: hip bones, side seams, leg openings."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
from scipy.interpolate import CubicSpline

from core.geometry.mesh import SIGNS, Points
from core.landmarks.lower_trunk.levels import Profile
from core.landmarks.lower_trunk.sections import LowerSection, LowerSections
from core.landmarks.types import SIDES, Landmark
from core.messages import Message

CREST = Message("Estimated from body height: the hip bone is not visible on the skin.")
SEAM = Message("Outermost line of the side, in the plane through the middle of the waist.")
OPENING = Message("Smooth curve through crotch, gluteal fold, hip joint and groin.")

STATURE = 4.3
"""Stature over the height from crotch to under-bust where no head is seen [1]; ours, 4.1 to 5.2."""

JOINT, CREST_HEIGHT, FRONT_POINT = 0.055, 0.122, 0.092
"""Heights of hip joint, iliac crest and front hip point over the crotch, in parts of the stature [1]: ratios
of standing women, within 15 mm.
"""

SUGGESTED = 0.2
"""How sure a suggestion is [1]; ours."""

_EVERY = 20.0
_AROUND = 72
_BELOW_CROTCH, _ABOVE_GROIN = 6.0, 8.0


def suggestions(
    sections: LowerSections, profile: Profile, points: Mapping[str, Landmark]
) -> Iterator[Landmark]:
    """Yield what the skin does not show, by side; ``points`` are the landmarks that were found."""
    stature = STATURE * (sections.top - profile.crotch)
    depth = _middle_depth(sections, points["waist"])
    for side, sign in zip(SIDES, SIGNS, strict=True):
        seam = _seam(sections, profile, depth, sign)
        hip = points["hip"].position[2]
        at = int(np.argmin(np.abs(seam[:, 2] - hip)))
        yield Landmark(f"side_seam_{side}", seam[at], SUGGESTED, SEAM, evidence=seam)
        crest = profile.crotch + CREST_HEIGHT * stature
        place = _outermost(sections.at(crest), depth, sign)
        if place is not None:
            yield Landmark(f"iliac_crest_{side}", place, SUGGESTED, CREST)
        opening = _opening(sections, profile, points, side, sign, stature)
        if len(opening):
            place = opening[np.argmax(sign * opening[:, 0])]
            yield Landmark(f"leg_opening_{side}", place, SUGGESTED, OPENING, evidence=opening)


def _middle_depth(sections: LowerSections, waist: Landmark) -> float:
    """Return y of the middle of the waist's depth [mm]."""
    outline = sections.at(float(waist.position[2])).trunk
    y = waist.position[1:2] if outline is None else outline[:, 1]
    return 0.5 * float(y.min() + y.max())


def _seam(sections: LowerSections, profile: Profile, y: float, sign: float) -> Points:
    """Return the side seam from the crotch up, (k, 3) [mm]."""
    heights = np.arange(profile.crotch + 1.0, sections.top, _EVERY)
    found = [_outermost(level, y, sign) for level in sections.many(heights)]
    return np.array([each for each in found if each is not None])


def _outermost(level: LowerSection, y: float, sign: float) -> Points | None:
    """Return the outermost place of one side in the plane at ``y`` [mm], (3,) [mm]."""
    outline = level.trunk if level.trunk is not None else level.legs[0 if sign > 0 else 1]
    if outline is None:
        return None
    a, b = outline[:, :2], np.roll(outline[:, :2], -1, axis=0)
    over = (a[:, 1] < y) != (b[:, 1] < y)
    if not over.any():
        return np.asarray(outline[np.argmax(sign * outline[:, 0])])
    part = (y - a[over, 1]) / (b[over, 1] - a[over, 1])
    x = a[over, 0] + part * (b[over, 0] - a[over, 0])
    return np.array([x[np.argmax(sign * x)], y, level.z])


def _opening(
    sections: LowerSections,
    profile: Profile,
    points: Mapping[str, Landmark],
    side: str,
    sign: float,
    stature: float,
) -> Points:
    """Return a leg opening as a closed curve, (k, 3) [mm]; empty where the skin has a hole there."""
    crotch = profile.crotch
    joint, front = crotch + JOINT * stature, crotch + FRONT_POINT * stature
    low, fold = crotch - _BELOW_CROTCH, float(points[f"gluteal_fold_{side}"].position[2])
    marks = [low, fold, joint, 0.5 * (crotch + front) + _ABOVE_GROIN, low]
    angles = np.linspace(0.0, 2.0 * np.pi, _AROUND, endpoint=False)
    heights = CubicSpline(np.linspace(0.0, 2.0 * np.pi, 5), marks, bc_type="periodic")(angles)
    leg = sections.at(low).legs[0 if sign > 0 else 1]
    if leg is None:
        return np.empty((0, 3))
    centre = 0.5 * (leg[:, :2].min(axis=0) + leg[:, :2].max(axis=0))
    ways = np.stack([-sign * np.cos(angles), np.sin(angles)], axis=1)
    curve = []
    for level, way in zip(sections.many(heights), ways, strict=True):
        outline = level.trunk if level.trunk is not None else level.legs[0 if sign > 0 else 1]
        place = None if outline is None else _along(outline, centre, way)
        if place is not None and sign * (place[0] - sections.middle) > 0.0:  # not on the other side
            curve.append([*place, level.z])
    return np.array([*curve, curve[0]]) if curve else np.empty((0, 3))


def _along(outline: Points, centre: Points, way: Points) -> Points | None:
    """Return the farthest place of an outline on a ray from ``centre`` along ``way``, (2,) [mm]."""
    a = outline[:, :2] - centre
    b = np.roll(a, -1, axis=0)
    beside = np.array([-way[1], way[0]])
    p, q = a @ beside, b @ beside
    over = (p < 0.0) != (q < 0.0)
    part = p[over] / (p[over] - q[over])
    reach = (a[over] + part[:, None] * (b[over] - a[over])) @ way
    return None if not len(reach) or reach.max() <= 0.0 else np.asarray(centre + reach.max() * way)
