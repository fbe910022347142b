"""Sensitivity of the exact solution to the settings, by derivatives of the solved system (ours).

In a balance the forces and what is held vanish, whatever the lengths of the lines are. So a small change of a
length moves the points by what one linear system says: the matrix is that of Newton's last step, the right
side what the change by itself does to the forces. Nothing is tried and no difference is taken.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from core.geometry.mesh import Floats, Indices
from core.mechanics.banded_matrix import Solve
from core.mechanics.newton import Equilibrium, SlidingSurface, small_solve
from core.mechanics.potential import Evaluation, Potential


@dataclass(frozen=True, eq=False)
class Rates:
    """What one unit of each of p settings does to a balance.

    ``moved`` (3 f, p) are the displacements of the free points, ``multipliers`` (h, p) those of what is held.
    """

    moved: Floats
    multipliers: Floats

    def summed(self, groups: Sequence[Sequence[int]], unit: float) -> Rates:
        """Return the rates by settings that move in ``groups``, each by ``unit``."""
        parts = (self.moved, self.multipliers)
        return Rates(
            *(unit * np.stack([part[:, group].sum(axis=1) for group in groups], axis=1) for part in parts)
        )

    def of(self, slopes: Floats) -> Floats:
        """Return the rates of figures with these ``slopes`` (m, 3 f) by the displacements, shape (m, p)."""
        return np.asarray(slopes @ self.moved)


class Sensitivities:
    """An exact balance that can be asked what moves it. Raises ValueError where it moves without bound."""

    def __init__(self, potential: Potential, balance: Equilibrium) -> None:
        self.potential, self.balance = potential, balance
        self.place: Evaluation = potential.at(balance.state.moved)
        sliding = potential.model.options.line_contact == "sliding" and len(potential.model.owner) > 0
        self._skin = SlidingSurface(potential.model) if sliding else None

    def by_ratio(self, lines: Indices) -> Rates:
        """Return the rates by the natural lengths of ``lines`` (p,), over their lengths at rest [mm / 1]."""
        model, place = self.potential.model, self.place
        taut = self.potential.taut(place.lengths)
        pull = -self.potential.tape * taut * model.tapes_at_rest / place.lengths
        forces = self.by_line(pull, lines)
        held = np.zeros((len(self.potential.wanted), len(lines)))
        of_line = model.sums(model.tapes_at_rest)
        for row, line in enumerate(self.potential.held_lines, start=len(self.potential.groups)):
            held[row] = np.where(lines == line, -of_line[line], 0.0)
        return self._rates(forces, held)

    @cached_property
    def by_excess(self) -> Rates:
        """Return the rates by what the volume of each zone has beyond rest [mm / mm^3]."""
        zones = self.potential.model.volume.zones
        held = np.zeros((len(self.potential.wanted), zones))
        held[: len(self.potential.groups)] = -self.potential.groups / self.potential.area
        return self._rates(np.zeros((self.place.gradient.size, zones)), held)

    def tensions(self, rates: Rates, natural: Floats) -> tuple[Floats, Floats]:
        """Return the tension of each line, (lines,) [1 mm], and its rates by the settings, (lines, p).

        ``natural`` (lines, p) [mm] is what the settings do to the natural lengths.
        """
        potential, model = self.potential, self.potential.model
        if len(potential.held_lines):
            by_setting = np.zeros_like(natural)
            by_setting[potential.held_lines] = -rates.multipliers[len(potential.groups) :]
            return potential.tensions(self.balance.multipliers), by_setting
        slopes = self.stretch_slopes(range(len(model.lines)))
        share = self.taut_shares[:, None]
        return (
            model.tapes * model.sums(potential.stretch(self.place.lengths)),
            model.tapes[:, None] * (rates.of(slopes) - share * natural),
        )

    def stretch_slopes(self, lines: Sequence[int]) -> Floats:
        """Return the slopes of what ``lines`` are stretched by, by the free points, shape (p, 3 f) [1]."""
        model, lengths = self.potential.model, self.place.lengths
        along = (self.potential.taut(lengths) / lengths)[:, None] * self.place.spans
        owner = model.owner[:, None]
        each = [model.segments.sum(np.where(owner == line, along, 0.0)).ravel() for line in lines]
        return np.stack(each) if each else np.zeros((0, 3 * self._free))

    @cached_property
    def taut_shares(self) -> Floats:
        """Return the part of each line's tape that is not slack, shape (lines,) [1]."""
        model = self.potential.model
        whole = model.sums(model.tapes_at_rest)
        taut = model.sums(self.potential.taut(self.place.lengths) * model.tapes_at_rest)
        return np.where(whole > 0.0, taut / np.where(whole > 0.0, whole, 1.0), 1.0)

    def by_forces(self, forces: Floats) -> Rates:
        """Return the rates by p settings one unit of which adds ``forces`` (3 f, p) to the energy's slope."""
        return self._rates(forces, np.zeros((len(self.potential.wanted), forces.shape[1])))

    def by_line(self, pull: Floats, lines: Indices) -> Floats:
        """Return the forces of the segments' ``pull`` (s,) along them, each line by itself, (3 f, p)."""
        segments, owner = self.potential.model.segments, self.potential.model.owner
        each = [
            segments.sum(np.where(owner == line, pull, 0.0)[:, None] * self.place.spans) for line in lines
        ]
        across = (lambda force: force.ravel()) if self._skin is None else self._skin.across(self.place)
        return np.stack([across(force) for force in each], axis=1) if each else np.zeros((3 * self._free, 0))

    @property
    def _free(self) -> int:
        return len(self.place.moved)

    def _rates(self, forces: Floats, held: Floats) -> Rates:
        """Solve for what answers ``forces`` (3 f, p) and what is ``held`` (h, p) being off."""
        solve, along = self._system
        free = solve(-forces) if forces.shape[1] else forces
        small = self.potential.small_matrix(self.place.slopes, along)
        multipliers = np.stack(
            [-small_solve(small, column) for column in (self.place.slopes @ free + held).T],
            axis=1,
        )
        return Rates(free + along @ multipliers, multipliers)

    @cached_property
    def _system(self) -> tuple[Solve, Floats]:
        """A solver of the matrix of the balance, and what it makes of the directions of the multipliers."""
        layout, multipliers = self.potential.model.layout, self.balance.multipliers
        band, push = layout.band, self.place.slopes
        if self._skin is None:
            matrix = self.potential.hessian(self.place, multipliers, clip=False, curved=True)
            factor = band.cholesky(matrix) or band.lu(band.spread(matrix))
        else:
            _, push = self._skin.projected(self.place)
            factor = band.lu(self._skin.derivative(self.potential, self.place, multipliers))
        if factor is None:
            raise ValueError("the equilibrium is singular")

        def solve(right: Floats, factor: Solve = factor) -> Floats:
            # The trace of stiffness in the matrix does not matter to Newton's steps, but to the tenth digit.
            first = factor(right)
            return np.asarray(first + factor(layout.trace * first))

        return solve, solve(np.ascontiguousarray(push.T))
