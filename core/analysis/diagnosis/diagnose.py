"""The doctor: what fights in a design that does not rest or strains, and the least that ends it (ours).

A change is named only after the design was run with it as the window runs it, and ended well.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import chain

from core.analysis.diagnosis.candidate_changes import (
    Change,
    ChangePath,
    Fix,
    common_paths,
    deactivations,
    fixable_findings,
    line_paths,
    lower_gains,
    option_changes,
    single_paths,
    with_option,
)
from core.analysis.diagnosis.opposing_constraints import ConstraintForces, analyse
from core.analysis.diagnosis.pressure_fixes import complete_fix, pressure_changes, rank_fixes
from core.analysis.diagnosis.search import Search
from core.analysis.diagnosis.stability import StabilityForecast, forecast
from core.analysis.diagnosis.trial_run import TrialResult, run_trial, severity_rank
from core.blas_threads import one_blas_thread
from core.document.design import Design
from core.garment.assessment import Finding
from core.mechanics.constraint_lines import Line
from core.mechanics.convergence import Convergence
from core.pipeline.active_lines import LineGroup, free_lines
from core.pipeline.build import Stages
from core.pipeline.stages import RegionStages
from core.progress import Progress, quiet

__all__ = ["Change", "Diagnosis", "Fix", "diagnose"]

_OTHERS = 2  # changes of other lines that look good, and are run too
_MOST_GAIN = 10.0
_GAIN_PRECISION = 0.005


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """What is wrong with a design, and what ends it.

    ``findings`` are those of the overall verdict that a change can end.

    ``problem`` is one of ``trial_run.PROBLEMS``, empty if the design is well. ``forces`` tells what pulls
    against what. ``gain_limit`` is the conventional gain at which the shape that the lines make begins to
    vibrate
    (probe units [1]), and ``onset`` the growth per turn with which a small swing begins, None where that is
    not asked or not known. ``fixes`` were run and end it, the best first. If there are none, ``nearest`` is
    the mildest of what was run, and ``locked`` names worn lines that may not be changed.
    """

    trial: TrialResult
    forces: ConstraintForces
    gain_limit: float | None = None
    onset: float | None = None
    fixes: tuple[Fix, ...] = ()
    findings: tuple[Finding, ...] = ()
    nearest: Fix | None = None
    locked: tuple[str, ...] = ()

    @property
    def stages(self) -> Stages:
        """Return the built stages of the diagnosed design."""
        return self.trial.stages

    @property
    def best_fix(self) -> Fix | None:
        """Return the best of the fixes, if there is any."""
        return self.fixes[0] if self.fixes else None

    @property
    def problem(self) -> str:
        """Return the problem of the design, or nothing."""
        return self.trial.problem

    @property
    def verdict(self) -> Convergence:
        """Return how its run ended, with period and growth if it swings."""
        return self.trial.verdict

    def with_convergence(self, verdict: Convergence) -> Diagnosis:
        """Return the same as told of a run that ended by ``verdict``: one that did not begin at rest."""
        if self.problem == "unreachable" or verdict.display_state == "settled":
            return self
        ran = replace(self.trial.run, verdict=verdict)
        runs = tuple(ran if each is self.trial.run else each for each in self.trial.runs)
        return replace(self, trial=replace(self.trial, runs=runs, problem=verdict.display_state))

    def line(self, name: str) -> Line:
        """Return a line of the design by name."""
        return next(line for line in self.stages.lines if line.name == name)

    @property
    def gain(self) -> float:
        """Return the conventional gain of the region with the problem (probe units [1])."""
        return self.trial.region.gain

    def longer_mm(self, change: Change) -> float:
        """Return how much longer the band of the first line of a change is set, negative if shorter [mm]."""
        name, before = change.lines[0], self.stages.design
        return (change.design.ratio(name) - before.ratio(name)) * self._rest_length(name)

    def moves_mm(self, change: Change) -> float:
        """Return how far a change moves the length of any line at most [mm]."""
        before, after = self.stages.design, change.design
        return max(abs(after.ratio(n) - before.ratio(n)) * self._rest_length(n) for n in change.lines)

    def _rest_length(self, name: str) -> float:
        return sum(self.line(part).rest_length for part in self.stages.design.band_of(name))


def diagnose(stages: Stages, progress: Progress = quiet) -> Diagnosis:
    """Return what is wrong with the design of ``stages``, and the smallest change that ends it.

    First the adaptive control where the conventional one vibrates, a single line, and the gain; if none does,
    a choice of the model, then that and a line; then all lines nearer to rest, alone or with such a choice;
    last a line taken off. Where all of these leave something to be checked, what leaves less is tried. A
    design whose run is well may press too much, or have slack lines. ``progress`` hears each step; raises
    Cancelled.
    """
    with one_blas_thread():
        progress("diagnosing", 0.0)
        trial = run_trial(stages, progress)
        found = Diagnosis(trial, analyse(trial.region, progress))
        if found.problem != "unreachable":
            found = replace(found, findings=fixable_findings(found.trial))
        if not found.problem:
            search = Search(found.trial, progress)
            return replace(found, fixes=pressure_changes(search, found.findings)) if found.findings else found
        if found.problem in ("vibrating", "diverging"):
            seen = forecast(trial.region)
            bears = gain_limit_of(trial.region, progress) if stages.design.volume == "conventional" else None
            found = replace(found, gain_limit=bears, onset=None if seen is None else seen.growth)
        return _treated(found, Search(found.trial, progress))


def _treated(found: Diagnosis, search: Search) -> Diagnosis:
    """Return the diagnosis with the changes that end its complaint, each run, the best first."""
    fixes = _ending(found, search)
    if fixes and all(fix.remains for fix in fixes):
        fixes += complete_fix(search, rank_fixes(fixes)[0])
    if fixes:
        return replace(found, fixes=rank_fixes(fixes))
    stages = found.stages
    if not search.tried:
        list(search.run_changes(option_changes(stages.design, found.problem)))  # to know the nearest
    region = found.trial.region
    worn = (line.name for line in region.model.lines if line.constrains)
    free = set(chain.from_iterable(free_lines(region)))
    locked = tuple(name for name in worn if name in region.design.active_lines() and name not in free)
    milder = [each for each in search.tried if severity_rank(each.remaining_problem) < found.trial.rank]
    nearest = min(
        milder, key=lambda each: (severity_rank(each.remaining_problem), each.change.size), default=None
    )
    return replace(found, nearest=nearest, locked=locked)


def _ending(found: Diagnosis, search: Search) -> list[Fix]:
    """Return changes that end a complaint: another control if this one vibrates, and the smallest others."""
    stages, swings = found.stages, found.problem in ("vibrating", "diverging")
    tame = swings and stages.design.volume == "conventional"
    gains = list(lower_gains(stages.design, found.trial.region, found.gain_limit)) if tame else []
    groups = free_lines(found.trial.region)
    choices = list(option_changes(stages.design, found.problem))
    adaptive = [each for each in choices if tame and each.setting == ("volume", "adaptive")]
    calmed = search.first_verified(iter(adaptive))
    cure, others = search.smallest_fix(single_paths(found.trial))
    fixes = [each for each in (calmed, cure) if each is not None]
    fixes += [each for each in search.run_changes(others[:_OTHERS]) if each.ends]
    if fixes:
        return fixes
    cure = search.smallest_fix(_chosen(gains, line_paths, groups))[0]
    cure = cure or search.first_verified(iter(choices))
    cure = cure or search.smallest_fix(_chosen(choices, line_paths, groups))[0]
    cure = cure or search.smallest_fix(common_paths(stages.design, groups))[0]
    cure = cure or search.smallest_fix(_chosen(gains, common_paths, groups))[0]
    cure = cure or search.smallest_fix(_chosen(choices, common_paths, groups))[0]
    cure = cure or search.first_verified(deactivations(stages.design, groups))
    return [] if cure is None else [search.simplify(cure)]


def _chosen(
    choices: list[Change],
    ways: Callable[[Design, Sequence[LineGroup]], Iterator[ChangePath]],
    groups: Sequence[LineGroup],
) -> Iterator[ChangePath]:
    """Yield the ways to change lines with each of other choices of the model."""
    for choice in choices:
        yield from with_option(choice, ways(choice.design, groups))


def gain_limit_of(stages: RegionStages, progress: Progress = quiet) -> float | None:
    """Return the conventional gain at which the shape that the lines make begins to vibrate, None if unknown.

    Where the turns of a gain come to rest is worked out anew for each that is tried.
    """

    seen: StabilityForecast | None = None

    def grows(gain: float) -> bool:
        nonlocal seen
        progress("diagnosing", 0.0)
        seen = forecast(replace(stages, design=replace(stages.design, gain=gain)), seen)
        return seen is None or seen.growth > 1.0

    low, high = 0.0, min(2.0 * stages.gain_limit, _MOST_GAIN)
    if grows(low) or not grows(high):
        return None
    while high - low > _GAIN_PRECISION:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if grows(middle) else (middle, high)
    return low
