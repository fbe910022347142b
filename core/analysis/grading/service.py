"""Which bodies the sizes of a chart serve, with garments that never contain the body itself."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from core.analysis.grading.grade_rule import fits
from core.analysis.grading.size_groups import Measure, SizeCode, SizedBodies
from core.analysis.grading.tolerance import ComparedBodies
from core.geometry.mesh import Floats, Indices

RULE, MEAN = GARMENTS = ("rule", "mean")
"""What a garment of a size is: the grade rule at that size, or the mean of the bodies of that size."""

_TOGETHER = 1000  # bodies: all at once would need memory for each of their garments of every size
_Maker = Callable[[Indices], Floats]
"""Makes garments of all sizes without each of some bodies (b,), by place: (b, sizes, measures)."""


@dataclass(frozen=True)
class Deviation:
    """The measure that deviates most: that of the ``garment`` and that of the ``body``, in its unit.

    ``excess`` is the deviation in shares of what is allowed.
    """

    measure: Measure
    garment: float
    body: float
    excess: float


@dataclass(frozen=True)
class Served:
    """How a body, by its place, is served by its own size and by the size that suits it ``best``.

    ``own`` is None if there is no garment without the body itself, or if a measure of the body is not known;
    ``best`` if there is none of any size. ``lacking`` is the first measure that is not known.
    """

    body: int
    code: SizeCode
    own: Deviation | None
    best_code: SizeCode | None
    best: Deviation | None
    lacking: Measure | None

    @property
    def by_own(self) -> bool | None:
        """Return whether the own size serves the body, None if that is not known."""
        return None if self.own is None else self.own.excess <= 1.0

    @property
    def by_best(self) -> bool | None:
        """Return whether any size serves the body, None if that is not known."""
        return None if self.best is None else self.best.excess <= 1.0


@dataclass(frozen=True)
class Service:
    """How all bodies are served, and each of the k ``measures`` that decide by itself.

    ``excess`` (n, k) are the deviations of the own size in shares of what is allowed, NaN if not compared.
    """

    bodies: tuple[Served, ...]
    measures: tuple[Measure, ...]
    excess: Floats

    def within(self, measure: Measure) -> float | None:
        """Return the share of the compared bodies whose own size is within the tolerance of one measure."""
        if measure not in self.measures:
            return None
        column = self.excess[:, self.measures.index(measure)]
        known = column[np.isfinite(column)]
        return float(np.mean(known <= 1.0)) if len(known) else None


def service_of(compared: ComparedBodies, garments: str = RULE) -> Service:
    """Return how sizes serve the bodies; ``garments`` is RULE or MEAN."""
    bodies = compared.bodies
    make = (_by_rule if garments == RULE else _by_mean)(bodies)
    rows = np.where(compared.complete, np.cumsum(compared.complete) - 1, -1)
    found: list[Served] = []
    excess = np.full((bodies.count, len(compared.measures)), np.nan)
    for first in range(0, bodies.count, _TOGETHER):
        places = np.arange(first, min(first + _TOGETHER, bodies.count))
        made = make(places)[:, :, compared.columns]
        for at, each in zip(map(int, places), made, strict=True):
            if rows[at] < 0:
                code = bodies.codes[int(bodies.group_of[at])]
                found.append(Served(at, code, None, None, None, _lacking(compared, at)))
                continue
            off = np.abs(compared.as_lengths(each) - compared.lengths[rows[at]]) / compared.allowed[rows[at]]
            excess[at] = off[bodies.group_of[at]]
            found.append(_served(compared, each, off, at))
    return Service(tuple(found), compared.measures, excess)


def _by_rule(bodies: SizedBodies) -> _Maker:
    """Return what makes garments of all sizes by the rule without each body."""
    sizes, found = np.array(bodies.codes, dtype=np.int64), fits(bodies)
    return lambda places: np.stack([fit.without_each(sizes, places) for fit in found], axis=2)


def _by_mean(bodies: SizedBodies) -> _Maker:
    """Return what makes garments of all sizes by the means without each body."""
    known = np.isfinite(bodies.values)
    values = np.where(known, bodies.values, 0.0)
    groups = (np.arange(len(bodies.codes))[:, None] == bodies.group_of).astype(float)
    sums, counts = groups @ values, groups @ known

    def make(places: Indices) -> Floats:
        own = groups.T[places][:, :, None]
        total, count = sums - own * values[places][:, None], counts - own * known[places][:, None]
        return np.where(count > 0.5, total / np.maximum(count, 1.0), np.nan)

    return make


def _served(compared: ComparedBodies, garments: Floats, off: Floats, at: int) -> Served:
    """Return how garments of all sizes (s, k), whose deviations are ``off`` (s, k), serve a body."""
    bodies = compared.bodies
    worst = np.where(np.isfinite(off).all(axis=1), off.max(axis=1), np.inf)

    def deviation(size: int) -> Deviation | None:
        if not np.isfinite(worst[size]):
            return None
        column = int(np.argmax(off[size]))
        body = float(bodies.values[at][compared.columns][column])
        return Deviation(compared.measures[column], float(garments[size, column]), body, float(worst[size]))

    own, best = int(bodies.group_of[at]), int(np.argmin(worst))
    found = deviation(best)
    return Served(at, bodies.codes[own], deviation(own), bodies.codes[best] if found else None, found, None)


def _lacking(compared: ComparedBodies, at: int) -> Measure | None:
    """Return the first measure of a body that is not known."""
    values = compared.bodies.values[at][compared.columns]
    unknown = np.flatnonzero(~np.isfinite(values))
    return compared.measures[int(unknown[0])] if len(unknown) else None
