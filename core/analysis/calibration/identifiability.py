"""Identifiability of the calibrated parameters (ours)."""

from __future__ import annotations

import numpy as np

from core.analysis.calibration.parameters import Parameter
from core.analysis.calibration.robust_least_squares import NormalEquations
from core.geometry.mesh import Flags, Floats

NOISE = 1.0
"""Of a good scan, to judge beforehand what can be told [mm]."""

MOOT = 0.8
"""A number that is less sure than by this part of what is known before any scan stays as it is [1]."""

_ALIKE = 0.7  # correlation from which on two numbers count as not told apart


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
