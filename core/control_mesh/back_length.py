"""The back of a band: the way round the back from one end of a line to the other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.control_mesh.fit import ControlMesh
from core.errors import FitError
from core.geometry.mesh import Floats, Mesh, Points, frozen
from core.landmarks.torso.cross_sections import Level, trunk_levels
from core.messages import LineName, Message

_BEARING = np.radians(2.0)
"""How far apart, seen from the axis of the trunk, the points lie through which a back is drawn [rad]."""


@dataclass(frozen=True, eq=False)
class Back:
    """The back part of a band: its ``length`` along the skin [mm], and its ``path`` to be drawn.

    The path goes from the left end of the line round the back to the right one, shape (k, 3) [mm].
    """

    length: float
    path: Points


def back_of(calm: Mesh, control: ControlMesh, path_name: str) -> Back:
    """Find the way round the back from one end of a line to the other, along the skin.

    It lies level on the ``calm`` body at the mean height of both ends, without the arms; a hole of the scan
    is bridged straight. With the front part it makes the whole band. Raises FitError if there is no torso at
    that height.
    """
    path = control.paths[path_name]
    right, left = control.mesh.vertices[path[0]], control.mesh.vertices[path[-1]]
    level = trunk_levels(calm, [0.5 * (right[2] + left[2])])[0]
    if len(level.segments) == 0:
        raise FitError(
            Message(
                "The scan has no surface on the back at the height of the {line} line.",
                line=LineName(path_name),
            ),
            Message("Open a scan of a complete upper body."),
        )
    axis = 0.5 * (level.points.min(axis=0) + level.points.max(axis=0))[:2]
    ends = np.array([right[:2], left[:2]]) - axis
    # The ends take part as segments without length, so that a hole next to them is bridged too.
    segments = np.concatenate([level.segments[:, :, :2] - axis, np.repeat(ends[:, None], 2, axis=1)])
    start, end = _behind(ends).tolist()
    return Back(_length_between(segments, start, end), _path(level, axis, right, left))


def _path(level: Level, axis: Floats, right: Floats, left: Floats) -> Points:
    """Return a path round the outermost skin of a level behind two ends, each (3,), from left to right.

    Its height goes evenly from that of one end to that of the other.
    """
    points = level.points[:, :2] - axis
    bearing, reach = _behind(points), np.linalg.norm(points, axis=1)
    start, end = _behind(np.array([right[:2], left[:2]]) - axis).tolist()
    count = max(int((end - start) / _BEARING), 2)
    cell = np.floor((bearing - start) / (end - start) * count).astype(np.int64)
    inside = (cell >= 0) & (cell < count)
    far = np.zeros(count)
    np.maximum.at(far, cell[inside], reach[inside])
    middle = start + (np.arange(count) + 0.5) * (end - start) / count
    seen = far > 0.0
    skin = axis + far[seen, None] * np.stack([np.sin(middle[seen]), np.cos(middle[seen])], axis=1)
    part = (middle[seen] - start) / (end - start)
    path = np.column_stack([skin, right[2] + part * (left[2] - right[2])])
    return frozen(np.concatenate([left[None], path[::-1], right[None]]))


def _behind(places: Points) -> Floats:
    """Return the azimuth about the axis, 0 straight back, positive the subject's left, shape (...) [rad]."""
    return np.asarray(np.arctan2(places[..., 0], places[..., 1]))


def _length_between(segments: Points, start: float, end: float) -> float:
    """Return the length of the segments, shape (s, 2, 2) [mm], between two azimuths [rad], with gaps."""
    azimuth = _behind(segments)
    order = np.argsort(azimuth, axis=1)
    azimuth = np.take_along_axis(azimuth, order, axis=1)
    segments = np.take_along_axis(segments, order[:, :, None], axis=1)
    inside = (azimuth[:, 1] >= start) & (azimuth[:, 0] <= end) & (np.ptp(azimuth, axis=1) < np.pi)
    azimuth, segments = azimuth[inside], segments[inside]
    span = np.maximum(azimuth[:, 1] - azimuth[:, 0], 1e-12)
    share = (np.minimum(azimuth[:, 1], end) - np.maximum(azimuth[:, 0], start)) / span
    length = np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1)
    return float((length * np.clip(share, 0.0, 1.0)).sum()) + _gaps(azimuth, segments)


def _gaps(azimuth: Floats, segments: Points) -> float:
    """Return the summed width of the gaps between segments (s, 2, 2) [mm] with azimuths (s, 2) [rad]."""
    order = np.argsort(azimuth[:, 0])
    azimuth, segments = azimuth[order], segments[order]
    last = np.maximum.accumulate(azimuth[:, 1])
    reached = np.maximum.accumulate(np.where(azimuth[:, 1] == last, np.arange(len(last)), 0))
    gap = np.flatnonzero(azimuth[1:, 0] > last[:-1] + 1e-9)
    return float(np.linalg.norm(segments[gap + 1, 0] - segments[reached[gap], 1], axis=1).sum())
