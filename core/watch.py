"""What is watched on the body turn by turn: the heights of its bust points, and its foremost place."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from core.control_mesh import ControlMesh
from core.landmarks import Landmarks
from core.mesh import Flags, Indices, Points
from core.solver import Marks
from core.tffd import Binding

_SHARPNESS = 1.0  # [mm]
_REACH = 30.0
_CANDIDATES = 400


class BodyWatch:
    """Follows a few hundred body vertices through t-FFD, so that a turn is measured without moving them all.

    The bust points are the body vertices nearest to the landmarks. The apex of a breast is the mean of its
    vertices, weighted by exp(-d / 1 mm) with their distance d behind the foremost: a single foremost vertex
    jumps about on a flat breast (ours). Protrusion is the distance of the apex in front of the centre of the
    control mesh's border. Calling it with control points, shape (n, 3) [mm], gives Marks; apex of both sides.
    """

    def __init__(self, binding: Binding, control: ControlMesh, landmarks: Landmarks) -> None:
        rest = binding.rest_moving
        points = np.stack([landmarks.position(f"bust_point_{side}") for side in ("left", "right")])
        _, nipples = cKDTree(rest).query(points)
        left, right = (_foremost(rest, on_side) for on_side in _sides(rest, control))
        self._left = slice(2, 2 + len(left))
        self._right = slice(2 + len(left), None)
        rows = np.concatenate([nipples, left, right])
        self._binding, self._rest, self._operator = binding, rest[rows], binding.operator.of_rows(rows)
        self._offset = points[:, 2] - rest[nipples, 2]
        self._back = float(control.mesh.vertices[control.border, 1].mean())

    def __call__(self, control_points: Points) -> Marks:
        """Return the marks for control points, shape (n, 3) [mm]."""
        places = self._rest + self._operator @ self._binding.change(control_points)
        apex = np.mean([_apex(places[self._left]), _apex(places[self._right])], axis=0)
        heights = places[:2, 2] + self._offset
        return Marks(float(heights[0]), float(heights[1]), float(apex[1]), self._back - float(apex[0]))


def _sides(rest: Points, control: ControlMesh) -> tuple[Flags, Flags]:
    """Tell which vertices lie on the free part of the left and of the right breast."""
    _, nearest = cKDTree(control.mesh.vertices).query(rest)
    free = ~control.fixed[nearest]
    return free & (control.column[nearest] > 0), free & (control.column[nearest] < 0)


def _foremost(rest: Points, on_side: Flags) -> Indices:
    """Return rows of vertices that may become the foremost: near the present one, evenly thinned."""
    rows = np.flatnonzero(on_side)
    near = rows[rest[rows, 1] < rest[rows, 1].min() + _REACH]
    return np.asarray(near[:: max(1, len(near) // _CANDIDATES)])


def _apex(places: Points) -> Points:
    """Return y and z of the apex, shape (2,) [mm]: a mean that favours what lies foremost."""
    weight = np.exp((places[:, 1].min() - places[:, 1]) / _SHARPNESS)
    return np.asarray(weight @ places[:, 1:] / weight.sum())
