"""Polylines on a skin followed from triangle to triangle: which edges each crosses, and where."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from core.errors import PatternError
from core.geometry.closest_point import barycentric, nearest_faces
from core.geometry.mesh import Flags, Floats, Indices, Mesh, Points, unit
from core.messages import Message
from core.pattern.triangle_strips import Strip, shortest_strip

SNAP = 4.0
"""An end within this distance of another curve is put on it [mm]. Source: ours."""

MARGIN = 0.04
"""Nearer than this to an edge or a corner, in parts of the triangle [1], no vertex is added. Source: ours."""

_INSIDE = 1e-3
"""Samples keep this distance from the edges of their triangle [1]: the search for a way then ends in it."""

_MOST_STEPS = 2000

_DETOUR = 10.0
"""A step may be so much longer over the skin than twice straight on [mm]; else it is astray. Source: ours."""

_FLIPPED = 8  # samples at most that were put on the opposite wall of a cleft


@dataclass(frozen=True, eq=False)
class SurfaceCurve:
    """A curve on the skin, ``points`` (k, 3) [mm]; closed where the last point is the first.

    A ``slit`` cuts a panel open and may end within it; any other curve separates panels. Nothing is sewn to
    a curve that ``is_edge``. A corner of a panel is where curves meet: a bend within a curve is rounded by
    up to one triangle of the skin.
    """

    name: str
    points: Points
    slit: bool = False
    is_edge: bool = False

    @property
    def is_closed(self) -> bool:
        """Return whether the curve ends where it begins."""
        return len(self.points) > 2 and float(np.linalg.norm(self.points[0] - self.points[-1])) < 1e-6


@dataclass(frozen=True, eq=False)
class Trace:
    """A curve as a sequence of s stations, and the triangle between each and the next, ``faces`` (s - 1,).

    A station is a place on the edge from vertex ``low`` to ``high``, ``share`` of the way (s, 3 arrays); or,
    where ``node`` (s,) is not -1, a place within a triangle that curves share by this number.
    """

    low: Indices
    high: Indices
    share: Floats
    node: Indices
    faces: Indices


@dataclass(frozen=True, eq=False)
class Traces:
    """The traces of all curves, and the shared places: their triangles (q,), shares of its corners (q, 3)."""

    curves: tuple[Trace, ...]
    node_faces: Indices
    node_shares: Floats


def trace_curves(mesh: Mesh, curves: tuple[SurfaceCurve, ...]) -> Traces:
    """Follow ``curves`` over ``mesh``.

    An end within ``SNAP`` of another curve is put on it. Between two points a curve is where the plane
    through both that is square to the skin cuts it, or, where that leads round the body, the shortest path.
    Points beside the opposite wall of a cleft are left out. Raises PatternError where the skin does not
    connect them.
    """
    joined, nodes = _join_ends(curves)
    ends = np.cumsum([len(points) for points in joined])
    node = np.concatenate(nodes)
    face, place = nearest_faces(mesh, np.concatenate(joined), mesh.centroid_tree)
    shares = np.clip(barycentric(mesh.vertices[mesh.faces[face]], place), 0.0, None)
    shares = np.maximum(shares, np.where(node >= 0, MARGIN, _INSIDE)[:, None])
    shares /= shares.sum(axis=1, keepdims=True)
    _, first = np.unique(node[node >= 0], return_index=True)
    first, shared = np.flatnonzero(node >= 0)[first], np.flatnonzero(node >= 0)
    face[shared], shares[shared] = face[first[node[shared]]], shares[first[node[shared]]]
    place = np.einsum("ij,ijk->ik", shares, mesh.vertices[mesh.faces[face]])
    samples = _Samples(face, place, node, ends)
    crossings, astray = _follow(mesh, samples)
    if (flipped := samples.between(astray)).any():
        fewer = samples.without(flipped)
        again, still = _follow(mesh, fewer)
        if len(still) < len(astray):
            samples, crossings = fewer, again
    if len(crossings.lost):
        lost = curves[int(np.searchsorted(samples.ends, crossings.lost[0], side="right"))]
        raise PatternError(
            Message('The skin cannot be followed along the curve "{name}".', name=lost.name),
            Message("Add a point to it, or keep it off holes and loose parts of the scan."),
        )
    return Traces(_stations(crossings, samples), face[first], shares[first])


@dataclass(frozen=True, eq=False)
class _Samples:
    """Points of all curves, each curve's before the next of ``ends``: triangle, ``place`` (g, 3) [mm], node.

    ``node`` is -1 for a point that is none.
    """

    face: Indices
    place: Points
    node: Indices
    ends: Indices

    @property
    def steps(self) -> Indices:
        """Return the samples from which a curve goes on to the next one."""
        return np.delete(np.arange(len(self.face)), self.ends - 1)

    def between(self, astray: Indices) -> Flags:
        """Return which samples, no nodes, are between two steps of a curve that are ``astray``, (g,).

        Few of them were put on the opposite wall of a cleft: the way to it is astray, and the way back.
        """
        found: Flags = np.zeros(len(self.face), dtype=bool)
        curve = np.searchsorted(self.ends, astray, side="right")
        open_at = -1
        for at in range(len(astray)):
            is_pair = open_at >= 0 and curve[open_at] == curve[at]
            if is_pair and astray[at] - astray[open_at] <= _FLIPPED:
                found[astray[open_at] + 1 : astray[at] + 1] = True
                open_at = -1
            else:
                open_at = at
        return found & (self.node < 0)

    def without(self, rows: Flags) -> _Samples:
        """Return the samples but those of the ``rows`` (g,)."""
        ends = self.ends - np.cumsum(rows)[self.ends - 1]
        return _Samples(self.face[~rows], self.place[~rows], self.node[~rows], ends)


def _join_ends(curves: tuple[SurfaceCurve, ...]) -> tuple[list[Points], list[Indices]]:
    """Put ends that lie near a curve on it; return all points, and the number of the node that each is.

    Curves that come first are left where they are. -1 marks points that are no node.
    """
    points: list[Points] = []
    nodes: list[Indices] = []
    total = 0
    for curve in curves:
        own, marks = np.asarray(curve.points, dtype=np.float64), np.full(len(curve.points), -1)
        if len(own) < 2:
            raise PatternError(Message('The curve "{name}" needs two points.', name=curve.name))
        if curve.is_closed:
            marks[[0, -1]] = total
            total += 1
        else:
            for end in (0, -1):
                own, marks, total = _join_end(own, marks, end, points, nodes, total)
        points.append(own)
        nodes.append(marks)
    return points, nodes


def _join_end(
    own: Points, marks: Indices, end: int, points: list[Points], nodes: list[Indices], total: int
) -> tuple[Points, Indices, int]:
    """Put one end of a curve on the nearest of the curves before it, or make it a node of its own."""
    away_from, curve, at, target = _nearest(own[end], points)
    if away_from >= SNAP:
        marks[end] = total
        return own, marks, total + 1
    line, mark = points[curve], nodes[curve]
    taken = np.flatnonzero(mark >= 0)
    away = np.linalg.norm(line[taken] - target, axis=1)
    if away.min(initial=np.inf) < SNAP:
        target, number = line[taken[away.argmin()]], mark[taken[away.argmin()]]
    else:
        number, total = total, total + 1
        points[curve] = np.insert(line, at + 1, target, axis=0)
        nodes[curve] = np.insert(mark, at + 1, number)
    keep = np.linalg.norm(own - target, axis=1) > 2.0 * max(away_from, 1e-3)
    keep |= marks >= 0
    keep[[0, -1]] = True
    own = own.copy()
    own[end], marks[end] = target, number
    return own[keep], marks[keep], total


def _nearest(place: Points, lines: list[Points]) -> tuple[float, int, int, Points]:
    """Return the distance of the nearest place on ``lines``, which line and step it is on, and itself."""
    if not lines:
        return np.inf, 0, 0, place
    whole, ends = np.concatenate(lines), np.cumsum([len(line) for line in lines])
    start, step = whole[:-1], np.diff(whole, axis=0)
    share = np.einsum("ij,ij->i", place - start, step)
    share = np.clip(share / np.maximum((step**2).sum(axis=1), 1e-300), 0.0, 1.0)
    away = np.linalg.norm(place - start - share[:, None] * step, axis=1)
    away[ends[:-1] - 1] = np.inf  # from one line to the next
    at = int(away.argmin())
    curve = int(np.searchsorted(ends, at, side="right"))
    return float(away[at]), curve, at - int(ends[curve]) + len(lines[curve]), start[at] + share[at] * step[at]


@dataclass(frozen=True, eq=False)
class _Crossings:
    """Crossings of edges: the sample before, the number after it, the edge, the share, the triangle.

    All (c,); ``lost`` are samples from which no way to the next was found.
    """

    sample: Indices
    number: Indices
    low: Indices
    high: Indices
    share: Floats
    face: Indices
    lost: Indices

    def through(self, sample: int, strip: Strip) -> _Crossings:
        """Return the same with the way from a ``sample`` to the next one through a ``strip``."""
        kept, count = self.sample != sample, len(strip.face)
        return _Crossings(
            np.append(self.sample[kept], np.full(count, sample)),
            np.append(self.number[kept], np.arange(count)),
            np.append(self.low[kept], strip.low),
            np.append(self.high[kept], strip.high),
            np.append(self.share[kept], strip.share),
            np.append(self.face[kept], strip.face),
            self.lost[self.lost != sample],
        )


def _follow(mesh: Mesh, samples: _Samples) -> tuple[_Crossings, Indices]:
    """Walk from sample to sample; return also the steps that are astray over the skin, or lost.

    Along the bottom of a cleft a plane may lead round the body: there the shortest path is taken.
    """
    found = _walk(mesh, mesh.face_neighbours, samples.face, samples.place, samples.steps)
    lengths, astray = _astray(mesh, found, samples.place)
    for number, length in zip(astray.tolist(), lengths.tolist(), strict=True):
        pair = slice(number, number + 2)
        one, two = samples.face[pair].tolist()
        strip = shortest_strip(mesh, (one, two), samples.place[pair])
        if strip is not None and strip.length < 0.5 * length:
            found = found.through(number, strip)
    return found, _astray(mesh, found, samples.place)[1]


def _astray(mesh: Mesh, crossings: _Crossings, place: Points) -> tuple[Floats, Indices]:
    """Return how long the steps that are astray are over the skin [mm], and from which samples they go."""
    order = np.lexsort([crossings.number, crossings.sample])
    sample, low, high = (column[order] for column in (crossings.sample, crossings.low, crossings.high))
    way = mesh.vertices[high] - mesh.vertices[low]
    at = mesh.vertices[low] + crossings.share[order][:, None] * way
    is_first = np.append(True, np.diff(sample) != 0)[: len(sample)]
    from_last = at - np.where(is_first[:, None], place[sample], np.roll(at, 1, axis=0))
    along = np.linalg.norm(from_last, axis=1)
    length: Floats = np.bincount(sample, along, len(place) - 1).astype(np.float64)
    is_last = np.roll(is_first, -1)
    length[sample[is_last]] += np.linalg.norm(place[sample[is_last] + 1] - at[is_last], axis=1)
    length[crossings.lost] = np.inf
    straight = np.linalg.norm(np.diff(place, axis=0), axis=1)
    astray = np.flatnonzero(length > 2.0 * straight + _DETOUR)
    return length[astray], np.asarray(astray)


def _walk(mesh: Mesh, neighbours: Indices, face: Indices, place: Points, sample: Indices) -> _Crossings:
    """Walk from each of the points ``sample`` (g,) to the next, all at once, a triangle a step."""
    normal = mesh.face_normals[face[:-1]] + mesh.face_normals[face[1:]]
    ahead = np.diff(place, axis=0)
    across = unit(np.cross(normal, ahead))
    sample = sample[face[sample] != face[sample + 1]]
    here, entered = face[sample], np.full(len(sample), -1)
    found, lost = [], []
    for number in range(_MOST_STEPS):
        if not len(sample):
            break
        corners = mesh.faces[here]
        after = np.roll(corners, -1, axis=1)
        low, high = np.minimum(corners, after), np.maximum(corners, after)
        start, normals = place[sample][:, None], across[sample][:, None]
        ends = mesh.vertices[low], mesh.vertices[high]
        at_low, at_high = (np.einsum("ijk,ijk->ij", end - start, normals) for end in ends)
        crossed = (at_low >= 0.0) != (at_high >= 0.0)
        share = at_low / np.where(crossed, at_low - at_high, 1.0)
        key = low * len(mesh.vertices) + high
        way = ends[0] + share[..., None] * (ends[1] - ends[0]) - start
        forward = np.einsum("ijk,ik->ij", way, ahead[sample])
        value = np.where(crossed & (key != entered[:, None]), forward, -np.inf)
        row, out = np.arange(len(sample)), value.argmax(axis=1)
        beyond = np.where(np.isfinite(value[row, out]), neighbours[here, out], -1)
        good = beyond >= 0
        lost.append(sample[~good])
        row, out, sample, here = row[good], out[good], sample[good], beyond[good]
        steps = np.full(len(row), number)
        found.append((sample, steps, low[row, out], high[row, out], share[row, out], here))
        going = here != face[sample + 1]
        sample, here, entered = sample[going], here[going], key[row, out][going]
    none = np.empty(0, dtype=np.int64)
    columns = zip(*found, strict=True) if found else [[none]] * 6
    samples, numbers, lows, highs, shares, faces = (np.concatenate(column) for column in columns)
    return _Crossings(samples, numbers, lows, highs, shares, faces, np.sort(np.concatenate([*lost, sample])))


def _stations(crossings: _Crossings, samples: _Samples) -> tuple[Trace, ...]:
    """Put crossings and nodes of all curves in order."""
    node, face, ends = samples.node, samples.face, samples.ends
    nodes = np.flatnonzero(node >= 0)
    sample = np.concatenate([nodes, crossings.sample])
    order = np.lexsort([np.concatenate([np.full(len(nodes), -1), crossings.number]), sample])
    blank = np.full(len(nodes), -1)
    low, high, share, number, after = (
        np.concatenate(pair)[order]
        for pair in (
            (blank, crossings.low),
            (blank, crossings.high),
            (np.zeros(len(nodes)), crossings.share),
            (node[nodes], np.full(len(crossings.sample), -1)),
            (face[nodes], crossings.face),
        )
    )
    bounds = np.searchsorted(sample[order], np.append(0, ends))
    rows = [slice(first, end) for first, end in pairwise(bounds.tolist())]
    return tuple(
        _without_returns(Trace(low[at], high[at], share[at], number[at], after[at][:-1])) for at in rows
    )


def _without_returns(trace: Trace) -> Trace:
    """Leave out pairs of crossings that lead over an edge and straight back."""
    while True:
        low, high, node = trace.low, trace.high, trace.node
        back = (low[1:] == low[:-1]) & (high[1:] == high[:-1]) & (node[1:] < 0) & (node[:-1] < 0)
        first = np.flatnonzero(back)
        if not len(first):
            return trace
        first = first[np.diff(first, prepend=-2) > 1]
        gone = np.concatenate([first, first + 1])
        low, high, node = (np.delete(each, gone) for each in (low, high, node))
        trace = Trace(low, high, np.delete(trace.share, gone), node, np.delete(trace.faces, gone))
