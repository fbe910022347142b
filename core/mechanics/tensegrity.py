"""The tensegric model: cables along the control mesh, balanced at rest by prestressed parts.

The paper (section 2) gives no formula. Three laws of our own are exactly balanced at rest. "Force density":
a cable between points i and j pulls with ``q_ij * (x_i - x_j)``, and a constant pseudo-force at each point
balances all its cables at rest, so that what remains is ``q_ij`` times the change of ``x_i - x_j``.
"Prestressed": cables after Hooke, shorter by nature than at rest, and such pseudo-forces. "Co-rotated": see
``core.mechanics.corotated_cells``.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Protocol

import numpy as np
from scipy import sparse
from scipy.sparse import linalg as sparse_linalg

from core.geometry.mesh import Flags, Floats, Indices, Mesh, Points, frozen
from core.mechanics.banded_matrix import Entries, Operator, compact
from core.mechanics.corotated_cells import Cells, cells
from core.mechanics.options import ModelOptions
from core.mechanics.springs import Springs, laplacian, springs

TRUNK_RELAXATION, TRUNK_ACROSS = 1.2, 0.3
"""``relaxation`` and ``line_across`` of a trunk [1], where many closed lines cross many points; ours.

With 1 and 1 a girdle of eleven lines creeps by 0.6 % an iteration and is left before it has settled. Across,
a taut line is as stiff as its tension over its length, a fifth of its stiffness at 70 % of its length.
"""


class TissueModel(Protocol):
    """What a model asks of its tissue: ``TensegrityModel``, or a solid condensed to the control points."""

    @property
    def rest(self) -> Points:
        """Return the control points at rest, shape (n, 3) [mm]."""

    @property
    def free(self) -> Indices:
        """Return the indices of the points that can move, (f,), ascending."""

    @property
    def cables(self) -> Indices:
        """Return the edges of the control mesh that have at least one free end, (m, 2)."""

    @property
    def mechanics(self) -> ModelOptions:
        """Return the choices that it was built with."""

    @property
    def place(self) -> Indices:
        """Return row of each control point among the free ones, shape (n,); -1 for a fixed point."""

    @property
    def stiffness(self) -> Operator:
        """Return the stiffness of an iteration, (f, f) where it acts alike on each axis, or (3 f, 3 f)."""

    @property
    def mean_stiffness(self) -> float:
        """Return the mean stiffness at a point."""

    @property
    def relaxation(self) -> float:
        """Return how far a point goes in an iteration, over the way to its balance [1]."""

    @property
    def line_across(self) -> float:
        """Return how stiff an iteration takes a line to be across, over its stiffness along it [1]."""

    @property
    def hessian_entries(self) -> tuple[Entries, ...]:
        """Return the positions of the values of ``hessian_figures``: the constant part first."""

    def with_options(self, mechanics: ModelOptions) -> TissueModel:
        """Return the same tissue under other choices of how lines and volume act."""

    def energy(self, moved: Points) -> float:
        """Return the elastic energy for displacements of the free points, shape (f, 3) [mm]; 0 at rest."""

    def forces(self, moved: Points) -> Points:
        """Return the forces that an iteration answers to, shape (f, 3)."""

    def gradient(self, moved: Points) -> Points:
        """Return the derivative of the energy, shape (f, 3)."""

    def hessian_figures(self, moved: Points, clip: bool) -> list[Floats]:
        """Return the figures of all but the constant part of the second derivative, in order."""

    def expand(self, moved: Points) -> Points:
        """Return all control points, shape (n, 3) [mm], the free ones displaced by ``moved`` (f, 3)."""


@dataclass(frozen=True, eq=False)
class TensegrityModel:
    """Control points at rest, their cables, and which of them are free to move.

    ``rest`` (n, 3) [mm]; ``free`` (f,) indices of the moving points, ascending; ``cables`` (m, 2) the pairs
    that have at least one free end; ``density`` (m,) [1] their force densities, 1/length over the mean of
    1/length; ``ground`` (f,) [1] the stiffness that ties each free point to its rest. ``fixed_edges`` and
    ``held_density`` are the edges between fixed points, which matter to co-rotated cells alone. ``depth``
    (n,) [mm] is that of the tissue, where a template tells it.
    """

    rest: Points
    free: Indices
    cables: Indices
    density: Floats
    mechanics: ModelOptions = field(default_factory=ModelOptions)
    ground: Floats | None = None
    fixed_edges: Indices = field(default_factory=lambda: np.empty((0, 2), dtype=np.int64))
    held_density: Floats = field(default_factory=lambda: np.empty(0))
    depth: Floats | None = None

    @cached_property
    def place(self) -> Indices:
        """Return row of each control point among the free ones, shape (n,); -1 for a fixed point."""
        place = np.full(len(self.rest), -1, dtype=np.int64)
        place[self.free] = np.arange(len(self.free))
        return place

    @cached_property
    def stiffness(self) -> Operator:
        """The stiffness that a turn solves for, shape (f, f) [1]: Laplacian of the force densities, ground.

        For the laws that are not linear it is an upper bound of the true stiffness.
        """
        ground = np.zeros(len(self.free)) if self.ground is None else self.ground
        return compact(sparse.csr_array(self._cable_laplacian + sparse.diags_array(ground)))

    @cached_property
    def _cable_laplacian(self) -> sparse.csr_array:
        return laplacian(self.place, self.cables, self.density)

    @cached_property
    def mean_stiffness(self) -> float:
        """Return the mean over the free points of the sum of their force densities [1]."""
        return float(self._cable_laplacian.diagonal().mean())

    @cached_property
    def _linear(self) -> Operator:
        """Return what is linear in the displacements: cables under the force density law, and the ground."""
        if self.mechanics.member_law == "force-density":
            return self.stiffness
        ground = np.zeros(len(self.free)) if self.ground is None else self.ground
        return compact(sparse.csr_array(sparse.diags_array(ground)))

    @property
    def relaxation(self) -> float:
        """Return 1: a point goes to its balance (paper section 5); a bit further on a trunk (ours)."""
        return TRUNK_RELAXATION if self._is_bonded_trunk else 1.0

    @property
    def line_across(self) -> float:
        """Return 1, a plain upper bound, but ``TRUNK_ACROSS`` on a trunk."""
        return TRUNK_ACROSS if self._is_bonded_trunk else 1.0

    @property
    def _is_bonded_trunk(self) -> bool:
        """Whether a template tells the depth of tissue, as that of the trunk does, and lines are bonded."""
        return self.depth is not None and self.mechanics.line_contact == "glued"

    def with_options(self, mechanics: ModelOptions) -> TensegrityModel:
        """Return the same net under other choices of how lines and volume act."""
        return replace(self, mechanics=mechanics)

    @property
    def cable_springs(self) -> Springs | None:
        """Return the cables as springs under the prestressed law, None under the others."""
        return self._springs

    @cached_property
    def _springs(self) -> Springs | None:
        if self.mechanics.member_law != "prestressed":
            return None
        return springs(self.rest, self.place, self.cables, self.density)

    @cached_property
    def _cells(self) -> Cells | None:
        if self.mechanics.member_law != "co-rotated":
            return None
        edges = np.concatenate([self.cables, self.fixed_edges])
        return cells(self.rest, edges, np.concatenate([self.density, self.held_density]), self.place)

    @cached_property
    def _natural(self) -> Floats:
        assert self._springs is not None
        return (1.0 - self.mechanics.prestress) * self._springs.rest_lengths

    @cached_property
    def _pseudo_force(self) -> Points:
        """The constant force that balances prestressed cables at rest, shape (f, 3), to the last bit."""
        assert self._springs is not None
        spans, lengths = self._springs.spans(np.zeros((len(self.free), 3)))
        return self._springs.gradient(spans, lengths, self._natural)

    def energy(self, moved: Points) -> float:
        """Return the elastic energy for displacements of the free points, shape (f, 3) [mm]; 0 at rest."""
        energy = 0.5 * float(np.sum(moved * (self._linear @ moved)))
        if self._springs is not None:
            _, lengths = self._springs.spans(moved)
            rest = self._springs.energy(self._springs.rest_lengths, self._natural)
            energy += self._springs.energy(lengths, self._natural) - rest
            energy -= float(np.sum(self._pseudo_force * moved))
        if self._cells is not None:
            spans = self._cells.spans(self.expand(moved))
            energy += self._cells.energy(spans, self._cells.rotations(spans))
        return energy

    def forces(self, moved: Points) -> Points:
        """Return the forces that an iteration answers to, shape (f, 3)."""
        return -self.gradient(moved)

    def gradient(self, moved: Points) -> Points:
        """Return the derivative of the energy, shape (f, 3): minus the force of all cables at each point."""
        gradient = self._linear @ moved
        if self._springs is not None:
            gradient += (
                self._springs.gradient(*self._springs.spans(moved), self._natural) - self._pseudo_force
            )
        if self._cells is not None:
            spans = self._cells.spans(self.expand(moved))
            gradient += self._cells.gradient(spans, self._cells.rotations(spans))
        return np.asarray(gradient)

    @cached_property
    def hessian_entries(self) -> tuple[Entries, ...]:
        """Return the positions of the values of ``hessian_figures``: the constant part first."""
        constant = self.stiffness if self._springs is None else self._linear
        parts = [_isotropic(sparse.coo_array(constant))]
        if self._springs is not None:
            parts.append(self._springs.entries)
        if self._cells is not None:
            parts.append(self._cells.entries())
        return tuple(parts)

    def hessian_figures(self, moved: Points, clip: bool) -> list[Floats]:
        """Return the figures of all but the constant part of the second derivative, in order.

        ``clip`` leaves out what may make it indefinite.
        """
        if self._springs is not None:
            return [self._springs.blocks(*self._springs.spans(moved), self._natural, clip).ravel()]
        if self._cells is not None:
            spans = self._cells.spans(self.expand(moved))
            turning = self._cells.rotation_blocks(spans, self._cells.rotations(spans)).ravel()
            return [np.zeros_like(turning) if clip else turning]
        return []

    def expand(self, moved: Points) -> Points:
        """Return all control points, shape (n, 3) [mm], the free ones displaced by ``moved`` (f, 3)."""
        points = self.rest.copy()
        points[self.free] = self._rest_free + moved
        return points

    @cached_property
    def _rest_free(self) -> Points:
        return self.rest[self.free]


def _isotropic(matrix: sparse.coo_array) -> Entries:
    """Return the entries of ``matrix`` (f, f) for each of the three axes, as one figure that is 1."""
    axis = np.arange(3)
    row, column = (3 * np.asarray(at)[:, None] + axis for at in (matrix.row, matrix.col))
    value = np.repeat(matrix.data, 3)
    return Entries(row.ravel(), column.ravel(), np.zeros(value.size, dtype=np.int64), value, 1)


def tensegrity_model(
    mesh: Mesh, fixed: Flags, mechanics: ModelOptions | None = None, depth: Floats | None = None
) -> TensegrityModel:
    """Build the model on a control mesh; ``fixed``, shape (n,), marks what stays (paper section 4).

    ``depth`` (n,) [mm] is that of the tissue, if it is known.
    """
    mechanics = mechanics or ModelOptions()
    lengths = np.linalg.norm(mesh.vertices[mesh.edges[:, 0]] - mesh.vertices[mesh.edges[:, 1]], axis=1)
    density = (1.0 / lengths) / np.mean(1.0 / lengths)
    still = fixed[mesh.edges[:, 0]] & fixed[mesh.edges[:, 1]]
    free = np.flatnonzero(~fixed)
    model = TensegrityModel(
        mesh.vertices,
        free,
        mesh.edges[~still],
        frozen(density[~still]),
        mechanics,
        fixed_edges=mesh.edges[still],
        held_density=frozen(density[still]),
        depth=depth,
    )
    return _grounded(model, mesh) if mechanics.firm_chest else model


SOFT_DEPTH, SKIN_DEPTH = 40.0, 4.0
"""Tissue as deep as the first is tied to its rest with ``firm_chest``, thinner tissue much more [mm]."""


def _grounded(model: TensegrityModel, mesh: Mesh) -> TensegrityModel:
    """Tie each free point to its rest, the more the thinner the tissue under it (firm chest; ours)."""
    return replace(model, ground=frozen(model.mechanics.firm_chest * firm_ground(model, mesh)))


def firm_ground(model: TensegrityModel, mesh: Mesh) -> Floats:
    """Return what ties each free point to its rest where ``firm_chest`` is 1, shape (f,) [1]."""
    depth = tissue_depth(model, mesh)
    return np.asarray(model.mean_stiffness * (SOFT_DEPTH / (depth + SKIN_DEPTH)) ** 2)


def tissue_depth(model: TensegrityModel, mesh: Mesh) -> Floats:
    """Return how deep the tissue is at each free point, shape (f,) [mm].

    Where no template tells it, that is how far a point stands before a soap film over the fixed points,
    which stands for the chest wall: an estimate, no measurement (ours).
    """
    if model.depth is not None:
        return model.depth[model.free]
    spans = springs(model.rest, model.place, model.cables, model.density)
    pulled = spans.sum(model.density[:, None] * spans.rest_spans)
    to_film = sparse_linalg.spsolve(sparse.csc_array(model._cable_laplacian), pulled)
    normals = mesh.vertex_normals[model.free]
    return np.asarray(np.abs(np.einsum("ij,ij->i", np.reshape(to_film, (-1, 3)), normals)))
