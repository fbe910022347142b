"""Straps: on from the upper end of a line over the shoulder and down the back to where it is sewn (ours).

There the body is fixed. The way is the shortest over the skin from the upper end to the top of the shoulder
straight above it, and on to the under-bust band at the back.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.errors import LineError
from core.geometry.geodesic import shortest_path
from core.geometry.mesh import Mesh, Points, frozen
from core.geometry.plane_sections import arc_length, cut, join_segments, resample
from core.messages import EMPTY, Message

NO_TAIL = np.empty((0, 3))

BAND = "under-bust"
"""The line whose back a strap is sewn to."""

_STEP = 8.0  # distance between the places of a tail [mm]
_LEAST = 25.0  # a shoulder rises at least this far above the upper end of a strap [mm]
_TOP, _FLAT = 3.0, 60.0  # skin level within the first for longer than the second is where the scan ends [mm]


@dataclass(frozen=True, eq=False)
class Tail:
    """The part of a strap on the fixed body: its ``length`` along the skin [mm] and its ``path`` (k, 3) [mm].

    The path goes from the upper end of the line over the shoulder to the band at the back; ``top`` [mm] is
    where on it the shoulder is. Without a shoulder it is empty, and ``problem`` tells why.
    """

    length: float
    path: Points
    top: float = 0.0
    problem: Message = EMPTY


def strap_tail(skin: Mesh, end: Points, band: Points) -> Tail:
    """Return the tail of a strap from its upper ``end`` (3,) to a ``band`` (k, 3) round the back, both [mm].

    On a scan without a shoulder the tail has no length.
    """
    try:
        top = shoulder_above(skin, end)
        sewn = band[np.argmin(np.abs(band[:, 0] - top[0]) + 1e6 * (band[:, 1] < end[1]))]
        ways = [shortest_path(skin, end, top), shortest_path(skin, top, sewn)]
    except LineError as problem:
        return Tail(0.0, NO_TAIL, problem=problem.message)
    lengths = [float(arc_length(way)[-1]) for way in ways]
    path = np.concatenate([resample(ways[0], _STEP), resample(ways[1], _STEP)[1:]])
    return Tail(sum(lengths), frozen(path), lengths[0])


def shoulder_above(skin: Mesh, end: Points) -> Points:
    """Return the top of the shoulder, (3,) [mm], in the plane from front to back through ``end`` (3,) [mm].

    Raises LineError if the scan ends below it.
    """
    over, closed = _outline(skin, end)
    peak = int(over[:, 2].argmax())
    top = over[peak]
    level, along = over[over[:, 2] > top[2] - _TOP], arc_length(over)
    open_there = not closed and min(along[peak], along[-1] - along[peak]) < _TOP
    if open_there or top[2] - end[2] < _LEAST or np.ptp(level[:, 1]) > _FLAT:
        raise LineError(
            Message("The scan ends below the shoulder."),
            Message("The strap ends on the upper chest: measure the remaining length by tape and add it."),
        )
    return np.asarray(top)


def _outline(skin: Mesh, end: Points) -> tuple[Points, bool]:
    """Return the curve in which a plane from front to back cuts the skin at ``end``, and if it is closed."""
    curves = join_segments(cut(skin, end, (1.0, 0.0, 0.0)))
    if not curves:
        raise LineError(
            Message("The scan has no surface at the upper end of the strap."), Message("Draw the line again.")
        )
    return min(curves, key=lambda curve: float(np.linalg.norm(curve[0] - end, axis=1).min()))
