"""Control points where the scan has no skin: filled after their neighbours and the other side of the body."""

from __future__ import annotations

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from core.geometry.mesh import Flags, Floats, Points
from core.geometry.mirror_plane import mirror

ALONG_ROWS = 0.3
"""Rows bend round the body, columns hardly do: how a row goes on counts so much against a column [1]."""


def interpolate_missing(points: Points, middle: float) -> Points:
    """Fill all NaN in points of shape (rows, columns, 3) [mm]; ``middle`` [mm] is x of the axis of the torso.

    Up to two columns side by side lie straight between their neighbours; wider holes take the shape of the
    other side, moved to fit what is round the hole; what neither side has goes on as it bends. Source: ours.
    """
    filled = interpolate_in_row(points)
    mirrored = mirror(filled[:, ::-1], middle)
    both = ~np.isnan(filled[..., 0]) & ~np.isnan(mirrored[..., 0])
    lent = np.isnan(filled[..., 0]) & ~np.isnan(mirrored[..., 0])
    if lent.any():
        apart = np.where(both[..., None], filled - mirrored, 0.0)
        apart = _solved(apart, lent, both | lent, order=1)
        filled = np.where(lent[..., None], mirrored + apart, filled)
    missing = np.isnan(filled[..., 0])
    if missing.any():
        filled = _solved(np.where(missing[..., None], 0.0, filled), missing, np.ones_like(missing), order=2)
    return filled


def interpolate_in_row(points: Points) -> Points:
    """Fill places without skin straight from their neighbours in the row, shape (rows, columns, 3) [mm].

    NaN stays in the outermost columns, and where more than two columns side by side are missing.
    """
    filled = points.copy()
    for row in filled:
        missing = np.isnan(row[:, 0])
        known = np.flatnonzero(~missing)
        for place in np.flatnonzero(missing):
            after = int(np.searchsorted(known, place))
            if 0 < after < len(known) and known[after] - known[after - 1] <= 3:
                low, high = known[after - 1], known[after]
                row[place] = row[low] + (row[high] - row[low]) * (place - low) / (high - low)
    return filled


def _solved(values: Points, unknown: Flags, usable: Flags, order: int) -> Points:
    """Return ``values`` with those ``unknown`` chosen so that differences of an ``order`` are small."""
    weights = {1: (-1.0, 1.0), 2: (1.0, -2.0, 1.0)}[order]
    number = np.arange(unknown.size).reshape(unknown.shape)
    chain = np.concatenate(
        [sliding_window_view(lines, order + 1, axis=1).reshape(-1, order + 1) for lines in (number, number.T)]
    )
    chain = chain[usable.ravel()[chain].all(axis=1) & unknown.ravel()[chain].any(axis=1)]
    matrix: Floats = np.zeros((len(chain), unknown.size))
    trust = np.where(chain[:, 1] - chain[:, 0] == 1, ALONG_ROWS, 1.0)
    for k, weight in enumerate(weights):
        matrix[np.arange(len(chain)), chain[:, k]] += weight * trust
    flat, free = values.reshape(-1, 3).copy(), unknown.ravel()
    flat[free] = np.linalg.lstsq(matrix[:, free], -matrix[:, ~free] @ flat[~free], rcond=None)[0]
    return flat.reshape(values.shape)
