"""Quantities of the lower trunk that can be targets, by the control points of that region (ours)."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from scipy.spatial import cKDTree

from core.analysis.inverse_design.quantity import SIDES, QuantityFamily, Read, Reading, Weighted
from core.deformation.tffd import FewPlaces
from core.geometry.mesh import Points
from core.pipeline.build import Stages
from core.pipeline.lower_region import LowerStages
from core.pipeline.observables import Tapes

_LEVELS = {"waist girth": "waist", "belly girth": "belly", "hip girth": "hip"}
_BACK, _UP = np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0])
_MARKS = {
    "buttock lift": ("buttock", _UP),
    "buttock out": ("buttock", _BACK),
    "fold lift": ("gluteal_fold", _UP),
}
_BELLY = "belly out"
_HIGHER = {"left buttock higher": "buttock", "left fold higher": "gluteal_fold"}


class _Girth:
    """A tape laid level round the body at a height that it keeps."""

    def __init__(self, lower: LowerStages, height: float) -> None:
        self._binding, self._moving = lower.binding, lower.moving
        self._tape = Tapes(lower.moving, [height])

    def __call__(self, control_points: Points) -> Reading:
        """Return the figure at control points, shape (n, 3) [mm]."""
        places = self._binding.places(control_points, self._moving.rest)
        (value,), (by_places,) = self._tape(places), self._tape.slopes(places)
        return Reading(float(value), self._binding.gradient(control_points, by_places[: self._moving.count]))


def _read_girth(stages: Stages, name: str) -> Read:
    return _Girth(_lower(stages), _lower(stages).landmarks.levels[_LEVELS[name]])


def _read_mark(stages: Stages, name: str) -> Read:
    what = next(each for each in _MARKS if name.startswith(each))
    mark, axis = _MARKS[what]
    weights = SIDES[name.removeprefix(what)][:, None] * axis
    return _followed(_lower(stages), (f"{mark}_left", f"{mark}_right"), weights)


def _read_balance(stages: Stages, name: str) -> Read:
    lower = _lower(stages)
    names = tuple(f"{_HIGHER[name]}_{side}" for side in ("left", "right"))
    few, marks = followed_marks(lower, names), np.stack([lower.landmarks.position(each) for each in names])
    away = marks - few.rest
    weights = np.stack([_UP, -_UP])
    return Weighted(lambda points: few.places(points) + away, few.gradient, weights)


def _read_belly(stages: Stages, _: str) -> Read:
    return _followed(_lower(stages), ("belly",), -_BACK[None])


def _followed(lower: LowerStages, names: tuple[str, ...], weights: Points) -> Read:
    """Return what reads how far the vertices nearest to landmarks move, times ``weights`` (k, 3)."""
    few = followed_marks(lower, names)
    return Weighted(few.places, few.gradient, weights, lower.control.mesh.vertices)


@lru_cache(maxsize=8)  # handles on the body follow them in every frame
def followed_marks(lower: LowerStages, names: tuple[str, ...]) -> FewPlaces:
    """Return the vertices nearest to landmarks of the lower trunk, in their order."""
    marks = np.stack([lower.landmarks.position(name) for name in names])
    _, rows = cKDTree(lower.binding.rest_moving).query(marks)
    return lower.binding.few(np.asarray(rows, dtype=np.int64))


def _lower(stages: Stages) -> LowerStages:
    assert stages.lower is not None
    return stages.lower


LOWER_GIRTHS = QuantityFamily(tuple(_LEVELS), _read_girth, tolerance=5.0, region="lower")
"""The girths at the heights of waist, belly and largest hip, as they are at rest [mm]."""

SEAT = QuantityFamily(tuple(f"{what}{side}" for what in _MARKS for side in SIDES), _read_mark, region="lower")
"""How far buttock points rise and come out backwards, and folds rise, the mean of both or one [mm]."""

SEAT_EVEN = QuantityFamily(tuple(_HIGHER), _read_balance, region="lower")
"""How much higher the left buttock point and the left gluteal fold are, as they are now [mm]."""

BELLY = QuantityFamily((_BELLY,), _read_belly, region="lower")
"""How far the belly comes out [mm]; less than nothing is flatter."""
