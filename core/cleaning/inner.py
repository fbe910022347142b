"""What of one piece of a skin is hidden inside another, as where legs or a stand reach into the trunk."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from core.cleaning.pieces import size_of
from core.cleaning.skin import Skin, components, grouped
from core.mesh import Flags, Floats, Indices, Points

HIDING = 0.3
"""A piece of at least this share of the largest piece's area [1] hides what reaches into it."""

DEPTH = 0.02
"""Hidden is what lies deeper than this, in parts of the body's size [1]."""

CELL = 0.015
"""Edge of the cells into which a skin is gathered to ask what lies inside it, in the same parts [1]."""

LOOKED_AT = 40
"""Only the largest pieces are looked at."""

BLOCK = 64
"""How many places are asked at a time."""


def drop_hidden(skin: Skin) -> tuple[Skin, int]:
    """Drop the triangles of pieces that lie inside a larger piece, where nobody could have scanned them.

    The skin is to be wound outward. Source: ours.
    """
    areas = skin.piece_areas if len(skin.faces) else np.zeros(0)
    if len(areas) < 2:
        return skin, 0
    order = np.argsort(-areas, kind="stable")[:LOOKED_AT]
    rank = np.full(len(areas), LOOKED_AT)
    rank[order] = np.arange(len(order))
    rank, size, gone = rank[skin.piece], size_of(skin), np.zeros(len(skin.faces), dtype=bool)
    for k in np.flatnonzero(areas[order] >= HIDING * areas.max()):
        own = np.flatnonzero(rank == k)
        low, high = skin.centres[own].min(axis=0), skin.centres[own].max(axis=0)
        within = ((skin.centres > low) & (skin.centres < high)).all(axis=1)
        others = np.flatnonzero((rank > k) & (rank < LOOKED_AT) & within & ~gone)
        if len(others):
            gone |= _hidden(skin, own, others, size)
    return (skin.with_faces(~gone), int(gone.sum())) if gone.any() else (skin, 0)


def _hidden(skin: Skin, own: Indices, others: Indices, size: float) -> Flags:
    """Tell which triangles lie deep inside the skin of ``own``, or near it and cut off with what does."""
    near, deep = np.zeros((2, len(skin.faces)), dtype=bool)
    cell = np.floor(skin.centres[others] / (DEPTH * size)).astype(np.int64)
    _, first, member = np.unique(cell, axis=0, return_index=True, return_inverse=True)
    places = skin.centres[others[first]]
    middle, dipole, area = _gathered(skin, own, CELL * size)
    distance, at = cKDTree(middle).query(places)
    touching = distance < DEPTH * size + np.sqrt(area[at])
    inside = ~touching
    inside[inside] = _winding(middle, dipole, places[inside]) > 0.5
    near[others], deep[others] = touching[member.ravel()], inside[member.ravel()]
    reached = np.zeros(len(skin.piece_areas), dtype=bool)
    reached[skin.piece[deep]] = True
    one, other, _ = skin.sides.neighbours
    whole = ~deep[one] & ~deep[other]
    part = components(one[whole], other[whole], len(skin.faces))
    seen = np.bincount(part, ~near & ~deep) > 0.0
    return np.asarray(deep | (reached[skin.piece] & ~seen[part]))


def _gathered(skin: Skin, own: Indices, edge: float) -> tuple[Points, Points, Floats]:
    """Return the middles of the cells of a skin, their area vectors and areas."""
    centres = skin.centres[own]
    cell = np.floor((centres - centres.min(axis=0)) / edge).astype(np.int64)
    order, start = grouped((cell[:, 0] << 40) | (cell[:, 1] << 20) | cell[:, 2])
    area = skin.areas[own][order]
    total = np.maximum(np.add.reduceat(area, start), 1e-300)
    middle = np.add.reduceat(area[:, None] * centres[order], start, axis=0) / total[:, None]
    return middle, np.add.reduceat(skin.area_vectors[own][order], start, axis=0), total


def _winding(middle: Points, dipole: Points, places: Points) -> Floats:
    """Return how often a skin goes round each place, shape (k,) [1]. Source: after Barill et al. 2018."""
    result, flux = np.zeros(len(places)), np.einsum("ci,ci->c", middle, dipole)
    square = np.einsum("ci,ci->c", middle, middle)
    for k in range(0, len(places), BLOCK):
        some = places[k : k + BLOCK]
        apart = square + np.einsum("ki,ki->k", some, some)[:, None] - 2.0 * some @ middle.T
        result[k : k + BLOCK] = ((flux - some @ dipole.T) / np.maximum(apart, 1e-300) ** 1.5).sum(axis=1)
    return result / (4.0 * np.pi)
