"""A skin cut along a plane, and one half of it mirrored onto the other."""

from __future__ import annotations

import numpy as np

from core.geometry.mesh import Faces, Flags, Floats, Indices, Mesh, Points
from core.geometry.mirror_plane import mirror
from core.scan.repair.editable_mesh import EditableMesh

SNAP = 0.15
"""Vertices nearer to the plane than this part of the median edge are moved onto it: no slivers [1]."""

SPECK = 0.01
"""Pieces that a cut leaves with less than this part of the largest one's area are dropped [1]."""


def clip_above(
    mesh: Mesh, axis: int, level: float, sign: float = 1.0, snap: float = SNAP
) -> tuple[Mesh, Flags]:
    """Return the part of a mesh [mm] beyond a plane, and which of its vertices, shape (n,), are on the plane.

    On the plane the coordinate ``axis`` is ``level``; what is kept is on the side of ``sign``.
    Triangles across the plane are cut. Source: ours.
    """
    height = sign * (mesh.vertices[:, axis] - level)
    near = np.abs(height) <= snap * _median_side(mesh)
    height = np.where(near, 0.0, height)
    vertices = mesh.vertices.copy()
    vertices[near, axis] = level
    up = height[mesh.faces] > 0.0
    down = height[mesh.faces] < 0.0
    whole = mesh.faces[up.any(axis=1) & ~down.any(axis=1)]
    one = _turned(mesh.faces, up, (up.sum(axis=1) == 1) & down.any(axis=1))
    two = _turned(mesh.faces, down, (up.sum(axis=1) == 2) & down.any(axis=1))
    starts = np.concatenate([one[:, 0], one[:, 0], two[:, 0], two[:, 0]])
    ends = np.concatenate([one[:, 1], one[:, 2], two[:, 1], two[:, 2]])
    cut, places = _cuts(vertices, height, starts, ends)
    places[:, axis] = level
    first, second, third, fourth = np.split(cut, np.cumsum([len(one), len(one), len(two)]))
    faces = [
        whole,
        np.stack([one[:, 0], first, second], axis=1),
        np.stack([third, two[:, 1], two[:, 2]], axis=1),
        np.stack([third, two[:, 2], fourth], axis=1),
    ]
    skin = EditableMesh(np.concatenate([vertices, places]), np.concatenate(faces)).compact()
    if len(skin.faces):
        skin = skin.without_pieces(skin.piece_areas < SPECK * skin.piece_areas.max())
    return Mesh(skin.vertices, skin.faces), skin.vertices[:, axis] == level


def mirrored_half(mesh: Mesh, middle: float, sign: float) -> Mesh:
    """Return one half of a mesh [mm] with its mirror image, joined along the plane x = ``middle``.

    ``sign`` is 1 to keep the left half (+x), -1 to keep the right one.
    """
    for snap in (SNAP, 0.0):
        half, seam = clip_above(mesh, 0, middle, sign, snap)
        whole = _with_image(half, seam, middle)
        if len(whole.faces) == 0 or EditableMesh(whole.vertices, whole.faces).sides.count.max() <= 2:
            break
    return whole


def _with_image(half: Mesh, seam: Flags, middle: float) -> Mesh:
    twin = np.where(seam, np.arange(len(seam)), len(seam) + np.cumsum(~seam) - 1)
    image = mirror(half.vertices[~seam], middle)
    faces = np.concatenate([half.faces, twin[half.faces][:, ::-1]])
    return Mesh(np.concatenate([half.vertices, image]), faces)


def _turned(faces: Faces, marked: Flags, chosen: Flags) -> Faces:
    """Return the ``chosen`` faces, shape (k, 3), each with its one ``marked`` corner first."""
    first = np.argmax(marked[chosen], axis=1)
    return np.take_along_axis(faces[chosen], (first[:, None] + np.arange(3)) % 3, axis=1)


def _cuts(vertices: Points, height: Floats, starts: Indices, ends: Indices) -> tuple[Indices, Points]:
    """Return the vertex at which each edge meets the plane, shape (k,), and the places of the new ones.

    An edge that ends on the plane meets it there.
    """
    crossing = height[ends] != 0.0
    edges = np.sort(np.stack([starts, ends], axis=1)[crossing], axis=1)
    unique, number = np.unique(edges, axis=0, return_inverse=True)
    a, b = unique.T
    share = (height[a] / (height[a] - height[b]))[:, None]
    places = vertices[a] + share * (vertices[b] - vertices[a])
    cut = ends.copy()
    cut[crossing] = len(vertices) + number.ravel()
    return cut, places


def _median_side(mesh: Mesh) -> float:
    corners = mesh.vertices[mesh.faces[:: max(1, len(mesh.faces) // 20_000)]]
    return (
        float(np.median(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)))
        if len(corners)
        else 0.0
    )
