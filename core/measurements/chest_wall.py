"""The chest behind a breast: the smooth surface that goes on where the skin round its root ends."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree

from core.geometry.mesh import Faces, Flags, Floats, Points

if TYPE_CHECKING:
    from scipy.interpolate import RBFInterpolator


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
    """Return which triangles, shape (m, 3, 3), lie over a place of the chart, and how far out there."""
    a, b, way = (corners[:, 1] - corners[:, 0]), (corners[:, 2] - corners[:, 0]), place - corners[:, 0, :2]
    area = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    safe = np.where(np.abs(area) > 1e-12, area, np.inf)
    s = (way[:, 0] * b[:, 1] - way[:, 1] * b[:, 0]) / safe
    t = (a[:, 0] * way[:, 1] - a[:, 1] * way[:, 0]) / safe
    within = (s >= -1e-9) & (t >= -1e-9) & (s + t <= 1.0 + 1e-9) & np.isfinite(safe)
    return within, corners[:, 0, 2] + s * a[:, 2] + t * b[:, 2]


COLLAR = 22.0
"""The wall is laid through the skin up to so far round the root [mm]."""

CELL = 4.0
"""The skin of the collar is averaged over cells of this size [mm]."""

STIFF = 20.0
"""How little the wall follows the unevenness of the skin: the smoothing of the spline [1]."""


FARTHEST = 1000.0
"""No chest lies so far from its axis [mm]."""

FEWEST = 24
"""A wall needs so many places of skin round the root."""


@dataclass(frozen=True, eq=False)
class ChestWall:
    """How far out the chest lies behind a breast, in its chart: an oval trunk, and what it differs from that.

    1 / w^2 of an oval, a round or a flat trunk is one wave of twice the angle: ``wave`` (4,), with the
    height. ``spline`` is the rest [mm].
    """

    radius: float
    wave: Floats
    spline: RBFInterpolator

    def out(self, uv: Points) -> Floats:
        """Return how far from the axis it lies over places of the chart, shape (k, 2) [mm]; (k,) [mm]."""
        return np.asarray(_oval(uv, self.radius, self.wave) + self.spline(uv)[:, 0])


def fit_chest_wall(chart: UnrolledTorso, chest: Points, loop: Points) -> ChestWall | None:
    """Fit the wall to the skin just outside a root; None if there is too little of it.

    ``chest`` (n, 3) [mm] are the vertices outside the breast and ``loop`` (k, 3) [mm] the root, in the chart.
    What an oval trunk does not fit a thin plate does, which bends least: with the slope of the chest all
    round it arches as a chest does, where a flat fan would cut through the ribs. Source: ours.
    """
    away = np.asarray(cKDTree(loop[:, :2]).query(chest[:, :2], distance_upper_bound=COLLAR)[0])
    from scipy.interpolate import RBFInterpolator  # noqa: PLC0415 (a fifth of a second that no start needs)

    places = _thinned(chest[away < COLLAR])
    if len(places) < FEWEST:
        return None
    uv, out = np.split(np.concatenate([places, loop[::2]]), [2], axis=1)
    wave = np.asarray(np.linalg.lstsq(_waves(uv, chart.radius), out[:, 0] ** -2.0, rcond=None)[0], np.float64)
    rest = out - _oval(uv, chart.radius, wave)[:, None]
    return ChestWall(chart.radius, wave, RBFInterpolator(uv, rest, smoothing=STIFF))


def _waves(uv: Points, radius: float) -> Floats:
    turn = 2.0 * uv[:, 0] / radius
    return np.stack([np.ones(len(uv)), np.cos(turn), np.sin(turn), uv[:, 1] / radius], axis=1)


def _oval(uv: Points, radius: float, wave: Floats) -> Floats:
    return np.asarray(np.maximum(_waves(uv, radius) @ wave, FARTHEST**-2.0) ** -0.5)


def _thinned(places: Points) -> Points:
    """Return the mean of the places in each cell of the chart, mirrored alike on both sides."""
    column = np.copysign(np.floor(np.abs(places[:, 0]) / CELL) + 1.0, places[:, 0])
    cells = np.column_stack([column, np.floor(places[:, 1] / CELL)])
    _, cell, count = np.unique(cells, axis=0, return_inverse=True, return_counts=True)
    return np.stack([np.bincount(cell, places[:, k]) / count for k in range(3)], axis=1)
