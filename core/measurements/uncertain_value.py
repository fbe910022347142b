"""Standard deviation of a value by source, and its format."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import exp, hypot

from core.geometry.mesh import Floats
from core.messages import Message

BEFORE, AFTER, CHANGE = "before", "after", "change"
LIFT, OUT = "lift", "out"
CUT, TENSION, MEAN_KPA, MAX_KPA = "cut", "tension", "mean_kpa", "max_kpa"
"""Kinds of figures; keys are "before:bust_girth", "lift", "lift left", "cut:mid-bust" and the like."""

LANDMARKS, SCAN, TISSUE, LINE, TAPE, ELASTIC, ROOT, MODEL = SOURCES = (
    *("landmarks", "scan", "tissue", "line", "tape", "elastic", "root", "model"),
)
"""What figures may be off by, in the order in which it is told."""


FACTORS = (TISSUE, LINE, ELASTIC)
"""Sources that are known to a factor: what goes with them is off by more upwards than downwards."""

FORCES = (TENSION, MEAN_KPA, MAX_KPA)
"""Kinds of figures that go with such sources; of what pulls they are never below nothing."""

MOST = 3.0
"""Standard deviations of the logarithm, times those that are told, up to which a factor makes sense [1]."""


@dataclass(frozen=True)
class Uncertainty:
    """How far one figure may be off: the standard deviation by source, in the figure's unit."""

    by_source: Mapping[str, float]

    @property
    def sd(self) -> float:
        """Return the standard deviation from all sources, which are taken as independent."""
        return hypot(*self.by_source.values())

    @property
    def shares(self) -> dict[str, float]:
        """Return the share of the variance of each source [1], largest first; none without uncertainty."""
        whole = self.sd**2
        parts = {name: sd**2 / whole for name, sd in self.by_source.items()} if whole else {}
        return dict(sorted(parts.items(), key=lambda part: -part[1]))

    @property
    def is_factor(self) -> bool:
        """Return whether sources that are known to a factor make most of it."""
        return sum(self.shares.get(name, 0.0) for name in FACTORS) > 0.5


@dataclass(frozen=True, eq=False)
class OutputUncertainties:
    """How far the figures of one solved design may be off.

    ``by_output`` by the keys of figures; a figure that is not known has none. ``skin`` (n,) [mm] is the
    standard
    deviation of each vertex of the reshaped body along its normal, ``rest`` [mm] that of the body at rest.
    What is told after the ± is ``sds`` standard deviations. ``sources`` are those that are in; the landmarks
    come last. ``other`` tells the figures if lines had the ``contact`` that the design has not: a choice of
    the model, and no part of the ±. ``failed`` counts what was tried and had no answer. ``values`` are
    those where the run comes to rest, which all of this is told of; ``bare`` is a body that wears no line.
    ``cautions`` are sentences on where this ± says less than it seems to.
    """

    by_output: Mapping[str, Uncertainty]
    skin: Floats
    rest: float
    sds: float
    sources: tuple[str, ...]
    other: Mapping[str, float]
    contact: str
    failed: int = 0
    values: Mapping[str, float] = field(default_factory=dict)
    bare: bool = False
    cautions: tuple[Message, ...] = ()

    @property
    def whole(self) -> bool:
        """Return whether all sources are in."""
        return LANDMARKS in self.sources

    def plus_minus(self, key: str) -> float | None:
        """Return what stands after the ± of a figure, in its unit.

        None for one that is not known, and where a ± would be wrong: see ``between``.
        """
        off = self._off(key)
        uneven = off is not None and _kind(key) in FORCES and (self.factor(key) or off > self.values[key])
        return None if uneven else off

    def factor(self, key: str) -> float | None:
        """Return by what a figure may be too small or too large, where mostly factors make it so."""
        off, value = self._off(key), self.values.get(key, 0.0)
        if off is None or _kind(key) not in FORCES or not self.by_output[key].is_factor or off > MOST * value:
            return None
        return exp(off / value)

    def between(self, key: str, value: float) -> tuple[float, float] | None:
        """Return from where to where a figure that comes to ``value`` may lie; None if that is not known."""
        off, factor = self._off(key), self.factor(key)
        if factor is not None:
            return value / factor, value * factor
        if off is None:
            return None
        ends = value - off, value + off
        return (max(ends[0], 0.0), max(ends[1], 0.0)) if _kind(key) in FORCES else ends  # a band cannot push

    def _off(self, key: str) -> float | None:
        doubt = self.by_output.get(key)
        return None if doubt is None else self.sds * doubt.sd


def _kind(key: str) -> str:
    return key.partition(":")[0]


def format_range(low: float, high: float) -> str:
    """Return a range as it is written where there are no other words for numbers."""
    return f"{low:.{uncertainty_digits(low)}f} to {high:.{uncertainty_digits(high)}f}"


def uncertainty_digits(off: float) -> int:
    """Return how many decimals a ± is told with: none from 10 on, else one; the one rule of rounding."""
    return 0 if off >= 9.95 else 1


def format_uncertainty(off: float) -> str:
    """Return a ± as it is written where there are no other words for numbers."""
    return f"{round_uncertainty(off):.{uncertainty_digits(off)}f}"


def round_uncertainty(off: float) -> float:
    """Return a ± as it is told; nothing is told to be surer than 0.1."""
    return max(round(off, uncertainty_digits(off)), 0.1)
