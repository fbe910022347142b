"""Even points over a panel: its border and slits as given, equilateral triangles within."""

from __future__ import annotations

import numpy as np
from scipy import sparse
from scipy.spatial import Delaunay, QhullError, cKDTree

from core.geometry.closest_point import barycentric, nearest_faces
from core.geometry.mesh import Faces, Flags, Floats, Indices, Mesh, boundary_loops, half_edges
from core.geometry.triangulate import clip_ears, inside_polygon

_CLEAR = 0.6
"""Points within keep so many spacings from border and slits. Source: ours."""

_THREAD = 1e-6
"""A triangle of less area than this part of its longest side squared is none [1]."""


_NEAR = 6
"""A place is looked for in so many triangles first: hardly one in a thousand is in none of them."""


def grid_within(ring: Floats, fixed: Floats, spacing: float) -> Floats:
    """Return places of an even grid in the polygon ``ring`` (b, 2), clear of it and of ``fixed``, (k, 2).

    The grid is the same seen in a mirror. Source: ours.
    """
    centre, reach = ring.mean(axis=0), np.ptp(ring, axis=0).max()
    half = int(reach / spacing) + 1
    row, column = (at.ravel() for at in np.mgrid[-2 * half : 2 * half + 1, -half : half + 1])
    places = centre + spacing * np.stack([column + 0.5 * (row % 2), np.sqrt(0.75) * row], axis=1)
    low, high = ring.min(axis=0), ring.max(axis=0)
    places = places[((places > low) & (places < high)).all(axis=1)]
    step = np.roll(ring, -1, axis=0) - ring
    dense = [ring + share * step for share in (0.0, 1 / 3, 2 / 3)]
    tree = cKDTree(np.concatenate([*dense, fixed]))
    places = places[np.isinf(tree.query(places, distance_upper_bound=_CLEAR * spacing)[0])]
    return np.asarray(places[inside_polygon(ring, places)])


def joined_by_triangles(points: Floats, border: Indices, lines: Indices) -> Faces | None:
    """Join ``points`` (p, 2) by triangles within the polygon of the rows ``border``, counter-clockwise.

    Its sides and the ``lines`` (l, 2) are edges. None where the polygon crosses itself or a line.
    """
    try:
        faces = Delaunay(points).simplices.astype(np.int64)
    except QhullError:
        return None
    a, b, c = (points[faces[:, k]] for k in range(3))
    turn = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    faces = _without_threads(points, np.where((turn < 0.0)[:, None], faces[:, ::-1], faces))
    outline = np.stack([border, np.roll(border, -1)], axis=1)
    wanted = np.concatenate([outline, lines])
    has_edge = _ahead(faces, len(points))
    has_edge |= has_edge.T
    for start, end in wanted[~has_edge[wanted[:, 0], wanted[:, 1]]].tolist():
        changed = _with_edge(points, faces, start, end)
        if changed is None:
            return None
        faces = changed
    faces = faces[_is_inside(points, faces, border)]
    ahead, around = _ahead(faces, len(points)), np.zeros((len(points), len(points)), dtype=bool)
    around[outline[:, 0], outline[:, 1]] = True
    whole = np.array_equal(ahead & ~ahead.T, around)
    return faces if whole and np.count_nonzero(ahead) == faces.size else None


def _ahead(faces: Faces, count: int) -> Flags:
    """Return from which of ``count`` points to which a side of a triangle leads, (count, count)."""
    ahead = np.zeros((count, count), dtype=bool)
    start, end = half_edges(faces).T
    ahead[start, end] = True
    return ahead


def _is_inside(points: Floats, faces: Faces, border: Indices) -> Flags:
    """Return which ``faces`` are within the ring ``border``, whose sides none crosses, (m,).

    Those at another point are: all points are within it.
    """
    inside = np.ones(len(points), dtype=bool)
    inside[border] = False
    found: Flags = np.asarray(inside[faces].any(axis=1))
    unsure = np.flatnonzero(~found)
    found[unsure] = inside_polygon(points[border], points[faces[unsure]].mean(axis=1))
    return found


def _without_threads(points: Floats, faces: Faces) -> Faces:
    """Leave out triangles whose corners lie on a line: each neighbour is divided at the corner between."""
    for _ in range(len(faces)):
        corners = points[faces]
        side = np.linalg.norm(np.roll(corners, -2, axis=1) - np.roll(corners, -1, axis=1), axis=2)
        thread = _left_of(corners[:, 0], corners[:, 1], corners[:, 2]) < _THREAD * side.max(axis=1) ** 2
        if not thread.any():
            break
        row = int(np.where(thread, side.max(axis=1), 0.0).argmax())
        middle, start, end = np.roll(faces[row], -int(side[row].argmax())).tolist()
        has_both = (faces == start).any(axis=1) & (faces == end).any(axis=1)
        beside = next((each for each in np.flatnonzero(has_both).tolist() if each != row), None)
        parts = []
        if beside is not None:
            tip = next(vertex for vertex in faces[beside].tolist() if vertex not in (start, end))
            parts = [(start, middle, tip), (middle, end, tip)]
            parts = [part if _left_of(*points[list(part)]) > 0.0 else part[::-1] for part in parts]
        kept = np.delete(faces, [row] if beside is None else [row, beside], axis=0)
        faces = np.concatenate([kept, np.array(parts, dtype=np.int64).reshape(-1, 3)])
    return faces


def _keys(edges: Indices) -> Indices:
    return np.asarray(edges.min(axis=1) << 31 | edges.max(axis=1))


def _with_edge(points: Floats, faces: Faces, start: int, end: int) -> Faces | None:
    """Replace the triangles that the line from ``start`` to ``end`` crosses, so that it is an edge."""
    first, last = points[start], points[end]
    sides = half_edges(faces)
    a, b = points[sides[:, 0]], points[sides[:, 1]]
    splits = _left_of(first, last, a) * _left_of(first, last, b) < 0.0
    splits &= _left_of(a, b, first) * _left_of(a, b, last) < 0.0
    splits &= ~np.isin(sides, [start, end]).any(axis=1)
    crossed = splits.reshape(3, -1).any(axis=0)
    loops = boundary_loops(faces[crossed])
    if len(loops) != 1 or start not in loops[0] or end not in loops[0]:
        return None
    loop = np.roll(loops[0], -int(np.flatnonzero(loops[0] == start)[0]))
    at = int(np.flatnonzero(loop == end)[0])
    parts = [loop[: at + 1], np.append(loop[at:], start)]
    cut = [part[clip_ears(points[part], np.arange(len(part)), np.inf)[0]] for part in parts]
    return np.concatenate([faces[~crossed], *cut])


def _left_of(start: Floats, end: Floats, place: Floats) -> Floats:
    """Return twice the areas of triangles, positive where ``place`` is left of the way to ``end``."""
    way, to = end - start, place - start
    return np.asarray(way[..., 0] * to[..., 1] - way[..., 1] * to[..., 0])


def located(chart: Floats, faces: Faces, places: Floats) -> tuple[Indices, Floats]:
    """Return for ``places`` (k, 2) in a ``chart`` (v, 2) of ``faces`` which one each is in, and its shares.

    The nearest one for a place that is in none; shares (k, 3) are of the corners.
    """
    corners = chart[faces]
    tree = cKDTree(corners.mean(axis=1), compact_nodes=False, balanced_tree=False)
    near = np.asarray(tree.query(places, np.arange(1, min(_NEAR, len(faces)) + 1))[1], dtype=np.int64)
    every = np.repeat(places, near.shape[1], axis=0)
    shares = barycentric(corners[near.ravel()], every).reshape(*near.shape, 3)
    within: Flags = np.asarray((shares > 0.0).all(axis=2))
    best = np.arange(len(places)), within.argmax(axis=1)
    at, own = near[best], shares[best]
    out = np.flatnonzero(~within[best])
    if len(out):
        flat = Mesh(np.pad(chart, [(0, 0), (0, 1)]), faces)
        at[out], foot = nearest_faces(flat, np.pad(places[out], [(0, 0), (0, 1)]))
        own[out] = barycentric(flat.vertices[faces[at[out]]], foot)
    return at, own


def cut_open(faces: Faces, edges: Indices) -> tuple[Faces, Indices]:
    """Part ``faces`` along ``edges`` (e, 2); return them, and the former one of each point, (p,).

    A corner stays joined to those that it reaches over other edges. Points keep their order.
    """
    sides = half_edges(faces)
    corner = np.arange(len(sides))  # corner k of face f has the number k m + f, as its side has
    after = (corner + len(faces)) % len(sides)
    order = np.argsort(_keys(sides), kind="stable")
    keys = _keys(sides)[order]
    twin = np.flatnonzero((keys[1:] == keys[:-1]) & ~np.isin(keys[1:], _keys(edges)))
    one, two = order[twin], order[twin + 1]
    start = np.concatenate([corner[one], after[one]])
    end = np.concatenate([after[two], corner[two]])
    graph = sparse.coo_array((np.ones(len(start)), (start, end)), (len(sides), len(sides)))
    label = sparse.csgraph.connected_components(graph, directed=False)[1]
    label = np.unique(sides[:, 0] * len(sides) + label, return_inverse=True)[1]
    source = np.empty(int(label.max()) + 1, dtype=np.int64)
    source[label] = sides[:, 0]
    return label.reshape(3, -1).T.astype(np.int64), source
