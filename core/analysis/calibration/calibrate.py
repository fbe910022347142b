"""Calibration: stiffness of tissue and lines that predicts a fitting scan best, with uncertainties (ours).

All that may be told is sought at once, each from what the design has, as far as such numbers differ at all.
What the two scans do not tell stays there, and what that leaves open is in the ± of the others.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from core.analysis.calibration.fit import Fit, FitState
from core.analysis.calibration.parameters import Parameter, candidate_parameters
from core.analysis.calibration.residuals import FittingScan, Residuals, compare
from core.analysis.calibration.robust_least_squares import NormalEquations
from core.analysis.calibration.surface_distance import is_valid
from core.document.calibration_record import Calibration, FittedParameter
from core.document.design import Design
from core.errors import UserError
from core.geometry.mesh import Flags, Floats, Points
from core.messages import Message
from core.pipeline.build import Stages
from core.progress import Progress, quiet

NOISE = 1.0
"""Of a good scan, to judge beforehand what can be told [mm]."""

MOOT = 0.8
"""A number that is less sure than by this part of what is known before any scan stays as it is [1]."""

_ALIKE = 0.7  # correlation from which on two numbers count as not told apart


FEWEST = 200
"""Points of the worn scan on the skin that moves that are needed for a fit."""

SURE = 2.0
"""A ± is so many standard deviations: 95 % of what chance makes [1]."""

MUCH_LEFT = 0.5
"""Where more than this of predicted less real remains something else made it: posture, breath, cloth [1]."""


def singular_values(slopes: Floats, numbers: tuple[Parameter, ...]) -> tuple[float, ...]:
    """Return those of ``slopes`` (k, p) [mm], the largest first, in units of what is known before."""
    if not numbers:
        return ()
    chosen = slopes - slopes.mean(axis=0)
    scaled = chosen * np.array([number.prior_deviation for number in numbers]) / NOISE
    return tuple(np.linalg.svd(scaled, compute_uv=False).tolist())


def standard_deviations(equations: NormalEquations) -> Floats:
    """Return the standard deviations of numbers as they are sought, (p,)."""
    return np.asarray(np.sqrt(np.maximum(np.diag(equations.covariance), 0.0)))


def unidentifiable(equations: NormalEquations, numbers: tuple[Parameter, ...]) -> Flags:
    """Return which of ``numbers`` (p,) the scans do not determine."""
    return standard_deviations(equations) > MOOT * np.array([number.prior_deviation for number in numbers])


def confounded_with(equations: NormalEquations, numbers: tuple[Parameter, ...], at: int) -> str:
    """Return the name of the number that one cannot be told from, empty if it does nothing by itself."""
    size = np.sqrt(np.maximum(np.diag(equations.covariance), 1e-300))
    alike = np.abs(equations.covariance[at]) / (size * size[at])
    alike[at] = 0.0
    other = int(alike.argmax())
    return numbers[other].name if alike[other] > _ALIKE else ""


@dataclass(frozen=True, eq=False)
class CalibrationResult:
    """What was found: ``design`` with its numbers and record, compared ``before`` and ``after``.

    ``points`` (n, 3) [mm] are the control points of all regions that it predicts; ``met`` points of the worn
    scan were on the moving skin. ``confounded`` tells for numbers that stayed what they cannot be told from.
    ``singular`` are the singular values of the slopes in units of what is known before: below 1 that tells
    more of a combination of numbers than the scans. ``solves`` exact answers were needed. ``at_end`` names
    numbers that went as far as they may: what the scan shows is not what these lines do. ``noise`` [mm] is
    the scan's.
    """

    design: Design
    points: Points
    before: Residuals
    after: Residuals
    confounded: Mapping[str, str]
    met: int
    singular: tuple[float, ...]
    solves: int
    at_end: tuple[str, ...] = ()
    noise: float = 0.0

    @property
    def calibration(self) -> Calibration:
        """Return the record of it."""
        assert self.design.calibration is not None
        return self.design.calibration

    @property
    def is_improved(self) -> bool:
        """Whether a number moved by more than its ±, none to its end, and the prediction came nearer."""
        moved = any(
            abs(number.after - number.before) > number.plus_minus
            for number in self.calibration.numbers
            if not number.kept
        )
        return moved and not self.at_end and self.after.total.rms < self.before.total.rms

    @property
    def is_poorly_determined(self) -> bool:
        """Return whether none of the numbers is told well."""
        return not any(number.is_well_determined for number in self.calibration.numbers)

    @property
    def has_large_residual(self) -> bool:
        """Return whether more than ``MUCH_LEFT`` of predicted less real remains, beyond the scan's noise."""
        before, after = (each.total.rms**2 - self.noise**2 for each in (self.before, self.after))
        return after > (MUCH_LEFT**2) * max(before, 0.0)


def require_active_line(stages: Stages) -> None:
    """Raise UserError if no line that moves the body is worn."""
    if not any(len(region.model.acting_lines) for region in stages.regions):
        raise UserError(
            Message("No active line moves the body."), Message("Activate the lines of the garment first.")
        )


def calibrate(
    stages: Stages,
    worn: FittingScan,
    *,
    thickness: float = 0.0,
    lengths: bool = False,
    one_roll: bool = False,
    progress: Progress = quiet,
) -> CalibrationResult:
    """Find the numbers of a design at which it predicts a worn scan best.

    The cloth is taken to be ``thickness`` [mm] thick; ``lengths`` tells that lines may have been cut to other
    lengths than designed, ``one_roll`` that those without a stiffness or an elastic of their own are of one
    roll, and share one stiffness. Raises UserError if nothing is worn that moves the body, or too little is
    seen.
    """
    require_active_line(stages)
    numbers = candidate_parameters(stages, lengths=lengths, each=not one_roll)
    fit = Fit(stages, worn, thickness, numbers, progress)
    first = fit.evaluate(stages.design)
    seen = is_valid(first.gaps)
    if seen.sum() < FEWEST:
        raise UserError(
            Message(
                "The fitting scan covers {count} points of the reshaped skin; {least} are required.",
                count=f"{seen.sum():.0f}",
                least=FEWEST,
            ),
            Message("Include the front of the body in the scan."),
        )
    here = fit.minimize(stages.design, np.ones(len(numbers), dtype=bool))
    stays = unidentifiable(_sure(fit, here), numbers)
    if stays.any():
        here = fit.minimize(stages.design, ~stays)
    # What stays is the answer from rest, as everywhere.
    last = fit.evaluate(here.stages.design, beside=here.beside)
    return _result(fit, first, last, stays.tolist(), worn)


def _result(
    fit: Fit, first: FitState, last: FitState, stays: list[bool], worn: FittingScan
) -> CalibrationResult:
    """Return what was found between the ``first`` look and the ``last``; ``stays`` tells what was not."""
    numbers, thickness = fit.numbers, fit.thickness
    sure, seen = _sure(fit, last), is_valid(first.gaps)
    before = compare(fit.start, first.points, worn, thickness)
    after = compare(last.stages, last.points, worn, thickness)
    found = tuple(_found(sure, numbers, stays, fit.start.design, last.stages.design))
    record = Calibration(worn.name, before.total.rms, after.total.rms, found, thickness)
    design = replace(last.stages.design, calibration=record)
    confused = {numbers[at].name: confounded_with(sure, numbers, at) for at in np.flatnonzero(stays).tolist()}
    singular = singular_values(first.slopes[seen, : len(numbers)], numbers)
    at_end = tuple(
        number.name
        for number, kept in zip(numbers, stays, strict=True)
        if not kept and number.is_at_limit(design)
    )
    return CalibrationResult(
        design,
        last.points,
        before,
        after,
        confused,
        int(seen.sum()),
        singular,
        fit.solves,
        at_end,
        worn.skin.noise,
    )


def _sure(fit: Fit, look: FitState) -> NormalEquations:
    """Return how sure the numbers are of which a fit is, those that stay among them."""
    equations = fit.normal_equations(look)
    count = len(fit.numbers)
    return equations.subset(np.arange(len(equations.slope)) < count)


def _found(
    sure: NormalEquations, numbers: tuple[Parameter, ...], stays: list[bool], before: Design, after: Design
) -> Iterator[FittedParameter]:
    """Yield the numbers as they were found, then those that stay."""
    unsure = (SURE * standard_deviations(sure)).tolist()
    for number, one, kept in zip(numbers, unsure, stays, strict=True):
        value = number.value_in(after)
        if not kept:
            plus_minus = value * one if number.logarithmic else one
            yield FittedParameter(number.name, number.value_in(before), value, plus_minus)
    for number, kept in zip(numbers, stays, strict=True):
        if kept:
            value = number.value_in(before)
            yield FittedParameter(number.name, value, value, 0.0, kept=True)
