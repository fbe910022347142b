"""The whole body as a frame shows it, and what can be read off it; worked out once a body is kept."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from core.geometry.mesh import Floats, Indices, Mesh, Points
from core.geometry.mirror_plane import Sides, mirror_plane
from core.pipeline.build import Stages, targets_of
from core.pipeline.live_solver import Frame
from core.pipeline.surface_fields import StrainOnBody, moved_outward, pulls


class BodyNow:
    """``places`` [mm] and ``normals`` [1] of all vertices, (n, 3), follow the frames of one body and fit."""

    def __init__(self, frame: Frame) -> None:
        self.stages: Stages = frame.stages
        self.rest: Mesh = frame.stages.body.mesh
        self.places: Points = self.rest.vertices.copy()
        self.normals: Points = self.rest.vertex_normals.copy()
        self.follow(frame)

    def is_of(self, frame: Frame) -> bool:
        """Tell whether a frame is of the body and the fit that all this was worked out for."""
        old, new = self.stages, frame.stages
        return old.moving is new.moving and old.control is new.control and old.patch is new.patch

    def follow(self, frame: Frame) -> None:
        """Be as this frame shows it; ``is_of`` must hold."""
        self.frame, self.stages = frame, frame.stages
        rows = frame.stages.moving.vertices
        self.places[rows], self.normals[rows] = frame.points, frame.normals

    @cached_property
    def box(self) -> tuple[Points, Points]:
        """The lowest and the highest coordinates of the body at rest, (3,) [mm]."""
        return self.rest.vertices.min(axis=0), self.rest.vertices.max(axis=0)

    @cached_property
    def sides(self) -> Sides:
        """Its left laid over its right."""
        stages = self.stages
        middle = mirror_plane(self.rest, stages.patch.fade == 0.0, stages.moving.middle)
        return Sides(self.rest, stages.moving.vertices, middle)

    @cached_property
    def _strain(self) -> StrainOnBody:
        stages = self.stages
        return StrainOnBody(stages.control, stages.moving.rest, stages.patch.fade[stages.moving.vertices])

    @cached_property
    def _rest_normals(self) -> Points:
        return self.rest.vertex_normals[self.stages.moving.vertices]

    def rows(self, name: str) -> Indices:
        """Return the vertices at which the values of a map change from frame to frame, (k,)."""
        return self.sides.rows if name == "sides" else self.stages.moving.vertices

    def values(self, name: str) -> Floats:
        """Return the values of a map of the body at ``rows`` [mm, %], (k,); NaN where there is none."""
        if name == "displacement":
            return moved_outward(self.stages.moving.rest, self._rest_normals, self.frame.points)
        if name == "strain":
            return 100.0 * self._strain(self.frame.control_points)
        return self.sides.differ(self.places, self.normals, self.sides.rows)

    @cached_property
    def _sides_at_rest(self) -> Floats:
        return self.sides.differ(self.rest.vertices, self.rest.vertex_normals)

    def at_rest(self, name: str) -> Floats:
        """Return the values of a map at all vertices of the body at rest, (n,); they are the caller's own."""
        if name == "sides":
            return self._sides_at_rest.copy()
        return np.full(len(self.rest.vertices), np.nan if name == "worn" else 0.0)

    def pulls(self) -> dict[str, Floats]:
        """Return how the segments of the worn lines pull, by line, each (k,) [%]."""
        ratios = targets_of(self.stages.design, self.stages).ratios
        found = pulls(self.stages.model, self.frame.control_points, ratios)
        return {name: 100.0 * share for name, share in found.items()}
