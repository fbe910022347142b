"""Many triangles at once, each cut into smaller ones at points of it and along given lines."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from core.errors import PatternError
from core.geometry.mesh import Faces, Flags, Floats, Indices
from core.messages import Message

_FLAT = 1e-11
"""Areas below this part of the triangle [1] are none."""


def greedy_triangles(shares: Floats, places: Floats, lines: Flags) -> tuple[Indices, Faces]:
    """Cut f triangles at n points each, three of which are the corners, so that ``lines`` are edges.

    ``shares`` (f, n, 3) are barycentric coordinates, those of points on an edge with an exact 0; ``places``
    (f, n, 3) [mm]; ``lines`` (f, n, n) is symmetric, its lines do not cross. The shortest edges that cross no
    other are taken. Return the triangle that each of the new ones belongs to, (m,), and its corners (m, 3) by
    their number in it, wound as the triangle is. Raises PatternError where the lines cross. Source: ours.
    """
    count = shares.shape[1]
    area = _areas(shares)
    i, j = np.triu_indices(count, 1)
    blocked = _passes_through(shares, area, i, j)
    crossing = _crossing(area, i, j)
    length = np.linalg.norm(places[:, i] - places[:, j], axis=2)
    order = np.argsort(np.where(lines[:, i, j], -1.0, length), axis=1, kind="stable")
    free, rows = ~blocked, np.arange(len(shares))
    taken = np.zeros_like(free)
    for pair in order.T:
        chosen = free[rows, pair]
        taken[rows, pair] |= chosen
        free &= ~(crossing[rows, pair] & chosen[:, None])
    edge = np.zeros(lines.shape, dtype=bool)
    edge[:, i, j] = edge[:, j, i] = taken
    if (lines & ~edge).any():
        raise PatternError(
            Message("Seams cross each other within a triangle of the skin in a way that cannot be cut."),
            Message("Move one of the seams a little."),
        )
    return _empty_triangles(area, edge)


def _areas(shares: Floats) -> Floats:
    """Return the signed area of each three points in parts of their triangle, (f, n, n, n) [1]."""
    x, y, z = (shares[:, :, None, axis] for axis in range(3))
    u, v, w = (shares[:, None, :, axis] for axis in range(3))
    across = np.stack([y * w - z * v, z * u - x * w, x * v - y * u], axis=3)
    area = across @ shares[:, None].transpose(0, 1, 3, 2)
    area[np.abs(area) < _FLAT] = 0.0
    return np.asarray(area)


def _passes_through(shares: Floats, area: Floats, i: Indices, j: Indices) -> Flags:
    """Return which pairs have another point between them, (f, p)."""
    to_i, to_j = (shares[:, None] - shares[:, at][:, :, None] for at in (i, j))
    between = np.einsum("fpkc,fpkc->fpk", to_i, to_j) < -_FLAT
    return np.asarray((between & (area[:, i, j] == 0.0)).any(axis=2))


def _crossing(area: Floats, i: Indices, j: Indices) -> Flags:
    """Return which pairs cross which, (f, p, p)."""
    split = area[:, i, j][:, :, i] * area[:, i, j][:, :, j] < 0.0
    return np.asarray(split & split.transpose(0, 2, 1))


def _empty_triangles(area: Floats, edge: Flags) -> tuple[Indices, Faces]:
    """Return the triangles whose sides are edges and that no other point is within."""
    corners = np.array(list(combinations(range(area.shape[1]), 3)))
    a, b, c = corners.T
    size = area[:, a, b, c]
    whole = edge[:, a, b] & edge[:, b, c] & edge[:, a, c] & (size != 0.0)
    turn = np.sign(size)[..., None]
    within = (area[:, a, b] * turn > 0.0) & (area[:, b, c] * turn > 0.0) & (area[:, c, a] * turn > 0.0)
    owner, which = np.nonzero(whole & ~within.any(axis=2))
    faces = corners[which]
    wound = size[owner, which] > 0.0
    faces = np.where(wound[:, None], faces, faces[:, ::-1])
    total = np.bincount(owner, np.abs(size[owner, which]), len(area))
    if (np.abs(total - 1.0) > 1e-6).any():
        raise PatternError(
            Message("A triangle of the skin cannot be cut along the seams."),
            Message("Move one of the seams a little."),
        )
    return owner, faces
