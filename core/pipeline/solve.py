"""Solution of a design in one call: iterations and exact solution, for commands, images and tests."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from core.blas_threads import one_blas_thread
from core.document.design import Design
from core.document.lines import ActiveLine
from core.errors import LineError
from core.geometry.mesh import Mesh, Points
from core.mechanics.convergence import Convergence, assess_convergence, combined
from core.mechanics.exact_solution import (
    NEWTON_LIMIT,
    newton,
    rates_at_body_volume,
    solve_body_exact,
    solve_exact,
)
from core.mechanics.iteration import Record, SolverState, initial_state, iterate, record
from core.mechanics.newton import Equilibrium
from core.mechanics.potential import Potential
from core.mechanics.sensitivity import Rates, Sensitivities
from core.mechanics.solver_comparison import assess_equilibrium, most_turns, shape_of
from core.messages import LineName, Message
from core.pipeline.build import Stages
from core.pipeline.model_stages import line_targets
from core.pipeline.stages import RegionStages
from core.progress import Progress, quiet

_NOT_FOUND = (
    Message("No equilibrium found for these line lengths."),
    Message("Set the lengths closer to 100 %, or choose an iterative volume control."),
)


class NoEquilibriumError(LineError):
    """The lines of ``design`` find no balance at their lengths."""

    def __init__(self, design: Design) -> None:
        super().__init__(*(_cannot_hold(design) if design.line_hold == "held" else _NOT_FOUND))
        self.design = design


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
    stages: RegionStages,
    ratios: tuple[float, ...] | None = None,
    near: Equilibrium | None = None,
    limit: int = NEWTON_LIMIT,
) -> Equilibrium:
    """Return the exact answer of a design, which may not be ``found``; from one ``near`` by it is quicker.

    ``ratios`` [1] are other lengths than the design's, one per line of the model. After ``limit`` steps it is
    given up.
    """
    own = line_targets(stages.design, stages).ratios
    if stages.balance is not None and ratios in (None, own):
        return stages.balance
    ratios = own if ratios is None else ratios
    if stages.design.dense_volume:
        return solve_body_exact(stages.model, ratios, stages.body_change, limit, near=near)
    return solve_exact(stages.model, ratios, limit, near=near)


def exact_solution(
    stages: RegionStages,
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
        excess = model.volume.zone_volumes(points) - model.rest_zones
    return Sensitivities(Potential(model, ratios, excess), balance)


def body_volume_rates(stages: RegionStages, answer: Sensitivities) -> Callable[[Rates], Rates]:
    """Return what makes of rates those at which the body keeps its volume, where a design asks for that."""
    if not stages.design.dense_volume:
        return lambda rates: rates
    points, binding, moving = answer.place.points, stages.binding, stages.moving
    sides = moving.side_volume_slopes(stages.shape(points)[0])[:, : moving.count]
    free = stages.model.tensegric.free
    slopes = np.stack([binding.gradient(points, side)[free].ravel() for side in sides])
    each = stages.model.options.volume_of == "each"
    return lambda rates: rates_at_body_volume(rates, answer.by_excess, slopes, each=each)


@dataclass(frozen=True, eq=False)
class RegionSolution:
    """The records of all iterations of one region, the last state and the verdict.

    ``rest`` is the record of the original shape.
    """

    stages: RegionStages
    rest: Record
    records: tuple[Record, ...]
    state: SolverState
    verdict: Convergence

    @property
    def last(self) -> Record:
        """Return the last record."""
        return self.records[-1] if self.records else self.rest

    @property
    def control_points(self) -> Points:
        """Return the control points at the end, shape (n, 3) [mm]."""
        return self.stages.model.tensegric.expand(self.state.moved)

    @property
    def body_change(self) -> float:
        """Return the volume that the body has gained by this region [ml]."""
        return float(self.stages.body_change(self.control_points).sum()) / 1000.0


@dataclass(frozen=True, eq=False)
class Solution:
    """Hold what each region of a design was solved to, the ``bust`` and the ``lower`` trunk if there is one.

    Records, state and control points are those of the bust; ``seconds`` is the duration.
    """

    stages: Stages
    bust: RegionSolution
    lower: RegionSolution | None
    seconds: float

    @property
    def regions(self) -> tuple[RegionSolution, ...]:
        """Return the solution of each region, the bust first."""
        return (self.bust,) if self.lower is None else (self.bust, self.lower)

    @property
    def rest(self) -> Record:
        """Return the record of the original shape."""
        return self.bust.rest

    @property
    def records(self) -> tuple[Record, ...]:
        """Return the records of all iterations."""
        return self.bust.records

    @property
    def state(self) -> SolverState:
        """Return the last state."""
        return self.bust.state

    @property
    def last(self) -> Record:
        """Return the last record."""
        return self.bust.last

    @property
    def control_points(self) -> Points:
        """Return the control points at the end, shape (n, 3) [mm]."""
        return self.bust.control_points

    @property
    def region_points(self) -> tuple[Points, ...]:
        """Return the control points of each region, the bust's first, each (n, 3) [mm]."""
        return tuple(each.control_points for each in self.regions)

    @property
    def body_change(self) -> float:
        """Return the volume that the body has gained by the bust [ml]."""
        return self.bust.body_change

    @property
    def verdict(self) -> Convergence:
        """Return the verdict on all regions: the worst motion and condition."""
        return combined([each.verdict for each in self.regions])

    @property
    def bust_verdict(self) -> Convergence:
        """Return the verdict on the bust."""
        return self.bust.verdict

    @cached_property
    def body(self) -> Mesh:
        """Return the reshaped body."""
        return self.stages.skin.body(self.region_points)


def solve(stages: Stages, turns: int | None = None, progress: Progress = quiet) -> Solution:
    """Solve the design of ``stages`` from the original shape.

    Makes exactly ``turns`` iterations, or until converged (at most ``most_turns``) if None; exact volume
    control uses Newton steps instead. ``progress`` receives each step. Raises Cancelled.
    """
    start = time.perf_counter()
    with one_blas_thread():
        solved = [solve_region(region, turns, progress) for region in stages.regions]
    lower = solved[1] if len(solved) > 1 else None
    return Solution(stages, solved[0], lower, time.perf_counter() - start)


def check_held_lines(solution: Solution) -> None:
    """Raise NoEquilibriumError if lines that hold their lengths have no equilibrium."""
    design, motion = solution.stages.design, solution.verdict.motion
    lost = ("diverging", "settling") if design.volume == "exact" else ("diverging",)
    if design.line_hold == "held" and motion in lost:
        raise NoEquilibriumError(design)


def solve_valid(stages: Stages) -> Solution:
    """Solve the design of ``stages``. Raises LineError if there is no valid shape."""
    solution = solve(stages)
    check_held_lines(solution)
    if solution.verdict.motion == "diverging":
        raise divergence_error()
    return solution


def divergence_error() -> LineError:
    """Return the error of a solution that is not a shape of the body."""
    return LineError(
        Message("The solver diverged: no shape is available for measurements or cutting."),
        Message("Make the lines longer or softer."),
    )


def solve_region(stages: RegionStages, turns: int | None, progress: Progress = quiet) -> RegionSolution:
    """Solve one region of a design; see ``solve``. Raises Cancelled."""
    rest = record(stages.model, initial_state(stages.model), 0.0, stages.watch)
    solve = _run_exact if stages.design.volume == "exact" else _run_turns
    records, state, verdict = solve(stages, rest, turns, progress)
    condition = shape_of(stages.model).quality(stages.model.tensegric.expand(state.moved))
    return RegionSolution(stages, rest, tuple(records), state, replace(verdict, condition=condition))


def _run_turns(
    stages: RegionStages, rest: Record, turns: int | None, progress: Progress
) -> tuple[list[Record], SolverState, Convergence]:
    targets = line_targets(stages.design, stages)
    records: list[Record] = []
    state = initial_state(stages.model)
    most = most_turns(stages.model) if turns is None else turns
    for now, measured in iterate(stages.model, lambda: targets, turns=most, watch=stages.watch):
        state = now
        records.append(measured)
        progress("solving", len(records) / most)
        if turns is None and assess_convergence(records).motion in ("settled", "diverging"):
            break
    return records, state, assess_convergence(records)


def _run_exact(
    stages: RegionStages, rest: Record, turns: int | None, progress: Progress
) -> tuple[list[Record], SolverState, Convergence]:
    ratios = line_targets(stages.design, stages).ratios
    records: list[Record] = []
    before = initial_state(stages.model)
    limit = NEWTON_LIMIT if turns is None else turns
    if stages.design.dense_volume:
        balances = iter([solve_body_exact(stages.model, ratios, stages.body_change, limit)])
    else:
        balances = newton(stages.model, ratios, limit)
    for balance in balances:
        progress("solving", balance.steps / limit)
        if balance.steps:
            step = float(((balance.state.moved - before.moved) ** 2).sum(axis=1).max() ** 0.5)
            records.append(record(stages.model, balance.state, step, stages.watch))
        before = balance.state
    return records, balance.state, assess_equilibrium(stages.model, balance)
