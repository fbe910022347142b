"""Make even: the lengths of left and right lines that bring both bust points alike, as a request (ours)."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace

from core.advice.parting import ENOUGH, moves_one_side, partable, parted
from core.aims.answers import free_lines
from core.aims.bust import LIFT, OUT
from core.aims.even import FURTHER_OUT, HIGHER
from core.aims.figure import Goal
from core.aims.readings import reading
from core.errors import UserError
from core.evenness import NO_BREAST, Evenness, evenness
from core.landmark import SIDES
from core.measuring.subject import shows_breast
from core.mesh import Points
from core.pipeline import Stages, build
from core.progress import Progress, quiet
from core.request import Reply, ask
from core.solution import run
from core.template import read_template

EVEN = (Goal(HIGHER, 0.0), Goal(FURTHER_OUT, 0.0))
"""Both bust points equally high and equally far out."""

_ALIKE = 0.5  # of two replies that are so nearly as even, the one that keeps more [mm]


@dataclass(frozen=True, eq=False)
class Evened:
    """What makes a design even, or nearest to it: the ``reply`` to ``goals``, those of evenness first.

    ``rest``, ``before`` and ``after`` are how left and right differ at rest, and in the exact answers of the
    design as it was and as it was found. ``parted`` names the lines that were split or unlinked for it.
    """

    reply: Reply
    goals: tuple[Goal, ...]
    rest: Evenness
    before: Evenness
    after: Evenness
    parted: tuple[str, ...]

    @property
    def even(self) -> bool:
        """Whether both bust points come to lie alike."""
        return self.after.furthest < ENOUGH


def even_goals(stages: Stages, control_points: Points) -> tuple[Goal, ...]:
    """Return what to ask for so that left and right come alike and the rest stays: the first the most.

    Lift and way out of both together are to stay as they are at ``control_points`` (n, 3) [mm], as far as
    there are lengths left for it: else least tension would undo the garment.
    """
    kept = [Goal(name, reading(stages, name)(control_points).value) for name in (LIFT, OUT)]
    left = max(len(list(free_lines(stages))) - len(EVEN), 0)
    return (*EVEN, *kept[:left])


def make_even(
    stages: Stages,
    shortest: Mapping[str, float] | None = None,
    kept: Collection[str] = (),
    progress: Progress = quiet,
) -> Evened:
    """Return the lengths that bring both bust points of a design alike, or as near as they can.

    Pairs are set apart and lines across both sides split first, if nothing else moves one side alone. What
    cannot be kept besides is let go of. ``shortest`` and ``kept`` see ``ask``. Raises UserError if a breast
    is missing, no worn line can move one side alone, or nothing balances; Cancelled.
    """
    if not all(shows_breast(stages.landmarks, side) for side in SIDES):
        raise UserError(NO_BREAST, "Place its bust point, or change lines by hand.")
    exact = build(replace(stages.design, volume="exact"), stages, progress)
    names: tuple[str, ...] = ()
    if not moves_one_side(exact):
        template = read_template(exact.design.template)
        names = partable(exact.design, template)
        exact = build(parted(exact.design, template), exact, progress)
    if not moves_one_side(exact):
        raise UserError(
            "No worn line can move one side alone.",
            "Wear a line that is not locked: one across both sides is split, a pair set apart.",
        )
    here = run(exact).control_points
    reply, goals = _asked(exact, even_goals(exact, here), shortest, kept, progress)
    there = build(reply.design, exact, progress)
    told = evenness(exact, here)
    after = evenness(there, run(there).control_points).after
    design = replace(reply.design, volume=stages.design.volume)
    return Evened(replace(reply, design=design), goals, told.before, told.after, after, names)


def _asked(
    stages: Stages,
    goals: tuple[Goal, ...],
    shortest: Mapping[str, float] | None,
    kept: Collection[str],
    progress: Progress,
) -> tuple[Reply, tuple[Goal, ...]]:
    """Return the reply that keeps most of what there is among those that make it about as even."""
    best: tuple[float, Reply, tuple[Goal, ...]] | None = None
    for count in range(len(goals), len(EVEN) - 1, -1):
        wanted = goals[:count]
        reply = ask(stages, wanted, shortest, kept, progress)
        uneven = max(abs(reply.reached[goal.name]) for goal in EVEN)
        if best is None or uneven < best[0] - _ALIKE:
            best = uneven, reply, wanted
        if reply.reachable:
            break
    assert best is not None
    return best[1:]
