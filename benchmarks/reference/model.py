"""Tissue of one body: its skin, its chest wall, and its nodes under a state of gravity and lines."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from core.geometry.mesh import Faces, Flags, Mesh, Points
from reference.bands import Bands, cut
from reference.contact import Cup, CupContact
from reference.sewn import Cloth, hanging
from reference.skin import QuadraticSkin, closest, remeshed, within_outline
from reference.solid_mesh import chest_wall, over_fixed, still_nodes, tetrahedra
from reference.states import LoadedBody
from reference.tissue import Tissue
from reference.underwire import Underwire, Wire

COUNT = 380
"""Points of the skin."""

LARGEST = 1500.0
"""Largest tetrahedron [mm^3] of a mesh with so many points."""

PIECES = 3
"""Pieces of a line between two control points."""


@dataclass(frozen=True, eq=False)
class BustModel:
    """Tissue between ``skin`` and ``wall`` (n, 3) [mm], which lies under each vertex of it."""

    skin: Mesh
    wall: Points
    loaded_body: LoadedBody
    surface: QuadraticSkin

    @property
    def nodes(self) -> Points:
        """Return the nodes of the tissue on the scan, (n, 3) [mm]."""
        return self.loaded_body.tissue.mesh.nodes

    def bands(
        self,
        lines: tuple[Points, ...],
        held: tuple[Flags, ...],
        ratio: float,
        stiffness_n: float,
        band_mm: float,
    ) -> Bands:
        """Return bands along control points ``lines`` (k, 3) [mm], of which some are ``held`` in space."""
        parts = [cut(line, fixed, PIECES) for line, fixed in zip(lines, held, strict=True)]
        points = np.concatenate([line for line, _ in parts])
        fixed = np.concatenate([flags for _, flags in parts])
        ends = np.cumsum([len(line) for line, _ in parts])
        pieces = np.stack([np.arange(len(points) - 1), np.arange(1, len(points))], axis=1)
        pieces = pieces[~np.isin(pieces[:, 1], ends)]
        _, rest = closest(self.skin, points)
        rest[fixed] = points[fixed]
        follow = self.surface.discs(rest, band_mm, fixed)
        each = np.ones(len(pieces))
        return Bands(rest, self.nodes, follow, pieces, ratio * each, stiffness_n * each)

    def cloth(self, cup: Cup, cloth: Cloth, disc_mm: float) -> Bands:
        """Return the strips of a sewn ``cup``, their ends glued to discs of ``disc_mm``.

        Points further from the skin than a disc reaches, as over a crease, hang in the air.
        """
        used, pieces = np.unique(cloth.strips, return_inverse=True)
        points, pieces = cup.rest.vertices[used], pieces.reshape(-1, 2)
        rest, follow = self._glued(points, disc_mm)
        hung = hanging(np.linalg.norm(rest - points, axis=1) > 0.5 * disc_mm, pieces)
        rest, follow = hung @ rest, sparse.csr_array(hung @ follow)
        return Bands(rest, self.nodes, follow, pieces, cloth.ratio, cloth.stiffness_n(cup.rest))

    def wires(self, cup: Cup, wire: Wire, disc_mm: float) -> tuple[Underwire, ...]:
        """Return the ``wire`` of the left and the right ``cup``, which discs of ``disc_mm`` follow."""
        made = []
        for own in (wire.side == 1, wire.side == -1):
            rest, follow = self._glued(cup.rest.vertices[wire.points[own]], disc_mm)
            made.append(Underwire(rest, self.nodes, follow, wire.shape[own], wire.hardness))
        return tuple(made)

    def _glued(self, points: Points, disc_mm: float) -> tuple[Points, sparse.csr_array]:
        """Return the places on the skin nearest to ``points`` (k, 3) [mm], and the means of discs there."""
        _, rest = closest(self.skin, points)
        return rest, self.surface.discs(rest, disc_mm, np.zeros(len(rest), dtype=bool))

    def contacts(self, cup: Cup) -> tuple[CupContact, ...]:
        """Return the contact with the left and the right ``cup``."""
        picked, triangles = self.skin_nodes()
        return cup.contacts(picked @ self.nodes, triangles, picked)

    def skin_nodes(self) -> tuple[sparse.csr_array, Faces]:
        """Return the matrix that picks the skin's nodes, (s, n), and their triangles, four to a face."""
        used, number = np.unique(self.surface.faces, return_inverse=True)
        a, b, c, ab, bc, ca = number.reshape(-1, 6).T
        faces = np.concatenate(
            [np.stack(each, axis=1) for each in ((a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca))]
        )
        ones = np.ones(len(used))
        return sparse.csr_array(
            (ones, (np.arange(len(used)), used)), shape=(len(used), len(self.nodes))
        ), faces


def bust_model(body: Mesh, control: Mesh, fixed: Flags, shear_kpa: float, count: int = COUNT) -> BustModel:
    """Return the tissue of ``body`` within the outline of ``control``; its skin has ``count`` points."""
    skin = remeshed(within_outline(body, control), count)
    wall = chest_wall(skin, over_fixed(skin.vertices, control, fixed))
    mesh = tetrahedra(skin, wall, LARGEST * (COUNT / count) ** 1.5)
    tissue = Tissue(mesh, still_nodes(mesh, skin), 1e-3 * shear_kpa)
    surface = QuadraticSkin(skin, mesh.quadratic_faces(skin.faces), len(mesh.nodes))
    return BustModel(skin, wall, LoadedBody(tissue), surface)
