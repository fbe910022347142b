"""Lines that pull as the curves of their elastics say: Hooke lines through the points they reach (ours).

The paper's lines obey Hooke's law (section 3). Of an elastic whose curve bends, the line has the secant at
the elongation at which it comes to rest, so force and length are a point of the curve; it is found by a few
exact answers.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from core.geometry.mesh import Floats
from core.mechanics.model import ConstrainedModel, assemble
from core.mechanics.newton import Equilibrium
from core.mechanics.potential import Potential

PRECISION = 1e-9
"""By how much the force of a line may differ from its elastic's at the same length, in parts."""

_GOOD = 1e-6  # where the precision above is out of reach, this will do
_ROUNDS = 40
_STEEPEST, _FLATTEST = -10.0, -0.2  # how the misfit is thought to change with the logarithm of EA

Solve = Callable[[ConstrainedModel], Equilibrium]
"""Finds the exact answer of a model from rest."""


class ElasticCurve(Protocol):
    """What is asked of an elastic."""

    def secant(self, elongation: float) -> float:
        """Return force over elongation [N]."""


@dataclass(frozen=True, eq=False)
class FittedModel:
    """A ``model`` whose lines pull as their elastics do, with their ``elongations`` [1] by name.

    ``agreed`` tells whether it has an exact answer at all, and force and length agree there; ``balance`` is
    that answer. ``log_ea`` (e,) are the logarithms of the lines' EA [N].
    """

    model: ConstrainedModel
    elongations: Mapping[str, float]
    agreed: bool
    balance: Equilibrium
    log_ea: Floats


@dataclass(frozen=True, eq=False)
class ElasticLines:
    """Worn lines of a ``model`` with natural ``ratios`` [1] and the ``elastics`` of some, all by name.

    ``newtons`` [N/mm] is one unit of the model's stiffness; ``own_stiffness`` [1] that of lines without an
    elastic, where they have one of their own.
    """

    model: ConstrainedModel
    ratios: Mapping[str, float]
    elastics: Mapping[str, ElasticCurve]
    newtons: float
    own_stiffness: Mapping[str, float]

    def with_ea(self, ea: Floats) -> ConstrainedModel:
        """Return the model in which the lines of the elastics have ``ea`` (e,) [N].

        EA is force over elongation of the natural length; over the length at rest it is EA / ratio.
        """
        model = self.model
        unit = self.newtons * model.tensegric.mean_stiffness
        segment = {line.name: line.spacing for line in model.lines}
        own = {
            name: float(each) / self.ratios[name] / (unit * segment[name])
            for name, each in zip(self.elastics, ea, strict=True)
        }
        worn = [model.lines[at].name for at in model.acting_lines]
        stiffness = {**self.own_stiffness, **own}
        return assemble(model.tensegric, model.lines, model.volume, worn, stiffness).with_layout_of(model)

    def elongations(self, model: ConstrainedModel, balance: Equilibrium) -> dict[str, float]:
        """Return how far the front of each elastic is stretched [1], by line; what is slack counts as 0."""
        potential = Potential(model, tuple(self.ratios[line.name] for line in model.lines))
        _, pieces = model.segments.spans(balance.state.moved)
        slack = model.sums(potential.stretch(pieces) - (pieces - potential.natural))
        reached = model.line_lengths(model.tensegric.expand(balance.state.moved))
        long = {line.name: each for line, each in zip(model.lines, slack + reached, strict=True)}
        rest = {line.name: line.rest_length for line in model.lines}
        return {name: float(long[name] / (self.ratios[name] * rest[name])) - 1.0 for name in self.elastics}

    def secants(self, elongations: Mapping[str, float]) -> Floats:
        """Return EA of the elastics at their elongations, shape (e,) [N]."""
        return np.array([elastic.secant(elongations[name]) for name, elastic in self.elastics.items()])


def fit_elastics(
    lines: ElasticLines, solve: Solve, begin: Floats | None = None, precision: float = PRECISION
) -> FittedModel:
    """Return the model in which each elastic's force and length are a point of its curve.

    EA is sought in logarithms, for each line with the slope that its last two rounds showed, from ``begin``
    (e,) on, until forces differ by no more than ``precision``, in parts.
    """
    log_ea = begin
    if log_ea is None:  # as if the lines did not move the body
        log_ea = np.log(lines.secants({name: 1.0 / lines.ratios[name] - 1.0 for name in lines.elastics}))
    slope = np.full(len(log_ea), -1.0)
    step, before = np.zeros_like(log_ea), np.zeros_like(log_ea)
    for _ in range(_ROUNDS):
        model = lines.with_ea(np.exp(log_ea))
        balance = solve(model)
        stretched = lines.elongations(model, balance)
        misfit = np.log(lines.secants(stretched)) - log_ea
        worst = float(np.abs(misfit).max(initial=0.0))
        if not balance.is_converged or worst < precision:
            break
        seen = np.abs(step) > 1e-12
        slope = np.where(seen, (misfit - before) / np.where(seen, step, 1.0), slope)
        slope = np.clip(slope, _STEEPEST, _FLATTEST)
        before, step = misfit, -misfit / slope
        log_ea = log_ea + step
    return FittedModel(
        model, stretched, balance.is_converged and worst < max(_GOOD, precision), balance, log_ea
    )
