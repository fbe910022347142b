"""Bodies grouped by band and cup, and the statistics of each measure within a size."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from core.geometry.mesh import Floats, Indices


class SizeCode(NamedTuple):
    """A size by the places of its band and its cup in the size chart, the smallest being 0."""

    band: int
    cup: int


@dataclass(frozen=True)
class Measure:
    """A column that is graded, by its ``name``, and its ``unit``."""

    name: str
    unit: str


@dataclass(frozen=True)
class SizedBodies:
    """Bodies with a size and measures: ``names`` of n bodies, ``sizes`` (n, 2) places of band and cup.

    ``values`` (n, m) are the measures, in the unit of each; NaN where a value is not known.
    """

    names: tuple[str, ...]
    sizes: Indices
    measures: tuple[Measure, ...]
    values: Floats

    def __post_init__(self) -> None:
        for array in (self.sizes, self.values):
            array.setflags(write=False)

    @property
    def count(self) -> int:
        """Return the number of bodies."""
        return len(self.names)

    @cached_property
    def codes(self) -> tuple[SizeCode, ...]:
        """Return the sizes that have a body, by band, then by cup."""
        return tuple(sorted({SizeCode(int(band), int(cup)) for band, cup in self.sizes}))

    @cached_property
    def group_of(self) -> Indices:
        """Return the place of the size of each body in ``codes``, shape (n,)."""
        places = {code: at for at, code in enumerate(self.codes)}
        return np.array([places[SizeCode(int(band), int(cup))] for band, cup in self.sizes], dtype=np.int64)

    def members(self, code: SizeCode) -> Indices:
        """Return the places of the bodies of a size."""
        return np.flatnonzero((self.sizes == code).all(axis=1))


@dataclass(frozen=True)
class Spread:
    """The statistics of a measure in a group: ``count`` values known, in the unit of the measure.

    Standard deviation and standard error of the mean are None for fewer than two values, the mean, smallest
    and largest value without any.
    """

    count: int
    mean: float | None
    deviation: float | None
    error: float | None
    least: float | None
    most: float | None


@dataclass(frozen=True)
class SizeSpread:
    """The ``spread`` of a measure in one size."""

    measure: Measure
    code: SizeCode
    spread: Spread


def spread_of(values: Sequence[float] | Floats) -> Spread:
    """Return the statistics of values; those that are not known (NaN) are left out."""
    known = np.asarray(values, dtype=np.float64)
    known = known[np.isfinite(known)]
    count = len(known)
    if not count:
        return Spread(0, None, None, None, None, None)
    deviation = float(known.std(ddof=1)) if count > 1 else None
    error = None if deviation is None else deviation / count**0.5
    return Spread(count, float(known.mean()), deviation, error, float(known.min()), float(known.max()))


def size_spreads(bodies: SizedBodies) -> Iterator[SizeSpread]:
    """Yield the statistics of each measure in each size, measure by measure."""
    groups = {code: bodies.members(code) for code in bodies.codes}
    for column, measure in enumerate(bodies.measures):
        for code, members in groups.items():
            yield SizeSpread(measure, code, spread_of(bodies.values[members, column]))
