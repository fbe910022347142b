"""The tolerance within which a garment serves a body, and deviations of measures in shares of it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from core.analysis.grading.size_groups import Measure, SizedBodies
from core.geometry.mesh import Flags, Floats, Indices

USUAL = 0.05
"""Share of a body's own measure by which that of a garment may differ: a choice.

It is between half a band step of 5 cm, 3.3 % of an under-bust of 75 cm, and half a cup step, which changes
the seams of a cup by 4 to 8 %.
"""

LEAST_MM = 3.0
"""No length has to agree better than this: seams are not sewn more exactly."""

AREA, LENGTH = "cm2", "mm"


@dataclass(frozen=True)
class ComparedBodies:
    """Bodies whose deciding measures are all known, and how much they may differ from a garment.

    ``shares`` (m,) are the tolerances of the measures as shares of the body's own value, NaN for a measure
    that does not decide. A length may always differ by LEAST_MM. An area counts as the side of the square of
    the same area, so that one share suits both. A measure that is known on no body is not compared.
    """

    bodies: SizedBodies
    shares: Floats

    @cached_property
    def columns(self) -> Flags:
        """Return which measures are compared, shape (m,)."""
        return np.asarray(np.isfinite(self.bodies.values).any(axis=0) & np.isfinite(self.shares))

    @cached_property
    def complete(self) -> Flags:
        """Return which bodies are compared: those with all these measures, shape (n,)."""
        if not self.columns.any():
            return np.zeros(self.bodies.count, dtype=bool)
        return np.asarray(np.isfinite(self.bodies.values[:, self.columns]).all(axis=1))

    @cached_property
    def measures(self) -> tuple[Measure, ...]:
        """Return the measures that are compared, k of them."""
        return tuple(each for each, used in zip(self.bodies.measures, self.columns, strict=True) if used)

    @cached_property
    def lengths(self) -> Floats:
        """Return the measures of the complete bodies as lengths, shape (c, k)."""
        return self.as_lengths(self.bodies.values[self.complete][:, self.columns])

    @cached_property
    def allowed(self) -> Floats:
        """Return the differences that are allowed to the complete bodies, shape (c, k)."""
        sewn = np.array([LEAST_MM if each.unit in (LENGTH, AREA) else 0.0 for each in self.measures])
        least = np.maximum(sewn, np.finfo(float).tiny)
        return np.asarray(np.maximum(self.shares[self.columns] * np.abs(self.lengths), least))

    def as_lengths(self, values: Floats) -> Floats:
        """Return values (..., k) as they are compared: areas [cm2] as lengths [mm], others unchanged."""
        areas = np.array([each.unit == AREA for each in self.measures], dtype=bool)
        return np.asarray(np.where(areas, 10.0 * np.sqrt(np.maximum(values, 0.0)), values))

    def excess(self, rows: Indices) -> Floats:
        """Return the largest deviation of garments made for bodies from these bodies, both in ``rows`` (r,).

        Shape (r, r), by garment and body, in shares of what is allowed: up to 1 a garment serves a body.
        """
        lengths, allowed = self.lengths[rows], self.allowed[rows]
        most = np.zeros((len(rows), len(rows)))
        for column in range(lengths.shape[1]):
            off = np.abs(lengths[:, column, None] - lengths[:, column]) / allowed[:, column]
            np.maximum(most, off, out=most)
        return most
