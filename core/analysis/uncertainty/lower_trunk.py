"""Uncertainty of waist, hips and seat: what lines, tissue, scan and landmarks do to the lower trunk.

Lines and tissue go through the linear system of the region's equilibrium. Where a landmark is off the control
mesh of the region is fitted anew, to one side. The error of the model itself is not known here: no reference
was computed for it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np

from core.analysis.uncertainty.input_uncertainty import InputUncertainty
from core.analysis.uncertainty.line_response import LineResponse
from core.analysis.uncertainty.linear_propagation import Effect
from core.analysis.uncertainty.outputs import Figures, line_values
from core.analysis.uncertainty.parameters import UPRIGHT, UncertainParameter, line_parameters
from core.deformation.tffd import deform
from core.errors import UserError
from core.garment.tension import line_tensions
from core.geometry.mesh import Floats, Mesh, Points
from core.landmarks.lower_trunk.sections import LowerSections
from core.landmarks.manual import in_file
from core.landmarks.types import SIDES
from core.measurements.lower_measures import lower_measures
from core.measurements.lower_trunk import LowerSubject, lower_subjects
from core.measurements.uncertain_value import AFTER, BEFORE, CHANGE, LANDMARKS, SCAN
from core.pipeline.build import Stages
from core.pipeline.lower_region import LowerStages, lower_stages
from core.pipeline.solve import exact_solution
from core.pipeline.stages import StageCache
from core.progress import quiet

OF_THE_LEVELS = ("waist", "belly", "hip", "crotch")
"""The landmarks of the midline whose heights the control mesh and the girths follow."""

NAMES = (*OF_THE_LEVELS, *(f"{kind}_{side}" for kind in ("buttock", "gluteal_fold") for side in SIDES))
"""All landmarks of the lower trunk that have knobs, each in height."""


class LowerPropagation:
    """The lower trunk of solved ``stages``, and what its knobs do to it. Raises NoEquilibriumError.

    A run of the conventional control leaves less volume than the equilibrium that this is told of.
    """

    def __init__(self, stages: Stages, assumed: InputUncertainty) -> None:
        assert stages.lower is not None
        self._stages, self._assumed, self._region = stages, assumed, stages.lower
        self._lines = LineResponse(self._region, exact_solution(self._region))
        self.points = self._lines.points
        places = deform(self._region.binding, self.points)
        self._places, self._normals = places, Mesh(places, stages.body.mesh.faces).vertex_normals
        self.values = self._read(self._region, self.points)

    @property
    def knobs(self) -> tuple[UncertainParameter, ...]:
        """Return what may be off, the landmarks last."""
        assumed, marks = self._assumed, self._region.landmarks.points
        found = [
            *line_parameters(self._region, assumed),
            UncertainParameter(SCAN, assumed.skin_mm),
            *(
                UncertainParameter(LANDMARKS, assumed.of_landmark(marks[name]), name, UPRIGHT)
                for name in NAMES
            ),
        ]
        return tuple(knob for knob in found if knob.sd > 0.0)

    def effect(self, knob: UncertainParameter) -> Effect | None:
        """Return what a knob does, None if there is no fit with it."""
        if knob.source == SCAN:
            return self._of_scan(knob)
        return self._of_landmark(knob) if knob.source == LANDMARKS else self._of_lines(knob)

    def _of_lines(self, knob: UncertainParameter) -> Effect:
        sides = list(self._lines.sides(knob))
        low, high = (
            line_values(side.stages, side.points, side.tensions, self._lines.meant)
            | measures(self._region, side.points)
            for side in sides
        )
        places = [deform(self._region.binding, side.points) for side in sides]
        return Effect(knob, _difference(low, high, 2.0), self._along(places[1] - places[0]) / 2.0)

    def _of_scan(self, knob: UncertainParameter) -> Effect:
        low, high = (measures(self._region, self.points, skin) for skin in (-knob.sd, knob.sd))
        return Effect(knob, _difference(low, high, 2.0), np.zeros(len(self._places)))

    def _of_landmark(self, knob: UncertainParameter) -> Effect | None:
        assert knob.direction is not None
        region = self._fitted_with(knob.name, knob.sd * knob.direction)
        if region is None:
            return None
        try:
            points = exact_solution(region).place.points
        except UserError:
            return None
        away = deform(region.binding, points) - self._places
        return Effect(knob, _difference(self.values, self._read(region, points), 1.0), self._along(away))

    def _fitted_with(self, name: str, away: Points) -> LowerStages | None:
        """Return the region with a landmark ``away`` (3,) [mm] from where it is, None if it cannot be had."""
        stages, place = self._stages, self._region.landmarks.position(name) + away
        design = stages.design.with_placed(name, in_file(place, stages.body.pose.file_to_mm))
        assert design.lower is not None
        made = design.lower_design, design.lower, stages.body, stages.landmarks, stages.fitted
        region = lower_stages(StageCache(stages, quiet), *made)
        return None if isinstance(region, UserError) else region

    def _read(self, region: LowerStages, points: Points) -> Figures:
        """Return measures and lines of the region as it is fitted, and its lines are set."""
        tensions = line_tensions(region, points)
        return line_values(region, points, tensions, self._lines.meant) | measures(region, points)

    def _along(self, moves: Points) -> Floats:
        """Return how far moves (n, 3) go along the normals of the reshaped body, (n,) [mm]."""
        return np.asarray(np.einsum("ij,ij->i", moves, self._normals))


def measures(region: LowerStages, points: Points, skin: float = 0.0) -> Figures:
    """Return the measures of the lower trunk before, after and their change, by key.

    ``points`` (n, 3) [mm] are its control points, ``skin`` [mm] is how much further out all skin lies.
    """
    shapes = lower_subjects(region, points)
    if skin:
        shapes = _further_out(shapes[0], skin), _further_out(shapes[1], skin)
    before, after = (
        {each.key: each.value for each in lower_measures(shape) if each.value is not None} for shape in shapes
    )
    both = before.keys() & after.keys()
    return {
        **{f"{BEFORE}:{key}": value for key, value in before.items()},
        **{f"{AFTER}:{key}": value for key, value in after.items()},
        **{f"{CHANGE}:{key}": after[key] - before[key] for key in both},
    }


def _further_out(subject: LowerSubject, skin: float) -> LowerSubject:
    cuts = subject.sections
    mesh = cuts.mesh.moved(cuts.mesh.vertices + skin * cuts.mesh.vertex_normals)
    return replace(subject, sections=LowerSections(mesh, cuts.top, cuts.bottom, cuts.middle))


def _difference(low: Mapping[str, float], high: Mapping[str, float], whole: float) -> Figures:
    return {key: (high[key] - low[key]) / whole for key in low if key in high}


def lower_effects(propagation: LowerPropagation, *, landmarks: bool) -> Iterator[Effect | None]:
    """Yield what each knob does: those of landmarks, which are slow, or all others."""
    for knob in propagation.knobs:
        if (knob.source == LANDMARKS) == landmarks:
            yield propagation.effect(knob)
