"""How a design stands when it is run from rest as the window runs it: well, or with what complaint."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from core.answer import balance_of
from core.comparison import TURN_CONTROLS, Run, carried, shape_of
from core.pipeline import Stages, targets_of
from core.progress import Progress, quiet
from core.solution import Solution, run
from core.solver import turn
from core.verdict import Verdict

COMPLAINTS = ("strained", "settling", "overstrained", "folded", "vibrating", "diverging", "unreachable")
"""What can be wrong, from the mildest to the worst: what a run is told as, and lengths without a balance."""


@dataclass(frozen=True, eq=False)
class Standing:
    """A design that was run; ``complaint`` is one of COMPLAINTS, or empty if it is well."""

    solution: Solution
    complaint: str
    _beside: dict[str, Solution] = field(default_factory=dict, repr=False)

    @property
    def stages(self) -> Stages:
        """What was run."""
        return self.solution.stages

    @property
    def verdict(self) -> Verdict:
        """How the run ended."""
        return self.solution.verdict

    @property
    def rank(self) -> int:
        """How bad it is: 0 if it is well."""
        return rank_of(self.complaint)

    def beside(self, control: str, progress: Progress = quiet) -> Solution:
        """Return the run of another control of the same design; it is made once."""
        if control == self.stages.design.volume:
            return self.solution
        if control not in self._beside:
            other = replace(self.stages, design=replace(self.stages.design, volume=control))
            self._beside[control] = run(other, progress=progress)
        return self._beside[control]


def rank_of(complaint: str) -> int:
    """Return how bad a complaint is: 0 if it is none."""
    return COMPLAINTS.index(complaint) + 1 if complaint else 0


def standing(stages: Stages, progress: Progress = quiet) -> Standing:
    """Run a design from rest and tell how it stands.

    As in the window a design whose lengths are held, or that asks for the exact answer, must have one.
    ``progress`` hears each turn; raises Cancelled.
    """
    solution = run(stages, progress=progress)
    told = solution.verdict.told
    complaint = "" if told == "settled" else told
    held, exact = stages.design.line_hold == "held", stages.design.volume == "exact"
    if (exact and solution.verdict.motion != "settled") or (
        held and (told == "diverging" or not balance_of(stages).found)
    ):
        complaint = "unreachable"
    return Standing(solution, complaint)


def gone_on(before: Standing, stages: Stages, progress: Progress = quiet) -> Verdict | None:
    """Return how turns end that go on under a changed design from where a run stands, as in the window.

    None where they do not: an exact answer starts from rest, and so does what follows a refusal or a run that
    ran away. Another control goes on from where its own run stands, made beside the one that is shown. Back
    from a fold turns come slowly: who has not come to rest is watched once more, as the window does.
    """
    control, old, design = stages.design.volume, before.stages.model, before.stages.design
    if before.complaint == "unreachable" or control not in {*TURN_CONTROLS, design.volume}:
        return None
    stood = before.beside(control, progress)
    if stood.verdict.motion == "diverging":
        return None
    model, targets = stages.model, targets_of(stages.design, stages)
    again = Run(model, control, replace(carried(stood.state, old, model), turn=0), None)
    for _ in range(2):
        again.watch_anew()
        while not again.resting:
            progress("diagnosing", 0.0)
            again.take(*turn(model, targets, again.state))
        if again.verdict.motion != "settling":
            break
    points = model.tensegric.expand(again.state.moved)
    return replace(again.verdict, condition=shape_of(model).condition(points))
