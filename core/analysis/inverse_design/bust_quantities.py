"""Quantities of the bust that can be targets, by the control points of the bust (ours)."""

from __future__ import annotations

import numpy as np

from core.analysis.inverse_design.quantity import SIDES, QuantityFamily, Read, Reading, Weighted
from core.geometry.mesh import Points
from core.pipeline.build import Stages
from core.pipeline.observables import Tapes

LIFT, OUT = "lift", "out"
_AXES = {LIFT: np.array([0.0, 0.0, 1.0]), OUT: np.array([0.0, -1.0, 0.0])}
_APEX_AXES = {"apex lift": np.array([0.0, 1.0]), "apex out": np.array([-1.0, 0.0])}  # by y and z
HIGHER, FURTHER_OUT = "left higher", "left further out"
_LEFT_LESS_RIGHT = {HIGHER: _AXES[LIFT], FURTHER_OUT: _AXES[OUT]}


def _read_bust(stages: Stages, name: str) -> Read:
    what, watch = name.split(maxsplit=1)[0], stages.watch
    weights = SIDES[name.removeprefix(what)][:, None] * _AXES[what]
    return Weighted(watch.bust_points, watch.bust_point_slopes, weights, stages.control.mesh.vertices)


def _read_apex(stages: Stages, name: str) -> Read:
    what, watch = next(each for each in _APEX_AXES if name.startswith(each)), stages.watch
    weights = SIDES[name.removeprefix(what)][:, None] * _APEX_AXES[what]
    return Weighted(watch.apexes, watch.apex_slopes, weights, stages.control.mesh.vertices)


def _read_balance(stages: Stages, name: str) -> Read:
    weights = np.array([[1.0], [-1.0]]) * _LEFT_LESS_RIGHT[name]
    return Weighted(stages.watch.bust_points, stages.watch.bust_point_slopes, weights)


BUST = QuantityFamily(tuple(f"{what}{side}" for what in _AXES for side in SIDES), _read_bust)
"""How far bust points rise and come out, the mean of both or one [mm]."""

APEX = QuantityFamily(tuple(f"{what}{side}" for what in _APEX_AXES for side in SIDES), _read_apex)
"""How far the foremost places, whatever skin that is, rise and come out, the mean of both or one [mm]."""

EVEN = QuantityFamily(tuple(_LEFT_LESS_RIGHT), _read_balance)
"""How much higher and further out the left bust point is than the right, as they are now [mm]."""

TAPE_STEP = 5.0
"""Heights at which a tape is laid, to be read between them [mm]."""


class _Girth:
    """A tape laid level round the body at the mean height of the bust points, which it follows.

    It is laid at heights that are ``TAPE_STEP`` apart and read between the two next to the bust points.
    """

    def __init__(self, stages: Stages) -> None:
        self._stages = stages
        self._rise = _read_bust(stages, LIFT)
        marks = stages.rest_marks
        self._rest_height = (marks.bust_point_left_z + marks.bust_point_right_z) / 2.0
        self._levels: dict[float, Tapes] = {}

    def __call__(self, control_points: Points) -> Reading:
        """Return the figure at control points, shape (n, 3) [mm]."""
        binding, moving = self._stages.binding, self._stages.moving
        places = binding.places(control_points, moving.rest)
        rise = self._rise(control_points)
        low, part = divmod((self._rest_height + rise.value) / TAPE_STEP, 1.0)
        tapes = [self._tape(TAPE_STEP * level) for level in (low, low + 1.0)]
        (below,), (above,) = (tape(places) for tape in tapes)
        (by_below,), (by_above,) = (tape.slopes(places) for tape in tapes)
        by_places = (1.0 - part) * by_below + part * by_above
        slopes = binding.gradient(control_points, by_places[: moving.count])
        steep = float(above - below) / TAPE_STEP
        return Reading(float((1.0 - part) * below + part * above), slopes + steep * rise.slopes)

    def _tape(self, height: float) -> Tapes:
        if height not in self._levels:
            self._levels[height] = Tapes(self._stages.moving, [height])
        return self._levels[height]


GIRTH = "girth"
_TOLERANCE = 5.0  # a girth grows by 2 pi times what its outline moves by [mm]
GIRTHS = QuantityFamily((GIRTH,), lambda stages, _: _Girth(stages), tolerance=_TOLERANCE)
"""The girth at the level of the bust points, as they are then [mm]."""
