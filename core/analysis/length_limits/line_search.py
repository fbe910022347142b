"""The way of one line through its lengths, from rest to either end."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from core.analysis.length_limits.criteria import Criterion
from core.analysis.length_limits.path_solutions import PathPoint, PathSolver
from core.analysis.length_limits.samples import Length, Sample, extrapolate
from core.mechanics.constraint_lines import RATIO_LIMITS, Line

PRECISION = 0.0005
"""Ratios of natural length to which a beginning is closed in on [1]."""

RED = ("overstrained", "folded", "inverted", "stretched")
"""Signs of a length beyond which no body, or no garment, is to be shown."""

_STRIDE = 0.025  # zones that come and go within less are only found where margins hint at it
_LONGEST = 0.1  # stride, where answers come as they are guessed, as those of soft lines do
_AS_GUESSED, _OTHERWISE = 0.03, 0.3  # how far points may be off a guess for a longer or a shorter one [mm]
_OFF_WAY, _OFF_ANYWAY = 0.5, 1.0  # how far off a guess that is still on the way: in parts of it, and [mm]
_LEAPS = 0.005, 0.05, 0.1, 0.2
"""How far beyond the last balance lines that spring back may snap to another, as it is tried [1]."""

_HAIR = 1e-9  # what is not there and what round-off makes of it [1]


class LineSearch:
    """The way of a ``line`` on a ``ground``; ``stops`` are ascending by length.

    ``last`` is the shortest and ``longest`` the longest length with a balance, None where the way ends before
    balances do.
    """

    def __init__(self, ground: PathSolver, line: Line, looks: Mapping[str, Criterion]) -> None:
        self._ground, self._line, self._looks = ground, line, looks
        self._snapped = False
        self.stops: list[Sample] = []
        self.last: Length | None = None
        self.longest: Length | None = None

    def run(self, present: float, through: bool) -> None:
        """Walk both ways from rest, or from the ``present`` length if nothing balances at rest.

        To longer lengths until the line is slack: what it does to the body from there on no band can. To
        shorter ones until a sign of RED shows, or ``through`` it until the worst does.
        """
        begin = self.solve_at(1.0) or self.solve_at(present)
        if begin is None:
            return
        down, self.last = self._way([begin], RATIO_LIMITS[0], through)
        up, self.longest = self._way([begin], RATIO_LIMITS[1], through)
        self.stops = [*reversed(down), *up[1:]]

    def solve_at(self, ratio: float) -> Sample | None:
        """Return the balance that rest leads to with the line at ``ratio``, or None if there is none."""
        found = self._ground.solve_from_original(ratio)
        return None if found is None else self._stop(found)

    def solve_near(self, ratio: float, start: PathPoint) -> Sample | None:
        """Return the balance at ``ratio`` if a few steps lead there from ``start``."""
        found = self._ground.solve_near(ratio, start)
        return None if found is None else self._stop(found)

    def _way(self, stops: list[Sample], end: float, through: bool) -> tuple[list[Sample], Length | None]:
        """Return the stops on the way to ``end``, and the last length if no balance lies beyond."""
        sign, stride = 1.0 if end > 1.0 else -1.0, _STRIDE
        alike = list(stops)  # those since the last jump: only these lead on
        while not self._ended(stops, end, through):
            here = stops[-1].length.ratio
            ratio = here + sign * min(stride, abs(end - here))
            start = extrapolate(alike[-3:], ratio)
            there = self.solve_near(ratio, start)
            if there is not None and (stride <= PRECISION or not _astray(alike, start, there.found)):
                stride = _next_stride(stride, _off(start, there.found) if len(alike) > 2 else None)
                alike.append(there)
            elif stride > PRECISION:
                stride /= 2.0
                continue
            elif sign < 0.0 and (there := self._jumped(here)) is not None:
                stride, alike = _STRIDE, [there]
            else:
                return stops, stops[-1].length
            stops.append(there)
        return stops, None

    def _ended(self, stops: list[Sample], end: float, through: bool) -> bool:
        here = stops[-1]
        enough = here.shows("slack") if end > 1.0 else self._enough(stops, through)
        return enough or abs(end - here.length.ratio) <= _HAIR

    def _enough(self, stops: list[Sample], through: bool) -> bool:
        here = stops[-1]
        if here.shows("stretched"):
            return True  # shorter ones are refused, and nothing is known of their elastic
        if through:
            return here.shows("overstrained") and here.shows("inverted")
        # What is red at rest already is the other lines' doing, and this one may mend it.
        return _red(here) and any(not _red(stop) for stop in stops)

    def _jumped(self, above: float) -> Sample | None:
        """Return a balance far from the last one: where lines are springs the shape may snap there, once.

        On a solid, whose energy is quadratic but for lines and cups, none was found on any garment.
        """
        options = self._ground.model.options
        if self._snapped or options.line_hold == "held" or options.tissue == "solid":
            return None
        self._snapped = True
        ratios = (above - leap for leap in _LEAPS)
        tries = (self.solve_at(ratio) for ratio in ratios if ratio >= RATIO_LIMITS[0])
        return next((there for there in tries if there is not None), None)

    def _stop(self, found: PathPoint) -> Sample:
        return Sample(Length(found.ratio, self._line.length(found.points)), found, self._looks)


def _red(stop: Sample) -> bool:
    return any(stop.shows(sign) for sign in RED)


def _next_stride(stride: float, off: float | None) -> float:
    """Return how long to stride after a guess was ``off`` by so much [mm], None if it was none yet."""
    if off is None:
        return min(1.5 * stride, _STRIDE)
    if off < _AS_GUESSED:
        return min(1.5 * stride, _LONGEST)
    return max(stride / 1.5, min(stride, _STRIDE)) if off > _OTHERWISE else stride


def _astray(stops: list[Sample], start: PathPoint, found: PathPoint) -> bool:
    """Return whether an answer lies elsewhere than the way through ``stops`` leads: on another branch."""
    led = _off(stops[-1].found, start)
    return len(stops) > 1 and _off(start, found) > _OFF_WAY * led + _OFF_ANYWAY


def _off(start: PathPoint, found: PathPoint) -> float:
    """Return how far the points of a guess are off, at most [mm]."""
    return float(np.abs(start.balance.state.moved - found.balance.state.moved).max(initial=0.0))
