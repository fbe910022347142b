"""The balance that a run comes to, ready to be asked what moves it: with the control of its design (ours).

The exact answer holds each volume, turns hold both breasts together, and the conventional force or none keep
another one. Figures are read where the run rests, so what is told of them has to be worked out there too.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from core.analysis.diagnosis.stability import combined_volume_model, equilibrium_for
from core.mechanics.potential import Potential
from core.mechanics.sensitivity import Rates, Sensitivities
from core.pipeline.build import Stages, line_targets
from core.pipeline.exact import NoEquilibriumError, body_volume_rates, exact_solution


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
    keeps = targets.control in ("adaptive", "accumulating")
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
