"""Figures of the body that can be asked for, each with its slopes by the control points (ours)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from core.errors import UserError
from core.mesh import Floats, Points
from core.pipeline import Stages
from core.watch import Tapes

LIFT, OUT, GIRTH = "lift", "out", "girth"
SIDES = {"": np.array([0.5, 0.5]), " left": np.array([1.0, 0.0]), " right": np.array([0.0, 1.0])}
_AXES = {LIFT: np.array([0.0, 0.0, 1.0]), OUT: np.array([0.0, -1.0, 0.0])}

NAMES = (*(f"{what}{side}" for what in (LIFT, OUT) for side in SIDES), GIRTH)
"""What can be asked for: how far bust points rise and come out [mm], the girth at their level [mm]."""


STEP = 5.0
"""Heights at which a tape is laid, to be read between them [mm]."""


@dataclass(frozen=True, eq=False)
class Reading:
    """A figure [mm] and its slopes by the control points, shape (n, 3) [1]."""

    value: float
    slopes: Points


Read = Callable[[Points], Reading]
"""Reads a figure off control points, shape (n, 3) [mm]."""


def reading(stages: Stages, name: str) -> Read:
    """Return what reads the figure ``name``. Raises UserError if there is none of that name."""
    if name == GIRTH:
        return _Girth(stages)
    what, _, side = name.partition(" ")
    if what not in _AXES or f" {side}".rstrip() not in SIDES:
        raise UserError(f"'{name}' cannot be asked for.", f"Ask for one of: {', '.join(NAMES)}.")
    return _BustPoints(stages, SIDES[f" {side}".rstrip()][:, None] * _AXES[what])


class _BustPoints:
    """How far bust points have moved from rest: both places times weights (2, 3), summed."""

    def __init__(self, stages: Stages, weights: Floats) -> None:
        self._watch, self._weights = stages.watch, weights
        self._rest = self._sum(stages.control.mesh.vertices)

    def _sum(self, control_points: Points) -> float:
        return float(np.sum(self._weights * self._watch.bust_points(control_points)))

    def __call__(self, control_points: Points) -> Reading:
        """Return the figure at control points, shape (n, 3) [mm]."""
        slopes = self._watch.bust_point_slopes(control_points, self._weights)
        return Reading(self._sum(control_points) - self._rest, slopes)


class _Girth:
    """A tape laid level round the body at the mean height of the bust points, which it follows.

    It is laid at heights that are ``STEP`` apart and read between the two next to the bust points.
    """

    def __init__(self, stages: Stages) -> None:
        self._stages = stages
        self._rise = _BustPoints(stages, SIDES[""][:, None] * _AXES[LIFT])
        marks = stages.rest_marks
        self._rest_height = (marks.nipple_left_z + marks.nipple_right_z) / 2.0
        self._levels: dict[float, Tapes] = {}

    def __call__(self, control_points: Points) -> Reading:
        """Return the figure at control points, shape (n, 3) [mm]."""
        binding, moving = self._stages.binding, self._stages.moving
        places = binding.operator.added(binding.change(control_points), moving.rest)
        rise = self._rise(control_points)
        low, part = divmod((self._rest_height + rise.value) / STEP, 1.0)
        tapes = [self._tape(STEP * level) for level in (low, low + 1.0)]
        (below,), (above,) = (tape(places) for tape in tapes)
        (by_below,), (by_above,) = (tape.slopes(places) for tape in tapes)
        by_places = (1.0 - part) * by_below + part * by_above
        slopes = binding.pulled(control_points, by_places[: moving.count])
        steep = float(above - below) / STEP
        return Reading(float((1.0 - part) * below + part * above), slopes + steep * rise.slopes)

    def _tape(self, height: float) -> Tapes:
        if height not in self._levels:
            self._levels[height] = Tapes(self._stages.moving, [height])
        return self._levels[height]
