"""Balance of left and right: line lengths with which both sides are alike, as targets (ours)."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace
from math import hypot

import numpy as np

from core.analysis.inverse_design.quantities import reading, tolerance
from core.analysis.inverse_design.quantity import Goal
from core.analysis.inverse_design.solve import InverseResult, solve_targets
from core.analysis.symmetry.compare import NO_BREAST, SideDifference, compare_sides
from core.analysis.symmetry.split_sides import (
    BUST_PAIR,
    ENOUGH,
    SidePair,
    moves_one_side,
    split_sides,
    splittable_lines,
    uneven_pairs,
    worn_pairs,
)
from core.control_mesh.template import read_template
from core.errors import UserError
from core.geometry.mesh import Points
from core.landmarks.types import SIDES
from core.measurements.subject import shows_breast
from core.messages import Message
from core.pipeline.build import Stages, build
from core.pipeline.solve import solve
from core.progress import Progress, quiet

_UNSEEN = 0.1  # [mm]


@dataclass(frozen=True, eq=False)
class BalanceResult:
    """What makes a design even, or nearest to it: the ``result`` to ``goals``, those of evenness first.

    ``pairs`` tell what is to be even. ``rest``, ``before`` and ``after`` are how left and right differ at
    rest, and in the exact answers of the design as it was and as it was found. ``kept`` is how what both
    sides do together went from there to here [mm]. ``split`` names the lines that were split or unlinked.
    """

    pairs: tuple[SidePair, ...]
    result: InverseResult
    goals: tuple[Goal, ...]
    rest: SideDifference
    before: SideDifference
    after: SideDifference
    kept: Mapping[str, tuple[float, float]]
    split: tuple[str, ...]

    def differences(self, told: SideDifference) -> dict[str, float]:
        """Return by how much the sides differ in a comparison [mm], by quantity."""
        return {
            name: value
            for pair in self.pairs
            for name, value in zip(pair.even, pair.differences(told), strict=True)
        }

    @property
    def is_balanced(self) -> bool:
        """Return whether both sides come to lie alike."""
        return max(map(abs, self.differences(self.after).values())) < ENOUGH

    @property
    def gain(self) -> float:
        """Return the decrease of the mirrored distance between the sides [mm]."""
        before, after = (hypot(*self.differences(each).values()) for each in (self.before, self.after))
        return before - after

    @property
    def loss(self) -> float:
        """Return the displacement of both sides together [mm]; girths count by their tolerance."""
        return hypot(*((after - before) / tolerance(name) for name, (before, after) in self.kept.items()))

    @property
    def is_worthwhile(self) -> bool:
        """Return whether it is even, or at least brings more than what it takes away."""
        return self.is_balanced or self.gain > max(self.loss, ENOUGH)


def balance_goals(stages: Stages, points: Points, pair: SidePair = BUST_PAIR) -> tuple[Goal, ...]:
    """Return what to ask for so that left and right come alike and the rest stays: the first the most.

    What both sides do together is to stay as it is at the control points of all regions, (n, 3) [mm]. With
    fewer lengths than wishes the nearest to all of them then takes no more away than it brings.
    """
    kept = _kept(stages, points, (pair,))
    return (*(Goal(name, 0.0) for name in pair.even), *(Goal(name, value) for name, value in kept.items()))


def _kept(stages: Stages, points: Points, pairs: Collection[SidePair]) -> dict[str, float]:
    return {name: reading(stages, name)(points).value for pair in pairs for name in (*pair.held, *pair.kept)}


Ask = Callable[[Stages, tuple[Goal, ...]], InverseResult]


class _Start:
    """A design solved exactly, from which ``pairs`` are made even; ``split`` are the lines parted for it."""

    def __init__(self, stages: Stages, pairs: tuple[SidePair, ...], split: Collection[str], ask: Ask) -> None:
        solution = solve(stages)
        self.stages, self.pairs, self._split, self._ask = stages, pairs, tuple(split), ask
        self.points = np.concatenate(solution.region_points)
        self._told = compare_sides(stages, *solution.region_points)
        self._were = _kept(stages, self.points, pairs)

    def reached(self, goals: tuple[Goal, ...]) -> BalanceResult:
        """Return what the nearest lengths to ``goals`` make of left and right."""
        reply = self._ask(self.stages, goals)
        there = build(reply.design, self.stages)
        again = solve(there)
        values = _kept(there, np.concatenate(again.region_points), self.pairs)
        kept = {name: (self._were[name], value) for name, value in values.items()}
        told, after = self._told, compare_sides(there, *again.region_points).after
        return BalanceResult(self.pairs, reply, goals, told.before, told.after, after, kept, self._split)


def balance_sides(
    stages: Stages,
    shortest: Mapping[str, float] | None = None,
    kept: Collection[str] = (),
    progress: Progress = quiet,
) -> BalanceResult:
    """Return the lengths that bring both sides of a design alike, or as near as is worth it.

    In each region with active lines linked ones are set apart and lines across both sides split first, if
    nothing else moves one side alone. What cannot be kept besides is let go of where that makes it even, or
    brings more than it takes away. Where nothing does, what is returned is not ``worth`` it. ``shortest`` and
    ``kept`` see ``solve_targets``. Raises UserError if a breast is missing, no worn line can move one side
    alone, or nothing balances; Cancelled.
    """

    def ask(there: Stages, goals: tuple[Goal, ...]) -> InverseResult:
        return solve_targets(there, goals, shortest, kept, progress)

    exact = build(replace(stages.design, volume="exact"), stages, progress)
    found, refused = [], []
    for pair in _wanted(exact):
        try:
            if pair is BUST_PAIR:
                _check_breasts(stages)
            found.append(_best(_Start(*_parted(exact, pair, progress), ask)))
        except UserError as problem:
            refused.append(problem)
    if not found:
        raise refused[0]
    worth = [each for each in found if each.is_worthwhile] or found[:1]
    best = worth[0] if len(worth) == 1 else _together(exact, worth, ask)
    design = replace(best.result.design, volume=stages.design.volume)
    return replace(best, result=replace(best.result, design=design))


def _check_breasts(stages: Stages) -> None:
    if not all(shows_breast(stages.landmarks, side) for side in SIDES):
        raise UserError(NO_BREAST, Message("Place the missing bust point, or edit the lines manually."))


def _wanted(stages: Stages) -> tuple[SidePair, ...]:
    """Return what is to be balanced: of several regions those that are not even."""
    pairs = worn_pairs(stages)
    if len(pairs) == 1:
        return pairs
    return uneven_pairs(stages, compare_sides(stages, *solve(stages).region_points).after) or pairs


def _parted(
    stages: Stages, pair: SidePair, progress: Progress
) -> tuple[Stages, tuple[SidePair, ...], tuple[str, ...]]:
    """Return the stages with what had to be parted in the region of a pair. Raises UserError."""
    names: tuple[str, ...] = ()
    if not moves_one_side(stages.regions[pair.region]):
        template = read_template(stages.design.template)
        names = splittable_lines(stages.design, template, pair)
        stages = build(split_sides(stages.design, template, names), stages, progress)
    if not moves_one_side(stages.regions[pair.region]):
        raise UserError(
            Message("No active line can move one side independently."),
            Message("Activate an unlocked line. Busk splits lines across both sides and unlinks pairs."),
        )
    return stages, (pair,), names


def _best(start: _Start) -> BalanceResult:
    """Return what brings the most among those that keep more and less; if any is even, among these."""
    (pair,) = start.pairs
    goals, found = balance_goals(start.stages, start.points, pair), []
    least = len(pair.even) + len(pair.held)

    def tried(count: int) -> bool:
        found.append(start.reached(goals[:count]))
        return found[-1].result.reachable

    # What evenness alone does not reach it does not reach with more to keep either: that is not looked for.
    if not tried(len(goals)) and tried(least):
        tried(least + 1)
    # Of several that bring as much, to what cannot be seen, the one that keeps the most.
    return max(
        found,
        key=lambda each: (each.is_balanced, round((each.gain - each.loss) / _UNSEEN), len(each.goals)),
    )


def _together(stages: Stages, found: Collection[BalanceResult], ask: Ask) -> BalanceResult:
    """Return what is found for several regions as one result."""
    split = [name for each in found for name in each.split]
    parted = split_sides(stages.design, read_template(stages.design.template), split)
    pairs = tuple(pair for each in found for pair in each.pairs)
    start = _Start(build(parted, stages), pairs, split, ask)
    return start.reached(tuple(goal for each in found for goal in each.goals))
