"""Girths as a tape and as the skin runs, and the areas of sections."""

from __future__ import annotations

from collections.abc import Iterator

from core.landmarks.torso.cross_sections import Level
from core.landmarks.torso.girths import MUCH, confidences
from core.landmarks.types import CERTAIN
from core.measurements.definitions import Measure, missing
from core.measurements.subject import Subject
from core.measurements.tape import enclosed, skin_ring, tape_ring
from core.messages import EMPTY, Message

NAMES = ("bust", "underbust", "high_bust", "waist", "hip")

WHY = {
    "bust": Message("The scan shows no trunk at the level of the bust points."),
    "underbust": Message("The scan shows no trunk below the breasts."),
    "high_bust": Message("The scan does not show both armpits, or the arms hang too close."),
    "waist": Message("The scan shows no waist: it ends too high, or the trunk is nowhere narrower."),
    "hip": Message("The scan shows no hip: it ends above it, or the trunk does not widen."),
}
"""Why a girth may be missing."""

UNSURE_LEVEL = Message("The fold under the breast is uncertain: an estimate.")

NARROWEST = Message(
    "At the narrowest place: the waist between lowest rib and hip bone does not show, "
    "and its girth may differ by several centimetres, which the ± does not include."
)
"""What is said of the girth of the waist."""

OVER_GAPS = Message("It goes over a hole of the scan or over a joined arm: an estimate.")


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
    """Tell whether much of an outline is no skin, and say so."""
    bridged = level.bridged_mm > MUCH
    return bridged, OVER_GAPS if bridged else EMPTY
