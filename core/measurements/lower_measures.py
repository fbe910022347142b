"""Measurements of waist, hips and seat, taken from the lower trunk."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from core.geometry.mesh import Mesh, Points
from core.geometry.plane_sections import (
    arc_length,
    cut,
    downward,
    hull_corners,
    hull_perimeter,
    join_segments,
)
from core.landmarks.lower_trunk.girths import MARKS, lower_girths
from core.landmarks.lower_trunk.outline_profiles import back
from core.landmarks.lower_trunk.seat import NOT_SHOWN
from core.landmarks.lower_trunk.sections import SHIFT
from core.landmarks.torso.girths import MUCH, Girth
from core.landmarks.types import CERTAIN, SIDES
from core.measurements.definitions import Measure, missing
from core.measurements.girths import NARROWEST, OVER_GAPS
from core.measurements.lower_trunk import LowerSubject
from core.messages import EMPTY, Message

NO_LEVEL = Message("The scan has no trunk at this level.")
NO_THIGH = Message("The scan ends above this level of the thigh.")
NO_MIDLINE = Message("The scan has a hole on the midline between waist and crotch.")

BUTTOCKS = tuple(f"buttock_{side}" for side in SIDES)
HIGH_HIP = "high_hip"
GIRTH_MARKS: Mapping[str, tuple[str, ...]] = {
    **MARKS,
    HIGH_HIP: ("waist", *BUTTOCKS),
    **{f"thigh_{side}": (f"gluteal_fold_{side}", "crotch") for side in SIDES},
}
"""The girths of the lower trunk, and the landmarks that their heights come from."""

OUTLINED = ("waist", "hip")
"""Girths that are measured along the skin too."""

REPLACED = tuple(f"{name}_girth{kind}" for name in OUTLINED for kind in ("", "_skin"))
"""The measures of the trunk that are taken at the landmarks of the lower trunk where the design has it."""

NEAR_CROTCH = 10.0
"""The midline of the skin passes the crotch no further away than this [mm]. Ours."""


def lower_measures(subject: LowerSubject) -> Iterator[Measure]:
    """Yield what is measured on waist, hips and seat; what the scan does not show has the reason."""
    girths = _girths(subject)
    for name in GIRTH_MARKS:
        yield from _girth(subject, name, girths.get(name))
    yield from _waist_and_hip(subject, girths)
    yield _crotch_length(subject)
    yield _protrusion(subject)
    for at, side in enumerate(SIDES):
        yield _fold_height(subject, side)
        yield _seat_volume(subject, at)


def _girths(subject: LowerSubject) -> Mapping[str, Girth]:
    """Return the girths by name that the scan shows, with that of the high hip."""
    found = dict(lower_girths(subject.sections, subject.landmarks))
    section = subject.sections.at(subject.high_hip)
    if section.trunk is not None:
        tape = hull_perimeter(section.trunk)
        found[HIGH_HIP] = Girth(subject.high_hip, tape, 0.0, section.bridged)
    return found


def _girth(subject: LowerSubject, name: str, girth: Girth | None) -> Iterator[Measure]:
    part, _, side = name.partition("_") if name.startswith("thigh") else (name, "", "")
    key = f"{part}_girth" + (f"_{side}" if side else "")
    keys = (key, f"{key}_skin") if name in OUTLINED else (key,)
    if girth is None:
        yield from (missing(each, NO_THIGH if side else NO_LEVEL) for each in keys)
        return
    section = subject.sections.at(girth.level_mm)
    outline = section.legs[SIDES.index(side)] if side else section.trunk
    assert outline is not None
    tape = outline[hull_corners(outline[:, :2])]
    note = OVER_GAPS if girth.bridged_mm > MUCH else NARROWEST if name == "waist" else EMPTY
    for each, value, ring in zip(keys, (girth.tape_mm, girth.skin_mm), (tape, outline), strict=False):
        curve = np.concatenate([ring, ring[:1]])
        yield _measure(subject, each, value, (curve,), GIRTH_MARKS[name], note)


def _waist_and_hip(subject: LowerSubject, girths: Mapping[str, Girth]) -> Iterator[Measure]:
    """Yield the ratio of waist and hip girth, and the height between them."""
    marks, keys = ("waist", "hip"), ("waist_hip_ratio", "waist_to_hip")
    if any(name not in girths for name in marks):
        yield from (missing(key, NO_LEVEL) for key in keys)
        return
    rings = tuple(ring for name in marks for ring in next(_girth(subject, name, girths[name])).curves)
    waist, hip = (girths[name] for name in marks)
    yield _measure(subject, keys[0], waist.tape_mm / hip.tape_mm, rings, marks)
    top = subject.places["waist"]
    line = np.array([[*top[:2], waist.level_mm], [*top[:2], hip.level_mm]])
    yield _measure(subject, keys[1], waist.level_mm - hip.level_mm, (line,), marks)


def _crotch_length(subject: LowerSubject) -> Measure:
    key, level = "crotch_length", subject.landmarks.levels["waist"]
    middle = np.array([subject.sections.middle, 0.0, level])
    curve = midline_curve(subject.sections.mesh, subject.places["crotch"], middle)
    if curve is None:
        return missing(key, NO_MIDLINE)
    return _measure(subject, key, _length(curve), (curve,), ("waist", "crotch"))


def midline_curve(mesh: Mesh, crotch: Points, middle: Points) -> Points | None:
    """Return the skin's midline from the level of ``middle`` in front through ``crotch`` to it behind.

    Shape (k, 3) [mm]; both places have shape (3,) [mm]. The plane of the curve contains both and runs
    straight from front to back. None where the skin is open on the way.
    """
    normal = np.array([middle[2] - crotch[2], 0.0, crotch[0] - middle[0]])
    normal /= np.linalg.norm(normal)
    away, least = np.inf, None
    for curve, closed in join_segments(cut(mesh, crotch + SHIFT * normal, normal)):
        apart = np.linalg.norm(curve - crotch, axis=1)
        if apart.min() < away:
            away, least = float(apart.min()), (curve, closed, int(apart.argmin()))
    if least is None or away > NEAR_CROTCH:
        return None
    ways = [way for way in (_up_to(way, float(middle[2])) for way in downward(*least)) if way is not None]
    if len(ways) < 2:
        return None
    front, behind = sorted(ways, key=lambda way: float(way[-1, 1]))
    return np.concatenate([front[::-1], behind[1:]])


def _up_to(way: Points, level: float) -> Points | None:
    """Return a curve, (k, 3) [mm], up to where it first reaches a height [mm]; None if it does not."""
    above = np.flatnonzero(way[:, 2] >= level)
    if not len(above) or above[0] == 0:
        return None
    low, high = way[above[0] - 1], way[above[0]]
    end = low + (level - low[2]) / (high[2] - low[2]) * (high - low)
    return np.concatenate([way[: above[0]], end[None]])


def _protrusion(subject: LowerSubject) -> Measure:
    level, middle = subject.landmarks.levels["waist"], subject.sections.middle
    (behind,) = back([subject.sections.at(level)], np.array([middle]), 0)[0]
    if not np.isfinite(behind):
        return missing("seat_protrusion", NO_LEVEL)
    tips = [subject.places[name] for name in BUTTOCKS]
    lines = tuple(np.array([[tip[0], behind, tip[2]], tip]) for tip in tips)
    out = float(np.mean([tip[1] for tip in tips])) - float(behind)
    return _measure(subject, "seat_protrusion", out, lines, ("waist", *BUTTOCKS))


def _fold_height(subject: LowerSubject, side: str) -> Measure:
    name, key = f"gluteal_fold_{side}", f"gluteal_fold_height_{side}"
    mark = subject.landmarks.points[name]
    if mark.rule == NOT_SHOWN:
        return missing(key, NOT_SHOWN)
    fold, crotch = subject.places[name], subject.places["crotch"]
    line = np.array([[*fold[:2], crotch[2]], fold])
    return _measure(subject, key, float(fold[2] - crotch[2]), (line,), (name, "crotch"))


def _seat_volume(subject: LowerSubject, at: int) -> Measure:
    """Return the volume of a seat; shown by the horizontal section through its buttock point."""
    tip, side = subject.places[BUTTOCKS[at]], SIDES[at]
    trunk = subject.sections.at(float(tip[2])).trunk
    if trunk is None:
        return missing(f"seat_volume_{side}", NO_LEVEL)
    own = trunk[((trunk[:, 0] > subject.sections.middle) == (at == 0)) & (trunk[:, 1] > trunk[:, 1].mean())]
    marks = ("waist", BUTTOCKS[at], f"gluteal_fold_{side}", "crotch")
    return _measure(subject, f"seat_volume_{side}", float(subject.seat[at]), (own,), marks)


def _measure(
    subject: LowerSubject,
    key: str,
    value: float,
    curves: tuple[Points, ...],
    marks: Sequence[str],
    note: Message = EMPTY,
) -> Measure:
    """Return a measure that rests on landmarks: an estimate where one of them is uncertain, by its rule."""
    least = min((subject.landmarks.points[name] for name in marks), key=lambda mark: mark.confidence)
    unsure = least.confidence < CERTAIN
    unit = missing(key, EMPTY).unit
    estimate = unsure or note == OVER_GAPS
    return Measure(key, value, unit, curves, least.confidence, estimate, note=least.rule if unsure else note)


def _length(curve: Points) -> float:
    return float(arc_length(curve)[-1])
