"""Classification of contours: trunk, arms, hands and legs."""

from __future__ import annotations

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from core.geometry.level_outlines import Outlines, Pieces
from core.geometry.mesh import Flags, Floats, Indices

GAP = 25.0
"""An open piece of outline nearer than this to the trunk, along x [mm], belongs to it."""

LIP = 110.0
"""The lower lip of an overhanging breast is less high than this [mm], an arm in front is higher."""

BROAD = 220.0
"""What hangs in front of the body and is longer than this [mm] in its level is an arm."""

MOST_LIMBS = 200
"""Closed pieces of a level beside the trunk that may be limbs, the largest ones; a body has fewer than 10."""


def limbs(pieces: Pieces, main: Indices, z: Floats, middle: float) -> Flags:
    """Return which closed ``pieces`` belong to an arm, a hand or a leg, not to an overhanging breast.

    ``main``, shape (k,), is the piece of the trunk on each level at heights ``z`` [mm], -1 where there is
    none. Pieces that lie over one another are one limb if one of them lies beside or behind the trunk,
    crosses the middle or is long, or if they are many. Source: ours.
    """
    body = main[pieces.level]
    free = pieces.closed & (body != np.arange(len(body)))
    member = np.flatnonzero(free)
    centre, box = pieces.centre, (pieces.low, pieces.high)
    odd = free & ((body < 0) | pieces_beside(pieces, body, middle))
    odd |= free & (np.linalg.norm(pieces.high - pieces.low, axis=1) > BROAD)
    pairs = []
    order = member[np.lexsort((-pieces.size[member], pieces.level[member]))]
    first = np.searchsorted(pieces.level[order], pieces.level[order])
    order = order[np.arange(len(order)) - first < MOST_LIMBS]
    start = np.searchsorted(pieces.level[order], np.arange(len(z) + 1))
    for k in range(len(z) - 1):
        low, high = order[start[k] : start[k + 1]], order[start[k + 1] : start[min(k + 2, len(z))]]
        if not len(low) or not len(high):
            continue
        a, b = np.repeat(low, len(high)), np.tile(high, len(low))
        over = ((box[0][b] <= centre[a]) & (centre[a] <= box[1][b])).all(axis=1)
        over |= ((box[0][a] <= centre[b]) & (centre[b] <= box[1][a])).all(axis=1)
        pairs.append(np.stack([a[over], b[over]]))
    ends = np.concatenate(pairs, axis=1) if pairs else np.empty((2, 0), dtype=np.int64)
    count = len(body)
    graph = sparse.coo_array((np.ones(ends.shape[1]), (ends[0], ends[1])), shape=(count, count))
    total, label = connected_components(graph, directed=False)
    bottom, top = np.full(total, np.inf), np.full(total, -np.inf)
    np.minimum.at(bottom, label, z[pieces.level])
    np.maximum.at(top, label, z[pieces.level])
    bad = (top - bottom > LIP) | (np.bincount(label, weights=odd, minlength=total) > 0)
    return np.asarray(free & bad[label])


def pieces_beside(pieces: Pieces, body: Indices, middle: float) -> Flags:
    """Tell which pieces lie beside or behind the trunk piece ``body`` of their level, or cross the middle."""
    x, y = pieces.centre.T
    own = pieces.centre[body, 1]
    across = (pieces.low[:, 0] <= middle) & (middle <= pieces.high[:, 0])
    return np.asarray((x < pieces.low[body, 0]) | (x > pieces.high[body, 0]) | (y > own) | across)


def middle_of(cuts: Outlines) -> float:
    """Return x of the middle of the body: the median middle of the widest piece of each level [mm]."""
    pieces = cuts.pieces
    if len(pieces.level) == 0:
        return 0.0
    order = np.lexsort((pieces.high[:, 0] - pieces.low[:, 0], pieces.level))
    widest = order[np.append(np.diff(pieces.level[order]) > 0, True)]
    return float(np.median(pieces.centre[widest, 0]))


def main_pieces(cuts: Outlines, middle: float) -> Indices:
    """Return the piece that is the trunk on each level: the largest across the middle; -1 for none."""
    pieces = cuts.pieces
    main = np.full(len(cuts.z), -1)
    over = np.flatnonzero((pieces.low[:, 0] <= middle) & (middle <= pieces.high[:, 0]))
    order = over[np.argsort(pieces.size[over], kind="stable")]
    main[pieces.level[order]] = order
    return main


def split_pieces(cuts: Outlines, main: Indices, sides: Floats) -> Indices:
    """Return ``main`` with the largest open piece of the trunk where holes leave none across the middle."""
    pieces = cuts.pieces
    low, high = sides[pieces.level].T
    part = (
        ~pieces.closed & (main[pieces.level] < 0) & (low < pieces.centre[:, 0]) & (pieces.centre[:, 0] < high)
    )
    part &= pieces.high[:, 1] - pieces.low[:, 1] > 60.0
    order = np.flatnonzero(part)[np.argsort(pieces.size[part], kind="stable")]
    result = main.copy()
    result[pieces.level[order]] = order
    return result


def kept_pieces(cuts: Outlines, main: Indices, limb: Flags, sides: Floats) -> tuple[Flags, Flags]:
    """Return which pieces are trunk, and on which levels its outline is open.

    ``sides``, shape (k, 2) [mm], tell where the trunk ends on levels near by; NaN where that is unknown.
    """
    pieces = cuts.pieces
    kept = np.zeros(len(pieces.level), dtype=bool)
    open_ = np.zeros(len(main), dtype=bool)
    for k, rows in enumerate(cuts.piece_rows()):
        if main[k] < 0:
            continue
        kept[main[k]] = True
        inner = ~limb[rows] & pieces.closed[rows]
        low, high = pieces.low[main[k], 0], pieces.high[main[k], 0]
        if not pieces.closed[main[k]]:
            open_[k] = True
            loose = rows[~pieces.closed[rows]]
            low, high = np.fmin(low, sides[k, 0]), np.fmax(high, sides[k, 1])
            more = loose[_linked(pieces.low[loose, 0], pieces.high[loose, 0], low, high)]
            low, high = pieces.low[more, 0].min(initial=low), pieces.high[more, 0].max(initial=high)
            kept[more] = True
        centre = pieces.centre[rows, 0]
        kept[rows[inner & (low <= centre) & (centre <= high)]] = True
    return kept, open_


def _linked(lows: Floats, highs: Floats, low: float, high: float) -> Flags:
    """Return which ranges, from ``lows`` to ``highs`` (p,), are linked to one by gaps of at most ``GAP``."""
    begin, end = np.append(lows, low), np.append(highs, high)
    order = np.argsort(begin, kind="stable")
    apart = begin[order][1:] > np.maximum.accumulate(end[order])[:-1] + GAP
    group = np.empty(len(order), dtype=np.int64)
    group[order] = np.concatenate([[0], np.cumsum(apart)])
    return np.asarray(group[:-1] == group[-1])
