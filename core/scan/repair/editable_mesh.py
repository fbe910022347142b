"""A skin under repair: triangles in any unit, and which of them meet along which sides."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from core.geometry.mesh import Faces, Flags, Floats, Indices, Points, area_vectors


@dataclass(frozen=True, eq=False)
class EditableMesh:
    """Vertices, shape (n, 3) [any unit], and triangles, shape (m, 3), in no way sound yet."""

    vertices: Points
    faces: Faces

    @cached_property
    def sides(self) -> Sides:
        """Return which sides of triangles are on the same edge."""
        return match_sides(self.faces, len(self.vertices))

    @cached_property
    def area_vectors(self) -> Points:
        """Return face normals times face areas, shape (m, 3)."""
        return area_vectors(self.vertices, self.faces)

    @cached_property
    def areas(self) -> Floats:
        """Return areas of the triangles, shape (m,)."""
        return np.asarray(np.sqrt(np.einsum("ij,ij->i", self.area_vectors, self.area_vectors)))

    @cached_property
    def centres(self) -> Points:
        """Return centres of the triangles, shape (m, 3)."""
        a, b, c = (self.vertices[self.faces[:, k]] for k in range(3))
        return np.asarray((a + b + c) / 3.0)

    @cached_property
    def piece(self) -> Indices:
        """Return the number of the piece that each triangle belongs to, 0 .. k-1: pieces share no edge."""
        first, second, _ = self.sides.neighbours
        return components(first, second, len(self.faces))

    @cached_property
    def piece_areas(self) -> Floats:
        """Return areas of the pieces, shape (k,)."""
        return np.asarray(np.bincount(self.piece, self.areas), dtype=np.float64)

    def with_faces(self, keep: Flags) -> EditableMesh:
        """Return the skin of the triangles ``keep``, shape (m,), and of their vertices alone."""
        return self if keep.all() else EditableMesh(self.vertices, self.faces[keep]).compact()

    def without_pieces(self, dropped: Flags) -> EditableMesh:
        """Return the skin without the pieces ``dropped``, shape (k,)."""
        return self.with_faces(~dropped[self.piece]) if dropped.any() else self

    def with_vertices(self, keep: Flags) -> EditableMesh:
        """Return the skin of the vertices ``keep``, shape (n,), and of the triangles between them."""
        if keep.all():
            return self
        faces = self.faces[keep[self.faces].all(axis=1)]
        return EditableMesh(self.vertices[keep], (np.cumsum(keep) - 1)[faces])

    def compact(self) -> EditableMesh:
        """Return the skin without vertices outside any triangle."""
        used = np.zeros(len(self.vertices), dtype=bool)
        used[self.faces] = True
        return self.with_vertices(used)


@dataclass(frozen=True, eq=False)
class Sides:
    """The sides of m triangles: side k of triangle f, from its corner k on, is number k m + f.

    ``order``, shape (3 m,), lists the sides edge by edge; edge i has ``count[i]`` of them, from ``start[i]``.
    """

    faces: Faces
    order: Indices
    start: Indices
    count: Indices

    @cached_property
    def neighbours(self) -> tuple[Indices, Indices, Flags]:
        """The triangles on both sides of each edge that has two, and whether they run against each other."""
        one, other = self._twos
        m = max(len(self.faces), 1)
        rising = (self.faces < np.roll(self.faces, -1, axis=1)).T.ravel()
        return one % m, other % m, rising[one] == rising[other]

    @cached_property
    def _twos(self) -> tuple[Indices, Indices]:
        first = self.start[self.count == 2]
        return self.order[first], self.order[first + 1]

    @cached_property
    def border(self) -> Indices:
        """Return numbers of the sides that no other triangle shares, ascending, shape (b,)."""
        return np.sort(self.order[self.start[self.count == 1]])

    def ends(self, side: Indices) -> tuple[Indices, Indices]:
        """Return the vertices that sides run from and to, each of shape (k,)."""
        corner, face = np.divmod(side, len(self.faces))
        return self.faces[face, corner], self.faces[face, (corner + 1) % 3]


def match_sides(faces: Faces, vertex_count: int) -> Sides:
    """Match the sides of ``faces``, shape (m, 3), with corners below ``vertex_count``."""
    m = len(faces)
    keys = np.empty(3 * m, dtype=np.int64)
    corners = [np.ascontiguousarray(faces[:, k]) for k in range(3)]
    for k in range(3):
        a, b = corners[k], corners[(k + 1) % 3]
        keys[k * m : (k + 1) * m] = np.minimum(a, b) * vertex_count + np.maximum(a, b)
    order, start = grouped(keys)
    return Sides(faces, order, start, np.diff(start, append=3 * m))


def grouped(keys: Indices) -> tuple[Indices, Indices]:
    """Return an order of ``keys``, shape (n,), none negative, and where each new key starts in it."""
    bits = max(len(keys) - 1, 1).bit_length()
    if len(keys) and int(keys.max()).bit_length() + bits < 63:
        # key and place in one number: sorting numbers is several times quicker than sorting places
        packed = np.sort((keys << bits) | np.arange(len(keys)))
        order, ranked = packed & ((1 << bits) - 1), packed >> bits
    else:
        order = np.argsort(keys, kind="stable")
        ranked = keys[order]
    new = np.ones(len(keys), dtype=bool)
    np.not_equal(ranked[1:], ranked[:-1], out=new[1:])
    return order, np.flatnonzero(new)


def first_equal(keys: Indices) -> Indices:
    """Return for each key the place of the first equal one, shape (n,)."""
    order, start = grouped(keys)
    first = np.empty(len(keys), dtype=np.int64)
    first[order] = np.repeat(order[start], np.diff(start, append=len(keys)))
    return first


def components(start: Indices, end: Indices, count: int) -> Indices:
    """Return the number of the connected part of each of ``count`` things that links join, shape (count,)."""
    ones = np.ones(len(start), dtype=np.int8)
    links = sparse.coo_array((ones, (start, end)), shape=(count, count)).tocsr()
    return np.asarray(connected_components(links, directed=False)[1], dtype=np.int64)
