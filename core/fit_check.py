"""What a fitted control mesh must fulfil, so that lines, volume and t-FFD work on it."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from core.mesh import Flags, Floats, Indices, Mesh, frozen, unit

SMALLEST_ANGLE = 8.0
"""Smallest angle of a triangle [deg]."""

SHORTEST_EDGE = 10.0
"""Shortest edge [mm]."""

SAME_WAY = 0.3
"""Smallest cosine between a triangle's normal and the mean normal of the skin behind it."""

SAMPLES = frozen([[8, 2, 2], [2, 8, 2], [2, 2, 8], [2, 5, 5], [5, 2, 5], [5, 5, 2]]) / 12.0
"""The skin behind a triangle is looked up from these places, as shares of its corners."""


def corner_angles(mesh: Mesh) -> Floats:
    """Return the angles of the triangles at their corners, shape (m, 3) [deg]."""
    corners = mesh.vertices[mesh.faces]
    to_next, to_last = np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners
    cosine = (unit(to_next) * unit(to_last)).sum(axis=2)
    return np.asarray(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))


def agreement(mesh: Mesh, skin: Mesh) -> Floats:
    """Return the cosine between a triangle's normal and the mean one of the skin there, shape (m,) [1]."""
    places = np.einsum("sc,mcj->msj", SAMPLES, mesh.vertices[mesh.faces])
    near = cKDTree(skin.vertices).query(places)[1]
    outward = unit(skin.vertex_normals[near].sum(axis=1))
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


def faulty_faces(mesh: Mesh, skin: Mesh, fold: Flags) -> Flags:
    """Tell which triangles are too flat, too small or face the wrong way, shape (m,).

    ``fold`` (n,) marks the points of the fold row: only there two triangles may meet at less than 90 degrees.
    """
    corners = mesh.vertices[mesh.faces]
    edges = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
    faulty = (corner_angles(mesh).min(axis=1) <= SMALLEST_ANGLE) | (edges.min(axis=1) <= SHORTEST_EDGE)
    faulty |= agreement(mesh, skin) <= SAME_WAY
    edge, faces, bend = bends(mesh)
    folded = (bend > 90.0) & ~fold[edge].any(axis=1)
    faulty[faces[folded].ravel()] = True
    return np.asarray(faulty)
