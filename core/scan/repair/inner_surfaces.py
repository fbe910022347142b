"""Inner surfaces of a skin: linings, layers scanned twice, legs that extend into the body."""

from __future__ import annotations

from functools import cache

import numpy as np
from scipy.spatial import cKDTree

from core.geometry.mesh import Flags, Floats, Indices, Points, unit
from core.messages import Message
from core.scan.repair.components import SAMPLES, largest, sample_component, size_of
from core.scan.repair.editable_mesh import EditableMesh, components, grouped

COVERED = 0.9
"""Share of a piece [1] that lies inside another, or on it, if it is no skin of its own."""

LAYER = 0.02
"""A second layer lies nearer than this to the skin, in parts of the body's size [1]."""

HIDING = 0.3
"""A piece of at least this share of the largest piece's area [1] hides what reaches into it."""

DEPTH = 0.02
"""Hidden is what lies deeper than this, in parts of the body's size [1]."""

CELL, FINE = 0.05, 0.01
"""Edge of the cells into which a skin is gathered to ask what lies inside and near it, in the same parts."""

BLOCK = 8
"""How many places are asked at a time: what is reckoned for them is to fit into the cache."""

BURIED = Message(
    "A large part of the scan was enclosed by another part and was removed. Check that the scan "
    "shows the skin and not clothing over it."
)
"""What is said if so much was inside that what is left may be no skin."""

DEEP, MUCH = 0.05, 0.2
"""It is said if a share of the scan greater than ``MUCH`` [1] is gone that lay farther than ``DEEP``, in the
same parts, from what is left: linings lie nearer, and legs that reach into a trunk are less."""


def remove_inner(skin: EditableMesh) -> tuple[EditableMesh, int]:
    """Drop pieces that lie inside another, or on it: linings and layers scanned twice. Wound outward."""
    areas = skin.piece_areas if len(skin.faces) else np.zeros(0)
    large = largest(areas)
    if len(large) < 2:
        return skin, 0
    size, inner = size_of(skin), np.zeros(len(areas), dtype=bool)
    faces = {int(number): np.flatnonzero(skin.piece == number) for number in large}
    tree_of = cache(lambda number: cKDTree(skin.centres[faces[number]]))
    cells_of = cache(lambda number: _gathered(skin, faces[number], CELL * size)[:2])
    for rank, number in enumerate(faces):
        places = sample_component(skin, faces[number], 100)
        for other_rank, other in enumerate(faces):
            # a lining may be a little larger than what it lines, a layer is the smaller one
            if other == number or inner[other] or areas[other] < 0.5 * areas[number]:
                continue
            low, high = (end(skin.centres[faces[other]], axis=0) for end in (np.min, np.max))
            if ((places > low - LAYER * size) & (places < high + LAYER * size)).all(axis=1).mean() <= COVERED:
                continue
            inner[number] |= other_rank < rank and _covered(
                skin, faces[other], tree_of(other), places, LAYER * size
            )
            inner[number] |= bool(np.mean(_winding(*cells_of(other), places, CELL * size) > 0.5) > COVERED)
    return skin.without_pieces(inner), int(inner.sum())


def remove_occluded(skin: EditableMesh) -> tuple[EditableMesh, int]:
    """Drop the triangles of pieces that lie inside a larger piece, where nobody could have scanned them.

    The skin is to be wound outward. Source: ours.
    """
    areas = skin.piece_areas if len(skin.faces) else np.zeros(0)
    large = largest(areas)
    if len(large) < 2:
        return skin, 0
    rank = np.full(len(areas), len(large))
    rank[large] = np.arange(len(large))
    rank, size, gone = rank[skin.piece], size_of(skin), np.zeros(len(skin.faces), dtype=bool)
    for k in np.flatnonzero(areas[large] >= HIDING * areas.max()):
        own = np.flatnonzero(rank == k)
        low, high = skin.centres[own].min(axis=0), skin.centres[own].max(axis=0)
        within = ((skin.centres > low) & (skin.centres < high)).all(axis=1)
        others = np.flatnonzero((rank > k) & (rank < len(large)) & within & ~gone)
        if len(others):
            gone |= _hidden(skin, own, others, size)
    return skin.with_faces(~gone), int(gone.sum())


def is_enclosed(before: EditableMesh, after: EditableMesh) -> bool:
    """Return whether much of the removed skin was deep inside the rest."""
    every, left = np.arange(len(before.faces)), np.arange(len(after.faces))
    skin = cKDTree(sample_component(after, left, 10 * SAMPLES))
    away = skin.query(sample_component(before, every))[0]
    return bool(np.mean(away > DEEP * size_of(before)) > MUCH)


def _hidden(skin: EditableMesh, own: Indices, others: Indices, size: float) -> Flags:
    """Return which triangles lie deep inside the skin of ``own``, or near it and cut off with what does."""
    near, deep = np.zeros((2, len(skin.faces)), dtype=bool)
    first, member = _celled(skin.centres[others], DEPTH * size)
    places = skin.centres[others[first]]
    middle, _, area = _gathered(skin, own, FINE * size)
    distance, at = cKDTree(middle).query(places)
    inside = distance > DEPTH * size + np.sqrt(area[at])
    near[others] = ~inside[member]
    # so far from the skin, no coarse cell has places on both sides of it
    first, cell = _celled(places[inside], CELL * size)
    middle, dipole, _ = _gathered(skin, own, CELL * size)
    inside[inside] = (_winding(middle, dipole, places[inside][first], CELL * size) > 0.5)[cell]
    deep[others] = inside[member]
    reached = np.zeros(len(skin.piece_areas), dtype=bool)
    reached[skin.piece[deep]] = True
    one, other, _ = skin.sides.neighbours
    whole = ~deep[one] & ~deep[other]
    part = components(one[whole], other[whole], len(skin.faces))
    seen = np.bincount(part, ~near & ~deep) > 0.0
    return np.asarray(deep | (reached[skin.piece] & ~seen[part]))


def _covered(skin: EditableMesh, faces: Indices, tree: cKDTree, places: Points, near: float) -> bool:
    """Tell whether nearly all ``places`` lie nearer than ``near`` to ``faces``, in a ``tree`` of centres."""
    distance, at = tree.query(places)
    away = places - skin.centres[faces[at]]
    height = np.abs(np.einsum("ij,ij->i", away, unit(skin.area_vectors[faces[at]])))
    beside = np.sqrt(np.maximum(distance**2 - height**2, 0.0))
    reach = near + 2.0 * np.sqrt(skin.areas[faces[at]])
    return bool(((height < near) & (beside < reach)).mean() > COVERED)


def _celled(places: Points, edge: float) -> tuple[Indices, Indices]:
    """Return one of ``places``, shape (k, 3), for each cell that holds some, and the cell of each place."""
    cell = np.floor((places - places.min(axis=0, initial=np.inf)) / edge).astype(np.int64)
    order, start = grouped((cell[:, 0] << 40) | (cell[:, 1] << 20) | cell[:, 2])
    member = np.empty(len(places), dtype=np.int64)
    member[order] = np.repeat(np.arange(len(start)), np.diff(start, append=len(places)))
    return order[start], member


def _gathered(skin: EditableMesh, own: Indices, edge: float) -> tuple[Points, Points, Floats]:
    """Return the middles of the cells of a skin, their area vectors and areas."""
    cell, area = _celled(skin.centres[own], edge)[1], skin.areas[own]

    def summed(ways: Points) -> Points:
        return np.stack([np.bincount(cell, ways[:, k]) for k in range(3)], axis=1)

    total = np.maximum(np.bincount(cell, area), 1e-300)
    middle = summed(area[:, None] * skin.centres[own]) / total[:, None]
    return middle, summed(skin.area_vectors[own]), total


def _winding(middle: Points, dipole: Points, places: Points, least: float) -> Floats:
    """Return how often a skin goes round each place, shape (k,) [1].

    The skin is taken as dipoles, none nearer than ``least``. Source: after Barill et al. 2018.
    """
    result, flux = np.zeros(len(places)), np.einsum("ci,ci->c", middle, dipole)
    square = np.einsum("ci,ci->c", middle, middle)
    for k in range(0, len(places), BLOCK):
        some = places[k : k + BLOCK]
        apart = square + np.einsum("ki,ki->k", some, some)[:, None] - 2.0 * some @ middle.T
        apart = np.maximum(apart, least * least)
        result[k : k + BLOCK] = ((flux - some @ dipole.T) / (apart * np.sqrt(apart))).sum(axis=1)
    return result / (4.0 * np.pi)
