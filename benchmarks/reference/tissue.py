"""Balance of nearly incompressible neo-Hookean tissue under its weight, and its exact derivatives.

Energy per volume of the unloaded shape: mu/2 (tr F^T F - 3) - mu ln det F + p (det F - 1) - p^2 / (2 kappa)
with F = dx/dX. The same equations are solved for the loaded shape x or for the unloaded shape X, so that both
problems have the same solutions. Source of the inverse problem: Govindjee and Mihalic (1996).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse

from core.geometry.mesh import Flags, Floats, Indices, Points
from reference.elements import EDGES, TetMesh, quadratic, quadratic_slopes, quadrature

DENSITY = 0.95e-6
"""Density of tissue [kg/mm^3]."""

GRAVITY = 9.81
"""Standard acceleration [m/s^2]."""

BULK = 500.0
"""Bulk modulus in parts of the shear modulus [1]."""


@dataclass(frozen=True, eq=False)
class Kinematics:
    """Values at the quadrature points: F (t, q, 3, 3), its determinant (t, q), gradients (t, q, 3, 10)."""

    gradient: Floats  # F [1]
    stretch: Floats  # det F [1]
    volume: Floats  # weight times det dX/dxi, (t, q) [mm^3]
    original: Floats  # gradients of shape functions in X [1/mm]
    current: Floats  # the same in x [1/mm]


@dataclass(frozen=True, eq=False)
class Tissue:
    """Tissue whose balance under weight is the shape ``mesh``; ``fixed`` (n,) nodes do not move.

    ``shear`` is the shear modulus [N/mm^2]. Unknowns are the three coordinates of free nodes and the pressure
    [N/mm^2] of all corners, scaled by the shear modulus.
    """

    mesh: TetMesh
    fixed: Flags
    shear: float

    @cached_property
    def _rule(self) -> tuple[Floats, Floats, Floats, Floats]:
        places, weights = quadrature()
        return weights, quadratic(places, EDGES), quadratic_slopes(places), places

    @cached_property
    def free(self) -> Indices:
        """Return the rows of all equations (3 n + c,) that are not those of fixed nodes."""
        movable = np.repeat(~self.fixed, 3)
        return np.flatnonzero(np.concatenate([movable, np.ones(self.mesh.corner_count, dtype=bool)]))

    @cached_property
    def weight(self) -> Floats:
        """Return the weight of each node under 1 g, shape (n,) [N]: mass is that of the shape ``mesh``."""
        weights, shape, slopes, _ = self._rule
        jacobian = np.einsum("tai,qxa->tqix", self.mesh.nodes[self.mesh.tetrahedra], slopes)
        volume = weights * np.linalg.det(jacobian)
        loads = DENSITY * GRAVITY * volume @ shape
        return np.asarray(
            np.bincount(self.mesh.tetrahedra.ravel(), loads.ravel(), len(self.mesh.nodes)), float
        )

    @cached_property
    def _rows(self) -> Indices:
        """Return the equations of each element: 30 of displacements, 4 of pressures, shape (t, 34)."""
        tets = self.mesh.tetrahedra
        moving = (3 * tets[:, :, None] + np.arange(3)).reshape(len(tets), 30)
        return np.hstack([moving, 3 * len(self.mesh.nodes) + tets[:, :4]])

    @cached_property
    def _pattern(self) -> tuple[Indices, sparse.csr_array]:
        """Return the place of each element's entries in the sparse matrix, and that matrix."""
        size = 3 * len(self.mesh.nodes) + self.mesh.corner_count
        keys = (self._rows[:, :, None] * size + self._rows[:, None, :]).ravel()
        unique, place = np.unique(keys, return_inverse=True)
        rows, columns = np.divmod(unique, size)
        starts = np.searchsorted(rows, np.arange(size + 1))
        matrix = sparse.csr_array((np.zeros(len(unique)), columns, starts), shape=(size, size))
        return place, matrix

    def kinematics(self, original: Points, shape: Points) -> Kinematics:
        """Return it for the unloaded nodes and the loaded ones, both (n, 3) [mm]; ValueError if inverted."""
        weights, _, slopes, _ = self._rule
        tets = self.mesh.tetrahedra
        unloaded = np.einsum("tai,qxa->tqix", original[tets], slopes)
        loaded = np.einsum("tai,qxa->tqix", shape[tets], slopes)
        determinant, current = np.linalg.det(unloaded), np.linalg.det(loaded)
        if min(determinant.min(), current.min()) <= 0.0:
            raise ValueError("a tetrahedron is inverted")
        in_original = np.swapaxes(np.linalg.inv(unloaded), 2, 3) @ slopes
        in_current = np.swapaxes(np.linalg.inv(loaded), 2, 3) @ slopes
        gradient = loaded @ np.linalg.inv(unloaded)
        return Kinematics(gradient, current / determinant, weights * determinant, in_original, in_current)

    def residual(self, original: Points, shape: Points, pressure: Floats, gravity: Floats) -> Floats:
        """Return unbalanced forces (3 n) [N] and volume errors (c) [mm^3]; ``gravity`` (3,) in g."""
        k = self.kinematics(original, shape)
        _, _, _, corners = self._rule
        p = self.shear * pressure[self.mesh.tetrahedra[:, :4]] @ corners.T
        change = np.swapaxes(k.gradient, 2, 3)
        inward = (p * k.stretch - self.shear)[..., None, None] * np.linalg.inv(change)
        stress = self.shear * k.gradient + inward
        forces = np.einsum("tq,tqij,tqja->tai", k.volume, stress, k.original, optimize=True).reshape(-1, 30)
        gap = k.volume * (k.stretch - 1.0 - p / (BULK * self.shear))
        volumes = self.shear * gap @ corners
        total: Floats = np.bincount(self._rows.ravel(), np.hstack([forces, volumes]).ravel()).astype(float)
        total[: 3 * len(shape)] -= (self.weight[:, None] * gravity).ravel()
        return np.asarray(total)

    def tangent(self, original: Points, shape: Points, pressure: Floats) -> sparse.csr_array:
        """Return the derivatives of the residual by the loaded shape and the pressures."""
        k = self.kinematics(original, shape)
        _, _, _, corners = self._rule
        p = self.shear * pressure[self.mesh.tetrahedra[:, :4]] @ corners.T
        g, count = _by_node(k.current), len(k.volume)
        crossed = _products(k.volume * (self.shear - p * k.stretch), g, g)
        moving = _products(k.volume * p * k.stretch, g, g) + _swapped(crossed)
        same = np.einsum("tq,tqia,tqib->tab", k.volume * self.shear, k.original, k.original, optimize=True)
        moving += np.einsum("tab,ij->taibj", same, np.eye(3)).reshape(count, 30, 30)
        mixed = self.shear * np.einsum("tq,tqn,qk->tnk", k.volume * k.stretch, g, corners, optimize=True)
        return self._assembled(moving, mixed, np.swapaxes(mixed, 1, 2), k.volume)

    def inverse_tangent(self, original: Points, shape: Points, pressure: Floats) -> sparse.csr_array:
        """Return the derivatives of the residual by the unloaded shape and the pressures."""
        k = self.kinematics(original, shape)
        _, _, _, corners = self._rule
        p = self.shear * pressure[self.mesh.tetrahedra[:, :4]] @ corners.T
        count, h = len(k.volume), _by_node(k.original)
        b = k.gradient @ np.swapaxes(k.gradient, 2, 3)
        turned = b @ k.current
        weight = k.volume * self.shear
        moving = _products(weight, _by_node(turned - k.current), h)
        moving -= _swapped(_products(weight, h, _by_node(turned)))
        spread = np.einsum("tq,tqij,tqka->taijqk", weight, k.gradient, k.original, optimize=True)
        along = spread.reshape(count, 90, -1) @ k.original.reshape(count, -1, 10)
        moving -= along.reshape(count, 10, 3, 3, 10).transpose(0, 1, 2, 4, 3).reshape(count, 30, 30)
        mixed = self.shear * np.einsum(
            "tq,tqn,qk->tnk", k.volume * k.stretch, _by_node(k.current), corners, optimize=True
        )
        squeezed = -self.shear * k.volume * (1.0 + p / (BULK * self.shear))
        below = np.einsum("tq,tqn,qk->tkn", squeezed, h, corners, optimize=True)
        return self._assembled(moving, mixed, below, k.volume)

    def _assembled(self, moving: Floats, mixed: Floats, below: Floats, volume: Floats) -> sparse.csr_array:
        """Return the sparse matrix of element matrices; the pressures' follows from ``volume`` (t, q)."""
        _, _, _, corners = self._rule
        pressures = -self.shear / BULK * np.einsum("tq,qk,ql->tkl", volume, corners, corners, optimize=True)
        element = np.concatenate(
            [np.concatenate([moving, mixed], axis=2), np.concatenate([below, pressures], axis=2)], axis=1
        )
        place, matrix = self._pattern
        values = np.bincount(place, element.ravel(), len(matrix.data))
        return sparse.csr_array((values, matrix.indices, matrix.indptr), shape=matrix.shape)


def _by_node(gradients: Floats) -> Floats:
    """Return gradients (t, q, 3, 10) as rows of node and axis, shape (t, q, 30)."""
    return np.ascontiguousarray(np.swapaxes(gradients, 2, 3)).reshape(*gradients.shape[:2], 30)


def _products(weight: Floats, one: Floats, other: Floats) -> Floats:
    """Return the sums over quadrature points of weighted outer products, shape (t, 30, 30)."""
    return np.swapaxes(weight[..., None] * one, 1, 2) @ other


def _swapped(element: Floats) -> Floats:
    """Return element matrices (t, 30, 30) with the axes of row and column exchanged."""
    count = len(element)
    return element.reshape(count, 10, 3, 10, 3).transpose(0, 1, 4, 3, 2).reshape(count, 30, 30)
