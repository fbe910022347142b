"""The ways in which a body may stand in its file, each as it would look from the front."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.rendering.thumbnail import Picture, render_thumbnail
from core.geometry.mesh import Floats, unit
from core.progress import Progress, quiet
from core.scan.body import Body
from core.scan.orientation.axis_override import AXES, nearest_axis
from core.scan.orientation.pose import Pose

MOST = 4
"""Ways that are offered."""

SAME = np.cos(np.radians(20.0))
"""Two ways whose up and front lie nearer than this look the same."""

ON_AXIS = np.cos(np.radians(1.5))
"""A direction as near to an axis of the file as this has the name of the axis."""


@dataclass(frozen=True, eq=False)
class OrientationOption:
    """``up`` and ``front`` as a scan is told them, the nearest axes, the ``rotation`` (3, 3) from the
    body.
    """

    up: str
    front: str
    axes: tuple[str, str]
    rotation: Floats


def orientation_options(pose: Pose) -> list[OrientationOption]:
    """Return how a body may stand, the likeliest first: what its shape allows, then turns about up."""
    now = unit(pose.file_to_mm[:3, :3])
    about = [np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) for c, s in ((0, 1), (0, -1), (-1, 0))]
    found: list[Floats] = []
    for turn in [
        now,
        *(unit(other[:3, :3]) for other in pose.others),
        *(turn @ now for turn in about),
    ]:
        if not any(_alike(turn, old) for old in found):
            found.append(turn)
    return [_way(turn, turn @ now.T) for turn in found[:MOST]]


def option_thumbnails(
    body: Body, size: tuple[int, int], clay: tuple[int, int, int], progress: Progress = quiet
) -> list[tuple[OrientationOption, Picture]]:
    """Return each way with a picture of the body as it would stand; see ``render_thumbnail``. Raises
    Cancelled.
    """
    painted: list[tuple[OrientationOption, Picture]] = []
    for way in orientation_options(body.pose):
        progress("painting", len(painted) / MOST)
        painted.append((way, render_thumbnail(body.smoothed, way.rotation, size, clay)))
    return painted


def _alike(turn: Floats, old: Floats) -> bool:
    """Whether two ways look the same, or would be told by the same axes."""
    near = bool(turn[2] @ old[2] > SAME and turn[1] @ old[1] > SAME)
    return near or all(nearest_axis(turn[k]) == nearest_axis(old[k]) for k in (1, 2))


def _way(file_to_body: Floats, turn: Floats) -> OrientationOption:
    up, front = file_to_body[2], -file_to_body[1]
    return OrientationOption(_told(up), _told(front), (nearest_axis(up), nearest_axis(front)), turn)


def _told(direction: Floats) -> str:
    name = nearest_axis(direction)
    if AXES[name] @ direction > ON_AXIS:
        return name
    return ",".join(f"{value:.5f}" for value in direction)
