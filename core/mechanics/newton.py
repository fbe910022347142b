"""Newton steps to the least energy at constant volume: the exact answer under glued lines (ours).

Unknowns are the free displacements and a multiplier for all that is held: a pressure for each breast, so that
one cannot feed the other (or one for the sum of both, which is what turns hold), and a tension for each line
whose length is held.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from core.geometry.mesh import Floats, Points
from core.mechanics.banded_matrix import Solve
from core.mechanics.iteration import SolverState
from core.mechanics.model import ConstrainedModel
from core.mechanics.potential import Evaluation, Potential

RESIDUAL_LIMIT = 1e-10
"""Largest unbalanced force over the mean stiffness [mm] at which the balance counts as exact."""

_QUICK = 0.25
"""A step that leaves no more than this of what was amiss needs no safeguard: most do, at half the cost."""

_AGAIN = 0.1
"""The same for a step with the factors of an earlier one: six of these cost as much as new factors."""

_PATIENCE = 8
_SHIFT = 1e-3

_BOLD = 8.0
"""No point moves further than this in such a step [mm]."""


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """An iterate of the exact solve: state, residual [mm], pressures of the zones, Newton steps taken.

    ``tensions`` (lines,) [mm] are the multipliers of held lines; ``multipliers`` all, in the solver's units.
    ``factors`` are those of a place near by, of a solid alone.
    """

    state: SolverState
    residual: float
    pressures: Floats
    steps: int
    multipliers: Floats = field(default_factory=lambda: np.zeros(2))
    tensions: Floats = field(default_factory=lambda: np.zeros(0))
    factors: Solve | None = field(default=None, repr=False)

    @property
    def is_converged(self) -> bool:
        """Return whether the residual came down to the limit, with some grace for round-off."""
        return self.residual < 100.0 * RESIDUAL_LIMIT


def energy_steps(potential: Potential, start: Equilibrium, limit: int) -> Iterator[Equilibrium]:
    """Yield ``start`` and the Newton iterates after it, until exact, lost, or ``limit`` steps are made.

    A short step that leaves a quarter of what was amiss, or less, is taken as it is. Any other is brought
    back to the exact volumes and lengths, and shortened until it lowers the energy. The factors of a solid
    cost far more than the rest of a step: they serve the next steps too, as long as these lead far enough.
    """
    place, multipliers = potential.at(start.state.moved), start.multipliers
    spoilt, kept = 0, start.factors if potential.one_sided else None
    for step in range(limit + 1):
        amiss = potential.residual_norm(place, multipliers)
        held = (np.abs(potential.amiss(place, multipliers)) <= 1e3 * potential.tolerance).all()
        residual = amiss if held else np.inf
        yield replace(equilibrium_at(potential, place.moved, residual, multipliers, step), factors=kept)
        if residual < RESIDUAL_LIMIT or step == limit:
            return
        taken = kept and _quick(potential, place, _Direction.towards(potential, place, kept), _AGAIN * amiss)
        if taken is None:
            solve, true = factor(potential, place, multipliers, shifted=spoilt >= _PATIENCE)
            spoilt += not true
            taken = _step(potential, place, multipliers, solve, amiss if true else 0.0)
            kept = solve if true and potential.one_sided else None
        if taken is None:
            return
        place, multipliers = taken


def equilibrium_at(
    potential: Potential,
    moved: Points,
    residual: float = np.inf,
    multipliers: Floats | None = None,
    steps: int = 0,
) -> Equilibrium:
    """Return a place as an iterate: ``moved`` (f, 3) [mm] with its residual and multipliers, 0 if None."""
    if multipliers is None:
        multipliers = np.zeros(len(potential.wanted))
    pressures, tensions = potential.pressures(multipliers), potential.tensions(multipliers)
    state = SolverState(moved, potential.model.state_pressure(pressures), steps)
    return Equilibrium(state, residual, pressures, steps, multipliers, tensions)


@dataclass(frozen=True, eq=False)
class _Direction:
    """Where factors lead: ``way`` (3 f,), and ``multipliers``, each of which moves by ``push`` (3 f, h)."""

    way: Floats
    multipliers: Floats
    push: Floats

    @staticmethod
    def towards(potential: Potential, place: Evaluation, solve: Solve) -> _Direction:
        """Return the direction of a Newton step from a place."""
        solved = solve(np.column_stack([-place.gradient, place.slopes.T]))
        free, push = solved[:, 0], solved[:, 1:]
        small = potential.small_matrix(place.slopes, push)
        multipliers = -small_solve(small, place.slopes @ free + place.held)
        return _Direction(free + push @ multipliers, multipliers, push)


def _step(
    potential: Potential, place: Evaluation, multipliers: Floats, solve: Solve, amiss: float
) -> tuple[Evaluation, Floats] | None:
    """Return where one Newton step leads, and the multipliers there; None if no step lowers the energy.

    ``amiss`` is what is amiss in ``place``, 0 to allow no step without safeguard.
    """
    ahead = _Direction.towards(potential, place, solve)
    if amiss and (quick := _quick(potential, place, ahead, _QUICK * amiss)) is not None:
        return quick
    if (np.abs(place.held) > potential.tolerance)[potential.exact].any():
        start = _retract(potential, place.moved, ahead.push)
        return None if start is None else (start, multipliers)
    found = _line_search(potential, place, ahead.way, ahead.push)
    return None if found is None else (found, ahead.multipliers)


def _quick(
    potential: Potential, place: Evaluation, ahead: _Direction, most: float
) -> tuple[Evaluation, Floats] | None:
    """Return the end of a short step and its multipliers, None unless at most ``most`` is amiss there."""
    if np.abs(ahead.way).max(initial=0.0) >= _BOLD:
        return None
    there = potential.at(place.moved + ahead.way.reshape(-1, 3))
    return (there, ahead.multipliers) if potential.residual_norm(there, ahead.multipliers) <= most else None


def factor(
    potential: Potential, place: Evaluation, multipliers: Floats, shifted: bool = False
) -> tuple[Solve, bool]:
    """Return a solver of the first positive definite Hessian, and whether it is the full one.

    The others leave out what spoils it; that is quick at first, but crawls where a fine mesh wrinkles. If
    ``shifted``, the full one is stiffened against the ground instead, no more than is needed.
    """
    band = potential.model.layout.band
    full = potential.hessian(place, multipliers, clip=False, curved=True)
    solve = band.cholesky(full)
    if solve is not None:
        return solve, True
    shift = _SHIFT * potential.model.tensegric.mean_stiffness
    while shifted and solve is None:
        stiffened = full.copy()
        stiffened[:: band.reach + 1] += shift
        solve, shift = band.cholesky(stiffened), 3.0 * shift
    for curved in (True, False):
        if solve is None:
            solve = band.cholesky(potential.hessian(place, multipliers, clip=True, curved=curved))
    assert solve is not None, "cables alone are positive definite"
    return solve, False


def _line_search(
    potential: Potential, place: Evaluation, direction: Floats, push: Floats
) -> Evaluation | None:
    """Return where the longest halved step that lowers the energy leads, all held again, or None."""
    here, slope = potential.energy(place), potential.slope(place, direction)
    length = 1.0
    while length > 1e-6:
        there = _retract(potential, place.moved + length * direction.reshape(-1, 3), push)
        if there is not None:
            # The last steps lower the energy by less than its round-off: allow for that.
            allowed = here + 1e-4 * length * min(slope, 0.0) + 1e-12 * abs(here)
            if potential.energy(there) <= allowed:
                return there
        length /= 2.0
    return None


def _retract(potential: Potential, moved: Points, push: Floats) -> Evaluation | None:
    """Return the place ``moved`` shifted along ``push`` (3 f, h) until all is held as it should be."""
    exact = potential.exact
    if not exact.all():
        push = push[:, exact]
    for _ in range(12):
        place = potential.at(moved)
        held, slopes = place.held[exact], place.slopes[exact]
        if (np.abs(held) < potential.tolerance[exact]).all():
            return place
        moved = moved - (push @ small_solve(slopes @ push, held)).reshape(-1, 3)
        if not np.isfinite(moved).all():
            return None
    return place if (np.abs(held) < 1e3 * potential.tolerance[exact]).all() else None


def small_solve(matrix: Floats, right: Floats) -> Floats:
    """Solve the small system of what is held; least multipliers where they do not matter."""
    if len(right) == 2:
        # By hand: the two breasts are the rule, and LAPACK's way to a 2 x 2 system is long.
        (a, b), (c, d) = matrix.tolist()
        whole, mixed = a * d, b * c
        if abs(whole - mixed) > 1e-12 * max(abs(whole), abs(mixed)):
            p, q = right.tolist()
            return np.asarray(np.array([d * p - b * q, a * q - c * p]) / (whole - mixed))
    try:
        return np.asarray(np.linalg.solve(matrix, right))
    except np.linalg.LinAlgError:
        return np.asarray(np.linalg.lstsq(matrix, right, rcond=1e-12)[0])


LONGEST_STEP = 8.0
"""No point moves further than this in one step [mm]."""


def sliding_steps(potential: Potential, start: Equilibrium, limit: int) -> Iterator[Equilibrium]:
    """Yield ``start`` and the Newton iterates after it, until exact, lost, or ``limit`` steps are made."""
    moved, multipliers = start.state.moved, start.multipliers
    skin = SlidingSurface(potential.model)
    for step in range(limit + 1):
        place = potential.at(moved)
        forces, push = skin.projected(place)
        residual = potential.residual(place, forces - push.T @ multipliers, multipliers)
        yield equilibrium_at(potential, moved, residual, multipliers, step)
        if residual < RESIDUAL_LIMIT or step == limit:
            return
        solve = potential.model.layout.band.lu(skin.derivative(potential, place, multipliers))
        if solve is None:
            return
        solved = solve(np.column_stack([-forces, push.T]))
        free, along = solved[:, 0], solved[:, 1:]
        small = potential.small_matrix(place.slopes, along)
        multipliers = -small_solve(small, place.slopes @ free + place.held)
        shift = (free + along @ multipliers).reshape(-1, 3)
        longest = float(np.sqrt(np.einsum("ij,ij->i", shift, shift).max()))
        if not np.isfinite(longest):
            return
        moved = moved + shift * (LONGEST_STEP / max(longest, LONGEST_STEP))


class SlidingSurface:
    """The directions across the skin at the points of sliding lines, and what they do to forces."""

    def __init__(self, model: ConstrainedModel) -> None:
        self.model = model
        # Before the tensions of held lines come one pressure for all zones or one for each.
        together = model.volume.closed or model.options.volume_of == "both"
        self._first_line = 1 if together else model.volume.zones
        self._area = abs(model.volume.rest_volume) ** (2.0 / 3.0)
        self.nodes = model.layout.nodes
        corners = model.layout.corners_of_lines
        self._node, self._axis = corners.row // 3, corners.row % 3
        # All zones alike: n is across their sum.
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
