"""Bracketing of the lengths at which signs begin and end."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby, pairwise

import numpy as np

from core.analysis.length_limits.criteria import COSTLY, OF_SHAPE
from core.analysis.length_limits.line_search import PRECISION, LineSearch
from core.analysis.length_limits.samples import Sample, Span, extrapolate, nearest

_NEARLY = 0.5  # of the least margin, from which on it is looked whether there is none in between [1]
_WIDE = 1.2  # more than a shape's margin changes by, there and back, over the length between [1]
_BARELY = 0.001  # margin of a guessed shape from which on it is solved for [1]
_NEAR, _BENT = 0.01, 0.5
"""Costly margins that are further from nothing than that, and than they bend, hide none in between [1]."""


def bracket_spans(walk: LineSearch, sign: str) -> tuple[Span, ...]:
    """Return the lengths that show ``sign``, ascending, closed in on where they begin and end."""
    looked = _worth_a_look(walk.stops, sign) if sign in COSTLY else walk.stops
    seen = sorted([*looked, *_nearly(walk, sign, looked)], key=lambda stop: stop.length.ratio)
    stops = [seen[0]]
    for short, long in pairwise(seen):
        if short.shows(sign) != long.shows(sign):
            stops += sorted(_closing_in(walk, short, long, sign), key=lambda stop: stop.length.ratio)
        stops.append(long)
    shown = groupby(stops, lambda stop: stop.shows(sign))
    runs = (list(run) for shows, run in shown if shows)
    return tuple(Span(run[0].length, run[-1].length) for run in runs)


def _worth_a_look(stops: Sequence[Sample], sign: str) -> list[Sample]:
    """Return the stops that tell all of a sign whose margin takes long to find, and changes smoothly.

    Beside the ends and the middle these are those between which the margin, bent as it is, may be none.
    """
    last = len(stops) - 1
    looked = sorted({0, last // 2, last})
    gaps = list(pairwise(looked))
    while gaps:
        first, end = gaps.pop()
        middle = (first + end) // 2
        if middle > first and _may_vanish([stops[at] for at in looked], looked.index(first), sign):
            looked = sorted([*looked, middle])
            gaps += [(first, middle), (middle, end)]
    return [stops[at] for at in looked]


def _may_vanish(looked: Sequence[Sample], at: int, sign: str) -> bool:
    """Return whether a margin may be none between a stop and the next, bent as it is about there."""
    one, other = (stop.margin(sign) for stop in looked[at : at + 2])
    least = min(abs(one), abs(other))
    if not one * other > 0.0 or least < _NEAR:
        return True
    width = looked[at + 1].length.ratio - looked[at].length.ratio
    trios = (looked[begin : begin + 3] for begin in (at - 1, at) if begin >= 0)
    return any(least < _BENT * _bend(trio, sign) * width**2 for trio in trios if len(trio) == 3)


def _bend(three: Sequence[Sample], sign: str) -> float:
    """Return how much a margin bends at three stops: the size of its second derivative."""
    (a, b, c), (f, g, h) = ([stop.length.ratio for stop in three], [stop.margin(sign) for stop in three])
    return abs(2.0 * ((h - g) / (c - b) - (g - f) / (b - a)) / (c - a))


def _nearly(walk: LineSearch, sign: str, looked: Sequence[Sample]) -> Iterator[Sample]:
    """Yield stops where ``sign`` may come and go, or go and come, between two that are alike."""
    for ratio in _dips(walk.stops, sign) if sign in OF_SHAPE else _turns_back(looked, sign):
        stop = walk.solve_near(ratio, extrapolate(nearest(walk.stops, ratio, 3), ratio))
        if stop is not None:
            yield stop


def _turns_back(looked: Sequence[Sample], sign: str) -> Iterator[float]:
    """Yield where a parabola through three margins, the middle one nearest to nothing, turns back."""
    for three in zip(looked, looked[1:], looked[2:], strict=False):
        before, middle, after = (stop.margin(sign) for stop in three)
        if not min(before * middle, middle * after) > 0.0 or abs(middle) > min(abs(before), abs(after)):
            continue
        at = [stop.length.ratio - three[1].length.ratio for stop in three]
        bend, slope, _ = np.polyfit(at, (before, middle, after), 2).tolist()
        turn = -0.5 * slope / bend if bend else 0.0
        if (middle + 0.5 * slope * turn) / middle < _NEARLY and at[0] < turn < at[2]:
            yield three[1].length.ratio + turn


def _dips(stops: Sequence[Sample], sign: str) -> Iterator[float]:
    """Yield where the shape between two stops, as three of them lead to it, all but shows ``sign``.

    Nothing is solved for that, so it is looked at often: the least margin is closed in on.
    """
    for at in range(1, len(stops)):
        ends, three = stops[at - 1 : at + 1], stops[max(at - 2, 0) :][:3]
        one, other = (stop.margin(sign) for stop in ends)
        short, long = (stop.length.ratio for stop in ends)
        wide = _WIDE * (long - short)
        if not one * other > 0.0 or min(abs(one), abs(other)) > wide or len(three) < 3:
            continue
        for _ in range(3):
            ratios = np.linspace(short, long, 5)
            guesses = (three[0].criteria[sign](extrapolate(three, ratio)) for ratio in ratios[1:-1])
            rooms = [np.sign(one) * room for room in guesses]
            least = 1 + int(np.argmin(rooms))
            short, long = ratios[least - 1], ratios[least + 1]
        if min(rooms) < min(_BARELY, abs(one), abs(other)):
            yield float(ratios[least])


def _closing_in(walk: LineSearch, short: Sample, long: Sample, sign: str) -> Iterator[Sample]:
    """Yield stops until ``sign`` begins or ends between two that are PRECISION apart."""
    middle = 0.5 * (short.length.ratio + long.length.ratio)
    others = (stop for stop in nearest(walk.stops, middle, 4) if stop not in (short, long))
    beside = sorted(others, key=lambda stop: abs(stop.length.ratio - middle))[:1]
    tries = 0
    while long.length.ratio - short.length.ratio > PRECISION:
        tries += 1
        calm, shown = (short, long) if long.shows(sign) else (long, short)
        share = 0.5 if tries % 3 == 0 else _share(calm, shown, beside, sign)
        between = _between(walk, [calm, shown, *beside], share)
        if between is None:
            return
        yield between
        if between.shows(sign) == short.shows(sign):
            short, beside = between, [short]
        else:
            long, beside = between, [long]


def _between(walk: LineSearch, stops: Sequence[Sample], share: float) -> Sample | None:
    """Return the stop that is a ``share`` of the way from the first of ``stops`` to the second."""
    calm, shown = stops[:2]
    ratio = calm.length.ratio + share * (shown.length.ratio - calm.length.ratio)
    starts = (extrapolate(stops, ratio), calm.found, shown.found)
    return next((stop for start in starts if (stop := walk.solve_near(ratio, start))), None)


def _share(calm: Sample, shown: Sample, beside: Sequence[Sample], sign: str) -> float:
    """Return where a sign seems to begin, a little beyond on the side where more is unknown [1].

    As a share of the way from one stop to the other; a third one ``beside`` them tells how the margin bends.
    """
    width = shown.length.ratio - calm.length.ratio
    here, there = calm.margin(sign), shown.margin(sign)
    share = here / (here - there)
    for third in beside:
        at = (third.length.ratio - calm.length.ratio) / width
        bend = ((third.margin(sign) - here) / at - (there - here)) / (at - 1.0)
        for _ in range(3):
            slope = there - here + bend * (2.0 * share - 1.0)
            step = (here + share * (there - here) + bend * share * (share - 1.0)) / slope if slope else 0.0
            share = min(max(share - step, 0.0), 1.0)
    nudge = 0.3 * PRECISION / abs(width)
    return min(max(share + (nudge if share < 0.5 else -nudge), nudge), 1.0 - nudge)
