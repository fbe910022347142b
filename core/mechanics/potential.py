"""The potential of a constrained model and what is held exactly, with all derivatives."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.geometry.mesh import Floats, Points
from core.mechanics.model import ConstrainedModel
from core.mechanics.springs import stretch_blocks


@dataclass(frozen=True, eq=False)
class Evaluation:
    """A model looked at in one place: all first-order figures of it.

    ``moved`` (f, 3) [mm]; ``inner`` and ``line`` (f, 3) the derivatives of the energy of body and lines;
    ``held`` (h,) what is held less what is wanted, [mm] and volumes over ``Potential.area``, whatever is
    taken up inside; ``slopes``
    (h, 3 f) their derivatives.
    """

    moved: Points
    points: Points
    spans: Points
    lengths: Floats
    inner: Points
    line: Points
    held: Floats
    slopes: Floats

    @property
    def gradient(self) -> Floats:
        """Return the derivative of the whole energy, shape (3 f,)."""
        return (self.inner + self.line).ravel()


class Potential:
    """Energy of body and lines for line ``ratios``, and the volumes and lengths that are held exactly.

    ``excess`` (k,) [mm^3] is what the zones are to have beyond rest (dense correction).
    """

    def __init__(
        self, model: ConstrainedModel, ratios: tuple[float, ...], excess: Floats | None = None
    ) -> None:
        self.model = model
        self.natural = model.natural_lengths(ratios)
        hold = model.options.line_hold == "held"
        self.one_sided = model.options.tissue == "solid"
        self.tape = np.zeros(len(self.natural)) if hold else model.segments.stiffness
        self.held_lines = model.acting_lines if hold else model.acting_lines[:0]
        zones = model.volume.zones
        together = model.volume.closed or model.options.volume_of == "both"
        self.groups = np.ones((1, zones)) if together else np.eye(zones)
        self.area = abs(model.volume.rest_volume) ** (2.0 / 3.0)
        volumes = model.rest_zones + (0.0 if excess is None else excess)
        self.wanted = np.concatenate(
            [self.groups @ volumes / self.area, model.sums(self.natural)[self.held_lines]]
        )
        self.tolerance = 1e-13 * np.concatenate(
            [np.full(len(self.groups), self.area**0.5), 10.0 * self.wanted[len(self.groups) :]]
        )

        self.soft = np.zeros(len(self.wanted))
        self.soft[: len(self.groups)] = self.groups @ model.give / self.area**2
        self.exact = self.soft == 0.0

    def energy(self, place: Evaluation) -> float:
        """Return the energy above that of the slack rest shape, with that of what zones take up inside."""
        longer = self.stretch(place.lengths)
        whole = self.model.tensegric.energy(place.moved) + 0.5 * float(self.tape @ (longer * longer))
        soft = ~self.exact
        return whole + 0.5 * float(np.sum(place.held[soft] ** 2 / self.soft[soft]))

    def slope(self, place: Evaluation, way: Floats) -> float:
        """Return the derivative of ``energy`` along a ``way`` (3 f,)."""
        soft = ~self.exact
        inside = (place.held[soft] / self.soft[soft]) @ (place.slopes[soft] @ way)
        return float(place.gradient @ way + inside)

    def amiss(self, place: Evaluation, multipliers: Floats) -> Floats:
        """Return how far all that is held is from what it is to be under its multipliers, shape (h,)."""
        return np.asarray(place.held + self.soft * multipliers)

    def small_matrix(self, slopes: Floats, push: Floats) -> Floats:
        """Return what multipliers that move the points by ``push`` (3 f, h) do to what is held, (h, h)."""
        matrix = slopes @ push
        return matrix if self.exact.all() else matrix + np.diag(self.soft)

    def stretch(self, lengths: Floats) -> Floats:
        """Return how much longer each segment is than by nature, (s,) [mm]; 0 of slack ones on a solid."""
        longer = lengths - self.natural
        return np.maximum(longer, 0.0) if self.one_sided else longer

    def _held(
        self, volumes: Floats, gradients: Floats, spans: Points, lengths: Floats
    ) -> tuple[Floats, Floats]:
        values, slopes = (
            self.groups @ volumes / self.area,
            self.groups @ gradients.reshape(len(gradients), -1) / self.area,
        )
        if len(self.held_lines):
            u = spans / lengths[:, None]
            each = [np.where(self.model.owner[:, None] == line, u, 0.0) for line in self.held_lines]
            values = np.concatenate([values, self.model.sums(lengths)[self.held_lines]])
            slopes = np.concatenate([slopes, *(self.model.segments.sum(u).reshape(1, -1) for u in each)])
        return values - self.wanted, slopes

    def at(self, moved: Points) -> Evaluation:
        """Return all first-order figures at displacements of the free points, shape (f, 3) [mm]."""
        spans, lengths = self.model.segments.spans(moved)
        force = self.pulls(lengths)[:, None] * spans
        points = self.model.tensegric.expand(moved)
        held, slopes = self._held(*self.model.volume.measure(points), spans, lengths)
        inner, line = self.model.tensegric.gradient(moved), self.model.segments.sum(force)
        return Evaluation(moved, points, spans, lengths, inner, line, held, slopes)

    def pulls(self, lengths: Floats) -> Floats:
        """Return tension over length of each segment, shape (s,) [1]; on a solid none pushes."""
        return np.asarray(self.tape * self.stretch(lengths) / lengths)

    def taut(self, lengths: Floats) -> Floats:
        """Return 1 for each segment that acts, 0 for slack tape on a solid, shape (s,)."""
        return np.where(lengths > self.natural, 1.0, 0.0) if self.one_sided else np.ones(len(lengths))

    def line_blocks(self, place: Evaluation, multipliers: Floats, clip: bool) -> Floats:
        """Return the second derivative of each line segment's energy and held length, shape (s, 3, 3)."""
        across = self.pulls(place.lengths)
        tensions = np.zeros(len(self.model.lines))
        tensions[self.held_lines] = -multipliers[len(self.groups) :]
        across = across + tensions[self.model.owner] / place.lengths
        if clip:
            across = np.maximum(across, 0.0)
        return stretch_blocks(
            place.spans / place.lengths[:, None], self.tape * self.taut(place.lengths), across
        )

    def residual_norm(self, place: Evaluation, multipliers: Floats) -> float:
        """Return the largest of the unbalanced forces over the mean stiffness and of what is held [mm]."""
        forces = np.abs(place.gradient - multipliers @ place.slopes).max(initial=0.0)
        away = np.abs(self.amiss(place, multipliers)).max(initial=0.0)
        return float(max(forces / self.model.tensegric.mean_stiffness, away))

    def residual(self, place: Evaluation, forces: Floats, multipliers: Floats) -> float:
        """Return the largest of the unbalanced ``forces`` (3 f,) over the mean stiffness [mm].

        It is infinite as long as anything that is held is not what it should be.
        """
        if (np.abs(self.amiss(place, multipliers)) > 1e3 * self.tolerance).any():
            return float("inf")
        return float(np.abs(forces).max(initial=0.0)) / self.model.tensegric.mean_stiffness

    def pressures(self, multipliers: Floats) -> Floats:
        """Return the pressures of the zones, shape (k,)."""
        return np.asarray(multipliers[: len(self.groups)] @ self.groups / self.area)

    def tensions(self, multipliers: Floats) -> Floats:
        """Return the tensions of the lines that are held, shape (lines,) [mm]; 0 for others."""
        tensions = np.zeros(len(self.model.lines))
        tensions[self.held_lines] = -multipliers[len(self.groups) :]
        return tensions

    def hessian(
        self, place: Evaluation, multipliers: Floats, *, clip: bool, curved: bool, lines: bool = True
    ) -> Floats:
        """Return the lower band of the second derivative of energy less multipliers times what is held.

        ``clip`` leaves out what compressed members take from it, ``curved`` = False the volume's share,
        ``lines`` = False that of the lines.
        """
        parts = self.model.tensegric.hessian_figures(place.moved, clip)
        blocks = self.line_blocks(place, multipliers, clip) if lines else np.zeros(9 * len(self.natural))
        centred = (place.points - self.model.volume.centre).ravel()
        layout = self.model.layout
        push = -self.pressures(multipliers) if curved else np.zeros(self.model.volume.zones)
        parts += [blocks.ravel(), *(each * centred for each in push)]
        return np.asarray(layout.constant + layout.changing @ np.concatenate(parts))
