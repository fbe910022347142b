"""Which part of a body is framed by a view, from whatever side."""

from __future__ import annotations

import numpy as np

from app.rendering.camera import View
from core.geometry.mesh import Floats, Points
from core.geometry.planar_curves import Plane

NOBODY = np.array([[-200.0, 200.0], [-130.0, 130.0], [0.0, 560.0]])
"""The box of a torso, where there is none."""

_ABOVE_BUST, _BELOW_BUST = 270.0, 350.0  # what a framed bust shows: from the neck to below the waist [mm]

_BUST_HEIGHT = 0.56  # of a torso cut at the hips, used until the landmarks are known

_EDGE = 0.1  # what lies nearer to the edge of a picture than this part of it is hardly seen
_SHEET = 24.0  # how far the sheet of a section reaches out of the body [mm]
_CLOSEST = 90.0  # what is shown round a place, whatever its size [mm]


def box_of(points: Points) -> Floats:
    """Return the least and largest coordinates of points (n, 3), shape (3, 2) [mm]."""
    return np.stack([points.min(axis=0), points.max(axis=0)], axis=1)


def framing_bust(view: View, box: Floats, level: float | None, aspect: float) -> View:
    """Return ``view`` of shoulders to waist; ``level`` is the height of the bust [mm], if it is known."""
    low, high = box[2]
    if level is None:
        level = low + _BUST_HEIGHT * (high - low)
    height = max(level - _BELOW_BUST, low), min(level + _ABOVE_BUST, high)
    return view.framing(np.stack([*box[:2], height]), aspect, margin=1.08)


def framing_points(view: View, points: Points, aspect: float) -> View:
    """Return ``view`` of ``points``, shape (k, 3) [mm], with some of what lies round them."""
    around = np.array([-_CLOSEST, _CLOSEST])
    return view.framing(box_of(points) + around, aspect)


def framing_place(view: View, place: Floats, normal: Floats, aspect: float) -> View:
    """Return ``view`` turned to where a place, (3,) [mm], faces the eye, and brought there if it is not seen.

    ``normal`` is that of the skin there, shape (3,).
    """
    turned = view.facing(normal)
    x, y, _ = turned.to_picture(place[None], aspect, 1.0)[0]
    seen = _EDGE * aspect < x < (1.0 - _EDGE) * aspect and _EDGE < y < 1.0 - _EDGE
    return turned if seen else turned.centred(place)


def depth_range(view: View, box: Floats) -> tuple[float, float]:
    """Return between which distances from the eye a body in ``box`` and its floor lie [mm]."""
    radius = float(np.hypot(np.linalg.norm(box[:, 1] - box[:, 0]) / 2.0, 700.0))
    depth = float((view.eye - box.mean(axis=1)) @ view.axes[2])
    return max(depth - radius, 20.0), max(depth + radius, 40.0)


def sheet_ends(plane: Plane, low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """Return the least and the largest flat coordinates, (2,) each, of a sheet through a box, (3,) [mm]."""
    corners = plane.flat(np.stack([low - _SHEET, high + _SHEET]))
    return corners.min(axis=0), corners.max(axis=0)
