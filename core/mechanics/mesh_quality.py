"""In what condition a control mesh is: how far its triangles have turned and its edges have strained.

A solver finds a balance for lines of any length. Whether the shape still means a body is another matter, and
is read off the control mesh itself (ours, beyond the paper).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from core.geometry.mesh import Faces, Flags, Floats, Indices, Mesh, Points

FOLD_LIMIT = 0.2
"""Cosine of the turn from which on a triangle counts as folded, about 78 degrees [1]; ours."""

STRAIN_RANGE = (0.7, 1.3)
"""Edge lengths over rest lengths between which a control mesh keeps its sense [1]; ours."""

STRAINED_RANGE = (0.8, 1.2)
"""Edge lengths over rest lengths between which bodies still look natural [1]; ours."""


@dataclass(frozen=True)
class MeshQuality:
    """The worst places of a control mesh.

    ``least_cosine`` [1] is the least cosine between a triangle's normal and its normal at rest, 0 for a
    triangle without area; ``shortest`` and ``longest`` [1] are the extreme edge lengths over rest lengths.
    """

    least_cosine: float
    shortest: float
    longest: float

    @property
    def largest_rotation(self) -> float:
        """Return the angle by which the worst triangle has turned [degrees]."""
        return math.degrees(math.acos(min(max(self.least_cosine, -1.0), 1.0)))

    @property
    def folded(self) -> bool:
        """Return whether a triangle has turned to its side: the shape is no body any more."""
        return not self.least_cosine > FOLD_LIMIT  # so that nan counts

    @property
    def inverted(self) -> bool:
        """Return whether a triangle shows its back."""
        return not self.least_cosine > 0.0

    @property
    def overstrained(self) -> bool:
        """Return whether an edge is outside STRAIN_RANGE."""
        return not self._within(STRAIN_RANGE)

    @property
    def strained(self) -> bool:
        """Return whether an edge is outside CALM_RANGE."""
        return not self._within(STRAINED_RANGE)

    def _within(self, bounds: tuple[float, float]) -> bool:
        return bounds[0] <= self.shortest and self.longest <= bounds[1]


def worst_of(qualities: Sequence[MeshQuality]) -> MeshQuality:
    """Return the worst places of several control meshes; what is not a number counts as worst."""
    figures = np.array([(each.least_cosine, each.shortest, -each.longest) for each in qualities])
    cosine, shortest, longest = figures.min(axis=0).tolist()
    return MeshQuality(cosine, shortest, -longest)


@dataclass(frozen=True, eq=False)
class OriginalShape:
    """A control mesh at rest: points (n, 3) [mm], and the triangles (m, 3) and edges (e, 2) that can move."""

    rest: Points
    faces: Faces
    edges: Indices

    def quality(self, points: Points) -> MeshQuality:
        """Return the condition of the mesh with its points at ``points``, shape (n, 3) [mm]."""
        if not len(self.faces):
            return MeshQuality(1.0, 1.0, 1.0)
        # A run that blows up may come here with figures that have no squares.
        with np.errstate(over="ignore", invalid="ignore"):
            axes = np.ascontiguousarray(points.T)
            turned = self._turned(axes)
            strain = _lengths(axes, self._ends) * self._per_rest_length
        return MeshQuality(float(turned.min()), float(strain.min()), float(strain.max()))

    def _turned(self, axes: Floats) -> Floats:
        x, y, z = _normals(axes, self._corners)
        rest_x, rest_y, rest_z = self._rest_normals
        size = np.sqrt(x * x + y * y + z * z)
        return np.asarray((x * rest_x + y * rest_y + z * rest_z) / np.maximum(size, 1e-300))

    @cached_property
    def _corners(self) -> Indices:
        return np.ascontiguousarray(self.faces.T)

    @cached_property
    def _ends(self) -> Indices:
        return np.ascontiguousarray(self.edges.T)

    @cached_property
    def _rest_normals(self) -> Floats:
        normals = np.array(_normals(self.rest.T, self._corners))
        return np.asarray(normals / np.linalg.norm(normals, axis=0))

    @cached_property
    def _per_rest_length(self) -> Floats:
        return np.asarray(1.0 / _lengths(self.rest.T, self._ends))


def original_shape(mesh: Mesh, fixed: Flags | None = None) -> OriginalShape:
    """Prepare a control mesh at rest; ``fixed``, shape (n,), marks the points that stay (none if None)."""
    still = np.zeros(len(mesh.vertices), dtype=bool) if fixed is None else fixed
    faces, edges = (cells[~still[cells].all(axis=1)] for cells in (mesh.faces, mesh.edges))
    return OriginalShape(mesh.vertices, faces, edges)


def mesh_quality(mesh: Mesh, points: Points, fixed: Flags | None = None) -> MeshQuality:
    """Return the condition of a control mesh with its points at ``points``, shape (n, 3) [mm].

    ``fixed`` as in ``original_shape``; who asks again and again keeps the ``OriginalShape``.
    """
    return original_shape(mesh, fixed).quality(points)


def _normals(axes: Floats, corners: Indices) -> tuple[Floats, Floats, Floats]:
    """Return twice the area vectors of triangles with ``corners`` (3, m), each axis of shape (m,) [mm^2].

    Axis by axis, which for some hundred triangles is several times faster than row by row.
    """
    at = axes.take(corners, axis=1)
    ax, ay, az = at[:, 1] - at[:, 0]
    bx, by, bz = at[:, 2] - at[:, 0]
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


def _lengths(axes: Floats, ends: Indices) -> Floats:
    spans = axes.take(ends[1], axis=1) - axes.take(ends[0], axis=1)
    return np.asarray(np.sqrt(np.einsum("ij,ij->j", spans, spans)))
