"""The volume of the control mesh, its gradient and curvature, and the laws that hold it.

Source: paper sections 4 and 5.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy import sparse

from core.geometry.mesh import Faces, Flags, Floats, Indices, Mesh, Points, frozen
from core.mechanics.banded_matrix import Entries, Operator, compact, joined

ITERATIVE_CONTROLS = ("none", "conventional", "accumulating", "adaptive")
"""The volume controls with a law in ``next_pressure``."""

CONTROLS = (*ITERATIVE_CONTROLS, "exact")
"""All volume controls as project files name them; ``exact`` is the solution that iterations approach.

Window and command line call ``accumulating`` integral: ``control_texts`` in
``app/presenters/model_options.py``, ``STORED`` in ``app/cli/options.py``.
"""

KEEPS_VOLUME = ("accumulating", "adaptive")
"""The iterative controls whose volume error is zero at rest. At rest under another, the pressure is the gain
times the error: ``gain`` of the design for ``conventional``, else 0.
"""


@dataclass(frozen=True, eq=False)
class VolumeMeasure:
    """The volume between the control mesh and the fan from the centre of its borders, in k zones.

    A closed mesh may have any centre. Borders are fixed, so a volume *difference* does not depend on the
    centre; ``rest_volume`` [mm^3] and with it every percentage does. ``faces`` (m, 3) are the triangles that
    can move and ``zone`` (m,) their zones: of a bust 0 is the subject's left breast and 1 the right one.
    ``still_volume`` [mm^3] is the share of all other triangles. ``closed`` tells that there is no border,
    and no zones that could be told apart. ``gather`` (3 m, k f) sums a sixth of what corners of the
    triangles of each zone get at the free points. ``kept`` (k,) [1] is how much of the volume that lines
    displace stays in each zone. Iterations hold zones that are ``separate`` each by a pressure of its own,
    others by one pressure together.
    """

    centre: Floats
    faces: Faces
    zone: Indices
    still_volume: float
    rest_volume: float
    closed: bool
    gather: Operator
    free_count: int
    kept: Floats
    separate: bool = False

    @property
    def zones(self) -> int:
        """Return the number of zones."""
        return len(self.kept)

    def volume(self, points: Points) -> float:
        """Return the volume of the control points, shape (n, 3) [mm^3]."""
        return self.still_volume + float(self.zone_volumes(points).sum())

    def zone_volumes(self, points: Points) -> Floats:
        """Return the volumes of the moving triangles of each zone, shape (k,) [mm^3]."""
        corners = (points - self.centre).ravel().take(self._cycle[:, :3])
        areas = corners[1:4, 1] * corners[2:5, 2] - corners[2:5, 1] * corners[1:4, 2]
        return np.asarray(self._shares @ (corners[:3, 0] * areas).sum(axis=0))

    def gradient(self, points: Points) -> Points:
        """Return dV/dx at the free points, shape (f, 3) [mm^2]: the direction of the volume force."""
        return np.asarray(self.zone_gradients(points).sum(axis=0))

    def zone_gradients(self, points: Points) -> Floats:
        """Return dV/dx of the volume of each zone, shape (k, f, 3) [mm^2]."""
        return self.measure(points)[1]

    def measure(self, points: Points) -> tuple[Floats, Floats]:
        """Return ``zone_volumes`` and ``zone_gradients`` of control points, shape (n, 3) [mm], at once."""
        corners = (points - self.centre).ravel().take(self._cycle)
        # What stands one and two further on in both axes and corners makes the cross products of all corners.
        areas = corners[1:4, 1:4] * corners[2:5, 2:5]
        areas -= corners[2:5, 1:4] * corners[1:4, 2:5]
        each = (corners[:3, 0] * areas[:, 0]).sum(axis=0)
        sums = areas.reshape(3, -1) @ self.gather
        return self._shares @ each, np.asarray(sums.T.reshape(self.zones, self.free_count, 3))

    @cached_property
    def _cycle(self) -> Indices:
        """Where x, y, z, x, y of the corners 0, 1, 2, 0, 1 stand among all coordinates, shape (5, 5, m)."""
        round_ = np.array([0, 1, 2, 0, 1])
        return np.ascontiguousarray(3 * self.faces.T[round_][None] + round_[:, None, None])

    @cached_property
    def _shares(self) -> Floats:
        return np.asarray((self.zone == np.arange(self.zones)[:, None]) / 6.0)

    def curvature(self, place: Indices) -> Entries:
        """Return where the second derivatives of the volumes of all zones lie.

        Its figures are the places (points - centre), shape (3 n,) [mm], times the pressure of each zone in
        turn. V is cubic: the block of points i and j of a triangle (i, j, k) is -[x_k]_x / 6, its mirror the
        transpose. ``place`` (n,) is the row of each point among the free ones, else -1.
        """
        count = 3 * len(place)
        parts = [_curvature(self.faces[self.zone == at], place, at * count) for at in range(self.zones)]
        return joined(parts, self.zones * count)


def volume_measure(
    mesh: Mesh,
    free: Indices,
    zone: Indices | None = None,
    kept: Sequence[float] = (1.0, 1.0),
    *,
    separate: bool = False,
) -> VolumeMeasure:
    """Prepare the volume of a control mesh; ``zone``, shape (m,), numbers the zone of each triangle.

    Without it 0 is the left and 1 the right of the middle. ``kept`` [1] has a share for each zone;
    ``separate`` see ``VolumeMeasure``.
    """
    loops = mesh.boundary_loops
    centre = mesh.vertices[loops[0]].mean(axis=0) if loops else mesh.vertices.mean(axis=0)
    if len(loops) > 1:  # inside a trunk, so that zones are no slanted cones
        centre = mesh.vertices.mean(axis=0)
    if zone is None:
        zone = np.where(mesh.vertices[mesh.faces].mean(axis=1)[:, 0] > centre[0], 0, 1)
    place = np.full(len(mesh.vertices), -1, dtype=np.int64)
    place[free] = np.arange(len(free))
    moving = (place[mesh.faces] >= 0).any(axis=1)
    faces, zone = mesh.faces[moving], zone[moving]
    still = Mesh(mesh.vertices, mesh.faces[~moving]).enclosed_volume(centre)
    rest = mesh.enclosed_volume(centre)
    gather = _gather(faces, zone, place, len(free), len(kept))
    measured = faces, zone, still, rest, not loops, gather, len(free)
    return VolumeMeasure(frozen(centre), *measured, frozen(kept), separate)


def _gather(faces: Faces, zone: Indices, place: Indices, free_count: int, zones: int) -> Operator:
    at = place[faces.T] + free_count * zone
    moves = np.flatnonzero((place[faces.T] >= 0).ravel())
    where = (moves, at.ravel()[moves])
    shape = (faces.size, zones * free_count)
    return compact(sparse.csr_array((np.full(len(moves), 1.0 / 6.0), where), shape=shape))


def _curvature(faces: Faces, place: Indices, offset: int) -> Entries:
    parts = []
    # Entries (a, b) of the matrix [v]_x, each with the component of v that stands there and its sign.
    skew = ((0, 1, 2, -1.0), (0, 2, 1, 1.0), (1, 0, 2, 1.0), (1, 2, 0, -1.0), (2, 0, 1, -1.0), (2, 1, 0, 1.0))
    for turn in range(3):
        i, j, k = (faces[:, (turn + step) % 3] for step in range(3))
        both = (place[i] >= 0) & (place[j] >= 0)
        pi, pj, k = 3 * place[i[both]], 3 * place[j[both]], 3 * k[both]
        for a, b, component, sign in skew:
            value = np.full(len(k), -sign / 6.0)
            parts.append(Entries(pi + a, pj + b, offset + k + component, value, 0))
            parts.append(Entries(pj + b, pi + a, offset + k + component, value, 0))
    return joined(parts, 0)


ADAPTIVE_STEP = 0.8
ADAPTIVE_DAMPING = 0.8
INTEGRAL_STEP = 0.5
_FLIP = 0.3
_QUIET = 1e-7


@dataclass(frozen=True)
class Pressure:
    """The volume force of the coming turn, and what its law remembers, a figure for each volume held.

    ``value`` [1] in probe units: 1 is the pressure that would change the whole volume by 100 % in one turn;
    ``error`` is that of the last turn, (V0 - V) / V0; ``step`` is the present step length of the adaptive
    law. Each is a number, or has shape (z,) where zones are held separately.
    """

    value: float | Floats = 0.0
    error: float | Floats = 0.0
    step: float | Floats = ADAPTIVE_STEP


def next_pressure(control: str, pressure: Pressure, error: float | Floats, gain: float) -> Pressure:
    """Return the pressure after a turn that ended with volume ``error`` = (V0 - V) / V0.

    ``conventional`` (paper section 4): proportional to the error, times ``gain``. ``adaptive`` (in the spirit
    of section 5; the formula is ours): the push grows by the error and shrinks by how fast the volume is
    already coming home, and its step is halved whenever the volume flips. ``accumulating`` (ours) is the
    plain baseline between them: half of every error is added. Zones that are held separately each follow
    the law by themselves. Raises ValueError for another control.
    """
    if control == "none":
        return replace(pressure, error=error)
    if control == "conventional":
        return replace(pressure, value=gain * error, error=error)
    if control == "accumulating":
        return replace(pressure, value=pressure.value + INTEGRAL_STEP * error, error=error)
    if control != "adaptive":
        raise ValueError(f"volume control {control!r} has no law")
    before = pressure.error
    size = np.abs(error)
    flips = (error * before < 0.0) & (size > _FLIP * np.abs(before)) & (size > _QUIET)
    step = _shortened(pressure.step, flips)
    push = step * (error + ADAPTIVE_DAMPING * (error - before))
    return Pressure(pressure.value + push, error, step)


def _shortened(step: float | Floats, flips: bool | Flags) -> float | Floats:
    """Return the next step length of the adaptive law: half where the volume ``flips``, else a bit longer."""
    longer = np.minimum(ADAPTIVE_STEP, 1.05 * np.asarray(step))
    new = np.where(flips, np.asarray(step) / 2.0, longer)
    return float(new) if new.ndim == 0 else new
