"""Robust least squares, and how sure its answer is although neighbours are off together (ours)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.mesh import Floats, Indices

PATCH = 25.0
"""Places in the same cube of this size may be off together [mm]."""

_HUBER = 2.0  # in standard deviations: what is further off counts by its distance, not by its square
_LEAST = 0.1  # as if no scanner were better than this [mm]


def spread_of(gaps: Floats) -> float:
    """Return the standard deviation of ``gaps`` (k,) [mm] after their median, at least a tenth of a mm."""
    return max(1.4826 * float(np.median(np.abs(gaps - np.median(gaps)))), _LEAST) if len(gaps) else _LEAST


def weights(gaps: Floats, spread: float) -> Floats:
    """Return Huber's weights of ``gaps`` (k,) that have a ``spread`` [mm], shape (k,) [1]."""
    return np.asarray(np.minimum(1.0, _HUBER * spread / np.maximum(np.abs(gaps), 1e-12)))


def cost(gaps: Floats, spread: float) -> float:
    """Return the mean of Huber's cost of ``gaps`` (k,) less what they have in common, as squares [mm^2]."""
    weight = weights(gaps, spread)
    gaps = gaps - float(weight @ gaps / max(weight.sum(), 1e-12))
    limit = _HUBER * spread
    far = np.abs(gaps) > limit
    each = np.where(far, 2.0 * limit * np.abs(gaps) - limit**2, gaps**2)
    return float(each.mean()) if len(each) else 0.0


@dataclass(frozen=True, eq=False)
class Normal:
    """The normal equations of gaps that go with p unknowns: ``matrix`` (p, p), ``slope`` (p,).

    ``meat`` (p, p) sums the squares of what each patch pulls with: so the spread is honest where neighbours
    are off together, be it by smoothed noise or since the model is no body.
    """

    matrix: Floats
    slope: Floats
    meat: Floats

    def step(self, damping: float = 0.0) -> Floats:
        """Return the step of Gauss and Newton, damped after Levenberg and Marquardt, shape (p,)."""
        damped = self.matrix + damping * np.diag(np.diag(self.matrix))
        return -np.asarray(np.linalg.lstsq(damped, self.slope, rcond=1e-14)[0])

    @property
    def covariance(self) -> Floats:
        """The covariance of the unknowns, shape (p, p)."""
        inverse = np.linalg.pinv(self.matrix, rcond=1e-14, hermitian=True)
        return np.asarray(inverse @ self.meat @ inverse)


def normal(gaps: Floats, slopes: Floats, spread: float, patches: Indices, *, offset: bool = False) -> Normal:
    """Return the normal equations of ``gaps`` (k,) with ``slopes`` (k, p); ``patches`` (k,) by number.

    With an ``offset`` all gaps may have one more in common, which is nobody's to tell: it is taken out.
    """
    weight = weights(gaps, spread)
    if offset and len(gaps):
        slopes = slopes - weight @ slopes / weight.sum()
        gaps = gaps - float(weight @ gaps / weight.sum())
    weighted = weight[:, None] * slopes
    pulls = weighted * gaps[:, None]
    by_patch = np.stack(
        [np.bincount(patches, column, int(patches.max(initial=-1)) + 1) for column in pulls.T], axis=1
    )
    return Normal(weighted.T @ slopes, pulls.sum(axis=0), np.asarray(by_patch.T @ by_patch, dtype=np.float64))
