"""Robust least squares, and how sure its answer is although neighbours are off together (ours)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.geometry.mesh import Flags, Floats, Indices

PATCHES = (25.0, 50.0)
"""Places in the same cube of one of these sizes may be off together [mm]."""

_HUBER = 2.0  # in standard deviations: what is further off counts by its distance, not by its square
_BLIND = 1e-9
_LEAST = 0.1  # as if no scanner were better than this [mm]


def robust_deviation(gaps: Floats) -> float:
    """Return the standard deviation of ``gaps`` (k,) [mm] after their median, at least a tenth of a mm."""
    return max(1.4826 * float(np.median(np.abs(gaps - np.median(gaps)))), _LEAST) if len(gaps) else _LEAST


def weights(gaps: Floats, spread: float) -> Floats:
    """Return Huber's weights of ``gaps`` (k,) that have a ``spread`` [mm], shape (k,) [1]."""
    return np.asarray(np.minimum(1.0, _HUBER * spread / np.maximum(np.abs(gaps), 1e-12)))


def cost(gaps: Floats, spread: float) -> float:
    """Return the sum of Huber's cost of ``gaps`` (k,), as squares [mm^2]."""
    limit = _HUBER * spread
    far = np.abs(gaps) > limit
    return float(np.where(far, 2.0 * limit * np.abs(gaps) - limit**2, gaps**2).sum())


@dataclass(frozen=True, eq=False)
class Prior:
    """What is known of p unknowns without any gap: ``precision`` (p, p), how far they are ``off`` (p,)."""

    precision: Floats
    off: Floats

    def cost(self, spread: float) -> float:
        """Return what it costs to be so far off, as squares of gaps with a ``spread`` [mm^2]."""
        return float(spread**2 * self.off @ self.precision @ self.off)


@dataclass(frozen=True, eq=False)
class NormalEquations:
    """The normal equations of gaps that go with p unknowns: ``matrix`` (p, p), ``slope`` (p,).

    ``covariance`` (p, p) is that of the unknowns.
    """

    matrix: Floats
    slope: Floats
    covariance: Floats

    def subset(self, some: Flags) -> NormalEquations:
        """Return the equations of ``some`` (p,) of the unknowns, the others held."""
        both = np.ix_(some, some)
        return NormalEquations(self.matrix[both], self.slope[some], self.covariance[both])

    def step(self, damping: float = 0.0) -> Floats:
        """Return the step of Gauss and Newton, damped after Levenberg and Marquardt, shape (p,)."""
        damped = self.matrix + damping * np.diag(np.diag(self.matrix))
        return -np.asarray(np.linalg.lstsq(damped, self.slope, rcond=1e-14)[0])


def normal_equations(
    gaps: Floats,
    slopes: Floats,
    spread: float,
    patches: Sequence[Indices] = (),
    known: Prior | None = None,
) -> NormalEquations:
    """Return the normal equations of ``gaps`` (k,) with ``slopes`` (k, p), and of what is ``known`` before.

    Each of ``patches`` (k,) numbers places that may be off together: so the covariance is honest where
    neighbours are, be it by smoothed noise or since the model is no body. Of several divisions that which
    makes an unknown least sure counts: it tells how far errors reach. At the least all are off by themselves.
    """
    weighted = weights(gaps, spread)[:, None] * slopes
    pulls = weighted * gaps[:, None]
    matrix, slope = np.asarray(weighted.T @ slopes), np.asarray(pulls.sum(axis=0))
    tied = np.zeros_like(matrix)
    if known is not None:
        tied = spread**2 * known.precision
        matrix, slope = matrix + tied, slope + tied @ known.off
    inverse = np.asarray(np.linalg.pinv(matrix, rcond=1e-14, hermitian=True), dtype=np.float64)
    # What is known beforehand is unsure as well: else an unknown that no gap tells would count as sure.
    before = spread**2 * inverse @ tied @ inverse
    every = [inverse @ pulls.T @ pulls @ inverse]
    every += [_left_out(weighted, slopes, pulls, inverse, patch) for patch in patches]
    return NormalEquations(matrix, slope, _widest(every) + before)


def _left_out(weighted: Floats, slopes: Floats, pulls: Floats, inverse: Floats, patch: Indices) -> Floats:
    """Return the covariance (p, p) that leaving out one patch after the other shows (jackknife)."""
    count, size = int(patch.max(initial=-1)) + 1, slopes.shape[1]
    if not count or not size:
        return np.zeros((size, size))
    rows = np.split(np.argsort(patch, kind="stable"), np.cumsum(np.bincount(patch))[:-1])
    own = np.array([weighted[each].T @ slopes[each] for each in rows])
    pulled = np.array([pulls[each].sum(axis=0) for each in rows])
    rest = np.eye(size) - own @ inverse  # what of the matrix is left without the patch
    steps = np.einsum("gpq,gq->gp", np.linalg.pinv(rest, rcond=_BLIND), pulled) @ inverse
    return np.asarray(steps.T @ steps * max(count - 1, 1) / count)


def _widest(every: Sequence[Floats]) -> Floats:
    """Return the first of some covariances (p, p), widened to the largest variance of each unknown."""
    sizes = np.sqrt(np.maximum([np.diag(each) for each in every], 1e-300))
    wider = sizes.max(axis=0) / sizes[0]
    return np.asarray(every[0] * np.outer(wider, wider))
