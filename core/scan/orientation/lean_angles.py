"""The lean of a body in its file as two angles, and the up direction that corrects it."""

from __future__ import annotations

import numpy as np

from core.geometry.mesh import Floats, unit
from core.scan.orientation.axis_override import AXES
from core.scan.orientation.pose import Pose

MOST = 45.0
"""The largest lean against the nearest axis of the file [degrees]."""


def lean_angles(pose: Pose) -> tuple[float, float]:
    """Return how far a body leans in its file, forward and to its left [degrees].

    Both are measured from the axis of the file that points up.
    """
    ahead, aside, axis = _directions(pose)
    up = unit(pose.file_to_mm[2, :3])
    forward, left = np.degrees(np.arctan2([up @ ahead, up @ aside], up @ axis))
    return float(forward), float(left)


def corrected_up(pose: Pose, forward: float, left: float) -> str:
    """Return the up direction "x,y,z" in the file of a body that leans so far [degrees] in it."""
    ahead, aside, axis = _directions(pose)
    angles = np.radians(np.clip([forward, left], -MOST, MOST))
    up = unit(axis + np.tan(angles[0]) * ahead + np.tan(angles[1]) * aside)
    return ",".join(f"{number:.4f}" for number in up + 0.0)


def _directions(pose: Pose) -> tuple[Floats, Floats, Floats]:
    """Return level unit vectors of the file to the front and the left of a body, and the axis that is up."""
    axis = AXES[pose.up]
    front = -pose.file_to_mm[1, :3]
    ahead = unit(front - (front @ axis) * axis)
    return ahead, np.cross(axis, ahead), axis
