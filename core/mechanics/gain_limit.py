"""Gain limit of the conventional force, at the original and at any equilibrium (ours).

A turn is linear for small moves: it moves the points by M^-1 (P a - K d), M being the lower triangle of the
stiffness that a turn solves for, K the true stiffness where the points are and a the direction of the volume
force. On the brink the displacement d flips from turn to turn, so that 2 M d - K d = P a, and its volume
calls forth the very pressure that made it.
"""

from __future__ import annotations

import numpy as np
from scipy import sparse
from scipy.sparse import linalg as sparse_linalg

from core.geometry.mesh import Floats, Points, unit
from core.mechanics.banded_matrix import (
    Entries,
    Operator,
    Solve,
    lower_points,
    over_axes,
    weighted_sum,
)
from core.mechanics.condensed_tissue import CondensedTissue
from core.mechanics.iteration import HELD_GROWTH
from core.mechanics.model import ConstrainedModel
from core.mechanics.newton import LONGEST_STEP, Equilibrium, SlidingSurface, equilibrium_at
from core.mechanics.potential import Evaluation, Potential
from core.mechanics.springs import Springs
from core.mechanics.tensegrity import TissueModel

_NEAR_ENOUGH = 1e-6  # largest unbalanced force over the mean stiffness [mm]: the limit does not see less
_STEPS = 12  # three are the rule
_DENSE = 0.3  # share of entries that are not 0 from which a full matrix is solved sooner


def gain_limit(model: ConstrainedModel) -> float:
    """Return the conventional gain above which small volume errors flip and grow at rest (probe units [1]).

    The tension of held lines, which also changes from turn to turn, is left out.
    """
    pushes = held_directions(model, model.tensegric.rest).reshape(-1, 3 * len(model.tensegric.free)).T
    if isinstance(model.tensegric, CondensedTissue):
        flipped = np.linalg.solve(_solid_double_lower_less_true(model, model.tensegric), pushes)
        return flip_limit(model, pushes, np.asarray(flipped))
    cables, lines = _double_lower_less_true(model)
    if model.options.line_contact == "sliding":
        n = unit(model.rest_gradient)
        across = sparse.csr_array(sparse.block_diag([np.outer(v, v) for v in n], format="csr"))
        lines = sparse.csr_array(across @ lines)
    matrix = sparse.csc_array(cables + lines)
    dense = matrix.nnz > _DENSE * len(pushes) ** 2
    solve = sparse_linalg.spsolve
    flipped = np.linalg.solve(matrix.toarray(), pushes) if dense else solve(matrix, pushes)
    return flip_limit(model, pushes, np.asarray(flipped).reshape(pushes.shape))


def held_directions(model: ConstrainedModel, points: Points) -> Floats:
    """Return the directions of the pressures of iterations, (z, f, 3) [mm^2]: one, or that of each zone."""
    each = model.volume.zone_gradients(points)
    return each if model.volume.separate else each.sum(axis=0, keepdims=True)


def flip_limit(model: ConstrainedModel, pushes: Floats, flipped: Floats) -> float:
    """Return the gain at which the pressures call themselves forth again, their signs changed [1].

    ``flipped`` (3 f, z) is how the points move under each of ``pushes`` (3 f, z) [mm^2] where displacements
    change their sign from turn to turn. Separate zones do so together: the largest eigenvalue tells when.
    """
    if not model.volume.separate:
        return model.probe / abs(float(pushes[:, 0] @ flipped[:, 0]))
    answers = np.linalg.solve(model.zone_responses, pushes.T @ flipped + np.diag(model.give))
    return 1.0 / float(np.abs(np.linalg.eigvals(answers)).max())


class OscillationLimit:
    """What turns of the conventional control come to in a ``model``, and when they swing about it."""

    def __init__(self, model: ConstrainedModel) -> None:
        self._model, self._together = model, not model.volume.separate
        slides = model.options.line_contact == "sliding" and len(model.owner) > 0
        self._skin = SlidingSurface(model) if slides else None
        band = model.layout.band
        self._lower = self._triangle(model.tensegric.stiffness if slides else model.stiffness)
        if slides:
            row, column, weight = sparse.find(sparse.tril(model.line_bound))
            self._row, each = row, 9 * np.arange(len(row))[:, None]
            a, b = (axis.ravel()[None, :] for axis in np.indices((3, 3)))
            self._of_lines = band.general(
                Entries(
                    (3 * row[:, None] + a).ravel(),
                    (3 * column[:, None] + b).ravel(),
                    (each + 3 * a + b).ravel(),
                    np.repeat(weight, 9),
                    9 * len(row),
                )
            )

    def equilibrium(self, potential: Potential, near: Equilibrium, gain: float) -> Equilibrium | None:
        """Return where turns of the conventional control with ``gain`` come to rest, if they do, or None.

        Its pressure is ``gain`` times the volume error, so volume is missing there; ``near`` is the exact
        balance.
        """
        sides = len(potential.groups)
        soft = self._missing(potential, gain)
        moved = near.state.moved
        multipliers = _joint(near.multipliers, sides) if self._together else near.multipliers
        for step in range(_STEPS):
            place = potential.at(moved)
            forces, push = self._forces(place, sides)
            slopes, held = self._rows(place.slopes, sides), self._rows(place.held, sides)
            amiss = held + soft @ multipliers
            unbalanced = np.abs(forces - multipliers @ push).max() / self._model.tensegric.mean_stiffness
            whole = _apart(multipliers, sides) if self._together else multipliers
            if max(unbalanced, np.abs(amiss).max()) < _NEAR_ENOUGH:
                return equilibrium_at(potential, moved, unbalanced, whole, step)
            solve = self._model.layout.band.lu(self._derivative(potential, place, whole))
            if solve is None:
                return None
            solved = solve(np.column_stack([-forces, push.T]))
            free, along = solved[:, 0], solved[:, 1:]
            small = slopes @ along + soft
            multipliers = np.asarray(-np.linalg.lstsq(small, slopes @ free + held, rcond=1e-12)[0])
            shift = (free + along @ multipliers).reshape(-1, 3)
            longest = float(np.abs(shift).max())
            if not np.isfinite(longest):
                return None
            moved = moved + shift * (LONGEST_STEP / max(longest, LONGEST_STEP))
        return None

    def limit(self, potential: Potential, balance: Equilibrium) -> float:
        """Return the gain above which small errors flip and grow where ``equilibrium`` is (probe units [1]).

        Lines whose length is held also change their tension from turn to turn; that is in it. Whether turns
        swing without any volume force is told by ``overshoot``.
        """
        place = potential.at(balance.state.moved)
        matrix = 2.0 * self._turn(place) - self._derivative(potential, place, balance.multipliers)
        solve = self._model.layout.band.lu(matrix)
        sides = len(potential.groups)
        if solve is None:
            return 0.0
        a = potential.area * place.slopes[:sides]
        if not self._together:
            each_flipped = np.stack([self._with_held(potential, place, solve, each) for each in a], axis=1)
            return flip_limit(self._model, a.T, each_flipped)
        whole = a.sum(axis=0)
        flipped = self._with_held(potential, place, solve, whole)
        return max(self._model.probe / float(whole @ flipped), 0.0)

    def overshoot(self, potential: Potential, balance: Equilibrium) -> float:
        """Return how far one turn goes where it goes furthest, over the way to ``equilibrium`` [1].

        Beyond 2 that move flips and grows from turn to turn, whatever holds the volume. It can only where
        turns leave out the stiffness of the lines: it is the largest real part of an eigenvalue of M^-1 K.
        """
        place = potential.at(balance.state.moved)
        band = self._model.layout.band
        solve = band.lu(self._turn(place))
        assert solve is not None, "a triangle with a diagonal of stiffnesses has an answer"
        pull = band.product(self._derivative(potential, place, balance.multipliers))
        held = place.slopes[len(potential.groups) :]
        push = self._forces(place, len(potential.groups))[1][self._pressures(potential) :]
        weight = (1.0 - 0.5 * HELD_GROWTH) * self._model.tapes[potential.held_lines]

        def turned(moved: Floats) -> Floats:
            return solve(pull(moved) + push.T @ (weight * (held @ moved)))

        size = band.size
        loop = sparse_linalg.LinearOperator((size, size), matvec=turned, dtype=np.float64)
        begin = np.cos(np.arange(size))  # any start does that is not even on both sides
        found = sparse_linalg.eigs(loop, 1, which="LR", v0=begin, tol=1e-4, return_eigenvectors=False)
        return float(found[0].real)

    def _forces(self, place: Evaluation, sides: int) -> tuple[Floats, Floats]:
        """Return the forces to balance, (3 f,), and the directions of one pressure and the tensions."""
        forces, push = (place.gradient, place.slopes) if self._skin is None else self._skin.projected(place)
        return forces, self._rows(push, sides)

    def _rows(self, rows: Floats, sides: int) -> Floats:
        """Return ``rows`` with those of all zones summed, where iterations hold their sum."""
        if not self._together:
            return rows
        return np.concatenate([rows[:sides].sum(axis=0, keepdims=True), rows[sides:]])

    def _pressures(self, potential: Potential) -> int:
        return 1 if self._together else len(potential.groups)

    def _missing(self, potential: Potential, gain: float) -> Floats:
        """Return what is missing of what is held per multiplier of the conventional control, (h, h)."""
        first = self._pressures(potential)
        soft = np.zeros((first + len(potential.held_lines),) * 2)
        if self._together:
            soft[0, 0] = self._model.probe / (gain * potential.area**2)
        else:
            by_pressure = np.diag(self._model.give) + self._model.zone_responses / gain
            soft[:first, :first] = by_pressure / potential.area**2
        return soft

    def _derivative(self, potential: Potential, place: Evaluation, multipliers: Floats) -> Floats:
        if self._skin is not None:
            return self._skin.derivative(potential, place, multipliers)
        return potential.model.layout.band.spread(
            potential.hessian(place, multipliers, clip=False, curved=True)
        )

    def _turn(self, place: Evaluation) -> Floats:
        """Return M, the triangle that a turn solves with, as a general band."""
        if self._skin is None:
            stiffness = self._model.stiffness_at(place.moved)
            return self._lower if stiffness is self._model.stiffness else self._triangle(stiffness)
        n = self._skin.normals(place)[self._row]
        return np.asarray(self._lower + self._of_lines @ (n[:, :, None] * n[:, None, :]).ravel())

    def _triangle(self, stiffness: Operator) -> Floats:
        lower = _lower_entries(stiffness, self._model.tensegric)
        return np.asarray(self._model.layout.band.general(lower) @ np.ones(1))

    def _with_held(self, potential: Potential, place: Evaluation, solve: Solve, a: Floats) -> Floats:
        """Solve for ``a`` with what held lines add: each pulls by its excess, less what its tension learns.

        A tension that takes a share of the excess each turn, while that flips, is half a share behind it.
        """
        sides, held = len(potential.groups), potential.held_lines
        if not len(held):
            return solve(a)
        _, push = self._forces(place, sides)
        pulled = solve(np.column_stack([a, push[self._pressures(potential) :].T]))
        weight = (1.0 - 0.5 * HELD_GROWTH) * self._model.tapes[held]
        slopes = place.slopes[sides:] * weight[:, None]
        small = np.eye(len(held)) - slopes @ pulled[:, 1:]
        return np.asarray(pulled[:, 0] + pulled[:, 1:] @ np.linalg.solve(small, slopes @ pulled[:, 0]))


def _joint(multipliers: Floats, sides: int) -> Floats:
    return np.concatenate([[multipliers[:sides].mean()], multipliers[sides:]])


def _apart(multipliers: Floats, sides: int) -> Floats:
    return np.concatenate([np.full(sides, multipliers[0]), multipliers[1:]])


def _lower_entries(stiffness: Operator, tissue: TissueModel) -> Entries:
    """Return the entries of the lower triangle of a stiffness of the free points."""
    row, column, weight = sparse.find(lower_points(stiffness, len(tissue.free), tissue.relaxation))
    return Entries(
        row.astype(np.int64), column.astype(np.int64), np.zeros(len(row), dtype=np.int64), weight, 1
    )


def _double_lower_less_true(model: ConstrainedModel) -> tuple[sparse.csr_array, sparse.csr_array]:
    """Return 2 M - H at rest for the cables and for the lines, both of shape (3 f, 3 f)."""
    tensegric, segments = model.tensegric, model.segments
    rest = np.zeros((len(tensegric.free), 3))
    figures = tensegric.hessian_figures(rest, False)
    true = over_axes(tensegric.stiffness, len(rest))  # it is the true one where nothing else is
    if figures:
        true = weighted_sum(tensegric.hessian_entries, [np.ones(1), *figures], rest.size)
    line_true = _stiffness_at_rest(segments)
    points = len(tensegric.free)
    return (
        sparse.csr_array(2.0 * lower_points(tensegric.stiffness, points, tensegric.relaxation) - true),
        sparse.csr_array(2.0 * lower_points(model.line_bound, points, tensegric.relaxation) - line_true),
    )


def _solid_double_lower_less_true(model: ConstrainedModel, solid: CondensedTissue) -> Floats:
    """Return 2 M - H at rest on a solid, all of it full, (3 f, 3 f)."""
    true = solid.hessian(np.zeros_like(solid.load))
    lower = lower_points(model.stiffness, len(solid.free), solid.relaxation)
    return np.asarray(2.0 * lower - true - _stiffness_at_rest(model.segments))


def _stiffness_at_rest(segments: Springs) -> sparse.csr_array:
    """Return the stiffness of all segments at rest, where none is taut, shape (3 f, 3 f)."""
    return segments.stretched(segments.stiffness, np.zeros(len(segments.stiffness)))
