"""Robust least squares, and how sure its answer is although neighbours are off together (ours)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.mesh import Floats, Indices

PATCHES = (25.0, 50.0)
"""Places in the same cube of one of these sizes may be off together [mm]."""

_HUBER = 2.0  # in standard deviations: what is further off counts by its distance, not by its square
_BLIND = 1e-9
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

    ``covariance`` (p, p) is that of the unknowns.
    """

    matrix: Floats
    slope: Floats
    covariance: Floats

    def step(self, damping: float = 0.0) -> Floats:
        """Return the step of Gauss and Newton, damped after Levenberg and Marquardt, shape (p,)."""
        damped = self.matrix + damping * np.diag(np.diag(self.matrix))
        return -np.asarray(np.linalg.lstsq(damped, self.slope, rcond=1e-14)[0])


def normal(
    gaps: Floats, slopes: Floats, spread: float, patches: Sequence[Indices] = (), *, offset: bool = False
) -> Normal:
    """Return the normal equations of ``gaps`` (k,) with ``slopes`` (k, p).

    Each of ``patches`` (k,) numbers places that may be off together: so the covariance is honest where
    neighbours are, be it by smoothed noise or since the model is no body. Of several divisions that which
    makes an unknown least sure counts: it tells how far errors reach. Without any all are off by themselves.
    With an ``offset`` all gaps may have one more in common, which is nobody's to tell: it is taken out.
    """
    weight = weights(gaps, spread)
    if offset and len(gaps):
        slopes = slopes - weight @ slopes / weight.sum()
        gaps = gaps - float(weight @ gaps / weight.sum())
    weighted = weight[:, None] * slopes
    pulls = weighted * gaps[:, None]
    matrix = np.asarray(weighted.T @ slopes)
    inverse = np.asarray(np.linalg.pinv(matrix, rcond=1e-14, hermitian=True), dtype=np.float64)
    every = [_left_out(weighted, slopes, pulls, inverse, patch) for patch in patches]
    return Normal(matrix, pulls.sum(axis=0), _widest(every) if every else np.asarray(spread**2 * inverse))


def _left_out(weighted: Floats, slopes: Floats, pulls: Floats, inverse: Floats, patch: Indices) -> Floats:
    """Return the covariance (p, p) that leaving out one patch after the other shows (jackknife)."""
    count, size = int(patch.max(initial=-1)) + 1, slopes.shape[1]
    if not count or not size:
        return np.zeros((size, size))
    own = np.zeros((count, size, size))
    np.add.at(own, patch, weighted[:, :, None] * slopes[:, None, :])
    pulled = np.zeros((count, size))
    np.add.at(pulled, patch, pulls)
    rest = np.eye(size) - own @ inverse  # what of the matrix is left without the patch
    steps = np.einsum("gpq,gq->gp", np.linalg.pinv(rest, rcond=_BLIND), pulled) @ inverse
    return np.asarray(steps.T @ steps * max(count - 1, 1) / count)


def _widest(every: Sequence[Floats]) -> Floats:
    """Return the first of some covariances (p, p), widened to the largest variance of each unknown."""
    sizes = np.sqrt(np.maximum([np.diag(each) for each in every], 1e-300))
    wider = sizes.max(axis=0) / sizes[0]
    return np.asarray(every[0] * np.outer(wider, wider))
