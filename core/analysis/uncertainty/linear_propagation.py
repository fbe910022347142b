"""Linear propagation of each uncertain parameter to all values, by derivatives of the solved system.

What lines are made of and how long they are goes through the linear system of the balance; figures are then
read a step to either side along what that says. Landmarks move the control mesh itself, and no fit is
differentiable in closed form: there the body is fitted anew a step to either side.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from core.analysis.uncertainty.outputs import (
    Figures,
    line_values,
    measurement_values,
    normal_distance,
    original_measurements,
    original_values,
    skin_normals,
)
from core.analysis.uncertainty.parameters import PLACING, UncertainParameter, perturb, turned_cup
from core.analysis.uncertainty.perturbed_solutions import PerturbedSolutions
from core.deformation.tffd import deform
from core.errors import UserError
from core.garment.tension import LineTension, line_tensions
from core.geometry.mesh import Floats, Points
from core.measurements.uncertain_value import ELASTIC, LANDMARKS, LINE, MODEL, SCAN, TAPE, TISSUE
from core.mechanics.force_units import newtons_per_unit
from core.mechanics.sensitivity import Rates
from core.mechanics.stiffness_sensitivity import Changes, d_sag, stiffness_rates
from core.pipeline.model_stages import line_targets


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
        self.ratios = np.array(line_targets(stages.design, stages).ratios)
        self._meant = {
            line.name: float(ratio) for line, ratio in zip(stages.model.lines, self.ratios, strict=True)
        }
        self.points = trials.points
        self.answer, self._kept = trials.equilibrium.solution, trials.equilibrium.kept
        self.places = deform(stages.binding, self.points)
        self.normals = skin_normals(stages, self.points)
        self.tensions = line_tensions(stages, self.points)
        self._long = {line.name: line.rest_lengths for line in stages.model.lines}
        for at in stages.model.acting_lines:
            name = stages.model.lines[at].name
            self._long[name] = stages.model.tapes_at_rest[stages.model.owner == at]

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
            figures = line_values(stages, points, line_tensions(stages, points), self._meant)
            found.append(figures | measurement_values(stages, trials.steps, trials.original, points))
            places.append(deform(stages.binding, points))
        return Effect(
            knob, _half(*found), normal_distance(stages.body, places[1], places[0], self.normals) / 2.0
        )

    def _of_lines(self, knob: UncertainParameter) -> Effect:
        moved, pulls = self._answered(knob)
        found, places = [], []
        for turn in (-1.0, 1.0):
            points = self.points + turn * moved
            tensions = {
                name: _pulled(each, turn * pulls[name], self._long[name])
                for name, each in self.tensions.items()
            }
            design = perturb(self.stages, {knob: turn}).design
            stages = replace(self.stages, design=design)
            figures = line_values(stages, points, tensions, self._meant)
            if np.abs(moved).max() > _STILL:
                figures |= measurement_values(stages, self.trials.steps, self.trials.original, points)
            found.append(figures)
            places.append(deform(self.stages.binding, points))
        return Effect(
            knob, _half(*found), normal_distance(self.stages.body, places[1], places[0], self.normals) / 2.0
        )

    def _answered(self, knob: UncertainParameter) -> tuple[Points, dict[str, Floats]]:
        """Return how control points move, (n, 3) [mm], and tensions change [N], by line, for one sd."""
        model, design = self.stages.model, self.stages.design
        elastics = design.active_elastics()
        names = [line.name for line in model.lines]
        stiffer, ratios = np.zeros((len(names), 1)), np.zeros((len(names), 1))
        solid = design.tissue == "solid"
        newtons = knob.sd if knob.source == TISSUE and not solid else 0.0
        for at, name in enumerate(names):
            elastic = elastics.get(name)
            if knob.source == TISSUE:
                # Elastics have newtons of their own on a net, whose unit changes; on a solid other lines do.
                stiffer[at] = -knob.sd if solid != (elastic is not None) else 0.0
            elif (knob.source == LINE and not elastic) or (
                knob.source == ELASTIC and elastic and elastic.name == knob.name and not knob.cup
            ):
                stiffer[at] = knob.sd
            elif knob.source == TAPE and name == knob.name and not knob.cup:
                ratios[at] = knob.sd / model.lines[at].whole_length
        made = {names.index(name): elastic for name, elastic in elastics.items()}
        beside = self._beside(knob)
        answers = stiffness_rates(
            self.answer, Changes(stiffer, ratios), made, self.ratios, self._kept, beside.moved
        )
        moved = np.zeros_like(self.points)
        moved[model.tensegric.free] = answers.moved[:, 0].reshape(-1, 3)
        return moved, self._pulls(knob, answers.pulls[:, 0], newtons, ratios, beside)

    def _beside(self, knob: UncertainParameter) -> Rates:
        """Return what a knob does to other things than lines: to a solid, and to cups."""
        if knob.source == TISSUE and self.stages.design.tissue == "solid":
            return self._kept(d_sag(self.answer)).summed([[0]], knob.sd)
        if knob.cup:
            return self._kept(self.answer.by_forces(self._of_cups(knob)))
        return Rates(
            np.zeros((self.answer.place.gradient.size, 1)), np.zeros((len(self.answer.place.held), 1))
        )

    def _of_cups(self, knob: UncertainParameter) -> Floats:
        """Return the forces on the free points that one sd of a setting of the cups adds, (3 f, 1)."""
        moved, found = self.answer.place.moved, []
        for turn in (-_SMALL, _SMALL):
            parts = self.stages.cup_layout(turned_cup(self.stages.design.cup, knob, turn)).parts()
            found.append(sum((part.gradient(moved) for part in parts), np.zeros_like(moved)))
        return ((found[1] - found[0]) / (2.0 * _SMALL)).reshape(-1, 1)

    def _pulls(
        self, knob: UncertainParameter, pulls: Floats, newtons: float, ratios: Floats, beside: Rates
    ) -> dict[str, Floats]:
        stages, model = self.stages, self.stages.model
        unit = newtons_per_unit(model, stages.design.tissue_stiffness)
        held = stages.design.line_hold == "held"
        found = {}
        for at, line in enumerate(model.lines):
            if line.name not in self.tensions:
                continue
            segments = self.tensions[line.name].segments
            if held:
                found[line.name] = newtons * segments + unit * self._held(at, ratios, beside)
            elif (model.owner == at).any():
                found[line.name] = newtons * segments + unit * pulls[model.owner == at]
            else:
                gained = self._on_ribs(knob, line.name, float(ratios[at, 0]))
                found[line.name] = np.full(len(segments), gained)
        return found

    def _held(self, line: int, ratios: Floats, beside: Rates) -> float:
        """Return what the tension of a held line gains, in the model's unit."""
        every = np.arange(len(ratios))
        rates = self._kept(self.answer.by_ratio(every))
        rest = np.array([each.rest_length for each in self.stages.model.lines])
        by_line = self.answer.tensions(rates, np.diag(rest))[1]
        by_beside = self.answer.tensions(beside, np.zeros((len(rest), 1)))[1]
        return float(by_line[line] @ ratios[:, 0] + by_beside[line, 0])

    def _on_ribs(self, knob: UncertainParameter, name: str, longer: float) -> float:
        """Return what the tension of an elastic that cannot move gains [N]."""
        elastic, ratio = self.stages.design.active_elastics()[name], self.stages.design.ratio(name)
        force = elastic.force(1.0 / ratio - 1.0)
        if knob.source == ELASTIC and knob.name == elastic.name:
            return knob.sd * force
        ends = [elastic.force(1.0 / (ratio + turn * longer) - 1.0) for turn in (-1.0, 1.0)]
        return (ends[1] - ends[0]) / 2.0


_SMALL = 1e-3  # of a standard deviation, to either side, for what a setting of the cups adds
_STILL = 1e-9  # a knob that moves no point further changes no measure [mm]


def effects(propagation: Propagation, knobs: Sequence[UncertainParameter]) -> Iterator[Effect | None]:
    """Yield what each knob does, or None where no fit was found to either side."""
    for knob in knobs:
        try:
            yield propagation.effect(knob)
        except UserError:
            yield None


def _pulled(tension: LineTension, more: Floats, lengths: Floats) -> LineTension:
    mean = tension.mean + float(np.average(more, weights=lengths))
    return replace(tension, segments=tension.segments + more, mean=mean)


def _half(low: Mapping[str, float], high: Mapping[str, float]) -> Figures:
    return _per(low, high, 2.0)


def _per(low: Mapping[str, float], high: Mapping[str, float], whole: float) -> Figures:
    return {key: (high[key] - low[key]) / whole for key in low if key in high}
