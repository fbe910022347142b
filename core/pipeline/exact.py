"""The exact answer of a design: where all forces balance at the volume that it keeps, and what moves it."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from core.document.design import Design
from core.document.lines import ActiveLine
from core.errors import LineError
from core.mechanics.exact_solution import NEWTON_LIMIT, rates_at_body_volume, solve_body_exact, solve_exact
from core.mechanics.newton import Equilibrium
from core.mechanics.potential import Potential
from core.mechanics.sensitivity import Rates, Sensitivities
from core.messages import LineName, Message
from core.pipeline.build import Stages, line_targets


class NoEquilibriumError(LineError):
    """The lines of ``design`` find no balance at their lengths."""

    def __init__(self, design: Design) -> None:
        super().__init__(*(_cannot_hold(design) if design.line_hold == "held" else _NOT_FOUND))
        self.design = design


_NOT_FOUND = (
    Message("No equilibrium found for these line lengths."),
    Message("Set the lengths closer to 100 %, or choose an iterative volume control."),
)


def _cannot_hold(design: Design) -> tuple[Message, Message]:
    line = max(design.lines, key=lambda line: abs(math.log(line.ratio)), default=ActiveLine("The line", 1.0))
    late = design.line_force == "explicit"
    return (
        Message(
            "{line} cannot be fixed at {percent} % of its original length.",
            line=LineName(line.name),
            percent=f"{100 * line.ratio:.1f}",
        ),
        Message("Choose implicit line forces, or make lines elastic.")
        if late
        else Message("Set the length closer to 100 %, or make lines elastic."),
    )


def exact_equilibrium(
    stages: Stages,
    ratios: tuple[float, ...] | None = None,
    near: Equilibrium | None = None,
    limit: int = NEWTON_LIMIT,
) -> Equilibrium:
    """Return the exact answer of a design, which may not be ``found``; from one ``near`` by it is quicker.

    ``ratios`` [1] are other lengths than the design's, one per line of the model. After ``limit`` steps it is
    given up.
    """
    ratios = line_targets(stages.design, stages).ratios if ratios is None else ratios
    if stages.design.dense_volume:
        return solve_body_exact(stages.model, ratios, stages.body_change, limit, near=near)
    return solve_exact(stages.model, ratios, limit, near=near)


def exact_solution(
    stages: Stages,
    ratios: tuple[float, ...] | None = None,
    near: Equilibrium | None = None,
    limit: int = NEWTON_LIMIT,
) -> Sensitivities:
    """Return the exact answer, ready to be asked what moves it. Raises NoEquilibriumError; see
    ``exact_equilibrium``.
    """
    ratios = line_targets(stages.design, stages).ratios if ratios is None else ratios
    balance = exact_equilibrium(stages, ratios, near, limit)
    if not balance.is_converged:
        raise NoEquilibriumError(stages.design)
    model, excess = stages.model, None
    if stages.design.dense_volume:
        points = model.tensegric.expand(balance.state.moved)
        excess = model.volume.side_volumes(points) - model.rest_sides
    return Sensitivities(Potential(model, ratios, excess), balance)


def body_volume_rates(stages: Stages, answer: Sensitivities) -> Callable[[Rates], Rates]:
    """Return what makes of rates those at which the body keeps its volume, where a design asks for that."""
    if not stages.design.dense_volume:
        return lambda rates: rates
    points, binding, moving = answer.place.points, stages.binding, stages.moving
    sides = moving.side_volume_slopes(stages.shape(points)[0])[:, : moving.count]
    free = stages.model.tensegric.free
    slopes = np.stack([binding.gradient(points, side)[free].ravel() for side in sides])
    each = stages.model.options.volume_of == "each"
    return lambda rates: rates_at_body_volume(rates, answer.by_excess, slopes, each=each)
