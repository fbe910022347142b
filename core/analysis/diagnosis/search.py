"""Search for fixes: the smallest single change, chosen by forecasts and verified by runs (ours).

On each way - a line longer or shorter, the gain lower - the first step whose outlook is good is closed in on;
then the smallest of all is made and run, and if that does not do, a somewhat larger one or the next. What a
run came to is kept: from there on the search looks from where runs stand.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from typing import Any, TypeGuard

from core.analysis.diagnosis.candidate_changes import Change, ChangePath, Fix, fixable_findings
from core.analysis.diagnosis.stability import StabilityForecast, forecast, forecast_about, length_difference
from core.analysis.diagnosis.trial_run import RunResult, TrialResult, continue_run, run_trial, severity_rank
from core.document.design import Design
from core.errors import UserError
from core.mechanics.mesh_quality import STRAIN_RANGE, STRAINED_RANGE
from core.mechanics.volume import KEEPS_VOLUME
from core.pipeline.build import Stages, build
from core.pipeline.model_stages import line_targets
from core.pipeline.stages import RegionStages
from core.progress import Progress

_LOOKS = 80  # outlooks that a search on one kind of way may take

_WORTH = 1.5  # times the smallest change that looks good: what is larger is not worth a search
_TRIES = 8  # runs on one kind of way, and in all: what a search may take
_MOST_TRIES = 20
_CLOSER = 3  # runs between a change that did not do and one that did, at most
_COARSER = 4  # times as many steps where the outlook was not good
_DOUBLED = 7  # runs until a change is large enough, at most
_FURTHER = 0.1  # of a step that a run did not bear out is added to it, and each time three times as much


@dataclass(frozen=True, order=True)
class _Hope:
    """A change that looks good: its size and the number of its way, ``steps`` on the ``way``.

    ``known`` places of runs were known then. ``failed`` runs on that way did not bear out what was seen, the
    last with ``short`` steps.
    """

    size: float
    number: int
    way: ChangePath = field(compare=False)
    steps: int = field(compare=False)
    known: int = field(compare=False)
    failed: int = field(default=0, compare=False)
    short: int = field(default=0, compare=False)

    @property
    def change(self) -> Change:
        """Return what is hoped to do."""
        return self.way.at(self.steps)


class Search:
    """Looks for what ends the complaint of a design that was run, by as many more ``looks`` ahead."""

    def __init__(self, sick: TrialResult, progress: Progress) -> None:
        self._sick, self._progress = sick, progress
        self._good: StabilityForecast | None = None
        self._stood: list[StabilityForecast] = []
        self._built: dict[tuple[Any, ...], Stages] = {}
        self.looks = _LOOKS
        self.tried: list[Fix] = []
        design = sick.stages.design
        steady = design.volume in (*KEEPS_VOLUME, "none") and design.line_hold == "spring"
        self._swings = not steady or design.line_force == "explicit" or sick.problem == "vibrating"
        self._learn(sick.region, sick.run)

    @property
    def stages(self) -> Stages:
        """Return the design that is looked at."""
        return self._sick.stages

    def _learn(self, stages: RegionStages, ran: RunResult) -> None:
        """Keep where a run came to: another place than the outlook's where there is more than one."""
        if ran.verdict.iterations and ran.verdict.motion != "diverging" and stages.design.volume != "exact":
            seen = forecast_about(stages, ran.middle)
            self._stood += [seen] if seen else []

    def _build(self, design: Design) -> Stages:
        """Build a changed design; what was made for others of the same model is not made again."""
        alike = design.model_options, design.all_active_lines()
        self._built[alike] = build(design, self._built.get(alike, self._sick.stages))
        return self._built[alike]

    def _region(self, stages: Stages) -> RegionStages:
        """Return the region that the problem is in."""
        return stages.regions[self._sick.worst]

    def _near(self, stages: RegionStages) -> StabilityForecast | None:
        """Return what to look from: of where runs stood and the last good outlook, the nearest."""
        model, targets = stages.model, line_targets(stages.design, stages)
        known = [*reversed(self._stood), *([self._good] if self._good else [])]
        return min(known, key=lambda each: length_difference(each, model, targets), default=None)

    def _bears(self, stages: RegionStages) -> bool:
        """Return whether the outlook of the region with the problem is good in a changed design."""
        if _too_far(stages, STRAINED_RANGE if self._sick.problem == "strained" else STRAIN_RANGE):
            return False
        seen = forecast(stages, self._near(stages))
        if seen is None or seen.condition.folded or seen.condition.overstrained:
            return False
        self._good = seen
        if self._sick.problem == "strained" and seen.condition.strained:
            return False
        return seen.is_stable if self._swings else True

    def _hopeful(self, change: Change) -> bool:
        if not self.looks:
            return False
        self.looks -= 1
        self._progress("diagnosing", 0.0)
        try:
            return self._bears(self._region(self._build(change.design)))
        except UserError:
            return False  # an elastic beyond its curve, for example

    def first_good(self, way: ChangePath, largest: float = math.inf, after: int = 0) -> int | None:
        """Return the fewest steps beyond ``after`` with which a way's outlook is good, if more are no worse.

        Changes of more than the ``largest`` size [%] are not looked for.
        """
        none, stride = after, 1
        steps = min(none + stride, way.most)
        while steps > none and not self._hopeful(way.at(steps)):
            none, stride = steps, _COARSER * stride
            steps = min(after + stride, way.most)
            if way.at(none + 1 if none < way.most else none).size > largest:
                return None
        if steps == none:
            return None
        while steps - none > 1:
            middle = (none + steps) // 2
            none, steps = (none, middle) if self._hopeful(way.at(middle)) else (middle, steps)
        return steps

    def run_change(self, change: Change) -> Fix:
        """Run a changed design, from rest and on from where the run stands, and keep what came out."""
        self._progress("diagnosing", 0.0)
        stages = self._build(change.design)
        after = run_trial(stages, self._progress, trial=True)
        left, ran = after.problem, after.runs[self._sick.worst]
        if self._well(left):
            warm = continue_run(self._sick, stages, self._progress)
            told = (
                "" if warm is None or warm.verdict.display_state == "settled" else warm.verdict.display_state
            )
            left, ran = max(left, told, key=severity_rank), warm or ran
        well = self._well(left)
        cure = Fix(change, after, well, left, remains=fixable_findings(after) if well else ())
        self.tried.append(cure)
        if not cure.ends:
            self._learn(self._region(stages), ran)
        return cure

    def run_changes(self, changes: Iterable[Change]) -> Iterator[Fix]:
        """Run changes; those that are refused, such as an elastic beyond its curve, are left out."""
        for change in changes:
            try:
                cure = self.run_change(change)
            except UserError:
                continue
            yield cure

    def _well(self, complaint: str) -> bool:
        return not complaint or (complaint == "strained" and self._sick.problem != "strained")

    def smallest_fix(self, ways: Iterator[ChangePath]) -> tuple[Fix | None, list[Change]]:
        """Return the smallest change on any way that a run bears out, and those that looked good besides."""
        self.looks = _LOOKS
        hopes, runs = self._hopes(ways), 0
        while hopes and runs < _TRIES and len(self.tried) < _MOST_TRIES:
            hope = heapq.heappop(hopes)
            if hope.known < len(self._stood):  # since then a run came to another place
                self._further(hopes, hope, hope.steps - 1)
                continue
            runs += 1
            cure = self.run_change(hope.change)
            if cure.ends:
                return self._closed_in(hope, cure), [each.change for each in sorted(hopes)]
            failed = replace(hope, failed=hope.failed + 1, short=hope.steps)
            more = max(3**hope.failed, math.ceil(hope.steps * (_FURTHER**failed.failed - 1.0)))
            self._further(hopes, failed, min(hope.steps + more, hope.way.most) - 1)
        return None, []

    def _closed_in(self, hope: _Hope, cure: Fix) -> Fix:
        """Return a smaller change that ends it too, between one that did not and one that did."""
        short, steps = hope.short or hope.steps, hope.steps
        for _ in range(_CLOSER):
            middle = (short + steps) // 2
            if middle - short < _FURTHER * steps:
                break
            closer = self.run_change(hope.way.at(middle))
            short, steps, cure = (short, middle, closer) if closer.ends else (middle, steps, cure)
        return cure

    def _hopes(self, ways: Iterator[ChangePath]) -> list[_Hope]:
        hopes: list[_Hope] = []
        for number, way in enumerate(ways):
            smallest = min((hope.size for hope in hopes), default=math.inf)
            steps = self.first_good(way, _WORTH * smallest)
            if steps is not None:
                hopes.append(_Hope(way.at(steps).size, number, way, steps, len(self._stood)))
        heapq.heapify(hopes)
        return hopes

    def _further(self, hopes: list[_Hope], hope: _Hope, after: int) -> None:
        """Place a way back with the fewest steps beyond ``after`` whose outlook is good, if there are any."""
        steps = self.first_good(hope.way, after=after)
        if steps is not None:
            known = len(self._stood)
            heapq.heappush(hopes, replace(hope, size=hope.way.at(steps).size, steps=steps, known=known))

    def first_verified(self, changes: Iterator[Change]) -> Fix | None:
        """Return the first of some changes that a run bears out.

        Where lines slide as springs a run tells more than an outlook: it is made to know where it comes to.
        """
        for change in changes:
            loose = change.design.line_contact == "sliding" and change.design.line_hold == "spring"
            tried = self.run_changes([change]) if self._hopeful(change) or loose else iter(())
            if (cure := next(tried, None)) is not None and cure.ends:
                return cure
        return None

    def simplify(self, cure: Fix) -> Fix:
        """Return one part of a double change if a run bears it out alone, else both with what each ends."""
        change, key = cure.change, cure.change.setting[0]
        if change.kind == "setting" or not key:
            return cure
        before, after = self._sick.stages.design, change.design
        as_before = {key: getattr(before, key)}
        lengths = self._once(replace(change, design=replace(after, **as_before), setting=("", None)))
        if lengths.ends and lengths.severity <= cure.severity:
            return lengths
        as_set = replace(after, lines=before.lines, lower=before.lower)
        alone = Change("setting", as_set, setting=change.setting)
        if key == "gain":
            gain = alone.design.gain or 0.0
            alone = Change("gain", alone.design, 100.0 * (1.0 - gain / self._sick.region.gain))
        choice = self._once(alone)
        return (
            choice
            if choice.ends and choice.severity <= cure.severity
            else replace(
                cure, option_result=lengths.remaining_problem, lengths_result=choice.remaining_problem
            )
        )

    def fewest_steps(self, way: ChangePath, first: int, most: int = 0) -> Fix | None:
        """Return about the fewest steps on a way that leave a severity of at ``most`` that, None if none do.

        Steps are doubled from the ``first`` on, then closed in on: a few runs.
        """

        def does(cure: Fix | None) -> TypeGuard[Fix]:
            return cure is not None and cure.ends and cure.severity <= most

        short, steps, found = 0, min(first, way.most), None
        for _ in range(_DOUBLED):
            tried = self._allowed(way.at(steps))
            if does(tried):
                found = tried
                break
            if steps == way.most:
                return None
            short, steps = steps, min(2 * steps, way.most)
        for _ in range(_CLOSER if found else 0):
            middle = (short + steps) // 2
            if middle == short:
                break
            closer = self._allowed(way.at(middle))
            short, steps, found = (short, middle, closer) if does(closer) else (middle, steps, found)
        return found

    def _allowed(self, change: Change) -> Fix | None:
        """Run a change unless its design was run already; None if it is refused."""
        try:
            return self._once(change)
        except UserError:
            return None  # an elastic beyond its curve, for example

    def _once(self, change: Change) -> Fix:
        """Run a change unless its design was run already."""
        known = (cure for cure in self.tried if cure.change.design == change.design)
        return next(known, None) or self.run_change(change)


def _too_far(stages: RegionStages, bounds: tuple[float, float]) -> bool:
    """Return whether lines are held at lengths at which some of their edges must be outside ``bounds``."""
    held = stages.design.line_hold == "held"
    names = {line.name for line in stages.model.lines if line.constrains}
    worn = (line.ratio for line in stages.design.lines if line.name in names)
    return held and any(not bounds[0] <= ratio <= bounds[1] for ratio in worn)
