"""Requirements of a fitted control mesh for lines, volume and t-FFD."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.control_mesh.skin_projection import SurfaceProjector
from core.geometry.mesh import Flags, Floats, Indices, Mesh, frozen, unit

SMALLEST_ANGLE = 8.0
"""Smallest angle of a triangle [deg]."""

SHORTEST_EDGE = 10.0
"""Shortest edge [mm]."""

SAME_WAY = 0.3
"""Smallest cosine between a triangle's normal and the mean normal of the skin behind it."""

BACKWARD = -0.5
"""A triangle whose cosine is below this faces backward; deep in a fold it may face either way.

A few that lie across the skin do no harm: bodies over them reshape without spikes.
"""

SHARPEST = 130.0
"""Two triangles that meet more sharply than this lie back on each other [deg]."""

SAMPLES = frozen([[8, 2, 2], [2, 8, 2], [2, 2, 8], [2, 5, 5], [5, 2, 5], [5, 5, 2]]) / 12.0
"""The skin behind a triangle is looked up from these places, as shares of its corners."""


def corner_angles(mesh: Mesh) -> Floats:
    """Return the angles of the triangles at their corners, shape (m, 3) [deg]."""
    corners = mesh.vertices[mesh.faces]
    to_next, to_last = np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners
    cosine = (unit(to_next) * unit(to_last)).sum(axis=2)
    return np.asarray(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))


def edge_lengths(mesh: Mesh) -> Floats:
    """Return the lengths of the sides of the triangles, shape (m, 3) [mm]."""
    corners = mesh.vertices[mesh.faces]
    return np.asarray(np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2))


def crossing_faces(mesh: Mesh) -> Flags:
    """Return which triangles intersect another one of the mesh, shape (m,).

    Two triangles cross where an edge of one passes through the other; those that share a corner too. Which
    side of a line another line passes on is told by their Pluecker coordinates; touching is no crossing.
    """
    points = mesh.vertices - mesh.vertices.mean(axis=0)
    edges, of_face = sides(mesh)
    start, end = points[edges[:, 0]], points[edges[:, 1]]
    corners = points[mesh.faces]
    after = np.roll(corners, -1, axis=1)
    lines = np.hstack([end - start, np.cross(start, end)])
    past = np.einsum(
        "ei,mki->emk", lines, np.concatenate([np.cross(corners, after), after - corners], axis=2)
    )
    through = (past > 0.0).all(axis=2) | (past < 0.0).all(axis=2)
    level = (corners[:, 0] * mesh.area_vectors).sum(axis=1)
    through &= (start @ mesh.area_vectors.T - level) * (end @ mesh.area_vectors.T - level) < 0.0
    through &= (edges[:, None, :, None] != mesh.faces[None, :, None, :]).all(axis=(2, 3))
    return np.asarray(through.any(axis=0) | through.any(axis=1)[of_face].any(axis=1))


def sides(mesh: Mesh) -> tuple[Indices, Indices]:
    """Return every edge once, shape (e, 2), and which of them runs from each corner to the next, (m, 3)."""
    half = np.sort(np.stack([mesh.faces, np.roll(mesh.faces, -1, axis=1)], axis=2), axis=2).reshape(-1, 2)
    edges, number = np.unique(half, axis=0, return_inverse=True)
    return edges, np.asarray(number.reshape(-1, 3), dtype=np.int64)


def agreement(mesh: Mesh, skin: Mesh | SurfaceProjector) -> Floats:
    """Return the cosine between a triangle's normal and the mean one of the skin there, shape (m,) [1]."""
    near = skin if isinstance(skin, SurfaceProjector) else SurfaceProjector(skin)
    places = np.einsum("sc,mcj->msj", SAMPLES, mesh.vertices[mesh.faces])
    outward = unit(near.normals_at(places).sum(axis=1))
    return np.asarray((outward * mesh.face_normals).sum(axis=1))


def bends(mesh: Mesh) -> tuple[Indices, Indices, Floats]:
    """Return inner edges (e, 2), the two triangles at each (e, 2), and how much these are bent (e,) [deg]."""
    half = np.sort(np.concatenate([mesh.faces[:, [k, k - 2]] for k in range(3)]), axis=1)
    face = np.tile(np.arange(len(mesh.faces)), 3)
    order = np.lexsort(half.T)
    half, face = half[order], face[order]
    pair = np.flatnonzero((half[1:] == half[:-1]).all(axis=1))
    faces = np.column_stack([face[pair], face[pair + 1]])
    cosine = (mesh.face_normals[faces[:, 0]] * mesh.face_normals[faces[:, 1]]).sum(axis=1)
    return half[pair], faces, np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))


@dataclass(frozen=True, eq=False)
class Faults:
    """Which triangles of a fit are at fault, each of shape (m,): ``folded`` ones make it useless.

    They cut others, are bent back on their neighbour or face the wrong way; the ``doubtful`` are pointed or
    small, or face another way than the skin.
    """

    folded: Flags
    doubtful: Flags

    @property
    def any(self) -> Flags:
        """Return which triangles have any fault."""
        return np.asarray(self.folded | self.doubtful)

    @property
    def weight(self) -> tuple[int, int]:
        """Return how bad it is: to be compared."""
        return int(self.folded.sum()), int(self.any.sum())


def find_mesh_faults(mesh: Mesh, skin: SurfaceProjector, fold: Flags) -> Faults:
    """Find faulty triangles of a fit; only at ``fold`` points (n,) two may meet at a sharp angle."""
    same_way = agreement(mesh, skin)
    folded = crossing_faces(mesh) | (same_way <= BACKWARD)
    edge, faces, bend = bends(mesh)
    folded[faces[(bend > SHARPEST) & ~fold[edge].any(axis=1)].ravel()] = True
    doubtful = corner_angles(mesh).min(axis=1) <= SMALLEST_ANGLE
    doubtful |= (edge_lengths(mesh).min(axis=1) <= SHORTEST_EDGE) | (same_way <= SAME_WAY)
    return Faults(np.asarray(folded), np.asarray(doubtful))
