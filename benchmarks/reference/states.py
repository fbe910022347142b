"""States of a body's tissue: the unloaded shape, and shapes under other gravity and with lines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Protocol

import numpy as np
from scipy import sparse

from core.geometry.mesh import Floats, Points
from reference.newton import follow, solve
from reference.tissue import Tissue

STANDING = np.array([0.0, 0.0, -1.0])
"""Direction and size of gravity in the scan [9.81 m/s^2]."""


class Worn(Protocol):
    """What is worn, as an energy of the nodes (n, 3) [mm] at a share of its load [1]."""

    def forces(self, nodes: Points, load: float) -> Floats:
        """Return the derivatives of the energy by the nodes, (3 n,) [N]."""

    def stiffness(self, nodes: Points, load: float) -> sparse.csr_array:
        """Return the second derivatives of the energy by the nodes, (3 n, 3 n) [N/mm]."""


@dataclass(frozen=True, eq=False)
class LoadedBody:
    """Tissue in balance under its weight on the scan."""

    tissue: Tissue

    @cached_property
    def _unloaded(self) -> Floats:
        """Return nodes and pressures of the unloaded shape: the inverse problem in three load steps."""
        tissue, scan = self.tissue, self.tissue.mesh.nodes
        start = np.concatenate([scan.ravel(), np.zeros(tissue.mesh.corner_count)])

        def solved(load: float, unknowns: Floats) -> Floats:
            return solve(
                lambda z: tissue.residual(*_swap(z, scan), load * STANDING),
                lambda z: tissue.inverse_tangent(*_swap(z, scan)),
                unknowns,
                tissue.free,
            )

        return follow(solved, start, 3)

    @property
    def unloaded(self) -> Points:
        """Return the nodes of the unloaded shape, (n, 3) [mm]."""
        return self._unloaded[: self.tissue.mesh.nodes.size].reshape(-1, 3)

    @property
    def pressure(self) -> Floats:
        """Return the pressures in the scan, (c,) [shear modulus]."""
        return self._unloaded[self.tissue.mesh.nodes.size :]

    def loaded(
        self, gravity: Floats, worn: Sequence[Worn] = (), steps: int = 4, start: Points | None = None
    ) -> Points:
        """Return the nodes, (n, 3) [mm], under ``gravity`` (3,) [9.81 m/s^2] with garments ``worn``.

        The load goes in ``steps`` from the scan, or from nodes ``start`` (n, 3), to gravity and garments at
        once.
        Raises NoBalanceError.
        """
        nodes = self.tissue.mesh.nodes if start is None else start
        unknowns = np.concatenate([nodes.ravel(), self.pressure])
        return follow(partial(self._at, gravity, worn), unknowns, steps)[: nodes.size].reshape(-1, 3)

    def _at(self, gravity: Floats, worn: Sequence[Worn], load: float, unknowns: Floats) -> Floats:
        tissue, unloaded, size = self.tissue, self.unloaded, self.tissue.mesh.nodes.size
        now = STANDING + load * (gravity - STANDING)

        def residual(z: Floats) -> Floats:
            total = tissue.residual(unloaded, *_split(z, size), now)
            for each in worn:
                total[:size] += each.forces(z[:size].reshape(-1, 3), load)
            return total

        def tangent(z: Floats) -> sparse.csr_array:
            matrix = tissue.tangent(unloaded, *_split(z, size))
            for each in worn:
                added = each.stiffness(z[:size].reshape(-1, 3), load)
                added.resize(matrix.shape)
                matrix = matrix + added
            return matrix

        return solve(residual, tangent, unknowns, tissue.free)


def _split(unknowns: Floats, size: int) -> tuple[Points, Floats]:
    return unknowns[:size].reshape(-1, 3), unknowns[size:]


def _swap(unknowns: Floats, shape: Points) -> tuple[Points, Points, Floats]:
    """Return unloaded shape, loaded ``shape`` and pressures where the unloaded one is unknown."""
    original, pressure = _split(unknowns, shape.size)
    return original, shape, pressure
