"""Measures of the designer's own, taken like all others."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from core.document.custom_measures import CustomMeasurement
from core.landmarks.torso.cross_sections import trunk_levels
from core.measurements.bust import NO_MARK, over_skin, straight
from core.measurements.definitions import Measure
from core.measurements.girths import over_gaps
from core.measurements.subject import Subject
from core.measurements.tape import tape_ring
from core.messages import Message

OWN = "own:"
"""The keys of the designer's own measures are this and their name."""

NO_TRUNK = Message("The scan has no trunk at that height.")


def measure_custom(subject: Subject, own: Iterable[CustomMeasurement]) -> Iterator[Measure]:
    """Yield the measures of the designer's own."""
    for each in own:
        yield replace(_measured(subject, each), text=each.text)


def _measured(subject: Subject, own: CustomMeasurement) -> Measure:
    key = f"{OWN}{own.name}"
    if own.kind == "girth":
        return _girth(key, subject, own)
    marks = [subject.mark(name) for name in own.marks]
    return straight(key, marks) if own.kind == "straight" else over_skin(key, subject, marks)


def _girth(key: str, subject: Subject, own: CustomMeasurement) -> Measure:
    marks = [subject.mark(name) for name in own.marks]
    at = marks[0] if marks else None
    if marks and at is None:
        return Measure(key, None, "mm", confidence=0.0, note=NO_MARK)
    ground = float(at.position[2] if at else subject.mesh.vertices[:, 2].min())
    level = trunk_levels(subject.mesh, [ground + own.level])[0]
    if level.tape == 0.0:
        return Measure(key, None, "mm", confidence=0.0, note=NO_TRUNK)
    bridged, note = over_gaps(level)
    measure = Measure(key, level.tape, "mm", (tape_ring(level),), estimate=bridged, note=note)
    return replace(measure, confidence=at.confidence) if at else measure
