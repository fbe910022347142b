"""A skin through a cloud of points that has no triangles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import breadth_first_order, connected_components, minimum_spanning_tree
from scipy.spatial import cKDTree

from core.mesh import Faces, Flags, Floats, Indices, Points, unit
from core.progress import Progress, quiet
from core.raw_scan import RawScan

FEWEST_POINTS = 2000
"""With fewer points no breast could be made out."""

FARTHEST = 1e9
"""A coordinate beyond this [file units] is a mistake."""

WORK_POINTS = 80_000
"""A denser cloud is thinned to about so many points, each the mean of a cell."""

NEIGHBOURS = 24
"""Points that a smooth patch is laid through."""

REACH, CELL = 2.2, 0.9
BLOCK = 4096
"""Cells of the grid in which the distance to the skin is written."""


def surface_of(
    points: Points, normals: Points | None = None, progress: Progress = quiet
) -> tuple[Points, Faces]:
    """Lay a surface through points, shape (n, 3), of any unit: vertices (k, 3) and faces (m, 3).

    ``normals``, shape (n, 3), tell the outside where they are known. Noise is evened out and loners are
    dropped; where there are no points there is no surface. Source: ours; patches after Levin 1998, signs
    after Hoppe et al. 1992, the grid after Curless and Levoy 1996.
    """
    progress("rebuilding the surface", 0.0)
    placed = _placed(points)
    spots, outside, spacing = _even(points[placed], None if normals is None else normals[placed])
    spots, outside = _without_loners(spots, outside)
    progress("rebuilding the surface", 0.1)
    direction = np.zeros_like(spots)
    for share in (0.3, 0.5):
        spots, direction = _on_patches(spots, spots)
        progress("rebuilding the surface", share)
    direction = _outward(spots, direction, outside)
    progress("rebuilding the surface", 0.6)
    vertices, faces = _contour(spots, direction, spacing)
    vertices, _ = _on_patches(vertices, spots)
    progress("rebuilding the surface", 0.9)
    return vertices, faces


def is_cloud(scan: RawScan) -> bool:
    """Tell whether a scan has no triangles, or but for a small part of its points."""
    if len(scan.faces) == 0:
        return True
    used = np.zeros(len(scan.vertices), dtype=bool)
    used[scan.faces] = True
    if (~used).sum() < FEWEST_POINTS:
        return False
    placed = _placed(scan.vertices)
    some = scan.vertices[placed][:: max(1, int(placed.sum()) // 4000)]
    corners = scan.vertices[used & placed]
    if len(corners) == 0:
        return True
    low, high = np.percentile(some, (1, 99), axis=0)
    reach, _ = cKDTree(corners).query(some)
    return bool(np.mean(reach < 0.05 * np.linalg.norm(high - low)) < 0.5)


def _placed(points: Points) -> Flags:
    return np.asarray((np.abs(points) < FARTHEST).all(axis=1))  # not a number is no place either


def spacing_of(points: Points) -> float:
    """Return how far neighbours lie from each other: the side of the square that each point has to itself."""
    some = points[:: max(1, len(points) // 4000)]
    reach, _ = _nearest(cKDTree(points), some, 9)
    return float(np.median(reach[:, -1]) * np.sqrt(np.pi / 8.0))


def _nearest(tree: cKDTree, places: Points, count: int) -> tuple[Floats, Indices]:
    """Return how far the nearest ``count`` points of a tree lie, and which they are, shapes (n, count)."""
    reach, near = tree.query(places, k=np.arange(1, min(count, tree.n) + 1))
    return np.asarray(reach), np.asarray(near, dtype=np.int64)


def _even(points: Points, normals: Points | None) -> tuple[Points, Points | None, float]:
    """Replace the points of each cell by their mean, the cells so large that few enough remain."""
    spacing = spacing_of(points)
    cell = spacing * max(0.7, np.sqrt(len(points) / WORK_POINTS))
    spot = np.floor((points - points.min(axis=0)) / cell).astype(np.int64)
    size = spot.max(axis=0) + 1
    key = (spot[:, 0] * size[1] + spot[:, 1]) * size[2] + spot[:, 2]
    _, group = np.unique(key, return_inverse=True)
    share = sparse.csr_array((np.ones(len(points)), (group, np.arange(len(points)))))
    mean = (share @ points) / share.sum(axis=1)[:, None]
    return mean, None if normals is None else unit(np.asarray(share @ unit(normals))), max(spacing, cell)


def _without_loners(spots: Points, outside: Points | None) -> tuple[Points, Points | None]:
    reach = _nearest(cKDTree(spots), spots, 6)[0][:, -1]
    near = reach < 3.5 * np.median(reach)
    return spots[near], None if outside is None else outside[near]


def _on_patches(queries: Points, spots: Points) -> tuple[Points, Points]:
    """Move points onto the smooth patches through the spots around them; also return the normals there."""
    tree = cKDTree(spots)
    parts = [_patches(queries[k : k + BLOCK], tree) for k in range(0, len(queries), BLOCK)]
    return np.concatenate([place for place, _ in parts]), np.concatenate([normal for _, normal in parts])


def _patches(queries: Points, tree: cKDTree) -> tuple[Points, Points]:
    """A patch is a quadric over the plane that lies best in its neighbours, near ones counting more."""
    reach, near = _nearest(tree, queries, NEIGHBOURS)
    scale = reach[:, -1] + 1e-300
    weight = np.exp(-((reach / (0.5 * scale[:, None])) ** 2))
    weight /= weight.sum(axis=1, keepdims=True)
    around = (tree.data[near] - queries[:, None]) / scale[:, None, None]
    offset = around - (weight[:, None] @ around)
    _, axes = np.linalg.eigh(np.swapaxes(offset * weight[..., None], 1, 2) @ offset)
    local = around @ axes
    height, u, v = local[..., 0], local[..., 1], local[..., 2]
    terms = np.stack([np.ones_like(u), u, v, u * u, u * v, v * v], axis=2)
    weighted = np.swapaxes(terms * weight[..., None], 1, 2)
    fit = np.linalg.solve(weighted @ terms + 1e-7 * np.eye(6), weighted @ height[..., None])[..., 0]
    normal = axes[..., 0] - fit[:, 1, None] * axes[..., 1] - fit[:, 2, None] * axes[..., 2]
    return queries + (fit[:, 0] * scale)[:, None] * axes[..., 0], unit(normal)


def _outward(spots: Points, direction: Points, outside: Points | None) -> Points:
    """Turn normals to one side: of the file's normals, or by walking from neighbour to neighbour."""
    if outside is not None:
        agree = np.einsum("ij,ij->i", direction, outside)
        return np.where(agree[:, None] < 0.0, -direction, direction)
    count = len(spots)
    _, near = _nearest(cKDTree(spots), spots, 11)
    start, end = np.repeat(np.arange(count), near.shape[1] - 1), near[:, 1:].ravel()
    cost = 1.0 - np.abs(np.einsum("ij,ij->i", direction[start], direction[end])) + 1e-9
    tree = minimum_spanning_tree(sparse.csr_array((cost, (start, end)), shape=(count, count)))
    tree = tree + tree.T
    pieces, piece = connected_components(tree, directed=False)
    sign = np.ones(count)
    for number in range(pieces):
        inside = np.flatnonzero(piece == number)
        top = inside[np.argmax(np.linalg.norm(spots[inside] - spots.mean(axis=0), axis=1))]
        order, before = breadth_first_order(tree, top, directed=False)
        _walk_signs(order.astype(np.int64), before.astype(np.int64), direction, sign)
        if sign[top] * (direction[top] @ (spots[top] - spots.mean(axis=0))) < 0.0:
            sign[inside] *= -1.0
    return direction * sign[:, None]


def _walk_signs(order: Indices, before: Indices, direction: Points, sign: Floats) -> None:
    flip = np.ones(len(order))
    flip[1:] = np.where(
        np.einsum("ij,ij->i", direction[order[1:]], direction[before[order[1:]]]) < 0.0, -1.0, 1.0
    )
    for k, spot in enumerate(order[1:].tolist(), 1):
        sign[spot] = sign[before[spot]] * flip[k]


def _contour(spots: Points, direction: Points, spacing: float) -> tuple[Points, Faces]:
    """Find where the height over the spots' planes is zero, on a grid that only lies near the spots.

    Each cell that the surface passes through gets a vertex, each edge that it cuts a square of four of them.
    """
    grid = _Grid.around(spots, CELL * spacing)
    reach, _ = cKDTree(spots).query(grid.places, k=1, distance_upper_bound=REACH * spacing)
    grid = grid.at(np.isfinite(reach))
    height = _heights(grid.places, spots, direction)
    cells, cuts, squares = [], [], []
    for axis in range(3):
        start, end = grid.edges(axis)
        cut = (height[start] < 0.0) != (height[end] < 0.0)
        start, end = start[cut], end[cut]
        share = height[start] / (height[start] - height[end])
        cuts += 4 * [grid.places[start] + share[:, None] * (grid.places[end] - grid.places[start])]
        one, other = (grid.strides[k % 3] for k in (axis + 1, axis + 2))
        key = grid.keys[start]
        square = np.stack([key, key - one, key - one - other, key - other], axis=1)
        squares.append(np.where((height[start] < 0.0)[:, None], square, square[:, ::-1]))
        cells += [square[:, k] for k in range(4)]
    key, points = np.concatenate(cells), np.concatenate(cuts)
    known = _once(key)
    cell = np.searchsorted(known, key)
    share = sparse.csr_array((np.ones(len(points)), (cell, np.arange(len(points)))))
    vertices = (share @ points) / share.sum(axis=1)[:, None]
    return vertices, _halves(vertices, np.searchsorted(known, np.concatenate(squares)))


def _halves(vertices: Points, squares: Indices) -> Faces:
    """Cut squares along their shorter diagonals."""
    a, b, c, d = (vertices[squares[:, k]] for k in range(4))
    other = np.linalg.norm(b - d, axis=1) < np.linalg.norm(a - c, axis=1)
    turned = np.where(other[:, None], np.roll(squares, -1, axis=1), squares)
    return np.concatenate([turned[:, [0, 1, 2]], turned[:, [0, 2, 3]]])


def _heights(places: Points, spots: Points, direction: Points) -> Floats:
    """Return how far places lie outside the planes of the spots around them, shape (n,).

    Spots that look another way than the nearest one belong to another sheet of skin: they do not count.
    """
    tree, height = cKDTree(spots), np.empty(len(places))
    for k in range(0, len(places), BLOCK):
        some = places[k : k + BLOCK]
        reach, near = _nearest(tree, some, 8)
        around = direction[near]
        weight = (1.0 - (reach / (1.001 * reach[:, -1:])) ** 2) ** 2
        weight *= np.maximum((around @ around[:, 0, :, None])[..., 0], 0.0)
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
    def around(cls, spots: Points, cell: float, width: int = 3) -> _Grid:
        low = spots.min(axis=0) - (width + 2) * cell
        index = np.floor((spots - low) / cell).astype(np.int64)
        size = index.max(axis=0) + width + 3
        strides = np.array([size[1] * size[2], size[2], 1])
        keys = _once(index @ strides)
        for stride in strides:
            keys = _once((keys + stride * np.arange(-width, width + 2)[:, None]).ravel())
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


def _once(keys: Indices) -> Indices:
    """Return every number once, in rising order; np.unique takes much longer."""
    rising = np.sort(keys)
    return rising[np.diff(rising, prepend=-1) > 0]
