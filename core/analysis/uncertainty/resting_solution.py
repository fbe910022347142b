"""The balance that a run comes to, ready to be asked what moves it: with the control of its design (ours).

The exact answer holds each volume, turns hold both breasts together, and the conventional force or none keep
another one. Figures are read where the run rests, so what is told of them has to be worked out there too.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from core.analysis.diagnosis.stability import resting, together
from core.mechanics.potential import Potential
from core.mechanics.sensitivity import Answer, Rates
from core.pipeline.build import Stages, targets_of
from core.pipeline.exact import NoBalanceError, answer_of, volume_keeper


@dataclass(frozen=True, eq=False)
class Resting:
    """The ``answer`` at which a run rests; ``kept`` makes of rates at its volume those under its control."""

    answer: Answer
    kept: Callable[[Rates], Rates]


def push_of(stages: Stages) -> float:
    """Return what pressure the control of a design answers missing volume with, in the model's unit."""
    targets = targets_of(stages.design, stages)
    return targets.gain * stages.model.pressure_unit if targets.control == "conventional" else 0.0


def resting_answer(stages: Stages, push: float | None = None) -> Resting:
    """Return what the run of a design comes to; ``push`` is its control's, see ``push_of``.

    Raises NoBalanceError.
    """
    targets = targets_of(stages.design, stages)
    if targets.control == "exact":
        answer = answer_of(stages)
        return Resting(answer, volume_keeper(stages, answer))
    push = push_of(stages) if push is None else push
    balance = resting(stages, replace(targets, gain=push / stages.model.pressure_unit))
    if not balance.found:
        raise NoBalanceError(stages.design)
    model = together(stages.model)
    share = model.volume.volume(model.tensegric.expand(balance.state.moved)) / model.volume.rest_volume - 1.0
    keeps = targets.control in ("adaptive", "accumulating")
    excess = np.full(2, 0.0 if keeps else 0.5 * share * model.volume.rest_volume)
    answer = Answer(Potential(model, targets.ratios, excess), balance)
    return Resting(answer, (lambda rates: rates) if keeps else _pushed(answer, push))


def _pushed(answer: Answer, push: float) -> Callable[[Rates], Rates]:
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
