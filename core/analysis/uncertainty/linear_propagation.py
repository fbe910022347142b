"""Linear propagation of each uncertain parameter to all values, by derivatives of the solved system.

What lines are made of and how long they are goes through the linear system of the balance; figures are then
read a step to either side along what that says. Landmarks move the control mesh itself, and no fit is
differentiable in closed form: there the body is fitted anew a step to either side.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from core.analysis.uncertainty.line_response import LineResponse
from core.analysis.uncertainty.outputs import (
    Figures,
    line_values,
    measurement_values,
    normal_distance,
    original_measurements,
    original_values,
    skin_normals,
)
from core.analysis.uncertainty.parameters import PLACING, UncertainParameter, perturb
from core.analysis.uncertainty.perturbed_solutions import PerturbedSolutions
from core.deformation.tffd import deform
from core.errors import UserError
from core.garment.tension import line_tensions
from core.geometry.mesh import Floats
from core.measurements.uncertain_value import LANDMARKS, MODEL, SCAN


@dataclass(frozen=True, eq=False)
class Effect:
    """What one standard deviation of a ``parameter`` does to ``values``, and to the reshaped skin along its
    normals, ``skin`` (n,) [mm].
    """

    parameter: UncertainParameter
    values: Figures
    skin: Floats


class Propagation:
    """One solved design and what its knobs do to it. Raises NoEquilibriumError."""

    def __init__(self, trials: PerturbedSolutions) -> None:
        self.trials, self.stages = trials, trials.base
        stages = trials.base
        equilibrium = trials.equilibrium
        self.lines = LineResponse(
            stages, equilibrium.solution, equilibrium.kept, lambda cup: stages.cup_layout(cup).parts()
        )
        self.points = trials.points
        self.places = deform(stages.binding, self.points)
        self.normals = skin_normals(stages, self.points)

    def effect(self, knob: UncertainParameter) -> Effect:
        """Return what a knob does. Raises the UserError of a fit that fails to both sides."""
        if knob.source == SCAN:
            return self._of_scan(knob)
        if knob.source == MODEL:
            return self._of_model(knob)
        if knob is PLACING:
            return self._of_placing()
        return self._of_landmark(knob) if knob.source == LANDMARKS else self._of_lines(knob)

    def _of_placing(self) -> Effect:
        """Return the effect of placement: a root at a placed fold may differ from that at a detected one."""
        trials, stages = self.trials, self.stages
        here = original_values(trials.original)
        if not trials.is_bare:
            here = measurement_values(stages, trials.steps, trials.original, self.points) | trials.values
        there = trials(perturb(stages, {PLACING: 0.0}))
        skin = normal_distance(stages.body, there.places, self.places, self.normals)
        return Effect(PLACING, _per(here, there.values, 1.0), skin)

    def _of_scan(self, knob: UncertainParameter) -> Effect:
        rest, steps = self.trials.original.subject, self.trials.steps
        if self.trials.is_bare:
            sides = [original_measurements(self.stages, steps, rest, skin) for skin in (-knob.sd, knob.sd)]
            return Effect(knob, _half(*map(original_values, sides)), np.full(len(self.places), knob.sd))
        found = [
            measurement_values(
                self.stages, steps, original_measurements(self.stages, steps, rest, skin), self.points, skin
            )
            for skin in (-knob.sd, knob.sd)
        ]
        return Effect(knob, _half(*found), np.full(len(self.places), knob.sd))

    def _of_landmark(self, knob: UncertainParameter) -> Effect:
        tried = []
        for turn in (-1.0, 1.0):
            try:
                tried.append((turn, self.trials(perturb(self.stages, {knob: turn}))))
            except UserError as problem:
                failed = problem
        if not tried:
            raise failed
        if len(tried) == 1:
            # To one side there is no fit: the other side alone tells, against all landmarks in their places.
            tried.append((0.0, self.trials(perturb(self.stages, {knob: 0.0}))))
        (low, one), (high, other) = sorted(tried, key=lambda each: each[0])
        whole = high - low
        skin = normal_distance(self.stages.body, other.places, one.places, self.normals) / whole
        return Effect(knob, _per(one.values, other.values, whole), skin)

    def _of_model(self, knob: UncertainParameter) -> Effect:
        stages, trials, found, places = self.stages, self.trials, [], []
        for turn in (-1.0, 1.0):
            points = self.points + perturb(stages, {knob: turn}).shift
            figures = line_values(stages, points, line_tensions(stages, points), self.lines.meant)
            found.append(figures | measurement_values(stages, trials.steps, trials.original, points))
            places.append(deform(stages.binding, points))
        return Effect(
            knob, _half(*found), normal_distance(stages.body, places[1], places[0], self.normals) / 2.0
        )

    def _of_lines(self, knob: UncertainParameter) -> Effect:
        found, places = [], []
        for side in self.lines.sides(knob):
            figures = line_values(side.stages, side.points, side.tensions, self.lines.meant)
            if np.abs(side.points - self.points).max() > _STILL:
                rest, steps = self.trials.original, self.trials.steps
                figures |= measurement_values(
                    replace(self.stages, design=side.stages.design), steps, rest, side.points
                )
            found.append(figures)
            places.append(deform(self.stages.binding, side.points))
        return Effect(
            knob, _half(*found), normal_distance(self.stages.body, places[1], places[0], self.normals) / 2.0
        )


_STILL = 1e-9  # a knob that moves no point further changes no measure [mm]


def effects(propagation: Propagation, knobs: Sequence[UncertainParameter]) -> Iterator[Effect | None]:
    """Yield what each knob does, or None where no fit was found to either side."""
    for knob in knobs:
        try:
            yield propagation.effect(knob)
        except UserError:
            yield None


def _half(low: Mapping[str, float], high: Mapping[str, float]) -> Figures:
    return _per(low, high, 2.0)


def _per(low: Mapping[str, float], high: Mapping[str, float], whole: float) -> Figures:
    return {key: (high[key] - low[key]) / whole for key in low if key in high}
