"""Incremental shading normals and volume of a moving body."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from core.geometry import kernels
from core.geometry.mesh import Flags, Floats, Indices, Mesh, Points, frozen, incidence


@dataclass(frozen=True, eq=False)
class MovingFaces:
    """The faces of a body that move with some of its vertices; made by ``moving_faces``.

    ``vertices`` are all corners of these faces, shape (r,), whose normals change; the first ``count`` are
    those that move. ``corners`` (3, a) are the faces, as places in ``vertices``, and ``left`` (a,) tells
    which lie on the subject's left of ``middle`` [mm] at rest. ``still`` is twice the area vectors of the
    other faces there, shape (r, 3) [mm^2]. Below, ``places`` are those of ``vertices``, shape (r, 3) [mm].
    """

    body: Mesh
    vertices: Indices
    count: int
    corners: Indices
    left: Flags
    still: Points
    middle: float

    @cached_property
    def rest(self) -> Points:
        """Return the places at rest, shape (r, 3) [mm]."""
        return frozen(self.body.vertices[self.vertices])

    def normals(self, places: Points) -> Points:
        """Return the unit normals of ``vertices``, shape (r, 3) [1]."""
        return kernels.normals(places, self.corners, self.still)

    def volume_change(self, places: Points) -> float:
        """Return the volume gained since rest [mm^3].

        Exact where no open border moves; a moving border is closed by a cone from the middle of the faces.
        """
        return float(self.side_volume_changes(places).sum())

    def side_volume_changes(self, places: Points) -> Floats:
        """Return the volumes gained since rest by the subject's left and right, shape (2,) [mm^3].

        Each side is closed by the cone from a point in the middle, so that both are the volume gained (ours).
        """
        return np.asarray(self._cones(places) - self._rest_cones)

    def side_volume_slopes(self, places: Points) -> Floats:
        """Return the derivatives of ``side_volume_changes`` by the places, shape (2, r, 3) [mm^2]."""
        corners = (places - self._apex)[self.corners]
        slopes = np.zeros((2, *places.shape))
        for at, corner in enumerate(self.corners):
            by_corner = np.cross(corners[at - 2], corners[at - 1]) / 6.0
            for side, here in enumerate((self.left, ~self.left)):
                for axis in range(3):
                    weight = np.where(here, by_corner[:, axis], 0.0)
                    slopes[side, :, axis] += np.bincount(corner, weight, len(places))
        return slopes

    def _cones(self, places: Points) -> Floats:
        return kernels.cones(places - self._apex, self.corners, self.left)

    @cached_property
    def _rest_cones(self) -> Floats:
        return self._cones(self.rest)

    @cached_property
    def _apex(self) -> Floats:
        y, z = self.rest[:, 1:].sum(axis=0) / max(len(self.rest), 1)
        return np.array([self.middle, y, z])


def moving_faces(body: Mesh, vertices: Indices, middle: float | None = None) -> MovingFaces:
    """Collect the faces of ``body`` that have a corner among ``vertices``, shape (k,), none of them twice.

    Left is where the centroid of a face has x > ``middle`` [mm]; that of the vertices if None.
    """
    moves = np.zeros(len(body.vertices), dtype=bool)
    moves[vertices] = True
    touched = moves[body.faces].any(axis=1)
    concerned = moves.copy()
    concerned[body.faces[touched]] = True
    corners = np.concatenate([vertices, np.flatnonzero(concerned & ~moves)])
    if middle is None:
        middle = float(body.vertices[corners, 0].sum() / max(len(corners), 1))
    place = np.full(len(body.vertices), -1)
    place[corners] = np.arange(len(corners))
    others = ~touched & concerned[body.faces].any(axis=1)
    gather = incidence(body.faces[others], len(body.vertices))[corners]
    faces = place[body.faces[touched]].T
    # In the order of their vertices: what lies together in space then lies together in memory.
    faces = np.ascontiguousarray(faces[:, np.argsort(faces.min(axis=0), kind="stable")])
    return MovingFaces(
        body,
        corners,
        len(vertices),
        faces,
        body.vertices[corners[faces], 0].mean(axis=0) > middle,
        frozen(2.0 * (gather @ body.area_vectors[others])),
        middle,
    )


def volume_change(body: Mesh, moved: Points) -> float:
    """Return the volume that ``body`` has gained with its vertices at ``moved``, shape (N, 3) [mm^3].

    Only the faces that moved are summed; see ``MovingFaces.volume_change`` for open borders.
    """
    faces = moving_faces(body, np.flatnonzero((moved != body.vertices).any(axis=1)))
    return faces.volume_change(moved[faces.vertices])
