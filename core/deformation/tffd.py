"""t-FFD: the dense body follows the control triangles (Kobayashi and Ootsubo 2003, as the paper uses it)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any, Literal

import numpy as np
import numpy.typing as npt
from scipy import sparse
from scipy.spatial.distance import cdist

from core.deformation.changes import Changes, FrameChanges
from core.geometry import kernels
from core.geometry.closest_point import Frames, centroids, corner_reach, is_usable, neighbourhoods
from core.geometry.mesh import Flags, Floats, Indices, Mesh, Points, frozen

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
class Binding:
    """How the vertices of a body follow control points: a linear operator on what these change.

    ``moving`` are the vertices that can move, shape (k,): the rows of ``operator``, neighbours together; its
    columns are those of ``changes``.
    """

    body: Mesh
    moving: Indices
    operator: Operator
    changes: Changes

    @cached_property
    def rest_moving(self) -> Points:
        """Return the moving vertices at rest, shape (k, 3) [mm]."""
        return frozen(self.body.vertices[self.moving])

    def places(self, control_points: Points, rest: Points) -> Points:
        """Return ``rest``, whose first rows are those of ``moving``, for ``control_points`` (n, 3) [mm]."""
        return self.operator.apply(self.changes.of(control_points), rest)

    def gradient(self, control_points: Points, slopes: Points) -> Points:
        """Return slopes by the control points of what has ``slopes`` (k, 3) by the places of ``moving``.

        Both at ``control_points`` (n, 3) [mm]; the result has their shape. Those that are fixed have none.
        """
        return self.changes.gradient(control_points, self.operator.apply_transposed(slopes))

    def few(self, rows: Indices) -> FewPlaces:
        """Return some of the rows of ``moving`` (r,), which are then quick to follow."""
        operator = self.operator.of_rows(rows)
        columns = np.unique(operator.indices).astype(np.int64)
        return FewPlaces(self.rest_moving[rows], operator[:, columns], self.changes.narrowed(columns))


@dataclass(frozen=True, eq=False)
class FewPlaces:
    """Some vertices of a body, at ``rest`` (r, 3) [mm], that follow ``changes`` by an ``operator``."""

    rest: Points
    operator: sparse.csr_array
    changes: Changes

    def places(self, control_points: Points) -> Points:
        """Return where they are, (r, 3) [mm]."""
        return np.asarray(self.rest + self.operator @ self.changes.of(control_points))

    def gradient(self, control_points: Points, slopes: Points) -> Points:
        """Return slopes by the control points, (n, 3), of what has ``slopes`` (r, 3) by the places."""
        return self.changes.gradient(control_points, self.operator.T @ slopes)


def bind(
    body: Mesh,
    control: Mesh,
    fade: Floats,
    weights: Weights = "smooth",
    *,
    scaled_normals: bool = False,
    fixed: Flags | None = None,
    single: bool = False,
) -> Binding:
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
    changes = FrameChanges(control, points, triangles - len(free), scaled_normals)
    return Binding(body, moving, operator, changes)


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
    return binding.places(control_points, binding.rest_moving)


def deform(binding: Binding, control_points: Points) -> Points:
    """Return all vertices of the body for ``control_points``, shapes (N, 3) and (n, 3) [mm].

    With the control points at rest the result is the body at rest, bit for bit. Raises ValueError unless
    there are as many as the control mesh has.
    """
    vertices = binding.body.vertices.copy()
    vertices[binding.moving] = deform_moving(binding, control_points)
    return vertices
