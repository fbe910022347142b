"""Nearly incompressible solid between skin and chest wall: what it does under weight and under loads.

Small displacements from the scan, on which the tissue is in balance with its weight. Displacements are
quadratic in each tetrahedron, the pressure is linear: a pair that does not lock (Taylor and Hood 1973).
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import SuperLU, splu

from core.geometry.mesh import Flags, Floats, Indices
from core.progress import Progress, quiet
from core.tissue.skin_patch import SkinPatch
from core.tissue.tetrahedra import EDGES, LAYERS, Tetrahedra, layered_tetrahedra
from core.tissue.wall_film import DEPTH, wall_film

BULK_OVER_SHEAR = 500.0
"""Bulk over shear modulus of tissue [1]: assumed, nearly incompressible."""

DENSITY = 0.95
"""Density of tissue [kg/l]: assumed, between fat and gland."""

EARTH = 9.81e-6
"""Weight of a volume of density 1 kg/l [N/mm^3]."""

_AT_ONCE = 4
"""So many right sides are solved at a time: with 24 each takes three times as long."""

_THREADS = 2
"""Threads that solve at the same time: SuperLU lets go of Python meanwhile."""

_NEAR, _FAR = 0.5854101966249685, 0.1381966011250105
_POINTS = np.where(np.eye(4, dtype=np.bool_), _NEAR, _FAR)
"""Four points of a tetrahedron whose mean is exact for quadratic functions, in barycentric coordinates."""


@dataclass(frozen=True, eq=False)
class TissueSolid:
    """Tetrahedra of tissue with a shear modulus [kPa] and a density [kg/l]; wall and rim do not move."""

    cells: Tetrahedra
    fixed: Flags
    shear_modulus: float
    density: float

    @cached_property
    def weights(self) -> Floats:
        """Return the weight that each node bears, shape (nodes,) [N]."""
        share = np.array([_shape(point) for point in _POINTS]).mean(axis=0)
        borne = np.abs(self.cells.volumes())[:, None] * share * self.density * EARTH
        at = self.cells.nodes.ravel()
        return np.asarray(np.bincount(at, borne.ravel(), self.cells.node_count), dtype=np.float64)

    @cached_property
    def free(self) -> Indices:
        """Return the coordinates of the nodes that can move, ascending, shape (m,)."""
        return np.flatnonzero(np.repeat(~self.fixed, 3))

    def weight_loads(self) -> Floats:
        """Return the loads on ``free`` of 1 g along each axis, shape (m, 3) [N]."""
        return np.asarray(np.kron(self.weights[:, None], np.eye(3))[self.free])

    def solved(self, loads: Floats) -> tuple[Floats, Floats]:
        """Return how ``free`` move under loads on them, (m, k) [mm] and [N], and pressures (c, k) [MPa]."""
        count, wide = loads.shape
        found = np.zeros((self._factors.shape[0], wide))

        def solve(start: int) -> None:
            some = slice(start, start + _AT_ONCE)
            found[:count, some] = loads[:, some]
            found[:, some] = self._factors.solve(found[:, some])

        with ThreadPoolExecutor(_THREADS, thread_name_prefix="busk-tissue") as threads:
            list(threads.map(solve, range(0, wide, _AT_ONCE)))
        return found[:count], found[count:]

    @cached_property
    def _factors(self) -> SuperLU:
        """Return the factors of the tangent: symmetric, so its diagonal is kept as it is."""
        stiffness, divergence, compressibility = self._tangent()
        free = self.free
        coupling = -divergence[:, free]
        high = sparse.hstack([stiffness[free][:, free], coupling.T])
        whole = sparse.csc_array(sparse.vstack([high, sparse.hstack([coupling, -compressibility])]))
        options = {"SymmetricMode": True}
        return splu(whole, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)

    def prestress(self, moved: Floats, pressure: Floats) -> sparse.csr_array:
        """Return what stresses under which ``free`` moved (m,) [mm] add to the tangent, (m, m) [N/mm].

        ``pressure`` (c,) [MPa] is positive in compression. To first order in both, for a neo-Hookean
        material; the shape that is known is the loaded one. Source: Govindjee and Mihalic 1996, linearised.
        """
        cells, shear = self.cells, 1e-3 * self.shear_modulus
        gradients, volumes = _corner_gradients(cells)
        motion = np.zeros(3 * cells.node_count)
        motion[self.free] = moved
        at_nodes, at_corners = motion.reshape(-1, 3)[cells.nodes], pressure[cells.nodes[:, :4]]
        added = np.zeros((len(volumes), 10, 3, 10, 3))
        for point in _POINTS:
            slope = np.einsum("ai,tic->tac", _shape_slopes(point), gradients)
            change = np.einsum("tac,tad->tcd", slope, at_nodes)
            part = 0.25 * volumes
            grown = np.einsum("tcc->t", change)
            strain = change + change.transpose(0, 2, 1) - grown[:, None, None] * np.eye(3)
            along = slope @ strain @ slope.transpose(0, 2, 1)
            added += np.einsum("t,tab,cd->tacbd", shear * part, along, np.eye(3))
            pushed, products = part * (at_corners @ point), np.einsum("tad,tbc->tacbd", slope, slope)
            added += (pushed - shear * part * grown)[:, None, None, None, None] * products
            added -= pushed[:, None, None, None, None] * products.transpose(0, 1, 4, 3, 2)
        where = (3 * cells.nodes[:, :, None] + np.arange(3)).reshape(len(volumes), 30)
        whole = _summed(added, where, where, (len(motion),) * 2)
        return sparse.csr_array(whole[self.free][:, self.free])

    def _tangent(self) -> tuple[sparse.csc_array, sparse.csc_array, sparse.csc_array]:
        """Return stiffness (3 n, 3 n), divergence (c, 3 n) and compressibility (c, c) in N and mm."""
        cells, shear = self.cells, 1e-3 * self.shear_modulus
        gradients, volumes = _corner_gradients(cells)
        stiffness = np.zeros((len(volumes), 10, 3, 10, 3))
        divergence = np.zeros((len(volumes), 4, 10, 3))
        for point in _POINTS:
            slope = np.einsum("ai,tic->tac", _shape_slopes(point), gradients)
            part = 0.25 * volumes
            alike = np.einsum("t,tac,tbc->tab", shear * part, slope, slope)
            stiffness += np.einsum("tab,cd->tacbd", alike, np.eye(3))
            stiffness += np.einsum("t,tad,tbc->tacbd", shear * part, slope, slope)
            divergence += np.einsum("t,p,tac->tpac", part, point, slope)
        pressure = _POINTS.T @ _POINTS / 4.0 / (BULK_OVER_SHEAR * shear)
        motion = (3 * cells.nodes[:, :, None] + np.arange(3)).reshape(len(volumes), 30)
        corner, count = cells.nodes[:, :4], 3 * cells.node_count
        return (
            _summed(stiffness, motion, motion, (count, count)),
            _summed(divergence, corner, motion, (len(cells.corners), count)),
            _summed(volumes[:, None, None] * pressure, corner, corner, (len(cells.corners),) * 2),
        )


def tissue_solid(
    patch: SkinPatch,
    shear_modulus: float,
    density: float = DENSITY,
    depth: float = DEPTH,
    layers: int = LAYERS,
    progress: Progress = quiet,
) -> TissueSolid:
    """Return the tissue under a skin patch, of a shear modulus [kPa], its factors made.

    Raises ValueError where the chest wall crosses the skin, Cancelled.
    """
    progress("tissue", 0.0)
    cells = layered_tetrahedra(patch.mesh, wall_film(patch, depth), layers)
    solid = TissueSolid(cells, _immovable(cells, patch), shear_modulus, density)
    progress("tissue", 0.3)
    assert solid._factors is not None
    progress("tissue", 1.0)
    return solid


def _immovable(cells: Tetrahedra, patch: SkinPatch) -> Flags:
    """Return which nodes lie on the wall or on the side under the rim, shape (nodes,)."""
    count = len(patch.mesh.vertices)
    corner = np.arange(len(cells.corners))
    on_wall, on_rim = corner < count, np.isin(corner % count, patch.rim)
    below = np.sort(cells.edges % count, axis=1)
    loops = [np.stack([loop, np.roll(loop, -1)], axis=1) for loop in patch.mesh.boundary_loops]
    sides = np.sort(np.concatenate(loops), axis=1)
    along_rim = np.isin(below[:, 0] * count + below[:, 1], sides[:, 0] * count + sides[:, 1])
    upright = (below[:, 0] == below[:, 1]) & np.isin(below[:, 0], patch.rim)
    middle = on_wall[cells.edges].all(axis=1) | along_rim | upright
    return np.concatenate([on_wall | on_rim, middle])


def _shape(point: Floats) -> Floats:
    """Return the ten quadratic shape functions at barycentric coordinates (4,), shape (10,) [1]."""
    middle = 4.0 * point[EDGES[:, 0]] * point[EDGES[:, 1]]
    return np.concatenate([point * (2.0 * point - 1.0), middle])


def _shape_slopes(point: Floats) -> Floats:
    """Return their derivatives by the four barycentric coordinates, shape (10, 4) [1]."""
    slopes = np.zeros((10, 4))
    slopes[range(4), range(4)] = 4.0 * point - 1.0
    middle = np.arange(4, 10)
    slopes[middle, EDGES[:, 0]] = 4.0 * point[EDGES[:, 1]]
    slopes[middle, EDGES[:, 1]] = 4.0 * point[EDGES[:, 0]]
    return slopes


def _corner_gradients(cells: Tetrahedra) -> tuple[Floats, Floats]:
    """Return gradients of the barycentric coordinates (t, 4, 3) [1/mm] and volumes (t,) [mm^3]."""
    start = cells.corners[cells.nodes[:, 0]]
    sides = np.stack([cells.corners[cells.nodes[:, k]] - start for k in (1, 2, 3)], axis=2)
    inverse = np.linalg.inv(sides)
    first = -inverse.sum(axis=1, keepdims=True)
    return np.concatenate([first, inverse], axis=1), np.linalg.det(sides) / 6.0


def _summed(parts: Floats, rows: Indices, columns: Indices, shape: tuple[int, int]) -> sparse.csc_array:
    """Return the matrix to which each element adds its part, (t, .., ..), at its rows and columns."""
    high, wide = rows.shape[1], columns.shape[1]
    where = (np.repeat(rows, wide, axis=1).ravel(), np.tile(columns, (1, high)).ravel())
    return sparse.csc_array(sparse.coo_array((parts.ravel(), where), shape=shape))
