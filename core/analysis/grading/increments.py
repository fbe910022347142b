"""Increments between neighbouring sizes: differences of means, with their uncertainty."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from scipy.special import stdtrit

from core.analysis.grading.size_groups import Measure, SizeCode, SizedBodies, Spread, size_spreads

CONFIDENCE = 0.95
"""The share of intervals that contain the true value, if values are distributed normally."""

BAND, CUP = "band", "cup"


@dataclass(frozen=True)
class Interval:
    """A confidence interval from ``low`` to ``high``, in the unit of its value."""

    low: float
    high: float

    def contains(self, value: float) -> bool:
        """Return whether a value is in the interval."""
        return self.low <= value <= self.high


@dataclass(frozen=True)
class Increment:
    """The difference of the means of two neighbouring sizes: one step of ``part``, BAND or CUP.

    The standard ``error`` and the ``interval`` are None where one of the sizes has fewer than two bodies.
    """

    measure: Measure
    part: str
    smaller: SizeCode
    larger: SizeCode
    counts: tuple[int, int]
    value: float
    error: float | None
    interval: Interval | None


def interval_of(value: float, error: float, freedom: float) -> Interval:
    """Return the confidence interval of a value by its standard error and degrees of freedom (Student)."""
    half = error * float(stdtrit(freedom, 0.5 + 0.5 * CONFIDENCE))
    return Interval(value - half, value + half)


def increments(bodies: SizedBodies) -> Iterator[Increment]:
    """Yield the increments of each measure: to the next cup of a band, to the next band at a cup.

    Sizes between which a size of the chart has no body are not compared.
    """
    found = {(each.measure, each.code): each.spread for each in size_spreads(bodies)}
    for (measure, code), spread in found.items():
        for part, step in (
            (CUP, SizeCode(code.band, code.cup + 1)),
            (BAND, SizeCode(code.band + 1, code.cup)),
        ):
            following = found.get((measure, step))
            if following is not None and spread.mean is not None and following.mean is not None:
                value, counts = following.mean - spread.mean, (spread.count, following.count)
                error, interval = _uncertainty(value, spread, following)
                yield Increment(measure, part, code, step, counts, value, error, interval)


def _uncertainty(value: float, first: Spread, second: Spread) -> tuple[float | None, Interval | None]:
    """Return standard error and interval of a difference of means; the deviations may differ.

    Source: B. L. Welch, The generalization of "Student's" problem (1947), with its degrees of freedom.
    """
    if first.error is None or second.error is None:
        return None, None
    squares = first.error**2, second.error**2
    error = sum(squares) ** 0.5
    if error == 0.0:
        return 0.0, Interval(value, value)
    shares = (square**2 / (each.count - 1) for square, each in zip(squares, (first, second), strict=True))
    return error, interval_of(value, error, error**4 / sum(shares))
