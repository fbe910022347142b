"""Plane sections of a mesh: exact segments, chained into curves, and what a tape reads on them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.spatial import ConvexHull, QhullError

from core.geometry.mesh import Floats, Indices, Mesh, Points

MOST_STEPS = 100_000
"""So many points are laid along a curve: one of a torn skin may run to and fro over kilometres."""


@dataclass(frozen=True, eq=False)
class Section:
    """Where a plane cuts a mesh: one segment per cut face.

    ``segments`` are the two end points, shape (s, 2, 3) [mm]; ``edge_ids`` tells which mesh edge each end
    lies on, shape (s, 2), so that neighbouring segments share an id and chain without a tolerance.
    """

    segments: Points
    edge_ids: Indices

    @property
    def points(self) -> Points:
        """Return all end points, shape (2 s, 3) [mm]."""
        return self.segments.reshape(-1, 3)


def cut(mesh: Mesh, origin: npt.ArrayLike, normal: npt.ArrayLike) -> Section:
    """Cut ``mesh`` with the plane through ``origin`` [mm] with ``normal`` [1]."""
    side = (mesh.vertices - np.asarray(origin, dtype=np.float64)) @ np.asarray(normal, dtype=np.float64)
    above = side >= 0.0
    one, two, three = (above[corner] for corner in mesh.faces.T)
    faces = mesh.faces[(one != two) | (two != three)]
    if len(faces) == 0:
        return Section(np.empty((0, 2, 3)), np.empty((0, 2), dtype=np.int64))
    up = above[faces]
    lone_value = up.sum(axis=1) == 1
    lone = np.argmax(up == lone_value[:, None], axis=1)
    rows = np.arange(len(faces))
    tip, left, right = (faces[rows, (lone + k) % 3] for k in range(3))
    ends, ids = [], []
    for other in (left, right):
        low, high = np.minimum(tip, other), np.maximum(tip, other)
        t = (side[low] / (side[low] - side[high]))[:, None]
        ends.append(mesh.vertices[low] * (1.0 - t) + mesh.vertices[high] * t)
        ids.append(low * len(mesh.vertices) + high)
    return Section(np.stack(ends, axis=1), np.stack(ids, axis=1))


def join_segments(section: Section) -> list[tuple[Points, bool]]:
    """Join the segments into curves: a list of (points (k, 3) [mm], closed), longest first."""
    return [(section.points[rows], bool(rows[0] == rows[-1])) for rows in ordered_rows(section)]


def ordered_rows(section: Section) -> list[Indices]:
    """Join the segments into curves: the rows of ``section.points`` in order, the longest curve first.

    A closed curve ends with the row that it begins with.
    """
    ends = section.edge_ids
    _, first, node = np.unique(ends, return_index=True, return_inverse=True)
    node = node.reshape(ends.shape)
    order = np.argsort(node.ravel(), kind="stable")
    count = np.bincount(node.ravel(), minlength=len(first))
    # Plain lists from here: the walk goes from node to node, which arrays are slow at.
    segment, bound = (order // 2).tolist(), np.concatenate([[0], np.cumsum(count)]).tolist()
    both, used = node.sum(axis=1).tolist(), [False] * len(ends)

    def walk(at: int) -> list[int]:
        path = [at]
        while True:
            for row in segment[bound[at] : bound[at + 1]]:
                if not used[row]:
                    break
            else:
                return path
            used[row] = True
            at = both[row] - at
            path.append(at)

    seen = np.argsort(first)
    curves = []
    for start in np.concatenate([seen[count[seen] == 1], seen]).tolist():
        path = walk(start)
        if len(path) > 1:
            curves.append(first[path])
    if not curves:
        return []
    row = np.concatenate(curves)
    begin = np.cumsum([0, *map(len, curves)])[:-1]
    step = np.linalg.norm(np.diff(section.points[row], axis=0, append=0.0), axis=1)
    step[np.append(begin[1:], len(row)) - 1] = 0.0  # from one curve to the next
    return [curves[k] for k in np.argsort(-np.add.reduceat(step, begin), kind="stable").tolist()]


def arc_length(curve: Points) -> Floats:
    """Return the distance along ``curve``, shape (k, 3), from its first point, shape (k,) [mm]."""
    steps = np.linalg.norm(np.diff(curve, axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])


def resample(curve: Points, step: float) -> Points:
    """Return points every ``step`` [mm] along ``curve``, both ends kept; at most ``MOST_STEPS`` of them."""
    s = arc_length(curve)
    count = min(max(2, round(float(s[-1]) / step) + 1), MOST_STEPS)
    return interpolate(np.linspace(0.0, s[-1], count), s, curve)


def interpolate(
    at: Floats | Indices, known: Floats | Indices, rows: Floats, period: float | None = None
) -> Floats:
    """Return ``rows`` (k, c), which are those at the ascending values ``known`` (k,), at others, (n, c)."""
    return np.stack([np.interp(at, known, column, period=period) for column in rows.T], axis=1)


def downward(curve: Points, closed: bool, at: int, start: Points | None = None) -> list[Points]:
    """Return both ways along ``curve`` from its point ``at``, the one first that is lower after 18 mm.

    Both begin with that point, or with ``start`` (3,) [mm] in its place.
    """
    if closed:
        turned = np.roll(curve[:-1], -at, axis=0)
        ways = [turned, np.roll(turned[::-1], 1, axis=0)]
    else:
        ways = [curve[at:], curve[at::-1]]
    if start is not None:
        ways = [np.concatenate([start[None], way[1:]]) for way in ways]

    def height(way: Points) -> float:
        return float(np.interp(18.0, arc_length(way), way[:, 2])) if len(way) > 1 else np.inf

    return sorted(ways, key=height)


def curvature(x: Floats, y: Floats) -> Floats:
    """Return the curvature of a plane curve, shape (k,) [1/mm], positive where it turns from x to y."""
    if len(x) < 3:
        return np.zeros(len(x))
    dx, dy = np.gradient(x), np.gradient(y)
    bend = dx * np.gradient(dy) - dy * np.gradient(dx)
    return np.asarray(bend / np.maximum(dx**2 + dy**2, 1e-9) ** 1.5)


def hull_corners(places: Floats) -> Indices:
    """Return the rows of the corners of the convex outline of ``places``, (k, 2), counter-clockwise.

    None where they span no area.
    """
    try:
        return np.asarray(ConvexHull(places).vertices, dtype=np.int64)
    except (QhullError, ValueError):  # too few of them, or all on a line
        return np.empty(0, dtype=np.int64)


def hull_perimeter(points: Points) -> float:
    """Return the length of a tape round ``points``, shape (k, 3), in their level [mm]; 0 if none."""
    if len(points) < 3:
        return 0.0
    try:
        return float(ConvexHull(points[:, :2]).area)
    except QhullError:
        return 0.0


def hull_slopes(points: Points) -> Points:
    """Return the slopes of ``hull_perimeter`` by the points' places in their level, shape (k, 2) [1]."""
    slopes = np.zeros((len(points), 2))
    corners = hull_corners(points[:, :2])
    sides = points[corners, :2] - points[np.roll(corners, 1), :2]
    sides /= np.linalg.norm(sides, axis=1, keepdims=True)
    slopes[corners] = sides - np.roll(sides, -1, axis=0)
    return slopes
