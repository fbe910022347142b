"""Tissue as a solid condensed to control points: what it answers to their displacements (ours).

It takes the place of the net of cables in a model: linear, in balance with its weight on the scan.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from scipy import sparse

from core.geometry.mesh import Floats, Indices, Points
from core.mechanics.banded_matrix import Entries
from core.mechanics.cup_parts import CupPart
from core.mechanics.options import ModelOptions

RELAXATION = 1.6
"""A solid's points go so far beyond their balance [1]: each depends on all others, so they would creep."""


@dataclass(frozen=True, eq=False)
class CondensedTissue:
    """Control points at rest on a condensed solid, and which of them are free to move.

    ``rest`` (n, 3) [mm]; ``free`` (f,) indices of the moving points, ascending; ``cables`` (m, 2) the edges
    whose strain is judged, with at least one free end, which carry nothing here; ``solid`` (3 f, 3 f) [N/mm]
    is the stiffness of the tissue and ``firmer`` its derivative by the logarithm of the shear modulus;
    ``load`` (f, 3) [N] is what a change of weight adds at the points, 0 on the scan. ``cups`` are the parts
    of cups that act on the points.
    """

    rest: Points
    free: Indices
    cables: Indices
    solid: Floats
    firmer: Floats
    load: Points
    mechanics: ModelOptions = field(default_factory=ModelOptions)
    cups: tuple[CupPart, ...] = ()

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

    @property
    def line_across(self) -> float:
        """Return 1: across a line an iteration takes it to be as stiff as along it [1]."""
        return 1.0

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

    @cached_property
    def stiffness(self) -> Floats:
        """Return the stiffness of tissue and cups in an iteration from rest, (3 f, 3 f) [N/mm]."""
        return self.stiffness_of(self.contacts(np.zeros_like(self.load)))

    def contacts(self, moved: Points) -> Points:
        """Return the direction out where points touch a cup that they may leave, else 0, (c, 3) [1]."""
        return np.concatenate([np.empty((0, 3)), *(cup.contacts(moved) for cup in self.cups)])

    def stiffness_of(self, contacts: Points) -> Floats:
        """Return the stiffness in an iteration with ``contacts`` (c, 3), (3 f, 3 f) [N/mm]."""
        # A point that a surface holds back goes to its balance there and not beyond.
        bounds = [RELAXATION * bound if touches else bound for touches, bound in self._bounds(contacts)]
        return self._with_cups(bounds)

    def contact_blocks(self, contacts: Points) -> Floats:
        """Return what ``contacts`` (c, 3) add to the points' own blocks in an iteration, (f, 3, 3) [N/mm]."""
        blocks = np.zeros((len(self.free), 3, 3))
        for cup, (touches, bound) in zip(self.cups, self._bounds(contacts), strict=True):
            if touches:
                at = cup.entries
                np.add.at(blocks, (at.row // 3, at.row % 3, at.column % 3), at.value * bound[at.source])
        return blocks

    def _bounds(self, contacts: Points) -> Iterator[tuple[bool, Floats]]:
        """Yield for each part whether it may touch, and its figures for an iteration."""
        done = 0
        for cup in self.cups:
            count = len(cup.contacts(np.zeros_like(self.load)))
            yield count > 0, cup.bound(contacts[done : done + count])
            done += count

    def hessian(self, moved: Points) -> Floats:
        """Return the second derivative of the energy as a full matrix, shape (3 f, 3 f) [N/mm]."""
        return self._with_cups(self.hessian_figures(moved, clip=False))

    def _with_cups(self, figures: Sequence[Floats]) -> Floats:
        whole = self.solid
        for cup, values in zip(self.cups, figures, strict=True):
            at = cup.entries
            added = sparse.coo_array((at.value * values[at.source], (at.row, at.column)), whole.shape)
            whole = whole + added.toarray()
        return whole

    def energy(self, moved: Points) -> float:
        """Return the energy for displacements of the free points, shape (f, 3) [mm]; 0 at rest [N mm]."""
        along = moved.ravel()
        tissue = 0.5 * float(along @ (self.solid @ along)) - float(np.sum(self.load * moved))
        return tissue + sum(cup.energy(moved) for cup in self.cups)

    def gradient(self, moved: Points) -> Points:
        """Return the derivative of the energy, shape (f, 3) [N]: minus the force of tissue and cups."""
        return sum((cup.gradient(moved) for cup in self.cups), self.resistance(moved) - self.load)

    def forces(self, moved: Points) -> Points:
        """Return the forces that an iteration answers to, (f, 3) [N]: those of cups are limited."""
        cups = sum((cup.limited_gradient(moved) for cup in self.cups), np.zeros_like(moved))
        return self.load - self.resistance(moved) - cups

    def resistance(self, moved: Points) -> Points:
        """Return the force with which the tissue alone resists displacements, both (f, 3) [N], [mm]."""
        return (self.solid @ moved.ravel()).reshape(-1, 3)

    @cached_property
    def hessian_entries(self) -> tuple[Entries, ...]:
        """Return the second derivative: that of the tissue, which is constant, and of the cups."""
        row, column = (at.ravel() for at in np.indices(self.solid.shape))
        source = np.zeros(row.size, dtype=np.int64)
        tissue = Entries(row, column, source, self.solid.ravel(), 1)
        return tissue, *(cup.entries for cup in self.cups)

    def hessian_figures(self, moved: Points, clip: bool) -> list[Floats]:
        """Return the figures of all but the constant part of the second derivative."""
        return [cup.figures(moved, clip) for cup in self.cups]

    def expand(self, moved: Points) -> Points:
        """Return all control points, shape (n, 3) [mm], the free ones displaced by ``moved`` (f, 3)."""
        points = self.rest.copy()
        points[self.free] += moved
        return points
