"""Mirror plane of a body, and the difference of its sides."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from core.geometry.mesh import Flags, Floats, Indices, Mesh, Points, frozen

MIRROR = frozen([-1.0, 1.0, 1.0])
"""Takes a place or a way on one side of a body that stands round x = 0 to that on the other side."""

FAR = 25.0
"""A place whose mirror image finds no skin nearer than this has no counterpart [mm]."""

ALIKE = 0.5
"""Nor has skin whose mirror image looks another way than the skin near it [cosine]."""

_ROUNDS = 4
_SIDEWAYS = 0.3  # skin that looks less to the side tells little of where the middle is


def mirror(places: Points, middle: float) -> Points:
    """Return ``places``, shape (.., 3) [mm], mirrored in the upright plane x = ``middle``."""
    return np.asarray(places * MIRROR + (2.0 * middle, 0.0, 0.0))


def mirror_plane(body: Mesh, still: Flags, start: float) -> float:
    """Return x of the upright plane that maps the still skin of a body onto itself best [mm] (ours).

    ``still`` (n,) tells the vertices that count: without the breasts, which need not be alike; ``start`` is
    where the plane about is.
    """
    rows = np.flatnonzero(still & (np.abs(body.vertex_normals[:, 0]) > _SIDEWAYS))
    tree, middle = cKDTree(body.vertices), start
    for _ in range(_ROUNDS):
        away, partner = map(np.asarray, tree.query(mirror(body.vertices[rows], middle)))
        met = away < FAR
        off = _stand_out(body.vertices, body.vertex_normals, rows[met], partner[met], middle)
        across = -body.vertex_normals[partner[met], 0]
        # The middle half: an arm that hangs otherwise must not pull.
        calm = np.abs(off - np.median(off)) <= np.median(np.abs(off - np.median(off))) + 1e-9
        middle += float(off[calm] @ across[calm] / max(2.0 * (across[calm] ** 2).sum(), 1e-12))
    return middle


class SideComparison:
    """Lays one side of a body over the other at x = ``middle`` [mm], again and again while it moves.

    ``rows`` are the vertices whose answer changes when those of ``moving`` (k,) move. ``partner`` (n,) is the
    vertex across from each, of no meaning for those that are ``alone`` (n,).
    """

    def __init__(self, rest: Mesh, moving: Indices, middle: float) -> None:
        self.middle = middle
        self.partner, self.alone = self._counterparts(rest)
        moves = np.zeros(len(rest.vertices), dtype=bool)
        moves[moving] = True
        self.rows = np.flatnonzero(moves | moves[self.partner])

    def protrusion_difference(self, places: Points, normals: Points, rows: Indices | None = None) -> Floats:
        """Return how far the skin at ``rows`` (all if None) stands out beyond the other side, mirrored [mm].

        ``places`` [mm] and ``normals`` [1] are those of all vertices, (n, 3); NaN without a counterpart.
        """
        rows = np.arange(len(places)) if rows is None else rows
        off = _stand_out(places, normals, rows, self.partner[rows], self.middle)
        return np.where(self.alone[rows], np.nan, off)

    def _counterparts(self, rest: Mesh) -> tuple[Indices, Flags]:
        found = cKDTree(rest.vertices).query(mirror(rest.vertices, self.middle))
        away, partner = map(np.asarray, found)
        alike = np.einsum("ij,ij->i", rest.vertex_normals, rest.vertex_normals[partner] * MIRROR)
        return partner.astype(np.int64), (away > FAR) | (alike < ALIKE)


def _stand_out(places: Points, normals: Points, rows: Indices, partner: Indices, middle: float) -> Floats:
    """Return how far places stand before the tangent planes of their mirrored partners, shape (k,) [mm]."""
    across = places[rows, 0] - (2.0 * middle - places[partner, 0])
    way = places[rows, 1:] - places[partner, 1:]
    return np.asarray(np.einsum("ij,ij->i", way, normals[partner, 1:]) - across * normals[partner, 0])
