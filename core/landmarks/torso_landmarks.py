"""Landmarks of the trunk: centre lines, sides, armpits, waist, hip and neck, those that the scan shows."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import gaussian_filter1d

from core.geometry.mesh import SIGNS, Flags, Floats, Mesh, Points
from core.geometry.plane_sections import arc_length, curvature, cut, join_segments, resample
from core.landmarks.bust_point import ACROSS
from core.landmarks.torso.cross_sections import Level, stable_level, trunk_levels
from core.landmarks.torso.torso_axis import STEP, TorsoAxis, torso_axis
from core.landmarks.types import SIDES, Landmark, Landmarks
from core.messages import Message

FRONT = Message("On the front centre line, midway between the bust points, at bust level.")
FRONT_UNDER = Message("On the front centre line, midway between the bust points, at under-bust level.")
BACK = Message("In the spinal groove at bust level.")
BACK_UNDER = Message("In the spinal groove at under-bust level.")
FLAT_BACK = Message("Midway between the sides of the back: no spinal groove detected.")
SIDE = Message("Outermost point of the trunk at the side, at the height of the under-bust girth.")
ARMPIT = Message("At the side of the trunk, at the highest level where the arm is separate from the trunk.")
WAIST = Message(
    "On the front centre line, at the narrowest level of the trunk below the bust. The anatomical waist "
    "between lowest rib and hip bone is not detectable and may be a few cm lower."
)
HIP = Message("On the front centre line, at the largest trunk girth below the waist.")
NECK_FRONT = Message("Deepest point of the front centre line between chest and neck.")
NECK_BACK = Message("Most prominent point of the back centre line at the base of the neck.")

CLEAR, PLAIN = 0.8, 0.4
"""How sure a mark is that shows clearly, and one that hardly shows (0..1): our judgement."""

EVEN = 4.0
"""The bust points lie so evenly about the middle of the trunk [mm]; twice that more, and a third is left."""


def torso_landmarks(mesh: Mesh, found: Landmarks) -> list[Landmark]:
    """Return the landmarks of the trunk round the bust landmarks ``found``. Source: ours."""
    guide = torso_axis(mesh)
    left, right = (found.position(f"bust_point_{side}") for side in SIDES)
    middle = 0.5 * float(left[0] + right[0])
    tape = np.where(guide.tape > 0.0, guide.tape, np.nan)
    heights = [found.underbust_level, found.bust_level]
    levels = dict(zip(("_underbust", ""), trunk_levels(mesh, heights), strict=True))
    stable = stable_level(mesh, found.underbust_level)
    aside = abs(middle - float(guide.centre_at(stable.z)[0]))
    marks = _fronts(mesh, levels, middle, _level_confidence(found, aside))
    marks += [_back(mesh, guide, level, name) for name, level in levels.items()]
    marks += [_side(guide, stable, name, sign) for name, sign in zip(SIDES, SIGNS, strict=True)]
    marks += [_armpit(mesh, guide, found, s) for s in (0, 1)]
    waist = _waist(guide, tape, found)
    if waist is not None:
        marks.append(_girdle(mesh, guide, *waist, "waist_front", WAIST))
        hip = _hip(guide, tape, waist[0])
        if hip is not None:
            marks.append(_girdle(mesh, guide, *hip, "hip_front", HIP))
    marks += _neck(mesh, guide, tape, found, middle)
    return [mark for mark in marks if mark is not None]


def _line(mesh: Mesh, x: float, low: float, high: float, back: bool, split: float) -> Points:
    """Return the upright line of skin at ``x`` between two heights [mm], shape (k, 3) [mm]; empty for none.

    It lies in front of y = ``split`` [mm], or at the ``back`` of it.
    """
    across = np.stack([mesh.vertices[corner, 0] for corner in mesh.faces.T])
    crossed = (across.min(axis=0) <= x) & (across.max(axis=0) >= x)
    pieces = join_segments(cut(Mesh(mesh.vertices, mesh.faces[crossed]), (x, 0.0, 0.0), (1.0, 0.0, 0.0)))
    best = np.empty((0, 3))
    for curve, _ in pieces:
        own = (curve[:, 2] >= low) & (curve[:, 2] <= high) & ((curve[:, 1] > split) == back)
        runs = np.split(np.arange(len(curve)), np.flatnonzero(np.diff(own.astype(int))) + 1)
        for run in runs:
            part = curve[run]
            if (
                own[run[0]]
                and len(part) > 1
                and np.ptp(part[:, 2]) > np.ptp(best[:, 2] if len(best) else [0.0])
            ):
                best = part
    return best


def _at(line: Points, z: float) -> Points | None:
    """Return the place of an upright line nearest to height ``z``, shape (3,) [mm]; None if it is far."""
    if len(line) < 2:
        return None
    fine = resample(line, 1.0)
    best = int(np.argmin(np.abs(fine[:, 2] - z)))
    return fine[best] if abs(fine[best, 2] - z) < 1.5 else None


def _split(level: Level) -> float:
    return 0.5 * float(level.points[:, 1].min() + level.points[:, 1].max()) if len(level.points) else 0.0


def _level_confidence(found: Landmarks, aside: float) -> dict[str, float]:
    """Return how sure the centres of the front are: as the points that they were taken from.

    The middle of the bust points may lie ``aside`` of that of the trunk [mm].
    """
    low = [mark for name, mark in found.points.items() if name.startswith(("fold", "lowest"))]
    deepest = min(low, key=lambda mark: float(mark.position[2]), default=None)
    busts = [found.points[f"bust_point_{side}"] for side in SIDES]
    own = [mark.confidence for mark in busts if mark.rule != ACROSS]  # that one only mirrors the other
    even = float(np.exp(-max(aside - EVEN, 0.0) / (2.0 * EVEN)))
    return {"": even * min(own, default=0.0), "_underbust": even * (deepest.confidence if deepest else 1.0)}


def _fronts(
    mesh: Mesh, levels: dict[str, Level], middle: float, sure: dict[str, float]
) -> list[Landmark | None]:
    under, bust = levels["_underbust"], levels[""]
    line = _line(mesh, middle, under.z - 20.0, bust.z + 60.0, False, _split(bust))
    marks: list[Landmark | None] = []
    for name, level, rule in (("", bust, FRONT), ("_underbust", under, FRONT_UNDER)):
        place = _at(line, level.z)
        if place is not None:
            marks.append(Landmark(f"front_centre{name}", place, min(CLEAR, sure[name]), rule, line))
    return marks


def _back(mesh: Mesh, guide: TorsoAxis, level: Level, name: str) -> Landmark | None:
    """Return the back centre on one level: in the hollow of the spine, near the middle of the trunk."""
    points = level.segments.reshape(-1, 3)
    if len(points) < 40:
        return None
    centre = float(guide.centre_at(level.z)[0])
    x = np.arange(-45.0, 45.5, 1.0)
    behind = points[(points[:, 1] > _split(level)) & (np.abs(points[:, 0] - centre) < 60.0)]
    behind = behind[np.argsort(behind[:, 0])]
    if len(behind) < 12 or behind[0, 0] > centre - 45.0 or behind[-1, 0] < centre + 45.0:
        return None
    y = gaussian_filter1d(np.interp(centre + x, behind[:, 0], behind[:, 1]), 4.0, mode="nearest")
    ridge = np.minimum(np.maximum.accumulate(y), np.maximum.accumulate(y[::-1])[::-1])
    depth = ridge - y - 0.02 * np.abs(x)
    best = int(np.argmax(depth))
    hollow = depth[best] > 1.0 and abs(x[best]) < 30.0
    at = centre + (float(x[best]) if hollow else 0.0)
    line = _line(mesh, at, level.z - 60.0, level.z + 60.0, True, _split(level))
    place = _at(line, level.z)
    if place is None:
        return None
    sure = PLAIN + (CLEAR - PLAIN) * float(np.clip((depth[best] - 1.0) / 5.0, 0.0, 1.0)) if hollow else PLAIN
    rule = (BACK_UNDER if name else BACK) if hollow else FLAT_BACK
    return Landmark(f"back_centre{name}", place, sure, rule, line)


def _side(guide: TorsoAxis, level: Level, name: str, sign: float) -> Landmark | None:
    points = level.segments.reshape(-1, 3)
    if len(points) < 40:
        return None
    centre = float(guide.centre_at(level.z)[0])
    out = sign * (points[:, 0] - centre)
    reach = float((sign * (level.points[:, 0] - centre)).max())
    if out.max() < reach - 2.0:
        return None
    flat = points[out > out.max() - 0.5]
    best = flat[int(np.argmin(np.abs(flat[:, 1] - np.median(flat[:, 1]))))]
    spread = float(np.ptp(flat[:, 1]))
    near = points[out > out.max() - 25.0]
    curve = near[np.argsort(near[:, 1])]
    return Landmark(f"side_{name}", best, CLEAR * float(np.exp(-max(spread - 15.0, 0.0) / 40.0)), SIDE, curve)


def _armpit(mesh: Mesh, guide: TorsoAxis, found: Landmarks, s: int) -> Landmark | None:
    """Return the armpit of one side: under the levels that an arm joins, up to the shoulder."""
    joined = guide.cut[:, s] & guide.shown & (guide.z > found.underbust_level)
    above = np.flatnonzero(joined & (guide.z > found.bust_level - 60.0))
    if len(above) == 0:
        return None
    k = int(above[0]) - 1
    if k < 1 or not guide.shown[k] or guide.z[k] > found.bust_level + 220.0:
        return None
    sign = SIGNS[s]
    level = trunk_levels(mesh, [float(guide.z[k])])[0]
    points = level.segments.reshape(-1, 3)
    if len(points) < 40:
        return None
    out = sign * (points[:, 0] - guide.centre[k, 0])
    best = points[int(np.argmax(out))]
    near = points[out > out.max() - 30.0]
    apart = bool((np.abs(guide.limb_level - k) <= 4).any())
    sure = (CLEAR if apart else PLAIN) * (1.0 if guide.z[k] > found.bust_level else 0.5)
    return Landmark(f"armpit_{SIDES[s]}", best, sure, ARMPIT, near[np.argsort(near[:, 1])])


def _waist(guide: TorsoAxis, tape: Floats, found: Landmarks) -> tuple[float, float] | None:
    """Return height [mm] and confidence of the natural waist; None if the scan ends above it."""
    low, high = found.underbust_level - 260.0, found.underbust_level - 20.0
    return _extreme(guide, -tape, (guide.z > low) & (guide.z < high), 4.0)


def _hip(guide: TorsoAxis, tape: Floats, waist: float) -> tuple[float, float] | None:
    """Return height [mm] and confidence of the hip; None if the scan ends above it."""
    return _extreme(guide, tape, (guide.z > waist - 320.0) & (guide.z < waist - 40.0), 4.0)


def _extreme(guide: TorsoAxis, value: Floats, inside: Flags, clear: float) -> tuple[float, float] | None:
    """Return height and confidence of the highest ``value`` with lower ones on both sides of it."""
    rows = np.flatnonzero(inside & np.isfinite(value))
    if len(rows) < 9 or (np.diff(rows) > 3).any():
        return None
    calm = gaussian_filter1d(value[rows], 7.0 / STEP, mode="nearest")
    best = int(np.argmax(calm))
    fall = min(calm[best] - calm[: best + 1].min(), calm[best] - calm[best:].min())
    if best < 2 or best > len(rows) - 3 or fall < 1.0:
        return None
    a, b, c = calm[best - 1 : best + 2]
    shift = 0.5 * (a - c) / min(a - 2.0 * b + c, -1e-9)
    return float(guide.z[rows[best]] + STEP * np.clip(shift, -1.0, 1.0)), 0.3 + 0.5 * min(fall / clear, 1.0)


def _girdle(
    mesh: Mesh, guide: TorsoAxis, z: float, confidence: float, name: str, rule: Message
) -> Landmark | None:
    """Return the centre front at height ``z`` [mm]; its evidence is the front of the outline there."""
    level = trunk_levels(mesh, [z])[0]
    points = level.segments.reshape(-1, 3)
    front = points[points[:, 1] < _split(level)] if len(points) else points
    if len(front) < 20:
        return None
    front = front[np.argsort(front[:, 0])]
    centre = guide.centre_at(z)[0]
    nearest = int(np.argmin(np.abs(front[:, 0] - centre)))
    if abs(front[nearest, 0] - centre) > 8.0:
        return None
    sure = confidence * float(np.exp(-level.bridged_mm / 200.0))
    return Landmark(name, front[nearest], sure, rule, front)


def _neck(
    mesh: Mesh, guide: TorsoAxis, tape: Floats, found: Landmarks, middle: float
) -> list[Landmark | None]:
    """Return the foot of the neck in front and behind, if the scan shows a neck under a head."""
    rows = np.flatnonzero((guide.z > found.bust_level + 120.0) & np.isfinite(tape))
    if len(rows) < 12:
        return []
    over = np.maximum.accumulate(tape[rows][::-1])[::-1]
    under_head = rows[over > tape[rows] + 60.0]
    if len(under_head) == 0:
        return []
    slim = under_head[int(np.argmin(tape[under_head]))]
    if not 220.0 < tape[slim] < 560.0:
        return []
    z, split = float(guide.z[slim]), float(guide.centre[slim, 1])
    marks: list[Landmark | None] = []
    for name, back, rule in (("neck_front", False, NECK_FRONT), ("neck_back", True, NECK_BACK)):
        line = _line(mesh, middle, z - 120.0, z + 10.0, back, split)
        marks.append(_foot(line, z, name, back, rule))
    return marks


def _foot(line: Points, z: float, name: str, back: bool, rule: Message) -> Landmark | None:
    if len(line) < 10 or arc_length(line)[-1] < 80.0:
        return None
    line = line if line[0, 2] > line[-1, 2] else line[::-1]
    even = resample(line, 1.0)
    y, height = gaussian_filter1d(even[:, 1:].T, 8.0, mode="nearest")
    bend = curvature(height, y)
    allowed = (even[:, 2] < z - 5.0) & (even[:, 2] > z - 100.0)
    allowed[:10] = allowed[-10:] = False
    if not allowed.any():
        return None
    best = int(np.argmax(np.where(allowed, bend, -np.inf)))
    sure = 0.3 * float(np.clip(bend[best] / 0.01, 0.0, 1.0))
    return Landmark(name, even[best], sure, rule, line)
