"""The loops over the dense body: each is defined in plain numpy, and compiled where numba is installed.

Importing numba takes about a second and compiling several, so a program starts with the definitions.
``warm`` reads or compiles the loops, and only when all are ready it switches to them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from core.geometry.mesh import Flags, Floats, Indices, Points, unit

Weights = npt.NDArray[np.float32] | npt.NDArray[np.float64]


@dataclass(frozen=True)
class _Forms:
    """Which form of the loops is in force: ``loops`` is empty until they are compiled."""

    state: str = "numpy: not warmed up"
    loops: Mapping[str, Callable[..., Any]] = field(default_factory=dict)


# The one thing here that changes: replaced once, as a whole, by `warm`. Both forms give the same figures, so
# a thread that still sees the old one is as right as one that sees the new.
_forms = _Forms()


def state() -> str:
    """Return "compiled", or "numpy" and why."""
    return _forms.state


def warm() -> bool:
    """Compile the loops, or read them from numba's cache, and switch to them; tell whether that went well.

    Takes a second, and some more the first time on a machine: call it in a thread that nobody waits for.
    Without numba, or if anything goes wrong, the definitions stay in force and ``state`` says why.
    """
    global _forms  # noqa: PLW0603  # explained above
    if not _forms.loops:
        try:
            _forms = _Forms("compiled", _compiled())
        except BaseException as error:  # a faulty numba must not take the program with it
            _forms = _Forms(f"numpy: {type(error).__name__}, {error}")
    return bool(_forms.loops)


def _compiled() -> Mapping[str, Callable[..., Any]]:
    import numba
    from numba import types

    def given(dtype: Any, dimensions: int) -> Any:
        # Our values are read-only arrays; numba takes others for these as well, but not the reverse.
        return types.Array(dtype, dimensions, "C", readonly=True)

    points, corners, columns = given(types.float64, 2), given(types.int64, 2), given(types.int64, 1)
    starts, flags, out = given(types.int64, 2), given(types.boolean, 1), types.float64[:, ::1]
    signatures = {
        blend_loop: [
            types.void(given(kind, 1), starts, columns, given(kind, 2), out)
            for kind in (types.float32, types.float64)
        ],
        normals_loop: [types.void(points, corners, points, out)],
        cones_loop: [types.void(points, corners, flags, types.float64[::1])],
    }
    return {
        loop.__name__: numba.njit(kinds, cache=True, nogil=True)(loop) for loop, kinds in signatures.items()
    }


def blend(weights: Weights, starts: Indices, columns: Indices, change: Points, rest: Points) -> Points:
    """Return ``rest``, shape (r, 3) [mm], with sums of ``change`` added to its first rows: t-FFD as deltas.

    Rows that the same columns change form a group, so that the inner loop runs over rows. Group g has the
    rows r to s and the ``columns[c:d]``; its weights, shape (d - c, s - r), lie at ``weights[w:x]``, where
    (r, c, w) and (s, d, x) are the rows g and g + 1 of ``starts``, shape (groups + 1, 3). ``change`` has
    shape (all columns, 3). Sums are made in the precision of ``weights``.
    """
    change = change.astype(weights.dtype)
    loop = _forms.loops.get("blend_loop")
    if loop is None:
        return blend_plain(weights, starts, columns, change, rest)
    result = rest.copy()
    loop(weights, starts, columns, change, result)
    return result


def blend_plain(weights: Weights, starts: Indices, columns: Indices, change: Any, rest: Points) -> Points:
    """Define ``blend``: one small matrix product a group."""
    change = change[columns].T
    moved = np.empty((3, starts[-1, 0]), weights.dtype)
    for (r, c, w), (s, d, x) in pairwise(starts.tolist()):
        np.matmul(change[:, c:d], weights[w:x].reshape(d - c, s - r), out=moved[:, r:s])
    result = rest.copy()
    result[: len(moved.T)] += moved.T
    return result


def blend_loop(weights: Any, starts: Any, columns: Any, change: Any, result: Any) -> None:
    """Add to ``result``, shape (r, 3), what ``blend_plain`` adds to ``rest``."""
    most = 0
    for g in range(len(starts) - 1):
        most = max(most, starts[g + 1, 0] - starts[g, 0])
    sums = np.empty((3, most), weights.dtype)
    for g in range(len(starts) - 1):
        first, at = starts[g, 0], starts[g, 2]
        count = starts[g + 1, 0] - first
        x, y, z = sums[0, :count], sums[1, :count], sums[2, :count]
        sums[:, :count] = 0.0
        for column in columns[starts[g, 1] : starts[g + 1, 1]]:
            dx, dy, dz = change[column, 0], change[column, 1], change[column, 2]
            weight = weights[at : at + count]
            for j in range(count):
                x[j] += weight[j] * dx
                y[j] += weight[j] * dy
                z[j] += weight[j] * dz
            at += count
        for j in range(count):
            result[first + j, 0] += x[j]
            result[first + j, 1] += y[j]
            result[first + j, 2] += z[j]


def normals(points: Points, corners: Indices, still: Points) -> Points:
    """Return the unit normals at ``points``, shape (r, 3) [1], zero where they cancel.

    Each is the direction of ``still``, shape (r, 3) [mm^2], plus twice the area vectors of the triangles of
    its point, whose ``corners`` have shape (3, a).
    """
    loop = _forms.loops.get("normals_loop")
    if loop is None:
        return normals_plain(points, corners, still)
    result = np.empty_like(still)
    loop(np.ascontiguousarray(points), corners, still, result)
    return result


def normals_plain(points: Points, corners: Indices, still: Points) -> Points:
    """Define ``normals``."""
    spans = _crossed(points, corners)
    sums = [
        still[:, axis] + sum(np.bincount(corner, spans[axis], len(points)) for corner in corners)
        for axis in range(3)
    ]
    return unit(np.stack(sums, axis=1))


def normals_loop(points: Any, corners: Any, still: Any, result: Any) -> None:
    """Write what ``normals_plain`` returns into ``result``, shape (r, 3)."""
    result[:] = still
    for f in range(corners.shape[1]):
        i, j, k = corners[0, f], corners[1, f], corners[2, f]
        ax, ay, az = points[j, 0] - points[i, 0], points[j, 1] - points[i, 1], points[j, 2] - points[i, 2]
        bx, by, bz = points[k, 0] - points[i, 0], points[k, 1] - points[i, 1], points[k, 2] - points[i, 2]
        nx, ny, nz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
        for corner in (i, j, k):
            result[corner, 0] += nx
            result[corner, 1] += ny
            result[corner, 2] += nz
    for row in range(len(result)):
        length = np.sqrt(result[row, 0] ** 2 + result[row, 1] ** 2 + result[row, 2] ** 2)
        if length > 0.0:
            result[row, 0] /= length
            result[row, 1] /= length
            result[row, 2] /= length


def cones(points: Points, corners: Indices, left: Flags) -> Floats:
    """Return the volumes of the cones from the origin over the triangles of each side, shape (2,) [mm^3].

    ``corners`` (3, a) are those of the triangles; ``left`` (a,) are summed first, the others second.
    """
    loop = _forms.loops.get("cones_loop")
    if loop is None:
        return cones_plain(points, corners, left)
    result = np.zeros(2)
    loop(np.ascontiguousarray(points), corners, left, result)
    return result


def cones_plain(points: Points, corners: Indices, left: Flags) -> Floats:
    """Define ``cones``."""
    first = points.T.take(corners[0], axis=1)
    six = sum(first[axis] * span for axis, span in enumerate(_crossed(points, corners)))
    return np.array([np.sum(six, where=left), np.sum(six, where=~left)]) / 6.0


def cones_loop(points: Any, corners: Any, left: Any, result: Any) -> None:
    """Add what ``cones_plain`` returns to ``result``, shape (2,)."""
    for f in range(corners.shape[1]):
        i, j, k = corners[0, f], corners[1, f], corners[2, f]
        ax, ay, az = points[j, 0] - points[i, 0], points[j, 1] - points[i, 1], points[j, 2] - points[i, 2]
        bx, by, bz = points[k, 0] - points[i, 0], points[k, 1] - points[i, 1], points[k, 2] - points[i, 2]
        six = points[i, 0] * (ay * bz - az * by) + points[i, 1] * (az * bx - ax * bz)
        result[0 if left[f] else 1] += (six + points[i, 2] * (ax * by - ay * bx)) / 6.0


def _crossed(points: Points, corners: Indices) -> tuple[Floats, Floats, Floats]:
    """Return x, y and z of twice the area vectors, shape (a,) each: whole columns are fast."""
    columns = np.ascontiguousarray(points.T)
    first, second, third = (columns.take(corner, axis=1) for corner in corners)
    (ax, ay, az), (bx, by, bz) = second - first, third - first
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
