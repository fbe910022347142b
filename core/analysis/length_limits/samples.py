"""Stops on the way of a line through its lengths, and what the way through some of them leads to."""

from __future__ import annotations

from bisect import bisect
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from core.analysis.length_limits.criteria import Criterion
from core.analysis.length_limits.path_solutions import PathPoint

_HAIR = 1e-9  # what is not there and what round-off makes of it [1]


@dataclass(frozen=True)
class Length:
    """A length of a line: natural length as set over that at rest [1], and the length it reaches [mm]."""

    ratio: float
    reached: float


@dataclass(frozen=True)
class Span:
    """Lengths from the ``short`` to the ``long`` one, all of which show a sign."""

    short: Length
    long: Length


@dataclass(frozen=True, eq=False)
class Sample:
    """A balance on the way, and what is looked at there, each when it is first asked for."""

    length: Length
    found: PathPoint
    criteria: Mapping[str, Criterion]
    known: dict[str, float] = field(default_factory=dict)

    def margin(self, sign: str) -> float:
        """Return how far it is from showing ``sign``; less than 0 if it does [1]."""
        if sign not in self.known:
            self.known[sign] = self.criteria[sign](self.found)
        return self.known[sign]

    def shows(self, sign: str) -> bool:
        """Return whether ``sign`` is to be seen."""
        return sign in self.criteria and not self.margin(sign) > -_HAIR


def nearest(stops: Sequence[Sample], ratio: float, count: int) -> Sequence[Sample]:
    """Return the ``count`` of ascending ``stops`` round a length [1], fewer if there are no more."""
    above = bisect([stop.length.ratio for stop in stops], ratio)
    begin = min(max(above - (count + 1) // 2, 0), max(len(stops) - count, 0))
    return stops[begin : begin + count]


def extrapolate(stops: Sequence[Sample], ratio: float) -> PathPoint:
    """Return where the way through ``stops`` leads at ``ratio``: two on a line, three on a parabola."""
    if len(stops) == 1:
        return stops[0].found
    one, other = stops[0].length.ratio, stops[-1].length.ratio
    return extrapolate(stops[:-1], ratio).interpolate(
        extrapolate(stops[1:], ratio), (ratio - one) / (other - one)
    )
