"""The chest behind a breast: the smooth surface that goes on where the skin round its root ends."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import RBFInterpolator
from scipy.spatial import cKDTree

from core.mesh import Floats, Points

COLLAR = 22.0
"""The wall is laid through the skin up to so far round the root [mm]."""

CELL = 4.0
"""The skin of the collar is averaged over cells of this size [mm]."""

STIFF = 20.0
"""How little the wall follows the unevenness of the skin: the smoothing of the spline [1]."""


FEWEST = 24
"""A wall needs so many places of skin round the root."""


@dataclass(frozen=True, eq=False)
class Wall:
    """How far out the chest lies behind a breast, in its chart."""

    spline: RBFInterpolator

    def out(self, uv: Points) -> Floats:
        """Return how far out it lies at places of the chart, shape (k, 2) [mm]; (k,) [mm]."""
        return np.asarray(1.0 / self.spline(uv)[:, 0])


def wall_of(chest: Points, loop: Points) -> Wall | None:
    """Lay the wall through the skin just outside a root; None if there is too little of it.

    ``chest`` (n, 3) [mm] are the vertices outside the breast and ``loop`` (k, 3) [mm] the root, in the chart.
    A thin plate bends least between: with the slope of the chest all round it arches as a chest does, where
    a flat fan would cut through the ribs. Source: ours.
    """
    away = np.asarray(cKDTree(loop[:, :2]).query(chest[:, :2], distance_upper_bound=COLLAR)[0])
    places = _thinned(chest[away < COLLAR])
    if len(places) < FEWEST:
        return None
    every = np.concatenate([places, loop[::2]])
    return Wall(RBFInterpolator(every[:, :2], 1.0 / every[:, 2:], smoothing=STIFF))


def _thinned(places: Points) -> Points:
    """Return the mean of the places in each cell of the chart, mirrored alike on both sides."""
    column = np.copysign(np.floor(np.abs(places[:, 0]) / CELL) + 1.0, places[:, 0])
    cells = np.column_stack([column, np.floor(places[:, 1] / CELL)])
    _, cell, count = np.unique(cells, axis=0, return_inverse=True, return_counts=True)
    return np.stack([np.bincount(cell, places[:, k]) / count for k in range(3)], axis=1)
