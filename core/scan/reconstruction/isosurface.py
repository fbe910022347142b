"""The surface between inside and outside, on a grid that lies only near the points that tell it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.spatial import cKDTree

from core.geometry.mesh import Faces, Flags, Floats, Indices, Points

CELL, REACH = 0.9, 2.0
"""The side of the grid's cells, and how far the surface goes beyond a point, in parts of the spacing [1]."""

STEEPEST = 1.5
"""The height changes by no more than so many times the way along an edge [1], but between two skins."""

AROUND = 8
"""Neighbours that tell how dense the points lie."""

UNEVEN, SPARSEST = 1.7, 3.0
"""Where points lie so many times farther apart than elsewhere [1], they are sparse there; up to so many."""

BLOCK = 4096
"""How many places are worked on at a time, so that they stay in the cache."""


def extract_isosurface(spots: Points, normals: Points, spacing: float) -> tuple[Points, Faces]:
    """Return the surface through spots, shape (n, 3), that look along ``normals``: vertices and triangles.

    It is where the height over the spots' planes is zero: each cell of the grid that it passes through gets a
    vertex, each edge that it cuts a square of four of them. Any unit. Source: Gibson 1998, surface nets;
    heights after Hoppe et al. 1992.
    """
    tree = cKDTree(spots)
    own = nearest(tree, spots, AROUND + 1)[0][:, -1] * np.sqrt(np.pi / AROUND)
    reach = REACH * np.where(own < UNEVEN * spacing, spacing, np.minimum(own, SPARSEST * spacing))
    grid = _Grid.around(spots, reach, CELL * spacing)
    far, near = nearest(tree, grid.places, 1)
    grid = grid.at(far[:, 0] < reach[near[:, 0]])
    height = _heights(grid.places, spots, normals)
    cells, cuts, squares = [], [], []
    for axis in range(3):
        start, end = grid.edges(axis)
        cut = (height[start] < 0.0) != (height[end] < 0.0)
        cut &= np.abs(height[start] - height[end]) < STEEPEST * CELL * spacing
        start, end = start[cut], end[cut]
        share = height[start] / (height[start] - height[end])
        cuts += 4 * [grid.places[start] + share[:, None] * (grid.places[end] - grid.places[start])]
        one, other = (grid.strides[k % 3] for k in (axis + 1, axis + 2))
        key = grid.keys[start]
        square = np.stack([key, key - one, key - one - other, key - other], axis=1)
        squares.append(np.where((height[start] < 0.0)[:, None], square, square[:, ::-1]))
        cells += [square[:, k] for k in range(4)]
    key, points = np.concatenate(cells), np.concatenate(cuts)
    known = once(key)
    cell = np.searchsorted(known, key)
    share = sparse.csr_array((np.ones(len(points)), (cell, np.arange(len(points)))))
    count = share.sum(axis=1)
    corner = np.searchsorted(known, np.concatenate(squares))
    corner = corner[(count[corner] >= 3).all(axis=1)]  # a cell that is cut in fewer edges lies at the border
    used = once(corner.ravel())
    vertices = (share @ points)[used] / count[used, None]
    return vertices, _halves(vertices, np.searchsorted(used, corner))


def _halves(vertices: Points, squares: Indices) -> Faces:
    """Cut squares along their shorter diagonals."""
    a, b, c, d = (vertices[squares[:, k]] for k in range(4))
    other = np.linalg.norm(b - d, axis=1) < np.linalg.norm(a - c, axis=1)
    turned = np.where(other[:, None], np.roll(squares, -1, axis=1), squares)
    return np.concatenate([turned[:, [0, 1, 2]], turned[:, [0, 2, 3]]])


def _heights(places: Points, spots: Points, direction: Points) -> Floats:
    """Return how far places lie outside the planes of the spots around them, shape (n,).

    Spots that look another way than the nearest one, or lie over or under it, belong to another sheet of
    skin: they do not count.
    """
    tree, height = cKDTree(spots), np.empty(len(places))
    for k in range(0, len(places), BLOCK):
        some = places[k : k + BLOCK]
        reach, near = nearest(tree, some, 8)
        around = direction[near]
        weight = (1.0 - (reach / (1.001 * reach[:, -1:])) ** 2) ** 2
        weight *= np.maximum((around @ around[:, 0, :, None])[..., 0], 0.0)
        aside = spots[near] - spots[near[:, :1]]
        above = (aside @ around[:, 0, :, None])[..., 0]
        weight *= np.maximum(1.0 - 4.0 * above**2 / ((aside**2).sum(axis=2) + 1e-300), 0.0)
        above = (around * (some[:, None] - spots[near])).sum(axis=2)
        height[k : k + BLOCK] = (weight * above).sum(axis=1) / (weight.sum(axis=1) + 1e-300)
    return height


@dataclass(frozen=True, eq=False)
class _Grid:
    """The nodes of a cubic grid near a surface: one number each, in rising order, and their places."""

    keys: Indices
    places: Points
    strides: Indices

    @classmethod
    def around(cls, spots: Points, reach: Floats, cell: float) -> _Grid:
        """Lay a grid that holds all nodes nearer to each spot than its reach."""
        widths = np.ceil(reach / cell).astype(np.int64)
        low = spots.min(axis=0) - (widths.max() + 2) * cell
        index = np.floor((spots - low) / cell).astype(np.int64)
        size = index.max(axis=0) + widths.max() + 3
        strides = np.array([size[1] * size[2], size[2], 1])
        groups = []
        for width in np.unique(widths).tolist():
            keys = once(index[widths == width] @ strides)
            for stride in strides:
                keys = once((keys + stride * np.arange(-width, width + 2)[:, None]).ravel())
            groups.append(keys)
        keys = once(np.concatenate(groups))
        index = np.stack(np.unravel_index(keys, size), axis=1)
        return cls(keys, low + cell * index, strides)

    def at(self, nodes: Flags) -> _Grid:
        """Return some of the nodes."""
        return _Grid(self.keys[nodes], self.places[nodes], self.strides)

    def edges(self, axis: int) -> tuple[Indices, Indices]:
        """Return the nodes at both ends of each edge along an axis."""
        wanted = self.keys + self.strides[axis]
        end = np.minimum(np.searchsorted(self.keys, wanted), len(self.keys) - 1)
        known = self.keys[end] == wanted
        return np.flatnonzero(known), end[known]


def spacing_of(points: Points) -> float:
    """Return how far neighbours lie from each other: the side of the square that each point has to itself."""
    points = distinct(points)
    some = points[:: max(1, len(points) // 4000)]
    reach, _ = nearest(cKDTree(points), some, AROUND + 1)
    return float(np.median(reach[:, -1]) * np.sqrt(np.pi / AROUND))


def distinct(points: Points) -> Points:
    """Return each point once, shape (k, 3): a tree of many equal ones is searched one by one.

    Those that are told apart by no bit are equal.
    """
    key = np.zeros(len(points), dtype=np.uint64)
    for column in (points + 0.0).view(np.uint64).T:  # zero has one sign
        key = (key ^ column ^ (column >> np.uint64(32))) * np.uint64(0x9E3779B97F4A7C15)
        key ^= key >> np.uint64(29)
    order = np.argsort(key, kind="stable")
    again = np.diff(key[order]) == 0
    if not again.any():
        return points
    keep = np.ones(len(points), dtype=bool)
    keep[order[1:][again]] = False
    return points[keep]


def nearest(tree: cKDTree, places: Points, count: int) -> tuple[Floats, Indices]:
    """Return how far the nearest ``count`` points of a tree lie, and which they are, shapes (n, count)."""
    reach, near = tree.query(places, k=np.arange(1, min(count, tree.n) + 1), workers=-1)  # all cores
    return np.asarray(reach), np.asarray(near, dtype=np.int64)


def once(keys: Indices) -> Indices:
    """Return every number once, in rising order; np.unique takes much longer."""
    rising = np.sort(keys)
    return rising[np.diff(rising, prepend=-1) > 0]
