"""What a quantity of the body is that can be a target: its value and its slopes (ours)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from core.geometry.mesh import Floats, Points
from core.pipeline.build import Stages

SIDES = {"": np.array([0.5, 0.5]), " left": np.array([1.0, 0.0]), " right": np.array([0.0, 1.0])}
"""What the left and the right count for [1], by the end of a figure's name."""


PRIORITIES = {"high": 4.0, "normal": 1.0, "low": 0.25}
"""By how much the tolerance of a target is divided where not all of them can be met [1]."""


@dataclass(frozen=True)
class Goal:
    """A target: a quantity by its ``name`` in ``readings``, its ``value`` [mm], and one of PRIORITIES."""

    name: str
    value: float
    priority: str = "normal"


@dataclass(frozen=True, eq=False)
class Reading:
    """A figure [mm] and its slopes by the control points, shape (n, 3) [1]."""

    value: float
    slopes: Points


Read = Callable[[Points], Reading]
"""Reads a figure off control points, shape (n, 3) [mm]."""

ReadMany = Callable[[Points], tuple[Floats, Floats]]
"""Reads m figures off control points at once: values (m,) [mm] and slopes (m, n, 3) [1]."""


@dataclass(frozen=True)
class QuantityFamily:
    """Figures that are read alike: their ``names``, and what makes a ``read`` for one of them.

    Names that begin with the word ``numbered`` go on with numbers, which ``read`` looks at itself. Targets
    that conflict are balanced by how many times their ``tolerance`` [mm] they are missed. ``region`` is the
    one whose control points ``read`` is given, "bust" or "lower"; empty where these are those of all regions.
    """

    names: tuple[str, ...]
    read: Callable[[Stages, str], Read]
    numbered: str = ""
    tolerance: float = 1.0
    region: str = "bust"

    def has(self, name: str) -> bool:
        """Return whether a quantity of that name belongs to this family."""
        return name in self.names or (bool(self.numbered) and name.startswith(f"{self.numbered} "))


class Weighted:
    """The sum of a few places times ``weights`` (k, 2 or 3), mostly one of each side, with its ``slopes``.

    It is counted from its value at ``rest`` control points, shape (n, 3) [mm], where these are given.
    """

    def __init__(
        self,
        places: Callable[[Points], Points],
        slopes: Callable[[Points, Floats], Points],
        weights: Floats,
        rest: Points | None = None,
    ) -> None:
        self._places, self._slopes, self._weights = places, slopes, weights
        self._rest = 0.0 if rest is None else self._sum(rest)

    def _sum(self, control_points: Points) -> float:
        return float(np.sum(self._weights * self._places(control_points)))

    def __call__(self, control_points: Points) -> Reading:
        """Return the figure at control points, shape (n, 3) [mm]."""
        return Reading(self._sum(control_points) - self._rest, self._slopes(control_points, self._weights))
