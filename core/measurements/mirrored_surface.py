"""The skin of both breasts beside the other one's, mirrored: how far apart in mm, and how much in ml."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from scipy.spatial import cKDTree

from core.control_mesh.fit import ControlMesh
from core.deformation.blend_region import BlendRegion
from core.geometry.mesh import Flags, Floats, Indices, Mesh, Points
from core.geometry.mirror_plane import SideComparison, mirror_plane
from core.scan.body import Body

MM3_PER_ML = 1000.0


@dataclass(frozen=True)
class SkinGap:
    """How the skin of one side lies beside the other one's, mirrored.

    ``mean`` is the distance over both breasts, ``largest`` that at ``vertex``, whose skin stands out more
    there and is on ``side`` [mm]. ``left_more`` is what lies between them where the left stands out more,
    ``right_more`` where the right does [ml]. ``seen`` is the share of the skin that has a counterpart [1].
    """

    mean: float
    largest: float
    side: str
    vertex: int
    left_more: float
    right_more: float
    seen: float

    @property
    def total(self) -> float:
        """Return by how much the left volume exceeds the right one [ml]."""
        return self.left_more - self.right_more

    @property
    def absolute_total(self) -> float:
        """Return the whole volume between the skin and its mirror image [ml]."""
        return self.left_more + self.right_more


class MirroredSurface:
    """The breasts of a skin at rest, the left laid over the right, again and again while it moves.

    ``still`` (n,) tells the vertices that do not move, ``breasts`` (n,) those of the breasts, which are taken
    on both sides where they are on one; ``start`` is where the mirror about is, ``middle`` where it is [mm].
    """

    def __init__(self, rest: Mesh, still: Flags, breasts: Flags, start: float) -> None:
        self._rest = rest
        self.middle = mirror_plane(rest, still, start)
        self._sides = SideComparison(rest, np.arange(len(rest.vertices)), self.middle)
        across = breasts[self._sides.partner] & ~self._sides.alone
        self._rows: Indices = np.flatnonzero(breasts | across)

    @cached_property
    def _left(self) -> Flags:
        return np.asarray(self._rest.vertices[self._rows, 0] > self.middle)

    def gap(self, places: Points) -> SkinGap | None:
        """Return how far apart they are with the skin at ``places`` (n, 3) [mm]; None if none can be told.

        What lies between two skins is the mean of what either's area tells: right to second order (ours).
        """
        mesh = self._rest.moved(places)
        off = self._sides.protrusion_difference(mesh.vertices, mesh.vertex_normals, self._rows)
        area, known = _areas(mesh)[self._rows], np.isfinite(off)
        if not known.any():
            return None
        off, seen = np.where(known, off, 0.0), np.where(known, area, 0.0)
        ahead = np.where(self._left, off, -off) * seen / (2.0 * MM3_PER_ML)  # of the left before the right
        most = int(np.argmax(off))
        return SkinGap(
            float(np.abs(off) @ seen / seen.sum()),
            float(off[most]),
            "left" if self._left[most] else "right",
            int(self._rows[most]),
            float(np.maximum(ahead, 0.0).sum()),
            float(np.maximum(-ahead, 0.0).sum()),
            float(seen.sum() / area.sum()),
        )


@lru_cache(maxsize=2)  # while lines change, the body at rest and what of it moves are the same
def mirrored_breasts(body: Body, control: ControlMesh, patch: BlendRegion) -> MirroredSurface:
    """Return the breasts of a body: its skin nearest to control points that can move."""
    calm, fade = body.smoothed, patch.fade
    if len(calm.vertices) != len(fade):  # of a giant scan the calm skin is coarser
        fade = fade[cKDTree(body.mesh.vertices).query(calm.vertices)[1]]
    nearest = np.asarray(cKDTree(control.mesh.vertices).query(calm.vertices)[1])
    breasts = ~control.held[nearest] & (fade > 0.0)
    middle = float(control.mesh.vertices[control.border_points, 0].mean())
    return MirroredSurface(calm, fade == 0.0, breasts, middle)


def _areas(mesh: Mesh) -> Floats:
    """Return the area that belongs to each vertex, a third of the triangles at it, shape (n,) [mm^2]."""
    thirds = np.repeat(mesh.face_areas / 3.0, 3)
    return np.asarray(np.bincount(mesh.faces.ravel(), thirds, len(mesh.vertices)), dtype=np.float64)
