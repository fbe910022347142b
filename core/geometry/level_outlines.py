"""Horizontal outlines of a mesh, many levels at once: their pieces, their polygons, their reach all round."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from core.errors import LandmarkError
from core.geometry.mesh import Flags, Floats, Indices, Mesh, Points, rows_of
from core.messages import Message

BINS = 120
"""Directions in which the reach of an outline is told, 3 degrees apart."""

BEARINGS = (np.arange(BINS) + 0.5) * (2.0 * np.pi / BINS) - np.pi
"""Bearing of each direction [rad]: 0 is the front (-y), positive towards the left (+x)."""


MOST_SEGMENTS = 1_000_000
"""Where levels a few mm apart cut a skin into more segments, most triangles run right through the body."""

BLOCK = 1 << 18
"""Segments are told apart by direction so many at a time, so that what is worked out for them stays small."""

MOST_JOINED = 200
"""Open pieces of a level that are joined to one outline; scans with holes have at most 10."""


@dataclass(frozen=True, eq=False)
class Pieces:
    """Connected pieces of outline: their box in the level [mm], their level, and whether they close."""

    low: Points
    high: Points
    level: Indices
    closed: Flags

    @property
    def centre(self) -> Points:
        """Return the middle of each box, shape (p, 2) [mm]."""
        return 0.5 * (self.low + self.high)

    @property
    def size(self) -> Floats:
        """Return the area of each box, shape (p,) [mm^2]."""
        return np.asarray(np.prod(self.high - self.low, axis=1))


@dataclass(frozen=True, eq=False)
class Outlines:
    """Cuts of a mesh at heights ``z``, shape (k,): ``segments``, shape (s, 2, 3) [mm].

    ``ids`` are the mesh edges that their ends lie on, shape (s, 2); ``level`` and ``piece`` tell where each
    segment belongs.
    """

    z: Floats
    segments: Points
    ids: Indices
    level: Indices
    piece: Indices
    pieces: Pieces

    def rows(self) -> Iterator[Indices]:
        """Yield the rows of the segments of each level."""
        return _rows_by(self.level, len(self.z))

    def piece_rows(self) -> Iterator[Indices]:
        """Yield the pieces of each level."""
        return _rows_by(self.pieces.level, len(self.z))


def outlines(mesh: Mesh, z: Floats) -> Outlines:
    """Cut ``mesh`` at ascending heights, shape (k,) [mm]. Raises LandmarkError if no skin is cut so.

    Source: ours.
    """
    segments, ids, level = _cut_levels(mesh, z)
    if len(segments) == 0:
        none = np.empty((0, 2))
        pieces = Pieces(none, none, np.empty(0, dtype=np.int64), np.empty(0, dtype=bool))
        return Outlines(z, segments, ids, level, level, pieces)
    piece, closed = _connected(ids)
    return Outlines(z, segments, ids, level, piece, _describe(segments, piece, level, closed))


def _cut_levels(mesh: Mesh, z: Floats) -> tuple[Points, Indices, Indices]:
    """Return the segments of all levels, the edges that their ends lie on, shape (s, 2), and their levels."""
    # how many levels each corner lies over
    below = np.searchsorted(z, mesh.vertices[:, 2], side="right")
    over = np.stack([below[corner] for corner in mesh.faces.T])
    first = over.min(axis=0)
    count = over.max(axis=0) - first
    if count.sum() > MOST_SEGMENTS:
        raise not_a_surface_error()
    face = np.repeat(np.arange(len(mesh.faces)), count)
    level = np.arange(len(face)) - np.repeat(np.cumsum(count) - count - first, count)
    above = over[:, face] > level
    lone = np.argmax(above == (above.sum(axis=0) == 1), axis=0)
    corners = mesh.faces[face]
    rows = np.arange(len(face))
    tip = corners[rows, lone]
    ends, ids = [], []
    for turn in (1, 2):
        other = corners[rows, (lone + turn) % 3]
        low, high = np.minimum(tip, other), np.maximum(tip, other)
        a, b = mesh.vertices[low], mesh.vertices[high]
        ends.append(a + (b - a) * ((z[level] - a[:, 2]) / (b[:, 2] - a[:, 2]))[:, None])
        ids.append((level * len(mesh.vertices) + low) * len(mesh.vertices) + high)
    return np.stack(ends, axis=1), np.stack(ids, axis=1), level


def not_a_surface_error() -> LandmarkError:
    """Return the refusal of a skin most of which is none."""
    return LandmarkError(
        Message("Triangles of this scan cross the inside of the body."),
        Message("Export only the body surface."),
    )


def _connected(ids: Indices) -> tuple[Indices, Flags]:
    """Return the connected piece of each segment, and whether each piece closes."""
    nodes, index = np.unique(ids, return_inverse=True)
    index = index.reshape(ids.shape)
    graph = sparse.coo_array((np.ones(len(ids)), (index[:, 0], index[:, 1])), shape=(len(nodes),) * 2)
    count, label = connected_components(graph, directed=False)
    loose = np.bincount(index.ravel(), minlength=len(nodes)) == 1
    closed = np.bincount(label, weights=loose, minlength=count) == 0
    return np.asarray(label[index[:, 0]], dtype=np.int64), closed


def _describe(segments: Points, piece: Indices, level: Indices, closed: Flags) -> Pieces:
    order = np.argsort(piece, kind="stable")
    start = np.searchsorted(piece[order], np.arange(len(closed)))
    flat = segments[order, :, :2]
    low = np.minimum.reduceat(np.minimum(flat[:, 0], flat[:, 1]), start, axis=0)
    high = np.maximum.reduceat(np.maximum(flat[:, 0], flat[:, 1]), start, axis=0)
    return Pieces(low, high, level[order[start]], closed)


def _rows_by(group: Indices, count: int) -> Iterator[Indices]:
    order = np.argsort(group, kind="stable")
    bounds = np.searchsorted(group[order], np.arange(count + 1))
    return (order[a:b] for a, b in pairwise(bounds))


def ring(segments: Points, ids: Indices) -> tuple[Indices, Points]:
    """Return the rows of segments in order round an outline, shape (r,), and where each begins, (r, 2) [mm].

    ``segments``, shape (s, 2, 3) [mm], with ``ids`` of their ends, shape (s, 2). Pieces that are open are
    joined, the nearest ends first, at most ``MOST_JOINED`` of them, the longest; of closed ones only the
    longest counts. Source: ours.
    """
    paths = sorted(_paths(ids), key=len, reverse=True)
    closed = [path for path in paths if _is_closed(ids, path)]
    if closed and len(closed[0]) >= len(paths[0]):
        whole = closed[0]
    else:
        whole = _joined(segments, [path for path in paths if not _is_closed(ids, path)][:MOST_JOINED])
    ends = np.array(whole)
    return ends >> 1, segments[ends >> 1, ends & 1, :2]


def _paths(ids: Indices) -> list[list[int]]:
    """Return chains of segment ends: each is where a segment (twice its row, plus its end) is entered."""
    flat = ids.ravel()
    order = np.argsort(flat, kind="stable")
    same = np.flatnonzero(flat[order[1:]] == flat[order[:-1]])
    partner = np.full(len(flat), -1)
    partner[order[same]], partner[order[same + 1]] = order[same + 1], order[same]
    after = partner.tolist()
    seen = [False] * len(ids)
    paths = []
    for start in [*np.flatnonzero(partner < 0).tolist(), *range(0, len(flat), 2)]:
        path, at = [], start
        while at >= 0 and not seen[at >> 1]:
            seen[at >> 1] = True
            path.append(at)
            at = after[at ^ 1]
        if path:
            paths.append(path)
    return paths


def _is_closed(ids: Indices, path: list[int]) -> bool:
    first, last = path[0], path[-1] ^ 1
    return len(path) > 2 and bool(ids[first >> 1, first & 1] == ids[last >> 1, last & 1])


def _joined(segments: Points, paths: list[list[int]]) -> list[int]:
    """Join open chains, longest first, each time with the nearest end of the others."""
    ends = np.array([[path[0], path[-1] ^ 1] for path in paths])
    doors = segments[ends >> 1, ends & 1]
    free = np.ones((len(paths), 1), dtype=bool)
    whole, at, free[0] = list(paths[0]), doors[0, 1], False
    for _ in paths[1:]:
        away = np.where(free, ((doors - at) ** 2).sum(axis=2), np.inf)
        path, end = divmod(int(np.argmin(away)), 2)
        whole += [entry ^ 1 for entry in reversed(paths[path])] if end else paths[path]
        at, free[path] = doors[path, 1 - end], False
    return whole


def radii(segments: Points, level: Indices, centre: Points, bins: int = BINS) -> Floats:
    """Return how far outlines reach from a centre in each direction, shape (k, bins) [mm]; NaN where open.

    ``segments``, shape (s, 2, 3), lie on levels ``level``, shape (s,), round ``centre``, shape (k, 2) [mm].
    """
    result = np.full((len(centre), bins), -np.inf)
    a, b = (segments[:, k, :2] - centre[level] for k in (0, 1))
    first, second = (np.arctan2(p[:, 0], -p[:, 1]) for p in (a, b))
    turn = np.mod(second - first + np.pi, 2.0 * np.pi) - np.pi
    start, step = np.where(turn >= 0.0, first, first + turn), np.abs(turn)
    width = 2.0 * np.pi / bins
    low = np.ceil((start + np.pi) / width - 0.5).astype(np.int64)
    count = np.maximum(np.floor((start + step + np.pi) / width - 0.5).astype(np.int64) - low + 1, 0)
    ends = np.cumsum(count)
    for begin in range(0, int(count.sum()), BLOCK):
        row = rows_of(ends, begin, min(begin + BLOCK, int(ends[-1])))
        bin_ = np.arange(begin, begin + len(row)) - (ends - count - low)[row]
        bearing = (bin_ + 0.5) * width - np.pi
        out = np.stack([np.sin(bearing), -np.cos(bearing)], axis=1)
        along = b[row] - a[row]
        cross = out[:, 0] * along[:, 1] - out[:, 1] * along[:, 0]
        distance = (a[row, 0] * along[:, 1] - a[row, 1] * along[:, 0]) / np.where(cross == 0.0, np.nan, cross)
        good = np.isfinite(distance)
        np.maximum.at(result.reshape(-1), level[row[good]] * bins + bin_[good] % bins, distance[good])
    return np.where(np.isfinite(result), result, np.nan)


def points_at(radius: Floats, bins: Indices, centre: Points, z: float) -> Points:
    """Return the points at ``radius``, shape (b,) [mm], in directions ``bins`` from a centre, (b, 3) [mm]."""
    bearing = BEARINGS[bins]
    x, y = centre[0] + radius * np.sin(bearing), centre[1] - radius * np.cos(bearing)
    return np.stack([x, y, np.full(len(bins), z)], axis=1)
