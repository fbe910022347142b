"""What changes where a body moves: shading normals and the volume it encloses, without touching the rest."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse

from core.mesh import Faces, Indices, Mesh, Points, frozen, incidence, unit


@dataclass(frozen=True, eq=False)
class MovingFaces:
    """The faces of a body that move with some of its vertices; made by ``moving_faces``.

    ``faces`` are these faces, shape (a, 3), and ``vertices`` all their corners, shape (r,), ascending: the
    vertices whose normals change. ``sides`` are two operators, shape (a, N), that give the sides of each
    face from its first corner; ``gather``, shape (r, a), sums face values at ``vertices``; ``still`` is twice
    the area vectors of the other faces there, shape (r, 3) [mm^2].
    """

    body: Mesh
    faces: Faces
    vertices: Indices
    sides: tuple[sparse.csr_array, sparse.csr_array]
    gather: sparse.csr_array
    still: Points

    def normals(self, positions: Points) -> Points:
        """Return the unit normals of ``vertices``, shape (r, 3) [1], at ``positions``, shape (N, 3) [mm]."""
        return unit(self.still + self.gather @ self._spans(positions))

    def volume_change(self, positions: Points) -> float:
        """Return the volume gained since rest at ``positions``, shape (N, 3) [mm^3].

        Exact where no open border moves; a moving border is closed by a cone from the middle of the faces.
        """
        return self._cone(positions) - self._rest_cone

    @cached_property
    def _rest_cone(self) -> float:
        return self._cone(self.body.vertices)

    @cached_property
    def _apex(self) -> Points:
        return np.asarray(self.body.vertices[self.vertices].sum(axis=0) / max(len(self.vertices), 1))

    def _cone(self, positions: Points) -> float:
        first = positions[self.faces[:, 0]] - self._apex
        return float(np.einsum("ij,ij->", first, self._spans(positions))) / 6.0

    def _spans(self, positions: Points) -> Points:
        """Return the cross products of the sides, shape (a, 3) [mm^2], column by column, which is fast."""
        (ax, ay, az), (bx, by, bz) = ((side @ positions).T for side in self.sides)
        return np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], axis=1)


def moving_faces(body: Mesh, vertices: Indices) -> MovingFaces:
    """Collect the faces of ``body`` that have a corner among ``vertices``, shape (k,)."""
    moves = np.zeros(len(body.vertices), dtype=bool)
    moves[vertices] = True
    touched = moves[body.faces].any(axis=1)
    faces = body.faces[touched]
    corners = np.unique(faces)
    gather = incidence(faces, len(body.vertices))[corners]
    others = incidence(body.faces[~touched], len(body.vertices))[corners]
    still = frozen(2.0 * (others @ body.area_vectors[~touched]))
    sides = (_side(faces, 1, len(body.vertices)), _side(faces, 2, len(body.vertices)))
    return MovingFaces(body, faces, corners, sides, gather, still)


def _side(faces: Faces, corner: int, vertex_count: int) -> sparse.csr_array:
    """Return the operator from positions to the sides from corner 0 to ``corner``, shape (a, N)."""
    rows = np.arange(len(faces))
    ends = np.stack([faces[:, corner], faces[:, 0]], axis=1).ravel()
    signs = np.tile([1.0, -1.0], len(faces))
    return sparse.csr_array((signs, (np.repeat(rows, 2), ends)), shape=(len(faces), vertex_count))


def volume_change(body: Mesh, moved: Points) -> float:
    """Return the volume that ``body`` has gained with its vertices at ``moved``, shape (N, 3) [mm^3].

    Only the faces that moved are summed; see ``MovingFaces.volume_change`` for open borders.
    """
    return moving_faces(body, np.flatnonzero((moved != body.vertices).any(axis=1))).volume_change(moved)
