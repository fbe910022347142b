"""The course of a band as it is worn: places on the reshaped skin, and what the band is pulled with there."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from weakref import WeakKeyDictionary

import numpy as np
from scipy import sparse
from scipy.ndimage import gaussian_filter1d

from core.garment.curve_smoothing import USUAL_WIDTH, CentreLine, LocalPlanes, centre_line
from core.garment.tension import LineTension
from core.geometry.mesh import Flags, Floats, Mesh, Points, unit
from core.pipeline.line_routes import NO_BACK, LineRoute
from core.pipeline.stages import RegionStages

_KEPT = 64
"""Bands that are kept as they lie on one body at rest."""

_LAID: WeakKeyDictionary[Mesh, dict[tuple[bytes, float, bytes], _Laid]] = WeakKeyDictionary()


@dataclass(frozen=True, eq=False)
class BandPath:
    """The middle of a band on the skin, every few mm, evenly.

    ``points`` (k, 3) [mm], ``normals`` (k, 3) of the skin, outward; ``tension`` (k,) [N] of the band;
    ``front`` (k,) where it is the front part. A ``closed`` one ends beside the place it begins with.
    """

    points: Points
    normals: Points
    tension: Floats
    front: Flags
    closed: bool

    @property
    def step(self) -> float:
        """Return the distance between two places [mm]."""
        following = np.roll(self.points, -1, axis=0) if self.closed else self.points[1:]
        return float(np.linalg.norm(following - self.points[: len(following)], axis=1).mean())

    def smoothed(self, over: float) -> BandPath:
        """Return the course without what is shorter than about ``over`` [mm]; the length stays in ``step``.

        Beyond an open end it is thought to go on as in a mirror, so that it keeps its bend.
        """
        sigma = 0.5 * over / self.step
        rows, more = np.concatenate([self.points, self.normals], axis=1), 0
        if not self.closed:
            more = min(int(np.ceil(4.0 * sigma)), len(rows) - 1)
            rows = np.concatenate([_beyond(rows[::-1], more, sigma)[::-1], rows, _beyond(rows, more, sigma)])
        rows = gaussian_filter1d(rows, sigma, axis=0, mode="wrap" if self.closed else "nearest")
        rows = rows[more : len(rows) - more]
        return BandPath(rows[:, :3], unit(rows[:, 3:]), self.tension, self.front, self.closed)


def _beyond(rows: Floats, more: int, sigma: float) -> Floats:
    """Return ``more`` rows of place and normal, (more, 6), that follow on ``rows`` (k, 6) as in a mirror.

    It stands across the way at the end, that of a parabola through the last three ``sigma`` [places].
    """
    used = rows[-1 : -max(int(np.ceil(3.0 * sigma)) + 2, 4) : -1, :3]
    way = unit(np.polynomial.polynomial.polyfit(np.arange(len(used)), used, min(2, len(used) - 1))[1])
    mirror = np.eye(3) - 2.0 * np.outer(way, way)
    back, end = rows[len(rows) - 1 - more : -1][::-1], rows[-1, :3]
    return np.concatenate([end + (back[:, :3] - end) @ mirror, back[:, 3:] @ mirror], axis=1)


@dataclass(frozen=True, eq=False)
class _Laid:
    """A band on the body at rest: ``line``, and ``follow`` (k, n), which takes it along with the vertices."""

    line: CentreLine
    follow: sparse.csr_array

    def course(self, tension: LineTension, shift: Points, normals: Points) -> BandPath:
        """Return it on a body whose vertices went by ``shift`` and have ``normals`` now, both (n, 3)."""
        line, part = self.line, self.line.part
        newtons = np.where(part >= 0, tension.segments[part.clip(0)], tension.mean)
        return BandPath(
            line.points + self.follow @ shift, unit(self.follow @ normals), newtons, part >= 0, line.closed
        )


def _lay(route: LineRoute, surface: LocalPlanes, width: float) -> _Laid:
    line = centre_line(route.path, surface, route.back, width, drawn=route.drawn, sewn=route.sewn)
    return _Laid(line, surface.displacement_weights(line.points))


def band_path(
    path: Points,
    tension: LineTension,
    surface: LocalPlanes,
    moved: Points,
    width: float,
    back: Points = NO_BACK,
) -> BandPath:
    """Return how a band ``width`` [mm] wide along ``path`` and round its ``back`` lies on a reshaped body.

    Both have shape (k, 3) [mm] on the body at rest, which is ``surface``; ``moved`` (n, 3) are its vertices
    as reshaped. The back is pulled as the front is in the mean.
    """
    mesh = surface.mesh
    shift, normals = moved - mesh.vertices, mesh.moved(moved).vertex_normals
    return _lay(LineRoute(path, back), surface, width).course(tension, shift, normals)


def band_paths(
    stages: RegionStages, control_points: Points, tensions: Mapping[str, LineTension]
) -> Iterator[tuple[str, BandPath, float]]:
    """Yield the lines of ``tensions`` on the body as ``control_points``, (n, 3) [mm], shape it.

    Each comes as name, course and width [mm].
    """
    mesh, moving = stages.body.mesh, stages.moving
    shift, normals = np.zeros_like(mesh.vertices), mesh.vertex_normals.copy()
    places, normals[moving.vertices] = stages.shape(control_points)
    shift[moving.vertices] = places - moving.rest
    for line in stages.model.lines:
        if line.name in tensions:
            width = stages.design.line_settings(line.name).width or USUAL_WIDTH
            laid = _known(mesh, stages.routes[line.name], width)
            yield line.name, laid.course(tensions[line.name], shift, normals), width


def _known(mesh: Mesh, route: LineRoute, width: float) -> _Laid:
    """Return how a band lies on the body at rest: as it does whatever the body is shaped to."""
    known, key = _LAID.setdefault(mesh, {}), (route.path.tobytes(), width, route.back.tobytes())
    if key not in known:
        while len(known) >= _KEPT:
            known.pop(next(iter(known)), None)
        known[key] = _lay(route, LocalPlanes(mesh), width)
    return known[key]
