"""How far the bust points rise and come out: figures that can be asked for (ours)."""

from __future__ import annotations

import numpy as np

from core.analysis.inverse_design.quantities import SIDES, Family, Read, Reading
from core.geometry.mesh import Floats, Points
from core.pipeline.build import Stages

LIFT, OUT = "lift", "out"
AXES = {LIFT: np.array([0.0, 0.0, 1.0]), OUT: np.array([0.0, -1.0, 0.0])}
"""Which way each is counted, shape (3,)."""


class BustPoints:
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


def _read(stages: Stages, name: str) -> Read:
    what = name.split(maxsplit=1)[0]
    return BustPoints(stages, SIDES[name.removeprefix(what)][:, None] * AXES[what])


BUST = Family(tuple(f"{what}{side}" for what in AXES for side in SIDES), _read)
"""How far bust points rise and come out, the mean of both or one [mm]."""
