"""The exact answer: least energy at constant volume, by Newton steps (ours, beyond the paper).

Unknowns are the free displacements and one pressure for each breast, so that one cannot feed the other. Turns
hold only the sum of both volumes: on a symmetric body they end at this answer, on an asymmetric one close to
it. Every iterate has the exact volumes, and the energy falls strictly.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError, cho_factor, cho_solve

from core.mesh import Floats, Points
from core.solver import ConstrainedModel, State, at_rest

RESIDUAL_LIMIT = 1e-10
"""Largest unbalanced force over the mean stiffness [mm] at which the balance counts as exact."""

NEWTON_LIMIT = 200
"""Newton steps after which the search is given up; half a dozen are the rule."""


@dataclass(frozen=True, eq=False)
class Balance:
    """An iterate of the exact solve: state, residual [mm], left and right pressure, Newton steps taken."""

    state: State
    residual: float
    pressures: Floats
    steps: int

    @property
    def found(self) -> bool:
        """Whether the residual came down to the limit, with some grace for round-off."""
        return self.residual < 100.0 * RESIDUAL_LIMIT


class Energy:
    """Elastic energy of cables and lines over the free displacements (f, 3) [mm], with two derivatives."""

    def __init__(self, model: ConstrainedModel, ratios: tuple[float, ...]) -> None:
        self.model = model
        self.cables = model.tensegric.stiffness
        self.natural = model.natural_lengths(ratios)

    def _spans(self, moved: Points) -> tuple[Points, Floats]:
        spans = self.model.rest_spans + self.model.signs @ moved
        return spans, np.sqrt(np.einsum("ij,ij->i", spans, spans))

    def value(self, moved: Points) -> float:
        """Return the energy above that of the slack rest shape."""
        _, length = self._spans(moved)
        lines = self.model.line_stiffness @ (length - self.natural) ** 2
        return 0.5 * float(np.sum(moved * (self.cables @ moved)) + lines)

    def gradient(self, moved: Points) -> Points:
        """Return the first derivative, shape (f, 3)."""
        spans, length = self._spans(moved)
        tension = self.model.line_stiffness * (1.0 - self.natural / length)
        return np.asarray(self.cables @ moved + self.model.signs.T @ (tension[:, None] * spans))

    def hessian(self, moved: Points, clip: bool) -> Floats:
        """Return the second derivative, shape (3 f, 3 f).

        ``clip`` leaves out what compressed lines take from it.
        """
        spans, length = self._spans(moved)
        u = spans / length[:, None]
        b = 1.0 - self.natural / length
        if clip:
            b = np.maximum(b, 0.0)
        k = self.model.line_stiffness
        blocks = (k * (1.0 - b))[:, None, None] * u[:, :, None] * u[:, None, :]
        blocks += (k * b)[:, None, None] * np.eye(3)
        size = 3 * len(moved)
        lines = (self.model.line_scatter @ blocks.ravel()).reshape(size, size)
        return np.asarray(self.model.cable_hessian + lines)


def solve_exact(model: ConstrainedModel, ratios: tuple[float, ...], limit: int = NEWTON_LIMIT) -> Balance:
    """Return the exact balance for line ``ratios``, one per line."""
    *_, last = newton(model, ratios, limit)
    return last


def newton(
    model: ConstrainedModel, ratios: tuple[float, ...], limit: int = NEWTON_LIMIT
) -> Iterator[Balance]:
    """Yield each Newton iterate from rest, rest included, until exact or ``limit`` steps are made.

    It always starts at rest, so that the answer depends on the design alone and not on the way there.
    """
    energy = Energy(model, ratios)
    wanted = model.volume.side_volumes(model.tensegric.rest)
    moved = at_rest(model).moved
    pressures, residual = np.zeros(2), np.inf
    for step in range(limit + 1):
        gradient = energy.gradient(moved).ravel()
        sides = model.volume.side_gradients(model.tensegric.expand(moved)).reshape(2, -1)
        if step:
            unbalanced = float(np.abs(gradient - sides.T @ pressures).max())
            residual = unbalanced / model.tensegric.mean_stiffness
        yield Balance(State(moved, turn=step), residual, pressures, step)
        if residual < RESIDUAL_LIMIT or step == limit:
            return
        solve = _factor(model, energy, moved, pressures)
        solved = solve(np.column_stack([-gradient, sides.T]))
        free, push = solved[:, 0], solved[:, 1:]
        pressures = -_small_solve(sides @ push, sides @ free)
        direction = free + push @ pressures
        taken = _line_search(model, energy, moved, direction, push, wanted, float(gradient @ direction))
        if taken is None:
            return
        moved = taken


def _factor(
    model: ConstrainedModel, energy: Energy, moved: Points, pressures: Floats
) -> Callable[[Floats], Floats]:
    """Return a solver of the first positive definite Hessian: the full one, or without what spoils it."""
    shift = 1e-8 * model.tensegric.mean_stiffness * np.eye(3 * len(moved))
    bend = model.volume.hessian(model.tensegric.expand(moved), pressures)
    for clip, curved in ((False, True), (True, True), (True, False)):
        matrix = energy.hessian(moved, clip) + shift - (bend if curved else 0.0)
        try:
            factor = cho_factor(matrix, lower=True, check_finite=False)
        except LinAlgError:
            continue
        return lambda right: np.asarray(cho_solve(factor, right, check_finite=False))
    raise AssertionError("cables alone are positive definite")


def _line_search(
    model: ConstrainedModel,
    energy: Energy,
    moved: Points,
    direction: Floats,
    push: Floats,
    wanted: Floats,
    slope: float,
) -> Points | None:
    """Return where the longest halved step that lowers the energy leads, brought to the volumes, or None."""
    here = energy.value(moved)
    length = 1.0
    while length > 1e-6:
        there = _retract(model, moved + length * direction.reshape(-1, 3), push, wanted)
        # The last steps lower the energy by less than its round-off: allow for that.
        if there is not None and energy.value(there) <= here + 1e-4 * length * min(slope, 0.0) + 1e-12 * abs(
            here
        ):
            return there
        length /= 2.0
    return None


def _retract(model: ConstrainedModel, moved: Points, push: Floats, wanted: Floats) -> Points | None:
    """Return ``moved`` shifted along ``push`` (3 f, 2) until both breasts have their ``wanted`` volumes."""
    tolerance = 1e-13 * abs(model.volume.rest_volume)
    for _ in range(12):
        points = model.tensegric.expand(moved)
        missing = wanted - model.volume.side_volumes(points)
        if float(np.abs(missing).max()) < tolerance:
            return moved
        sides = model.volume.side_gradients(points).reshape(2, -1)
        moved = moved + (push @ _small_solve(sides @ push, missing)).reshape(-1, 3)
        if not np.isfinite(moved).all():
            return None
    return moved if float(np.abs(missing).max()) < 1e3 * tolerance else None


def _small_solve(matrix: Floats, right: Floats) -> Floats:
    """Solve the 2 x 2 system of the two breasts; least pressures where they do not matter."""
    return np.asarray(np.linalg.lstsq(matrix, right, rcond=1e-12)[0])
