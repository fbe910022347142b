"""A figure of the body that can be asked for, with its slopes by the control points (ours)."""

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
class Family:
    """Figures that are read alike: their ``names``, and what makes a ``read`` for one of them.

    Names that begin with the word ``numbered`` go on with numbers, which ``read`` looks at itself. Targets
    that conflict are balanced by how many times their ``tolerance`` [mm] they are missed.
    """

    names: tuple[str, ...]
    read: Callable[[Stages, str], Read]
    numbered: str = ""
    tolerance: float = 1.0

    def has(self, name: str) -> bool:
        """Tell whether a figure of that name is of this family."""
        return name in self.names or (bool(self.numbered) and name.startswith(f"{self.numbered} "))
