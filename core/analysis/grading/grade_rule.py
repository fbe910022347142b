"""Grade rules: one increment per band step and one per cup step for each measure, by least squares."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.special import fdtrc

from core.analysis.grading.increments import Interval, interval_of
from core.analysis.grading.size_groups import Measure, SizeCode, SizedBodies
from core.geometry.mesh import Floats, Indices

FULL_LEVERAGE = 1.0 - 1e-9
"""With a leverage above this a body alone decides a coefficient: it cannot be predicted without itself."""


@dataclass(frozen=True)
class StepIncrement:
    """An increment per step, its standard ``error`` and ``interval``; these are None without spare bodies."""

    value: float
    error: float | None
    interval: Interval | None


@dataclass(frozen=True)
class GradeRule:
    """The rule of a measure: ``at_base`` + band steps * ``per_band`` + cup steps * ``per_cup``.

    Steps are counted from the ``base`` size; ``count`` bodies decided the rule. An increment is None where
    the bodies do not vary in that part of the size, or where band and cup rise together. ``residual`` is the
    standard deviation of bodies from the rule, None without spare bodies; ``explained`` the share of the
    variance that the size explains (R squared), None if there is none. ``nonlinearity`` is the probability
    that sizes deviate from a straight rule by chance as much as these do (lack-of-fit test): below 0.05
    increments differ between sizes; None if it cannot be tested.
    """

    measure: Measure
    base: SizeCode
    at_base: float | None
    count: int
    per_band: StepIncrement | None
    per_cup: StepIncrement | None
    residual: float | None
    explained: float | None
    nonlinearity: float | None


class RuleFit:
    """Least squares of one measure (n,) on the sizes (n, 2) of the bodies for which it is known.

    Where band and cup cannot be separated, the smallest coefficients that fit are used.
    """

    def __init__(self, values: Floats, sizes: Indices, base: SizeCode) -> None:
        known = np.isfinite(values)
        self.values, self.sizes, self.base = values[known], sizes[known], base
        self._rows = np.where(known, np.cumsum(known) - 1, -1)
        design = self._design(self.sizes)
        self._inverse = np.linalg.pinv(design.T @ design, rcond=1e-12, hermitian=True)
        self.coefficients = self._inverse @ (design.T @ self.values)
        self.rank = int(np.linalg.matrix_rank(design)) if len(design) else 0
        self.residuals = self.values - design @ self.coefficients
        self._leverages = np.einsum("ij,jk,ik->i", design, self._inverse, design)

    def _design(self, sizes: Indices) -> Floats:
        steps = np.asarray(sizes, dtype=np.float64) - self.base
        return np.column_stack([np.ones(len(steps)), steps])

    @property
    def freedom(self) -> int:
        """Return the number of spare bodies: the degrees of freedom of the residual."""
        return len(self.values) - self.rank

    @cached_property
    def residual(self) -> float | None:
        """Return the standard deviation of bodies from the rule [unit of the measure]."""
        if self.freedom < 1:
            return None
        return float(np.sqrt(self.residuals @ self.residuals / self.freedom))

    def step(self, part: int) -> StepIncrement | None:
        """Return the increment per step of the band (0) or of the cup (1), None if it is not determined."""
        varying = [at for at in (0, 1) if len(self.sizes) and np.ptp(self.sizes[:, at]) > 0]
        if part not in varying or self.rank < 1 + len(varying):
            return None
        value = float(self.coefficients[1 + part])
        if self.residual is None:
            return StepIncrement(value, None, None)
        error = self.residual * float(self._inverse[1 + part, 1 + part]) ** 0.5
        return StepIncrement(value, error, interval_of(value, error, self.freedom))

    def explained(self) -> float | None:
        """Return the share of the variance that the size explains, None without variance."""
        total = float(np.sum((self.values - self.values.mean()) ** 2)) if len(self.values) else 0.0
        return 1.0 - float(self.residuals @ self.residuals) / total if total > 0.0 else None

    def nonlinearity(self) -> float | None:
        """Return the probability of the lack of fit of the straight rule to the means (F test)."""
        _, group = np.unique(self.sizes, axis=0, return_inverse=True)
        counts = np.bincount(group.ravel())
        means = np.bincount(group.ravel(), self.values) / np.maximum(counts, 1)
        inside = float(np.sum((self.values - means[group.ravel()]) ** 2))
        lacking, pure = len(counts) - self.rank, len(self.values) - len(counts)
        if lacking < 1 or pure < 1 or inside <= 0.0:
            return None
        between = max(float(self.residuals @ self.residuals) - inside, 0.0)
        return float(fdtrc(lacking, pure, (between / lacking) / (inside / pure)))

    def without_each(self, sizes: Indices, bodies: Indices) -> Floats:
        """Return the rule at ``sizes`` (k, 2), fitted without each of the ``bodies`` (b,): (b, k).

        A body whose value is not known decides nothing. NaN where a body alone decides a coefficient.
        Source: the update of least squares when one observation is removed.
        """
        at_sizes = self._design(sizes)
        predicted = np.tile(at_sizes @ self.coefficients, (len(bodies), 1))
        rows, known = self._rows[bodies], self._rows[bodies] >= 0
        rows = rows[known]
        alone = self._leverages[rows] > FULL_LEVERAGE
        shares = self.residuals[rows] / np.where(alone, 1.0, 1.0 - self._leverages[rows])
        changes = (self._design(self.sizes[rows]) @ self._inverse) * shares[:, None]
        changes[alone] = np.nan
        predicted[known] -= changes @ at_sizes.T
        return predicted


def base_size(bodies: SizedBodies) -> SizeCode:
    """Return the size with most bodies; of several the one nearest to the mean of all sizes."""
    centre = bodies.sizes.mean(axis=0)
    counts = np.bincount(bodies.group_of)
    ranked = [
        (-int(count), float(np.sum((np.array(code) - centre) ** 2)), code)
        for count, code in zip(counts, bodies.codes, strict=True)
    ]
    return min(ranked)[2]


def fits(bodies: SizedBodies) -> tuple[RuleFit, ...]:
    """Return the least-squares fit of each measure."""
    base = base_size(bodies)
    return tuple(RuleFit(column, bodies.sizes, base) for column in bodies.values.T)


def grade_rules(bodies: SizedBodies) -> tuple[GradeRule, ...]:
    """Return the rule of each measure."""
    return tuple(_rule(measure, fit) for measure, fit in zip(bodies.measures, fits(bodies), strict=True))


def _rule(measure: Measure, fit: RuleFit) -> GradeRule:
    return GradeRule(
        measure,
        fit.base,
        float(fit.coefficients[0]) if len(fit.values) else None,
        len(fit.values),
        fit.step(0),
        fit.step(1),
        fit.residual,
        fit.explained(),
        fit.nonlinearity() if len(fit.values) else None,
    )
