"""The numbers of tissue and lines that predict a worn scan best, and how sure they are (ours).

Least squares after Gauss, Newton, Levenberg and Marquardt. How the skin moves with a number follows from the
solved system; no solve is made twice to take a difference. What the two scans cannot tell stays as it is.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from core.answer import NoBalanceError, answer_of
from core.design import Design
from core.design_calibration import Calibration, FoundNumber
from core.errors import LineError, UserError
from core.mesh import Floats, Indices, Points
from core.pipeline import Stages, build
from core.progress import Progress, quiet
from core.solving.newton import Balance
from core.solving.sensitivity import Answer
from core.worn_scan.comparing import Difference, Worn, compare, gaps_to
from core.worn_scan.gap import cells, known
from core.worn_scan.least_squares import PATCHES, Normal, cost, normal, spread_of
from core.worn_scan.numbers import STIFFNESS, Number, candidates, rates_by
from core.worn_scan.telling import NOISE, confused_with, least_sure, one_will_do, tellable, unsure_of

FEWEST = 200
"""Moving vertices that the worn scan must show for a fit."""

SURE = 2.0
"""A ± is so many standard deviations: 95 % of what chance makes [1]."""

_STEPS, _DONE, _TRIED = 25, 1e-4, 6
_FARTHEST = np.log(4.0)  # no stiffness changes more than this in one step


@dataclass(frozen=True, eq=False)
class Found:
    """What was found: ``design`` with its numbers and record, compared ``before`` and ``after``.

    ``points`` (n, 3) [mm] are the control points that it predicts. ``confused`` tells for numbers that stayed
    what they cannot be told from. ``singular`` are the singular values of the slopes in units of what counts
    as told: below about 1 a combination of numbers is not told. ``solves`` exact answers were needed.
    """

    design: Design
    points: Points
    before: Difference
    after: Difference
    confused: Mapping[str, str]
    singular: tuple[float, ...]
    solves: int

    @property
    def calibration(self) -> Calibration:
        """The record of it."""
        assert self.design.calibration is not None
        return self.design.calibration

    @property
    def helped(self) -> bool:
        """Whether a number moved by more than its ±, and prediction and scan came nearer to each other."""
        moved = any(
            abs(number.after - number.before) > number.plus_minus
            for number in self.calibration.numbers
            if not number.kept
        )
        return moved and self.after.all_of_it.rms < self.before.all_of_it.rms


@dataclass(frozen=True, eq=False)
class _Look:
    """An exact answer of a design, with its ``gaps`` (k,) [mm] and, if asked for, their ``slopes`` (k, p)."""

    stages: Stages
    answer: Answer
    gaps: Floats
    slopes: Floats

    @property
    def points(self) -> Points:
        return self.answer.place.points


class _Fit:
    """The fit of one design to a worn scan."""

    def __init__(self, stages: Stages, worn: Worn, thickness: float, progress: Progress) -> None:
        self.worn, self._thickness, self._progress = worn, thickness, progress
        self.start = stages
        rest = stages.moving.rest[: stages.moving.count]
        self.patches: list[Indices] = [cells(rest, size) for size in PATCHES]
        self.solves = 0

    def look(self, design: Design, numbers: tuple[Number, ...], near: _Look | None = None) -> _Look:
        """Return the exact answer of a design. Raises UserError if there is none, Cancelled."""
        self._progress("calibrating", min(self.solves / _STEPS, 0.95))
        self.solves += 1
        stages = build(design, near.stages if near else self.start)
        answer = exact_answer(stages, near.answer.balance if near else None)
        points = answer.place.points
        gaps = gaps_to(stages, points, self.worn.skin, self._thickness)
        return _Look(stages, answer, gaps, self._slopes(stages, answer, numbers))

    def _slopes(self, stages: Stages, answer: Answer, numbers: tuple[Number, ...]) -> Floats:
        points, binding, count = answer.place.points, stages.binding, stages.moving.count
        normals = stages.shape(points)[1][:count]
        slopes = np.zeros((count, len(numbers)))
        if not numbers:
            return slopes
        try:
            moved = rates_by(stages, answer, numbers)
        except ValueError as unbounded:
            raise LineError("The body moves without bound there.", "Set the lines longer.") from unbounded
        for column, free in enumerate(moved.T):
            way = np.zeros_like(points)
            way[stages.model.tensegric.free] = free.reshape(-1, 3)
            follow = binding.operator.added(binding.pushed(points, way), np.zeros((count, 3)))
            slopes[:, column] = np.einsum("ij,ij->i", follow, normals)
        return slopes

    def normal(self, look: _Look, spread: float | None = None) -> Normal:
        """Return the normal equations of a look."""
        seen = known(look.gaps)
        gaps, patches = look.gaps[seen], [patch[seen] for patch in self.patches]
        return normal(gaps, look.slopes[seen], spread or spread_of(gaps), patches, offset=True)

    def least(self, design: Design, numbers: tuple[Number, ...]) -> _Look:
        """Return where steps lead from ``design`` as long as they lessen the cost."""
        here = self.look(design, numbers)
        damping = 0.0
        for _ in range(_STEPS if numbers else 0):
            spread = spread_of(here.gaps[known(here.gaps)])
            taken, step = self._taken(here, numbers, damping, spread)
            if taken is None:
                break
            here, damping = taken, damping / 10.0
            if (np.abs(step) < _DONE).all():
                break
        return here

    def _taken(
        self, here: _Look, numbers: tuple[Number, ...], damping: float, spread: float
    ) -> tuple[_Look | None, Floats]:
        """Return the look after one step that lessens the cost, None if there is none, and the step."""
        equations = self.normal(here, spread)
        step = np.zeros(len(numbers))
        for _ in range(_TRIED):
            step = np.clip(equations.step(damping), -_FARTHEST, _FARTHEST)
            design = moved_by(here.stages.design, numbers, step)
            try:
                there = self.look(design, numbers, here)
            except UserError:
                there = None
            if there is not None:
                both = known(here.gaps) & known(there.gaps)
                if cost(there.gaps[both], spread) < cost(here.gaps[both], spread):
                    return there, step
            if (np.abs(step) < _DONE).all():
                break
            damping = max(10.0 * damping, 1e-3)
        return None, step


def moved_by(design: Design, numbers: tuple[Number, ...], step: Floats) -> Design:
    """Return the design with its numbers moved by a ``step`` (p,), as they are sought."""
    for number, change in zip(numbers, step.tolist(), strict=True):
        design = number.found(design, number.sought(design) + change)
    return design


def exact_answer(stages: Stages, near: Balance | None = None) -> Answer:
    """Return the exact answer of a design; if not from ``near`` by then from rest. Raises NoBalanceError."""
    try:
        return answer_of(stages, near=near)
    except NoBalanceError:
        if near is None:
            raise
        return answer_of(stages)


def refuse_bare(stages: Stages) -> None:
    """Raise UserError if no line that moves the body is worn."""
    if not len(stages.model.pulling):
        raise UserError("No line that moves the body is worn.", "Wear the lines of the garment first.")


def calibrate(
    stages: Stages,
    worn: Worn,
    *,
    thickness: float = 0.0,
    lengths: bool = False,
    progress: Progress = quiet,
) -> Found:
    """Find the numbers of a design at which it predicts a worn scan best.

    The cloth is taken to be ``thickness`` [mm] thick; ``lengths`` tells that lines may have been cut to other
    lengths than designed. Raises UserError if nothing is worn that moves the body, or too little is seen.
    """
    refuse_bare(stages)
    fit = _Fit(stages, worn, thickness, progress)
    first = fit.look(stages.design, ())
    if known(first.gaps).sum() < FEWEST:
        raise UserError(
            f"The worn scan shows {known(first.gaps).sum():.0f} places of the skin that moves; "
            f"{FEWEST} are needed.",
            "Scan the front of the body too.",
        )
    told, confused, singular = _tellable(fit, stages, lengths)
    here = fit.least(stages.design, told)
    if one_will_do(fit.normal(here), told, here.stages.design):
        told, confused = _judged(fit, stages.design, candidates(stages, lengths=lengths, each=False))
        here = fit.least(stages.design, told)
    told, here = _left(fit, told, here, confused)
    # What stays is the answer from rest, as everywhere.
    last = fit.look(here.stages.design, told)
    before = compare(stages, first.points, worn, thickness)
    after = compare(last.stages, last.points, worn, thickness)
    numbers = (*_found(fit.normal(last), told, stages.design, last.stages.design), *_stayed(stages, confused))
    record = Calibration(worn.name, before.all_of_it.rms, after.all_of_it.rms, numbers, thickness)
    design = replace(last.stages.design, calibration=record)
    return Found(design, last.points, before, after, confused, singular, fit.solves)


def _left(
    fit: _Fit, told: tuple[Number, ...], here: _Look, confused: dict[str, str]
) -> tuple[tuple[Number, ...], _Look]:
    """Return what is sure of the numbers that were found, and the look at which it alone was sought.

    The others go into ``confused``, with what they cannot be told from.
    """
    while told:
        equations = fit.normal(here)
        worst = least_sure(equations, [number.blind for number in told])
        if worst is None:
            break
        confused[told[worst].name] = confused_with(equations, told, worst)
        told = (*told[:worst], *told[worst + 1 :])
        here = fit.least(fit.start.design, told)
    return told, here


def _tellable(
    fit: _Fit, stages: Stages, lengths: bool
) -> tuple[tuple[Number, ...], dict[str, str], tuple[float, ...]]:
    """Return the numbers that a good scan could tell here, and what others cannot be told from.

    Lines that cannot be told from each other share one stiffness.
    """
    numbers = candidates(stages, lengths=lengths, each=True)
    told, confused = _judged(fit, stages.design, numbers)
    if any(number.kind == STIFFNESS and number.name in confused for number in numbers):
        numbers = candidates(stages, lengths=lengths, each=False)
        told, confused = _judged(fit, stages.design, numbers)
    slopes = fit.look(stages.design, numbers)
    seen = known(slopes.gaps)
    scaled = slopes.slopes[seen] * np.array([number.blind for number in numbers]) / NOISE
    return told, confused, tuple(np.linalg.svd(scaled, compute_uv=False).tolist())


def _judged(
    fit: _Fit, design: Design, numbers: tuple[Number, ...]
) -> tuple[tuple[Number, ...], dict[str, str]]:
    look = fit.look(design, numbers)
    return tellable(look.slopes[known(look.gaps)], numbers)


def _found(
    equations: Normal, told: tuple[Number, ...], before: Design, after: Design
) -> tuple[FoundNumber, ...]:
    unsure = SURE * unsure_of(equations)
    numbers = []
    for number, one in zip(told, unsure.tolist(), strict=True):
        value = number.of(after)
        plus_minus = value * one if number.logarithmic else one
        numbers.append(FoundNumber(number.name, number.of(before), value, plus_minus))
    return tuple(numbers)


def _stayed(stages: Stages, confused: Mapping[str, str]) -> tuple[FoundNumber, ...]:
    every = {
        number.name: number
        for each in (True, False)
        for number in candidates(stages, lengths=True, each=each)
    }
    kept = [(name, every[name].of(stages.design)) for name in confused]
    return tuple(FoundNumber(name, value, value, 0.0, kept=True) for name, value in kept)
