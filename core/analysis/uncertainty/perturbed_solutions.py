"""A design solved anew with knobs turned: what is sampled, and what landmarks are propagated with."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from core.analysis.diagnosis.stability import combined_volume_model, equilibrium_for
from core.analysis.uncertainty.outputs import (
    Figures,
    OriginalMeasurements,
    Steps,
    line_values,
    measurement_values,
    original_measurements,
    original_values,
    output_values,
    under_bust_steps,
)
from core.analysis.uncertainty.parameters import Perturbed
from core.deformation.tffd import deform
from core.garment.tension import line_tensions
from core.geometry.mesh import Points
from core.landmarks.manual import PlacedMark
from core.measurements.subject import subject_of
from core.measurements.table import original_subject, reshaped_subject
from core.mechanics.potential import Potential
from core.mechanics.sensitivity import Rates, Sensitivities
from core.mechanics.volume import KEEPS_VOLUME
from core.pipeline.build import Stages, build, detect_landmarks, of_bust_alone
from core.pipeline.model_stages import line_targets
from core.pipeline.solve import NoEquilibriumError, body_volume_rates, exact_solution


@dataclass(frozen=True, eq=False)
class ConvergedSolution:
    """The ``solution`` at which a run rests; ``kept`` makes of rates at its volume those under its
    control.
    """

    solution: Sensitivities
    kept: Callable[[Rates], Rates]


def control_response(stages: Stages) -> float:
    """Return what pressure the control of a design answers missing volume with, in the model's unit."""
    targets = line_targets(stages.design, stages)
    return targets.gain * stages.model.pressure_unit if targets.control == "conventional" else 0.0


def converged_solution(stages: Stages, push: float | None = None) -> ConvergedSolution:
    """Return what the run of a design comes to; ``push`` is its control's, see ``control_response``.

    Raises NoEquilibriumError.
    """
    targets = line_targets(stages.design, stages)
    if targets.control == "exact":
        answer = exact_solution(stages)
        return ConvergedSolution(answer, body_volume_rates(stages, answer))
    push = control_response(stages) if push is None else push
    balance = equilibrium_for(stages, replace(targets, gain=push / stages.model.pressure_unit))
    if not balance.is_converged:
        raise NoEquilibriumError(stages.design)
    model = combined_volume_model(stages.model)
    share = model.volume.volume(model.tensegric.expand(balance.state.moved)) / model.volume.rest_volume - 1.0
    keeps = targets.control in KEEPS_VOLUME
    excess = np.full(2, 0.0 if keeps else 0.5 * share * model.volume.rest_volume)
    answer = Sensitivities(Potential(model, targets.ratios, excess), balance)
    return ConvergedSolution(answer, (lambda rates: rates) if keeps else _pushed(answer, push))


def _pushed(answer: Sensitivities, push: float) -> Callable[[Rates], Rates]:
    """Return what makes of rates at a held volume those at which the pressure follows what is missing."""
    potential, by = answer.potential, answer.by_excess
    half = 0.5 * potential.model.volume.rest_volume
    more = Rates(half * by.moved.sum(axis=1, keepdims=True), half * by.multipliers.sum(axis=1, keepdims=True))
    of_more = float(potential.pressures(more.multipliers[:, 0])[0]) + push

    def kept(rates: Rates) -> Rates:
        pressures = np.array([potential.pressures(column)[0] for column in rates.multipliers.T])
        excess = -pressures[None, :] / of_more
        return Rates(rates.moved + more.moved @ excess, rates.multipliers + more.multipliers @ excess)

    return kept


_KEPT = (
    "read scan",
    "find landmarks",
    "read template",
    "fit control mesh",
    "halve control mesh",
    "condense tissue",
)
"""The stages that are slow to make and small to keep."""


@dataclass(frozen=True, eq=False)
class PerturbedSolution:
    """A design solved: its ``stages``, control ``points`` (n, 3) and body ``places`` (m, 3) [mm]."""

    stages: Stages
    points: Points
    places: Points
    values: Figures


class PerturbedSolutions:
    """Tries variations of ``base``, the bust of a ``whole`` design.

    What hangs on landmarks alone is kept for another design.
    ``former`` are the trials of one: of the same scan and landmarks they know what is needed here too.
    """

    def __init__(self, base: Stages, former: PerturbedSolutions | None = None) -> None:
        self.whole, self.base = base, (base := of_bust_alone(base))
        self._known: dict[tuple[PlacedMark, ...], tuple[Stages, OriginalMeasurements]] = {}
        if former is not None and _alike(base, former.base) and self.steps == former.steps:
            self._known = former._known

    def __call__(self, turned: Perturbed, *, keep: bool = True) -> PerturbedSolution:
        """Solve a variation and read it; ``keep`` for the next time what hangs on its landmarks alone.

        Raises the UserError of a stage that fails.
        """
        if self.is_bare:
            return self._unworn(turned)
        placed = turned.design.placed
        known, rest = self._known.get(placed, (self.base, None))
        stages = build(turned.design, known, near=self.base)
        rest = rest or original_measurements(stages, self.steps)
        if keep and placed not in self._known:
            slim = {name: known for name, known in stages.memo.items() if name in _KEPT}
            self._known[placed] = replace(self.base, design=stages.design, memo=slim), rest
        if turned.skin:
            rest = original_measurements(stages, self.steps, rest.subject, turned.skin)
        points = converged_solution(stages, self._push).solution.place.points + turned.shift
        ratios = {line.name: self.base.design.ratio(line.name) for line in stages.model.lines}
        figures = {
            **measurement_values(stages, self.steps, rest, points, turned.skin),
            **line_values(stages, points, line_tensions(stages, points), ratios),
        }
        return PerturbedSolution(stages, points, deform(stages.binding, points), figures)

    def _unworn(self, turned: Perturbed) -> PerturbedSolution:
        """Read a body that wears nothing: the skin stays, so nothing is fitted and nothing solved."""
        marks = detect_landmarks(self.base.body, turned.design.placed)
        subject = replace(subject_of(self.base.body.smoothed, marks), down=self.steps.before)
        rest = original_measurements(self.base, self.steps, subject, turned.skin)
        return PerturbedSolution(self.base, self.points, self.base.body.mesh.vertices, original_values(rest))

    @property
    def is_bare(self) -> bool:
        """Return whether nothing reshapes the body, so that it stays as it is."""
        return self.base.design.is_bare

    @cached_property
    def values(self) -> Figures:
        """Return the figures of lines and bust points where the run rests. Raises NoEquilibriumError."""
        return {} if self.is_bare else output_values(self.base, self.points)

    @cached_property
    def original(self) -> OriginalMeasurements:
        """Return the body at rest with its landmarks where they are."""
        return original_measurements(self.base, self.steps)

    @cached_property
    def points(self) -> Points:
        """Return the control points where the run rests, shape (n, 3) [mm]. Raises NoEquilibriumError."""
        return self.equilibrium.solution.place.points

    @cached_property
    def equilibrium(self) -> ConvergedSolution:
        """Return the balance that the run of the design comes to. Raises NoEquilibriumError."""
        return converged_solution(self.base, self._push)

    @cached_property
    def _push(self) -> float:
        """Return how the control answers missing volume: alike whatever is turned."""
        return control_response(self.base)

    @cached_property
    def steps(self) -> Steps:
        """Return how far under the breasts the under-bust is measured."""
        rest = original_subject(self.base.body.smoothed, self.base.landmarks)
        return under_bust_steps(rest, reshaped_subject(rest, self.base, self.points))


def _alike(one: Stages, other: Stages) -> bool:
    return (
        one.body is other.body
        and one.control is other.control
        and one.design.placed == other.design.placed
        and one.design.own_measures == other.design.own_measures
    )
