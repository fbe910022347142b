"""Layers of tetrahedra between a skin and the wall under it, with quadratic shape functions."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse

from core.geometry.closest_point import barycentric, nearest_faces
from core.geometry.mesh import Floats, Indices, Mesh, Points

LAYERS = 2

_MENDS = 30
"""So often at most is a wall moved where prisms are turned inside out."""

EDGES = np.array([[0, 1], [1, 2], [0, 2], [0, 3], [1, 3], [2, 3]])
"""Corners of a tetrahedron between which its middle nodes 4 to 9 lie."""


@dataclass(frozen=True, eq=False)
class Tetrahedra:
    """Straight tetrahedra with a node in the middle of each edge.

    ``corners`` (n, 3) [mm], wall first, skin last; ``edges`` (e, 2) between them; node n + k is the middle of
    edge k. ``nodes`` (t, 10) of each tetrahedron, corners first.
    """

    skin: Mesh
    corners: Points
    edges: Indices
    nodes: Indices

    @property
    def node_count(self) -> int:
        """Return the number of nodes, middles included."""
        return len(self.corners) + len(self.edges)

    @cached_property
    def skin_nodes(self) -> Indices:
        """Return the nodes on the skin, middles included, ascending, shape (s,)."""
        top = len(self.corners) - len(self.skin.vertices)
        middles = self._edge_numbers(self.skin.edges + top)
        return np.concatenate([np.arange(top, len(self.corners)), len(self.corners) + np.sort(middles)])

    def finer_skin(self) -> Mesh:
        """Return the skin with ``skin_nodes`` as its vertices, four triangles to a face."""
        top = len(self.corners) - len(self.skin.vertices)
        nodes = np.concatenate([self.corners, self.corners[self.edges].mean(axis=1)])
        corner = self.skin.faces + top
        pairs = np.sort(corner[:, [[0, 1], [1, 2], [2, 0]]], axis=2)
        middle = len(self.corners) + self._edge_numbers(pairs.reshape(-1, 2)).reshape(-1, 3)
        (a, b, c), (ab, bc, ca) = corner.T, middle.T
        parts = ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))
        faces = np.concatenate([np.stack(part, axis=1) for part in parts])
        return Mesh(nodes[self.skin_nodes], np.searchsorted(self.skin_nodes, faces))

    def volumes(self) -> Floats:
        """Return the signed volumes of the tetrahedra, shape (t,) [mm^3]."""
        a, b, c, d = (self.corners[self.nodes[:, k]] for k in range(4))
        return np.asarray(np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6.0)

    def skin_rows(self, places: Points) -> sparse.csr_array:
        """Return the share of each node in the skin nearest to ``places`` (k, 3) [mm], (k, nodes) [1]."""
        face, foot = nearest_faces(self.skin, places)
        share = np.clip(barycentric(self.skin.vertices[self.skin.faces[face]], foot), 0.0, 1.0)
        share /= share.sum(axis=1, keepdims=True)
        top = len(self.corners) - len(self.skin.vertices)
        corner = self.skin.faces[face] + top
        pairs = np.sort(corner[:, [[0, 1], [1, 2], [2, 0]]], axis=2)
        middle = len(self.corners) + self._edge_numbers(pairs.reshape(-1, 2)).reshape(-1, 3)
        values = np.hstack([share * (2.0 * share - 1.0), 4.0 * share * np.roll(share, -1, axis=1)])
        rows = np.repeat(np.arange(len(places)), 6)
        where = (rows, np.hstack([corner, middle]).ravel())
        shape = (len(places), self.node_count)
        return sparse.csr_array(sparse.coo_array((values.ravel(), where), shape=shape))

    def _edge_numbers(self, pairs: Indices) -> Indices:
        key = self.edges[:, 0] * len(self.corners) + self.edges[:, 1]  # ascending, as the edges are
        return np.asarray(np.searchsorted(key, pairs[:, 0] * len(self.corners) + pairs[:, 1]))


def layered_tetrahedra(skin: Mesh, wall: Points, layers: int = LAYERS) -> Tetrahedra:
    """Fill the space between ``wall``, shape (n, 3) [mm], and ``skin`` with prisms of three tetrahedra each.

    Where prisms are turned inside out, the wall is moved to lie under the skin as it does around. Raises
    ValueError if that does not help. Source: prisms are split by the numbers of their corners, so that
    neighbours share their diagonals (Dompierre 1999).
    """
    for _ in range(_MENDS):
        made = _split(skin, wall, layers)
        turned = np.unique(made.nodes[made.volumes() <= 0.0][:, :4] % len(wall))
        if not len(turned):
            return made
        wall = _evened(skin, wall, turned)
    raise ValueError("the chest wall crosses the skin")


def _evened(skin: Mesh, wall: Points, places: Indices) -> Points:
    """Return ``wall`` with ``places`` as far from the skin, and in the direction, as their neighbours."""
    ends = np.concatenate([skin.edges, skin.edges[:, ::-1]])
    count = np.bincount(ends[:, 0], minlength=len(wall))
    depth = skin.vertices - wall
    around = np.stack([np.bincount(ends[:, 0], axis[ends[:, 1]], len(wall)) for axis in depth.T], axis=1)
    wall = np.array(wall)
    wall[places] = skin.vertices[places] - around[places] / count[places, None]
    return wall


def _split(skin: Mesh, wall: Points, layers: int) -> Tetrahedra:
    """Return three tetrahedra for each face and layer, however they are turned."""
    count = len(wall)
    corners = np.concatenate([wall + (skin.vertices - wall) * (k / layers) for k in range(layers + 1)])
    ascending = np.sort(skin.faces, axis=1)
    odd_face = _is_odd(skin.faces)
    parts = []
    for layer in range(layers):
        a, b, c = (ascending + count * layer).T
        up_a, up_b, up_c = (ascending + count * (layer + 1)).T
        for odd, four in (
            (False, (a, b, c, up_c)),
            (True, (a, b, up_b, up_c)),
            (False, (a, up_a, up_b, up_c)),
        ):
            part = np.stack(four, axis=1)
            flipped = odd_face != odd
            part[flipped] = part[flipped][:, [1, 0, 2, 3]]
            parts.append(part)
    cells = np.concatenate(parts)
    pairs = np.sort(cells[:, EDGES].reshape(-1, 2), axis=1)
    keys, number = np.unique(pairs[:, 0] * len(corners) + pairs[:, 1], return_inverse=True)
    edges = np.stack(np.divmod(keys, len(corners)), axis=1)
    return Tetrahedra(skin, corners, edges, np.hstack([cells, len(corners) + number.reshape(-1, 6)]))


def _is_odd(faces: Indices) -> np.ndarray:
    """Return which faces do not have their corners in ascending order, up to a rotation, shape (m,)."""
    first = faces.argmin(axis=1)
    rows = np.arange(len(faces))
    return np.asarray(faces[rows, (first + 1) % 3] > faces[rows, (first + 2) % 3])
