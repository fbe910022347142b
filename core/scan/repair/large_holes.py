"""Large holes of a skin, filled by hand: a patch as fine as the skin round it that follows its curvature."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from core.geometry.mesh import Faces, Floats, Indices, Mesh, Points, edges
from core.geometry.triangulate import triangulate
from core.scan.repair.hole_filling import edge_keys, edges_at, quadric_height
from core.scan.repair.holes import Hole, frame_of

MOST_STEPS = 100.0
"""A patch has at most so many vertices from side to side [1]."""

AROUND = 30.0
"""The skin within half a hole's length and this beyond its border tells how a patch bends [mm]."""

MOST_AROUND = 20_000
"""So many vertices round a hole are used for that."""

FEW = 8
"""A border of so few corners needs no vertex inside it [1]."""

RINGS = 2
"""So many rings of triangles round a hole give a patch its slope and curvature at the border."""


def fill_large_holes(mesh: Mesh, holes: Sequence[Hole]) -> tuple[Mesh, Indices, int]:
    """Return a mesh [mm] with ``holes`` filled, its new vertices, shape (k,), and how many stay open.

    Old vertices keep their numbers. A hole stays open if its border touches itself. Source: ours; the patch
    minimises the squared Laplacian, as Botsch and Kobbelt 2004.
    """
    faces, places, count = [mesh.faces], [mesh.vertices], len(mesh.vertices)
    borders = np.concatenate([*(hole.border for hole in holes), np.empty(0, dtype=np.int64)])
    edges, still_open = edges_at(borders, mesh.faces), 0
    for hole in holes:
        if len(hole.border) < 3 or len(set(hole.border.tolist())) < len(hole.border):
            still_open += 1
            continue
        for laid_out in (False, True):
            patch, new = _patch(mesh, hole.border, laid_out)
            corners = np.concatenate([hole.border, count + np.arange(len(new))])[patch]
            inner = set(edge_keys(corners).tolist()) - set(edge_keys(hole.border[None]).tolist())
            if inner.isdisjoint(edges):
                break
        else:  # a patch would join what is joined already
            still_open += 1
            continue
        edges |= inner
        faces.append(corners)
        places.append(new)
        count += len(new)
    new_ones = np.arange(len(mesh.vertices), count)
    return Mesh(np.concatenate(places), np.concatenate(faces)), new_ones, still_open


def _patch(mesh: Mesh, border: Indices, laid_out: bool) -> tuple[Faces, Points]:
    """Return triangles over a hole and the places in it, shape (k, 3); corners below b are of the border.

    ``laid_out`` round a circle, a border may have any shape; as seen from outside it must not cross itself.
    """
    axes, extent = frame_of(mesh.vertices[border])
    middle, length = mesh.vertices[border].mean(axis=0), float(extent[:2].max())
    rim = _rim(mesh, border)
    known = (mesh.vertices[rim.vertices] - middle) @ axes.T
    patch, inside = _triangles(known[: len(border), :2], length)
    if laid_out or (len(inside) == 0 and len(border) > FEW):
        patch, inside = _triangles(_circle(known[: len(border)]), 0.0)
        local = _settled(rim, patch, np.full((len(inside), 3), np.nan), known, known)
        local = _settled(rim, patch, local, known, known)
        return patch, middle + local @ axes
    bend = quadric_height(_around(mesh, middle, axes, length), max(length, 1e-9))
    start = np.column_stack([inside, bend(inside)])
    off = known[:, 2:] - bend(known[:, :2])[:, None]
    start[:, 2:] += _settled(rim, patch, start, known, off)
    return patch, middle + start @ axes


@dataclass(frozen=True, eq=False)
class _Rim:
    """The skin round a hole: ``vertices``, shape (r,), the ``border`` ones first, and faces of them."""

    vertices: Indices
    faces: Faces
    border: int


def _rim(mesh: Mesh, border: Indices) -> _Rim:
    touched = np.zeros(len(mesh.vertices), dtype=bool)
    touched[border] = True
    for _ in range(RINGS):
        faces = mesh.faces[touched[mesh.faces].any(axis=1)]
        touched[faces] = True
    touched[border] = False
    vertices = np.concatenate([border, np.flatnonzero(touched)])
    number = np.zeros(len(mesh.vertices), dtype=np.int64)
    number[vertices] = np.arange(len(vertices))
    return _Rim(vertices, number[faces], len(border))


def _triangles(outline: Floats, length: float) -> tuple[Faces, Floats]:
    """Triangulate a border, shape (b, 2), that runs against its hole, and strew places in it."""
    faces, inside = triangulate(outline[::-1], length / MOST_STEPS)
    return np.where(faces < len(outline), len(outline) - 1 - faces, faces), inside


def _circle(places: Points) -> Floats:
    """Lay the border of a hole out round a circle of its length, shape (b, 2), against its hole."""
    side = np.linalg.norm(np.roll(places, -1, axis=0) - places, axis=1)
    angle = -2.0 * np.pi * (np.cumsum(side) - side) / side.sum()
    return np.asarray(side.sum() / (2.0 * np.pi) * np.stack([np.cos(angle), np.sin(angle)], axis=1))


def _around(mesh: Mesh, middle: Points, axes: Floats, length: float) -> Points:
    """Return the skin round a hole that looks the same way, in the frame of the hole, shape (k, 3)."""
    local = (mesh.vertices - middle) @ axes.T
    near = (np.linalg.norm(local, axis=1) < 0.75 * length + AROUND) & (mesh.vertex_normals @ axes[2] > 0.3)
    near = np.flatnonzero(near & (np.abs(local[:, 2]) < length))
    return np.asarray(local[near[:: max(1, len(near) // MOST_AROUND)]])


def _settled(rim: _Rim, patch: Faces, start: Points, known: Points, values: Floats) -> Floats:
    """Return the values inside a patch, shape (k, d), that continue those of its rim, shape (r, d), smoothly.

    ``start``, shape (k, 3), are rough places inside, NaN where there are none yet; ``known``, shape (r, 3),
    those of the rim.
    """
    b, k = rim.border, len(start)
    if k == 0:
        return np.empty((0, values.shape[1]))
    places = np.concatenate([known[:b], start, known[b:]])
    faces = np.concatenate([patch, np.where(rim.faces < b, rim.faces, rim.faces + k)])
    ends = edges(faces)
    side = np.linalg.norm(places[ends[:, 0]] - places[ends[:, 1]], axis=1)
    pull = (
        1.0 / np.maximum(side, 1e-3 * np.nanmedian(side)) if np.isfinite(side).all() else np.ones(len(side))
    )
    n = len(places)
    joined = sparse.coo_array((pull, (ends[:, 0], ends[:, 1])), shape=(n, n)).tocsr()
    joined = joined + joined.T
    many = np.maximum(np.bincount(ends.ravel(), minlength=n), 1)
    laplacian = sparse.diags_array(1.0 / many) @ (sparse.diags_array(joined.sum(axis=1)) - joined)
    rows = laplacian.tocsr()[: b + k].tocsc()
    free, outer = rows[:, b : b + k], sparse.hstack([rows[:, :b], rows[:, b + k :]])
    return np.asarray(splu((free.T @ free).tocsc()).solve(-(free.T @ (outer @ values))), dtype=np.float64)
