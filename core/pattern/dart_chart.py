"""Where a dart helps: a panel slit from each place of its border to a target, laid flat and compared."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from scipy import sparse

from core.blas_threads import one_blas_thread
from core.geometry.closest_point import barycentric, nearest_faces
from core.geometry.mesh import Floats, Mesh, Points, boundary_loops, unit
from core.geometry.plane_sections import resample
from core.geometry.triangulate import inside_polygon
from core.pattern.breast_map import BreastMap
from core.pattern.cloth_energy import ClothLike
from core.pattern.even_points import cut_open, grid_within, joined_by_triangles
from core.pattern.flattening import FlatPanel, FlatProblem, flatten, strain_summary
from core.pattern.panel import Panel, PanelSide
from core.progress import Progress, quiet

SPACING = 10.0
"""Distance of the points of a panel in a trial [mm]; larger panels have some 300 of them. Source: ours."""

CLEAR = 10.0
"""A dart ends so far from the border, where its target lies on it [mm]. Source: ours."""

_EVERY = 2  # places of the border from one candidate to the next
_CLEAR = 0.4  # spacings that a dart keeps from the rest of the border


@dataclass(frozen=True, eq=False)
class Dart:
    """A slit from the border of a panel, from a ``share`` of the side ``seam``, to its ``end``.

    ``start`` and ``end`` (3,) [mm] lie on the body, ``clock`` [degrees] is that of the start about the bust
    point, None away from a breast. ``left`` is the share of the elastic work that the dart leaves, ``within``
    the strain that 95 % of the area keeps [1].
    """

    seam: str
    share: float
    clock: float | None
    start: Points
    end: Points
    left: float
    within: float


@dataclass(frozen=True, eq=False)
class DartChart:
    """What darts do for a panel: its strain ``within`` without one [1], and ``darts`` in order round it.

    ``deficit`` [degrees] is what they have to take out in all.
    """

    panel: str
    within: float
    deficit: float
    darts: tuple[Dart, ...]

    @property
    def best(self) -> Dart | None:
        """Return the dart that leaves the least strain, None if no dart can be laid flat."""
        return min(self.darts, key=lambda dart: dart.within, default=None)


def angle_deficit(panel: Panel, places: Points) -> float:
    """Return by how much the angles round the points within a panel fall short of full turns [degrees].

    It is the curvature of its skin at ``places`` (p, 3) [mm]: 0 for what can be laid flat without strain.
    """
    corners = places[panel.faces]
    ahead, back = np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners
    across = np.linalg.norm(np.cross(ahead, back), axis=2)
    angles = np.arctan2(across, np.einsum("mcx,mcx->mc", ahead, back))
    total = np.bincount(panel.faces.ravel(), angles.ravel(), len(places))
    inner = np.ones(len(places), dtype=bool)
    inner[np.concatenate(boundary_loops(panel.faces))] = False
    return float(np.degrees((2.0 * np.pi - total[inner]).sum()))


def dart_chart(
    panel: Panel,
    places: Points,
    cloth: ClothLike,
    target: Points | None = None,
    breast: BreastMap | None = None,
    progress: Progress = quiet,
) -> DartChart:
    """Try darts from every second place of a panel's border to ``target`` (3,) [mm], and compare them.

    ``places`` (p, 3) [mm] are those of its points on the body. The target is the bust point of ``breast`` if
    it is given, else the place that stands out most. Darts that make the piece overlap itself are left out.
    Raises Cancelled.
    """
    if target is None:
        target = _summit(panel, places) if breast is None else breast.apex
    trials = _Trials.of(panel, places, cloth)
    plain = trials.flat(None)
    if plain is None:
        return DartChart(panel.name, np.inf, angle_deficit(panel, places), ())
    darts, lines = [], list(trials.lines(target))
    for number, (at, line) in enumerate(lines):
        progress("darts", number / len(lines))
        tried = trials.flat(line)
        if tried is None or tried.flat.is_folded or tried.flat.overlaps:
            continue
        start, end = trials.mix(line[[0, -1]]) @ places
        clock = None if breast is None else float(breast.clock(start[None])[0])
        within = strain_summary(tried.flat).within
        darts.append(Dart(*trials.sides[at], clock, start, end, tried.work / plain.work, within))
    progress("darts", 1.0)
    within = strain_summary(plain.flat).within
    return DartChart(panel.name, within, angle_deficit(panel, places), tuple(darts))


def _summit(panel: Panel, places: Points) -> Points:
    """Return the place of a panel that is furthest off the mean plane of its border, (3,) [mm]."""
    border = places[np.concatenate([side.points[:-1] for side in panel.sides])]
    out = unit(Mesh(places, panel.faces).area_vectors.sum(axis=0))
    return np.asarray(places[int(((places - border.mean(axis=0)) @ out).argmax())])


@dataclass(frozen=True, eq=False)
class _Trial:
    """A panel laid ``flat`` with a slit, and the elastic ``work`` that is left."""

    flat: FlatPanel
    work: float


@dataclass(frozen=True, eq=False)
class _Trials:
    """A ``panel`` whose ``ring`` (b, 2) in its ``chart`` is its border, every ``spacing`` [mm].

    ``sides`` are the name of the side of each place of the ring, and its share of the way along it.
    """

    panel: Panel
    places: Points
    cloth: ClothLike
    chart: Mesh
    ring: Floats
    sides: tuple[tuple[str, float], ...]
    spacing: float

    @classmethod
    def of(cls, panel: Panel, places: Points, cloth: ClothLike) -> _Trials:
        """Divide the border of a panel evenly, its corners kept."""
        flat = flatten(panel, places, cloth)  # opens darts that the panel has
        start = panel.start if flat.is_folded or flat.overlaps else flat.worn
        area = float(np.linalg.norm(Mesh(places, panel.faces).area_vectors, axis=1).sum())
        spacing = max(SPACING, float(np.sqrt(area / 300.0)))
        parts = [resample(start[side.points], spacing)[:-1] for side in panel.sides]
        sides = tuple(
            (side.name, at / len(part))
            for side, part in zip(panel.sides, parts, strict=True)
            for at in range(len(part))
        )
        chart = Mesh(np.pad(start, [(0, 0), (0, 1)]), panel.faces)
        return cls(panel, places, cloth, chart, np.concatenate(parts), sides, spacing)

    def mix(self, points: Floats) -> sparse.csr_array:
        """Return places of the chart (k, 2) as shares of the points of the panel, (k, p)."""
        face, foot = nearest_faces(self.chart, np.pad(points, [(0, 0), (0, 1)]))
        corners = self.chart.faces[face]
        shares = barycentric(self.chart.vertices[corners], foot)
        entries = (shares.ravel(), (np.repeat(np.arange(len(points)), 3), corners.ravel()))
        return sparse.csr_array(entries, shape=(len(points), len(self.places)))

    def lines(self, target: Points) -> Iterator[tuple[int, Floats]]:
        """Yield places of the ring, and lines (k, 2) from them to a target on the body, within the panel."""
        face, foot = nearest_faces(Mesh(self.places, self.panel.faces), target[None])
        corners = self.panel.faces[face]
        aim = (barycentric(self.places[corners], foot)[:, None] @ self.chart.vertices[corners, :2])[0, 0]
        near = float(np.linalg.norm(self.ring - aim, axis=1).min())
        name = self.panel.name
        slits = {side.name for side in self.panel.sides if side.partner and side.partner[0] == name}
        for at in range(0, len(self.ring), _EVERY):
            if self.sides[at][0] in slits:
                continue
            way = aim - self.ring[at]
            whole = float(np.linalg.norm(way))
            length = whole - max(CLEAR - near, 0.0)
            if length < 2.0 * self.spacing:
                continue
            end = self.ring[at] + way * (length / whole)
            line = np.linspace(self.ring[at], end, max(round(length / self.spacing), 2) + 1)
            others = np.delete(self.ring, at, axis=0)
            clear = np.linalg.norm(line[1:, None] - others, axis=2).min() > _CLEAR * self.spacing
            if clear and inside_polygon(self.ring, line[1:]).all():
                yield at, line

    def flat(self, line: Floats | None) -> _Trial | None:
        """Lay the panel flat, slit along a ``line`` from the ring; None where it cannot be."""
        ring, slit = np.arange(len(self.ring)), np.empty((0, 2), dtype=np.int64)
        fixed = self.ring[:0] if line is None else line[1:]
        if line is not None:
            start = int(np.linalg.norm(self.ring - line[0], axis=1).argmin())
            chain = np.append(start, len(ring) + np.arange(len(fixed)))
            slit = np.stack([chain[:-1], chain[1:]], axis=1)
        inner = grid_within(self.ring, fixed, self.spacing)
        points = np.concatenate([self.ring, fixed, inner])
        faces = joined_by_triangles(points, ring, slit)
        if faces is None:
            return None
        faces, former = cut_open(faces, slit)
        points, mix = points[former], self.mix(points[former])
        (loop,) = boundary_loops(faces)
        side = PanelSide("", np.append(loop, loop[0]), None)
        grain = points[:, 1] - points[:, 1].mean()
        own = replace(self.panel, mix=mix, faces=faces, sides=(side,), grain=grain, start=points)
        problem = FlatProblem.of([own], [mix @ self.places], [self.cloth])
        with one_blas_thread():
            flat = problem.minimum(points)
        return _Trial(problem.results(flat)[0], float(problem.work(problem.state(flat))[0]))
