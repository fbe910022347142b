"""t-FFD: the dense body follows the control triangles (Kobayashi and Ootsubo 2003, as the paper uses it)."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any, Literal

import numpy as np
import numpy.typing as npt
from scipy import sparse
from scipy.spatial.distance import cdist

from core.geometry import kernels
from core.geometry.closest_point import Frames, centroids, corner_reach, is_usable, neighbourhoods
from core.geometry.mesh import Faces, Flags, Floats, Indices, Mesh, Points, frozen

Weights = Literal["paper", "smooth"]

HAT_RANGE = 2.5
"""The hat of the paper reaches this many mean radii of its triangle."""

GAUSS_WIDTH = 0.6
"""Standard deviation of the smooth weights in parts of the median triangle size (ours)."""

NEGLIGIBLE = 1e-3
"""The Gauss curve is lowered by this part of its height: it ends, without a step, at 3.7 deviations."""


@dataclass(frozen=True, eq=False)
class Operator:
    """A sparse operator, stored in groups of rows that have the same columns, as ``kernels.blend`` reads it.

    A full table a group: no entry needs an index, and the inner loop runs over the rows.
    """

    weights: kernels.Weights
    starts: Indices
    columns: Indices

    def apply(self, change: Floats, rest: Points) -> Points:
        """Return ``rest``, shape (r, 3) [mm], plus the operator times ``change``, (columns, 3).

        The rows of the operator are the first rows of ``rest``; those after them stay.
        """
        return kernels.blend(self.weights, self.starts, self.columns, change, rest)

    def apply_transposed(self, slopes: Points) -> Points:
        """Return slopes by the operator's columns of what has ``slopes`` (r, 3) by its rows, (columns, 3)."""
        weights, found = self.weights, np.zeros((int(self.columns.max(initial=-1)) + 1, 3))
        for (r, c, w), (s, d, x) in pairwise(self.starts.tolist()):
            found[self.columns[c:d]] += weights[w:x].reshape(d - c, s - r) @ slopes[r:s]
        return found

    def of_rows(self, rows: Indices) -> sparse.csr_array:
        """Return a few of its rows as a matrix, shape (rows, columns)."""
        each, back = np.unique(rows, return_inverse=True)  # a row may be asked for twice
        at = np.full(self.starts[-1, 0], -1)
        at[each] = np.arange(len(each))
        dense = np.zeros((len(each), int(self.columns.max(initial=-1)) + 1))
        for (r, c, w), (s, d, x) in pairwise(self.starts.tolist()):
            chosen = np.flatnonzero(at[r:s] >= 0)
            table = self.weights[w:x].reshape(d - c, s - r)
            dense[np.ix_(at[r:s][chosen], self.columns[c:d])] = table[:, chosen].T
        return sparse.csr_array(dense[back])


@dataclass(frozen=True, eq=False)
class Binding(ABC):
    """How the vertices of a body follow its control mesh: a linear operator on what the control mesh changes.

    ``moving`` are the vertices that can move, shape (k,): the rows of ``operator``, neighbours together.
    """

    body: Mesh
    moving: Indices
    operator: Operator

    @cached_property
    def rest_moving(self) -> Points:
        """Return the moving vertices at rest, shape (k, 3) [mm]."""
        return frozen(self.body.vertices[self.moving])

    @abstractmethod
    def change(self, control_points: Points) -> Floats:
        """Return what the operator applies to, (columns, 3), for ``control_points`` (n, 3) [mm]."""

    def gradient(self, control_points: Points, slopes: Points) -> Points:
        """Return slopes by the control points of what has ``slopes`` (k, 3) by the places of ``moving``.

        Both at ``control_points`` (n, 3) [mm]; the result has their shape. Those that are fixed have none.
        """
        return self.gradient_by_points(control_points, self.operator.apply_transposed(slopes))

    @abstractmethod
    def gradient_by_points(self, control_points: Points, slopes: Points) -> Points:
        """Return slopes by the control points, (n, 3), of what has ``slopes`` (c, 3) by the first columns.

        Of several figures at once, (k, c, 3), they are (k, n, 3).
        """

    @abstractmethod
    def directional_derivative(self, control_points: Points, moved: Points) -> Floats:
        """Return how fast ``change`` changes at ``control_points`` as they move by ``moved``, both (n, 3)."""


@dataclass(frozen=True, eq=False)
class FrameBinding(Binding):
    """A body that follows the frames of the control triangles.

    The columns of the operator are the control points ``points`` (p,) that can move, then the normals of the
    control triangles ``triangles`` (t,).
    """

    control: Mesh
    points: Indices
    triangles: Indices
    scaled_normals: bool

    def change(self, control_points: Points) -> Floats:
        """Return by how much ``points`` and the normals of ``triangles`` changed, shape (p + t, 3).

        Raises ValueError unless there are as many ``control_points`` as the control mesh has, (n, 3) [mm].
        """
        _require_shape(control_points, self.control.vertices)
        return self._frames(control_points) - self._rest_frames

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

    def gradient_by_points(self, control_points: Points, slopes: Points) -> Points:
        """Return slopes by the control points: see ``Binding``."""
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
        """Return how fast ``change`` changes as the control points move: see ``Binding``."""
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


def bind(
    body: Mesh,
    control: Mesh,
    fade: Floats,
    weights: Weights = "smooth",
    *,
    scaled_normals: bool = False,
    fixed: Flags | None = None,
    single: bool = False,
) -> FrameBinding:
    """Bind the vertices of ``body`` to the triangles of ``control``.

    ``fade`` scales the motion of each vertex, shape (N,), 0 still .. 1 full; vertices without fade or without
    weight keep their place. Weights "paper" are the hat in the distance to the centroid of the 2003 paper,
    "smooth" is a Gauss curve in the distance to the triangle (ours). Control points that are ``fixed``, shape
    (n,), are taken never to move. ``single`` keeps the operator in single precision: half the memory is read
    in each frame, and places are exact to 1e-4 mm.
    """
    free = np.ones(len(control.vertices), dtype=bool) if fixed is None else ~fixed
    can_change = np.concatenate([free, free[control.faces].any(axis=1)])
    candidates = np.flatnonzero(fade > 0.0)
    groups = list(_groups(body.vertices[candidates], fade[candidates], control, weights, can_change))
    sizes = [(*group.table.shape[::-1], group.table.size) for group in groups]
    operator = Operator(
        _joined([group.table.ravel() for group in groups], np.float32 if single else np.float64),
        frozen(np.cumsum([(0, 0, 0), *sizes], axis=0), np.int64).view(np.int64),
        _joined([group.columns for group in groups], np.int64),
    )
    points, triangles = np.split(np.flatnonzero(can_change), [int(free.sum())])
    moving = _joined([candidates[group.rows] for group in groups], np.int64)
    return FrameBinding(body, moving, operator, control, points, triangles - len(free), scaled_normals)


@dataclass(frozen=True, eq=False)
class CarriedBinding(Binding):
    """A body that follows ``frames`` of a finer mesh, whose points the control points carry along.

    ``rest`` (n, 3) [mm] are the control points at rest, of which ``free`` (f,) can move; ``carried``
    (3 s, 3 f) [1] times their displacements are those of the points ``nodes`` (s,) of the finer mesh.
    """

    frames: FrameBinding
    rest: Points
    free: Indices
    nodes: Indices
    carried: Floats

    def change(self, control_points: Points) -> Floats:
        """Return what the operator applies to. Raises ValueError for a wrong number of points."""
        _require_shape(control_points, self.rest)
        return self.frames.change(self._finer(control_points))

    def gradient_by_points(self, control_points: Points, slopes: Points) -> Points:
        """Return slopes by the control points: see ``Binding``."""
        by_nodes = self.frames.gradient_by_points(self._finer(control_points), slopes)[..., self.nodes, :]
        few = by_nodes.reshape(*by_nodes.shape[:-2], -1) @ self.carried
        found = np.zeros((*few.shape[:-1], *self.rest.shape))
        found[..., self.free, :] = few.reshape(*few.shape[:-1], -1, 3)
        return found

    def directional_derivative(self, control_points: Points, moved: Points) -> Floats:
        """Return how fast ``change`` changes as the control points move: see ``Binding``."""
        finer = self._spread(moved)
        return self.frames.directional_derivative(self._finer(control_points), finer)

    def _finer(self, control_points: Points) -> Points:
        """Return the points of the finer mesh."""
        return self.frames.control.vertices + self._spread(control_points - self.rest)

    def _spread(self, moved: Points) -> Points:
        """Return displacements of the finer mesh for those of the control points."""
        finer = np.zeros_like(self.frames.control.vertices)
        finer[self.nodes] = (self.carried @ moved[self.free].ravel()).reshape(-1, 3)
        return finer


def bind_carried(
    frames: FrameBinding, rest: Points, free: Indices, nodes: Indices, carried: Floats
) -> CarriedBinding:
    """Bind a body that follows ``frames`` to control points that carry those: see ``CarriedBinding``."""
    return CarriedBinding(frames.body, frames.moving, frames.operator, frames, rest, free, nodes, carried)


def _require_shape(control_points: Points, rest: Points) -> None:
    wanted, got = rest.shape, np.shape(control_points)
    if got != wanted:
        raise ValueError(f"control points of shape {got} for a control mesh of shape {wanted}")


def _joined(parts: Sequence[npt.NDArray[Any]], dtype: npt.DTypeLike) -> npt.NDArray[Any]:
    """Return the parts one after the other, read-only."""
    joined = np.concatenate([np.empty(0, dtype), *parts], dtype=dtype)
    joined.setflags(write=False)
    return joined


@dataclass(frozen=True, eq=False)
class _Group:
    """Rows (g,) of an operator, their columns (c,) and the entries, shape (c, g)."""

    rows: Indices
    columns: Indices
    table: Floats


def _groups(
    points: Points, fade: Floats, control: Mesh, weights: Weights, can_change: Flags
) -> Iterator[_Group]:
    """Give the operator on the columns that ``can_change``, for all points that have a weight."""
    frames, sigma = Frames.of(control), _sigma(control)
    reach = HAT_RANGE * corner_reach(control).mean(axis=1)
    column = np.where(can_change, np.cumsum(can_change) - 1, -1)
    ends = np.column_stack([control.faces, len(control.vertices) + np.arange(len(control.faces))])
    if weights == "paper":
        near = neighbourhoods(points, control, reach=reach)
    else:
        near = neighbourhoods(points, control, spread=sigma * np.sqrt(-2.0 * np.log(NEGLIGIBLE)))
    for rows, triangles in near:
        u, v, h = frames.coordinates(points[rows], triangles)
        if weights == "paper":
            weight = _hat(points[rows], centroids(control)[triangles], reach[triangles])
        else:
            weight = _gauss(frames.distance2(points[rows], triangles, h), sigma)
        total = weight.sum(axis=0)
        weighted = total > 0.0
        weight *= fade[rows] / np.where(weighted, total, 1.0)
        near_one = weight.any(axis=1)
        weight, u, v, h = (table[near_one] for table in (weight, u, v, h))
        in_frame = np.stack([weight * (1.0 - u - v), weight * u, weight * v, weight * h], axis=1)
        columns, table = _summed(column[ends[triangles[near_one]]], in_frame)
        yield _Group(rows[weighted], columns, table[:, weighted])


def _summed(column: Indices, entries: Floats) -> tuple[Indices, Floats]:
    """Sum the entries, shape (c, 4, g), that have the same column, shape (c, 4); negative: none."""
    columns, place = np.unique(column, return_inverse=True)
    join = sparse.csr_array(
        (np.ones(column.size), (place.ravel(), np.arange(column.size))), shape=(len(columns), column.size)
    )
    table: Floats = np.asarray(join @ entries.reshape(column.size, entries.shape[2]))
    return columns[columns >= 0], table[columns >= 0]


def _hat(points: Points, middles: Points, reach: Floats) -> Floats:
    return np.asarray(np.maximum(1.0 - cdist(middles, points) / reach[:, None], 0.0))


def _gauss(distance2: Floats, sigma: float) -> Floats:
    beyond = distance2 - distance2.min(axis=0)
    return np.asarray(np.maximum(np.exp(beyond / (-2.0 * sigma**2)) - NEGLIGIBLE, 0.0))


def _sigma(control: Mesh) -> float:
    sizes = np.sqrt(control.face_areas[is_usable(control)])
    return GAUSS_WIDTH * float(np.median(sizes)) if len(sizes) else 0.0


def movable_border_triangles(control: Mesh, fixed: Flags) -> Indices:
    """Return the triangles of the outermost ring of ``control`` that can move, shape (t,); best none (ours).

    ``fixed`` (n,) tells the control points that stay. The body at the border follows the last triangles far
    beyond them: where those turn, parts that should be still move by millimetres. A closed mesh has no
    border and so no such triangle.
    """
    outer = np.zeros(len(control.vertices), dtype=bool)
    for loop in control.boundary_loops:
        outer[loop] = True
    return np.flatnonzero(outer[control.faces].any(axis=1) & ~fixed[control.faces].all(axis=1))


def deform_moving(binding: Binding, control_points: Points) -> Points:
    """Return the places of ``binding.moving`` for ``control_points``, shapes (k, 3) and (n, 3) [mm]."""
    return binding.operator.apply(binding.change(control_points), binding.rest_moving)


def deform(binding: Binding, control_points: Points) -> Points:
    """Return all vertices of the body for ``control_points``, shapes (N, 3) and (n, 3) [mm].

    With the control points at rest the result is the body at rest, bit for bit. Raises ValueError unless
    there are as many as the control mesh has.
    """
    vertices = binding.body.vertices.copy()
    vertices[binding.moving] = deform_moving(binding, control_points)
    return vertices
