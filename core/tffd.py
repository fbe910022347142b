"""t-FFD: the dense body follows the control triangles (Kobayashi and Ootsubo 2003, as the paper uses it)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from scipy import sparse

from core.mesh import Floats, Indices, Mesh, Points, area_vectors, frozen, unit
from core.proximity import Pairs, corner_reach, nearest_place, pairs_around, pairs_within, usable

Weights = Literal["paper", "smooth"]

HAT_RANGE = 2.5
"""The hat of the paper reaches this many mean radii of its triangle."""

GAUSS_WIDTH = 0.6
"""Standard deviation of the smooth weights in parts of the median triangle size (ours)."""

NEGLIGIBLE = 1e-3
"""The Gauss curve is lowered by this part of its height: it ends, without a step, at 3.7 deviations."""


@dataclass(frozen=True, eq=False)
class Binding:
    """How the vertices of a body follow its control mesh: a linear operator on what the control mesh changes.

    ``moving`` are the vertices that can move, shape (k,), ascending. ``operator`` has shape (k, n + m): its
    columns are the n control points and the m normals of the control triangles.
    """

    body: Mesh
    control: Mesh
    moving: Indices
    operator: sparse.csr_array
    scaled_normals: bool

    @cached_property
    def rest_frames(self) -> Floats:
        """Control points and triangle normals at rest, shape (n + m, 3)."""
        return frozen(frames(self.control, self.control.vertices, self.scaled_normals))

    @cached_property
    def rest_moving(self) -> Points:
        """The moving vertices at rest, shape (k, 3) [mm]."""
        return frozen(self.body.vertices[self.moving])


def frames(control: Mesh, points: Points, scaled_normals: bool) -> Floats:
    """Return control points and unit normals stacked, shape (n + m, 3).

    Scaled normals grow with the square root of the triangle's area, so that a similarity is followed exactly.
    """
    areas = area_vectors(points, control.faces)
    normals = unit(areas)
    if scaled_normals:
        rest = np.where(control.face_areas > 0.0, control.face_areas, 1.0)
        normals *= np.sqrt(np.linalg.norm(areas, axis=1) / rest)[:, None]
    return np.concatenate([points, normals])


def bind(
    body: Mesh, control: Mesh, fade: Floats, weights: Weights = "smooth", *, scaled_normals: bool = False
) -> Binding:
    """Bind the vertices of ``body`` to the triangles of ``control``.

    ``fade`` scales the motion of each vertex, shape (N,), 0 still .. 1 full; vertices without fade or without
    weight keep their place. Weights "paper" are the hat in the distance to the centroid of the 2003 paper,
    "smooth" is a Gauss curve in the distance to the triangle (ours).
    """
    candidates = np.flatnonzero(fade > 0.0)
    points = body.vertices[candidates]
    pairs, weight = _hat(points, control) if weights == "paper" else _gauss(points, control)
    total = np.bincount(pairs.point, weight, minlength=len(candidates))
    weighted = total > 0.0
    weight = weight * (fade[candidates] / np.where(weighted, total, 1.0))[pairs.point]
    operator = _operator(pairs, weight, control, len(candidates))[weighted]
    moving = candidates[weighted]
    moving.setflags(write=False)
    return Binding(body, control, moving, operator, scaled_normals)


def _hat(points: Points, control: Mesh) -> tuple[Pairs, Floats]:
    reach = HAT_RANGE * corner_reach(control).mean(axis=1)
    pairs = pairs_within(points, control, reach)
    away = points[pairs.point] - control.vertices[control.faces].mean(axis=1)[pairs.triangle]
    return pairs, 1.0 - np.linalg.norm(away, axis=1) / reach[pairs.triangle]


def _gauss(points: Points, control: Mesh) -> tuple[Pairs, Floats]:
    sizes = np.sqrt(control.face_areas[usable(control)])
    sigma = GAUSS_WIDTH * float(np.median(sizes)) if len(sizes) else 0.0
    spread2 = -2.0 * sigma**2 * np.log(NEGLIGIBLE)
    pairs = pairs_around(points, control, np.sqrt(spread2))
    distance2, _ = nearest_place(pairs, control)
    nearest = np.full(len(points), np.inf)
    np.minimum.at(nearest, pairs.point, distance2)
    beyond = distance2 - nearest[pairs.point]
    kept = beyond < spread2
    return pairs.chosen(kept), np.exp(-beyond[kept] / (2.0 * sigma**2)) - NEGLIGIBLE


def _operator(pairs: Pairs, weight: Floats, control: Mesh, rows: int) -> sparse.csr_array:
    """Blend the images of each point: first on the corners and normal of its triangles, then joined."""
    triangles, points = len(control.faces), len(control.vertices)
    in_frame = np.stack([1.0 - pairs.u - pairs.v, pairs.u, pairs.v, pairs.h], axis=1) * weight[:, None]
    columns = 4 * pairs.triangle[:, None] + np.arange(4)
    starts = 4 * np.searchsorted(pairs.point, np.arange(rows + 1))
    blend = sparse.csr_array((in_frame.ravel(), columns.ravel(), starts), shape=(rows, 4 * triangles))
    targets = np.column_stack([control.faces, points + np.arange(triangles)]).ravel()
    join = sparse.csr_array(
        (np.ones(4 * triangles), targets, np.arange(4 * triangles + 1)),
        shape=(4 * triangles, points + triangles),
    )
    return sparse.csr_array(blend @ join)


def deform_moving(binding: Binding, control_points: Points) -> Points:
    """Return the places of ``binding.moving`` for ``control_points``, shapes (k, 3) and (n, 3) [mm]."""
    now = frames(binding.control, control_points, binding.scaled_normals)
    return np.asarray(binding.rest_moving + binding.operator @ (now - binding.rest_frames))


def deform(binding: Binding, control_points: Points) -> Points:
    """Return all vertices of the body for ``control_points``, shapes (N, 3) and (n, 3) [mm].

    With the control points at rest the result is the body at rest, bit for bit.
    """
    vertices = binding.body.vertices.copy()
    vertices[binding.moving] = deform_moving(binding, control_points)
    return vertices
