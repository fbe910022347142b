"""How far figures of a solved design may be off: a standard deviation by source, and what it is told as."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import hypot

from core.mesh import Floats

BEFORE, AFTER, CHANGE = "before", "after", "change"
LIFT, OUT = "lift", "out"
CUT, TENSION, MEAN_KPA, MAX_KPA = "cut", "tension", "mean_kpa", "max_kpa"
"""Kinds of figures; keys are "before:bust_girth", "lift", "lift left", "cut:mid-bust" and the like."""

LANDMARKS, SCAN, TISSUE, LINE, TAPE, ELASTIC, ROOT = SOURCES = (
    *("landmarks", "scan", "tissue", "line", "tape", "elastic", "root"),
)
"""What figures may be off by, in the order in which it is told."""


@dataclass(frozen=True)
class Doubt:
    """How far one figure may be off: the standard deviation by source, in the figure's unit."""

    by_source: Mapping[str, float]

    @property
    def sd(self) -> float:
        """The standard deviation from all sources, which are taken as independent."""
        return hypot(*self.by_source.values())

    @property
    def shares(self) -> dict[str, float]:
        """What part of the variance each source makes [1], the largest first; none where nothing is off."""
        whole = self.sd**2
        parts = {name: sd**2 / whole for name, sd in self.by_source.items()} if whole else {}
        return dict(sorted(parts.items(), key=lambda part: -part[1]))


@dataclass(frozen=True, eq=False)
class Spread:
    """How far the figures of one solved design may be off.

    ``doubts`` by the keys of figures; a figure that is not known has none. ``skin`` (n,) [mm] is the standard
    deviation of each vertex of the reshaped body along its normal, ``rest`` [mm] that of the body at rest.
    What is told after the ± is ``sds`` standard deviations. ``sources`` are those that are in; the landmarks
    come last. ``other`` tells the figures if lines had the ``contact`` that the design has not: a choice of
    the model, and no part of the ±. ``failed`` counts what was tried and had no answer.
    """

    doubts: Mapping[str, Doubt]
    skin: Floats
    rest: float
    sds: float
    sources: tuple[str, ...]
    other: Mapping[str, float]
    contact: str
    failed: int = 0

    @property
    def whole(self) -> bool:
        """Whether all sources are in."""
        return LANDMARKS in self.sources and bool(self.contact)

    def plus_minus(self, key: str) -> float | None:
        """Return what stands after the ± of a figure, in its unit; None for one that is not known."""
        doubt = self.doubts.get(key)
        return None if doubt is None else self.sds * doubt.sd


def digits(off: float) -> int:
    """Return how many decimals a ± is told with: none from 10 on, else one; the one rule of rounding."""
    return 0 if off >= 9.95 else 1


def told_off(off: float) -> str:
    """Return a ± as it is written where there are no other words for numbers."""
    return f"{rounded(off):.{digits(off)}f}"


def rounded(off: float) -> float:
    """Return a ± as it is told; nothing is told to be surer than 0.1."""
    return max(round(off, digits(off)), 0.1)
