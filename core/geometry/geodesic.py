"""Shortest ways over the skin, from place to place where a line is drawn.

Source: N. Sharp, K. Crane, "You Can Find Geodesic Paths in Triangle Meshes by Just Flipping Edges", 2020, as
the library potpourri3d has it.
"""

from __future__ import annotations

import numpy as np
import potpourri3d
from scipy.spatial import cKDTree

from core.errors import LineError
from core.geometry.closest_point import barycentric, nearest_faces
from core.geometry.mesh import Faces, Indices, Mesh, Points, half_edges, submesh
from core.geometry.plane_sections import arc_length
from core.messages import Message


def no_path_error() -> LineError:
    """Return what to say where two places do not hang together."""
    return LineError(
        Message("No path over the skin reaches that point."),
        Message("Click on the same part of the body."),
    )


class SurfacePaths:
    """Ways over one body; it takes a third of a second to prepare and some milliseconds for each.

    Raises LineError if the body's surface branches: then there is no way over it.
    """

    def __init__(self, mesh: Mesh) -> None:
        mesh = split_pinched_vertices(mesh)
        self._tree = cKDTree(mesh.vertices)
        try:
            self._solver = potpourri3d.EdgeFlipGeodesicSolver(mesh.vertices, mesh.faces.astype(np.int64))
        except (RuntimeError, ValueError) as problem:
            raise LineError(
                Message("Lines cannot be drawn on the surface of this scan."),
                Message("Define the line by control points."),
            ) from problem

    def path(self, start: Points, end: Points) -> Points:
        """Return the way between two places of the skin, each (3,) [mm], shape (k, 3); both are its ends.

        Raises LineError if they lie on parts of the body that do not hang together.
        """
        return self._path(start, end, None)

    def length_along_edges(self, start: Points, end: Points) -> float:
        """Return the length of the way along edges from which the way between two places is found [mm]."""
        return float(arc_length(self._path(start, end, 0))[-1])

    def _path(self, start: Points, end: Points, most: int | None) -> Points:
        """Return the way after at most so many steps that shorten it, (k, 3) [mm]."""
        first, last = (int(self._tree.query(place)[1]) for place in (start, end))
        if first == last:
            return np.stack([start, end])
        try:
            way = np.asarray(self._solver.find_geodesic_path(first, last, most), dtype=np.float64)
        except (RuntimeError, ValueError) as problem:
            raise no_path_error() from problem
        # The places themselves stand for the vertices beside them, or the way would go there and back.
        return np.concatenate([[start], way[1:-1], [end]])


def split_pinched_vertices(mesh: Mesh) -> Mesh:
    """Return ``mesh`` with each vertex at which holes meet doubled: one for each piece of skin there.

    The library walks round each vertex, and refuses a skin where it cannot.
    """
    half = half_edges(mesh.faces)
    count = len(mesh.vertices)
    keys, turned = half[:, 0] * count + half[:, 1], half[:, 1] * count + half[:, 0]
    ends = np.bincount(half[~np.isin(keys, turned), 0], minlength=count)
    vertices, faces = list(mesh.vertices), mesh.faces.copy()
    for pinched in np.flatnonzero(ends > 1).tolist():
        for fan in _fans(faces, pinched)[1:]:
            faces[fan] = np.where(faces[fan] == pinched, len(vertices), faces[fan])
            vertices.append(mesh.vertices[pinched])
    return Mesh(np.array(vertices), faces) if len(vertices) > count else mesh


def _fans(faces: Faces, vertex: int) -> list[list[int]]:
    """Return the faces round a vertex in groups that hang together by edges of it."""
    left = {
        int(face): set(faces[face].tolist()) - {vertex} for face in np.flatnonzero((faces == vertex).any(1))
    }
    fans = []
    while left:
        face, border = left.popitem()
        fan = [face]
        while met := [each for each, ends in left.items() if ends & border]:
            for each in met:
                border |= left.pop(each)
            fan += met
        fans.append(fan)
    return fans


INWARD = 0.02
"""So far from its border a place is put into a triangle, in parts of it [1]: no triangle becomes a thread."""


def shortest_path(mesh: Mesh, start: Points, end: Points) -> Points:
    """Return the shortest way over the skin between two places on it, each (3,) [mm], shape (k, 3) [mm].

    Only the skin near both is looked at: all places of a way of some length lie within the ellipsoid about
    its ends that this length spans. The way is shortened from one along edges: where that and the triangles
    round it are within, it is the same on the whole skin. Raises LineError where there is no way.
    """
    span = 1.25 * float(np.linalg.norm(end - start)) + 20.0
    while True:
        try:
            piece = _piece_within(mesh, start, end, span)
            paths = SurfacePaths(_with_vertex(_with_vertex(piece, start), end))
            needed = paths.length_along_edges(start, end) + 2.0 * _longest_edge(piece)
        except LineError:
            if not np.isfinite(span):
                raise
            span = np.inf  # the piece hangs together at a corner alone, or not at all
            continue
        if needed <= span:
            return paths.path(start, end)
        span = 1.05 * needed


def _piece_within(mesh: Mesh, start: Points, end: Points, span: float) -> Mesh:
    """Return the triangles with all corners in the ellipsoid of ``span`` [mm]. Raises LineError for none."""
    rows: Indices = np.arange(len(mesh.faces))
    if np.isfinite(span):
        rows = np.sort(mesh.centroid_tree.query_ball_point(0.5 * (start + end), 0.5 * span))
    own, faces = np.unique(mesh.faces[rows], return_inverse=True)
    vertices = mesh.vertices[own]
    near = np.linalg.norm(vertices - start, axis=1) + np.linalg.norm(vertices - end, axis=1) < span
    faces = faces.reshape(-1, 3)
    kept = near[faces].all(axis=1)
    if not kept.any():
        raise no_path_error()
    return submesh(Mesh(vertices, faces), kept)


def _longest_edge(mesh: Mesh) -> float:
    corners = mesh.vertices[mesh.faces]
    return float(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max())


def _with_vertex(mesh: Mesh, place: Points) -> Mesh:
    """Return ``mesh`` with a vertex at a ``place`` of it, shape (3,) [mm], or hardly beside."""
    face, foot = nearest_faces(mesh, place[None])
    corners = mesh.faces[face[0]]
    part = np.maximum(barycentric(mesh.vertices[corners][None], foot)[0], INWARD)
    vertex = len(mesh.vertices)
    parts = [[a, b, vertex] for a, b in zip(corners, np.roll(corners, -1), strict=True)]
    faces = np.concatenate([np.delete(mesh.faces, face[0], axis=0), parts])
    return Mesh(np.concatenate([mesh.vertices, [part / part.sum() @ mesh.vertices[corners]]]), faces)
