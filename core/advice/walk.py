"""The way of one line through its lengths, from rest to either end; closed in on where signs begin."""

from __future__ import annotations

from bisect import bisect
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import groupby, pairwise

import numpy as np

from core.advice.ground import Found, Ground
from core.advice.looks import OF_SHAPE, Look
from core.lines import RATIO_LIMITS, Line

PRECISION = 0.0005
"""Ratios of natural length to which a beginning is closed in on [1]."""

RED = ("overstrained", "folded", "inverted", "stretched")
"""Signs of a length beyond which no body, or no garment, is to be shown."""

_STRIDE = 0.025  # zones that come and go within less are only found where margins hint at it
_NEARLY = 0.5  # of the least margin, from which on it is looked whether there is none in between [1]
_LEAPS = 0.005, 0.05, 0.1, 0.2
"""How far beyond the last balance lines that spring back may snap to another, as it is tried [1]."""

_WIDE = 0.03  # more than a shape's margin changes by, there and back, within a stride [1]
_BARELY = 0.001  # margin of a guessed shape from which on it is solved for [1]
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
class Stop:
    """A balance on the way, and what is looked at there, each when it is first asked for."""

    length: Length
    found: Found
    looks: Mapping[str, Look]
    known: dict[str, float] = field(default_factory=dict)

    def margin(self, sign: str) -> float:
        """Return how far it is from showing ``sign``; less than 0 if it does [1]."""
        if sign not in self.known:
            self.known[sign] = self.looks[sign](self.found)
        return self.known[sign]

    def shows(self, sign: str) -> bool:
        """Return whether ``sign`` is to be seen."""
        return sign in self.looks and not self.margin(sign) > -_HAIR


class Walk:
    """The way of a ``line`` on a ``ground``; ``stops`` are ascending by length.

    ``last`` is the shortest and ``longest`` the longest length with a balance, None where the way ends before
    balances do.
    """

    def __init__(self, ground: Ground, line: Line, looks: Mapping[str, Look]) -> None:
        self._ground, self._line, self._looks = ground, line, looks
        self._snapped = False
        self.stops: list[Stop] = []
        self.last: Length | None = None
        self.longest: Length | None = None

    def go(self, present: float, through: bool) -> None:
        """Walk both ways from rest, or from the ``present`` length if nothing balances at rest.

        To longer lengths until the line is slack: what it does to the body from there on no band can. To
        shorter ones until a sign of RED shows, or ``through`` it until the worst does.
        """
        begin = self.solved(1.0) or self.solved(present)
        if begin is None:
            return
        down, self.last = self._way([begin], RATIO_LIMITS[0], through)
        up, self.longest = self._way([begin], RATIO_LIMITS[1], through)
        self.stops = [*reversed(down), *up[1:]]

    def solved(self, ratio: float) -> Stop | None:
        """Return the balance that rest leads to with the line at ``ratio``, or None if there is none."""
        found = self._ground.from_rest(ratio)
        return None if found is None else self._stop(found)

    def spans(self, sign: str) -> tuple[Span, ...]:
        """Return the lengths that show ``sign``, ascending, closed in on where they begin and end."""
        seen = sorted([*self.stops, *self._nearly(sign)], key=lambda stop: stop.length.ratio)
        stops = [seen[0]]
        for short, long in pairwise(seen):
            if short.shows(sign) != long.shows(sign):
                stops += sorted(self._closing_in(short, long, sign), key=lambda stop: stop.length.ratio)
            stops.append(long)
        shown = groupby(stops, lambda stop: stop.shows(sign))
        runs = (list(run) for shows, run in shown if shows)
        return tuple(Span(run[0].length, run[-1].length) for run in runs)

    def _nearly(self, sign: str) -> Iterator[Stop]:
        """Yield stops where ``sign`` may come and go, or go and come, between two that are alike."""
        for ratio in self._dips(sign) if sign in OF_SHAPE else self._turns_back(sign):
            above = bisect([stop.length.ratio for stop in self.stops], ratio)
            nearest = self.stops[max(above - 1, 0) : above + 1]
            stop = self._near(ratio, _ahead(nearest, ratio))
            if stop is not None:
                yield stop

    def _turns_back(self, sign: str) -> Iterator[float]:
        """Yield where a parabola through three margins, the middle one nearest to nothing, turns back."""
        for three in zip(self.stops, self.stops[1:], self.stops[2:], strict=False):
            before, middle, after = (stop.margin(sign) for stop in three)
            if not min(before * middle, middle * after) > 0.0 or abs(middle) > min(abs(before), abs(after)):
                continue
            at = [stop.length.ratio - three[1].length.ratio for stop in three]
            bend, slope, _ = np.polyfit(at, (before, middle, after), 2).tolist()
            turn = -0.5 * slope / bend if bend else 0.0
            if (middle + 0.5 * slope * turn) / middle < _NEARLY and at[0] < turn < at[2]:
                yield three[1].length.ratio + turn

    def _dips(self, sign: str) -> Iterator[float]:
        """Yield where the shape between two stops, as three of them lead to it, all but shows ``sign``.

        Nothing is solved for that, so it is looked at often: the least margin is closed in on.
        """
        for at in range(1, len(self.stops)):
            ends = self.stops[at - 1 : at + 1]
            one, other = (stop.margin(sign) for stop in ends)
            three = self.stops[max(at - 2, 0) :][:3]
            if not one * other > 0.0 or min(abs(one), abs(other)) > _WIDE or len(three) < 3:
                continue
            short, long = (stop.length.ratio for stop in ends)
            for _ in range(3):
                ratios = np.linspace(short, long, 5)
                rooms = [np.sign(one) * self._margin_between(sign, three, ratio) for ratio in ratios[1:-1]]
                least = 1 + int(np.argmin(rooms))
                short, long = ratios[least - 1], ratios[least + 1]
            if min(rooms) < min(_BARELY, abs(one), abs(other)):
                yield float(ratios[least])

    def _margin_between(self, sign: str, three: list[Stop], ratio: float) -> float:
        """Return the margin of what three stops lead to at ``ratio``, without solving for it [1]."""
        first = _ahead(three[:2], ratio)
        share = (ratio - three[0].length.ratio) / (three[2].length.ratio - three[0].length.ratio)
        return self._looks[sign](first.mixed(_ahead(three[1:], ratio), share))

    def _way(self, stops: list[Stop], end: float, through: bool) -> tuple[list[Stop], Length | None]:
        """Return the stops on the way to ``end``, and the last length if no balance lies beyond."""
        sign, stride = 1.0 if end > 1.0 else -1.0, _STRIDE
        here = stops[-1]
        while (
            not (self._enough(stops, through) if sign < 0.0 else here.shows("slack"))
            and abs(end - here.length.ratio) > _HAIR
        ):
            ratio = here.length.ratio + sign * min(stride, abs(end - here.length.ratio))
            there = self._near(ratio, _ahead(stops[-2:], ratio))
            if there is not None:
                here, stride = there, min(1.5 * stride, _STRIDE)
                stops.append(here)
            elif stride > PRECISION:
                stride /= 2.0
            elif sign < 0.0 and (there := self._jumped(here.length.ratio)) is not None:
                here, stride = there, _STRIDE
                stops.append(here)
            else:
                return stops, here.length
        return stops, None

    def _enough(self, stops: list[Stop], through: bool) -> bool:
        here = stops[-1]
        if here.shows("stretched"):
            return True  # shorter ones are refused, and nothing is known of their elastic
        if through:
            return here.shows("overstrained") and here.shows("inverted")
        # What is red at rest already is the other lines' doing, and this one may mend it.
        return _red(here) and any(not _red(stop) for stop in stops)

    def _jumped(self, above: float) -> Stop | None:
        """Return a balance far from the last one: where lines are springs the shape may snap there, once."""
        if self._snapped or self._ground.model.mechanics.line_hold == "held":
            return None
        self._snapped = True
        ratios = (above - leap for leap in _LEAPS)
        tries = (self.solved(ratio) for ratio in ratios if ratio >= RATIO_LIMITS[0])
        return next((there for there in tries if there is not None), None)

    def _closing_in(self, short: Stop, long: Stop, sign: str) -> Iterator[Stop]:
        """Yield stops until ``sign`` begins or ends between two that are PRECISION apart."""
        tries = 0
        while long.length.ratio - short.length.ratio > PRECISION:
            tries += 1
            calm, shown = (short, long) if long.shows(sign) else (long, short)
            between = self._between(calm, shown, sign, halve=tries % 3 == 0)
            if between is None:
                return
            yield between
            short, long = (between, long) if between.shows(sign) == short.shows(sign) else (short, between)

    def _between(self, calm: Stop, shown: Stop, sign: str, halve: bool) -> Stop | None:
        """Return a stop where ``sign`` seems to begin, a little beyond on the side where more is unknown."""
        width = shown.length.ratio - calm.length.ratio
        share = calm.margin(sign) / (calm.margin(sign) - shown.margin(sign))
        nudge = 0.3 * PRECISION / abs(width)
        share = 0.5 if halve else min(max(share + (nudge if share < 0.5 else -nudge), nudge), 1.0 - nudge)
        ratio = calm.length.ratio + share * width
        starts = self._starts(calm.found, shown.found, share)
        return next((stop for start in starts if (stop := self._near(ratio, start))), None)

    @staticmethod
    def _starts(one: Found, other: Found, share: float) -> Iterator[Found]:
        yield one.mixed(other, share)
        yield one
        yield other

    def _near(self, ratio: float, start: Found) -> Stop | None:
        found = self._ground.near(ratio, start)
        return None if found is None else self._stop(found)

    def _stop(self, found: Found) -> Stop:
        return Stop(Length(found.ratio, self._line.length(found.points)), found, self._looks)


def _red(stop: Stop) -> bool:
    return any(stop.shows(sign) for sign in RED)


def _ahead(stops: list[Stop], ratio: float) -> Found:
    """Return where the way through the last ``stops``, one or two, leads at ``ratio``."""
    one, here = stops[0], stops[-1]
    if one is here:
        return here.found
    share = (one.length.ratio - ratio) / (one.length.ratio - here.length.ratio)
    return one.found.mixed(here.found, share)
