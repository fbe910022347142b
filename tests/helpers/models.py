"""Small models with chosen mechanics, and plain computations of what the core vectorises."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy import sparse
from shapes import central_difference, torso

from core.mechanics.constraint_lines import Line
from core.mechanics.iteration import LineTargets, SolverState, iterate
from core.mechanics.model import ConstrainedModel, constrained_model
from core.mechanics.newton import SlidingSurface
from core.mechanics.options import ModelOptions
from core.mechanics.potential import Potential

LAWS = (
    ModelOptions(),
    ModelOptions(member_law="prestressed", prestress=0.5),
    ModelOptions(member_law="co-rotated"),
)
"""The three member laws, all else as by default."""


def law_of(mechanics: ModelOptions) -> str:
    """The words that tell a choice of mechanics from the default one."""
    return "-".join(str(v) for v in vars(mechanics).values() if v not in vars(ModelOptions()).values()) or "A"


@cache
def small(mechanics: ModelOptions | None = None, *, worn: tuple[str, ...] | None = None) -> ConstrainedModel:
    """A skew torso of which two rows of seven points are free, with its mid-bust and full-bust lines."""
    control = torso(skew=0.3)
    few = (control.row >= 2) & (control.row <= 3) & (np.abs(control.column) <= 3)
    return constrained_model(replace(control, fixed=~few), worn=worn, mechanics=mechanics)


def cable_force(model: ConstrainedModel, points: np.ndarray) -> np.ndarray:
    """The force of the cables on all points, cable by cable, for the two laws that know no cells."""
    tensegric, mechanics = model.tensegric, model.options
    force = np.zeros_like(points)
    for (i, j), q in zip(tensegric.cables, tensegric.density, strict=True):
        span, rest = points[i] - points[j], tensegric.rest[i] - tensegric.rest[j]
        if mechanics.member_law == "force-density":
            pull = q * (span - rest)
        else:
            natural = (1.0 - mechanics.prestress) * np.linalg.norm(rest)
            here, there = np.linalg.norm(span), np.linalg.norm(rest)
            pull = q * ((here - natural) * span / here - (there - natural) * rest / there)
        force[i] -= pull
        force[j] += pull
    return force


def pairs_of(across: sparse.csr_array) -> list[tuple[int, int]]:
    """The first and the second point of each segment of lines through control points."""
    dense = across.toarray()
    assert set(np.unique(dense)) <= {-1.0, 0.0, 1.0}
    return [(int(np.argmax(row)), int(np.argmin(row))) for row in dense]


def path_of(line: Line) -> list[int]:
    """The control points that a line runs through."""
    return [int(np.argmax(row)) for row in line.weights.toarray()]


def line_force(model: ConstrainedModel, points: np.ndarray, ratios: tuple[float, ...]) -> np.ndarray:
    """The force of the worn lines on all points, segment by segment, after Hooke."""
    force = np.zeros_like(points)
    pairs = pairs_of(model.segments.across)
    for (i, j), k, line in zip(pairs, model.segments.stiffness, model.owner, strict=True):
        rest = np.linalg.norm(model.tensegric.rest[i] - model.tensegric.rest[j])
        span = points[i] - points[j]
        length = np.linalg.norm(span)
        pull = k * (length - ratios[line] * rest) * span / length
        force[i] -= pull
        force[j] += pull
    return force


def volume_slopes(model: ConstrainedModel, points: np.ndarray) -> np.ndarray:
    """The derivatives of the left and of the right volume at all points, triangle by triangle."""
    slopes = np.zeros((2, *points.shape))
    centred = points - model.volume.centre
    for corners, zone in zip(model.volume.faces, model.volume.zone, strict=True):
        for turn in range(3):
            i, j, k = np.roll(corners, turn)
            slopes[zone, i] += np.cross(centred[j], centred[k]) / 6.0
    return slopes


def energy_of(potential: Potential, moved: np.ndarray) -> float:
    """The energy for displacements of the free points."""
    return potential.energy(potential.at(moved))


def settled(
    model: ConstrainedModel, targets: LineTargets, turns: int = 4000, step: float = 1e-11
) -> SolverState:
    """Where turns come to rest; they must, in so many turns."""
    for state, measured in iterate(model, lambda: targets, turns=turns):
        if measured.step < step and abs(measured.error) < 1e-3:
            return state
    raise AssertionError(f"still moves by {measured.step:.1e} mm a turn")


def check_sliding_derivative(
    model: ConstrainedModel, ratios: tuple[float, ...], moved: np.ndarray
) -> np.ndarray:
    """Hold the derivative of the balance of sliding lines against central differences, and return it.

    Its error falls with the square of the step.
    """
    potential, skin = Potential(model, ratios), SlidingSurface(model)
    multipliers = np.array([*[3e4, 2e4][: len(potential.groups)], -40.0, -30.0])[: len(potential.wanted)]

    def balance(at: np.ndarray) -> np.ndarray:
        forces, push = skin.projected(potential.at(at))
        return forces - push.T @ multipliers

    solve = model.layout.band.lu(skin.derivative(potential, potential.at(moved), multipliers))
    exact = np.linalg.inv(solve(np.eye(moved.size)))

    def error(step: float) -> float:
        return float(np.abs(central_difference(balance, moved, step).reshape(exact.shape) - exact).max())

    assert error(0.4) / error(0.2) == pytest.approx(4.0, rel=0.15)
    assert error(1e-4) < 1e-5
    return np.asarray(exact)
