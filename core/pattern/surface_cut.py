"""Curves on a skin become edges of its triangles; new vertices keep their shares of the skin's."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse

from core.geometry.mesh import Faces, Flags, Floats, Indices, Mesh, Points, face_neighbours
from core.pattern.point_triangulation import greedy_triangles
from core.pattern.surface_trace import MARGIN, SNAP, SurfaceCurve, Traces, trace_curves

_FEWEST = 4  # stations of a curve whose ends may be taken together with those beside them


@dataclass(frozen=True, eq=False)
class CutSkin:
    """A ``skin`` whose triangles end at ``curves``.

    ``mix`` (w, n): the vertices from the n of the skin, whose own come first; ``faces`` (m, 3) in which
    triangle of the skin each lies, ``origin`` (m,). ``edges`` (e, 2), lower vertex first, lie on curves,
    each on that with the number ``curve`` (e,), the first where several share it. ``chains`` are the vertices
    of each curve in order, ``vertices`` (w, 3) [mm] where all were when it was cut.
    """

    skin: Mesh
    curves: tuple[SurfaceCurve, ...]
    mix: sparse.csr_array
    vertices: Points
    faces: Faces
    origin: Indices
    edges: Indices
    curve: Indices
    chains: tuple[Indices, ...]

    @cached_property
    def face_neighbours(self) -> Indices:
        """Return the triangle beyond each side 0-1, 1-2, 2-0 of the faces, -1 if there is none, (m, 3)."""
        whole = np.flatnonzero((self.faces == self.skin.faces[self.origin]).all(axis=1))
        number = np.full(len(self.skin.faces), -1)
        number[self.origin[whole]] = whole
        beyond, on_skin = np.full(self.faces.shape, -1), self.skin.face_neighbours[self.origin[whole]]
        beyond[whole] = np.where(on_skin >= 0, number[on_skin], -1)
        rest = np.flatnonzero((beyond < 0).any(axis=1))  # only these are beside triangles that were cut
        after = face_neighbours(self.faces[rest])
        beyond[rest] = np.where(after >= 0, rest[after], beyond[rest])
        return beyond


def cut_surface(mesh: Mesh, curves: tuple[SurfaceCurve, ...], within: Flags | None = None) -> CutSkin:
    """Make ``curves`` on ``mesh`` edges of it; they may cross and end on each other.

    Triangles that no curve touches are left out unless they are ``within`` (m,); by default all are. Raises
    PatternError where a curve cannot be followed over the skin.
    """
    points, gaps = _points_and_gaps(mesh, trace_curves(mesh, curves))
    points, gaps = _divided(mesh, points, gaps)
    mix = points.mix(len(mesh.vertices))
    vertices = np.asarray(mix @ mesh.vertices)
    faces, origin = _cut_faces(mesh, points, vertices, gaps, within)
    low, high = np.minimum(gaps.start, gaps.end), np.maximum(gaps.start, gaps.end)
    key, first = np.unique(low * len(points.corners) + high, return_index=True)
    edges = np.stack([key // len(points.corners), key % len(points.corners)], axis=1)
    breaks = np.flatnonzero(np.diff(gaps.curve)) + 1
    starts, ends = np.split(gaps.start, breaks), np.split(gaps.end, breaks)
    chains = tuple(np.append(start, end[-1]) for start, end in zip(starts, ends, strict=True))
    return CutSkin(mesh, curves, mix, vertices, faces, origin, edges, gaps.curve[first], chains)


@dataclass(frozen=True, eq=False)
class _Vertices:
    """All vertices as ``shares`` (w, 3) of the vertices ``corners`` (w, 3) of the skin, its own first."""

    corners: Indices
    shares: Floats

    def mix(self, count: int) -> sparse.csr_array:
        """Return the matrix of the shares, (w, count)."""
        shares, corners = self.shares[count:], self.corners[count:]
        rows = np.repeat(np.arange(len(shares)), 3)
        added = sparse.csr_array((shares.ravel(), (rows, corners.ravel())), (len(shares), count))
        added.eliminate_zeros()
        return sparse.csr_array(sparse.vstack([sparse.eye_array(count, format="csr"), added]))

    def places(self, mesh: Mesh) -> Points:
        """Return where the vertices are, (w, 3) [mm]."""
        return np.asarray(np.einsum("wk,wkx->wx", self.shares, mesh.vertices[self.corners]))

    def within(self, faces: Faces, vertices: Indices) -> Floats:
        """Return the shares of the corners of ``faces`` (k, 3) in ``vertices`` (k,) of them, (k, 3) [1]."""
        same = faces[:, :, None] == self.corners[vertices][:, None]
        return np.asarray((same * self.shares[vertices][:, None]).sum(axis=2))


@dataclass(frozen=True, eq=False)
class _Gaps:
    """Steps of curves from vertex to vertex, in order: ``start``, ``end``, triangle ``face``, ``curve``.

    All (g,). Those ``along`` an edge of the skin run on it, the others through their triangle.
    """

    start: Indices
    end: Indices
    face: Indices
    curve: Indices
    along: Flags


def _points_and_gaps(mesh: Mesh, traces: Traces) -> tuple[_Vertices, _Gaps]:
    """Make vertices of stations: those near a vertex of the skin, or near each other on an edge, are one."""
    low, high, share, node = (
        np.concatenate([getattr(trace, name) for trace in traces.curves])
        for name in ("low", "high", "share", "node")
    )
    count, nodes = len(mesh.vertices), len(traces.node_faces)
    crossing = np.flatnonzero(node < 0)
    order = crossing[np.lexsort([share[crossing], low[crossing] * count + high[crossing]])]
    same = (np.diff(low[order]) == 0) & (np.diff(high[order]) == 0) & (np.diff(share[order]) < MARGIN)
    begins = np.append(True, ~same)[: len(order)]
    first, group = order[begins], np.cumsum(begins) - 1
    mean = np.bincount(group, share[order]) / np.bincount(group)
    vertex = count + node
    vertex[order] = count + nodes + group
    vertex[crossing] = np.where(share < MARGIN, low, np.where(share > 1.0 - MARGIN, high, vertex))[crossing]
    own = np.repeat(np.arange(count)[:, None], 3, axis=1)
    on_edge = np.stack([low[first], high[first], high[first]], axis=1)
    corners = np.concatenate([own, mesh.faces[traces.node_faces], on_edge])
    edge_shares = np.stack([1.0 - mean, mean, np.zeros(len(mean))], axis=1)
    corner = np.repeat([[1.0, 0.0, 0.0]], count, axis=0)
    points = _Vertices(corners, np.concatenate([corner, traces.node_shares, edge_shares]))
    ends = np.cumsum([len(trace.low) for trace in traces.curves])
    shared = _shared_starts(vertex, ends, count, count + nodes, points.places(mesh))
    for at_node, apart in shared.items():
        vertex[vertex == at_node] = apart
    fixed = np.array([*range(count, count + nodes), *shared.values()])
    chains = [
        _without_spikes(chain, trace.faces, fixed)
        for chain, trace in zip(np.split(vertex, ends[:-1]), traces.curves, strict=True)
    ]
    start, end = (np.concatenate([chain[at] for chain, _ in chains]) for at in (slice(-1), slice(1, None)))
    face = np.concatenate([faces for _, faces in chains])
    curve = np.repeat(np.arange(len(chains)), [len(faces) for _, faces in chains])
    there, back = (points.within(mesh.faces[face], at) for at in (start, end))
    return points, _Gaps(start, end, face, curve, ((there == 0.0) & (back == 0.0)).any(axis=1))


def _shared_starts(vertex: Indices, ends: Indices, low: int, high: int, places: Points) -> dict[int, int]:
    """Return for nodes from which curves run together the vertex where they part, which takes their place.

    Curves that leave a node at a small angle cross the first edge of the skin at one vertex. Up to there they
    would be a side of their own, which no block has. ``vertex`` (s,) are the stations of all curves, which
    end before ``ends``; those from ``low`` up to ``high`` are nodes.
    """
    curve = np.repeat(np.arange(len(ends)), np.diff(ends, prepend=0))
    step = np.flatnonzero(np.diff(curve) == 0)
    both = np.concatenate([np.stack([vertex[step], vertex[step + 1]], 1)] * 2)
    both[len(step) :] = both[len(step) :, ::-1]
    is_node = (both >= low) & (both < high)
    from_node = is_node[:, 0] & ~is_node[:, 1] & (np.bincount(curve)[np.tile(curve[step], 2)] > _FEWEST)
    steps = np.column_stack([both, np.tile(curve[step], 2)])[from_node]
    pair, times = np.unique(np.unique(steps, axis=0)[:, :2], axis=0, return_counts=True)
    pair = pair[times > 1]
    away = np.linalg.norm(places[pair[:, 0]] - places[pair[:, 1]], axis=1)
    nearest = np.argsort(-away, kind="stable")
    return {int(pair[at, 0]): int(pair[at, 1]) for at in nearest if away[at] < SNAP}


def _without_spikes(chain: Indices, faces: Indices, fixed: Indices) -> tuple[Indices, Indices]:
    """Leave out steps that lead nowhere, and those to a vertex and straight back, but to those ``fixed``.

    ``chain`` (s,) are vertices, ``faces`` (s - 1,) lie between.
    """
    while True:
        still = np.flatnonzero(chain[1:] == chain[:-1])
        if not len(still):
            spike = np.flatnonzero((chain[2:] == chain[:-2]) & ~np.isin(chain[1:-1], fixed))
            spike = spike[np.diff(spike, prepend=-3) > 2]
            still = np.concatenate([spike, spike + 1])
        if not len(still) or len(chain) - len(still) < 2:
            return chain, faces
        chain, faces = np.delete(chain, still), np.delete(faces, still)


def _divided(mesh: Mesh, points: _Vertices, gaps: _Gaps) -> tuple[_Vertices, _Gaps]:
    """Divide gaps where they cross each other, and those along an edge at the vertices on it."""
    points, gap, vertex, share = _meetings(mesh, points, gaps)
    on_gap, on_vertex, on_share = _between(mesh, points, gaps)
    number = np.arange(len(gaps.start))
    gap = np.concatenate([number, number, gap, on_gap])
    vertex = np.concatenate([gaps.start, gaps.end, vertex, on_vertex])
    share = np.concatenate([np.zeros(len(number)), np.ones(len(number)), share, on_share])
    order = np.lexsort([share, gap])
    gap, vertex = gap[order], vertex[order]
    kept = np.flatnonzero((np.diff(gap) == 0) & (np.diff(vertex) != 0))
    source = gap[kept]
    parts = _Gaps(vertex[kept], vertex[kept + 1], gaps.face[source], gaps.curve[source], gaps.along[source])
    return points, parts


def _meetings(mesh: Mesh, points: _Vertices, gaps: _Gaps) -> tuple[_Vertices, Indices, Indices, Floats]:
    """Add a vertex where gaps cross; return also the gaps (k,), their new vertex and the share of the way."""
    through = np.flatnonzero(~gaps.along)
    through = through[np.argsort(gaps.face[through], kind="stable")]
    face = gaps.face[through]
    pairs = []
    for step in range(1, int(np.bincount(np.unique(face, return_inverse=True)[1]).max(initial=1))):
        at = np.flatnonzero(face[step:] == face[:-step])
        pairs.append(np.stack([through[at], through[at + step]], axis=1))
    pair = np.concatenate(pairs) if pairs else np.empty((0, 2), dtype=np.int64)
    ends = np.concatenate([gaps.start[pair], gaps.end[pair]], axis=1)
    apart = np.array([len(set(row)) == 4 for row in ends.tolist()], dtype=bool)
    pair, ends = pair[apart], ends[apart][:, [0, 2, 1, 3]]
    corners = mesh.faces[gaps.face[pair[:, 0]]]
    a, b, c, d = (points.within(corners, column) for column in ends.T)
    normal, other = np.cross(c, d), np.cross(a, b)
    a_off, b_off, c_off, d_off = (
        np.einsum("ij,ij->i", normal if at < 2 else other, place) for at, place in enumerate((a, b, c, d))
    )
    meet = (a_off * b_off < 0.0) & (c_off * d_off < 0.0)
    first, second = (p[meet] / (p[meet] - q[meet]) for p, q in ((a_off, b_off), (c_off, d_off)))
    shares = a[meet] + first[:, None] * (b[meet] - a[meet])
    number, corners, shares = _merged(gaps.face[pair[meet, 0]], corners[meet], shares)
    grown = _Vertices(np.concatenate([points.corners, corners]), np.concatenate([points.shares, shares]))
    vertex = np.tile(len(points.corners) + number, 2)
    return grown, pair[meet].T.ravel(), vertex, np.concatenate([first, second])


def _merged(face: Indices, corners: Faces, shares: Floats) -> tuple[Indices, Faces, Floats]:
    """Make one of places of one triangle that nearly coincide; return the number of each place too."""
    near = np.abs(shares[:, None] - shares).max(axis=2) < MARGIN
    near &= face[:, None] == face
    count, number = sparse.csgraph.connected_components(sparse.csr_array(near), directed=False)
    first = np.unique(number, return_index=True)[1]
    mean = np.stack([np.bincount(number, column, count) for column in shares.T], axis=1)
    return (
        number.astype(np.int64),
        corners[first],
        mean / np.maximum(np.bincount(number, minlength=count), 1)[:, None],
    )


def _between(mesh: Mesh, points: _Vertices, gaps: _Gaps) -> tuple[Indices, Indices, Floats]:
    """Return gaps along an edge (k,), a vertex between their ends for each, and the share of the way."""
    used = np.unique(np.concatenate([gaps.start, gaps.end]))
    used = used[(used >= len(mesh.vertices)) & (points.shares[used, 2] == 0.0)]
    on_edge: dict[tuple[int, int], list[tuple[float, int]]] = {}
    for vertex, (low, high), share in zip(
        used.tolist(), points.corners[used, :2].tolist(), points.shares[used, 1].tolist(), strict=True
    ):
        on_edge.setdefault((low, high), []).append((share, vertex))
    along = np.flatnonzero(gaps.along)
    corners = mesh.faces[gaps.face[along]]
    start, end = (points.within(corners, at[along]) for at in (gaps.start, gaps.end))
    beside = ((start == 0.0) & (end == 0.0)).argmax(axis=1)[:, None]
    edge = np.take_along_axis(corners, (beside + np.array([1, 2])) % 3, axis=1)
    high = (beside + 1 + edge.argmax(axis=1)[:, None]) % 3
    begin, stop = (np.take_along_axis(at, high, axis=1)[:, 0] for at in (start, end))
    found = [(-1, -1, 0.0)]
    for gap, (low_end, high_end), first, last in zip(
        along.tolist(), np.sort(edge, axis=1).tolist(), begin.tolist(), stop.tolist(), strict=True
    ):
        for share, vertex in on_edge.get((low_end, high_end), ()):
            if min(first, last) < share < max(first, last):
                found.append((gap, vertex, (share - first) / (last - first)))
    gap_of, vertex_of, share_of = (np.array(column[1:]) for column in zip(*found, strict=True))
    return gap_of.astype(np.int64), vertex_of.astype(np.int64), share_of.astype(np.float64)


def _cut_faces(
    mesh: Mesh, points: _Vertices, places: Points, gaps: _Gaps, within: Flags | None
) -> tuple[Faces, Indices]:
    """Cut the triangles that curves touch; return all, and the triangle of the skin each is of."""
    face = np.concatenate([gaps.face, gaps.face])
    vertex = np.concatenate([gaps.start, gaps.end])
    added = vertex >= len(mesh.vertices)
    face, vertex = face[added], vertex[added]
    zero = points.within(mesh.faces[face], vertex) == 0.0
    edge = zero.any(axis=1)
    across = mesh.face_neighbours[face, (zero.argmax(axis=1) + 1) % 3]
    edge &= across >= 0
    key = np.concatenate([face, across[edge]]) * len(points.corners) + np.concatenate([vertex, vertex[edge]])
    face, vertex = np.divmod(np.unique(key), len(points.corners))
    chord = ~gaps.along
    chords = gaps.face[chord], gaps.start[chord], gaps.end[chord]
    touched, number = np.unique(face, return_counts=True)
    parts, owners = [], []
    begin = np.cumsum(number) - number
    for count in np.unique(number).tolist():
        of = np.flatnonzero(number == count)
        rows = touched[of]
        ids = np.concatenate([mesh.faces[rows], vertex[begin[of][:, None] + np.arange(count)]], axis=1)
        shares = points.within(np.repeat(mesh.faces[rows], count + 3, axis=0), ids.ravel()).reshape(
            len(rows), count + 3, 3
        )
        owner, faces = greedy_triangles(shares, places[ids], _lines(rows, ids, *chords))
        parts.append(ids[owner[:, None], faces])
        owners.append(rows[owner])
    left = np.ones(len(mesh.faces), dtype=bool) if within is None else within.copy()
    left[touched] = False
    whole = np.flatnonzero(left)
    return np.concatenate([mesh.faces[whole], *parts]), np.concatenate([whole, *owners])


def _lines(rows: Indices, ids: Indices, face: Indices, start: Indices, end: Indices) -> Flags:
    """Return which pairs of ``ids`` (f, n) of the triangles ``rows`` (f,) are joined by a step, (f, n, n)."""
    at = np.searchsorted(rows, face)
    at[at == len(rows)] = 0
    inside = rows[at] == face
    at, start, end = at[inside], start[inside], end[inside]
    one, two = ((ids[at] == vertex[:, None]).argmax(axis=1) for vertex in (start, end))
    lines = np.zeros((*ids.shape, ids.shape[1]), dtype=bool)
    lines[at, one, two] = lines[at, two, one] = True
    return lines
