"""The skin near the control mesh: its nearest places, and which way it faces there."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from core.geometry.closest_point import centroid_tree, nearest_faces
from core.geometry.mesh import Floats, Mesh, Points, incidence

CANDIDATES = 24
"""The nearest place is looked for on so many triangles whose centres are near."""


@dataclass(frozen=True, eq=False)
class SurfaceProjector:
    """Part of a body's skin; what it takes to look places up on it is prepared once."""

    mesh: Mesh

    @cached_property
    def _vertices(self) -> cKDTree:
        return cKDTree(self.mesh.vertices, compact_nodes=False, balanced_tree=False)

    @cached_property
    def _centres(self) -> cKDTree:
        return centroid_tree(self.mesh)

    @cached_property
    def vertex_areas(self) -> Floats:
        """The area of the triangles round each vertex, shape (n,) [mm^2]."""
        return np.asarray(incidence(self.mesh.faces, len(self.mesh.vertices)) @ self.mesh.face_areas)

    def normals_at(self, places: Points) -> Points:
        """Return the normals of the nearest vertices of the skin, as ``places``, shape (..., 3) [1]."""
        return np.asarray(self.mesh.vertex_normals[self._vertices.query(places)[1]])

    def project(self, places: Points) -> Points:
        """Return the nearest places of the skin, as ``places``, shape (k, 3) [mm]."""
        return nearest_faces(self.mesh, places, self._centres, CANDIDATES)[1]
