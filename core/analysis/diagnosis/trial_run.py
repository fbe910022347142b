"""How a design stands when it is run from rest as the window runs it: well, or with what complaint."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from core.geometry.mesh import Points
from core.mechanics.convergence import SETTLED_STEP, Verdict
from core.mechanics.iteration import State, at_rest, turn
from core.mechanics.solver_comparison import MOST_TURNS, TURN_CONTROLS, Run, carried, shape_of
from core.pipeline.build import Stages, targets_of
from core.pipeline.exact import balance_of
from core.pipeline.solve import run
from core.progress import Progress, quiet

COMPLAINTS = ("strained", "settling", "overstrained", "folded", "vibrating", "diverging", "unreachable")
"""What can be wrong, from the mildest to the worst: what a run is told as, and lengths without a balance."""

_LATE = 24  # turns over which a swing is taken out of where a run stands
_EARLIER, _LATEST = slice(-2 * _LATE, -_LATE), slice(-_LATE, None)
_SEEN = 100  # turns before which nothing is plain
_CLEARLY = 10.0  # times the step of a run that has settled


@dataclass(frozen=True, eq=False)
class Ran:
    """How turns ended: the last ``state``, and its ``verdict``.

    ``middle`` (f, 3) [mm] is where points were on the whole in the last turns: what swings does so about it.
    """

    state: State
    verdict: Verdict
    middle: Points


@dataclass(frozen=True, eq=False)
class Standing:
    """A design that was run; ``complaint`` is one of COMPLAINTS, or empty if it is well."""

    stages: Stages
    ran: Ran
    complaint: str
    _beside: dict[str, Ran] = field(default_factory=dict, repr=False)

    @property
    def verdict(self) -> Verdict:
        """How the run ended."""
        return self.ran.verdict

    @property
    def control_points(self) -> Points:
        """Where the run ended, shape (n, 3) [mm]."""
        return self.stages.model.tensegric.expand(self.ran.state.moved)

    @property
    def rank(self) -> int:
        """How bad it is: 0 if it is well."""
        return rank_of(self.complaint)

    def beside(self, control: str, progress: Progress = quiet) -> Ran:
        """Return the run of another control of the same design; it is made once."""
        if control == self.stages.design.volume:
            return self.ran
        if control not in self._beside:
            self._beside[control] = _turned(self.stages, control, progress)
        return self._beside[control]


def rank_of(complaint: str) -> int:
    """Return how bad a complaint is: 0 if it is none."""
    return COMPLAINTS.index(complaint) + 1 if complaint else 0


def standing(stages: Stages, progress: Progress = quiet, *, trial: bool = False) -> Standing:
    """Run a design from rest and tell how it stands.

    As in the window a design whose lengths are held, or that asks for the exact answer, must have one. A
    ``trial`` is given up once it is plain that it swings, or has no balance. ``progress`` hears each turn;
    raises Cancelled.
    """
    held, exact = stages.design.line_hold == "held", stages.design.volume == "exact"
    ran = _solved(stages, progress) if exact else None
    nowhere = ran.verdict.motion != "settled" if ran else held and trial and not balance_of(stages).found
    if ran is None:
        ran = _nothing(stages) if nowhere else _turned(stages, stages.design.volume, progress, trial=trial)
    told = ran.verdict.told
    if held and not exact and not nowhere:
        nowhere = told == "diverging" or not (trial or balance_of(stages).found)
    return Standing(stages, ran, "unreachable" if nowhere else "" if told == "settled" else told)


def gone_on(before: Standing, stages: Stages, progress: Progress = quiet) -> Ran | None:
    """Return how turns end that go on under a changed design from where a run stands, as in the window.

    None where they do not: an exact answer starts from rest, and so does what follows a refusal, or a run
    that diverged or did not converge. Another control goes on from where its own run stands, made beside the
    one that is shown. Back from a fold turns come slowly: who has not come to rest is watched once more, as
    the window does.
    """
    control, old, design = stages.design.volume, before.stages.model, before.stages.design
    if before.complaint == "unreachable" or control not in {*TURN_CONTROLS, design.volume}:
        return None
    if control == "exact":
        return None
    stood = before.beside(control, progress)
    if stood.verdict.motion in ("diverging", "settling"):
        return None
    state = stood.state if stages.model is old else carried(stood.state, old, stages.model)
    return _turned(stages, control, progress, replace(state, turn=0), trial=True, patient=True)


def _nothing(stages: Stages) -> Ran:
    """Return what stands where nothing was run: the body at rest."""
    state = at_rest(stages.model)
    return Ran(state, Verdict("settling", 0, 0.0), state.moved)


def _solved(stages: Stages, progress: Progress) -> Ran:
    solution = run(stages, progress=progress)
    return Ran(solution.state, solution.verdict, solution.state.moved)


def _turned(
    stages: Stages,
    control: str,
    progress: Progress,
    start: State | None = None,
    *,
    trial: bool = False,
    patient: bool = False,
) -> Ran:
    """Make turns from ``start`` until they rest; who is ``patient`` watches what still settles once more."""
    model, targets = stages.model, replace(targets_of(stages.design, stages), control=control)
    again = Run(model, control, at_rest(model) if start is None else start, None)
    late = deque([again.state.moved], _LATE)
    given_up: Callable[[Run], bool] = _swings_on if trial else _never
    for _ in range(1 + patient):
        again.watch_anew()
        while not again.resting and not given_up(again):
            progress("diagnosing", 0.0)
            again.take(*turn(model, targets, again.state))
            late.append(again.state.moved)
        if again.verdict.motion != "settling":
            break
    condition = shape_of(model).condition(model.tensegric.expand(again.state.moved))
    verdict = replace(again.verdict, condition=condition)
    return Ran(again.state, verdict, np.mean(late, axis=0))


def _never(_: Run) -> bool:
    return False


def _swings_on(run: Run) -> bool:
    """Return whether it is plain that a run swings beyond the turns it is given: it hardly fades."""
    turns = run.state.turn - run.changed_at
    if turns < _SEEN or turns % _LATE or run.verdict.motion != "vibrating":
        return False
    early, late = (max(one.step for one in run.records[part]) for part in (_EARLIER, _LATEST))
    fades = min(late / early, 1.0) ** ((MOST_TURNS - turns) / _LATE)
    return bool(late * fades > _CLEARLY * SETTLED_STEP)
