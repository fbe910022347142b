"""A skin through a cloud of points that has no triangles."""

from __future__ import annotations

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import breadth_first_order, connected_components, minimum_spanning_tree
from scipy.spatial import cKDTree

from core.geometry.mesh import MAX_COORDINATE, Faces, Flags, Floats, Indices, Points, quadric_terms, unit
from core.progress import Progress, quiet
from core.scan.readers.raw_scan import RawScan
from core.scan.reconstruction.isosurface import BLOCK, distinct, extract_isosurface, nearest, once, spacing_of

FEWEST_POINTS = 2000
"""With fewer points no breast could be made out."""

SMALL_PART = 0.2
"""Where less of the points lies near triangles [1] the scan is a cloud; else what has none was cut away."""

SMOOTHEST_FOG = 0.8
"""Mean cosine [1] between the normals of neighbours; points in a volume give 0.66, a very noisy skin 0.9."""

STEEP = 0.7
"""Sine of the angle between the skin at a point and the way to a neighbour, from which it is no neighbour."""

SMALL_PIECE = 0.002
"""A loose piece with so small a share of the points [1] is a speck: which side it shows does not matter."""

TRUE_NORMALS = 0.7
"""Mean cosine [1] to the normals of the patches from which the normals of a file are believed."""

FEWEST_PLACES = 500
"""Fewer different places than this make no surface."""

WORK_POINTS = 80_000
"""A denser cloud is thinned to about so many points, each the mean of a cell."""

THINNING = 0.7
"""The side of the cells whose points become one, in parts of the spacing [1]."""

NEIGHBOURS = 24
"""Points that a smooth patch is laid through."""


def reconstruct_surface(
    points: Points, normals: Points | None = None, progress: Progress = quiet
) -> tuple[Points, Faces]:
    """Reconstruct a surface from points, shape (n, 3), of any unit: vertices (k, 3) and faces (m, 3).

    ``normals``, shape (n, 3), tell the outside where they are known. Noise is evened out and loners are
    dropped; where there are no points there is no surface. Raises ValueError, Cancelled. Source: ours;
    patches after Levin 1998, the signs of normals after Hoppe et al. 1992.
    """
    progress("rebuilding the surface", 0.0)
    placed = _placed(points)
    spots, outside = points[placed], None if normals is None else normals[placed]
    if len(spots) == 0:
        raise ValueError("no point has a position")
    cell = THINNING * spacing_of(spots) or float(np.ptp(spots, axis=0).max()) / 1000.0
    for share in (0.1, 0.3, 0.5):  # noise fills more cells than the skin does: less so on the patches
        spots, outside, cell = _thinned(spots, outside, cell)
        spots, direction = _on_patches(spots, spots)
        progress("rebuilding the surface", share)
    direction = _outward(spots, direction, outside)
    progress("rebuilding the surface", 0.6)
    spacing = spacing_of(spots)
    vertices, faces = extract_isosurface(spots, direction, spacing)
    progress("rebuilding the surface", 0.8)
    smooth, _ = _on_patches(vertices, spots)
    moved = np.linalg.norm(smooth - vertices, axis=1, keepdims=True)
    return np.where(moved < 0.5 * spacing, smooth, vertices), faces  # beyond the last points patches run wild


def is_cloud(scan: RawScan) -> bool:
    """Return whether a scan has no triangles, or triangles on only a small part of its points."""
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
    reach, _ = cKDTree(distinct(corners)).query(some)
    return bool(np.mean(reach < 0.05 * np.linalg.norm(high - low)) < SMALL_PART)


def _placed(points: Points) -> Flags:
    return np.asarray((np.abs(points) < MAX_COORDINATE).all(axis=1))  # not a number is no place either


def _thinned(points: Points, normals: Points | None, cell: float) -> tuple[Points, Points | None, float]:
    """Thin points to few enough, and drop those that lie alone; also return the side of the cells."""
    if not cell > 0.0:
        raise ValueError("all points at one position")
    spots, outside = _even(points, normals, cell)
    while len(spots) > WORK_POINTS:
        cell *= 1.05 * np.sqrt(len(spots) / WORK_POINTS)
        spots, outside = _even(points, normals, cell)
    if len(spots) < FEWEST_PLACES:
        raise ValueError("too few different points")
    return *_without_loners(spots, outside), cell


def _even(points: Points, normals: Points | None, cell: float) -> tuple[Points, Points | None]:
    """Replace the points in each cell of a grid by their mean."""
    spot = np.floor((points - points.min(axis=0)) / cell).astype(np.int64)
    size = spot.max(axis=0) + 1
    key = (spot[:, 0] * size[1] + spot[:, 1]) * size[2] + spot[:, 2]
    group = np.searchsorted(once(key), key)
    share = sparse.csr_array((np.ones(len(points)), (group, np.arange(len(points)))))
    mean = (share @ points) / share.sum(axis=1)[:, None]
    return mean, None if normals is None else unit(np.asarray(share @ unit(normals)))


def _without_loners(spots: Points, outside: Points | None) -> tuple[Points, Points | None]:
    reach = nearest(cKDTree(spots), spots, 6)[0][:, -1]
    near = reach < 3.5 * np.median(reach)
    return spots[near], None if outside is None else outside[near]


def _on_patches(queries: Points, spots: Points) -> tuple[Points, Points]:
    """Move points onto the smooth patches through the spots around them; also return the normals there."""
    tree = cKDTree(spots)
    parts = [_patches(queries[k : k + BLOCK], tree) for k in range(0, len(queries), BLOCK)]
    return np.concatenate([place for place, _ in parts]), np.concatenate([normal for _, normal in parts])


def _patches(queries: Points, tree: cKDTree) -> tuple[Points, Points]:
    """A patch is a quadric over the plane that lies best in its neighbours, near ones counting more."""
    reach, near = nearest(tree, queries, NEIGHBOURS)
    scale = reach[:, -1] + 1e-300
    weight = np.exp(-((reach / (0.5 * scale[:, None])) ** 2))
    weight /= weight.sum(axis=1, keepdims=True)
    around = (tree.data[near] - queries[:, None]) / scale[:, None, None]
    offset = around - (weight[:, None] @ around)
    _, axes = np.linalg.eigh(np.swapaxes(offset * weight[..., None], 1, 2) @ offset)
    local = around @ axes
    height, u, v = local[..., 0], local[..., 1], local[..., 2]
    terms = quadric_terms(u, v)
    weighted = np.swapaxes(terms * weight[..., None], 1, 2)
    fit = np.linalg.solve(weighted @ terms + 1e-7 * np.eye(6), weighted @ height[..., None])[..., 0]
    normal = axes[..., 0] - fit[:, 1, None] * axes[..., 1] - fit[:, 2, None] * axes[..., 2]
    return queries + (fit[:, 0] * scale)[:, None] * axes[..., 0], unit(normal)


def _outward(spots: Points, direction: Points, outside: Points | None) -> Points:
    """Turn normals to one side: of the file's normals, or by walking from neighbour to neighbour."""
    count = len(spots)
    _, near = nearest(cKDTree(spots), spots, 11)
    start, end = np.repeat(np.arange(count), near.shape[1] - 1), near[:, 1:].ravel()
    alike = np.abs(np.einsum("ij,ij->i", direction[start], direction[end]))
    if np.mean(alike) < SMOOTHEST_FOG:
        raise ValueError("the points do not form a surface")
    if outside is not None:
        agree = np.einsum("ij,ij->i", direction, outside)
        if np.mean(np.abs(agree)) > TRUE_NORMALS:
            return np.where(agree[:, None] < 0.0, -direction, direction)
    aside = unit(spots[end] - spots[start])
    steep = np.abs(np.einsum("ij,ij->i", direction[start], aside))
    steep = np.maximum(steep, np.abs(np.einsum("ij,ij->i", direction[end], aside)))
    same = steep < STEEP  # straight across lies another skin, as of an arm beside the trunk
    cost = (1.0 - alike + steep**2 + 1e-9)[same]
    tree = minimum_spanning_tree(sparse.csr_array((cost, (start[same], end[same])), shape=(count, count)))
    tree = tree + tree.T
    _, piece = connected_components(tree, directed=False)
    sign = np.ones(count)
    for number in np.flatnonzero(np.bincount(piece) > SMALL_PIECE * count):
        inside = np.flatnonzero(piece == number)
        order, before = breadth_first_order(tree, inside[0], directed=False)
        _walk_signs(order.astype(np.int64), before.astype(np.int64), direction, sign)
        away = spots[inside] - spots[inside].mean(axis=0)
        if np.einsum("n,ni,ni->", sign[inside], direction[inside], away) < 0.0:
            sign[inside] *= -1.0
    return direction * sign[:, None]


def _walk_signs(order: Indices, before: Indices, direction: Points, sign: Floats) -> None:
    flip = np.ones(len(order))
    flip[1:] = np.where(
        np.einsum("ij,ij->i", direction[order[1:]], direction[before[order[1:]]]) < 0.0, -1.0, 1.0
    )
    for k, spot in enumerate(order[1:].tolist(), 1):
        sign[spot] = sign[before[spot]] * flip[k]
