"""Shortest ways over the skin, from place to place where a line is drawn.

Source: N. Sharp, K. Crane, "You Can Find Geodesic Paths in Triangle Meshes by Just Flipping Edges", 2020, as
the library potpourri3d has it.
"""

from __future__ import annotations

import numpy as np
import potpourri3d
from scipy.spatial import cKDTree

from core.errors import LineError
from core.mesh import Mesh, Points


class SkinWays:
    """Ways over one body; it takes a third of a second to prepare and some milliseconds for each.

    Raises LineError if the body's surface branches: then there is no way over it.
    """

    def __init__(self, mesh: Mesh) -> None:
        self._mesh, self._tree = mesh, cKDTree(mesh.vertices)
        try:
            self._solver = potpourri3d.EdgeFlipGeodesicSolver(mesh.vertices, mesh.faces.astype(np.int64))
        except (RuntimeError, ValueError) as problem:
            raise LineError(
                "Lines cannot be drawn on the skin of this scan.", "Lead one through control points."
            ) from problem

    def way(self, start: Points, end: Points) -> Points:
        """Return the way between two places of the skin, each (3,) [mm], shape (k, 3); both are its ends.

        Raises LineError if they lie on parts of the body that do not hang together.
        """
        first, last = (int(self._tree.query(place)[1]) for place in (start, end))
        if first == last:
            return np.stack([start, end])
        try:
            way = np.asarray(self._solver.find_geodesic_path(first, last), dtype=np.float64)
        except (RuntimeError, ValueError) as problem:
            raise LineError(
                "There is no way over the skin to that place.", "Click on the same part of the body."
            ) from problem
        # The places themselves stand for the vertices beside them, or the way would go there and back.
        return np.concatenate([[start], way[1:-1], [end]])
