"""All values of a solved design that have an uncertainty, read off one body."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from core.deformation.tffd import deform
from core.garment.band_path import band_paths
from core.garment.pressure import band_pressure
from core.garment.tension import LineTension, line_tensions, mean_elongation
from core.geometry.mesh import Floats, Mesh, Points
from core.measurements.definitions import Measure
from core.measurements.lower_measures import REPLACED
from core.measurements.subject import Subject, subject_of
from core.measurements.table import Measures, of_subject
from core.measurements.tracked_points import smoothed_moves
from core.measurements.uncertain_value import (
    AFTER,
    BEFORE,
    CHANGE,
    CUT,
    LIFT,
    MAX_KPA,
    MEAN_KPA,
    OUT,
    TENSION,
)
from core.pipeline.build import Stages
from core.pipeline.stages import RegionStages
from core.scan.body import Body

Figures = dict[str, float]
"""Figures by key, see ``core.measurements.uncertain_value``."""


@dataclass(frozen=True, eq=False)
class OriginalMeasurements:
    """A body at rest that is measured again and again: ``subject``, and what was measured ``before``."""

    subject: Subject
    before: Mapping[str, Measure]


@dataclass(frozen=True)
class Steps:
    """How far under the breasts the under-bust is measured before and after [mm].

    The rule goes down in steps until no breast is nicked. A hair decides between two steps; what is told here
    is how sure the girth is at the one that was taken.
    """

    before: float | None
    after: float | None


def under_bust_steps(rest: Subject, after: Subject) -> Steps:
    """Return the steps that a body takes by the rule."""
    return Steps(*(each.landmarks.underbust_level - each.levels["underbust"].z for each in (rest, after)))


def original_measurements(
    stages: Stages, steps: Steps, subject: Subject | None = None, skin: float = 0.0
) -> OriginalMeasurements:
    """Return the body of a design at rest, its skin so much further out [mm]."""
    subject = subject or replace(subject_of(stages.body.smoothed, stages.landmarks), down=steps.before)
    shown = subject
    if skin:
        mesh = subject.mesh
        shown = subject.moved(mesh.vertices + skin * mesh.vertex_normals, (0.0, 0.0))
    return OriginalMeasurements(subject, _measured(stages, shown))


def original_values(rest: OriginalMeasurements) -> Figures:
    """Return the measures of a body that wears nothing: before and after are the same, and no change is."""
    return {**_values(BEFORE, rest.before), **_values(AFTER, rest.before)}


def measurement_values(
    stages: Stages, steps: Steps, rest: OriginalMeasurements, points: Points, skin: float = 0.0
) -> Figures:
    """Return measures before and after with their change, and how the bust points moved [mm].

    ``points`` (n, 3) [mm] are the control points; ``skin`` [mm] is how much further out all skin lies.
    """
    places = deform(stages.binding, points)
    vertices = rest.subject.mesh.vertices + smoothed_moves(stages.body, places - stages.body.mesh.vertices)
    if skin:
        vertices = vertices + skin * Mesh(vertices, rest.subject.mesh.faces).vertex_normals
    left, right = stages.body_change(points).tolist()
    worn = replace(rest.subject, down=steps.after).moved(vertices, (left, right))
    after = _measured(stages, worn, rest.subject)
    before, now = _values(BEFORE, rest.before), _values(AFTER, after)
    changes = {
        f"{CHANGE}:{key}": now[f"{AFTER}:{key}"] - before[f"{BEFORE}:{key}"]
        for key in after
        if f"{AFTER}:{key}" in now and f"{BEFORE}:{key}" in before
    }
    return {**before, **now, **changes, **bust_values(stages, points)}


def bust_values(stages: Stages, points: Points) -> Figures:
    """Return how far the bust points rose and came forward [mm], both and each."""
    moves = stages.watch.bust_points(points) - stages.watch.bust_points(stages.control.mesh.vertices)
    found: Figures = {}
    for what, ways in ((LIFT, moves[:, 2]), (OUT, -moves[:, 1])):
        found |= {what: float(ways.mean()), f"{what} left": float(ways[0]), f"{what} right": float(ways[1])}
    return found


def line_values(
    stages: RegionStages, points: Points, tensions: Mapping[str, LineTension], ratios: Mapping[str, float]
) -> Figures:
    """Return what is told of worn lines: lengths to cut [mm], tensions [N] and pressures [kPa].

    ``ratios`` are the lengths that are meant to be cut, whatever comes of cutting them.
    """
    found: Figures = {f"{TENSION}:{name}": each.mean for name, each in tensions.items()}
    elastics, held = stages.design.active_elastics(), stages.design.line_hold == "held"
    for line in stages.model.lines:
        if line.name in elastics:
            elastic, reached = elastics[line.name], line.length(points)
            natural = ratios[line.name] * line.rest_length
            elongation = mean_elongation(stages, elastic, tensions.get(line.name), reached / natural - 1.0)
            if held and line.name in tensions:
                elongation = elastic.elongation(tensions[line.name].mean)
                natural = reached / (1.0 + elongation)
            back = line.back_length / (1.0 + elongation)
            found[f"{CUT}:{line.name}"] = natural + back + elastic.allowance_mm
    for name, course, width in band_paths(stages, points, tensions):
        pressed = band_pressure(course, width)
        found[f"{MEAN_KPA}:{name}"], found[f"{MAX_KPA}:{name}"] = pressed.mean, pressed.largest
    return found


def output_values(stages: Stages, points: Points) -> Figures:
    """Return all but the measures of a design as it is solved to control ``points``, shape (n, 3) [mm]."""
    ratios = {line.name: stages.design.ratio(line.name) for line in stages.model.lines}
    return {
        **bust_values(stages, points),
        **line_values(stages, points, line_tensions(stages, points), ratios),
    }


def skin_normals(stages: Stages, points: Points) -> Points:
    """Return the normals of the reshaped body, shape (n, 3) [1]."""
    return Mesh(deform(stages.binding, points), stages.body.mesh.faces).vertex_normals


def normal_distance(body: Body, one: Points, other: Points, normals: Points) -> Floats:
    """Return how far ``one`` lies beyond ``other``, both (n, 3) [mm], along ``normals``, shape (n,) [mm]."""
    return np.asarray(np.einsum("ij,ij->i", one - other, normals))


def _measured(stages: Stages, subject: Subject, rest: Subject | None = None) -> Measures:
    """Return the measures of the bust; those that the lower trunk replaces have no uncertainty."""
    found = of_subject(subject, stages.design.own_measures, rest)
    return found if stages.lower is None else {key: found[key] for key in found if key not in REPLACED}


def _values(kind: str, measured: Mapping[str, Measure]) -> Figures:
    return {f"{kind}:{key}": each.value for key, each in measured.items() if each.value is not None}
