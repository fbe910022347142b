"""Contact, without friction, of skin with a rigid cup: a penalty on how far its places lie outside of it."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy import sparse

from core.geometry.mesh import Faces, Floats, Indices, Mesh, Points
from reference.distance_field import DistanceField, distance_field
from reference.sewn import Cloth
from reference.skin import barycentric, closest
from reference.underwire import Wire

HARDNESS = 0.01
"""Pressure with which a cup answers to skin outside of it [N/mm^3]: 0.1 mm at 1 kPa."""


@dataclass(frozen=True, eq=False)
class Cup:
    """A cup of each breast, given at the points of the control mesh halved once.

    ``lift``, ``forward`` and ``gather`` [mm] are the way of the apex, ``coverage`` is where the upper edge
    lies. The cup is ``rest`` with its points at ``target`` (n, 3) [mm]; ``side`` (n,) is 1 and -1 at points
    that the left and the right cup cover, else 0. With ``cloth`` it is sewn and holds nothing back.
    """

    lift: float
    forward: float
    gather: float
    coverage: str
    rest: Mesh
    target: Points
    side: Indices
    cloth: Cloth | None = None
    wire: Wire | None = None

    def contacts(self, skin: Points, triangles: Faces, picked: sparse.csr_array) -> tuple[CupContact, ...]:
        """Return the contact of nodes ``skin`` (s, 3) [mm], which ``picked`` (s, n) takes from all nodes.

        The way of the control points is carried linearly to the nodes. Those touch whose triangle of the
        control mesh is covered at all corners; the cup goes on beyond its edge, so that skin may slide there.
        """
        face, foot = closest(self.rest, skin)
        corners = self.rest.faces[face]
        shares = barycentric(self.rest.vertices[corners], foot)
        way = np.einsum("sc,scx->sx", shares, (self.target - self.rest.vertices)[corners])
        surface = Mesh(skin, triangles)
        area = np.bincount(triangles.ravel(), np.repeat(surface.face_areas / 3.0, 3), len(skin))
        sides = ((self.side[corners] == side).all(axis=1) for side in (1, -1))
        return tuple(
            CupContact(sparse.csr_array(picked[own]), area[own], surface, way, np.flatnonzero(own))
            for own in sides
        )


@dataclass(frozen=True, eq=False)
class CupContact:
    """Places of the skin that one cup holds back, and the cup on its way from the scan.

    ``follow`` (k, n) takes the places from the nodes, each of which stands for ``area`` (k,) [mm^2]; the cup
    is the ``skin`` at rest moved by ``way`` (s, 3) [mm] times the load; the places are those of its vertices
    ``covered`` (k,).
    """

    follow: sparse.csr_array
    area: Floats
    skin: Mesh
    way: Points
    covered: Indices
    _last: dict[float, tuple[DistanceField, Floats]] = field(default_factory=dict, init=False, repr=False)

    def _distance(self, load: float) -> tuple[DistanceField, Floats]:
        """Return the distance from the cup, and that of its own places: 0 but for the rounding of edges."""
        if load in self._last:
            return self._last[load]
        surface = self.skin.moved(self.skin.vertices + load * self.way)
        own = surface.vertices[self.covered]
        distance = distance_field(surface, np.concatenate([own, self.skin.vertices[self.covered]]))
        self._last.clear()
        self._last[load] = distance, distance.at(own)[0]
        return self._last[load]

    def _out(self, nodes: Points, load: float) -> tuple[Floats, Points, Floats]:
        """Return how far places lie outside, (k,) [mm], not less than 0, and two derivatives of distance."""
        distance, level = self._distance(load)
        out, slope, bend = distance.at(self.follow @ nodes)
        return np.maximum(out - level, 0.0), slope, bend

    def outside(self, nodes: Points) -> Floats:
        """Return how far each place lies outside the cup, (k,) [mm]: 0 within."""
        return self._out(nodes, 1.0)[0]

    def forces(self, nodes: Points, load: float) -> Floats:
        """Return the derivatives of the energy by the nodes, (3 n,) [N]."""
        out, slope, _ = self._out(nodes, load)
        return np.asarray((self.follow.T @ ((HARDNESS * self.area * out)[:, None] * slope)).ravel())

    def total(self, nodes: Points) -> Floats:
        """Return the force of the cup on the skin, (3,) [N]."""
        return np.asarray(-self.forces(nodes, 1.0).reshape(-1, 3).sum(axis=0))

    def stiffness(self, nodes: Points, load: float) -> sparse.csr_array:
        """Return the second derivatives of the energy by the nodes, (3 n, 3 n) [N/mm]."""
        out, slope, bend = self._out(nodes, load)
        blocks = (out > 0.0)[:, None, None] * slope[:, :, None] * slope[:, None, :]
        blocks = (HARDNESS * self.area)[:, None, None] * (blocks + out[:, None, None] * bend)
        count = len(blocks)
        starts = np.arange(count + 1)
        whole = sparse.bsr_array((blocks, np.arange(count), starts), shape=(3 * count, 3 * count))
        ends = sparse.kron(self.follow, sparse.eye_array(3), format="csr")
        return sparse.csr_array(ends.T @ whole.tocsr() @ ends)
