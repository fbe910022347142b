"""Measurements of a body, original and reshaped, with those defined by the user."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from types import MappingProxyType
from typing import Any

import numpy as np

from core.deformation.tffd import deform
from core.document.custom_measures import CustomMeasurement
from core.geometry.mesh import Mesh, Points
from core.landmarks.torso.cross_sections import trunk_levels
from core.landmarks.types import Landmarks
from core.measurements.bust import NO_MARK, NO_ROOT, apexes, cup_measures, over_skin, straight
from core.measurements.definitions import KEYS, Measure, definition_of, missing
from core.measurements.girths import girth_measures, over_gaps, tape_ring
from core.measurements.lower_measures import lower_measures
from core.measurements.lower_trunk import lower_subjects
from core.measurements.mirrored_surface import SkinGap, mirrored_breasts
from core.measurements.subject import Subject, subject_of
from core.measurements.tracked_points import smoothed_moves
from core.messages import Message
from core.pipeline.build import Stages

OWN = "own:"
"""The keys of the designer's own measures are this and their name."""

NO_TRUNK = Message("The scan has no trunk at that height.")


Measures = Mapping[str, Measure]
"""Measures by their keys, in the order of the table of definitions; own ones come last, as "own:NAME"."""


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


def measures(mesh: Mesh, landmarks: Landmarks, own: Iterable[CustomMeasurement] = ()) -> Measures:
    """Measure a body, by key; use the smoothed skin ``body.smoothed`` of a scan.

    A measurement that the scan does not show has the value None and the reason.
    """
    return of_subject(subject_of(mesh, landmarks), own)


def before_after(stages: Stages, *region_points: Points) -> tuple[Measures, Measures]:
    """Measure the original body, and the body reshaped by the control points of its regions.

    ``region_points`` are those of each region, the bust's first, each of shape (n, 3) [mm]; regions left out
    keep their shape. The landmarks move with the skin and the levels of the bust follow them; those of the
    lower trunk stay. The lift of the apex exists only after, waist, hips and seat only with the lower trunk.
    Raises ValueError unless there are as many control points as the control meshes have.
    """
    mesh, landmarks, own = stages.body.smoothed, stages.landmarks, stages.design.own_measures
    rest, before = original_subject(mesh, landmarks), _at_rest(mesh, landmarks)
    after = reshaped_subject(rest, stages, *region_points)
    found = _with_own(before, rest, own), of_subject(after, own, rest)
    skin = mirrored_breasts(stages.body, stages.control, stages.patch)
    first, last = (
        _with_excess(each, of, skin.gap(of.mesh.vertices))
        for each, of in zip(found, (rest, after), strict=True)
    )
    if stages.lower is None:
        return first, last
    points = region_points[1] if len(region_points) > 1 else stages.lower.control.mesh.vertices
    below = lower_subjects(stages.lower, points)
    return _with_lower(first, lower_measures(below[0])), _with_lower(last, lower_measures(below[1]))


def _with_lower(found: Measures, below: Iterable[Measure]) -> Measures:
    """Return the measures with those of the lower trunk, whose waist and hip replace those of the bust."""
    whole = {**found, **{each.key: each for each in below}}
    return MappingProxyType(
        {**_ordered(whole), **{key: each for key, each in found.items() if key not in KEYS}}
    )


def _with_excess(found: Measures, subject: Subject, gap: SkinGap | None) -> Measures:
    """Return the measures with the excess volume of one breast over the mirrored other one."""
    key, height = "asymmetry_volume", found["asymmetry_height"]
    if gap is None or height.value is None:
        return found
    curves = tuple(root.closed for root in subject.roots.values()) or height.curves
    excess = Measure(key, gap.total, found[key].unit, curves, height.confidence)
    return MappingProxyType({**found, key: excess})


def of_subject(
    subject: Subject, own: Iterable[CustomMeasurement] = (), rest: Subject | None = None
) -> Measures:
    """Return what a subject measures; told who it was at ``rest``, the lift of its apex too."""
    usual = dict(_usual(subject))
    if rest is not None:
        usual["apex_lift"] = _lift(subject, rest)
    return _with_own(_ordered(usual), subject, own)


def bust_girths(stages: Stages, control_points: Points) -> tuple[float, float] | None:
    """Return the bust girth of the original body and as ``control_points`` (n, 3) reshape it [mm].

    It is that of ``before_after``, or None where the scan has no trunk at that level.
    """
    rest = original_subject(stages.body.smoothed, stages.landmarks)
    levels = [each.levels.get("bust") for each in (rest, reshaped_subject(rest, stages, control_points))]
    before, after = (level.tape if level else 0.0 for level in levels)
    return (before, after) if before and after else None


def custom_before_after(
    stages: Stages, region_points: Sequence[Points], own: CustomMeasurement
) -> tuple[Measure, Measure]:
    """Return one measure of the designer's own at rest, and reshaped by the control points of each region.

    ``region_points`` are those of ``before_after``. It need not belong to the design yet. Raises ValueError
    as ``before_after`` does.
    """
    rest = original_subject(stages.body.smoothed, stages.landmarks)
    before, after = (
        next(measure_custom(subject, (own,)))
        for subject in (rest, reshaped_subject(rest, stages, *region_points))
    )
    return before, after


@lru_cache(maxsize=2)  # while a line is dragged, the body at rest is one and the same
def original_subject(mesh: Mesh, landmarks: Landmarks) -> Subject:
    """Return who is measured, at rest: the calm skin, ``body.calm``, with its landmarks."""
    return subject_of(mesh, landmarks)


@lru_cache(maxsize=2)
def _at_rest(mesh: Mesh, landmarks: Landmarks) -> Measures:
    return _ordered(_usual(original_subject(mesh, landmarks)))


def reshaped_subject(rest: Subject, stages: Stages, *region_points: Points) -> Subject:
    """Return a subject as the control points of the regions, each (n, 3) [mm], bust first, reshape it."""
    scan, regions = stages.body.mesh.vertices, zip(stages.regions, region_points, strict=False)
    moves = sum((deform(each.binding, points) - scan for each, points in regions), np.zeros(()))
    left, right = stages.body_change(region_points[0]).tolist()
    return rest.moved(rest.mesh.vertices + smoothed_moves(stages.body, moves), (left, right))


def measure_rows(before: Measures, after: Measures | None = None) -> list[dict[str, Any]]:
    """Return a table of what was measured as plain values, one row a measure, in order.

    Each has key, title, side, unit, before, after, difference (None where one is missing), plus_minus,
    confidence, estimate, note, iso and definition. Lengths and the like are not rounded.
    """
    rows = []
    for key in after or before:
        first, last = before.get(key), after.get(key) if after else None
        told = last or first
        assert told is not None
        values = [each.value if each else None for each in (first, last)]
        both = [value for value in values if value is not None]
        title, side, iso, text = _words(told)
        rows.append(
            {
                "key": key,
                "title": title,
                "side": side,
                "unit": told.unit,
                "before": values[0],
                "after": values[1],
                "difference": both[1] - both[0] if len(both) > 1 else None,
                "plus_minus": told.plus_minus,
                "confidence": told.confidence,
                "estimate": told.estimate or bool(first and first.estimate),
                "note": told.note,
                "iso": iso,
                "definition": text,
            }
        )
    return rows


def _words(measure: Measure) -> tuple[Message | str, str, str, Message]:
    """Return title, side, name in the standard and definition of a measure."""
    if measure.key.startswith(OWN):
        return measure.key.removeprefix(OWN), "", "", measure.text
    told, side = definition_of(measure.key)
    return told.title, side, told.iso, told.text


def _usual(subject: Subject) -> Measures:
    return {each.key: each for each in (*girth_measures(subject), *cup_measures(subject))}


def _ordered(found: Measures) -> Measures:
    return {key: found[key] for key in KEYS if key in found}


def _with_own(found: Measures, subject: Subject, own: Iterable[CustomMeasurement]) -> Measures:
    return MappingProxyType({**found, **{each.key: each for each in measure_custom(subject, own)}})


def _lift(subject: Subject, rest: Subject) -> Measure:
    now, before = apexes(subject), apexes(rest)
    if now is None or before is None:
        return missing("apex_lift", NO_ROOT)
    sure = min(root.confidence for root in subject.roots.values())
    lines = tuple(np.array(pair) for pair in zip(before, now, strict=True))
    return Measure("apex_lift", float((now - before)[:, 2].mean()), "mm", lines, sure)
