"""What is drawn on the body to define a measure: filled areas, arrows, levels that it is taken from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.geometry.mesh import Points
from core.landmarks.types import SIDES, Landmarks
from core.measurements.table import Measures

BUSTS = tuple(f"bust_point_{side}" for side in SIDES)

BESIDE = 34.0
"""So far beside the body stands an arrow, and a third of it further a line goes on [mm]."""


@dataclass(frozen=True, eq=False)
class Marks:
    """What defines a measure, each of shape (k, 3) [mm].

    ``curves`` lie on the skin; ``arrows`` have two ends, between which is measured; ``guides`` are
    lines that it is measured from or to; ``dots`` are places.
    """

    curves: tuple[Points, ...] = ()
    arrows: tuple[Points, ...] = ()
    guides: tuple[Points, ...] = ()
    dots: tuple[Points, ...] = ()


def marks_of(key: str, found: Measures, landmarks: Landmarks) -> Marks:
    """Return what defines a measure, of the left side where there are two."""
    curves = (found.get(key) or found[f"{key}_{SIDES[0]}"]).curves
    left, right = (landmarks.position(name) for name in BUSTS)
    if key in ("bust_point_distance", "cup_width"):
        return Marks(arrows=curves)
    if key == "cup_depth":
        depth, line = curves
        return Marks(arrows=(depth,), guides=(line,), dots=(depth[1:],))
    if key in ("bust_point_to_fold", "root_length"):
        return Marks(curves=curves, dots=(curves[0][[0, -1]],))
    if key in ("asymmetry_height", "asymmetry_forward"):
        return _levels(left, right, axis=2 if key == "asymmetry_height" else 1)
    special = {
        "bust_height": lambda: _heights(left, np.array([*left[:2], landmarks.underbust_level])),
        "bust_protrusion": lambda: _depths(*curves[0]),
        "asymmetry_volume": lambda: Marks(
            curves=tuple(each for side in SIDES for each in found[f"breast_volume_{side}"].curves)
        ),
        "apex_lift": lambda: _heights(*curves[0][::-1]),
        "waist_to_hip": lambda: _heights(*curves[0]),
        "seat_protrusion": lambda: _depths(*curves[0]),
        "gluteal_fold_height": lambda: _heights(*curves[0][::-1], behind=True),
        "seat_volume": Marks,
    }
    return special.get(key, lambda: Marks(curves=curves))()


def _heights(upper: Points, lower: Points, *, behind: bool = False) -> Marks:
    """Seen from the side: two levels before or behind the body, and the way from one to the other."""
    away = -BESIDE if behind else BESIDE
    beside = (max if behind else min)(upper[1], lower[1]) - away
    ends = np.array([[upper[0], beside, lower[2]], [upper[0], beside, upper[2]]])
    guides = tuple(
        np.array([place, end - (0.0, away / 3.0, 0.0)])
        for place, end in zip((lower, upper), ends, strict=True)
    )
    return Marks(arrows=(ends,), guides=guides, dots=(upper[None],))


def _depths(chest: Points, tip: Points) -> Marks:
    """Seen from the side: two upright lines, and the way forward from one to the other above the bust."""
    above = tip[2] + 2.6 * BESIDE
    ends = np.array([[tip[0], chest[1], above], [tip[0], tip[1], above]])
    low = np.array([tip[0], 0.0, tip[2] - 2.6 * BESIDE])
    further = np.array((0.0, 0.0, BESIDE / 3.0))
    guides = tuple(np.array([[*end[:2], low[2]], end + further]) for end in ends)
    return Marks(arrows=(ends,), guides=guides, dots=(tip[None],))


def _levels(left: Points, right: Points, axis: int) -> Marks:
    """Two lines from side to side, one through each bust point, and the way along ``axis`` between them."""
    wide = 1.9 * abs(left[0])
    forward = min(left[1], right[1])

    def line(place: Points) -> Points:
        y = place[1] if axis == 1 else forward
        return np.array([[-wide, y, place[2]], [wide, y, place[2]]])

    ends = np.array([line(right)[1], line(left)[1]])
    ends[:, 0] = left[0] if axis == 1 else 0.0
    if axis == 1:
        ends[:, 2] = left[2]
        guides = tuple(np.column_stack([line(each)[:, :2], [left[2]] * 2]) for each in (left, right))
    else:
        guides = line(left), line(right)
    return Marks(arrows=(ends,), guides=guides, dots=(np.array([left, right]),))
