"""A prediction is laid on all points of a worn scan by its numbers: least squares by sensitivities (ours).

After Gauss, Newton, Levenberg and Marquardt, with Huber's weights. How the skin moves with a number follows
from the solved system; no solve is made twice to take a difference. Beside the numbers it is sought where
exactly the worn scan stands, as surely as its still skin tells that, and what all gaps have in common, as
cloth of another thickness would: both are nobody's to tell, and make the numbers as unsure as they are.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.analysis.calibration.parameters import Parameter, point_sensitivities, prior_precision
from core.analysis.calibration.residuals import FittingScan
from core.analysis.calibration.robust_least_squares import (
    PATCHES,
    NormalEquations,
    Prior,
    cost,
    normal_equations,
    robust_deviation,
)
from core.analysis.calibration.surface_distance import REACH, Surface, grid_cells, is_valid
from core.document.design import Design
from core.errors import LineError, UserError
from core.geometry.mesh import Flags, Floats, Points
from core.mechanics.newton import Equilibrium
from core.mechanics.sensitivity import Sensitivities
from core.messages import Message
from core.pipeline.build import Stages, build
from core.pipeline.solve import NoEquilibriumError, exact_solution
from core.pipeline.stages import RegionStages
from core.progress import Progress

BESIDE = 7
"""Unknowns beside the numbers: three turns [rad], three shifts and what all gaps have in common [mm]."""

MOST_POINTS = 150_000
"""Of more points near the moving skin each second, third and so on counts: as many as one every mm."""

_SUREST = (1e-5, 1e-3)  # a turn [rad] and a shift [mm] of an alignment that no noise makes unsure
_STEPS, _DONE, _TRIED = 25, 1e-4, 6
_FARTHEST = np.log(4.0)  # no stiffness changes more than this in one step


@dataclass(frozen=True, eq=False)
class FitState:
    """The exact ``answers`` of the regions of a design: ``gaps`` (n,) [mm] to the points, none elsewhere.

    ``beside`` (7,) are the unknowns beside the numbers, which the gaps hold already; ``slopes`` (n, p + 7).
    ``rest`` (n, 3) [mm] is where the skin under the points was at rest.
    """

    stages: Stages
    answers: tuple[Sensitivities, ...]
    rest: Points
    beside: Floats
    gaps: Floats
    slopes: Floats

    @property
    def points(self) -> Points:
        """Return the control points of all regions, (n, 3) [mm]."""
        return np.concatenate([answer.place.points for answer in self.answers])


class Fit:
    """The fit of one design to a worn scan; ``solves`` exact answers were made."""

    def __init__(
        self,
        stages: Stages,
        worn: FittingScan,
        thickness: float,
        numbers: tuple[Parameter, ...],
        progress: Progress,
    ) -> None:
        self.start, self.numbers, self.solves = stages, numbers, 0
        self.thickness, self._progress, self._laid = thickness, progress, worn.alignment
        moving = stages.skin.faces.rest
        low, high = moving.min(axis=0) - REACH, moving.max(axis=0) + REACH
        every = worn.skin.mesh.vertices
        near = np.flatnonzero(((every > low) & (every < high)).all(axis=1))
        near = near[:: -(-len(near) // MOST_POINTS) or 1]  # each, or each second, third ...
        self._points, self._facing, self._noise = (
            every[near],
            worn.skin.vertex_directions[near],
            worn.skin.noise,
        )
        self._sought = self._sought_by(stages.design)
        precision = np.zeros((len(numbers) + BESIDE, len(numbers) + BESIDE))
        precision[: len(numbers), : len(numbers)] = prior_precision(numbers)
        laid = worn.alignment.covariance + np.diag(np.repeat(_SUREST, 3) ** 2)
        precision[len(numbers) : -1, len(numbers) : -1] = np.linalg.inv(laid)
        self._precision = precision

    def evaluate(
        self, design: Design, near: FitState | None = None, beside: Floats | None = None
    ) -> FitState:
        """Return the exact answer of a design. Raises UserError if there is none, Cancelled."""
        self._progress("calibrating", min(self.solves / _STEPS, 0.95))
        self.solves += 1
        stages = build(design, near.stages if near else self.start)
        known = [answer.balance for answer in near.answers] if near else [None] * len(stages.regions)
        answers = tuple(map(solve_from, stages.regions, known))
        skin = stages.skin
        places, normals = skin.shape([answer.place.points for answer in answers])
        feet = Surface(places, normals, skin.faces.corners).project(self._points, self._facing, self._noise)
        moved = np.zeros((len(places), len(self.numbers)))
        for region, answer, rows in zip(stages.regions, answers, skin.rows, strict=True):
            own = rows[: region.moving.count]
            moved[own] += residual_jacobian(region, answer, self.numbers, normals[own])
        turned = np.cross(self._points[feet.rows] - self._laid.middle, feet.normals)
        common = np.ones((len(feet.rows), 1))
        slopes = np.zeros((len(self._points), len(self.numbers) + BESIDE))
        slopes[feet.rows] = np.concatenate([feet.interpolate(moved), -turned, -feet.normals, common], axis=1)
        beside = np.zeros(BESIDE) if beside is None else beside
        gaps = np.full(len(self._points), np.nan)
        gaps[feet.rows] = feet.gaps + self.thickness + slopes[feet.rows, len(self.numbers) :] @ beside
        rest = np.zeros_like(self._points)
        rest[feet.rows] = feet.interpolate(skin.faces.rest)
        return FitState(stages, answers, rest, beside, gaps, slopes)

    def normal_equations(self, look: FitState, spread: float | None = None) -> NormalEquations:
        """Return the normal equations of a look; with covariances if no ``spread`` [mm] is told."""
        seen = is_valid(look.gaps)
        gaps, slopes, before = look.gaps[seen], look.slopes[seen], self._beforehand(look)
        if spread is not None:
            return normal_equations(gaps, slopes, spread, known=before)
        # Patches by feet: noise would part points of one place, those outside from those inside.
        patches = [grid_cells(look.rest[seen], size) for size in PATCHES]
        return normal_equations(gaps, slopes, robust_deviation(gaps), patches, before)

    def minimize(self, design: Design, free: Flags) -> FitState:
        """Return where steps of the ``free`` (p,) numbers lead from ``design``, which lessen the cost."""
        here, damping = self.evaluate(design), 0.0
        open_ = np.concatenate([free, np.ones(BESIDE, dtype=bool)])
        for _ in range(_STEPS):
            spread = robust_deviation(here.gaps[is_valid(here.gaps)])
            taken, step = self._taken(here, open_, damping, spread)
            if taken is None:
                break
            here, damping = taken, damping / 10.0
            if (np.abs(step) < _DONE).all():
                break
        return here

    def _taken(
        self, here: FitState, open_: Flags, damping: float, spread: float
    ) -> tuple[FitState | None, Floats]:
        """Return the look after one step that lessens the cost, None if there is none, and the step."""
        equations = self.normal_equations(here, spread).subset(open_)
        count = len(self.numbers)
        step = np.zeros(count + BESIDE)
        for _ in range(_TRIED):
            step[open_] = equations.step(damping)
            step[:count] = np.clip(step[:count], -_FARTHEST, _FARTHEST)
            design = with_parameter_step(here.stages.design, self.numbers, step[:count])
            step[:count] = self._sought_by(design) - self._sought_by(here.stages.design)  # within what may be
            try:
                there = self.evaluate(design, here, here.beside + step[count:])
            except UserError:
                there = None
            if there is not None:
                both = is_valid(here.gaps) & is_valid(there.gaps)
                if self._cost(there, both, spread) < self._cost(here, both, spread):
                    return there, step
            if (np.abs(step) < _DONE).all():
                break
            damping = max(10.0 * damping, 1e-3)
        return None, step

    def _cost(self, look: FitState, seen: Flags, spread: float) -> float:
        return cost(look.gaps[seen], spread) + self._beforehand(look).cost(spread)

    def _beforehand(self, look: FitState) -> Prior:
        off = self._sought_by(look.stages.design) - self._sought
        return Prior(self._precision, np.concatenate([off, look.beside]))

    def _sought_by(self, design: Design) -> Floats:
        return np.array([number.to_unknown(design) for number in self.numbers])


def residual_jacobian(
    stages: RegionStages, answer: Sensitivities, numbers: tuple[Parameter, ...], normals: Points
) -> Floats:
    """Return how fast the moving vertices of a region rise along ``normals`` (k, 3) with ``numbers``, (k, p)
    [mm].

    Raises LineError where they do without bound.
    """
    points, binding, count = answer.place.points, stages.binding, stages.moving.count
    slopes = np.zeros((count, len(numbers)))
    if not numbers:
        return slopes
    try:
        moved = point_sensitivities(stages, answer, numbers)
    except ValueError as unbounded:
        raise LineError(
            Message("The equilibrium is not unique for these values."), Message("Make the lines longer.")
        ) from unbounded
    for column, free in enumerate(moved.T):
        way = np.zeros_like(points)
        way[stages.model.tensegric.free] = free.reshape(-1, 3)
        follow = binding.operator.apply(
            binding.changes.directional_derivative(points, way), np.zeros((count, 3))
        )
        slopes[:, column] = np.einsum("ij,ij->i", follow, normals)
    return slopes


def with_parameter_step(design: Design, numbers: tuple[Parameter, ...], step: Floats) -> Design:
    """Return the design with its numbers moved by a ``step`` (p,), as they are sought."""
    for number, change in zip(numbers, step.tolist(), strict=True):
        if change:
            design = number.from_unknown(design, number.to_unknown(design) + change)
    return design


def solve_from(stages: RegionStages, near: Equilibrium | None = None) -> Sensitivities:
    """Return the exact answer of a design; if not from ``near`` by then from rest. Raises
    NoEquilibriumError.
    """
    try:
        return exact_solution(stages, near=near)
    except NoEquilibriumError:
        if near is None:
            raise
        return exact_solution(stages)
