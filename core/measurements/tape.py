"""Closed rings of a level of the trunk: as a tape lies round it, as the skin runs, and what they enclose."""

from __future__ import annotations

import numpy as np

from core.geometry.mesh import Points
from core.geometry.plane_sections import Section, hull_corners, ordered_rows
from core.landmarks.torso.cross_sections import Level

ROUNDED = 4
"""Ends of segments that agree to so many decimals [mm] are one place."""


def tape_ring(level: Level) -> Points:
    """Return where a tape lies round a level, bridging hollows: a closed curve, shape (k, 3) [mm]."""
    corners = level.points[hull_corners(level.points[:, :2])]
    return np.concatenate([corners, corners[:1]])


def skin_ring(level: Level) -> Points:
    """Return the outline of a level as one closed curve, shape (k, 3) [mm]; over gaps it goes straight."""
    segments = np.concatenate([level.segments, level.bridges])
    if len(segments) == 0:
        return np.empty((0, 3))
    rounded = np.round(segments.reshape(-1, 3), ROUNDED)
    ids = np.unique(rounded, axis=0, return_inverse=True)[1].reshape(len(segments), 2)
    whole = ids[:, 0] != ids[:, 1]
    section = Section(segments[whole], ids[whole])
    pieces = [section.points[rows] for rows in ordered_rows(section)]
    if not pieces:
        return np.empty((0, 3))
    ends = np.array([[piece[0], piece[-1]] for piece in pieces])
    free, parts = np.ones((len(pieces), 1), dtype=bool), pieces[:1]
    free[0] = False
    for _ in pieces[1:]:
        # The piece whose end lies nearest to where the ring has come to goes on from there.
        away = np.where(free, np.linalg.norm(ends - parts[-1][-1], axis=2), np.inf)
        piece, turned = divmod(int(np.argmin(away)), 2)
        parts.append(pieces[piece][::-1] if turned else pieces[piece])
        free[piece] = False
    ring = np.concatenate(parts)
    return ring if np.array_equal(ring[0], ring[-1]) else np.concatenate([ring, ring[:1]])


def enclosed(ring: Points) -> float:
    """Return the area inside a closed level curve, shape (k, 3) [mm], in mm^2."""
    if len(ring) < 3:
        return 0.0
    x, y = (ring[:, :2] - ring[0, :2]).T
    return 0.5 * abs(float((x[:-1] * y[1:] - x[1:] * y[:-1]).sum()))
