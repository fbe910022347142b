"""Differences of two designs on the same bodies: mean with uncertainty, distribution, who gains."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.analysis.grading.increments import Interval, interval_of
from core.geometry.mesh import Flags, Floats, Indices

MORE, EQUAL, LESS = 1, 0, -1


@dataclass(frozen=True)
class PairedDifference:
    """The differences second - first of a quantity on ``count`` bodies for which both are known.

    ``mean`` with its ``interval`` (None for fewer than two bodies); ``deviation`` the standard deviation;
    ``quantiles`` the least, the quartiles with the median, and the largest; ``more``, ``equal``, ``less`` the
    number of bodies on which the second is larger, equal within the resolution, or smaller.
    """

    count: int
    first_mean: float
    second_mean: float
    mean: float
    deviation: float | None
    interval: Interval | None
    quantiles: tuple[float, ...]
    more: int
    equal: int
    less: int


def paired_difference(first: Floats, second: Floats, resolution: float = 0.0) -> PairedDifference | None:
    """Return the differences of two values (n,) of each body, None if no body has both.

    Values that differ by no more than the ``resolution`` count as equal.
    """
    known = np.isfinite(first) & np.isfinite(second)
    changes = second[known] - first[known]
    count = len(changes)
    if not count:
        return None
    mean, deviation, interval = float(changes.mean()), None, None
    if count > 1:
        deviation = float(changes.std(ddof=1))
        interval = interval_of(mean, deviation / count**0.5, count - 1)
    quantiles = np.quantile(changes, (0.0, 0.25, 0.5, 0.75, 1.0))
    signs = directions(changes, resolution)
    return PairedDifference(
        count,
        float(first[known].mean()),
        float(second[known].mean()),
        mean,
        deviation,
        interval,
        tuple(map(float, quantiles)),
        *(int((signs == sign).sum()) for sign in (MORE, EQUAL, LESS)),
    )


def directions(changes: Floats, resolution: float) -> Indices:
    """Return MORE, EQUAL or LESS for each of the changes (n,), which are known."""
    signs: Indices = np.where(np.abs(changes) <= resolution, EQUAL, np.sign(changes)).astype(np.int64)
    return signs


@dataclass(frozen=True)
class Tradeoff:
    """How two quantities change together on the bodies that have both: a gain, and a cost.

    ``counts`` (3, 3) are numbers of bodies: rows gain LESS, EQUAL, MORE, columns cost LESS, EQUAL, MORE.
    ``better`` (n,) are bodies on which the gain rises and the cost does not, or the cost falls and the gain
    does not; ``worse`` the reverse. All others are ``mixed``, ``same``, or not known.
    """

    counts: Indices
    better: Flags
    worse: Flags
    same: Flags
    mixed: Flags

    @property
    def outcomes(self) -> dict[str, Flags]:
        """Return the bodies of each outcome by its name."""
        return {"better": self.better, "worse": self.worse, "same": self.same, "mixed": self.mixed}

    @property
    def count(self) -> int:
        """Return the number of bodies for which both are known."""
        return int(self.counts.sum())

    @property
    def gains_at_no_cost(self) -> int:
        """Return on how many bodies the gain rises and the cost does not."""
        return int(self.counts[2, :2].sum())


def tradeoff(gain: Floats, cost: Floats, resolutions: tuple[float, float]) -> Tradeoff:
    """Return how changes (n,) of a gain and of a cost go together; NaN where one is not known."""
    known = np.isfinite(gain) & np.isfinite(cost)
    rise = directions(np.where(known, gain, 0.0), resolutions[0])
    dearer = directions(np.where(known, cost, 0.0), resolutions[1])
    counts = np.zeros((3, 3), dtype=np.int64)
    np.add.at(counts, (rise[known] + 1, dearer[known] + 1), 1)
    same = known & (rise == EQUAL) & (dearer == EQUAL)
    better = known & (rise >= EQUAL) & (dearer <= EQUAL) & ~same
    worse = known & (rise <= EQUAL) & (dearer >= EQUAL) & ~same
    return Tradeoff(counts, better, worse, same, known & ~(same | better | worse))
