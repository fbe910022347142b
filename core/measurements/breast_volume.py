"""A breast: the skin within its root, the chest behind it, and the volume between the two."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from core.geometry.mesh import Faces, Flags, Floats, Indices, Mesh, Points, area_vectors, boundary_loops
from core.geometry.plane_sections import resample
from core.measurements.breast_root import Root, Side
from core.measurements.chest_wall import ChestWall, UnrolledTorso, fit_chest_wall

BAND = 4.0
"""Skin so near to the root counts as lying on it [mm], on coarse skins further."""


FACING = 0.3
"""Skin of the chest looks outward at least so much [cosine]."""

RIM = 8.0
"""So near to the edge of the piece of skin that is looked at lies its rim [mm]."""


@dataclass(frozen=True, eq=False)
class Breast:
    """One breast of a body at rest: its skin is ``faces`` of the body, shape (m, 3).

    ``volume`` is that between skin and chest [mm^3]; ``holed`` tells that the scan has a hole there.
    """

    faces: Faces
    volume: float
    holed: bool

    @cached_property
    def vertices(self) -> Indices:
        """Return the vertices of its skin, shape (k,)."""
        return np.unique(self.faces)


def breast_of(side: Side, root: Root) -> Breast | None:
    """Return the breast within a root.

    None if the root does not part it from the chest, or the chest round it does not show.
    """
    chart, piece, uvw = side.chart, side.piece, side.uvw
    band = _band(piece, root)
    edges = piece.edges
    label = _pieces(len(uvw), edges[~band[edges].any(axis=1)])
    away = np.where(band, np.inf, ((piece.vertices - side.bust_point) ** 2).sum(axis=1))
    own = ~band & (label == label[np.argmin(away)])
    flat = uvw[:, :2]
    rim = ((flat < flat.min(axis=0) + RIM) | (flat > flat.max(axis=0) - RIM)).any(axis=1)
    if band.all() or (own & rim).any():
        return None  # the skin goes on from the breast to the rim: the root is open
    outside = ~band & ~own
    facing = np.einsum("ij,ij->i", piece.vertex_normals, chart.outward(piece.vertices)) > FACING
    wall = fit_chest_wall(chart, uvw[outside & facing], chart.unroll(root.loop))
    if wall is None:
        return None
    inside = piece.faces[(own | band)[piece.faces].all(axis=1)]
    holes = [loop for loop in boundary_loops(inside) if own[loop].any()]
    volume = _volume(chart, wall, *_filled(piece.vertices, inside, holes))
    return Breast(side.rows[inside], volume, bool(holes))


def _filled(places: Points, faces: Faces, holes: Sequence[Indices]) -> tuple[Points, Faces]:
    """Return places and faces with a fan over each hole, whose border loops are given in face order."""
    for loop in holes:
        tip = np.full(len(loop), len(places))
        places = np.concatenate([places, places[loop].mean(axis=0, keepdims=True)])
        faces = np.concatenate([faces, np.stack([np.roll(loop, -1), loop, tip], axis=1)])
    return places, faces


def _volume(chart: UnrolledTorso, wall: ChestWall, places: Points, faces: Faces) -> float:
    """Return the volume between the skin ``faces`` and the wall [mm^3].

    A flow away from the axis that grows by its own volume everywhere and is nil on the wall passes the skin:
    what passes is the volume (divergence theorem), of overhanging parts too. The exact course of the root
    hardly matters, as skin and wall meet there. Source: ours.
    """
    rows, faces = np.unique(faces, return_inverse=True)
    skin, faces = places[rows], faces.reshape(-1, 3)
    flat = chart.unroll(skin)
    far = np.maximum(flat[:, 2], 1.0)
    strength = (far**2 - wall.out(flat[:, :2]) ** 2) / (2.0 * far)
    flow = strength[:, None] * chart.outward(skin)
    return float(np.einsum("ij,ij->", flow[faces].mean(axis=1), area_vectors(skin, faces)))


def _band(piece: Mesh, root: Root) -> Flags:
    """Return which vertices lie on the root, wide enough for no edge to leap over it."""
    away = np.asarray(cKDTree(resample(root.closed, 1.5)).query(piece.vertices)[0])
    close = piece.vertices[piece.edges[(away[piece.edges] < 4.0 * BAND).any(axis=1)]]
    length = np.linalg.norm(close[:, 0] - close[:, 1], axis=1)
    return np.asarray(away < max(BAND, 0.6 * float(np.percentile(length, 99.0)) if len(length) else BAND))


def _pieces(count: int, edges: Indices) -> Indices:
    graph = sparse.coo_array((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(count, count))
    return np.asarray(connected_components(graph, directed=False)[1])


def foremost(places: Points) -> Points:
    """Return the foremost place, shape (3,) [mm]: a mean that favours what lies foremost."""
    weight: Floats = np.exp(places[:, 1].min() - places[:, 1])
    return np.asarray(weight @ places / weight.sum())
