"""Surface fields of the body: displacement, strain and line tension."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from scipy import sparse

from core.control_mesh.fit import ControlMesh
from core.geometry.closest_point import Frames, neighbourhoods
from core.geometry.mesh import Floats, Indices, Mesh, Points
from core.mechanics.model import ConstrainedModel
from core.mechanics.potential import Potential


def normal_displacement(rest: Points, normals: Points, places: Points) -> Floats:
    """Return how far places (k, 3) moved along the normals that they had at rest, shape (k,) [mm]."""
    return np.asarray(np.einsum("ij,ij->i", places - rest, normals))


def strains(rest: Mesh, points: Points) -> Floats:
    """Return the least and the largest strain in each triangle of ``rest`` at ``points``, (m, 2) [1].

    They are the principal strains: lengths over lengths at rest, less 1, in the two directions that stay
    square to each other. ``points`` have shape (n, 3) [mm].
    """
    before, now = _metric(rest.vertices, rest.faces), _metric(points, rest.faces)
    area = np.maximum(before[:, 0] * before[:, 2] - before[:, 1] ** 2, 1e-12)
    trace = before[:, 2] * now[:, 0] - 2.0 * before[:, 1] * now[:, 1] + before[:, 0] * now[:, 2]
    half = 0.5 * trace / area
    product = np.maximum(now[:, 0] * now[:, 2] - now[:, 1] ** 2, 0.0) / area
    spread = np.sqrt(np.maximum(half**2 - product, 0.0))
    stretch = np.sqrt(np.maximum(np.stack([half - spread, half + spread], axis=1), 0.0))
    return np.asarray(stretch - 1.0)


def _metric(points: Points, faces: Indices) -> Floats:
    """Return the products aa, ab, bb of the two sides from corner 0 of each triangle, shape (m, 3) [mm^2]."""
    corner, first, second = points[faces[:, 0]], points[faces[:, 1]], points[faces[:, 2]]
    a, b = first - corner, second - corner
    return np.stack([np.einsum("ij,ij->i", *pair) for pair in ((a, a), (a, b), (b, b))], axis=1)


class StrainOnBody:
    """Carries the strain of the control mesh to places of the body, shape (k, 3) [mm].

    A control point has the mean of its triangles, after their area; between control points it goes evenly,
    and ``fade`` (k,) lets it end where the body no longer follows the control mesh.
    """

    def __init__(self, control: ControlMesh, places: Points, fade: Floats) -> None:
        self._mesh = control.mesh
        area = np.repeat(control.mesh.face_areas, 3)
        corners, face = control.mesh.faces.ravel(), np.repeat(np.arange(len(control.mesh.faces)), 3)
        gather = sparse.csr_array(
            (area, (corners, face)), shape=(len(control.mesh.vertices), len(control.mesh.faces))
        )
        total = np.maximum(gather.sum(axis=1), 1e-12)
        self._carry = sparse.csr_array(
            between_control_points(control.mesh, places, fade) @ gather.multiply(1.0 / total[:, None])
        )

    def __call__(self, points: Points) -> Floats:
        """Return the largest strain, stretched or pressed together, at each place, shape (k,) [1]."""
        return np.asarray(self._carry @ np.abs(strains(self._mesh, points)).max(axis=1))


def between_control_points(control: Mesh, places: Points, fade: Floats) -> sparse.csr_array:
    """Return the matrix that goes evenly between control points, at the nearest place of each, (k, n).

    ``fade`` (k,) lets values end where the body no longer follows the control mesh.
    """
    frames = Frames.of(control)
    index, weight = np.zeros((len(places), 3), dtype=np.int64), np.zeros((len(places), 3))
    for rows, triangles in neighbourhoods(places, control):
        u, v, h = frames.coordinates(places[rows], triangles)
        best = frames.distance2(places[rows], triangles, h).argmin(axis=0), np.arange(len(rows))
        u, v = frames.nearest_place(places[rows], triangles, u, v)
        index[rows] = control.faces[triangles[best[0]]]
        weight[rows] = np.stack([1.0 - u[best] - v[best], u[best], v[best]], axis=1) * fade[rows, None]
    start = np.arange(0, index.size + 1, 3)
    return sparse.csr_array(
        (weight.ravel(), index.ravel(), start), shape=(len(places), len(control.vertices))
    )


def carrier(control: Mesh, places: Points, fade: Floats) -> Callable[[Floats], Floats]:
    """Return what carries values at control points, (n,), to places, (k,); see ``between_control_points``."""
    matrix = between_control_points(control, places, fade)
    return lambda values: np.asarray(matrix @ values)


def line_forces(model: ConstrainedModel, points: Points, ratios: tuple[float, ...]) -> Mapping[str, Floats]:
    """Return how each segment of the worn lines pulls, by line, as share of the strongest one, (k,) [1].

    The model has no newtons: its stiffness is that of the cables. Lines that are held have one tension that
    is no spring's: for them there is no answer.
    """
    if model.options.line_hold == "held" or not len(model.owner):
        return {}
    potential = Potential(model, ratios)
    force = potential.tape * potential.stretch(model.segments.lengths(points))
    share = force / max(float(np.abs(force).max()), 1e-9)
    return {
        line.name: share[model.owner == index]
        for index, line in enumerate(model.lines)
        if (model.owner == index).any()
    }
