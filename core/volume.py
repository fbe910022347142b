"""The volume of the control mesh, its gradient and curvature, and the laws that hold it.

Source: paper sections 4 and 5.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy import sparse

from core.mesh import Faces, Flags, Floats, Indices, Mesh, Points, frozen

CONTROLS = ("none", "conventional", "adaptive", "exact")
"""The volume controls by name; ``exact`` is no law of turns but the answer that they aim at."""


def _cross(a: Points, b: Points) -> Points:
    """Return the row-wise cross product; for some hundred rows several times faster than numpy's own."""
    ax, ay, az = a[..., 0], a[..., 1], a[..., 2]
    bx, by, bz = b[..., 0], b[..., 1], b[..., 2]
    return np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], axis=-1)


@dataclass(frozen=True, eq=False)
class VolumeMeasure:
    """The volume between the control mesh and the fan from the centre of its border.

    A closed mesh may have any centre.
    The border is fixed, so a volume *difference* does not depend on the centre; ``rest_volume`` [mm^3] and
    with it every percentage does. ``faces`` (m, 3) are the triangles that can move, ``left`` (m,) those of
    the subject's left breast; ``still_volume`` [mm^3] is the share of all other triangles.
    """

    centre: Floats
    faces: Faces
    left: Flags
    still_volume: float
    rest_volume: float
    scatter: Floats
    curvature: tuple[sparse.csr_array, sparse.csr_array]
    free_count: int

    def volume(self, points: Points) -> float:
        """Return the volume of the control points, shape (n, 3) [mm^3]."""
        a, b, c = self._corners(points)
        return self.still_volume + float(np.einsum("ij,ij->", a, _cross(b, c))) / 6.0

    def side_volumes(self, points: Points) -> Floats:
        """Return the moving triangles' volume on the subject's left and right, shape (2,) [mm^3]."""
        a, b, c = self._corners(points)
        each = np.einsum("ij,ij->i", a, _cross(b, c)) / 6.0
        return np.array([each[self.left].sum(), each[~self.left].sum()])

    def gradient(self, points: Points) -> Points:
        """Return dV/dx at the free points, shape (f, 3) [mm^2]: the direction of the volume force."""
        return np.asarray(self.scatter @ self._corner_gradients(points).reshape(-1, 3))

    def side_gradients(self, points: Points) -> Floats:
        """Return dV/dx of the left and of the right volume, shape (2, f, 3) [mm^2]."""
        each = self._corner_gradients(points)
        left = np.where(self.left[None, :, None], each, 0.0).reshape(-1, 3)
        right = np.where(self.left[None, :, None], 0.0, each).reshape(-1, 3)
        return np.stack([self.scatter @ left, self.scatter @ right])

    def hessian(self, points: Points, pressures: Floats) -> Floats:
        """Return the second derivative of ``pressures . (left, right volume)``, shape (3 f, 3 f) [mm]."""
        flat = (points - self.centre).ravel()
        values = pressures[0] * (self.curvature[0] @ flat) + pressures[1] * (self.curvature[1] @ flat)
        size = 3 * self.free_count
        return np.asarray(values.reshape(size, size))

    def _corners(self, points: Points) -> Points:
        return np.asarray(points[self.faces.T] - self.centre)

    def _corner_gradients(self, points: Points) -> Points:
        corners = self._corners(points)
        return _cross(corners[[1, 2, 0]], corners[[2, 0, 1]]) / 6.0


def volume_measure(mesh: Mesh, free: Indices, left: Flags | None = None) -> VolumeMeasure:
    """Prepare the volume of a control mesh; ``left``, shape (m,), marks the triangles of the left breast."""
    loops = mesh.boundary_loops
    centre = mesh.vertices[loops[0]].mean(axis=0) if loops else mesh.vertices.mean(axis=0)
    if left is None:
        left = mesh.vertices[mesh.faces].mean(axis=1)[:, 0] > centre[0]
    place = np.full(len(mesh.vertices), -1, dtype=np.int64)
    place[free] = np.arange(len(free))
    moving = (place[mesh.faces] >= 0).any(axis=1)
    faces, left = mesh.faces[moving], left[moving]
    still = Mesh(mesh.vertices, mesh.faces[~moving]).enclosed_volume(centre)
    scatter = np.zeros((len(free), 3 * len(faces)))
    at = place[faces.T].ravel()
    scatter[at[at >= 0], np.flatnonzero(at >= 0)] = 1.0
    curvature = (
        _curvature(faces[left], place, len(mesh.vertices)),
        _curvature(faces[~left], place, len(mesh.vertices)),
    )
    return VolumeMeasure(
        frozen(centre), faces, left, still, mesh.enclosed_volume(centre), scatter, curvature, len(free)
    )


def _curvature(faces: Faces, place: Indices, count: int) -> sparse.csr_array:
    """Return the linear map from centred positions (3 n,) to the volume Hessian of ``faces``, (9 f^2,).

    V is cubic: the block of points i and j of a triangle (i, j, k) is -[x_k]_x / 6, its mirror the transpose.
    """
    size = 3 * (int(place.max(initial=-1)) + 1)
    rows, columns, values = [], [], []
    # Entries (a, b) of the matrix [v]_x, each with the component of v that stands there and its sign.
    skew = ((0, 1, 2, -1.0), (0, 2, 1, 1.0), (1, 0, 2, 1.0), (1, 2, 0, -1.0), (2, 0, 1, -1.0), (2, 1, 0, 1.0))
    for turn in range(3):
        i, j, k = (faces[:, (turn + step) % 3] for step in range(3))
        both = (place[i] >= 0) & (place[j] >= 0)
        pi, pj, k = 3 * place[i[both]], 3 * place[j[both]], 3 * k[both]
        for a, b, component, sign in skew:
            for row, column in ((pi + a, pj + b), (pj + b, pi + a)):
                rows.append(row * size + column)
                columns.append(k + component)
                values.append(np.full(len(k), -sign / 6.0))
    shape = (size * size, 3 * count)
    if not rows:
        return sparse.csr_array(shape)
    entries = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
    return sparse.csr_array(entries, shape=shape)


ADAPTIVE_STEP = 0.8
ADAPTIVE_DAMPING = 0.8
_FLIP = 0.3
_QUIET = 1e-7


@dataclass(frozen=True)
class Pressure:
    """The volume force of the coming turn, and what its law remembers.

    ``value`` [1] in probe units: 1 is the pressure that would change the whole volume by 100 % in one turn;
    ``error`` is that of the last turn, (V0 - V) / V0; ``step`` is the present step length of the adaptive
    law.
    """

    value: float = 0.0
    error: float = 0.0
    step: float = ADAPTIVE_STEP


def next_pressure(control: str, pressure: Pressure, error: float, gain: float) -> Pressure:
    """Return the pressure after a turn that ended with volume ``error`` = (V0 - V) / V0.

    ``conventional`` (paper section 4): proportional to the error, times ``gain``. ``adaptive`` (in the spirit
    of section 5; the formula is ours): the push grows by the error and shrinks by how fast the volume is
    already coming home, and its step is halved whenever the volume flips.
    """
    if control == "none":
        return replace(pressure, error=error)
    if control == "conventional":
        return replace(pressure, value=gain * error, error=error)
    before = pressure.error
    flips = error * before < 0.0 and abs(error) > _FLIP * abs(before) and abs(error) > _QUIET
    step = pressure.step / 2.0 if flips else min(ADAPTIVE_STEP, 1.05 * pressure.step)
    push = step * (error + ADAPTIVE_DAMPING * (error - before))
    return Pressure(pressure.value + push, error, step)
