"""Girths along the tape and along the skin, and areas of sections."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from core.geometry.mesh import Points
from core.geometry.plane_sections import Section, hull_corners, ordered_rows
from core.landmarks.torso.cross_sections import Level
from core.landmarks.torso.girths import MUCH, confidences
from core.landmarks.types import CERTAIN
from core.measurements.definitions import Measure, missing
from core.measurements.subject import Subject
from core.messages import EMPTY, Message

ROUNDED = 4
"""Ends of segments that agree to so many decimals [mm] are one place."""


NAMES = ("bust", "underbust", "high_bust", "waist", "hip")

WHY = {
    "bust": Message("The scan has no trunk at the level of the bust points."),
    "underbust": Message("The scan has no trunk below the breasts."),
    "high_bust": Message("The scan does not include both armpits, or the arms are too close to the body."),
    "waist": Message("No waist detected: the scan ends too high, or the trunk does not narrow."),
    "hip": Message("No hip detected: the scan ends above it, or the trunk does not widen."),
}
"""Why a girth may be missing."""

UNSURE_LEVEL = Message("The inframammary fold is uncertain: estimate.")

NARROWEST = Message(
    "At the narrowest level: the anatomical waist between lowest rib and hip bone is not visible, and its "
    "girth may differ by several centimetres (not included in ±)."
)
"""What is said of the girth of the waist."""

OVER_GAPS = Message("Crosses a hole in the scan or a merged arm: estimate.")


def tape_ring(level: Level) -> Points:
    """Return where a tape lies round a level, bridging hollows: a closed curve, shape (k, 3) [mm]."""
    corners = level.points[hull_corners(level.points[:, :2])]
    return np.concatenate([corners, corners[:1]])


def skin_ring(level: Level) -> Points:
    """Return the outline of a level as one closed curve, shape (k, 3) [mm]; over gaps it goes straight."""
    segments = np.concatenate([level.segments, level.bridges])
    if len(segments) == 0:
        return np.empty((0, 3))
    rounded = np.round(segments.reshape(-1, 3), ROUNDED)
    ids = np.unique(rounded, axis=0, return_inverse=True)[1].reshape(len(segments), 2)
    whole = ids[:, 0] != ids[:, 1]
    section = Section(segments[whole], ids[whole])
    pieces = [section.points[rows] for rows in ordered_rows(section)]
    if not pieces:
        return np.empty((0, 3))
    ends = np.array([[piece[0], piece[-1]] for piece in pieces])
    free, parts = np.ones((len(pieces), 1), dtype=bool), pieces[:1]
    free[0] = False
    for _ in pieces[1:]:
        # The piece whose end lies nearest to where the ring has come to goes on from there.
        away = np.where(free, np.linalg.norm(ends - parts[-1][-1], axis=2), np.inf)
        piece, turned = divmod(int(np.argmin(away)), 2)
        parts.append(pieces[piece][::-1] if turned else pieces[piece])
        free[piece] = False
    ring = np.concatenate(parts)
    return ring if np.array_equal(ring[0], ring[-1]) else np.concatenate([ring, ring[:1]])


def enclosed(ring: Points) -> float:
    """Return the area inside a closed level curve, shape (k, 3) [mm], in mm^2."""
    if len(ring) < 3:
        return 0.0
    x, y = (ring[:, :2] - ring[0, :2]).T
    return 0.5 * abs(float((x[:-1] * y[1:] - x[1:] * y[:-1]).sum()))


def girth_measures(subject: Subject) -> Iterator[Measure]:
    """Yield the girths, and what is enclosed at bust and under-bust."""
    sure = confidences(subject.landmarks)
    for name in NAMES:
        level = subject.levels.get(name)
        if level is None or level.tape == 0.0:
            yield from (missing(f"{name}_girth{kind}", WHY[name]) for kind in ("", "_skin"))
            if name in NAMES[:2]:
                yield missing(f"section_area_{name}", WHY[name])
            continue
        tape, skin = tape_ring(level), skin_ring(level)
        values = {f"{name}_girth": (level.tape, tape, "mm"), f"{name}_girth_skin": (level.skin, skin, "mm")}
        if name in NAMES[:2]:
            values[f"section_area_{name}"] = (enclosed(skin) / 100.0, skin, "cm2")
        bridged, note = over_gaps(level)
        unsure = name == "underbust" and sure.get(name, 1.0) < CERTAIN
        note = note or (UNSURE_LEVEL if unsure else NARROWEST if name == "waist" else note)
        for key, (value, ring, unit) in values.items():
            yield Measure(key, value, unit, (ring,), sure.get(name, 1.0), bridged or unsure, note=note)


def over_gaps(level: Level) -> tuple[bool, Message]:
    """Return whether much of an outline crosses gaps, with a warning."""
    bridged = level.bridged_mm > MUCH
    return bridged, OVER_GAPS if bridged else EMPTY
