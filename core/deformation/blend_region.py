"""The patch: the part of the body that follows the control mesh, and how it fades out at its border."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components, dijkstra
from scipy.spatial import cKDTree

from core.control_mesh.fit import ControlMesh
from core.geometry.closest_point import Frames, centroids, corner_reach, neighbourhoods
from core.geometry.mesh import Flags, Floats, Indices, Mesh, Points, frozen
from core.messages import EMPTY, Message

FAR = 60.0
"""No vertex further than this from the control mesh belongs to the patch [mm]."""

CLOSE = 20.0
"""Up to this distance a vertex belongs fully to the control triangle before it [mm]."""

DETOUR = 2.0
"""A stretch of the fence may be this many times as long as its straight border edge."""

COVERED = 0.9
"""The flood must reach this part of the control points within the border."""


@dataclass(frozen=True, eq=False)
class BlendRegion:
    """How far each vertex of the body follows the control mesh.

    ``fade`` has shape (N,): 0 outside the patch .. 1 well inside. ``rule`` is "flood" when the border could
    be drawn on the surface; "distance" when a hole or a loose piece prevented that, and ``reason`` says what.
    """

    fade: Floats
    rule: Literal["flood", "distance"]
    reason: Message = EMPTY


class _FenceError(Exception):
    """The border of the patch cannot be drawn on the surface."""

    def __init__(self, reason: Message) -> None:
        super().__init__(reason)
        self.reason = reason


def blend_weights(body: Mesh, control: ControlMesh, fade: float = 25.0) -> BlendRegion:
    """Find the patch of ``body`` under ``control``, with a soft border ``fade`` wide [mm] (ours).

    Shortest edge paths between the points of each border fence it in, a flood from the control mesh's seeds
    fills it, and the fade is a smooth step of the distance along the surface to that fence. Where the fence
    has a gap or the flood escapes, the fade follows from the nearest place on the control mesh instead.
    """
    try:
        return BlendRegion(frozen(_flooded(body, control, fade)), "flood")
    except _FenceError as gap:
        return BlendRegion(frozen(_by_distance(body, control, fade)), "distance", gap.reason)


def smooth_step(t: Floats) -> Floats:
    """Return 0 below 0, 1 above 1 and 3 t^2 - 2 t^3 between."""
    t = np.clip(t, 0.0, 1.0)
    return np.asarray(t * t * (3.0 - 2.0 * t))


def _flooded(body: Mesh, control: ControlMesh, fade: float) -> Floats:
    around = _near_patch(body.vertices, control.mesh)
    graph = _edge_graph(body, around)
    tree = cKDTree(body.vertices[around])
    at = np.asarray(tree.query(control.mesh.vertices)[1], dtype=np.int64)
    rings = [_fence(graph, tree, at[loop], control.mesh.vertices[loop]) for loop in control.borders]
    fence = np.unique(np.concatenate(rings))
    region = _flood(graph, fence, at[list(control.seeds)])
    inner = np.setdiff1d(at, at[control.border_points])
    if region[inner].mean() < COVERED:
        raise _FenceError(Message("The scan is disconnected within the blend region."))
    if _touches_rest(body, around, region):
        raise _FenceError(Message("The border of the blend region is not closed on the scan."))
    region[fence] = True
    members = np.flatnonzero(region)
    sources = np.searchsorted(members, fence)
    along = dijkstra(graph[members][:, members], indices=sources, min_only=True, limit=fade)
    result = np.zeros(len(body.vertices))
    result[around[members]] = smooth_step(along / fade)
    return result


def _near_patch(points: Points, control: Mesh) -> Indices:
    """Return the points that may be within ``FAR`` of the control mesh, and some more, shape (k,)."""
    reach = FAR + corner_reach(control).max()
    low, high = control.vertices.min(axis=0) - reach, control.vertices.max(axis=0) + reach
    x, y, z = ((low[axis] <= points[:, axis]) & (points[:, axis] <= high[axis]) for axis in range(3))
    in_box = np.flatnonzero(x & y & z)
    away, _ = cKDTree(centroids(control)).query(points[in_box], distance_upper_bound=reach)
    return np.asarray(in_box[np.isfinite(away)])


def _edge_graph(body: Mesh, members: Indices) -> sparse.csr_array:
    """Return the edges among ``members``, shape (k,), with their lengths [mm], shape (k, k), symmetric."""
    place = np.full(len(body.vertices), -1, dtype=np.int32)
    place[members] = np.arange(len(members))
    faces = place.take(body.faces)
    faces = faces[(faces[:, 0] >= 0) & (faces[:, 1] >= 0) & (faces[:, 2] >= 0)]
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    one_way = sparse.coo_array((np.ones(len(start), dtype=np.int8), (start, end)), shape=(len(members),) * 2)
    graph = (one_way.tocsr() + one_way.T.tocsr()).tocoo()
    x, y, z = (column.take(graph.row) - column.take(graph.col) for column in body.vertices[members].T)
    return sparse.csr_array((np.sqrt(x * x + y * y + z * z), (graph.row, graph.col)), shape=graph.shape)


def _fence(graph: sparse.csr_array, tree: cKDTree, stops: Indices, corners: Points) -> Indices:
    """Return the vertices on the shortest paths from stop to stop, once round, ascending."""
    straight = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)
    vertices = set(stops.tolist())
    for start, end, chord in zip(stops.tolist(), np.roll(stops, -1).tolist(), straight.tolist(), strict=True):
        limit = DETOUR * (chord + CLOSE)
        # No way from start to end that is short enough leaves this ball.
        middle = 0.5 * (tree.data[start] + tree.data[end])
        members = np.array(sorted({start, end, *tree.query_ball_point(middle, 0.5 * limit)}))
        at = int(np.searchsorted(members, start))
        near = graph[members][:, members]
        _, (before,) = dijkstra(near, indices=[at], limit=limit, return_predecessors=True)
        step = int(np.searchsorted(members, end))
        while step != at:
            step = int(before[step])
            if step < 0:
                raise _FenceError(Message("The border of the blend region crosses a hole in the scan."))
            vertices.add(int(members[step]))
    return np.array(sorted(vertices), dtype=np.int64)


def _flood(graph: sparse.csr_array, fence: Indices, seeds: Indices) -> Flags:
    """Return which vertices the seeds reach without crossing the fence, shape (k,)."""
    open_ground = np.ones(graph.shape[0], dtype=bool)
    open_ground[fence] = False
    ground = np.flatnonzero(open_ground)
    count, label = connected_components(graph[ground][:, ground], directed=False)
    reached = np.zeros(count, dtype=bool)
    place = np.cumsum(open_ground) - 1
    reached[label[place[seeds[open_ground[seeds]]]]] = True
    region = np.zeros(graph.shape[0], dtype=bool)
    region[ground] = reached[label]
    return region


def _touches_rest(body: Mesh, around: Indices, region: Flags) -> bool:
    """Return whether the flood came to the rest of the body, beyond its part ``around`` the patch."""
    beyond = np.ones(len(body.vertices), dtype=bool)
    beyond[around] = False
    flooded = np.zeros(len(body.vertices), dtype=bool)
    flooded[around[region]] = True
    faces = body.faces[flooded.take(body.faces).any(axis=1)]
    return bool(beyond[faces].any())


def _by_distance(body: Mesh, control: ControlMesh, fade: float) -> Floats:
    """Fade with the distance of the nearest place on the control mesh to its border.

    It is less where the body is far away, and nothing where it faces the other way: an arm before the patch
    stays still.
    """
    mesh = control.mesh
    around = _near_patch(body.vertices, mesh)
    distance2, triangle, spots = _nearest_spots(body.vertices[around], mesh)
    inwards = np.min([_to_loop(spots, mesh.vertices[loop]) for loop in control.borders], axis=0)
    inwards[inwards < 1e-6] = 0.0  # before the border itself, but for rounding
    near = smooth_step((FAR - np.sqrt(distance2)) / (FAR - CLOSE))
    facing = np.einsum("ij,ij->i", body.vertex_normals[around], mesh.face_normals[triangle])
    result = np.zeros(len(body.vertices))
    result[around] = smooth_step(inwards / fade) * near * smooth_step(1.0 + 2.0 * facing)
    return result


def _nearest_spots(points: Points, mesh: Mesh) -> tuple[Floats, Indices, Points]:
    """Return squared distance (k,) [mm^2], triangle (k,) and place (k, 3) [mm] nearest to each point."""
    frames = Frames.of(mesh)
    distance2, nearest = np.empty(len(points)), np.empty(len(points), dtype=np.int64)
    place = np.empty((len(points), 2))
    for rows, triangles in neighbourhoods(points, mesh):
        u, v, h = frames.coordinates(points[rows], triangles)
        away = frames.distance2(points[rows], triangles, h)
        at = np.argmin(away, axis=0), np.arange(len(rows))
        distance2[rows], nearest[rows] = away[at], triangles[at[0]]
        on_triangle = frames.nearest_place(points[rows], triangles, u, v)
        place[rows] = np.stack([on_triangle[0][at], on_triangle[1][at]], axis=1)
    v0, v1, v2 = (mesh.vertices[mesh.faces[nearest, k]] for k in range(3))
    return distance2, nearest, v0 + place[:, :1] * (v1 - v0) + place[:, 1:] * (v2 - v0)


def _to_loop(points: Points, corners: Points) -> Floats:
    """Return the distances from points, shape (k, 3), to the closed polyline of ``corners``, (b, 3) [mm]."""
    side = np.roll(corners, -1, axis=0) - corners
    offset = points[:, None] - corners
    along = np.einsum("kbi,bi->kb", offset, side) / np.maximum(np.einsum("bi,bi->b", side, side), 1e-12)
    gap = offset - np.clip(along, 0.0, 1.0)[:, :, None] * side
    return np.asarray(np.sqrt(np.einsum("kbi,kbi->kb", gap, gap).min(axis=1)))
