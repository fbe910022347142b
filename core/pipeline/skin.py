"""Skin that moves: the parts of a body that its regions move, as one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.deformation.incremental_normals import MovingFaces, moving_faces
from core.deformation.tffd import Binding, deform_moving
from core.geometry.mesh import Indices, Mesh, Points


@dataclass(frozen=True, eq=False)
class MovingSkin:
    """The skin that regions move together: where two of them reach, their moves add up.

    ``rows`` are where the vertices of each region's ``MovingFaces`` stand among ``faces.vertices``.
    """

    faces: MovingFaces
    bindings: tuple[Binding, ...]
    rows: tuple[Indices, ...]

    @property
    def vertices(self) -> Indices:
        """Return the vertices of the body that places and normals belong to, (r,)."""
        return self.faces.vertices

    def places(self, control_points: Sequence[Points]) -> Points:
        """Return the places of ``vertices``, (r, 3) [mm], for the control points of each region."""
        if len(self.bindings) == 1:
            return self.bindings[0].places(control_points[0], self.faces.rest)
        places = self.faces.rest.copy()
        for binding, rows, points in zip(self.bindings, self.rows, control_points, strict=True):
            places[rows[: len(binding.moving)]] += deform_moving(binding, points) - binding.rest_moving
        return places

    def of_bust(self, *figures: Points) -> tuple[Points, ...]:
        """Return the rows of ``figures``, each (r, 3), that belong to the moving faces of the bust alone."""
        return figures if len(self.rows) == 1 else tuple(each[self.rows[0]] for each in figures)

    def shape(self, control_points: Sequence[Points]) -> tuple[Points, Points]:
        """Return places [mm] and normals [1] of ``vertices``, each (r, 3)."""
        places = self.places(control_points)
        return places, self.faces.normals(places)

    def body(self, control_points: Sequence[Points]) -> Mesh:
        """Return the whole body, reshaped; with control points at rest it is the body, bit for bit."""
        vertices, moves = self.faces.body.vertices.copy(), self.vertices[: self.faces.count]
        vertices[moves] = self.places(control_points)[: self.faces.count]
        return self.faces.body.moved(vertices)


def joined(bust: tuple[MovingFaces, Binding], lower: tuple[MovingFaces, Binding]) -> MovingSkin:
    """Return the skin that two regions of one body move."""
    both = bust[0], lower[0]
    body = bust[0].body
    moving = np.union1d(bust[1].moving, lower[1].moving)
    faces = moving_faces(body, moving, bust[0].middle)
    place = np.empty(len(body.vertices), dtype=np.int64)
    place[faces.vertices] = np.arange(len(faces.vertices))
    return MovingSkin(faces, (bust[1], lower[1]), tuple(place[each.vertices] for each in both))


def alone(moving: MovingFaces, binding: Binding) -> MovingSkin:
    """Return the skin that one region moves."""
    return MovingSkin(moving, (binding,), (np.arange(len(moving.vertices)),))
