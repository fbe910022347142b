"""Targets solved with lines that are off as well, where the active ones do not reach them (ours)."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Sequence

from core.analysis.inverse_design.conflicts import Conflict
from core.analysis.inverse_design.quantity import Goal
from core.analysis.inverse_design.search import Bounds
from core.analysis.inverse_design.solve import InverseResult, InverseSolver
from core.document.design import Design
from core.errors import UserError
from core.geometry.mesh import Points
from core.pipeline.build import Stages, build
from core.progress import Progress, quiet

_MOST = 4  # groups of optional lines that are each tried alone as well
_WORTH = 0.1  # nearer by so much a line is worth switching on [mm]

Chosen = tuple[str, ...]


def optional_lines(stages: Stages) -> tuple[Chosen, ...]:
    """Return the inactive lines that could move the body, linked ones together."""
    design, active = stages.design, stages.design.all_active_lines()
    moving = [line.name for line in stages.lines if line.constrains]
    off = [name for name in moving if name not in active and not design.line_settings(name).locked]
    groups = (tuple(sorted(set(design.linked_lines(name)).intersection(off))) for name in off)
    return tuple(dict.fromkeys(groups))


class LineSelection:
    """One design whose targets may switch on ``optional`` lines; used as ``InverseSolver`` is.

    Without an optional line, with each alone and with all of them: the nearest answer counts, and of those
    that are about as near the one with the fewest lines.
    """

    def __init__(
        self,
        stages: Stages,
        optional: Collection[str] = (),
        bounds: Bounds | None = None,
        most_kpa: float | None = None,
    ) -> None:
        self._stages, self._bounds, self._most_kpa = stages, bounds or Bounds({}), most_kpa
        self._groups = [group for group in optional_lines(stages) if set(group) <= set(optional)]
        self._solvers: dict[Chosen, InverseSolver] = {(): InverseSolver(stages, self._bounds, most_kpa)}
        self._chosen: Chosen = ()
        self.nearer: Callable[[Design], object] = lambda design: None

    def solve(self, goals: Sequence[Goal], progress: Progress = quiet) -> InverseResult:
        """Return the answer to ``goals``, which depends on them and the design alone; see ``ask``."""
        found: dict[Chosen, InverseResult] = {}
        problem: UserError | None = None
        for chosen in self._candidates():
            try:
                found[chosen] = self._solver(chosen).solve(goals, progress)
            except UserError as why:
                problem = problem or why
                continue
            if found[chosen].reachable:
                break
        if not found:
            assert problem is not None
            raise problem
        self._chosen = next(iter(found))
        for chosen, reply in found.items():
            best = found[self._chosen]
            nearer = (reply.agreed, best.deviation - _WORTH > reply.deviation) == (True, True)
            if reply.reachable or nearer:
                self._chosen = chosen
        return found[self._chosen]

    def solve_quickly(self, goals: Sequence[Goal], progress: Progress = quiet) -> InverseResult:
        """Return an answer near the last one, with the lines of that; see ``InverseSolver.solve_quickly``."""
        return self._solver(self._chosen).solve_quickly(goals, progress)

    def conflicts(
        self, reply: InverseResult, goals: Sequence[Goal], progress: Progress = quiet
    ) -> tuple[Conflict, ...]:
        """Return which of the ``goals`` conflict in the last reply; see ``InverseSolver.conflicts``."""
        return self._solver(self._chosen).conflicts(reply, goals, progress)

    def unlimited(
        self, reply: InverseResult, goals: Sequence[Goal], progress: Progress = quiet
    ) -> InverseResult | None:
        """Return the answer without a limit of pressure where that is what keeps ``goals`` from being met.

        Else there is none. Raises UserError, Cancelled.
        """
        if reply.reachable or not reply.at_pressure_limit:
            return None
        chosen = [name for name in self._chosen if name in reply.design.all_active_lines()]
        free = LineSelection(self._stages, chosen, self._bounds, math.inf)
        return free.solve(goals, progress)

    def current_values(self, names: Collection[str]) -> tuple[dict[str, float], dict[str, float]]:
        """Return what quantities and pressures are in the design as it is; see
        ``InverseSolver.current_values``.
        """
        return self._solver(()).current_values(names)

    def values_at(self, names: Collection[str], points: Points) -> dict[str, float]:
        """Return the quantities ``names`` at control points of all regions, ``points`` (n, 3) [mm]."""
        return self._solver(()).values_at(names, points)

    def _candidates(self) -> Sequence[Chosen]:
        every = tuple(name for group in self._groups for name in group)
        singles = self._groups if 1 < len(self._groups) <= _MOST else []
        return list(dict.fromkeys(((), *singles, every)))

    def _solver(self, chosen: Chosen) -> InverseSolver:
        if chosen not in self._solvers:
            design = self._stages.design
            for name in chosen:
                design = design.with_line(name, self._bounds.longest)
            self._solvers[chosen] = InverseSolver(build(design, self._stages), self._bounds, self._most_kpa)
        solver = self._solvers[chosen]
        solver.nearer = self.nearer
        return solver


def activated(before: Design, after: Design) -> tuple[str, ...]:
    """Return the lines that are active ``after`` and were not ``before``."""
    return tuple(sorted(after.all_active_lines() - before.all_active_lines()))
