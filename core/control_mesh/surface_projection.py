"""The skin near the control mesh: its nearest places, and which way it faces there."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from core.geometry.closest_point import nearest_on
from core.geometry.mesh import Floats, Mesh, Points, incidence

CANDIDATES = 24
"""The nearest place is looked for on so many triangles whose centres are near."""


@dataclass(frozen=True, eq=False)
class NearSkin:
    """Part of a body's skin; what it takes to look places up on it is prepared once."""

    mesh: Mesh

    @cached_property
    def _vertices(self) -> cKDTree:
        return cKDTree(self.mesh.vertices, compact_nodes=False, balanced_tree=False)

    @cached_property
    def _centres(self) -> cKDTree:
        centres = self.mesh.vertices[self.mesh.faces].mean(axis=1)
        return cKDTree(centres, compact_nodes=False, balanced_tree=False)

    @cached_property
    def vertex_areas(self) -> Floats:
        """The area of the triangles round each vertex, shape (n,) [mm^2]."""
        return np.asarray(incidence(self.mesh.faces, len(self.mesh.vertices)) @ self.mesh.face_areas)

    def facing(self, places: Points) -> Points:
        """Return the normals of the nearest vertices of the skin, as ``places``, shape (..., 3) [1]."""
        return np.asarray(self.mesh.vertex_normals[self._vertices.query(places)[1]])

    def nearest(self, places: Points) -> Points:
        """Return the nearest places of the skin, as ``places``, shape (k, 3) [mm]."""
        count = min(CANDIDATES, len(self.mesh.faces))
        near = self._centres.query(places, np.arange(1, count + 1))[1]
        asked = np.repeat(places, count, axis=0)
        found = nearest_on(self.mesh.vertices[self.mesh.faces[near.ravel()]], asked)
        away = np.linalg.norm(found - asked, axis=1).reshape(-1, count)
        return np.asarray(found.reshape(-1, count, 3)[np.arange(len(places)), away.argmin(axis=1)])
