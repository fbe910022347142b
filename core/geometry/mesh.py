"""Triangle meshes: the one geometric value that all floors share."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy import sparse
from scipy.spatial import cKDTree

Points = npt.NDArray[np.float64]
"""Positions, shape (n, 3) [mm]."""

Faces = npt.NDArray[np.int64]
"""Corner indices of triangles, shape (m, 3), counter-clockwise seen from outside."""

Indices = npt.NDArray[np.int64]
Floats = npt.NDArray[np.float64]
Flags = npt.NDArray[np.bool_]


MAX_COORDINATE = 1e9
"""A coordinate beyond this [file units, mm] is a mistake: squares and cubes of it would not stay finite."""


def frozen(array: npt.ArrayLike, dtype: npt.DTypeLike = np.float64) -> npt.NDArray[np.float64]:
    """Return a contiguous read-only copy of ``array``."""
    result = np.array(array, dtype=dtype, order="C")
    result.setflags(write=False)
    return result


SIGNS = (1.0, -1.0)
"""Sign of x of the left and of the right side of a body."""


@dataclass(frozen=True, eq=False)
class _Topology:
    """What follows from the ``faces`` (m, 3) of a mesh alone, wherever its vertices are."""

    faces: Faces

    @cached_property
    def edges(self) -> Indices:
        return edges(self.faces)

    @cached_property
    def boundary_loops(self) -> tuple[Indices, ...]:
        return boundary_loops(self.faces)

    @cached_property
    def face_neighbours(self) -> Indices:
        return face_neighbours(self.faces)


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles in space, shape (n, 3) [mm] and (m, 3); the arrays are read-only copies."""

    vertices: Points
    faces: Faces
    _topology: _Topology | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "vertices", frozen(self.vertices))
        if self._topology is None:
            object.__setattr__(self, "_topology", _Topology(frozen(self.faces, np.int64).view(np.int64)))
        object.__setattr__(self, "faces", self._shared.faces)

    @property
    def _shared(self) -> _Topology:
        assert self._topology is not None
        return self._topology

    def moved(self, vertices: Points) -> Mesh:
        """Return the same triangles at other positions, shape (n, 3) [mm]."""
        return Mesh(vertices, self.faces, self._topology)

    @cached_property
    def area_vectors(self) -> Points:
        """Return face normals times face areas, shape (m, 3) [mm^2]."""
        return area_vectors(self.vertices, self.faces)

    @cached_property
    def face_areas(self) -> Floats:
        """Return triangle areas, shape (m,) [mm^2]."""
        return np.asarray(np.linalg.norm(self.area_vectors, axis=1))

    @cached_property
    def face_normals(self) -> Points:
        """Return outward unit normals of the faces, shape (m, 3) [1]; zero for a degenerate face."""
        return unit(self.area_vectors)

    @cached_property
    def vertex_normals(self) -> Points:
        """Return area-weighted unit normals of the vertices, shape (n, 3) [1]."""
        return unit(incidence(self.faces, len(self.vertices)) @ self.area_vectors)

    @property
    def edges(self) -> Indices:
        """Return every edge once, lower index first, shape (e, 2)."""
        return self._shared.edges

    @property
    def boundary_loops(self) -> tuple[Indices, ...]:
        """Return closed loops of border vertices in face order, longest first; empty for a closed mesh."""
        return self._shared.boundary_loops

    @property
    def face_neighbours(self) -> Indices:
        """Return the triangle beyond each side 0-1, 1-2, 2-0 of the faces, -1 if there is none, (m, 3)."""
        return self._shared.face_neighbours

    @cached_property
    def centroid_tree(self) -> cKDTree:
        """Return a tree of the centroids of the faces, quick to build, for ``nearest_faces`` to search."""
        return cKDTree(self.vertices[self.faces].mean(axis=1), compact_nodes=False, balanced_tree=False)

    def enclosed_volume(self, apex: npt.ArrayLike = (0.0, 0.0, 0.0)) -> float:
        """Return the signed volume of the cone over the faces from ``apex`` [mm^3].

        For a closed mesh wound outward this is its volume, whatever the apex.
        """
        corners = self.vertices[self.faces] - np.asarray(apex, dtype=np.float64)
        return float(np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))) / 6.0


def submesh(mesh: Mesh, kept: Flags) -> Mesh:
    """Return the ``kept`` (m,) faces of a mesh with the vertices that they use."""
    used, faces = own_vertices(mesh.faces[kept], len(mesh.vertices))
    return Mesh(mesh.vertices[used], faces)


def own_vertices(faces: Faces, count: int) -> tuple[Indices, Faces]:
    """Return which of ``count`` vertices ``faces`` (m, 3) use, (k,), and the faces of these numbers."""
    used = np.zeros(count, dtype=bool)
    used[faces] = True
    return np.flatnonzero(used), (np.cumsum(used) - 1)[faces]


def quadric_terms(u: Floats, v: Floats) -> Floats:
    """Return what a quadric height over the plane at places ``u``, ``v`` is made of, shape (.., 6)."""
    return np.stack([np.ones_like(u), u, v, u * u, u * v, v * v], axis=-1)


def unit(vectors: Points) -> Points:
    """Return ``vectors``, shape (n, 3), scaled to length 1; zero vectors stay zero."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(vectors / np.where(length > 0.0, length, 1.0))


def area_vectors(vertices: Points, faces: Faces) -> Points:
    """Return half the cross product of two sides of each face, shape (m, 3) [mm^2]."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return np.asarray(0.5 * np.cross(b - a, c - a))


def sample_surface(vertices: Points, faces: Faces, areas: Floats, count: int) -> tuple[Points, Indices]:
    """Return places strewn evenly over faces of known ``areas``, shape (count, 3), and the face of each.

    The same each time, and as even whatever the order and the size of the faces. Source: ours.
    """
    low, high = vertices[faces[:, 0]].min(axis=0), vertices[faces[:, 0]].max(axis=0)
    cell = max(np.sqrt(areas.sum() / count), float((high - low).max()) / 1000.0, 1e-300)
    column, row, level = np.floor((vertices[faces[:, 0]] - low) / cell).astype(np.int64).T
    order = np.argsort((column * 1024 + row) * 1024 + level, kind="stable")  # a step stays in one place
    total = np.cumsum(areas[order])
    number = np.arange(count)
    face = order[np.searchsorted(total, (number + 0.5) / count * total[-1])]
    u, v = (0.7549 * number) % 1.0, (0.5698 * number) % 1.0  # an even sequence in the unit square
    over = u + v > 1.0
    u, v = np.where(over, 1.0 - u, u), np.where(over, 1.0 - v, v)
    a, b, c = (vertices[faces[face, k]] for k in range(3))
    return np.asarray(a + u[:, None] * (b - a) + v[:, None] * (c - a)), face


def rows_of(ends: Indices, start: int, stop: int) -> Indices:
    """Return the row of each of the items ``start`` to ``stop``, where rows end before the items ``ends``."""
    first, last = np.searchsorted(ends, [start, stop - 1], side="right")
    rows = np.arange(first, last + 1)
    return np.repeat(rows, np.diff(np.minimum(ends[rows], stop), prepend=start))


def incidence(faces: Faces, vertex_count: int) -> sparse.csr_array:
    """Return the 0/1 matrix that sums face values at vertices, shape (vertex_count, m)."""
    columns = np.repeat(np.arange(len(faces)), 3)
    ones = np.ones(faces.size)
    return sparse.csr_array((ones, (faces.ravel(), columns)), shape=(vertex_count, len(faces)))


def half_edges(faces: Faces) -> Indices:
    """Return the directed sides of all faces, shape (3 m, 2): first those from corner 0 to 1 of each."""
    return np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])


def _edge_keys(half_edges: Indices) -> Indices:
    """Return one number for each edge, the same in both directions, ordered as its vertices are."""
    ends = np.sort(half_edges, axis=1)
    return np.asarray(ends[:, 0] * (ends[:, 1].max(initial=0) + 1) + ends[:, 1])


def edges(faces: Faces) -> Indices:
    """Return every edge of ``faces`` once, lower index first, in the order of its vertices, shape (e, 2)."""
    sides = half_edges(faces)
    _, first = np.unique(_edge_keys(sides), return_index=True)
    return np.sort(sides[first], axis=1)


def face_neighbours(faces: Faces) -> Indices:
    """Return the triangle beyond each side 0-1, 1-2, 2-0 of ``faces`` (m, 3), -1 at a border, (m, 3).

    Beyond a side of more than two triangles there is none.
    """
    sides = half_edges(faces)
    low, high = sides.min(axis=1), sides.max(axis=1)
    key = low * (high.max(initial=0) + 1) + high
    order = np.argsort(key, kind="stable")
    ordered = key[order]
    same = ordered[1:] == ordered[:-1]
    alone = np.append(True, ~same[:-1]) & np.append(~same[1:], True)
    first = np.flatnonzero(same & alone)
    beyond = np.full(len(key), -1, dtype=np.int64)
    one, two = order[first], order[first + 1]
    beyond[one], beyond[two] = two % len(faces), one % len(faces)
    return beyond.reshape(3, -1).T


def boundary_loops(faces: Faces) -> tuple[Indices, ...]:
    """Return the closed loops of border vertices of ``faces``, longest first."""
    half = half_edges(faces)
    _, first, count = np.unique(_edge_keys(half), return_index=True, return_counts=True)
    after: dict[int, list[int]] = defaultdict(list)
    for start, end in half[first[count == 1]].tolist():
        after[start].append(end)
    loops = []
    while after:
        start = next(iter(after))
        loop = [start]
        while loop[-1] in after:
            ends = after[loop[-1]]
            following = ends.pop()
            if not ends:
                del after[loop[-1]]
            if following == start:
                break
            loop.append(following)
        loops.append(np.array(loop, dtype=np.int64))
    return tuple(sorted(loops, key=len, reverse=True))
