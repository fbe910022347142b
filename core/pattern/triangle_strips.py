"""The shortest strip of triangles between two places of a skin, and a path through it (ours)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import dijkstra

from core.geometry.closest_point import centroids
from core.geometry.mesh import Floats, Indices, Mesh, Points, submesh

REACH = 80.0
"""Strips are searched among the triangles within this distance of both places [mm]."""

_ASIDE = 0.05  # a path keeps this distance from the ends of the edges that it crosses [1]
_PASSES = 30  # of pulling it straight


@dataclass(frozen=True, eq=False)
class Strip:
    """A path over k edges: from vertex ``low`` to ``high``, ``share`` of the way, into triangle ``face``.

    All (k,); ``length`` [mm].
    """

    low: Indices
    high: Indices
    share: Floats
    face: Indices
    length: float


def shortest_strip(mesh: Mesh, faces: tuple[int, int], ends: Points) -> Strip | None:
    """Return the path between ``ends`` (2, 3) [mm] in two ``faces``; None where none is within ``REACH``."""
    near = np.zeros(len(mesh.faces), dtype=bool)
    near[mesh.centroid_tree.query_ball_point(ends.mean(axis=0), REACH)] = True
    near[list(faces)] = True
    rows = np.flatnonzero(near)
    order = _between(mesh, rows, *np.searchsorted(rows, faces).tolist())
    if order is None:
        return None
    strip = rows[order]
    side = (mesh.face_neighbours[strip[:-1]] == strip[1:, None]).argmax(axis=1)
    at = np.arange(len(side))
    corners = mesh.faces[strip[:-1]]
    one, two = corners[at, side], corners[at, (side + 1) % 3]
    low, high = np.minimum(one, two), np.maximum(one, two)
    share, length = _straight(mesh.vertices[low], mesh.vertices[high], ends)
    return Strip(low, high, share, strip[1:], length)


def _between(mesh: Mesh, rows: Indices, first: int, last: int) -> Indices | None:
    """Return the numbers of ``rows`` (k,) of triangles from the first to the last, each beside the next."""
    piece = submesh(Mesh(mesh.vertices, mesh.faces[rows]), np.ones(len(rows), dtype=bool))
    beyond, centres = piece.face_neighbours, centroids(piece)
    start, end = np.repeat(np.arange(len(rows)), 3), beyond.ravel()
    start, end = start[end >= 0], end[end >= 0]
    away = np.linalg.norm(centres[start] - centres[end], axis=1)
    graph = sparse.csr_array((away, (start, end)), (len(rows),) * 2)
    _, (before,) = dijkstra(graph, indices=[first], return_predecessors=True)
    order = [last]
    while order[-1] != first:
        if before[order[-1]] < 0:
            return None
        order.append(int(before[order[-1]]))
    return np.array(order[::-1])


def _straight(low: Points, high: Points, ends: Points) -> tuple[Floats, float]:
    """Return where a straight path between ``ends`` (2, 3) crosses edges, (k,) [1], and its length [mm]."""
    way = high - low
    squared = np.maximum(np.einsum("ij,ij->i", way, way), 1e-300)
    share = np.full(len(way), 0.5)
    for _ in range(_PASSES):
        path = np.concatenate([ends[:1], low + share[:, None] * way, ends[1:]])
        middle = 0.5 * (path[:-2] + path[2:])
        share = np.clip(np.einsum("ij,ij->i", middle - low, way) / squared, _ASIDE, 1.0 - _ASIDE)
    path = np.concatenate([ends[:1], low + share[:, None] * way, ends[1:]])
    return share, float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())
