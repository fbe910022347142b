"""The front of a trunk rolled out flat: how far round it, how high and how far out a place lies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.geometry.mesh import Faces, Flags, Floats, Points


@dataclass(frozen=True, eq=False)
class UnrolledTorso:
    """Rolls out places about an upright axis at ``centre``, shape (2,) [mm].

    u [mm] is the way round the axis at the distance ``radius`` [mm], 0 in front and growing towards the left,
    v [mm] the height, w [mm] the distance from the axis.
    """

    centre: Points
    radius: float

    def unroll(self, places: Points) -> Points:
        """Return u, v, w of ``places``, shape (k, 3) [mm]."""
        x, y = (places[:, :2] - self.centre).T
        return np.stack([self.radius * np.arctan2(x, -y), places[:, 2], np.hypot(x, y)], axis=1)

    def roll_up(self, uvw: Points) -> Points:
        """Return the places with u, v, w as in ``uvw``, shape (k, 3) [mm]."""
        u, v, w = uvw.T
        angle = u / self.radius
        return np.stack([self.centre[0] + w * np.sin(angle), self.centre[1] - w * np.cos(angle), v], axis=1)

    def outward(self, places: Points) -> Points:
        """Return the level unit vectors away from the axis at ``places``, shape (k, 3) [1]."""
        way = np.column_stack([places[:, :2] - self.centre, np.zeros(len(places))])
        return np.asarray(way / np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-9))


def innermost(uvw: Points, faces: Faces, uv: Points) -> Floats:
    """Return how far out skin lies first over each place of a chart, shape (k,) [mm]; NaN where none does.

    ``uvw`` (n, 3) [mm] are the vertices of ``faces`` (m, 3), ``uv`` the places, shape (k, 2) [mm].
    """
    corners = uvw[faces]
    low, high = corners[:, :, :2].min(axis=1), corners[:, :, :2].max(axis=1)
    far = np.full(len(uv), np.nan)
    for row, place in enumerate(uv):
        near = corners[((low <= place) & (place <= high)).all(axis=1)]
        within, height = _over(near, place)
        far[row] = height[within].min() if within.any() else np.nan
    return far


def _over(corners: Points, place: Points) -> tuple[Flags, Floats]:
    """Tell which triangles, shape (m, 3, 3), lie over a place of the chart, and how far out there."""
    a, b, way = (corners[:, 1] - corners[:, 0]), (corners[:, 2] - corners[:, 0]), place - corners[:, 0, :2]
    area = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    safe = np.where(np.abs(area) > 1e-12, area, np.inf)
    s = (way[:, 0] * b[:, 1] - way[:, 1] * b[:, 0]) / safe
    t = (a[:, 0] * way[:, 1] - a[:, 1] * way[:, 0]) / safe
    within = (s >= -1e-9) & (t >= -1e-9) & (s + t <= 1.0 + 1e-9) & np.isfinite(safe)
    return within, corners[:, 0, 2] + s * a[:, 2] + t * b[:, 2]
