"""Ways of changing a design so that a fight ends, counted in steps that a person can set (ours)."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial, reduce
from typing import Any

from core.analysis.diagnosis.trial_run import TrialResult
from core.document.design import Design
from core.garment.assessment import GOOD, LEVELS, Finding, assess
from core.garment.curve_smoothing import USUAL_WIDTH
from core.mechanics.constraint_lines import RATIO_LIMITS
from core.pipeline.active_lines import LineGroup, free_lines
from core.pipeline.stages import RegionStages

LENGTH_STEP = 0.001
"""Ratio of lengths that a person sets [1]."""

GAIN_STEP = 0.01
"""Gain that a person sets, in probe units [1]."""

_LEAST_SHARE = 0.5  # of the gain that was set: with less it keeps hardly any volume
_BELOW = 0.96  # of the gain that a shape bears: there a swing fades within the turns that a run is watched
_BORNE = 0.88  # of the gain limit at rest: what shapes mostly bear
_MOST_TOGETHER = 95  # %: beyond that nothing is left of the garment


@dataclass(frozen=True, eq=False)
class Change:
    """One change of a design.

    ``kind`` is "length", "gain", "setting", "off" (lines taken off), "width" (a wider band) or "together"
    (all lines nearer to rest).
    ``lines`` are those that it is about, ``setting`` the field and its new value, which may come with a
    length. ``size`` [%] is how far a length moves, of that at rest, or the gain, of what it was: one scale;
    of a setting it is 0.
    """

    kind: str
    design: Design
    size: float = 0.0
    lines: tuple[str, ...] = ()
    setting: tuple[str, Any] = ("", None)


@dataclass(frozen=True)
class ChangePath:
    """A way of changing a design in up to ``most`` steps; ``at`` returns the change of so many."""

    at: Callable[[int], Change]
    most: int


def single_paths(sick: TrialResult) -> Iterator[ChangePath]:
    """Yield the ways to change one line of a design that was run, or the gain, which helps no lengths
    without a balance.
    """
    design, gain = sick.stages.design, sick.region.gain
    if design.volume == "conventional" and sick.problem != "unreachable":
        first = math.ceil(gain / GAIN_STEP - 1e-6) - 1
        most = first - math.ceil(_LEAST_SHARE * gain / GAIN_STEP) + 1
        yield ChangePath(partial(_gain, design, gain, first), most)
    yield from line_paths(design, free_lines(sick.region))


def line_paths(design: Design, groups: Sequence[LineGroup]) -> Iterator[ChangePath]:
    """Yield the ways to make one of ``groups`` longer or shorter; at its rest length it would be off."""
    for names in groups:
        ratio = design.ratio(names[0])
        low, high = RATIO_LIMITS
        top, bottom = (1.0 - LENGTH_STEP, low) if ratio < 1.0 else (high, 1.0 + LENGTH_STEP)
        for sign, end in ((1, top), (-1, bottom)):
            grid = math.floor(sign * ratio / LENGTH_STEP + 1e-6)
            most = math.floor(sign * end / LENGTH_STEP + 1e-6) - grid
            if most > 0:  # a line that is worn at its rest length has one way only
                yield ChangePath(partial(_length, design, names, sign, grid), most)


def _gain(design: Design, before: float, first: int, steps: int) -> Change:
    gain = round((first - steps + 1) * GAIN_STEP, 6)
    return Change("gain", replace(design, gain=gain), 100.0 * (1.0 - gain / before))


def _length(design: Design, names: tuple[str, ...], sign: int, grid: int, steps: int) -> Change:
    ratio = round(sign * (grid + steps) * LENGTH_STEP, 6)
    return Change(
        "length", design.with_linked(names[0], ratio), 100.0 * abs(ratio - design.ratio(names[0])), names
    )


def lower_gains(design: Design, region: RegionStages, bears: float | None) -> Iterator[Change]:
    """Yield lower gains, for other changes beside them: so the control that was chosen can stay.

    Somewhat below what the shape ``bears``, where that is known, and below what shapes mostly bear: with
    lines nearer to rest a shape may bear less.
    """
    lowest, before = math.inf, region.gain
    for borne in (bears, _BORNE * region.gain_limit):
        gain = 0.0 if borne is None else round(math.floor(_BELOW * borne / GAIN_STEP) * GAIN_STEP, 6)
        if _LEAST_SHARE * before <= gain < min(before, lowest):
            lowest = gain
            yield _set(design, "gain", gain)


def option_changes(design: Design, complaint: str) -> Iterator[Change]:
    """Yield other choices of the model that may end a complaint, the least far-reaching first."""
    moving = complaint in ("vibrating", "diverging", "settling")
    in_step = [_set(design, "line_force", "implicit")]
    controls = [_set(design, "volume", control) for control in ("adaptive", "exact")[: 1 + moving]]
    spring = [_set(design, "line_hold", "spring")]
    late = design.line_force == "explicit"  # then nothing else is of use before
    order = [*in_step, *controls, *spring] if moving or late else [*spring, *controls]
    for change in order:
        if change.design != design:
            yield change


def _set(design: Design, key: str, value: str | float) -> Change:
    return Change("setting", replace(design, **{key: value}), setting=(key, value))  # type: ignore[arg-type]


def with_option(setting: Change, ways: Iterator[ChangePath]) -> Iterator[ChangePath]:
    """Yield ways that start from another choice of the model as the changes of both at once."""

    def both(way: ChangePath, steps: int) -> Change:
        return replace(way.at(steps), setting=setting.setting)

    for way in ways:
        yield ChangePath(partial(both, way), way.most)


def deactivations(design: Design, groups: Sequence[LineGroup]) -> Iterator[Change]:
    """Yield the ways to take one of ``groups`` off."""
    for names in groups:
        size = 100.0 * abs(design.ratio(names[0]) - 1.0)
        yield Change("off", design.with_linked(names[0], None), size, names)


def wider_bands(design: Design, names: LineGroup, width: float) -> Change:
    """Return the change to bands ``width`` [mm] wide: they press less, and the shape stays."""
    widths = [design.line_settings(name).width or USUAL_WIDTH for name in names]
    for name in names:
        design = design.with_line_settings(replace(design.line_settings(name), width=width))
    return Change("width", design, 100.0 * (width / min(widths) - 1.0), tuple(names))


def common_paths(design: Design, groups: Sequence[LineGroup]) -> Iterator[ChangePath]:
    """Yield the way of all ``groups`` nearer to rest, a hundredth of how far they are a step, if two."""
    if len(groups) > 1:
        yield ChangePath(partial(_together, design, groups), _MOST_TOGETHER)


def _together(design: Design, groups: Sequence[LineGroup], steps: int) -> Change:
    size = 0.0
    for names in groups:
        before = design.ratio(names[0])
        after = 1.0 + (1.0 - steps / 100.0) * (before - 1.0)
        round_ = math.ceil if before < 1.0 else math.floor
        after = round(round_(after / LENGTH_STEP - (1e-6 if before < 1.0 else -1e-6)) * LENGTH_STEP, 6)
        size = max(size, 100.0 * abs(after - before))
        design = design.with_linked(names[0], None if after == 1.0 else after)
    return Change("together", design, size, reduce(tuple.__add__, groups, ()))


SEVERITIES = range(len(LEVELS) + 1)
"""How bad findings are: as the index of their level, and beyond it for a pressure that nobody can wear."""


def severity(findings: tuple[Finding, ...]) -> int:
    """Return how bad ranked findings are: one of SEVERITIES."""
    level = findings[0].level if findings else GOOD
    return LEVELS.index(level) + any(each.is_unwearable for each in findings)


FIXABLE = ("convergence", "shape", "band", "pressure")
"""Topics of findings that a change of lines or model can end."""


@dataclass(frozen=True, eq=False)
class Fix:
    """A change, and how the design stands with it: run from rest, and on from where it was.

    ``remaining_problem`` is the worse of what is wrong with the run then, empty if nothing is; ``remains``
    are all findings on the changed design that a change can end, the worst first. Of a change that is two,
    ``option_result`` is what would be wrong without the other choice, ``lengths_result`` without the lengths.
    """

    change: Change
    trial: TrialResult
    ends: bool
    remaining_problem: str = ""
    option_result: str = ""
    lengths_result: str = ""
    remains: tuple[Finding, ...] = ()

    @property
    def level(self) -> str:
        """Return the level of what remains."""
        return self.remains[0].level if self.remains else GOOD

    @property
    def severity(self) -> int:
        """Return how bad what remains is: one of SEVERITIES."""
        return severity(self.remains)

    @property
    def rank(self) -> tuple[int, int, float]:
        """How it compares to other changes, the best first: what remains, how many changes, how large [%]."""
        change = self.change
        of_lines = {"together": max(len(change.lines), 2), "off": 2, "length": 1, "width": 1, "gain": 1}.get(
            change.kind, 0
        )
        return self.severity, of_lines + bool(change.setting[0]), change.size


def fixable_findings(standing: TrialResult) -> tuple[Finding, ...]:
    """Return what is found on a design that was run and that a change of it can end, the worst first."""
    found = (each for each in assess(standing).findings if each.topic in FIXABLE)
    # No length, width or choice makes a pressure known.
    return tuple(each for each in found if each.topic != "pressure" or each.value)
