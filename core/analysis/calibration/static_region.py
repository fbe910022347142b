"""The skin of the first scan that no line moves, as far to the sides as reaches no arms."""

from __future__ import annotations

import numpy as np

from core.analysis.calibration.surface_distance import Surface
from core.geometry.mesh import Faces, Flags, Mesh, Points, sample_surface
from core.pipeline.build import Stages

_SAMPLE = 4000  # places at most that are strewn over it
_BELOW, _ABOVE, _BESIDE = 160.0, 60.0, 15.0  # how far the still skin reaches beyond the control mesh [mm]


def static_faces(stages: Stages) -> Faces:
    """Return the triangles (m, 3) of the trunk's skin that no line moves."""
    mesh, control = stages.body.mesh, stages.control.mesh.vertices
    low, high = control.min(axis=0), control.max(axis=0)
    middle = mesh.vertices[mesh.faces].mean(axis=1)
    beside = (middle[:, 0] > low[0] - _BESIDE) & (middle[:, 0] < high[0] + _BESIDE)
    level = (middle[:, 2] > low[2] - _BELOW) & (middle[:, 2] < high[2] + _ABOVE)
    return np.asarray(mesh.faces[beside & level & ~_moves(stages)[mesh.faces].any(axis=1)])


def sample_surface_with_normals(mesh: Mesh, faces: Faces) -> tuple[Points, Points]:
    """Return places (k, 3) [mm] strewn over ``faces`` of a mesh, and the normals there."""
    areas = Mesh(mesh.vertices, faces).face_areas
    places, face = sample_surface(mesh.vertices, faces, areas, min(_SAMPLE, 4 * len(faces)))
    corners = mesh.vertex_normals[faces[face]].sum(axis=1)
    return places, corners / np.maximum(np.linalg.norm(corners, axis=1), 1e-12)[:, None]


def _moves(stages: Stages) -> Flags:
    moves = np.zeros(len(stages.body.mesh.vertices), dtype=bool)
    moves[stages.moving.vertices[: stages.moving.count]] = True
    return moves


def static_surface(mesh: Mesh, faces: Faces) -> Surface:
    """Return the skin of ``faces`` (m, 3) of a mesh, for points to stand over."""
    used, corners = np.unique(faces, return_inverse=True)
    return Surface(mesh.vertices[used], mesh.vertex_normals[used], corners.reshape(-1, 3).T)
