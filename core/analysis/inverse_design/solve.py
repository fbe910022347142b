"""Ask for the result: the lengths of lines that bring the body to what is wished (ours).

The search works on one model. Lines made of elastics have other stiffnesses at other lengths, and what bands
press with follows from the shape they lie on: both are looked at after an answer, and it is asked again from
there with what was learnt, until figures and pressures agree.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from core.analysis.inverse_design.conflicts import Conflict, conflicts_of
from core.analysis.inverse_design.objective import NEAR, goal_weights
from core.analysis.inverse_design.pressure_limit import PressureLimit, largest_pressures
from core.analysis.inverse_design.quantities import QuantityReaders
from core.analysis.inverse_design.quantity import Goal
from core.analysis.inverse_design.search import LOOSEST, Bounds, Candidate, Search
from core.analysis.inverse_design.sensitivities import exact_points
from core.blas_threads import one_blas_thread
from core.document.design import Design
from core.errors import LineError
from core.geometry.mesh import Floats, Points
from core.pipeline.build import Stages, build
from core.pipeline.solve import NoEquilibriumError
from core.progress import Progress, quiet

_LIMIT_ROUNDS, _FIRM_FROM = (
    9,
    3,
)  # rounds for pressure; from then on limits only get lower: lines may alternate
_SLOPES = -2.0, 0.5  # of lengths that are found by those of the model [1]


@dataclass(frozen=True, eq=False)
class InverseResult:
    """What can be done: the ``design`` with the lengths found, and what its exact answer ``reached`` [mm].

    ``reachable`` tells whether that is what was asked for, ``miss`` [mm] what the worst figure lacks,
    ``deviation`` [mm] the root of the squares of all as they count: see ``goal_weights``. If not,
    there is a reason: lines ``at_limit`` are as short or as long as they may be, lines that are
    ``at_pressure_limit`` do
    so as hard as they may, ``slack`` ones would push, ``strained`` is a shape that would strain beyond what
    looks natural; without any the lines do not move it that way. ``agreed`` is False where lengths, elastics
    and pressures did not come to agree: there may be better. ``pressure`` [kPa] is the largest of each line
    that was looked at, and ``limit`` what it may be; ``unchecked`` are the worn lines that were not looked
    at.
    ``tension`` [N] is the sum over the lines, an estimate where they are made of no elastic; ``answers`` how
    many were worked out.
    ``longest`` is the ratio that no line goes beyond [1], ``points`` (n, 3) [mm] are the exact answer of all
    regions.
    """

    design: Design
    reached: Mapping[str, float]
    reachable: bool
    miss: float
    at_limit: tuple[str, ...]
    at_pressure_limit: tuple[str, ...]
    slack: tuple[str, ...]
    strained: bool
    agreed: bool
    pressure: Mapping[str, float]
    limit: float
    unchecked: tuple[str, ...]
    tension: float
    answers: int
    longest: float = LOOSEST
    deviation: float = 0.0
    points: Points = field(default_factory=lambda: np.zeros((0, 3)))

    def may_not_be_longer(self, name: str) -> bool:
        """Return which limit a line has reached."""
        return self.design.ratio(name) > self.longest - 1e-3


def solve_targets(
    stages: Stages,
    goals: Sequence[Goal],
    shortest: Mapping[str, float] | None = None,
    kept: Collection[str] = (),
    progress: Progress = quiet,
    most_kpa: float | None = None,
) -> InverseResult:
    """Return the lengths of the worn lines that bring the body to ``goals``, or as near as they can.

    ``shortest`` [1] are ratios that named lines may not go below; locked lines and those ``kept`` stay.
    No line pushes, and none presses more than ``most_kpa``; if that is not given, lines made of elastic press
    no more than the red light begins with, straps aside. Raises UserError if no worn line is free, nothing is
    asked, or nothing balances at the start; Cancelled.
    """
    return InverseSolver(stages, Bounds(shortest or {}, kept), most_kpa).solve(goals, progress)


class InverseSolver:
    """One design that is asked again and again: what one answer needed is there for the next.

    ``bounds`` and ``most_kpa`` are those of ``solve_targets``. ``nearer`` hears of the nearest design so far
    while an answer is looked for elsewhere, in the thread that asks.
    """

    def __init__(self, stages: Stages, bounds: Bounds | None = None, most_kpa: float | None = None) -> None:
        self._stages, design = stages, stages.design
        self._made = {} if design.line_hold == "held" else design.active_elastics()
        self._limit = PressureLimit(design, most_kpa)
        bounds = bounds or Bounds({})
        shortest = dict(bounds.shortest)
        for name, elastic in self._made.items():
            # As if the line did not move the body: beyond that its elastic is not known.
            shortest[name] = max(shortest.get(name, 0.0), 1.0 / (1.0 + elastic.max_elongation))
        self._bounds = replace(bounds, shortest=shortest)
        self._figures = QuantityReaders(stages)  # they hang on the body, not on its lines
        self._goals: Sequence[Goal] = ()
        self._progress: Progress = quiet
        self.nearer: Callable[[Design], object] = lambda design: None
        self._search: Search | None = None
        self._used: list[tuple[Search, int]] = []

    def solve(self, goals: Sequence[Goal], progress: Progress = quiet) -> InverseResult:
        """Return the answer to ``goals``, which depends on them and the design alone; see
        ``solve_targets``.
        """
        return self._told(self._answered, goals, progress)

    def solve_quickly(self, goals: Sequence[Goal], progress: Progress = quiet) -> InverseResult:
        """Return an answer near the last one, for a hand on its way: lengths that do it, not the best.

        It is neither sought elsewhere nor checked from rest, and pressures are looked at once. Raises as
        ``solve_targets`` does.
        """
        return self._told(self._near_the_last, goals, progress)

    def conflicts(
        self, reply: InverseResult, goals: Sequence[Goal], progress: Progress = quiet
    ) -> tuple[Conflict, ...]:
        """Return which ``goals`` the last ``solve`` could not meet together. Raises UserError, Cancelled."""
        if reply.reachable or len(goals) < 2:
            return ()
        with one_blas_thread():
            stages = build(reply.design, self._stages)
            self._goals, self._progress = goals, progress
            search = self._begun(stages)
            return conflicts_of(search, goals)

    def current_values(self, names: Collection[str]) -> tuple[dict[str, float], dict[str, float]]:
        """Return what the figures ``names`` are in the design as it is [mm], and what its lines press with.

        These are the largest pressures [kPa] of all lines. Raises UserError.
        """
        with one_blas_thread():
            points = exact_points(self._stages)
            return self.values_at(names, points), largest_pressures(self._stages, points)

    def values_at(self, names: Collection[str], points: Points) -> dict[str, float]:
        """Return what the figures ``names`` are at control points of all regions, ``points`` (n, 3) [mm]."""
        values, _ = self._figures.reader(tuple(names))(points)
        return dict(zip(names, values.tolist(), strict=True))

    def _told(
        self, answered: Callable[[], InverseResult], goals: Sequence[Goal], progress: Progress
    ) -> InverseResult:
        same = [goal.name for goal in goals] == [goal.name for goal in self._goals]
        self._goals, self._progress, self._used = goals, progress, []
        if not same:
            self._search = None
        with one_blas_thread():
            try:
                return answered()
            except NoEquilibriumError:
                self._search = None
                raise NoEquilibriumError(self._stages.design) from None

    # -- the answer

    def _answered(self) -> InverseResult:
        """Return what was found; of what elastics make of it, the nearest that was seen."""
        self._limit.clear()
        search = self._begun(self._stages)
        found = search.result_at(search.minimize())
        if not self._made:
            return self._within_limit(search, found)
        best, rounds = self._reply(found, agreed=False), [(search.start, found.lengths)]
        for _ in range(_LIMIT_ROUNDS):
            try:
                stages = build(search.design_at(_agreed(rounds)), search.stages)
            except LineError:  # beyond the curve of an elastic, or no balance with it
                break
            search = self._begun(stages)
            seen = search.result_at(search.start)
            well = self._is_within_limit(search, seen)
            seen = search.result_at(search.start)  # within the limits that were found just now
            if well and (not best.agreed or self._miss(seen) < best.miss):
                best = self._kept(search, seen, agreed=True)
            elif not best.agreed:  # nearer to the limits than what was found without them
                best = self._kept(search, seen, agreed=False)
            if well and seen.reached:  # a first look is from rest, so this is what the design is solved to
                return best
            found = search.result_at(search.iterate_from(search.start))
            rounds.append((search.start, found.lengths))
            if well and np.abs(found.solution.values - seen.solution.values).max() < NEAR:
                # What keeps the search from here keeps the answer, which is as good as there.
                return replace(
                    best, at_pressure_limit=tuple(sorted({*best.at_pressure_limit, *found.most_tensioned}))
                )
        return replace(best, agreed=False)

    def _within_limit(self, search: Search, found: Candidate) -> InverseResult:
        """Return what was found, or the nearest within the limit of pressure; the model stays the same."""
        for number in range(_LIMIT_ROUNDS if self._limit.applies else 0):
            if self._is_within_limit(search, found, firm=number >= _FIRM_FROM):
                break
            found = search.result_at(search.iterate_from(found.lengths) if number else search.minimize())
        else:
            return self._kept(search, found, agreed=not self._limit.applies)
        return self._kept(search, found, agreed=True)

    def _near_the_last(self) -> InverseResult:
        if self._search is None:
            return self._answered()
        search = self._search
        self._used.append((search, len(search)))
        search.set_goals(self._goals)
        search.progress = self._progress
        found = search.result_at(search.iterate_from(search.start))
        if not self._made:
            if self._limit.applies and not self._is_within_limit(search, found):
                found = search.result_at(search.iterate_from(found.lengths))
            return self._kept(search, found, agreed=True)
        try:
            search = self._begun(build(found.design, search.stages))
        except LineError:
            return self._reply(found, agreed=False)
        well = self._is_within_limit(search, search.result_at(search.start))
        seen = search.result_at(search.start)
        if not (well and seen.reached):
            seen = search.result_at(search.iterate_from(search.start))
        return self._kept(search, seen, agreed=True)

    # -- its parts

    def _begun(self, stages: Stages) -> Search:
        read = self._figures.reader([goal.name for goal in self._goals])
        search = Search(stages, self._goals, self._bounds, self._progress, read)
        search.set_tension_limits(self._limit.hardest)
        search.nearer = lambda found: self.nearer(found.design)
        self._used.append((search, 0))
        return search

    def _is_within_limit(self, search: Search, found: Candidate, *, firm: bool = False) -> bool:
        """Compute what lines press with at what was found, limit their tensions, and tell if all is kept."""
        stages = search.stages.at_lengths(found.design)
        kept = self._limit.is_satisfied(stages, found.solution, search.free, firm=firm)
        search.set_tension_limits(self._limit.hardest)
        return kept

    def _kept(self, search: Search, found: Candidate, *, agreed: bool) -> InverseResult:
        """Return what was found, and go on from there when the next wish is in a hurry."""
        search.start, self._search = found.lengths, search
        return self._reply(found, agreed=agreed)

    def _reply(self, found: Candidate, *, agreed: bool) -> InverseResult:
        design, limit = found.design, self._limit
        values = found.solution.values.tolist()
        return InverseResult(
            design,
            {goal.name: value for goal, value in zip(self._goals, values, strict=True)},
            found.reached and agreed,
            self._miss(found),
            found.at_limit,
            limit.lines_at_limit(found.most_tensioned),
            found.slack,
            found.strained,
            agreed,
            dict(limit.pressure),
            limit.kpa,
            tuple(sorted(design.all_active_lines() - set(limit.pressure))),
            float(np.maximum(found.solution.tensions, 0.0).sum()),
            sum(len(search) - before for search, before in self._used),
            self._bounds.longest,
            self._deviation(found),
            found.solution.points,
        )

    def _deviation(self, found: Candidate) -> float:
        lack = found.solution.values - [goal.value for goal in self._goals]
        return float(np.linalg.norm(goal_weights(self._goals) * lack))

    def _miss(self, found: Candidate) -> float:
        return float(np.abs(found.solution.values - [goal.value for goal in self._goals]).max())


def _agreed(rounds: Sequence[tuple[Floats, Floats]]) -> Floats:
    """Return the lengths at which those of the model and those found with it should be the same.

    ``rounds`` are both, round by round; each line goes on with the slope that the last two rounds showed.
    """
    model, found = rounds[-1]
    if len(rounds) < 3:  # the first search began elsewhere
        return found
    step = model - rounds[-2][0]
    moved = np.abs(step) > 1e-9
    slope = np.clip(np.where(moved, (found - rounds[-2][1]) / np.where(moved, step, 1.0), 0.0), *_SLOPES)
    return model + (found - model) / (1.0 - slope)
