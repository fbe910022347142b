"""How far the foremost place of the bust rises and comes out: figures that can be asked for (ours)."""

from __future__ import annotations

import numpy as np

from core.analysis.inverse_design.quantities import SIDES, Family, Read, Reading
from core.geometry.mesh import Floats, Points
from core.pipeline.build import Stages

_AXES = {"apex lift": np.array([0.0, 1.0]), "apex out": np.array([-1.0, 0.0])}  # by y and z


class _Apex:
    """How far the apexes have moved from rest: y and z of both times weights (2, 2), summed.

    The apex is not the same skin all the time: it is whatever lies foremost.
    """

    def __init__(self, stages: Stages, weights: Floats) -> None:
        self._watch, self._weights = stages.watch, weights
        self._rest = self._sum(stages.control.mesh.vertices)

    def _sum(self, control_points: Points) -> float:
        return float(np.sum(self._weights * self._watch.apexes(control_points)))

    def __call__(self, control_points: Points) -> Reading:
        """Return the figure at control points, shape (n, 3) [mm]."""
        slopes = self._watch.apex_slopes(control_points, self._weights)
        return Reading(self._sum(control_points) - self._rest, slopes)


def _read(stages: Stages, name: str) -> Read:
    what = next(each for each in _AXES if name.startswith(each))
    return _Apex(stages, SIDES[name.removeprefix(what)][:, None] * _AXES[what])


APEX = Family(tuple(f"{what}{side}" for what in _AXES for side in SIDES), _read)
"""How far the foremost places rise and come out, the mean of both or one [mm]."""
