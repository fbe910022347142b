"""Skin over the tissue: the part of a body within the outline of its control mesh, coarsely meshed."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components, dijkstra

from core.geometry.closest_point import barycentric, nearest_faces
from core.geometry.mesh import Faces, Flags, Floats, Indices, Mesh, Points

RIM = 5.0
"""Skin nearer than this to the border of what lies within the outline does not move [mm]: assumed."""

_EDGE = 1e-3
"""A place whose barycentric coordinate is below this [1] lies on a side of its triangle."""

_ROUNDS = 5
"""So often are points moved to the middle of their cells."""


@dataclass(frozen=True, eq=False)
class SkinPatch:
    """A coarse skin, and which of its vertices lie over fixed control points alone, shape (n,)."""

    mesh: Mesh
    over_fixed: Flags

    @cached_property
    def rim(self) -> Indices:
        """Return the vertices on the border, ascending."""
        return np.unique(np.concatenate(self.mesh.boundary_loops))


def skin_patch(body: Mesh, control: Mesh, fixed: Flags, size: float) -> SkinPatch:
    """Return the skin of ``body`` within the outline of ``control``, with points about ``size`` [mm] apart.

    ``fixed`` (k,) tells which control points do not move. Raises ValueError where no skin lies within.
    Source: geodesic farthest points, moved to the middle of their cells; triangles join neighbours (ours).
    """
    whole = _largest_piece(body, ~_beyond_outline(body.vertices, control))
    border = np.concatenate(whole.boundary_loops)
    whole = _largest_piece(whole, dijkstra(edge_graph(whole), indices=border, min_only=True) >= RIM)
    coarse = coarse_mesh(whole, size)
    face, _ = nearest_faces(control, coarse.vertices)
    return SkinPatch(coarse, np.asarray(fixed[control.faces[face]].all(axis=1)))


def coarse_mesh(mesh: Mesh, size: float) -> Mesh:
    """Return ``mesh``, which has a border, with points about ``size`` [mm] apart; they are vertices of it."""
    graph = edge_graph(mesh)
    border = _border_sites(mesh, size)
    sites = _farthest_sites(graph, border, size)
    for _ in range(_ROUNDS):
        cell = _cells(graph, sites)
        sites = np.concatenate([border, _middles(mesh.vertices, cell, sites)[len(border) :]])
    corners = _cells(graph, sites)[mesh.faces]
    apart = (corners != np.roll(corners, 1, axis=1)).all(axis=1)
    _, first = np.unique(np.sort(corners[apart], axis=1), axis=0, return_index=True)
    return _without_unused(mesh.vertices[sites], corners[apart][np.sort(first)])


def edge_graph(mesh: Mesh) -> sparse.csr_array:
    """Return the edges of a mesh as a symmetric graph, weighted with their lengths [mm]."""
    ends, count = mesh.edges, len(mesh.vertices)
    length = np.linalg.norm(mesh.vertices[ends[:, 0]] - mesh.vertices[ends[:, 1]], axis=1)
    one_way = sparse.coo_array((length, (ends[:, 0], ends[:, 1])), shape=(count, count))
    return sparse.csr_array(one_way + one_way.T)


def _beyond_outline(places: Points, control: Mesh) -> Flags:
    """Return which places have their nearest place of the control mesh on its outline, shape (n,)."""
    face, foot = nearest_faces(control, places)
    share = barycentric(control.vertices[control.faces[face]], foot)
    outline = np.concatenate([np.stack([loop, np.roll(loop, -1)], axis=1) for loop in control.boundary_loops])
    sides = {tuple(sorted(pair)) for pair in outline.tolist()}
    corners = control.faces
    opposite = np.stack([corners[:, [1, 2]], corners[:, [2, 0]], corners[:, [0, 1]]], axis=1)
    is_side = np.array([[tuple(sorted(pair)) in sides for pair in each] for each in opposite.tolist()])
    on_side = (is_side[face] & (share < _EDGE)).any(axis=1)
    on_corner = (np.isin(corners, outline)[face] & (share > 1.0 - _EDGE)).any(axis=1)
    return np.asarray(on_side | on_corner)


def _largest_piece(mesh: Mesh, kept: Flags) -> Mesh:
    """Return the largest connected piece of the faces whose corners are all ``kept`` (n,)."""
    piece = _without_unused(mesh.vertices, mesh.faces[kept[mesh.faces].all(axis=1)])
    if not len(piece.faces):
        raise ValueError("no skin lies within the outline of the control mesh")
    _, label = connected_components(edge_graph(piece), directed=False)
    largest = np.bincount(label[piece.faces[:, 0]]).argmax()
    return _without_unused(piece.vertices, piece.faces[label[piece.faces[:, 0]] == largest])


def _without_unused(vertices: Points, faces: Faces) -> Mesh:
    used, renumbered = np.unique(faces, return_inverse=True)
    return Mesh(vertices[used], renumbered.reshape(-1, 3))


def _border_sites(mesh: Mesh, size: float) -> Indices:
    """Return vertices about ``size`` [mm] apart along the longest border."""
    loop = mesh.boundary_loops[0]
    steps = np.linalg.norm(np.diff(mesh.vertices[[*loop, loop[0]]], axis=0), axis=1)
    along = np.cumsum(steps) - steps
    count = max(round(steps.sum() / size), 3)
    at = np.searchsorted(along, np.arange(count) * steps.sum() / count)
    return np.asarray(loop[np.unique(np.minimum(at, len(loop) - 1))])


def _farthest_sites(graph: sparse.csr_array, border: Indices, size: float) -> Indices:
    """Return ``border`` and, one by one, the vertex farthest from all until none is ``size`` [mm] away."""
    sites = list(border)
    away = dijkstra(graph, indices=sites, min_only=True)
    while away[farthest := int(np.argmax(away))] > 0.95 * size:
        sites.append(farthest)
        away = np.minimum(
            away, dijkstra(graph, indices=[farthest], min_only=True, limit=1.01 * away[farthest] + 1.0)
        )
    return np.array(sites)


def _cells(graph: sparse.csr_array, sites: Indices) -> Indices:
    """Return for each vertex the number of the site nearest along the skin, shape (n,)."""
    _, _, source = dijkstra(graph, indices=sites, min_only=True, return_predecessors=True)
    number = np.zeros(graph.shape[0], dtype=np.int64)
    number[sites] = np.arange(len(sites))
    return np.asarray(number[source])


def _middles(vertices: Points, cell: Indices, sites: Indices) -> Indices:
    """Return the vertex nearest to the mean of each cell."""
    count = np.bincount(cell, minlength=len(sites))
    mean = np.stack([np.bincount(cell, axis, len(sites)) / count for axis in vertices.T], axis=1)
    away: Floats = np.linalg.norm(vertices - mean[cell], axis=1)
    order = np.lexsort((away, cell))
    return np.asarray(order[np.searchsorted(cell[order], np.arange(len(sites)))])
