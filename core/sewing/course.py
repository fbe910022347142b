"""The course of a band as it is worn: places on the reshaped skin, and what the band is pulled with there."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d

from core.centre_line import NO_BACK, USUAL_WIDTH, Surface, centre_line
from core.mesh import Flags, Floats, Points, unit
from core.pipeline import Stages
from core.sewing.tensions import LineTension
from core.tffd import deform


@dataclass(frozen=True, eq=False)
class Course:
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
        """The distance between two places [mm]."""
        following = np.roll(self.points, -1, axis=0) if self.closed else self.points[1:]
        return float(np.linalg.norm(following - self.points[: len(following)], axis=1).mean())

    def smoothed(self, over: float) -> Course:
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
        return Course(rows[:, :3], unit(rows[:, 3:]), self.tension, self.front, self.closed)


def _beyond(rows: Floats, more: int, sigma: float) -> Floats:
    """Return ``more`` rows of place and normal, (more, 6), that follow on ``rows`` (k, 6) as in a mirror.

    It stands across the way at the end, that of a parabola through the last three ``sigma`` [places].
    """
    used = rows[-1 : -max(int(np.ceil(3.0 * sigma)) + 2, 4) : -1, :3]
    way = unit(np.polynomial.polynomial.polyfit(np.arange(len(used)), used, min(2, len(used) - 1))[1])
    mirror = np.eye(3) - 2.0 * np.outer(way, way)
    back, end = rows[len(rows) - 1 - more : -1][::-1], rows[-1, :3]
    return np.concatenate([end + (back[:, :3] - end) @ mirror, back[:, 3:] @ mirror], axis=1)


def course_of(
    path: Points, tension: LineTension, surface: Surface, moved: Points, width: float, back: Points = NO_BACK
) -> Course:
    """Return how a band ``width`` [mm] wide along ``path`` and round its ``back`` lies on a reshaped body.

    Both have shape (k, 3) [mm] on the body at rest, which is ``surface``; ``moved`` (n, 3) are its vertices
    as reshaped. The back is pulled as the front is in the mean.
    """
    laid = centre_line(path, surface, back, width)
    follow = surface.follow(laid.points)
    mesh = surface.mesh
    points = laid.points + follow @ (moved - mesh.vertices)
    normals = unit(follow @ mesh.moved(moved).vertex_normals)
    front = laid.part >= 0
    newtons = np.where(front, tension.segments[laid.part.clip(0)], tension.mean)
    return Course(points, normals, newtons, front, laid.closed)


def courses(
    stages: Stages, control_points: Points, tensions: Mapping[str, LineTension]
) -> Iterator[tuple[str, Course, float]]:
    """Yield the lines of ``tensions`` on the body as ``control_points``, (n, 3) [mm], shape it.

    Each comes as name, course and width [mm].
    """
    mesh = stages.body.mesh
    surface, moved = Surface(mesh), deform(stages.binding, control_points)
    for line in stages.model.lines:
        if line.name in tensions:
            back = stages.backs[line.name].path if line.name in stages.backs else NO_BACK
            path = stages.control.mesh.vertices[line.path]
            width = stages.design.traits_of(line.name).width or USUAL_WIDTH
            yield line.name, course_of(path, tensions[line.name], surface, moved, width, back), width
