"""Newton steps to the least energy at constant volume: the exact answer under glued lines (ours).

Unknowns are the free displacements and a multiplier for all that is held: a pressure for each breast, so that
one cannot feed the other (or one for the sum of both, which is what turns hold), and a tension for each line
whose length is held.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from core.geometry.mesh import Floats, Points
from core.mechanics.banded_matrix import Solve
from core.mechanics.iteration import SolverState
from core.mechanics.potential import Evaluation, Potential

RESIDUAL_LIMIT = 1e-10
"""Largest unbalanced force over the mean stiffness [mm] at which the balance counts as exact."""

_QUICK = 0.25
"""A step that leaves no more than this of what was amiss needs no safeguard: most do, at half the cost."""

_PATIENCE = 8
_SHIFT = 1e-3

_BOLD = 8.0
"""No point moves further than this in such a step [mm]."""


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """An iterate of the exact solve: state, residual [mm], left and right pressure, Newton steps taken.

    ``tensions`` (lines,) [mm] are the multipliers of held lines; ``multipliers`` all, in the solver's units.
    """

    state: SolverState
    residual: float
    pressures: Floats
    steps: int
    multipliers: Floats = field(default_factory=lambda: np.zeros(2))
    tensions: Floats = field(default_factory=lambda: np.zeros(0))

    @property
    def is_converged(self) -> bool:
        """Whether the residual came down to the limit, with some grace for round-off."""
        return self.residual < 100.0 * RESIDUAL_LIMIT


def energy_steps(potential: Potential, start: Equilibrium, limit: int) -> Iterator[Equilibrium]:
    """Yield ``start`` and the Newton iterates after it, until exact, lost, or ``limit`` steps are made.

    A short step that leaves a quarter of what was amiss, or less, is taken as it is. Any other is brought
    back to the exact volumes and lengths, and shortened until it lowers the energy.
    """
    place, multipliers = potential.at(start.state.moved), start.multipliers
    spoilt = 0
    for step in range(limit + 1):
        amiss = potential.residual_norm(place, multipliers)
        held = (np.abs(place.held) <= 1e3 * potential.tolerance).all()
        residual = amiss if held else np.inf
        yield equilibrium_at(potential, place.moved, residual, multipliers, step)
        if residual < RESIDUAL_LIMIT or step == limit:
            return
        solve, true = factor(potential, place, multipliers, shifted=spoilt >= _PATIENCE)
        spoilt += not true
        taken = _step(potential, place, multipliers, solve, amiss if true else 0.0)
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
    state = SolverState(moved, iteration=steps)
    pressures, tensions = potential.pressures(multipliers), potential.tensions(multipliers)
    return Equilibrium(state, residual, pressures, steps, multipliers, tensions)


def _step(
    potential: Potential, place: Evaluation, multipliers: Floats, solve: Solve, amiss: float
) -> tuple[Evaluation, Floats] | None:
    """Return where one Newton step leads, and the multipliers there; None if no step lowers the energy.

    ``amiss`` is what is amiss in ``place``, 0 to allow no step without safeguard.
    """
    solved = solve(np.column_stack([-place.gradient, place.slopes.T]))
    free, push = solved[:, 0], solved[:, 1:]
    new = -small_solve(place.slopes @ push, place.slopes @ free + place.held)
    direction = free + push @ new
    if amiss and np.abs(direction).max(initial=0.0) < _BOLD:
        there = potential.at(place.moved + direction.reshape(-1, 3))
        if potential.residual_norm(there, new) <= _QUICK * amiss:
            return there, new
    if (np.abs(place.held) > potential.tolerance).any():
        start = _retract(potential, place.moved, push)
        return None if start is None else (start, multipliers)
    found = _line_search(potential, place, direction, push)
    return None if found is None else (found, new)


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
    here, slope = potential.energy(place), float(place.gradient @ direction)
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
    for _ in range(12):
        place = potential.at(moved)
        away = np.abs(place.held)
        if (away < potential.tolerance).all():
            return place
        moved = moved - (push @ small_solve(place.slopes @ push, place.held)).reshape(-1, 3)
        if not np.isfinite(moved).all():
            return None
    return place if (away < 1e3 * potential.tolerance).all() else None


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
