"""Search for the line lengths that reach the targets with the least tension (ours).

The exact answer tells how each figure moves with each length (``sensitivity``), so a few answers
lead to the wished one. First the nearest that the lines can do is found; if that is what was wished, the
least tension among all lengths that do it.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from itertools import chain
from typing import Any

import numpy as np
from scipy.optimize import minimize

from core.analysis.inverse_design.objective import Objective, Slopes, goal_weights, total_tension
from core.analysis.inverse_design.quadratic_model import next_trust_radius, updated_curvature
from core.analysis.inverse_design.quantities import QuantityReaders
from core.analysis.inverse_design.quantity import Goal, ReadMany
from core.analysis.inverse_design.sensitivities import PERCENT, LinearizedSolution, LinearizedSolutions
from core.document.design import Design
from core.errors import UserError
from core.garment.tension import SLACK
from core.geometry.mesh import Floats
from core.mechanics.constraint_lines import RATIO_LIMITS
from core.mechanics.exact_solution import NEWTON_LIMIT
from core.messages import Message
from core.pipeline.active_lines import LineGroup, active_line_groups, all_free_lines
from core.pipeline.build import Stages
from core.pipeline.solve import NoEquilibriumError
from core.progress import Progress, quiet

LOOSEST = 1.0
"""A line is not asked to be longer than at rest: it would push [1]."""

_PUSH = 0.5 * SLACK  # half of what counts as none: a run ends a hair beside its exact answer [N]

_STEPS, _ELSEWHERE = 24, 12  # answers after which a search is given up, from the start and from elsewhere

_HALFWAY = 0.9  # ratio at which a search begins anew

_TRIES, _GOOD = 12, 1e-3  # steps to less tension, and a part of it that is not worth another

_BOLD, _LAST = 8.0, 0.01  # the longest step tried at first, and one that can no longer be told [%]

_SHORTEST = 1e-4  # a step to what is wanted [%]

_EXACT = 1e-8  # [mm^2]

_LITTLE = 1e-6  # a step that brings no more than this is the last one [mm^2]

_TELLS = 0.002  # or one that brings no more than this nearer [mm]

_QUICK = 16  # Newton steps after which a step was too bold

_BESIDE = 0.5  # so near to where another start led, and no better, it leads there as well [%]

_AT_LIMIT = 1e-3  # room to a limit [1]

_AT_END = 0.01  # [%]


@dataclass(frozen=True, eq=False)
class Candidate:
    """A design with the ``lengths`` that were found [%], the exact answer there, and what keeps it there.

    ``reached`` tells whether the answer is what was asked for. ``at_limit`` names the lines as short or as
    long
    as they may be, ``most_tensioned`` those with the most tension they may have, ``slack`` those that would
    push if they were longer; ``strained`` tells that the shape would strain beyond what looks natural.
    """

    design: Design
    lengths: Floats
    solution: LinearizedSolution
    reached: bool
    at_limit: tuple[str, ...]
    most_tensioned: tuple[str, ...]
    slack: tuple[str, ...]
    strained: bool


@dataclass(frozen=True)
class Bounds:
    """What lines may do: ``shortest`` [1] are least ratios by name; those ``kept`` stay as locked ones do.

    None gets longer than ``longest`` [1].
    """

    shortest: Mapping[str, float]
    kept: Collection[str] = ()
    longest: float = LOOSEST


class Search:
    """The free lengths of a design as unknowns, shape (p,) [%], and what is wanted of them.

    ``start`` are the lengths that it has. ``nearer`` hears of what was found before it is looked for
    elsewhere. Raises UserError if no line is free or nothing is asked.
    """

    def __init__(
        self,
        stages: Stages,
        goals: Sequence[Goal],
        bounds: Bounds,
        progress: Progress = quiet,
        read: ReadMany | None = None,
    ) -> None:
        self.stages, self.progress = stages, progress
        read = QuantityReaders(stages).reader([goal.name for goal in goals]) if read is None else read
        self._groups = _asked(stages, all_free_lines(stages, bounds.kept), read)
        if not goals or not self._groups:
            raise UserError(
                Message("No unlocked line moves the body."),
                Message("Activate an unlocked line, and set a target."),
            )
        self._answers = LinearizedSolutions(stages, self._groups, read)
        self.nearer: Callable[[Candidate], object] = lambda found: None
        low = [
            max(RATIO_LIMITS[0], *(bounds.shortest.get(name, 0.0) for name in each)) for each in self._groups
        ]
        self._low, self._high = np.array(low) / PERCENT, np.maximum(low, bounds.longest) / PERCENT
        values, lines = np.array([goal.value for goal in goals]), [line.name for line in stages.lines]
        self._wanted = Objective(values, goal_weights(goals), self._low, self._high, lines)
        set_ = [stages.design.ratio(group[0]) / PERCENT for group in self._groups]
        self.start = np.clip(set_, self._low, self._high)
        self._bar_pushing()

    def __len__(self) -> int:
        """Return the number of answers that were worked out."""
        return len(self._answers)

    @property
    def free(self) -> frozenset[str]:
        """Return the names of the lines that may change."""
        return frozenset(name for group in self._groups for name in group)

    def set_goals(self, goals: Sequence[Goal]) -> None:
        """Set new values or priorities of the same targets."""
        self._wanted.values = np.array([goal.value for goal in goals])
        self._wanted.weights = goal_weights(goals)

    def set_tension_limits(self, hardest: Mapping[str, float]) -> None:
        """Let named lines pull no harder than so [N] from now on."""
        self._wanted.hardest = dict(hardest)

    def _bar_pushing(self) -> None:
        """Let no line push, as no band can; one that stays and pushes at the start may push no more."""
        groups = chain.from_iterable(map(active_line_groups, self.stages.regions))
        acting = set(chain.from_iterable(groups))
        names = [line.name for line in self.stages.lines if line.name in acting]
        free, loosest = self.free, dict.fromkeys(names, -_PUSH)
        if not free.issuperset(names) and (look := self._look(self.start)) is not None:
            pulls = zip((line.name for line in self.stages.lines), look.tensions.tolist(), strict=True)
            loosest |= {name: min(-_PUSH, pull) for name, pull in pulls if name in acting - free}
        self._wanted.loosest = loosest

    def solve_at(self, lengths: Floats, limit: int = NEWTON_LIMIT) -> LinearizedSolution:
        """Return the exact answer at ``lengths``. Raises NoEquilibriumError, Cancelled."""
        self.progress("asking", min(len(self) / _STEPS, 1.0))
        return self._answers(lengths, limit)

    def minimize(self) -> Floats:
        """Return the lengths that come nearest to what is wanted, with the least tension if they reach it.

        Raises NoEquilibriumError if there is no balance at the start, Cancelled.
        """
        lengths = self._least_tension(self._near_by())
        met = self._wanted.is_met(self.solve_at(lengths))
        if self._answers.is_reachable_from_original(lengths):
            return lengths
        near = self.iterate_from(
            lengths
        )  # what rest leads to is mostly not far away, nor is the least tension
        return (
            near if self._wanted.is_met(self.solve_at(near)) >= met else self._least_tension(self._near_by())
        )

    def minimize_single(self, chosen: Collection[int]) -> LinearizedSolution:
        """Return the answer nearest to the ``chosen`` of the goals, by number, where the others are free.

        Raises NoEquilibriumError, Cancelled.
        """
        every, nearer = self._wanted, self.nearer
        self._wanted, self.nearer = every.subset(chosen), lambda found: None
        try:
            return self.solve_at(self._near_by())
        finally:
            self._wanted, self.nearer = every, nearer

    def _near_by(self) -> Floats:
        """Return the nearest from the start or, if that does not reach what is wanted, from elsewhere."""
        best = self.iterate_from(self.start)
        known, starts = [best], self._elsewhere()
        while not self._wanted.is_met(self.solve_at(best)) and (begin := next(starts, None)) is not None:
            self.nearer(self.result_at(best))
            known.append(self.iterate_from(begin, known))
            best = min(best, known[-1], key=self._amiss_at)
        return best

    def _elsewhere(self) -> Iterator[Floats]:
        """Yield other starts: all lines at rest, all halfway, and the best with one of them alone halfway."""
        rest = np.clip(np.full(len(self.start), 1.0 / PERCENT), self._low, self._high)
        halfway = np.clip(np.full(len(self.start), _HALFWAY / PERCENT), self._low, self._high)
        for begin in (rest, halfway):
            if not np.array_equal(begin, self.start) and self._look(begin) is not None:
                yield begin
        if len(rest) > 1:
            alone = np.where(np.eye(len(rest), dtype=bool), halfway, rest)
            found = [begin for begin in alone if self._look(begin) is not None]
            if found:
                yield min(found, key=self._amiss_at)

    def _amiss_at(self, lengths: Floats) -> float:
        return self._wanted.violation(self.solve_at(lengths))

    def iterate_from(self, start: Floats, known: Sequence[Floats] = ()) -> Floats:
        """Return where steps after Gauss and Newton lead from ``start``, none of them too bold.

        Each learns how slopes change on the way. Beside one of those ``known`` already they go no further.
        Nothing is looked for elsewhere or from rest. Raises NoEquilibriumError if nothing balances at the
        start, Cancelled.
        """
        here, reach, most = start, _BOLD, len(self) + (_ELSEWHERE if known else _STEPS)
        look, wanted = self.solve_at(here), self._wanted
        amiss, finest = wanted.violation(look), self._wanted.smallest_weight_ratio
        bends = np.zeros((*wanted.residual_rows(look)[1].shape, len(here)))
        while reach > _LAST and len(self) < most and amiss > _EXACT * finest**2:
            if (other := self._beside(here, amiss, known)) is not None:
                return other
            there, left = wanted.next_lengths(here, look, reach, bends)
            step, little = there - here, max(_LITTLE * finest**2, 2.0 * _TELLS * finest * amiss**0.5)
            if np.abs(step).max() < _SHORTEST or amiss - left < little:
                break
            seen = self._look(there, _QUICK)
            if seen is None:
                reach = float(np.abs(step).max()) / 4.0
                continue
            bends = updated_curvature(
                bends, step, wanted.residual_rows(seen)[1] - wanted.residual_rows(look)[1]
            )
            gain = amiss - wanted.violation(seen)
            if gain <= 0.0:
                reach = float(np.abs(step).max()) / 2.0
                continue
            reach = next_trust_radius(reach, _BOLD, gain / (amiss - left))
            # Near enough, and no longer quickly nearer.
            last = gain < little or (gain < 0.5 * amiss and wanted.is_met(seen))
            here, look, amiss = there, seen, amiss - gain
            if last:
                break
        return here

    def _beside(self, here: Floats, amiss: float, known: Sequence[Floats]) -> Floats | None:
        """Return that of the ``known`` lengths which these are beside, and no better."""
        for other in known:
            if np.abs(here - other).max() < _BESIDE and amiss >= self._amiss_at(other):
                return other
        return None

    def _least_tension(self, start: Floats) -> Floats:
        """Return lengths that reach what ``start`` reaches with less tension; ``start`` if none are found."""
        before = self.solve_at(start)
        if not self._wanted.is_met(before) or len(start) <= len(self._wanted.values):
            return start
        unit = max(float(np.abs(before.tensions).sum()), 1e-9)

        def tension(lengths: Floats) -> Slopes:
            return total_tension(self.solve_at(lengths), unit)

        wanted = _constraint(
            "eq", lambda at: (self.solve_at(at).values - self._wanted.values, self.solve_at(at).by_values)
        )
        limits = _constraint(
            "ineq", lambda at: [part / PERCENT for part in self._wanted.smooth_margins(self.solve_at(at))]
        )
        try:
            found = self._least(tension, start, [wanted, limits])
            if not self._wanted.is_met(self.solve_at(found)):
                found = self.iterate_from(found)
            after = self.solve_at(found)
        except NoEquilibriumError:
            return start
        less = total_tension(after, unit)[0] < total_tension(before, unit)[0]
        return found if self._wanted.is_met(after) and less else start

    def design_at(self, lengths: Floats) -> Design:
        """Return the design with its lines at ``lengths``."""
        set_ = [round(float(length) * PERCENT, 6) for length in lengths]
        both = zip(self._groups, set_, strict=True)
        ratios = [(name, ratio) for group, ratio in both for name in group]
        return reduce(lambda design, each: design.with_line(*each), ratios, self.stages.design)

    def result_at(self, lengths: Floats) -> Candidate:
        """Return what was found at ``lengths``."""
        look = self.solve_at(lengths)
        ends = np.abs(np.stack([lengths - self._low, lengths - self._high])).min(axis=0) < _AT_END
        at_end = tuple(
            name for group, there in zip(self._groups, ends, strict=True) if there for name in group
        )
        hardest, loosest = self._wanted.hardest, self._wanted.loosest
        tight = self._wanted.margins(look)[0] < _AT_LIMIT
        pulls, pushes, strains = np.split(tight, [len(hardest), len(hardest) + len(loosest)])
        pulled = tuple(name for name, there in zip(hardest, pulls, strict=True) if there)
        slack = tuple(name for name, there in zip(loosest, pushes, strict=True) if there)
        met, strained = self._wanted.is_met(look), bool(strains.any())
        return Candidate(self.design_at(lengths), lengths, look, met, at_end, pulled, slack, strained)

    def _look(self, lengths: Floats, limit: int = NEWTON_LIMIT) -> LinearizedSolution | None:
        try:
            return self.solve_at(lengths, limit)
        except NoEquilibriumError:
            return None

    def _least(
        self, figure: Callable[[Floats], Slopes], start: Floats, constraints: list[dict[str, Any]]
    ) -> Floats:
        """Return where ``figure`` is least under ``constraints``."""
        how: dict[str, Any] = {"jac": True, "bounds": list(zip(self._low, self._high, strict=True))}
        how |= {"constraints": constraints, "options": {"maxiter": _TRIES, "ftol": _GOOD}}
        found = minimize(figure, start, method="SLSQP", **how)
        return np.asarray(np.clip(found.x, self._low, self._high))


def _asked(stages: Stages, groups: Sequence[LineGroup], read: ReadMany) -> tuple[LineGroup, ...]:
    """Return the groups of lines in regions that what is read depends on: others keep their lengths."""
    if len(stages.regions) == 1:
        return tuple(groups)
    _, slopes = read(stages.rest_points)
    regions = zip(stages.regions, stages.region_rows, strict=True)
    asked = [region for region, rows in regions if slopes[:, rows].any()]
    return tuple(group for group in groups if any(stages.region_of(name) in asked for name in group))


def _constraint(kind: str, figures: Callable[[Floats], Sequence[Floats]]) -> dict[str, Any]:
    """Return the constraint that ``figures``, values and slopes, are nothing or at least nothing."""
    return {"type": kind, "fun": lambda at: figures(at)[0], "jac": lambda at: figures(at)[1]}
