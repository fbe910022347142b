"""Snapping: the path along edges of the control mesh that follows a drawn curve best (ours).

A path is a chain of control points joined by edges. Each edge answers for a stretch of the curve; stretches
follow each other from end to end, and what they cost is the squared distance between each point of the curve
and the point as far along its edge. The cheapest chain is found by dynamic programming along the curve.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.control_mesh.fit import ControlMesh
from core.errors import LineError
from core.geometry.mesh import Floats, Indices, Points, half_edges
from core.geometry.plane_sections import arc_length, interpolate
from core.messages import Message

STEP = 4.0
"""Distance between the points of the curve that are looked at [mm]; larger for very long curves."""

_MOST = 220  # points of a curve that are looked at
_SHORTEST, _LONGEST = 0.5, 1.6  # stretch of the curve that an edge answers for, over its own length
_NEAR = 60.0  # edges that lie further from the curve than this are not tried at first [mm]


@dataclass(frozen=True, eq=False)
class Snapped:
    """A path of control points, a closed one without its end, and how far the curve is off it [mm].

    ``is_movable`` is False where no point of it can move: then the line can only be measured.
    """

    path: tuple[int, ...]
    closed: bool
    deviation: float
    is_movable: bool


def snap(control: ControlMesh, curve: Points, closed: bool = False, *, pulling: bool = False) -> Snapped:
    """Return the path of control points at rest that follows a curve, shape (k, 3) [mm].

    A ``closed`` curve goes on from its end to its beginning. ``pulling`` wants a path of which every piece
    has an end that can move. Raises LineError if the curve has no length or the path turns back to where it
    comes from.
    """
    if closed:
        curve = np.concatenate([curve, curve[:1]])
    points, edges = control.mesh.vertices, directed_edges(control.mesh.faces)
    if pulling:
        edges = edges[~control.fixed[edges].all(axis=1)]
    samples = resampled(curve)
    near = np.linalg.norm(points[:, None] - samples, axis=2).min(axis=1) < _NEAR
    path = _best(points, edges[near[edges].all(axis=1)], samples, closed) or _best(
        points, edges, samples, closed
    )
    path = path[:-1] if closed else path
    if len(path) < (3 if closed else 2):
        raise LineError(
            Message("The line is too short for the control mesh."),
            Message("Extend the line to the next control points."),
        )
    off = max_deviation(samples, points[[*path, *path[:1]] if closed else list(path)])
    return Snapped(path, closed, off, not control.fixed[list(path)].all())


def directed_edges(faces: Indices) -> Indices:
    """Return the edges of triangles, shape (e, 2), each in both directions."""
    one_way = half_edges(faces)
    return np.unique(np.concatenate([one_way, one_way[:, ::-1]]), axis=0)


def resampled(curve: Points) -> Points:
    """Return points evenly along a curve, both ends among them. Raises LineError if it has no length."""
    along = arc_length(curve)
    if len(curve) < 2 or along[-1] < STEP:
        raise LineError(
            Message("The line has no length."),
            Message("Draw the line between two different points of the body."),
        )
    at = np.linspace(0.0, along[-1], int(np.clip(along[-1] / STEP, 2, _MOST)) + 1)
    return interpolate(at, along, curve)


def max_deviation(samples: Points, corners: Points) -> float:
    """Return how far points, shape (k, 3), are at most from the polyline through ``corners`` (c, 3) [mm]."""
    start, span = corners[:-1], np.diff(corners, axis=0)
    to = samples[:, None] - start
    share = np.einsum("kci,ci->kc", to, span) / np.einsum("ci,ci->c", span, span)
    away = np.linalg.norm(to - np.clip(share, 0.0, 1.0)[:, :, None] * span, axis=2)
    return float(away.min(axis=1).max())


def _best(points: Points, edges: Indices, samples: Points, closed: bool) -> tuple[int, ...]:
    """Return the cheapest chain of directed ``edges`` (e, 2) along the samples, empty if there is none."""
    if not len(edges):
        return ()
    costs = _Costs(points, edges, samples)
    if not closed:
        return costs.walk(None)[1]
    away = np.linalg.norm(points - samples[0], axis=1)
    starts = [int(point) for point in np.argsort(away) if point in edges][:4]
    return min((costs.walk(start) for start in starts), default=(np.inf, ()))[1]


class _Costs:
    """What it costs that an edge answers for a stretch of the samples: for each length of stretch once."""

    def __init__(self, points: Points, edges: Indices, samples: Points) -> None:
        self._count, self._edges, self._samples = len(points), edges, samples
        step = float(np.linalg.norm(np.diff(samples, axis=0), axis=1).mean())
        lengths = np.linalg.norm(points[edges[:, 1]] - points[edges[:, 0]], axis=1)
        self._most = min(int(_LONGEST * lengths.max() / step) + 2, len(samples) - 1)
        self._by_length = [
            np.where((lengths <= n * step / _SHORTEST)[:, None], self._of(points, n), np.inf)
            for n in range(1, self._most + 1)
        ]

    def _of(self, points: Points, n: int) -> Floats:
        """Return the costs of stretches of ``n`` steps, shape (edges, starts)."""
        count = len(self._samples) - n
        start, end = points[self._edges[:, 0]], points[self._edges[:, 1]]
        total = np.zeros((len(self._edges), count))
        for k in range(1, n + 1):
            place = start + (k - 0.5) / n * (end - start)
            middle = 0.5 * (self._samples[k - 1 : count + k - 1] + self._samples[k : count + k])
            total += ((place[:, None] - middle) ** 2).sum(axis=2)
        return total

    def walk(self, start: int | None) -> tuple[float, tuple[int, ...]]:
        """Return cost and points of the cheapest chain from end to end; a ``start`` is its end too."""
        count = len(self._samples)
        cost = np.full((count, self._count), np.inf)
        cost[0] = 0.0 if start is None else np.where(np.arange(self._count) == start, 0.0, np.inf)
        came = np.full((count, self._count, 2), -1)
        into = self._edges[:, 1]
        for at in range(1, count):
            for n in range(1, min(self._most, at) + 1):
                total = cost[at - n, self._edges[:, 0]] + self._by_length[n - 1][:, at - n]
                # The last of equal places that is written stands: the cheapest comes last.
                order = np.argsort(-total, kind="stable")
                order = order[total[order] < cost[at, into[order]]]
                cost[at, into[order]] = total[order]
                came[at, into[order], 0], came[at, into[order], 1] = self._edges[order, 0], at - n
        end = int(np.argmin(cost[-1])) if start is None else start
        return float(cost[-1, end]), self._back(came, end) if np.isfinite(cost[-1, end]) else ()

    def _back(self, came: Indices, point: int) -> tuple[int, ...]:
        path, at = [point], len(self._samples) - 1
        while at > 0:
            point, at = (int(value) for value in came[at, point])
            path.append(point)
        return tuple(reversed(path))
