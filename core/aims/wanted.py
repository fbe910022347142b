"""What is wanted of the lengths of lines, within limits, and the step that leads there (ours)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.optimize import lsq_linear

from core.aims.answers import Look
from core.aims.figure import Goal
from core.aims.outline import section_of
from core.mesh import Floats

NEAR = 0.05
"""A figure this near to what was asked for is what was asked for [mm]."""

INSIDE = 5e-3
"""So far inside the limit of strain lengths stay: a run ends a hair beside its exact answer [1]."""

_LAZY = 1e-3  # of several ways that do the same, the shortest [mm / %]
_STRICT = 10_000.0  # a limit that is broken by a ten-thousandth counts as a figure 1 mm off
_BROKEN = -1e-4  # room to a limit [1]


@dataclass
class Wanted:
    """Figures that are to have ``values`` (m,) [mm], with ``low`` and ``high`` ends of lengths (p,) [%].

    ``weights`` (m,) are what figures count for. ``lines`` names those of the model; ``hardest`` is the most
    that some may pull with, in the model's unit.
    """

    values: Floats
    weights: Floats
    low: Floats
    high: Floats
    lines: Sequence[str]
    hardest: Mapping[str, float] = field(default_factory=dict)

    def room(self, look: Look) -> tuple[Floats, Floats]:
        """Return the room to strain and to the most tensions, (k,) [1], and its slopes, (k, p)."""
        most = [(self.lines.index(name), pull) for name, pull in self.hardest.items()]
        rows = [1.0 - look.pulls[line] / pull for line, pull in most]
        slopes = [-look.by_pulls[line] / pull for line, pull in most]
        return np.array([look.margin - INSIDE, *rows]), np.stack([look.by_margin, *slopes])

    def is_met(self, look: Look) -> bool:
        """Tell whether a look is what is wanted, with no limit broken."""
        near = np.abs(look.values - self.values).max() < NEAR
        return bool(near and self.room(look)[0].min() > _BROKEN)

    def amiss(self, look: Look) -> float:
        """Return how far a look is from what is wanted, and how far it breaks limits besides [mm^2]."""
        return self._amiss(look.values, self.room(look)[0])

    def breaks_a_limit(self, look: Look) -> bool:
        """Tell whether a look breaks a limit."""
        return bool(self.room(look)[0].min() < 0.0)

    def towards(self, here: Floats, look: Look, reach: float) -> tuple[Floats, float]:
        """Return the lengths, within ``reach`` [%], that leave least amiss if all is linear, and how much.

        Room that is left to a limit is an unknown of its own, which may not be negative.
        """
        room, by_room = self.room(look)
        count, limits = len(here), len(room)
        matrix = np.block(
            [
                [self.weights[:, None] * look.by_values, np.zeros((len(self.values), limits))],
                [_LAZY * np.eye(count), np.zeros((count, limits))],
                [_STRICT * by_room, -_STRICT * np.eye(limits)],
            ]
        )
        away = self.weights * (self.values - look.values)
        right = np.concatenate([away, np.zeros(count), -_STRICT * room])
        low, high = (np.clip(end - here, -reach, reach) for end in (self.low, self.high))
        # No line may stand still for lack of room between its ends.
        low, high = np.minimum(low, -1e-9), np.maximum(high, 1e-9)
        ends = np.append(low, np.zeros(limits)), np.append(high, np.full(limits, np.inf))
        step = lsq_linear(matrix, right, ends, method="bvls").x[:count]
        there = np.clip(here + step, self.low, self.high)
        left = self._amiss(look.values + look.by_values @ (there - here), room + by_room @ (there - here))
        return there, left

    def _amiss(self, values: Floats, room: Floats) -> float:
        away = self.weights * (values - self.values)
        broken = _STRICT * np.minimum(room, 0.0)
        return float(away @ away + broken @ broken)


def weights_of(goals: Sequence[Goal]) -> Floats:
    """Return what each figure counts for: all heights of one section together as much as another one."""
    sections = [section_of(goal.name) or goal.name for goal in goals]
    return 1.0 / np.sqrt([float(sections.count(section)) for section in sections])
