"""What a body follows as control points move: points and normals of a mesh, which other points may carry."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Protocol

import numpy as np

from core.geometry.mesh import Faces, Floats, Indices, Mesh, Points


class Changes(Protocol):
    """What an operator applies to, in its columns, with its derivatives."""

    def of(self, control_points: Points) -> Floats:
        """Return what the control points (n, 3) [mm] change, (columns, 3).

        Raises ValueError for a wrong number of them.
        """

    def gradient(self, control_points: Points, slopes: Points) -> Points:
        """Return slopes by the control points, (n, 3), of what has ``slopes`` (c, 3) by the first columns.

        Of several figures at once, (k, c, 3), they are (k, n, 3).
        """

    def directional_derivative(self, control_points: Points, moved: Points) -> Floats:
        """Return how fast the columns change at ``control_points`` that move by ``moved``, both (n, 3)."""

    def narrowed(self, columns: Indices) -> Changes:
        """Return those of some columns alone, ascending, (c,): all others need not be computed."""


@dataclass(frozen=True, eq=False)
class FrameChanges:
    """What changes with the frames of the triangles of a ``control`` mesh.

    The columns are its points ``points`` (p,) that can move, then the normals of its triangles ``triangles``
    (t,).
    """

    control: Mesh
    points: Indices
    triangles: Indices
    scaled_normals: bool

    def of(self, control_points: Points) -> Floats:
        """Return by how much ``points`` and the normals of ``triangles`` changed, shape (p + t, 3)."""
        _require_shape(control_points, self.control.vertices)
        return self._frames(control_points) - self._rest_frames

    def narrowed(self, columns: Indices) -> FrameChanges:
        """Return those of some columns alone: see ``Changes``."""
        points, triangles = np.split(columns, [np.searchsorted(columns, len(self.points))])
        return replace(
            self, points=self.points[points], triangles=self.triangles[triangles - len(self.points)]
        )

    @property
    def corners(self) -> Indices:
        """Return the points of the mesh that the columns depend on, ascending."""
        return np.unique(np.concatenate([self.points, self._corners.ravel()]))

    def _frames(self, control_points: Points) -> Floats:
        """Return control points and unit normals.

        Scaled normals grow with the root of the triangle's area, so that a similarity is followed exactly.
        """
        v0, v1, v2 = control_points.T[:, self._corners].swapaxes(0, 1)
        (ax, ay, az), (bx, by, bz) = v1 - v0, v2 - v0
        spans = np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])
        length = np.sqrt(np.einsum("ij,ij->j", spans, spans))
        spans /= np.where(length > 0.0, length, 1.0)
        if self.scaled_normals:
            rest = 2.0 * self.control.face_areas[self.triangles]
            spans *= np.sqrt(length / np.where(rest > 0.0, rest, 1.0))
        return np.concatenate([control_points[self.points], spans.T])

    def gradient(self, control_points: Points, slopes: Points) -> Points:
        """Return slopes by the control points: see ``Changes``."""
        columns = np.zeros((*slopes.shape[:-2], len(self.points) + len(self.triangles), 3))
        columns[..., : slopes.shape[-2], :] = slopes
        points, by_normal = np.split(columns, [len(self.points)], axis=-2)
        v0, v1, v2 = control_points[self._corners]
        across = np.cross(v1 - v0, v2 - v0)
        by_area = self._through_normals(across, by_normal)
        by_second, by_third = np.cross(v2 - v0, by_area), np.cross(by_area, v1 - v0)
        found = np.zeros((len(control_points), *slopes.shape[:-2], 3))
        found[self.points] = np.moveaxis(points, -2, 0)
        for corner, share in zip(self._corners, (-by_second - by_third, by_second, by_third), strict=True):
            np.add.at(found, corner, np.moveaxis(share, -2, 0))
        return np.asarray(np.moveaxis(found, 0, -2))

    def directional_derivative(self, control_points: Points, moved: Points) -> Floats:
        """Return how fast the columns change as the control points move: see ``Changes``."""
        v0, v1, v2 = control_points[self._corners]
        w0, w1, w2 = moved[self._corners]
        across = np.cross(v1 - v0, v2 - v0)
        by_move = np.cross(w1 - w0, v2 - v0) + np.cross(v1 - v0, w2 - w0)
        return np.concatenate([moved[self.points], self._through_normals(across, by_move)])

    def _through_normals(self, across: Floats, rates: Floats) -> Floats:
        """Return the rates of normals by ``rates`` (t, 3) of the products ``across`` that they come of.

        The derivative is symmetric, so it carries slopes by the normals back to the products as well.
        """
        length = np.where((size := np.linalg.norm(across, axis=1)) > 0.0, size, 1.0)[:, None]
        unit = across / length
        along = np.sum(unit * rates, axis=-1, keepdims=True) * unit
        if not self.scaled_normals:
            return np.asarray((rates - along) / length)
        rest = 2.0 * self.control.face_areas[self.triangles, None]
        return np.asarray((rates - 0.5 * along) / np.sqrt(length * np.where(rest > 0.0, rest, 1.0)))

    @cached_property
    def _rest_frames(self) -> Floats:
        return self._frames(self.control.vertices)

    @cached_property
    def _corners(self) -> Faces:
        return np.ascontiguousarray(self.control.faces[self.triangles].T)


@dataclass(frozen=True, eq=False)
class CarriedChanges:
    """What changes with the ``frames`` of a finer mesh, whose points the control points carry along.

    ``rest`` (n, 3) [mm] are the control points at rest, of which ``free`` (f,) can move; ``carried``
    (3 s, 3 f) [1] times their displacements are those of the points ``nodes`` (s,) of the finer mesh.
    """

    frames: FrameChanges
    rest: Points
    free: Indices
    nodes: Indices
    carried: Floats

    def of(self, control_points: Points) -> Floats:
        """Return what the columns change: see ``Changes``."""
        _require_shape(control_points, self.rest)
        return self.frames.of(self._finer(control_points))

    def gradient(self, control_points: Points, slopes: Points) -> Points:
        """Return slopes by the control points: see ``Changes``."""
        by_nodes = self.frames.gradient(self._finer(control_points), slopes)[..., self.nodes, :]
        few = by_nodes.reshape(*by_nodes.shape[:-2], -1) @ self.carried
        found = np.zeros((*few.shape[:-1], *self.rest.shape))
        found[..., self.free, :] = few.reshape(*few.shape[:-1], -1, 3)
        return found

    def directional_derivative(self, control_points: Points, moved: Points) -> Floats:
        """Return how fast the columns change as the control points move: see ``Changes``."""
        finer = self._spread(moved)
        return self.frames.directional_derivative(self._finer(control_points), finer)

    def narrowed(self, columns: Indices) -> CarriedChanges:
        """Return those of some columns alone: see ``Changes``."""
        frames = self.frames.narrowed(columns)
        kept = np.flatnonzero(np.isin(self.nodes, frames.corners))
        rows = (3 * kept[:, None] + np.arange(3)).ravel()
        return replace(self, frames=frames, nodes=self.nodes[kept], carried=self.carried[rows])

    def _finer(self, control_points: Points) -> Points:
        """Return the points of the finer mesh."""
        return self.frames.control.vertices + self._spread(control_points - self.rest)

    def _spread(self, moved: Points) -> Points:
        """Return displacements of the finer mesh for those of the control points."""
        finer = np.zeros_like(self.frames.control.vertices)
        finer[self.nodes] = (self.carried @ moved[self.free].ravel()).reshape(-1, 3)
        return finer


def _require_shape(control_points: Points, rest: Points) -> None:
    wanted, got = rest.shape, np.shape(control_points)
    if got != wanted:
        raise ValueError(f"control points of shape {got} for a control mesh of shape {wanted}")
