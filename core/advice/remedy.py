"""What ends a fight: the smallest single change, looked for by outlooks and proved by runs (ours).

Changes are counted in steps that a person can set. On each way - a line longer or shorter, the gain lower -
the first step whose outlook is good is closed in on; then the smallest of all is made and run, and if that
does not do, a somewhat larger one or the next.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial, reduce
from typing import Any

from core.advice.outlook import Outlook, outlook
from core.advice.standing import Standing, gone_on, rank_of, standing
from core.design import Design
from core.errors import UserError
from core.lines import RATIO_LIMITS
from core.pipeline import Stages, build
from core.progress import Progress
from core.solving.condition import CALM_RANGE, STRAIN_RANGE
from core.worn_lines import Together, free_lines

LENGTH_STEP = 0.001
"""Ratio of lengths that a person sets [1]."""

GAIN_STEP = 0.01
"""Gain that a person sets, in probe units [1]."""

_LEAST_GAIN = 0.1
_BELOW = 0.96  # of the gain that a shape bears: there a swing fades within the turns that a run is watched
_WORTH = 1.5  # times the smallest change that looks good: what is larger is not worth a search
_TRIES = 6  # runs on one kind of way, and in all: what a search may take
_MOST_TRIES = 16
MOST_LOOKS = 140
"""Outlooks that a search for single changes may take, and half of that the search for what comes after."""

_COARSER = 3  # times as many steps where the outlook was not good
_MOST_TOGETHER = 95  # %: beyond that nothing is left of the garment
_FURTHER = 1.08  # a step that a run did not bear out is made larger by so much, then more


@dataclass(frozen=True, eq=False)
class Change:
    """One change of a design.

    ``kind`` is "length", "gain", "setting", "off" (lines taken off) or "together" (all lines nearer to rest).
    ``lines`` are those that it is about, ``setting`` the field and its new value, which may come with a
    length. ``size`` [%] is how far a length moves, of that at rest, or the gain, of what it was: one scale;
    of a setting it is 0.
    """

    kind: str
    design: Design
    size: float = 0.0
    lines: tuple[str, ...] = ()
    setting: tuple[str, Any] = ("", None)


@dataclass(frozen=True, eq=False)
class Cure:
    """A change, and how the design stands with it: run from rest, and on from where it was.

    ``left`` is the worse of what is wrong then, empty if nothing is.
    """

    change: Change
    standing: Standing
    ends: bool
    left: str = ""


@dataclass(frozen=True)
class Way:
    """A way of changing a design in up to ``most`` steps; ``at`` returns the change of so many."""

    at: Callable[[int], Change]
    most: int


def single_ways(stages: Stages) -> Iterator[Way]:
    """Yield the ways to change one line, or the gain."""
    if stages.design.volume == "conventional" and stages.gain > _LEAST_GAIN:
        first = math.ceil(stages.gain / GAIN_STEP - 1e-6) - 1
        yield Way(partial(_gain, stages, first), first - round(_LEAST_GAIN / GAIN_STEP) + 1)
    yield from line_ways(stages)


def line_ways(stages: Stages) -> Iterator[Way]:
    """Yield the ways to make one line longer or shorter; at its rest length it would be off."""
    for names in free_lines(stages):
        ratio = stages.design.ratio(names[0])
        low, high = RATIO_LIMITS
        top, bottom = (1.0 - LENGTH_STEP, low) if ratio < 1.0 else (high, 1.0 + LENGTH_STEP)
        for sign, end in ((1, top), (-1, bottom)):
            grid = math.floor(sign * ratio / LENGTH_STEP + 1e-6)
            most = math.floor(sign * end / LENGTH_STEP + 1e-6) - grid
            yield Way(partial(_length, stages.design, names, sign, grid), most)


def _gain(stages: Stages, first: int, steps: int) -> Change:
    gain = round((first - steps + 1) * GAIN_STEP, 6)
    return Change("gain", replace(stages.design, gain=gain), 100.0 * (1.0 - gain / stages.gain))


def _length(design: Design, names: tuple[str, ...], sign: int, grid: int, steps: int) -> Change:
    ratio = round(sign * (grid + steps) * LENGTH_STEP, 6)
    return Change(
        "length", design.with_linked(names[0], ratio), 100.0 * abs(ratio - design.ratio(names[0])), names
    )


def settings(design: Design, complaint: str, bears: float | None = None) -> Iterator[Change]:
    """Yield other choices of the model that may end a complaint, the least far-reaching first.

    ``bears`` is the gain that the shape bears: where it is known a gain somewhat below it comes first.
    """
    if bears is not None:
        gain = round(math.floor(_BELOW * bears / GAIN_STEP) * GAIN_STEP, 6)
        if _LEAST_GAIN <= gain < (math.inf if design.gain is None else design.gain):
            yield _set(design, "gain", gain)
    moving = complaint in ("vibrating", "diverging", "settling")
    in_step = [_set(design, "line_force", "implicit")]
    controls = [_set(design, "volume", control) for control in ("adaptive", "exact")[: 1 + moving]]
    spring = [_set(design, "line_hold", "spring")]
    order = [*in_step, *controls, *spring] if moving else [*spring, *controls, *in_step]
    for change in order:
        if change.design != design:
            yield change


def _set(design: Design, key: str, value: str | float) -> Change:
    return Change("setting", replace(design, **{key: value}), setting=(key, value))  # type: ignore[arg-type]


def with_setting(setting: Change, ways: Iterator[Way]) -> Iterator[Way]:
    """Yield ways that start from another choice of the model as the changes of both at once."""

    def both(way: Way, steps: int) -> Change:
        return replace(way.at(steps), setting=setting.setting)

    for way in ways:
        yield Way(partial(both, way), way.most)


def off_changes(stages: Stages) -> Iterator[Change]:
    """Yield the ways to take one line off."""
    for names in free_lines(stages):
        size = 100.0 * abs(stages.design.ratio(names[0]) - 1.0)
        yield Change("off", stages.design.with_linked(names[0], None), size, names)


def together_ways(stages: Stages) -> Iterator[Way]:
    """Yield the way of all lines nearer to rest, a hundredth of how far they are a step, if there are two."""
    groups = free_lines(stages)
    if len(groups) > 1:
        yield Way(partial(_together, stages.design, groups), _MOST_TOGETHER)


def _together(design: Design, groups: Sequence[Together], steps: int) -> Change:
    size = 0.0
    for names in groups:
        before = design.ratio(names[0])
        after = 1.0 + (1.0 - steps / 100.0) * (before - 1.0)
        round_ = math.ceil if before < 1.0 else math.floor
        after = round(round_(after / LENGTH_STEP - (1e-6 if before < 1.0 else -1e-6)) * LENGTH_STEP, 6)
        size = max(size, 100.0 * abs(after - before))
        design = design.with_linked(names[0], None if after == 1.0 else after)
    return Change("together", design, size, reduce(tuple.__add__, groups, ()))


class Search:
    """Looks for what ends the ``complaint`` of a design that was run, by as many more ``looks`` ahead."""

    def __init__(self, sick: Standing, progress: Progress) -> None:
        self._sick, self._progress = sick, progress
        self._near: Outlook | None = None
        self.looks = MOST_LOOKS
        self.tried: list[Cure] = []
        design = sick.stages.design
        steady = design.volume in ("adaptive", "accumulating", "none") and design.line_hold == "spring"
        self._swings = not steady or design.line_force == "explicit" or sick.complaint == "vibrating"

    def _bears(self, stages: Stages) -> bool:
        """Return whether the outlook of a changed design is good."""
        self._progress("diagnosing", 0.0)
        if _too_far(stages, CALM_RANGE if self._sick.complaint == "strained" else STRAIN_RANGE):
            return False
        seen = outlook(stages, self._near)
        if seen is None or seen.condition.folded or seen.condition.overstrained:
            return False
        self._near = seen
        if self._sick.complaint == "strained" and seen.condition.strained:
            return False
        return seen.stays if self._swings else True

    def _hopeful(self, change: Change) -> bool:
        if not self.looks:
            return False
        self.looks -= 1
        try:
            return self._bears(build(change.design, self._sick.stages))
        except UserError:
            return False  # an elastic beyond its curve, for example

    def first_good(self, way: Way, largest: float = math.inf) -> int | None:
        """Return the fewest steps on a way whose outlook is good, if that gets no worse with more of them.

        Changes of more than the ``largest`` size [%] are not looked for.
        """
        none, steps = 0, min(1, way.most)
        while steps > none and not self._hopeful(way.at(steps)):
            none, steps = steps, min(_COARSER * steps, way.most)
            if way.at(none + 1 if none < way.most else none).size > largest:
                return None
        if steps == none:
            return None
        while steps - none > 1:
            middle = (none + steps) // 2
            none, steps = (none, middle) if self._hopeful(way.at(middle)) else (middle, steps)
        return steps

    def tried_out(self, change: Change) -> Cure:
        """Run a changed design, from rest and on from where the run stands, and keep what came out."""
        self._progress("diagnosing", 0.0)
        stages = build(change.design, self._sick.stages)
        after = standing(stages, self._progress)
        left = after.complaint
        if self._well(left):
            warm = gone_on(self._sick, stages, self._progress)
            told = "" if warm is None or warm.told == "settled" else warm.told
            left = max(left, told, key=rank_of)
        cure = Cure(change, after, self._well(left), left)
        self.tried.append(cure)
        return cure

    def _well(self, complaint: str) -> bool:
        return not complaint or (complaint == "strained" and self._sick.complaint != "strained")

    def smallest(self, ways: Iterator[Way]) -> tuple[Cure | None, list[Change]]:
        """Return the smallest change on any way that a run bears out, and those that looked good besides."""
        hopes: list[tuple[float, int, int, Way]] = []
        for number, way in enumerate(ways):
            smallest = min((hope[0] for hope in hopes), default=math.inf)
            steps = self.first_good(way, _WORTH * smallest)
            if steps is not None:
                hopes.append((way.at(steps).size, number, steps, way))
        heapq.heapify(hopes)
        others = {number: way.at(steps) for _, number, steps, way in hopes}
        further = dict.fromkeys(others, 1.0)
        for _ in range(_TRIES):
            if not hopes or len(self.tried) >= _MOST_TRIES:
                break
            _, number, steps, way = heapq.heappop(hopes)
            others.pop(number, None)
            cure = self.tried_out(way.at(steps))
            if cure.ends:
                return cure, sorted(others.values(), key=lambda change: change.size)
            further[number] *= _FURTHER
            if steps < way.most:
                steps = min(max(steps + 1, math.ceil(steps * further[number])), way.most)
                heapq.heappush(hopes, (way.at(steps).size, number, steps, way))
        return None, []

    def first_of(self, changes: Iterator[Change]) -> Cure | None:
        """Return the first of some changes that a run bears out."""
        for change in changes:
            if self._hopeful(change) and (cure := self.tried_out(change)).ends:
                return cure
        return None

    def plainer(self, cure: Cure) -> Cure:
        """Return a cure without the other choice that comes with its lengths, if a run bears that out too."""
        change, key = cure.change, cure.change.setting[0]
        if change.kind == "setting" or not key:
            return cure
        as_before = {key: getattr(self._sick.stages.design, key)}
        without = replace(change, design=replace(change.design, **as_before), setting=("", None))
        tried = self.tried_out(without)
        return tried if tried.ends else cure


def _too_far(stages: Stages, bounds: tuple[float, float]) -> bool:
    """Return whether lines are held at lengths at which some of their edges must be outside ``bounds``."""
    held = stages.design.line_hold == "held"
    names = {line.name for line in stages.model.lines if line.constrains}
    worn = (line.ratio for line in stages.design.lines if line.name in names)
    return held and any(not bounds[0] <= ratio <= bounds[1] for ratio in worn)
