"""Panels of a garment: even points that ride on the skin inside seams, and the sides that are sewn."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from scipy import sparse

from core.errors import PatternError
from core.geometry.mesh import Faces, Floats, Indices, Points, area_vectors, face_neighbours, half_edges, unit
from core.geometry.plane_sections import arc_length
from core.messages import Message
from core.pattern.even_points import cut_open, grid_within, joined_by_triangles, located
from core.pattern.panel_border import BorderPiece, SeamNet, SkinRegion, seam_net, skin_regions
from core.pattern.plane_maps import PlaneBand, conformal_map, rigid_map, triangle_slopes
from core.pattern.surface_cut import CutSkin

SPACINGS = (5.0, 9.0)
"""The distance of points of small and of large panels [mm]. Source: measured, see ``spacing_of``."""

UP = (0.0, 0.0, 1.0)

Bridge = Callable[[CutSkin, Faces], CutSkin]
"""What moves the faces of a garment, (k, 3) of the cut skin, to where its cloth is."""

_SAME = 0.01
"""Ends of pieces of one seam that are nearer are the same [mm]. Source: ours."""

_LEVEL = 0.2
"""A panel whose slope upward is in the mean less than this lies level [1]. Source: ours."""


@dataclass(frozen=True, eq=False)
class PanelSeed:
    """A panel to be cut: its name, a ``place`` within it, (3,) [mm], and the name of its cloth.

    Its grain line runs ``up`` on the body, turned by ``turn`` [degrees], counter-clockwise seen from outside.
    """

    name: str
    place: Points
    cloth: str = ""
    turn: float = 0.0


@dataclass(frozen=True, eq=False)
class PanelSide:
    """A stretch of a panel's outline, from corner to corner on one seam or edge.

    ``points`` (k,) are points of the panel, counter-clockwise round it seen from outside. To it is sewn, in
    reverse order, the side of ``partner``, a panel's name and the number of its side; to an edge None.
    ``ends`` (2, 3) [mm] are its corners on the skin at rest, where cloth over a hollow is not.
    """

    name: str
    points: Indices
    partner: tuple[str, int] | None
    ends: Points = field(default_factory=lambda: np.zeros((2, 3)))


@dataclass(frozen=True, eq=False)
class Panel:
    """A panel of p points that ride on the n vertices of a body.

    ``mix`` (p, n): their shares, each row's sum 1; ``faces`` (m, 3); ``sides`` in order round it. The piece
    is turned so that the sum of its points times ``grain`` (p,) points up. ``start`` (p, 2) [mm] is a
    first guess of the flat piece. ``covers`` [mm^2] is the area of the skin within its outline; that has a
    part of the triangles ``origin`` (k,) of the body.
    """

    name: str
    cloth: str
    mix: sparse.csr_array
    faces: Faces
    sides: tuple[PanelSide, ...]
    grain: Floats
    start: Floats
    covers: float
    origin: Indices

    def places(self, vertices: Points) -> Points:
        """Return where the points are on a body of these ``vertices`` (n, 3), (p, 3) [mm]."""
        return np.asarray(self.mix @ vertices)

    @cached_property
    def band(self) -> PlaneBand:
        """Return the band storage of the flat points' coordinates."""
        return PlaneBand.of(self.faces, len(self.start), 2)


def spacing_of(area: float) -> float:
    """Return the distance of points that a panel of ``area`` [mm^2] is given [mm]: some 600 of them."""
    return float(np.clip(np.sqrt(area / 500.0), *SPACINGS))


def cut_panels(
    cut: CutSkin,
    seeds: tuple[PanelSeed, ...],
    spacing: float | None = None,
    up: tuple[float, ...] = UP,
    bridge: Bridge | None = None,
    kept: tuple[Panel, ...] = (),
) -> tuple[Panel, ...]:
    """Return the panels round ``seeds`` on a ``cut`` skin; ``up`` is the direction of their grain lines.

    Points are ``spacing`` [mm] apart, or as it suits the panel's area. Neighbours have the same points on
    their seams, also those that are ``kept`` as they were cut before. ``bridge`` moves the skin of all panels
    to where cloth spans its hollows. Raises PatternError where a panel is open or in the way of another.
    """
    on_skin = net = seam_net(cut)
    regions = skin_regions(net, tuple(seed.name for seed in seeds), np.array([seed.place for seed in seeds]))
    if bridge is not None:
        cut = bridge(cut, np.concatenate([region.source[region.faces] for region in regions]))
        net, regions = replace(net, cut=cut), tuple(region.on(cut.vertices) for region in regions)
    steps = [spacing or spacing_of(region.area) for region in regions]
    finest = _finest(regions, steps)
    beside = _kept_sides(on_skin, list(finest), kept)
    samples = {
        piece: _Samples.of(cut, net.pieces[piece], step, beside[piece][1] if piece in beside else None)
        for piece, step in finest.items()
    }
    parts = [
        _even_panel(net, region, samples, seed, np.array(up), step)
        for region, seed, step in zip(regions, seeds, steps, strict=True)
    ]
    runs = [keys for _, keys in parts]
    where = {key: (seeds[at].name, side) for at, keys in enumerate(runs) for side, key in enumerate(keys)}
    where |= {key: place for key, _, place in beside.values() if key not in where}
    return tuple(
        replace(
            panel, sides=tuple(_sewn(on_skin, *pair, where) for pair in zip(panel.sides, keys, strict=True))
        )
        for panel, keys in parts
    )


def _finest(regions: Sequence[SkinRegion], steps: Sequence[float]) -> dict[int, float]:
    """Return the distance of points on each piece of border: that of the finer panel beside it [mm]."""
    finest: dict[int, float] = {}
    for region, step in zip(regions, steps, strict=True):
        for piece in [run[0] for run in region.runs] + [slit[0] for slit in region.slits]:
            finest[piece] = min(step, finest.get(piece, np.inf))
    return finest


_Key = tuple[int, bool]
"""A piece of border, and whether it is followed as it leads."""


def _kept_sides(
    net: SeamNet, pieces: list[int], kept: tuple[Panel, ...]
) -> dict[int, tuple[_Key, int, tuple[str, int]]]:
    """Return for pieces of border on which a panel is ``kept``: its way, how many steps, name and side."""
    ends: dict[str, list[tuple[int, Points]]] = {}
    for number in pieces:
        piece = net.pieces[number]
        places = net.cut.vertices[piece.chain[[0, -1]]]
        ends.setdefault(net.cut.curves[piece.curve].name, []).append((number, places))
    found = {}
    for panel in kept:
        for at, side in enumerate(panel.sides):
            for number, theirs in ends.get(side.name, ()):
                for forward in (True, False):
                    if np.abs(side.ends - (theirs if forward else theirs[::-1])).max() < _SAME:
                        found[number] = (number, forward), len(side.points) - 1, (panel.name, at)
    return found


def _sewn(
    net: SeamNet, side: PanelSide, key: tuple[int, bool], where: dict[tuple[int, bool], tuple[str, int]]
) -> PanelSide:
    """Return a side with its partner: the one along the same piece of seam the other way round."""
    piece, forward = key
    curve = net.cut.curves[net.pieces[piece].curve]
    ends = net.cut.vertices[net.pieces[piece].chain[[0, -1]]]
    partner = None if curve.is_edge else where.get((piece, not forward))
    return replace(side, name=curve.name, partner=partner, ends=ends if forward else ends[::-1])


@dataclass(frozen=True, eq=False)
class _Samples:
    """Even places on a piece of border, for both neighbours: ``share`` of the step from ``at``, (k,)."""

    at: Indices
    share: Floats

    @classmethod
    def of(cls, cut: CutSkin, piece: BorderPiece, spacing: float, count: int | None) -> _Samples:
        """Divide a piece into ``count`` stretches, or such of about ``spacing`` [mm], both ends kept."""
        along = arc_length(cut.vertices[piece.chain])
        ring = piece.chain[0] == piece.chain[-1]
        count = count or max(round(float(along[-1]) / spacing), 3 if ring else 1)
        places = np.linspace(0.0, along[-1], count + 1)
        at = np.clip(np.searchsorted(along, places, side="right") - 1, 0, len(along) - 2)
        return cls(at, np.clip((places - along[at]) / np.diff(along)[at], 0.0, 1.0))

    def on(self, chain: Indices) -> tuple[Indices, Floats]:
        """Return the three vertices of a ``chain`` and their shares that each place is made of, (k, 3)."""
        ends = np.stack([chain[self.at], chain[self.at + 1], chain[self.at]], axis=1)
        return ends, np.stack([1.0 - self.share, self.share, np.zeros(len(ends))], axis=1)


@dataclass(frozen=True, eq=False)
class _Outline:
    """Points on border and slits: in the ``chart`` (b, 2), and as shares of vertices of the region (b, 3).

    ``paths`` are the piece and direction of each run and its points; the first ``ring`` points are the
    outline, ``lines`` (l, 2) the slits.
    """

    chart: Floats
    vertices: Indices
    shares: Floats
    paths: tuple[tuple[tuple[int, bool], Indices], ...]
    ring: int
    lines: Indices


def _outline(region: SkinRegion, samples: dict[int, _Samples], chart: Floats) -> _Outline:
    """Lay the samples of a region's border and slits into its ``chart`` (v, 2)."""
    parts, paths, lines = [], [], [np.empty((0, 2), dtype=np.int64)]
    known: dict[int, int] = {}
    total = 0
    for piece, forward, own in region.runs:
        ends, shares = samples[piece].on(own if forward else own[::-1])
        parts.append((ends[:-1], shares[:-1]) if forward else (ends[:0:-1], shares[:0:-1]))
        known[int(own[0])] = total
        paths.append(((piece, forward), total + np.arange(len(ends))))
        total += len(ends) - 1
    paths[-1][1][-1] = 0
    ring = total
    for piece, _, chain in region.slits:
        ends, shares = samples[piece].on(chain)
        points = np.full(len(ends), -1)
        points[[0, -1]] = [known.get(int(end), -1) for end in chain[[0, -1]]]
        new = points < 0
        points[new] = total + np.arange(int(new.sum()))
        known |= {int(chain[at]): int(points[at]) for at in (0, -1)}
        parts.append((ends[new], shares[new]))
        total += int(new.sum())
        paths += [((piece, True), points), ((piece, False), points[::-1])]
        lines.append(np.stack([points[:-1], points[1:]], axis=1))
    vertices, shares = (np.concatenate(column) for column in zip(*parts, strict=True))
    places = np.einsum("bk,bkc->bc", shares, chart[vertices])
    return _Outline(places, vertices, shares, tuple(paths), ring, np.concatenate(lines))


def _even_panel(
    net: SeamNet,
    region: SkinRegion,
    samples: dict[int, _Samples],
    seed: PanelSeed,
    up: Points,
    spacing: float,
) -> tuple[Panel, list[tuple[int, bool]]]:
    """Return a panel of even points, and the piece of border that each of its sides is on."""
    skin = net.cut.vertices[region.source]
    chart = _chart(skin, region.faces, up, seed.turn)
    outline = _outline(region, samples, chart)
    ring = outline.chart[: outline.ring]
    inner = grid_within(ring, outline.chart[outline.ring :], spacing)
    points = np.concatenate([outline.chart, inner])
    faces = joined_by_triangles(points, np.arange(outline.ring), outline.lines)
    if faces is None:
        raise PatternError(
            Message('The panel "{name}" is too strongly curved to be laid flat.', name=seed.name),
            Message("Divide it by a seam."),
        )
    at, inner_shares = located(chart, region.faces, inner)
    vertices = np.concatenate([outline.vertices, region.faces[at]])
    shares = np.concatenate([outline.shares, inner_shares])
    former = np.arange(len(points))
    if len(outline.lines):
        faces, former = cut_open(faces, outline.lines)
    rows = np.repeat(np.arange(len(former)), 3)
    columns = region.source[vertices[former]].ravel()
    entries = (shares[former].ravel(), (rows, columns))
    mix = sparse.csr_array(sparse.coo_array(entries, (len(former), len(net.cut.vertices)))) @ net.cut.mix
    places = np.asarray(mix @ net.cut.skin.vertices)
    sides, keys = _sides(faces, former, outline)
    start = points[former]
    grain = _grain(places, faces, start, up, seed.turn)
    return Panel(seed.name, seed.cloth, mix, faces, sides, grain, start, region.area, region.origin), keys


def _sides(
    faces: Faces, former: Indices, outline: _Outline
) -> tuple[tuple[PanelSide, ...], list[tuple[int, bool]]]:
    """Return the sides of a panel in order, and the piece of border of each."""
    steps = {
        step: (path, at)
        for path, (_, points) in enumerate(outline.paths)
        for at, step in enumerate(zip(points[:-1].tolist(), points[1:].tolist(), strict=True))
    }
    border = half_edges(faces)[face_neighbours(faces).T.ravel() < 0]
    found: dict[int, list[tuple[int, int, int]]] = {}
    for (start, end), step in zip(border.tolist(), former[border].tolist(), strict=True):
        path, at = steps[step[0], step[1]]
        found.setdefault(path, []).append((at, start, end))
    runs = {}
    for path, parts in found.items():
        parts.sort()
        runs[parts[0][1]] = path, np.array([*[start for _, start, _ in parts], parts[-1][2]])
    at = min(runs, key=lambda start: runs[start][0])
    order = []
    while at in runs:
        order.append(runs.pop(at))
        at = int(order[-1][1][-1])
    named = tuple(PanelSide("", points, None) for _, points in order)
    return named, [outline.paths[path][0] for path, _ in order]


def _grain(places: Points, faces: Faces, flat: Floats, up: Points, turn: float) -> Floats:
    """Return shares of points, (p,), whose sum of places laid ``flat`` (p, 2) is the way of the grain line.

    It runs ``up`` on the body; on a panel that lies level, as a gusset, along its greatest length.
    """
    vectors = area_vectors(places, faces)
    normal = unit(vectors)
    along, aside = up - (normal @ up)[:, None] * normal, np.cross(normal, up)
    angle = np.radians(turn)
    aside = np.cos(angle) * aside - np.sin(angle) * along  # of the turned grain line
    corners = places[faces]
    opposite = np.roll(corners, -1, axis=1) - np.roll(corners, -2, axis=1)
    # Twice the area times the slope of a hat function is the side opposite it, turned by 90 degrees.
    pull = np.bincount(faces.ravel(), 0.5 * np.einsum("mkc,mc->mk", opposite, aside).ravel(), len(places))
    total = pull @ flat
    if np.hypot(*total) > _LEVEL * np.linalg.norm(vectors, axis=1).sum():
        return np.asarray(pull, dtype=np.float64)
    off = flat - flat.mean(axis=0)
    longest = np.linalg.eigh(off.T @ off)[1][:, 1]
    x, y = longest * np.copysign(1.0, longest @ total)
    return np.asarray(off @ [x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle)])


def _chart(places: Points, faces: Faces, up: Points, turn: float) -> Floats:
    """Return the skin of a panel roughly laid flat, its grain line upward, (v, 2) [mm]."""
    slopes, band = triangle_slopes(places, faces), PlaneBand.of(faces, len(places), 1)
    chart = rigid_map(faces, slopes, conformal_map(places, faces, slopes, band), band)
    x, y = _grain(places, faces, chart, up, turn) @ chart
    return np.asarray(chart @ np.array([[y, x], [-x, y]]) / np.hypot(x, y))
