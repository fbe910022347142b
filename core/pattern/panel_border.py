"""Curves on a cut skin as pieces from node to node, and the panels between them."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np
from scipy import sparse

from core.errors import PatternError
from core.geometry.closest_point import nearest_faces, nearest_on
from core.geometry.mesh import Faces, Flags, Indices, Points, area_vectors, half_edges, own_vertices
from core.messages import Message
from core.pattern.even_points import cut_open
from core.pattern.surface_cut import CutSkin

Run = tuple[int, bool, Indices]
"""The number of a piece of border, whether it is followed as it leads, and the vertices in order, (k,)."""


@dataclass(frozen=True, eq=False)
class BorderPiece:
    """A part of a curve between two nodes: its number, and its vertices of the cut skin in order, (k,)."""

    curve: int
    chain: Indices


@dataclass(frozen=True, eq=False)
class SeamNet:
    """All curves of a ``cut`` skin as ``pieces``, and where each of its edges is in them.

    Edge e of a curve leads from vertex ``place[e]`` of the chain of piece ``piece[e]``, which is
    ``begin[e]``, to the next.
    """

    cut: CutSkin
    pieces: tuple[BorderPiece, ...]
    piece: Indices
    place: Indices
    begin: Indices

    @cached_property
    def _keys(self) -> Indices:
        return np.asarray(self.cut.edges[:, 0] << 31 | self.cut.edges[:, 1])

    @cached_property
    def _on_curve(self) -> Flags:
        flags = np.zeros(len(self.cut.vertices), dtype=bool)
        flags[self.cut.edges] = True
        return flags

    def find(self, sides: Indices) -> Indices:
        """Return the edge of a curve that each of ``sides`` (k, 2) is, -1 if none, (k,)."""
        found = np.full(len(sides), -1)
        may = np.flatnonzero(self._on_curve[sides[:, 0]] & self._on_curve[sides[:, 1]])
        key = sides[may].min(axis=1) << 31 | sides[may].max(axis=1)
        at = np.minimum(np.searchsorted(self._keys, key), len(self._keys) - 1)
        found[may] = np.where(self._keys[at] == key, at, -1)
        return found


def seam_net(cut: CutSkin) -> SeamNet:
    """Divide the curves of ``cut`` at the nodes: where they meet, end, or another of them goes on."""
    edges, count = cut.edges, len(cut.edges)
    vertex, edge = edges.ravel(), np.repeat(np.arange(count), 2)
    order = np.argsort(vertex, kind="stable")
    vertex, edge = vertex[order], edge[order]
    first = np.flatnonzero((vertex[1:] == vertex[:-1]) & (np.bincount(vertex)[vertex[1:]] == 2))
    one, two = edge[first], edge[first + 1]
    same = cut.curve[one] == cut.curve[two]
    passed = set(vertex[first[same]].tolist())
    graph = sparse.coo_array((np.ones(same.sum()), (one[same], two[same])), (count, count))
    label = sparse.csgraph.connected_components(graph, directed=False)[1]
    pieces, place, begin = [], np.empty(count, dtype=np.int64), np.empty(count, dtype=np.int64)
    for number in range(int(label.max(initial=-1)) + 1):
        rows = np.flatnonzero(label == number)
        chain, at = _chain(edges[rows], passed, cut.chains[int(cut.curve[rows[0]])])
        place[rows], begin[rows] = at, chain[at]
        pieces.append(BorderPiece(int(cut.curve[rows[0]]), chain))
    return SeamNet(cut, tuple(pieces), label.astype(np.int64), place, begin)


def _chain(edges: Indices, passed: set[int], curve: Indices) -> tuple[Indices, Indices]:
    """Put ``edges`` (k, 2) in order, from the lower-numbered node on; return vertices and each edge's place.

    A ring without a node begins where its curve does.
    """
    beside: dict[int, list[tuple[int, int]]] = defaultdict(list)
    for edge, (low, high) in enumerate(edges.tolist()):
        beside[low].append((high, edge))
        beside[high].append((low, edge))
    nodes = [vertex for vertex in beside if vertex not in passed]
    at = min(nodes) if nodes else int(curve[0])
    chain, place = [at], np.full(len(edges), -1, dtype=np.int64)
    for number in range(len(edges)):
        at, edge = min(step for step in beside[at] if place[step[1]] < 0)
        place[edge] = number
        chain.append(at)
    return np.array(chain), place


@dataclass(frozen=True, eq=False)
class SkinRegion:
    """The skin of a panel: ``faces`` (m, 3) of its own vertices, each one ``source`` (v,) of the cut skin's.

    Its border is made of ``runs``, counter-clockwise; ``slits`` are pieces within it and their vertices.
    ``area`` [mm^2]; ``origin`` (k,) are the triangles of the skin that it has a part of.
    """

    faces: Faces
    source: Indices
    runs: tuple[Run, ...]
    slits: tuple[Run, ...]
    area: float
    origin: Indices

    def on(self, vertices: Points) -> SkinRegion:
        """Return the same where the cut skin has these ``vertices`` (w, 3) [mm]."""
        return replace(self, area=_area(vertices[self.source], self.faces))


def face_regions(net: SeamNet) -> Indices:
    """Return the number of the region of each triangle, (m,): all curves but slits divide them."""
    cut = net.cut
    curve_edge = net.find(half_edges(cut.faces))
    divides = np.array([not curve.slit for curve in cut.curves])
    barrier = (curve_edge >= 0) & divides[cut.curve[curve_edge]]
    beyond = np.where(barrier.reshape(3, -1).T, -1, cut.face_neighbours)
    begins = np.append(0, np.cumsum((beyond >= 0).sum(axis=1)))
    after = beyond[beyond >= 0]
    graph = sparse.csr_array((np.ones(len(after), dtype=np.int8), after, begins), (len(cut.faces),) * 2)
    return np.asarray(sparse.csgraph.connected_components(graph, directed=False)[1], dtype=np.int64)


def skin_regions(net: SeamNet, names: tuple[str, ...], seeds: Points) -> tuple[SkinRegion, ...]:
    """Return the skin round each of ``seeds`` (s, 3) [mm] as far as curves, those that are no slits.

    Raises PatternError where it is no disc, or the same for two.
    """
    label = face_regions(net)
    at = label[_faces_at(net.cut, seeds)].tolist()
    for number, region in enumerate(at):
        if region in at[:number]:
            raise PatternError(
                Message(
                    'No seam separates the panels "{first}" and "{second}".',
                    first=names[at.index(region)],
                    second=names[number],
                ),
                Message("Close the seam between them, or move the place that marks one of them."),
            )
    return tuple(
        _region(net, np.flatnonzero(label == region), name) for region, name in zip(at, names, strict=True)
    )


def _faces_at(cut: CutSkin, places: Points) -> Indices:
    """Return the triangle of the cut skin at each place."""
    face, place = nearest_faces(cut.skin, places, cut.skin.centroid_tree)
    found = []
    for origin, foot in zip(face.tolist(), place, strict=True):
        rows = np.flatnonzero(cut.origin == origin)
        on_each = nearest_on(cut.vertices[cut.faces[rows]], np.repeat(foot[None], len(rows), axis=0))
        found.append(rows[np.linalg.norm(on_each - foot, axis=1).argmin()])
    return np.array(found, dtype=np.int64)


def _region(net: SeamNet, rows: Indices, name: str) -> SkinRegion:
    """Cut a panel's triangles ``rows`` out of the skin, open along curves that have it on both sides."""
    cut = net.cut
    source, faces = own_vertices(cut.faces[rows], len(cut.vertices))
    sides = half_edges(faces)
    edge = net.find(source[sides])
    twice = (edge >= 0) & (np.bincount(edge[edge >= 0], minlength=len(cut.edges)) == 2)[edge]
    slit = twice & np.array([curve.slit for curve in cut.curves])[cut.curve[edge]]
    _check_ends(net, edge[twice & ~slit], name)
    border = ~np.isin(_keys(sides), _keys(sides[:, ::-1]))
    if (twice & ~slit).any() or np.bincount(sides[border, 0]).max(initial=0) > 1:
        faces, former = cut_open(faces, sides[twice & ~slit])
        source, sides = source[former], half_edges(faces)
        border = ~np.isin(_keys(sides), _keys(sides[:, ::-1]))
    if (edge[border] < 0).any():
        raise _not_a_disc(net, Message('The panel "{name}" is open.', name=name))
    runs = _in_order(sorted(_runs(net, edge[border], sides[border], source), key=partial(_rank, net)))
    forward = slit & (net.begin[edge] == source[sides[:, 0]])
    slits = _runs(net, edge[forward], sides[forward], source)
    characteristic = len(source) - (len(sides) + int(border.sum())) // 2 + len(faces)
    if characteristic != 1 or not runs:
        raise _not_a_disc(net, Message('The panel "{name}" has no single closed outline.', name=name))
    area = _area(cut.vertices[source], faces)
    origin = np.zeros(len(cut.skin.faces), dtype=bool)
    origin[cut.origin[rows]] = True
    return SkinRegion(faces, source, runs, tuple(slits), area, np.flatnonzero(origin))


def _area(places: Points, faces: Faces) -> float:
    return float(np.linalg.norm(area_vectors(places, faces), axis=1).sum())


def _keys(sides: Indices) -> Indices:
    return np.asarray(sides[:, 0] << 31 | sides[:, 1])


def _runs(net: SeamNet, edge: Indices, sides: Indices, source: Indices) -> list[Run]:
    """Return the pieces that ``sides`` (k, 2) on the ``edge`` (k,) of each make up, as they lead."""
    forward = net.begin[edge] == source[sides[:, 0]]
    order = np.lexsort([np.where(forward, net.place[edge], -net.place[edge]), forward, net.piece[edge]])
    piece, forward, sides = net.piece[edge][order], forward[order], sides[order]
    ends = np.flatnonzero((np.diff(piece) != 0) | (np.diff(forward) != 0)) + 1
    return [
        (int(piece[rows[0]]), bool(forward[rows[0]]), np.append(sides[rows, 0], sides[rows[-1], 1]))
        for rows in np.split(np.arange(len(sides)), ends)
        if len(rows)
    ]


def _rank(net: SeamNet, run: Run) -> tuple[int, int, bool]:
    """Return where a run is on which curve: with the first, a panel begins also when it is cut again."""
    piece = net.pieces[run[0]]
    chain = net.cut.chains[piece.curve]
    return piece.curve, int(np.isin(chain, piece.chain[:2]).argmax()), run[1]


def _in_order(runs: list[Run]) -> tuple[Run, ...]:
    """Put ``runs`` in order round a panel, the first one first; none if they are not one outline."""
    after = {int(run[2][0]): run for run in runs}
    if len(after) < len(runs):
        return ()
    order = [runs[0]]
    while (end := int(order[-1][2][-1])) != int(runs[0][2][0]):
        if end not in after or len(order) > len(runs):
            return ()
        order.append(after[end])
    return tuple(order) if len(order) == len(runs) else ()


def _check_ends(net: SeamNet, edges: Indices, name: str) -> None:
    """Refuse a curve that is no slit and ends within a panel, with it on both sides of ``edges``."""
    for piece in np.unique(net.piece[edges]).tolist():
        chain = net.pieces[piece].chain
        if (np.bincount(net.cut.edges.ravel())[chain[[0, -1]]] == 1).any():
            raise PatternError(
                Message(
                    'The seam "{seam}" ends within the panel "{name}".', seam=_title(net, piece), name=name
                ),
                Message("Lead it to another seam or edge, or make it a dart."),
            )


def _title(net: SeamNet, piece: int) -> str:
    return net.cut.curves[net.pieces[piece].curve].name


def _not_a_disc(net: SeamNet, problem: Message) -> PatternError:
    """Return the error of a panel without one outline, with the curves whose ends are free."""
    degree = np.bincount(net.cut.edges.ravel())
    free = {
        _title(net, number)
        for number, piece in enumerate(net.pieces)
        if (degree[piece.chain[[0, -1]]] == 1).any() and not net.cut.curves[piece.curve].slit
    }
    if not free:
        return PatternError(problem, Message("Seams and edges have to go once round each panel."))
    return PatternError(
        problem,
        Message("These seams end away from any other: {names}.", names=", ".join(sorted(free))),
    )
