"""Balance of left and right: line lengths with which both bust points are alike, as targets (ours)."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace
from math import hypot

from core.analysis.inverse_design.bust_quantities import FURTHER_OUT, HIGHER, LIFT, OUT
from core.analysis.inverse_design.quantities import reading
from core.analysis.inverse_design.quantity import Goal
from core.analysis.inverse_design.solve import InverseResult, solve_targets
from core.analysis.symmetry.compare import NO_BREAST, SideDifference, compare_sides
from core.analysis.symmetry.split_sides import ENOUGH, moves_one_side, split_sides, splittable_lines
from core.control_mesh.template import read_template
from core.errors import UserError
from core.geometry.mesh import Points
from core.landmarks.types import SIDES
from core.measurements.subject import shows_breast
from core.messages import Message
from core.pipeline.build import Stages, build
from core.pipeline.solve import solve
from core.progress import Progress, quiet

EVEN = (Goal(HIGHER, 0.0), Goal(FURTHER_OUT, 0.0))
"""Both bust points equally high and equally far out."""

_UNSEEN = 0.1  # [mm]

KEPT = (LIFT, OUT)
"""What is to stay of both sides together: else least tension would undo the garment."""


@dataclass(frozen=True, eq=False)
class BalanceResult:
    """What makes a design even, or nearest to it: the ``result`` to ``goals``, those of evenness first.

    ``rest``, ``before`` and ``after`` are how left and right differ at rest, and in the exact answers of the
    design as it was and as it was found. ``kept`` is how lift and way out went from there to here [mm].
    ``split`` names the lines that were split or unlinked for it.
    """

    result: InverseResult
    goals: tuple[Goal, ...]
    rest: SideDifference
    before: SideDifference
    after: SideDifference
    kept: Mapping[str, tuple[float, float]]
    split: tuple[str, ...]

    @property
    def is_balanced(self) -> bool:
        """Return whether both bust points come to lie alike."""
        return self.after.largest_difference < ENOUGH

    @property
    def gain(self) -> float:
        """Return the decrease of the mirrored distance between the bust points [mm]."""
        return self.before.distance - self.after.distance

    @property
    def loss(self) -> float:
        """Return the displacement of both sides together, in height and forward [mm]."""
        return hypot(*(after - before for before, after in self.kept.values()))

    @property
    def is_worthwhile(self) -> bool:
        """Return whether it is even, or at least brings more than what it takes away."""
        return self.is_balanced or self.gain > max(self.loss, ENOUGH)


def balance_goals(stages: Stages, control_points: Points) -> tuple[Goal, ...]:
    """Return what to ask for so that left and right come alike and the rest stays: the first the most.

    Lift and way out of both together are to stay as they are at ``control_points`` (n, 3) [mm]. With fewer
    lengths than wishes the nearest to all of them then takes no more away than it brings.
    """
    return (*EVEN, *(Goal(name, value) for name, value in _kept(stages, control_points).items()))


def _kept(stages: Stages, control_points: Points) -> dict[str, float]:
    return {name: reading(stages, name)(control_points).value for name in KEPT}


def balance_sides(
    stages: Stages,
    shortest: Mapping[str, float] | None = None,
    kept: Collection[str] = (),
    progress: Progress = quiet,
) -> BalanceResult:
    """Return the lengths that bring both bust points of a design alike, or as near as is worth it.

    Pairs are set apart and lines across both sides split first, if nothing else moves one side alone. What
    cannot be kept besides is let go of where that makes it even, or brings more than it takes away. Where
    nothing does, what is returned is not ``worth`` it. ``shortest`` and ``kept`` see ``solve_targets``.
    Raises
    UserError if a breast is missing, no worn line can move one side alone, or nothing balances; Cancelled.
    """
    if not all(shows_breast(stages.landmarks, side) for side in SIDES):
        raise UserError(NO_BREAST, Message("Place the missing bust point, or edit the lines manually."))
    exact = build(replace(stages.design, volume="exact"), stages, progress)
    names: tuple[str, ...] = ()
    if not moves_one_side(exact):
        template = read_template(exact.design.template)
        names = splittable_lines(exact.design, template)
        exact = build(split_sides(exact.design, template), exact, progress)
    if not moves_one_side(exact):
        raise UserError(
            Message("No active line can move one side independently."),
            Message("Activate an unlocked line. Busk splits lines across both sides and unlinks pairs."),
        )
    best = _best(exact, names, lambda goals: solve_targets(exact, goals, shortest, kept, progress))
    design = replace(best.result.design, volume=stages.design.volume)
    return replace(best, result=replace(best.result, design=design))


def _best(
    stages: Stages, names: tuple[str, ...], asked: Callable[[tuple[Goal, ...]], InverseResult]
) -> BalanceResult:
    """Return what brings the most among those that keep more and less; if any is even, among these."""
    solved = solve(stages)
    here = solved.control_points
    told, found = compare_sides(stages, *solved.region_points), []
    were, goals = _kept(stages, here), balance_goals(stages, here)

    def tried(count: int) -> bool:
        reply = asked(goals[:count])
        there = build(reply.design, stages)
        again = solve(there)
        kept = {name: (were[name], value) for name, value in _kept(there, again.control_points).items()}
        after = compare_sides(there, *again.region_points).after
        found.append(BalanceResult(reply, goals[:count], told.before, told.after, after, kept, names))
        return reply.reachable

    # What evenness alone does not reach it does not reach with more to keep either: that is not looked for.
    if not tried(len(goals)) and tried(len(EVEN)):
        tried(len(EVEN) + 1)
    # Of several that bring as much, to what cannot be seen, the one that keeps the most.
    return max(
        found,
        key=lambda each: (each.is_balanced, round((each.gain - each.loss) / _UNSEEN), len(each.goals)),
    )
