"""Ask for the result: the lengths of lines that bring the body to what is wished (ours).

The search works on one model. Lines made of elastics have other stiffnesses at other lengths, and what bands
press with follows from the shape they lie on: both are looked at after an answer, and it is asked again from
there with what was learnt, until figures and pressures agree.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from threadpoolctl import threadpool_limits

from core.aims.answers import Look, NoBalanceError
from core.aims.figure import Goal
from core.aims.reaching import NEAR, Bounds, Found, Search
from core.cutting import goes_on
from core.design import Design, cannot_hold, no_balance
from core.errors import LineError
from core.mesh import Floats
from core.pipeline import Stages, build
from core.pressure import pressures
from core.progress import Progress, quiet
from core.sewing.comfort import comfort
from core.sewing.tensions import line_tensions
from core.solving.newtons import newtons_per_unit

_ROUNDS = 6
_TOO_MUCH = 1.01  # over the limit of pressure, at which it counts as kept


@dataclass(frozen=True, eq=False)
class Reply:
    """What can be done: the ``design`` with the lengths found, and what its exact answer ``reached`` [mm].

    ``reachable`` tells whether that is what was asked for, ``miss`` [mm] what the worst figure lacks. If not,
    there is a reason: lines ``at_end`` are as short or as long as they may be, lines that are ``pressing`` do
    so as hard as they may, ``strained`` is a shape that would strain beyond what looks natural; without any
    the lines do not move it that way. ``agreed`` is False where lengths, elastics and pressures did not come
    to agree: there may be better. ``pressure`` [kPa] is the largest of
    each line that was looked at, ``unseen`` are the worn lines that were not. ``tension`` [N] is the sum over
    the lines, an estimate where they are made of no elastic; ``answers`` how many were worked out.
    """

    design: Design
    reached: Mapping[str, float]
    reachable: bool
    miss: float
    at_end: tuple[str, ...]
    pressing: tuple[str, ...]
    strained: bool
    agreed: bool
    pressure: Mapping[str, float]
    unseen: tuple[str, ...]
    tension: float
    answers: int


def ask(
    stages: Stages,
    goals: Sequence[Goal],
    shortest: Mapping[str, float] | None = None,
    kept: Collection[str] = (),
    progress: Progress = quiet,
) -> Reply:
    """Return the lengths of the worn lines that bring the body to ``goals``, or as near as they can.

    ``shortest`` [1] are ratios that named lines may not go below; locked lines and those ``kept`` stay.
    Lines made of elastic press no more than the red light begins with. Raises UserError if no worn line is
    free, nothing is asked, or nothing balances at the start; Cancelled.
    """
    bounds = Bounds(shortest or {}, kept)
    # Two BLAS threads make these small products many times slower.
    with threadpool_limits(1):
        try:
            return _Rounds(stages, goals, bounds, progress).reply()
        except NoBalanceError:
            held = stages.design.line_hold == "held"
            raise (cannot_hold(stages.design) if held else no_balance()) from None


class _Rounds:
    """Asked again and again, each time from the design that was found last."""

    def __init__(self, stages: Stages, goals: Sequence[Goal], bounds: Bounds, progress: Progress) -> None:
        self._goals, self._progress = goals, progress
        self._made = {} if stages.design.line_hold == "held" else stages.design.worn_elastics()
        shortest = dict(bounds.shortest)
        for name, elastic in self._made.items():
            # As if the line did not move the body: beyond that its elastic is not known.
            shortest[name] = max(shortest.get(name, 0.0), 1.0 / (1.0 + elastic.reach))
        self._bounds = replace(bounds, shortest=shortest)
        self._hardest: dict[str, float] = {}
        self._pressure: dict[str, float] = {}
        self._newtons = newtons_per_unit(stages.model, stages.design.tissue_stiffness)
        self._answers = 0
        self._search = self._begun(stages)

    def reply(self) -> Reply:
        """Return what was found; of what elastics make of it, the nearest that was seen."""
        stages, found = self._search.stages, self._found(self._search.least())
        if not self._made:
            return self._reply(found, agreed=True)
        best = self._reply(found, agreed=False)
        for _ in range(_ROUNDS):
            try:
                stages = build(found.design, stages)
            except LineError:  # beyond the curve of an elastic, or no balance with it
                break
            self._search = self._begun(stages)
            well = self._presses_well(stages, self._search.at(self._search.start))
            seen = self._search.found(self._search.start)
            if well and (not best.agreed or self._miss(seen) < best.miss):
                best = self._reply(seen, agreed=True)
            found = self._found(self._search.nearest())
            if well and (seen.reached or np.abs(found.look.values - seen.look.values).max() < NEAR):
                return best
        return replace(best, agreed=False)

    def _begun(self, stages: Stages) -> Search:
        return Search(stages, self._goals, self._bounds, self._progress)

    def _found(self, lengths: Floats) -> Found:
        self._answers += len(self._search)
        return self._search.found(lengths)

    def _presses_well(self, stages: Stages, look: Look) -> bool:
        """Look at what lines press with, limit what those that press too much may pull, and tell if none did.

        Only lines whose tension is known from an elastic are looked at, and for which the limit was set.
        """
        limit, lines = comfort().red_kpa, stages.model.lines
        tensions = line_tensions(stages, look.points)
        seen = {line.name for line in lines if not goes_on(stages, line)} & set(self._made)
        worn = pressures(stages, look.points)
        self._pressure = {name: worn[name].largest for name in sorted(seen) if not tensions[name].estimate}
        pulls = {line.name: float(pull) for line, pull in zip(lines, look.pulls, strict=True)}
        for name, kpa in self._pressure.items():
            if pulls[name] > 0.0 and (kpa > limit or name in self._hardest):
                self._hardest[name] = pulls[name] * limit / kpa
        self._search.hardest = self._hardest
        return all(kpa < _TOO_MUCH * limit for kpa in self._pressure.values())

    def _reply(self, found: Found, *, agreed: bool) -> Reply:
        design, limit = found.design, comfort().red_kpa / _TOO_MUCH**2
        values = found.look.values.tolist()
        return Reply(
            design,
            {goal.name: value for goal, value in zip(self._goals, values, strict=True)},
            found.reached and agreed,
            self._miss(found),
            found.at_end,
            tuple(name for name, kpa in self._pressure.items() if kpa > limit),
            found.strained,
            agreed,
            dict(self._pressure),
            tuple(sorted(design.worn() - set(self._pressure))),
            self._newtons * float(np.maximum(found.look.pulls, 0.0).sum()),
            self._answers,
        )

    def _miss(self, found: Found) -> float:
        return float(np.abs(found.look.values - [goal.value for goal in self._goals]).max())
