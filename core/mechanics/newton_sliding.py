"""The exact answer under sliding lines, which no energy describes: Newton steps on the balance itself (ours).

At each point of a line only the part of its force across the skin acts; the garment carries the rest. The
direction across the skin turns with the body, and the derivative below knows that, so the last steps converge
quadratically.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from core.geometry.mesh import Floats, Points
from core.mechanics.model import ConstrainedModel
from core.mechanics.newton import RESIDUAL_LIMIT, Equilibrium, equilibrium_at, small_solve
from core.mechanics.potential import Evaluation, Potential

LONGEST_STEP = 8.0
"""No point moves further than this in one step [mm]."""


def sliding_steps(potential: Potential, start: Equilibrium, limit: int) -> Iterator[Equilibrium]:
    """Yield ``start`` and the Newton iterates after it, until exact, lost, or ``limit`` steps are made."""
    moved, multipliers = start.state.moved, start.multipliers
    skin = SlidingSurface(potential.model)
    for step in range(limit + 1):
        place = potential.at(moved)
        forces, push = skin.projected(place)
        residual = potential.residual(place, forces - push.T @ multipliers)
        yield equilibrium_at(potential, moved, residual, multipliers, step)
        if residual < RESIDUAL_LIMIT or step == limit:
            return
        solve = potential.model.layout.band.lu(skin.derivative(potential, place, multipliers))
        if solve is None:
            return
        solved = solve(np.column_stack([-forces, push.T]))
        free, along = solved[:, 0], solved[:, 1:]
        multipliers = -small_solve(place.slopes @ along, place.slopes @ free + place.held)
        shift = (free + along @ multipliers).reshape(-1, 3)
        longest = float(np.sqrt(np.einsum("ij,ij->i", shift, shift).max()))
        if not np.isfinite(longest):
            return
        moved = moved + shift * (LONGEST_STEP / max(longest, LONGEST_STEP))


class SlidingSurface:
    """The directions across the skin at the points of sliding lines, and what they do to forces."""

    def __init__(self, model: ConstrainedModel) -> None:
        self.model = model
        # Before the tensions of held lines come one pressure for both sides or one for each.
        self._first_line = 1 if model.volume.closed or model.options.volume_of == "both" else 2
        self._area = abs(model.volume.rest_volume) ** (2.0 / 3.0)
        self.nodes = model.layout.nodes
        corners = model.layout.corners_of_lines
        self._node, self._axis = corners.row // 3, corners.row % 3
        # Left and right alike: n is across the sum of both.
        self._source, self._value = corners.source % (3 * len(model.tensegric.rest)), corners.value

    def _across(self, place: Evaluation) -> tuple[Points, Floats]:
        """Return n at the points of the lines, 0 elsewhere, (f, 3), and the volume gradient's size, (f,)."""
        outward = self._area * place.slopes[: self._first_line].sum(axis=0).reshape(-1, 3)
        size = np.sqrt(np.einsum("ij,ij->i", outward, outward))
        n = np.zeros_like(outward)
        n[self.nodes] = outward[self.nodes] / size[self.nodes, None]
        return n, size

    def normals(self, place: Evaluation) -> Points:
        """Return the directions across the skin at the points of the lines, 0 elsewhere, shape (f, 3)."""
        return self._across(place)[0]

    def across(self, place: Evaluation) -> Callable[[Points], Floats]:
        """Return what takes of forces, shape (f, 3), the part across the skin, shape (3 f,)."""
        n, _ = self._across(place)
        return lambda force: np.asarray((n * np.einsum("ij,ij->i", force, n)[:, None]).ravel())

    def projected(self, place: Evaluation) -> tuple[Floats, Floats]:
        """Return the forces to balance, shape (3 f,), and the directions of the multipliers, (h, 3 f)."""
        across = self.across(place)
        push = place.slopes.copy()
        for row in range(self._first_line, len(push)):
            push[row] = across(push[row].reshape(-1, 3))
        return place.inner.ravel() + across(place.line), push

    def derivative(self, potential: Potential, place: Evaluation, multipliers: Floats) -> Floats:
        """Return the derivative of the projected forces less the multipliers' as a general band."""
        band, model = self.model.layout.band, self.model
        inner = band.spread(potential.hessian(place, multipliers, clip=False, curved=True, lines=False))
        n, size = self._across(place)
        blocks = potential.line_blocks(place, multipliers, clip=False)
        segment, point = model.layout.acting_pairs
        felt = (n[point, :, None] * n[point, None, :]) @ blocks[segment]
        # n turns with the skin: its derivative is that of the volume's gradient, less the part along n.
        first = self._first_line
        line = place.line - (multipliers[first:] @ place.slopes[first:]).reshape(n.shape)
        normal = np.einsum("ij,ij->i", n, line)
        turning = normal[:, None, None] * np.eye(3) + n[:, :, None] * line[:, None, :]
        turning = turning @ (np.eye(3) - n[:, :, None] * n[:, None, :]) / size[:, None, None]
        centred = (place.points - model.volume.centre).ravel()
        figures = turning[self._node, :, self._axis] * (self._value * centred[self._source])[:, None]
        return np.asarray(
            inner
            + model.layout.lines_general @ felt.ravel()
            + model.layout.rotation_general @ figures.ravel()
        )
