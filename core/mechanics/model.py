"""ConstrainedModel: a tensegric model with its constraining lines and its volume, ready to be solved."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from types import MappingProxyType
from typing import Any, cast

import numpy as np
from scipy import sparse
from scipy.sparse import linalg

from core.control_mesh.fit import ControlMesh
from core.geometry.mesh import Floats, Indices, Points, frozen
from core.mechanics.banded_matrix import Operator, compact, over_axes, weighted_sum
from core.mechanics.condensed_tissue import CondensedTissue
from core.mechanics.constraint_lines import Line, anchored_line, free_line, line_on
from core.mechanics.gauss_seidel import (
    ForwardOfBlocks,
    GaussSeidelSweep,
    block_sweep,
    bonded_sweep,
    forward_of_blocks,
    sliding_sweep,
)
from core.mechanics.hessian_layout import HessianLayout, layout_of
from core.mechanics.options import ModelOptions
from core.mechanics.springs import Springs, members
from core.mechanics.tensegrity import TissueModel, tensegrity_model
from core.mechanics.volume import Pressure, VolumeMeasure, volume_measure

_LEAST_KEPT = 1e-3
"""A share of displaced volume below this counts as this [1]."""

_TURNED = 0.02
"""An iteration answers anew to cups when a place where one presses has turned by this [1]."""


@dataclass(frozen=True, eq=False)
class ConstrainedModel:
    """A tensegric model with its constraining lines and its volume: all that stays fixed during a run.

    ``lines`` are all lines, worn or only measured. ``segments`` are those of the worn ones as springs, the
    same tape along a line; ``owner`` (s,) tells the line of each. ``beyond`` (s,) [mm] is the tape that
    slides over the shoulder from the segment on, as long as it is whatever the body does.
    """

    tensegric: TissueModel
    lines: tuple[Line, ...]
    volume: VolumeMeasure
    segments: Springs
    owner: Indices
    beyond: Floats

    @property
    def options(self) -> ModelOptions:
        """Return the choices that this model was built with."""
        return self.tensegric.mechanics

    @cached_property
    def stiffness(self) -> Operator:
        """Stiffness of tissue and implicit line segments between free points, (f, f) or (3 f, 3 f) [1]."""
        return self._with_lines(self.tensegric.stiffness)

    def stiffness_at(self, moved: Points) -> Operator:
        """Return the stiffness of an iteration from displacements (f, 3) [mm]: cups may touch elsewhere."""
        tissue = self.tensegric
        if not isinstance(tissue, CondensedTissue) or not tissue.cups:
            return self.stiffness
        return self._with_lines(tissue.stiffness_of(tissue.contacts(moved)))

    def _with_lines(self, own: Operator) -> Operator:
        lines, points = self.line_bound, len(self.tensegric.free)
        if own.shape == lines.shape == (points, points):
            return compact(sparse.csr_array(sparse.csr_array(own) + lines))
        if own.shape[0] == points:
            own = over_axes(own, points).toarray()
        return np.asarray(own + over_axes(lines, points))

    @cached_property
    def line_bound(self) -> sparse.csr_array:
        """Return what the segments of the lines add to the stiffness of an iteration, an upper bound [1].

        Shape (f, f), or (3 f, 3 f) where they are softer across: ``TissueModel.line_across``.
        """
        # A long tail makes a segment soft along it, but not across: the upper bound is that without a tail.
        bound = self.segments.stiffness * (self.tapes_at_rest / self.segments.rest_lengths)
        if self.options.line_force != "implicit":
            bound = np.zeros(len(self.owner))
        across = self.tensegric.line_across
        if across == 1.0:
            return self.segments.weighted(bound)
        return self.segments.stretched(bound, across * bound)

    @cached_property
    def sweep(self) -> GaussSeidelSweep:
        """Return how one iteration from rest answers the forces that it finds unbalanced."""
        if isinstance(self.tensegric, CondensedTissue) and self.tensegric.cups:
            return self.sweep_at(np.zeros_like(self.tensegric.load))
        if self.options.line_contact == "glued" or not len(self.owner):
            return bonded_sweep(self.stiffness, len(self.tensegric.free), self.tensegric.relaxation)
        return sliding_sweep(self.tensegric.stiffness, self.line_bound, self.segments.nodes)

    def sweep_at(self, moved: Points) -> GaussSeidelSweep:
        """Return how the iteration from displacements (f, 3) [mm] answers: it depends on what cups touch."""
        tissue = self.tensegric
        if not isinstance(tissue, CondensedTissue) or not tissue.cups:
            return self.sweep
        contacts = tissue.contacts(moved)
        known = self._last_sweep[0] if self._last_sweep else None
        if known is None or not _alike(known, contacts):
            self._last_sweep[:] = [contacts, block_sweep(self._untouched, tissue.contact_blocks(contacts))]
        return cast(GaussSeidelSweep, self._last_sweep[1])

    @cached_property
    def _untouched(self) -> ForwardOfBlocks:
        """The forward substitution of a solid that no cup touches."""
        tissue = self.tensegric
        assert isinstance(tissue, CondensedTissue)
        none = np.zeros_like(tissue.contacts(np.zeros_like(tissue.load)))
        stiffness = self._with_lines(tissue.stiffness_of(none))
        return forward_of_blocks(stiffness, len(tissue.free), tissue.relaxation)

    @cached_property
    def _last_sweep(self) -> list[Any]:
        return []

    @cached_property
    def rest_gradient(self) -> Points:
        """Return the direction of the volume force at rest, shape (f, 3) [mm^2]."""
        return self.volume.gradient(self.tensegric.rest)

    @cached_property
    def rest_zones(self) -> Floats:
        """Return the volumes of the zones at rest, shape (k,) [mm^3]."""
        return self.volume.zone_volumes(self.tensegric.rest)

    @cached_property
    def probe(self) -> float:
        """Volume change of one sweep per unit of pressure, dV/dP [mm^5], measured on a zero field (ours)."""
        a = self.rest_gradient
        return float(np.sum(a * self.sweep.solve(a, np.zeros_like(a), a)))

    @cached_property
    def layout(self) -> HessianLayout:
        """Return the layout of the second derivatives for the exact solution."""
        return layout_of(self.tensegric, self.segments, self.volume)

    def with_layout_of(self, other: ConstrainedModel) -> ConstrainedModel:
        """Return this model with the layout of ``other``, whose members join the same points.

        It does not depend on any stiffness, and takes longer than a balance.
        """
        self.__dict__["layout"] = other.layout  # what would be worked out when first asked for
        return self

    @property
    def pressure_unit(self) -> float:
        """Return the pressure that would change the whole volume by 100 % in one turn, linearised."""
        return self.volume.rest_volume / self.probe

    @cached_property
    def pressure_units(self) -> Floats:
        """Return what pressures change one zone alone by 100 % of the whole volume in one turn, (k, k).

        Each column is for a zone. The push of a zone moves the skin of its neighbours as well: without the
        figures beside the diagonal each zone would answer what its neighbours do; and what a zone takes up
        inside follows a pressure at once: one that keeps little would overshoot (ours).
        """
        return np.asarray(self.volume.rest_volume * np.linalg.inv(self.zone_responses))

    @cached_property
    def zone_probes(self) -> Floats:
        """Return the volume change of each zone in a sweep per pressure of each, (k, k) [mm^5]; see probe."""
        directions = self.volume.zone_gradients(self.tensegric.rest)
        still = np.zeros_like(directions[0])
        moves = np.stack([self.sweep.solve(each, still, self.rest_gradient) for each in directions])
        return np.tensordot(directions, moves, axes=((1, 2), (1, 2)))

    @cached_property
    def zone_responses(self) -> Floats:
        """Return how each zone departs from what it is to have in a turn per pressure, (k, k) [mm^5]."""
        return np.asarray(self.zone_probes + np.diag(self.give))

    def volume_force(self, pressure: float | Floats, gradients: Floats) -> Points:
        """Return the force of a pressure [probe units], (f, 3); ``gradients`` (k, f, 3) are the zones'."""
        if not self.volume.separate:
            return np.asarray((pressure * self.pressure_unit) * gradients.sum(axis=0))
        return np.tensordot(self.zone_pressures(pressure), gradients, axes=1)

    def zone_pressures(self, pressure: float | Floats) -> Floats:
        """Return the pressure of each zone, shape (k,), for one in probe units [1], or one of each zone."""
        if not self.volume.separate:
            return np.full(self.volume.zones, pressure * self.pressure_unit)
        return np.asarray(self.pressure_units @ np.broadcast_to(pressure, self.volume.zones))

    def pressure_like(self, other: ConstrainedModel, pressure: float | Floats) -> float | Floats:
        """Return a ``pressure`` of ``other`` in the probe units of this model, whose points are the same."""
        if not self.volume.separate:
            return pressure * other.pressure_unit / self.pressure_unit
        return np.asarray(np.linalg.solve(self.pressure_units, other.zone_pressures(pressure)))

    def state_pressure(self, pressures: Floats) -> Pressure:
        """Return the pressure of a state whose zones have ``pressures``, (k,), if they are held apart."""
        if not self.volume.separate:
            return Pressure()
        return Pressure(np.asarray(np.linalg.solve(self.pressure_units, pressures), dtype=np.float64))

    def zone_errors(self, points: Points, pressure: float | Floats) -> Floats:
        """Return what each zone has beyond what it is to have, in parts of the whole volume, shape (k,).

        It is to have what it has at rest, less what it takes up inside under a ``pressure`` [probe units].
        """
        wanted = self.rest_zones - self.give * self.zone_pressures(pressure)
        return np.asarray((self.volume.zone_volumes(points) - wanted) / self.volume.rest_volume)

    @cached_property
    def give(self) -> Floats:
        """Return how much volume each zone takes up inside per unit of pressure, shape (k,) [mm^5]; see kept.

        A zone that lines press by itself keeps its share ``VolumeMeasure.kept`` of what they displace, where
        displacements are small: what it takes up is in proportion to its pressure (ours).
        """
        kept = self.volume.kept
        if (kept >= 1.0).all():
            return np.zeros(len(kept))
        directions = self.volume.zone_gradients(self.tensegric.rest).reshape(len(kept), -1)
        figures = self.tensegric.hessian_figures(np.zeros((len(self.tensegric.free), 3)), False)
        entries = self.tensegric.hessian_entries
        tissue = weighted_sum(entries, [np.ones(1), *figures], directions.shape[1])
        answers = linalg.splu(sparse.csc_array(tissue)).solve(directions.T)
        by_pressure = np.einsum("ki,ik->k", directions, answers)
        return np.asarray((1.0 - kept) / np.maximum(kept, _LEAST_KEPT) * by_pressure)

    def natural_lengths(self, ratios: tuple[float, ...]) -> Floats:
        """Return the natural lengths of the worn segments for a ratio per line, shape (s,) [mm].

        Source: paper section 3. Where tape goes on beyond a segment, what that keeps of its length is taken
        off, so that length less natural length is what all of the tape is too long (ours).
        """
        return np.asarray(np.asarray(ratios)[self.owner] * self.tapes_at_rest - self.beyond)

    @cached_property
    def tapes_at_rest(self) -> Floats:
        """Return the rest lengths of the worn segments with what goes on beyond them, shape (s,) [mm]."""
        return self.segments.rest_lengths + self.beyond

    def sums(self, values: Floats) -> Floats:
        """Return the sums of values of the worn segments over each line, shape (lines,)."""
        return np.asarray(np.bincount(self.owner, values, len(self.lines)), dtype=np.float64)

    def line_lengths(self, points: Points) -> tuple[float, ...]:
        """Return the lengths of the front parts of all lines, worn or not [mm]; ``points`` (n, 3) [mm]."""
        across, still, owner, tails = self._all_segments
        spans = across @ points + still
        lengths = np.sqrt(np.einsum("ij,ij->i", spans, spans))
        return tuple((np.bincount(owner, lengths, len(self.lines)) + tails).tolist())

    @cached_property
    def _all_segments(self) -> tuple[sparse.csr_array, Points, Indices, Floats]:
        owner = np.repeat(np.arange(len(self.lines)), [len(line.rest_lengths) for line in self.lines])
        tails = np.array([line.tail_length for line in self.lines])
        return *_joined(self.lines, len(self.tensegric.rest)), owner, tails

    @cached_property
    def tapes(self) -> Floats:
        """Stiffness of each line as a whole, its segments in a row, shape (lines,) [1]; 0 if not worn."""
        give = self.sums(1.0 / self.segments.stiffness)
        return np.where(give > 0.0, 1.0 / np.where(give > 0.0, give, 1.0), 0.0)

    @cached_property
    def acting_lines(self) -> Indices:
        """Return the lines that act on a point which can move, ascending."""
        return np.unique(self.owner)


def constrained_model(
    control: ControlMesh,
    *,
    worn: Collection[str] | None = None,
    back_lengths: Mapping[str, float] | None = None,
    tail_lengths: Mapping[str, float] | None = None,
    mechanics: ModelOptions | None = None,
    own_stiffness: Mapping[str, float] | None = None,
    solid: CondensedTissue | None = None,
) -> ConstrainedModel:
    """Build the model of a control mesh with a line on each of its paths, on a net or a ``solid``.

    ``worn`` names the lines that act (all of them if None), the others are only measured; ``back_lengths``
    and ``tail_lengths`` [mm] see ``Line``, ``own_stiffness`` [1] see ``assemble``.
    """
    tensegric: TissueModel = solid or tensegrity_model(control.mesh, control.fixed, mechanics, control.depth)
    backs, tails, points = back_lengths or {}, tail_lengths or {}, control.mesh.vertices
    through = [
        line_on(name, path, points, tensegric.free, backs.get(name, 0.0))
        for name, path in control.paths.items()
    ]
    between = [
        free_line(name, embedded.weights, points, tensegric.free, embedded.steps)
        for name, embedded in control.embedded.items()
    ]
    lines = tuple(replace(line, tail_length=tails.get(line.name, 0.0)) for line in (*through, *between))
    if control.anchored is not None:
        lines = tuple(anchored_line(line, points, control.anchored, tensegric.free) for line in lines)
    worn = control.line_names if worn is None else worn
    return assemble(tensegric, lines, _volume(control, tensegric.free), worn, own_stiffness or {})


def _volume(control: ControlMesh, free: Indices) -> VolumeMeasure:
    """Return the volume of a control mesh in the zones of its template, else of the left and the right."""
    if control.zone is None:
        columns = control.column[control.mesh.faces].sum(axis=1)
        return volume_measure(control.mesh, free, np.where(columns > 0, 0, 1))
    kept = np.ones(len(control.zone_names)) if control.kept is None else control.kept
    return volume_measure(control.mesh, free, control.zone, tuple(kept), separate=True)


def assemble(
    tensegric: TissueModel,
    lines: tuple[Line, ...],
    volume: VolumeMeasure,
    worn: Collection[str],
    own_stiffness: Mapping[str, float] = MappingProxyType({}),
) -> ConstrainedModel:
    """Join the parts of a model.

    A line that is not worn, or lies on fixed points alone, is measured but does not pull. Its stiffness per
    mm is the same all along; a segment from control point to control point has the mechanics'
    ``line_stiffness`` on the mean, or that of ``own_stiffness`` [1] if it names the line (ours).
    """
    usual, unit = tensegric.mechanics.line_stiffness, tensegric.mean_stiffness
    pulling = [(index, line) for index, line in enumerate(lines) if line.constrains and line.name in worn]
    counts = [len(line.rest_lengths) for _, line in pulling]
    owner = np.repeat([i for i, _ in pulling], counts).astype(np.int64)
    none = np.empty(0)
    beyond = np.concatenate([none, *(_beyond(line) for _, line in pulling)])
    tapes = np.concatenate([none, *(line.rest_lengths for _, line in pulling)]) + beyond
    each = np.array([own_stiffness.get(line.name, usual) * unit * line.spacing for _, line in pulling])
    across, still = _joined([line for _, line in pulling], len(tensegric.rest))
    segments = members(tensegric.rest, tensegric.place, across, np.repeat(each, counts) / tapes, still)
    return ConstrainedModel(tensegric, lines, volume, segments, owner, frozen(beyond))


def _alike(known: Points, contacts: Points) -> bool:
    """Return whether the same places touch as when a sweep was made, and have hardly turned."""
    same = np.array_equal(known.any(axis=1), contacts.any(axis=1))
    return same and bool(np.abs(known - contacts).max(initial=0.0) <= _TURNED)


def _joined(lines: Sequence[Line], count: int) -> tuple[sparse.csr_array, Points]:
    """Return ``across`` (s, count) and ``still`` (s, 3) of all lines one after the other."""
    none = sparse.csr_array((0, count))
    across = sparse.csr_array(sparse.vstack([none, *(line.across for line in lines)], format="csr"))
    still = [np.broadcast_to(line.still, (len(line.rest_lengths), 3)) for line in lines]
    return across, np.concatenate([np.empty((0, 3)), *still])


def _beyond(line: Line) -> Floats:
    """Return what goes on beyond each segment of a line, (s,) [mm]: the tail beyond the last."""
    beyond = np.zeros(len(line.rest_lengths))
    beyond[-1] = line.tail_length
    return beyond
