"""Trial run of a design from the original, with its problem, if any."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from core.geometry.mesh import Points
from core.mechanics.convergence import CONVERGED_STEP, Convergence
from core.mechanics.iteration import SolverState, initial_state, step
from core.mechanics.solver_comparison import COMPARED_CONTROLS, ControlRun, carried, shape_of
from core.pipeline.build import Stages
from core.pipeline.model_stages import line_targets
from core.pipeline.solve import exact_equilibrium, solve_region
from core.pipeline.stages import RegionStages
from core.progress import Progress, quiet

PROBLEMS = ("strained", "settling", "overstrained", "folded", "vibrating", "diverging", "unreachable")
"""What can be wrong, from the mildest to the worst: what a run is told as, and lengths without a balance."""

_LATE = 24  # turns over which a swing is taken out of where a run stands
_EARLIER, _LATEST = slice(-2 * _LATE, -_LATE), slice(-_LATE, None)
_SEEN = 100  # turns before which nothing is plain
_CLEARLY = 10.0  # times the step of a run that has settled


@dataclass(frozen=True, eq=False)
class RunResult:
    """How turns ended: the last ``state``, and its ``verdict``.

    ``middle`` (f, 3) [mm] is where points were on the whole in the last turns: what swings does so about it.
    """

    state: SolverState
    verdict: Convergence
    middle: Points


@dataclass(frozen=True, eq=False)
class TrialResult:
    """A design that was run; ``problem`` is one of PROBLEMS, or empty if it is well.

    ``runs`` are those of its regions; ``worst`` numbers the one that the problem is in.
    """

    stages: Stages
    runs: tuple[RunResult, ...]
    problem: str
    worst: int = 0
    _beside: dict[str, RunResult] = field(default_factory=dict, repr=False)

    @property
    def region(self) -> RegionStages:
        """Return the region that the problem is in, the bust where there is none."""
        return self.stages.regions[self.worst]

    @property
    def run(self) -> RunResult:
        """Return the run of that region."""
        return self.runs[self.worst]

    @property
    def verdict(self) -> Convergence:
        """Return how that run ended."""
        return self.run.verdict

    @property
    def region_points(self) -> tuple[Points, ...]:
        """Return the control points of each region at the end of its run, each (n, 3) [mm]."""
        both = zip(self.stages.regions, self.runs, strict=True)
        return tuple(region.model.tensegric.expand(run.state.moved) for region, run in both)

    @property
    def bust_verdict(self) -> Convergence:
        """Return how the run of the bust ended."""
        return self.runs[0].verdict

    @property
    def control_points(self) -> Points:
        """Return the control points of the bust at the end, shape (n, 3) [mm]."""
        return self.region_points[0]

    @property
    def rank(self) -> int:
        """Return how bad it is: 0 if it is well."""
        return severity_rank(self.problem)

    def run_with_control(self, control: str, progress: Progress = quiet) -> RunResult:
        """Return the run of another control of the region with the problem; it is made once."""
        if control == self.stages.design.volume:
            return self.run
        if control not in self._beside:
            self._beside[control] = _turned(self.region, control, progress)
        return self._beside[control]


def severity_rank(complaint: str) -> int:
    """Return how bad a complaint is: 0 if it is none."""
    return PROBLEMS.index(complaint) + 1 if complaint else 0


def run_trial(stages: Stages, progress: Progress = quiet, *, trial: bool = False) -> TrialResult:
    """Run all regions of a design from rest and tell how it stands.

    As in the window a design whose lengths are held, or that asks for the exact answer, must have one. A
    ``trial`` is given up once it is plain that it swings, or has no balance. ``progress`` hears each turn;
    raises Cancelled.
    """
    told = [_run_region(region, progress, trial=trial) for region in stages.regions]
    runs, problems = tuple(run for run, _ in told), [problem for _, problem in told]
    worst = max(
        range(len(told)),
        key=lambda at: (severity_rank(problems[at]), bool(stages.regions[at].design.lines)),
    )
    return TrialResult(stages, runs, problems[worst], worst)


def _run_region(stages: RegionStages, progress: Progress, *, trial: bool) -> tuple[RunResult, str]:
    """Return how a region ran from rest, and its problem, one of PROBLEMS or empty."""
    held, exact = stages.design.line_hold == "held", stages.design.volume == "exact"
    ran = _solved(stages, progress) if exact else None
    nowhere = (
        ran.verdict.motion != "settled"
        if ran
        else held and trial and not exact_equilibrium(stages).is_converged
    )
    if ran is None:
        ran = _nothing(stages) if nowhere else _turned(stages, stages.design.volume, progress, trial=trial)
    told = ran.verdict.display_state
    if held and not exact and not nowhere:
        nowhere = told == "diverging" or not (trial or exact_equilibrium(stages).is_converged)
    return ran, "unreachable" if nowhere else "" if told == "settled" else told


def continue_run(before: TrialResult, stages: Stages, progress: Progress = quiet) -> RunResult | None:
    """Return how turns end that go on under a changed design from where a run stands, as in the window.

    They are those of the region with the problem. None where they do not: an exact answer starts from rest,
    and so does what follows a refusal, or a run that diverged or did not converge. Another control goes on
    from where its own run stands, made beside the one that is shown. Back from a fold turns come slowly: who
    has not come to rest is watched once more, as the window does.
    """
    control, old, design = stages.design.volume, before.region.model, before.stages.design
    region = stages.regions[before.worst]
    if before.problem == "unreachable" or control not in {*COMPARED_CONTROLS, design.volume}:
        return None
    if control == "exact":
        return None
    stood = before.run_with_control(control, progress)
    if stood.verdict.motion in ("diverging", "settling"):
        return None
    state = stood.state if region.model is old else carried(stood.state, old, region.model)
    return _turned(region, control, progress, replace(state, iteration=0), trial=True, patient=True)


def _nothing(stages: RegionStages) -> RunResult:
    """Return what stands where nothing was run: the body at rest."""
    state = initial_state(stages.model)
    return RunResult(state, Convergence("settling", 0, 0.0), state.moved)


def _solved(stages: RegionStages, progress: Progress) -> RunResult:
    solution = solve_region(stages, None, progress)
    return RunResult(solution.state, solution.verdict, solution.state.moved)


def _turned(
    stages: RegionStages,
    control: str,
    progress: Progress,
    start: SolverState | None = None,
    *,
    trial: bool = False,
    patient: bool = False,
) -> RunResult:
    """Make turns from ``start`` until they rest; who is ``patient`` watches what still settles once more."""
    model, targets = stages.model, replace(line_targets(stages.design, stages), control=control)
    again = ControlRun(model, control, initial_state(model) if start is None else start, None)
    late = deque([again.state.moved], _LATE)
    given_up: Callable[[ControlRun], bool] = _swings_on if trial else _never
    for _ in range(1 + patient):
        again.reset_history()
        while not again.is_finished and not given_up(again):
            progress("diagnosing", 0.0)
            again.take(*step(model, targets, again.state))
            late.append(again.state.moved)
        if again.verdict.motion != "settling":
            break
    condition = shape_of(model).quality(model.tensegric.expand(again.state.moved))
    verdict = replace(again.verdict, condition=condition)
    return RunResult(again.state, verdict, np.mean(late, axis=0))


def _never(_: ControlRun) -> bool:
    return False


def _swings_on(run: ControlRun) -> bool:
    """Return whether it is plain that a run swings beyond the turns it is given: it hardly fades."""
    turns = run.state.iteration - run.changed_at
    if turns < _SEEN or turns % _LATE or run.verdict.motion != "vibrating":
        return False
    early, late = (max(one.step for one in run.records[part]) for part in (_EARLIER, _LATEST))
    fades = min(late / early, 1.0) ** ((run.most_turns - turns) / _LATE)
    return bool(late * fades > _CLEARLY * CONVERGED_STEP)
