"""Tissue as a solid condensed to control points: what it answers to their displacements (ours).

It takes the place of the net of cables in a model: linear, in balance with its weight on the scan.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from core.geometry.mesh import Floats, Indices, Points
from core.mechanics.banded_matrix import Entries
from core.mechanics.options import ModelOptions

RELAXATION = 1.6
"""A solid's points go so far beyond their balance [1]: each depends on all others, so they would creep."""


@dataclass(frozen=True, eq=False)
class CondensedTissue:
    """Control points at rest on a condensed solid, and which of them are free to move.

    ``rest`` (n, 3) [mm]; ``free`` (f,) indices of the moving points, ascending; ``cables`` (m, 2) the edges
    of the control mesh with at least one free end, which carry nothing here; ``stiffness`` (3 f, 3 f) [N/mm]
    and its derivative ``firmer`` by the logarithm of the shear modulus; ``load`` (f, 3) [N] is what a change
    of weight adds at the points, 0 on the scan.
    """

    rest: Points
    free: Indices
    cables: Indices
    stiffness: Floats
    firmer: Floats
    load: Points
    mechanics: ModelOptions = field(default_factory=ModelOptions)

    @cached_property
    def place(self) -> Indices:
        """Return row of each control point among the free ones, shape (n,); -1 for a fixed point."""
        place = np.full(len(self.rest), -1, dtype=np.int64)
        place[self.free] = np.arange(len(self.free))
        return place

    @property
    def relaxation(self) -> float:
        """Return how far a point goes in an iteration, over the way to its balance [1]."""
        return RELAXATION

    def with_options(self, mechanics: ModelOptions) -> CondensedTissue:
        """Return the same tissue under other choices of how lines and volume act."""
        return replace(self, mechanics=mechanics)

    @cached_property
    def mean_stiffness(self) -> float:
        """Return the median over points and axes of the force that moves one alone by 1 mm [N/mm].

        Points that lie close together, as in a crease, are very stiff against each other: no mean. Stresses
        of weight do not count: the unit of line stiffness goes with the shear modulus.
        """
        return float(np.median(self.firmer.diagonal()))

    def energy(self, moved: Points) -> float:
        """Return the energy for displacements of the free points, shape (f, 3) [mm]; 0 at rest [N mm]."""
        along = moved.ravel()
        return 0.5 * float(along @ (self.stiffness @ along)) - float(np.sum(self.load * moved))

    def gradient(self, moved: Points) -> Points:
        """Return the derivative of the energy, shape (f, 3) [N]: minus the force of the tissue."""
        return (self.stiffness @ moved.ravel()).reshape(-1, 3) - self.load

    @cached_property
    def hessian_entries(self) -> tuple[Entries, ...]:
        """Return the second derivative, which is constant, as one figure that is 1."""
        row, column = (at.ravel() for at in np.indices(self.stiffness.shape))
        source = np.zeros(row.size, dtype=np.int64)
        return (Entries(row, column, source, self.stiffness.ravel(), 1),)

    def hessian_figures(self, moved: Points, clip: bool) -> list[Floats]:
        """Return the figures of all but the constant part of the second derivative: there are none."""
        return []

    def expand(self, moved: Points) -> Points:
        """Return all control points, shape (n, 3) [mm], the free ones displaced by ``moved`` (f, 3)."""
        points = self.rest.copy()
        points[self.free] += moved
        return points
