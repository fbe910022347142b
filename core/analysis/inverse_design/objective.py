"""Objective of the line lengths within limits, and the step towards it (ours)."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from core.analysis.inverse_design.profile_quantities import section_of
from core.analysis.inverse_design.quadratic_model import QuadraticModel, violation
from core.analysis.inverse_design.quantities import tolerance
from core.analysis.inverse_design.quantity import PRIORITIES, Goal
from core.analysis.inverse_design.sensitivities import LinearizedSolution
from core.geometry.mesh import Floats

NEAR = 0.05
"""A figure this near to what was asked for is what was asked for [mm]."""

INSIDE = 5e-3
"""So far inside the limit of strain lengths stay: a run ends a hair beside its exact answer [1]."""

_BROKEN = -1e-4  # room to a limit [1]
_SLACK = 0.03  # of the tension at the start: about as much counts as none [1]
_FIRM = 10.0  # what the room of a line to pushing is counted in [N]


Slopes = tuple[float, Floats]


@dataclass
class Objective:
    """Figures that are to have ``values`` (m,) [mm], with ``low`` and ``high`` ends of lengths (p,) [%].

    ``weights`` (m,) are what figures count for; those of no weight are read and not wanted. ``lines`` names
    those of all regions; ``hardest`` is the most that some may pull with and ``loosest`` the least, negative
    where they may push [N].
    """

    values: Floats
    weights: Floats
    low: Floats
    high: Floats
    lines: Sequence[str]
    hardest: Mapping[str, float] = field(default_factory=dict)
    loosest: Mapping[str, float] = field(default_factory=dict)

    def margins(self, look: LinearizedSolution) -> tuple[Floats, Floats]:
        """Return the room to the most and least tensions and to strain of the edges, (k,) [1], and slopes."""
        pulls, by_pulls = self._pulls(look)
        return np.append(pulls, look.margins - INSIDE), np.concatenate([by_pulls, look.by_margins])

    def smooth_margins(self, look: LinearizedSolution) -> tuple[Floats, Floats]:
        """Return the room to the most and least tensions and to strain in all, (k,) [1], and slopes."""
        pulls, by_pulls = self._pulls(look)
        margin, by_margin = look.least_margin()
        return np.append(pulls, margin - INSIDE), np.concatenate([by_pulls, by_margin[None]])

    def _pulls(self, look: LinearizedSolution) -> tuple[Floats, Floats]:
        hard, loose = ([self.lines.index(name) for name in each] for each in (self.hardest, self.loosest))
        most, least = (np.array(list(each.values())) for each in (self.hardest, self.loosest))
        room = np.append(1.0 - look.tensions[hard] / most, (look.tensions[loose] - least) / _FIRM)
        return room, np.concatenate(
            [-look.by_tensions[hard] / most[:, None], look.by_tensions[loose] / _FIRM]
        )

    def is_met(self, look: LinearizedSolution) -> bool:
        """Return whether a candidate meets all targets within all limits."""
        near = np.abs(look.values - self.values)[self.weights > 0.0].max() < NEAR
        return bool(near and self.margins(look)[0].min() > _BROKEN)

    def violation(self, look: LinearizedSolution) -> float:
        """Return how far a look is from what is wanted, and how far it breaks limits besides [mm^2]."""
        return violation(self.residual_rows(look)[0], len(self.values))

    def residual_rows(self, look: LinearizedSolution) -> tuple[Floats, Floats]:
        """Return what figures lack, as they count [mm], then the rooms [1], and slopes: see
        ``QuadraticModel``.
        """
        room, by_room = self.margins(look)
        lack, by_lack = look.values - self.values, look.by_values
        return (
            np.append(self.weights * lack, room),
            np.concatenate([self.weights[:, None] * by_lack, by_room]),
        )

    def next_lengths(
        self, here: Floats, look: LinearizedSolution, reach: float, bends: Floats
    ) -> tuple[Floats, float]:
        """Return the lengths, within ``reach`` [%], that leave least amiss by what is known, and how much.

        ``bends`` (r, p, p) are those of the rows.
        """
        low, high = (np.clip(end - here, -reach, reach) for end in (self.low, self.high))
        step, left = QuadraticModel(*self.residual_rows(look), bends, len(self.values)).minimize(low, high)
        return np.clip(here + step, self.low, self.high), left

    def subset(self, chosen: Collection[int]) -> Objective:
        """Return these targets with those of the ``chosen`` rows alone wanted."""
        weights = np.zeros_like(self.weights)
        weights[list(chosen)] = self.weights[list(chosen)]
        return replace(self, weights=weights / weights.max())

    @property
    def smallest_weight_ratio(self) -> float:
        """Return the smallest weight of a target divided by the largest [1]."""
        wanted = self.weights[self.weights > 0.0]
        return float(wanted.min() / wanted.max())


def goal_weights(goals: Sequence[Goal]) -> Floats:
    """Return what each figure counts for: its priority over its tolerance, that of the first being 1.

    All heights of one section count together as much as another figure.
    """
    sections = [section_of(goal.name) or goal.name for goal in goals]
    count = np.array([float(sections.count(section)) for section in sections])
    scale = np.array([PRIORITIES[goal.priority] / tolerance(goal.name) for goal in goals])
    return np.asarray(scale / scale.max() / np.sqrt(count))


def total_tension(look: LinearizedSolution, unit: float) -> Slopes:
    """Return the sum of all tensions over ``unit`` and its slopes, shape (p,).

    A line that pushes counts as slack; the transition is smooth.
    """
    pulls, by_pulls = look.tensions / unit, look.by_tensions / unit
    size = np.hypot(pulls, _SLACK)
    return 0.5 * float((pulls + size).sum()), 0.5 * np.asarray((1.0 + pulls / size) @ by_pulls)
