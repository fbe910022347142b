"""How much higher and further out the left bust point is than the right: even is 0 (ours)."""

from __future__ import annotations

import numpy as np

from core.analysis.inverse_design.bust_quantity import AXES, LIFT, OUT
from core.analysis.inverse_design.quantities import Family, Read, Reading
from core.geometry.mesh import Points
from core.pipeline.build import Stages

HIGHER, FURTHER_OUT = "left higher", "left further out"
_MORE = {HIGHER: AXES[LIFT], FURTHER_OUT: AXES[OUT]}
_LEFT_LESS_RIGHT = np.array([[1.0], [-1.0]])


class LeftMore:
    """By how much the left bust point is further along a way, (3,), than the right one."""

    def __init__(self, stages: Stages, way: Points) -> None:
        self._watch, self._weights = stages.watch, _LEFT_LESS_RIGHT * way

    def __call__(self, control_points: Points) -> Reading:
        """Return the figure at control points, shape (n, 3) [mm]."""
        value = float(np.sum(self._weights * self._watch.bust_points(control_points)))
        return Reading(value, self._watch.bust_point_slopes(control_points, self._weights))


def _read(stages: Stages, name: str) -> Read:
    return LeftMore(stages, _MORE[name])


EVEN = Family(tuple(_MORE), _read)
"""How much higher and further out the left bust point is than the right, as they lie now [mm]."""
