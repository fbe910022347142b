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
from core.geometry.mesh import Faces, Flags, Mesh, Points, half_edges
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
        first, last = (int(self._tree.query(place)[1]) for place in (start, end))
        if first == last:
            return np.stack([start, end])
        try:
            way = np.asarray(self._solver.find_geodesic_path(first, last), dtype=np.float64)
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
    its ends that this length spans. Raises LineError where there is no way.
    """
    span = 1.5 * float(np.linalg.norm(end - start)) + 60.0
    to_ends = np.linalg.norm(mesh.vertices - start, axis=1) + np.linalg.norm(mesh.vertices - end, axis=1)
    while True:
        whole = bool((to_ends < span).all())
        try:
            way = _way_within(mesh, to_ends < span, start, end)
        except LineError:
            if whole:
                raise
            span = np.inf  # the piece hangs together at a corner alone, or not at all
            continue
        length = float(arc_length(way)[-1])
        if whole or length <= span:
            return way
        span = 1.05 * length


def _way_within(mesh: Mesh, near: Flags, start: Points, end: Points) -> Points:
    rows, faces = np.unique(mesh.faces[near[mesh.faces].all(axis=1)], return_inverse=True)
    if not len(rows):
        raise no_path_error()
    piece = Mesh(mesh.vertices[rows], faces.reshape(-1, 3))
    for place in (start, end):
        piece = _with_vertex(piece, place)
    return SurfacePaths(piece).path(start, end)


def _with_vertex(mesh: Mesh, place: Points) -> Mesh:
    """Return ``mesh`` with a vertex at a ``place`` of it, shape (3,) [mm], or hardly beside."""
    face, foot = nearest_faces(mesh, place[None])
    corners = mesh.faces[face[0]]
    part = np.maximum(barycentric(mesh.vertices[corners][None], foot)[0], INWARD)
    vertex = len(mesh.vertices)
    parts = [[a, b, vertex] for a, b in zip(corners, np.roll(corners, -1), strict=True)]
    faces = np.concatenate([np.delete(mesh.faces, face[0], axis=0), parts])
    return Mesh(np.concatenate([mesh.vertices, [part / part.sum() @ mesh.vertices[corners]]]), faces)
