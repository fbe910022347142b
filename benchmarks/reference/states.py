"""States of a body's tissue: the unloaded shape, and shapes under other gravity and with lines."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
from scipy import sparse

from core.geometry.mesh import Floats, Points
from reference.bands import Bands
from reference.newton import follow, solve
from reference.tissue import Tissue

STANDING = np.array([0.0, 0.0, -1.0])
"""Direction and size of gravity in the scan [9.81 m/s^2]."""


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

    def loaded(self, gravity: Floats, bands: Bands | None = None, start: Floats | None = None) -> Points:
        """Return the nodes, (n, 3) [mm], under ``gravity`` (3,) [9.81 m/s^2] with ``bands`` worn.

        The load goes in steps from the scan, or from nodes ``start`` (n, 3), to gravity and lengths at once.
        Raises NoBalanceError.
        """
        nodes = self.tissue.mesh.nodes if start is None else start
        unknowns = np.concatenate([nodes.ravel(), self.pressure])
        return follow(partial(self._at, gravity, bands), unknowns, 4)[: nodes.size].reshape(-1, 3)

    def _at(self, gravity: Floats, bands: Bands | None, load: float, unknowns: Floats) -> Floats:
        tissue, unloaded, size = self.tissue, self.unloaded, self.tissue.mesh.nodes.size
        now = STANDING + load * (gravity - STANDING)

        def residual(z: Floats) -> Floats:
            total = tissue.residual(unloaded, *_split(z, size), now)
            if bands is not None:
                total[:size] += bands.forces(z[:size].reshape(-1, 3), load)
            return total

        def tangent(z: Floats) -> sparse.csr_array:
            matrix = tissue.tangent(unloaded, *_split(z, size))
            if bands is None:
                return matrix
            worn = bands.stiffness(z[:size].reshape(-1, 3), load)
            return sparse.csr_array(matrix + sparse.block_diag([worn, _nothing(len(z) - size)], format="csr"))

        return solve(residual, tangent, unknowns, tissue.free)


def _split(unknowns: Floats, size: int) -> tuple[Points, Floats]:
    return unknowns[:size].reshape(-1, 3), unknowns[size:]


def _swap(unknowns: Floats, shape: Points) -> tuple[Points, Points, Floats]:
    """Return unloaded shape, loaded ``shape`` and pressures where the unloaded one is unknown."""
    original, pressure = _split(unknowns, shape.size)
    return original, shape, pressure


def _nothing(count: int) -> sparse.csr_array:
    return sparse.csr_array((count, count))
