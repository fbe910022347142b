"""The torso under a control mesh: its axis and size, its armpits, and how high the breasts lie round it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.errors import FitError
from core.geometry.mesh import Flags, Floats, Mesh, Points
from core.landmarks.torso.cross_sections import trunk_levels
from core.landmarks.types import Landmarks
from core.messages import Message, SideName

REFERENCE = 130.0
"""Half width of the torso under the breasts for which the lengths of a template are given [mm]."""

ROOT = np.radians(80.0)
"""The outer root of the breast lies at least so far round the torso ..."""

BEYOND = np.radians(28.0)
"""... and at least so far beyond the bust point [rad]."""

SHOULDER = 1.3
"""From the armpits up the torso is more than so many times as wide as under the breasts."""

UNDER = np.array([-20.0, -12.0, -5.0])
"""The torso is measured so far over the under-bust level [mm]: at the first that the scan shows."""


@dataclass(frozen=True)
class Breast:
    """Where one breast lies: azimuths of bust point and outer root about the axis [rad], heights [mm]."""

    azimuth: float
    root: float
    bust: float
    fold: float
    lowest: float


@dataclass(frozen=True, eq=False)
class Torso:
    """The upright axis through ``axis``, shape (3,) [mm], and what stands round it.

    ``scale`` [1] is the size of the torso against the reference, ``armpit`` the height of the armpits and
    ``armpit_width`` the half width of the torso there [mm].
    """

    axis: Points
    scale: float
    armpit: float
    armpit_width: float
    left: Breast
    right: Breast

    def height(self, what: str, azimuth: Floats) -> Floats:
        """Return the height of "bust", "fold" or "lowest" at azimuths, shape (k,) [rad]; shape (k,) [mm].

        Level outside each bust point, and a smooth way from one to the other between them.
        """
        reach = np.where(azimuth >= 0.0, self.left.azimuth, self.right.azimuth)
        t = 0.5 * (1.0 + np.clip(azimuth / reach, -1.0, 1.0))
        left = t * t * (3.0 - 2.0 * t)
        return np.asarray(left * getattr(self.left, what) + (1.0 - left) * getattr(self.right, what))


def cropped(mesh: Mesh, keep: Flags) -> Mesh:
    """Return the triangles all whose corners are in ``keep``, shape (n,), with these vertices only."""
    faces = mesh.faces[keep[mesh.faces].all(axis=1)]
    used = np.zeros(len(mesh.vertices), dtype=np.bool_)
    used[faces] = True
    return Mesh(mesh.vertices[used], (np.cumsum(used) - 1)[faces])


def measure_torso(mesh: Mesh, landmarks: Landmarks) -> Torso:
    """Measure the torso of a body. Raises FitError if there is none under the breasts. Source: ours."""
    level = _below(mesh, landmarks.underbust_level)
    if len(level) < 3:
        raise FitError(
            Message("The scan ends at the breasts: the torso below them is missing."),
            Message("Open a scan that extends at least 10 cm below the breasts, or correct the landmarks."),
        )
    low, high = level.min(axis=0), level.max(axis=0)
    axis = np.array([0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), 0.0])
    half_width = 0.5 * float(high[0] - low[0])
    scale = half_width / REFERENCE
    armpit, armpit_width = _armpit(mesh, landmarks, half_width)
    left, right = (_breast(landmarks, side, axis) for side in ("left", "right"))
    return Torso(axis, scale, armpit, armpit_width, left, right)


def _below(mesh: Mesh, underbust_level: float) -> Points:
    """Return the outline of the torso 2 cm under the breasts, nearer if the scan ends before, (k, 3) [mm]."""
    levels = [level.points for level in trunk_levels(mesh, underbust_level + UNDER)]
    widths = np.array([np.ptp(points[:, 0]) if len(points) else 0.0 for points in levels])
    return levels[int(np.argmax(widths >= 0.85 * widths.max()))]


def _armpit(mesh: Mesh, landmarks: Landmarks, half_width: float) -> tuple[float, float]:
    """Return height and half width of the last level, going up, that is not yet as wide as shoulders [mm]."""
    scale = half_width / REFERENCE
    z = np.arange(landmarks.bust_level - 12.0, landmarks.bust_level + 150.0 * scale, 3.0)
    low, high, width = 0, len(z), half_width
    for step in (4, 1):  # coarse first: a level costs time
        tried = np.arange(low, high, step)
        levels = [level.points for level in trunk_levels(mesh, z[tried], arms=True)]
        widths = np.array([0.5 * np.ptp(points[:, 0]) if len(points) else np.inf for points in levels])
        over = np.flatnonzero(widths > SHOULDER * half_width)
        first = int(over[0]) if len(over) else len(tried)
        if first == 0:
            break
        low, width = int(tried[first - 1]), float(widths[first - 1])
        high = min(low + step, high)
    return float(z[low]), width


def _breast(landmarks: Landmarks, side: str, axis: Points) -> Breast:
    bust, fold = landmarks.position(f"bust_point_{side}"), landmarks.position(f"fold_{side}")
    outward = (1.0 if side == "left" else -1.0) * float(bust[0] - axis[0])
    forward = float(axis[1] - bust[1])
    azimuth = float(np.arctan2(outward, forward))
    if not np.radians(10.0) < azimuth < np.radians(80.0):
        raise FitError(
            Message(
                "The {side} bust point is at an angle of {angle} degrees to the front centre, outside the "
                "range of 10 to 80 degrees.",
                side=SideName(side),
                angle=f"{np.degrees(azimuth):.0f}",
            ),
            Message("Place the bust point on the breast of that side."),
        )
    lowest = min(float(fold[2]), float(landmarks.position(f"lowest_{side}")[2]))
    return Breast(azimuth, max(ROOT, azimuth + BEYOND), float(bust[2]), float(fold[2]), lowest)
