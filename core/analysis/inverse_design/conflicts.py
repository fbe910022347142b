"""Conflicts between targets: what each reaches alone, and what another one loses by it (ours)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from core.analysis.inverse_design.objective import NEAR
from core.analysis.inverse_design.profile_quantities import section_of
from core.analysis.inverse_design.quantities import tolerance
from core.analysis.inverse_design.quantity import PRIORITIES, Goal
from core.analysis.inverse_design.search import Search
from core.geometry.mesh import Floats


@dataclass(frozen=True)
class Conflict:
    """A target that is not met, by its ``name``: that of a quantity, or of a section for its whole profile.

    ``reached`` and ``alone`` [mm] are its values in the compromise and as the only target; those of a profile
    are its mean distance from the target. ``against`` names the other target that loses most by meeting this
    one alone, with its values ``kept`` and ``lost`` [mm] in the compromise and then; it is empty where this
    one does not come nearer alone. ``price`` [mm/mm] is what ``against`` loses per millimetre.
    """

    name: str
    reached: float
    alone: float
    against: str = ""
    kept: float = 0.0
    lost: float = 0.0
    price: float = 0.0


def conflicts_of(search: Search, goals: Sequence[Goal]) -> tuple[Conflict, ...]:
    """Return the conflicts of ``goals`` at the start of a ``search`` for them, one per target that is missed.

    Raises NoEquilibriumError, Cancelled.
    """
    members: dict[str, list[int]] = {}
    for at, goal in enumerate(goals):
        members.setdefault(section_of(goal.name) or goal.name, []).append(at)
    targets = np.array([goal.value for goal in goals])
    here = search.solve_at(search.start).values
    missed = [name for name, rows in members.items() if np.abs(here - targets)[rows].max() >= NEAR]
    if len(members) < 2 or not missed:
        return ()
    return tuple(
        _conflict(name, members, goals, here, search.minimize_single(members[name]).values) for name in missed
    )


def _conflict(
    name: str, members: Mapping[str, list[int]], goals: Sequence[Goal], here: Floats, there: Floats
) -> Conflict:
    """Return the conflict of one target, whose quantities are ``here`` in the compromise, ``there`` alone."""
    targets = np.array([goal.value for goal in goals])
    off = {each: _off((here - targets)[rows]) for each, rows in members.items()}
    then = {each: _off((there - targets)[rows]) for each, rows in members.items()}
    gain = off[name] - then[name]
    shown = {
        each: (off[each], then[each]) if section_of(goals[rows[0]].name) else (here[rows[0]], there[rows[0]])
        for each, rows in members.items()
    }

    def loss(each: str) -> float:
        goal = goals[members[each][0]]
        return (then[each] - off[each]) * PRIORITIES[goal.priority] / tolerance(goal.name)

    against = max((each for each in members if each != name), key=loss)
    reached, alone = (float(value) for value in shown[name])
    if gain < NEAR or then[against] - off[against] < NEAR:
        return Conflict(name, reached, alone)
    kept, lost = (float(value) for value in shown[against])
    return Conflict(name, reached, alone, against, kept, lost, (then[against] - off[against]) / gain)


def _off(lacks: Floats) -> float:
    return float(np.abs(lacks).mean())
