"""Pieces sewn together again in space: how near the garment comes to the body that it was made from.

What is modelled: flat pieces as they are worn, before ease, joined along their seams, take the shape in space
with the least stretch, alike in all directions, from where they lie on the body. Neither the body nor weight
or bending of the cloth hold them, so an open garment may leave the body where it would lie on it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from core.geometry.closest_point import nearest_faces
from core.geometry.mesh import Faces, Floats, Indices, Mesh, Points
from core.pattern.garment import Pattern
from core.pattern.plane_maps import triangle_slopes

REST = 0.01
"""The step after which the garment is at rest [mm]."""

_MOST_TURNS = 400


@dataclass(frozen=True, eq=False)
class SewnGarment:
    """A garment of n points that is sewn: its ``places`` (n, 3) [mm], and where it was ``worn`` on the body.

    ``faces`` (m, 3); ``points`` (p,) are those of all points of its panels, one panel after the other.
    """

    places: Points
    worn: Points
    faces: Faces
    points: Indices

    @cached_property
    def apart(self) -> Floats:
        """Return how far each point is from the garment on the body, (n,) [mm]."""
        foot = nearest_faces(Mesh(self.worn, self.faces), self.places)[1]
        return np.asarray(np.linalg.norm(self.places - foot, axis=1))

    @property
    def rms(self) -> float:
        """Return the root mean square of ``apart`` [mm]."""
        return float(np.sqrt((self.apart**2).mean()))

    @property
    def worst(self) -> float:
        """Return the largest of ``apart`` [mm]."""
        return float(self.apart.max())


def sewn_again(pattern: Pattern) -> SewnGarment:
    """Sew the pieces of a pattern together in space, starting from where they lie on the body.

    By turns of local and global steps (O. Sorkine, M. Alexa, "As-rigid-as-possible surface modeling", 2007).
    """
    points, faces = _joined(pattern)
    count = int(points.max()) + 1
    share = np.bincount(points, minlength=count)[:, None]
    on_body = np.concatenate(pattern.places)
    worn = np.stack([np.bincount(points, column, count) for column in on_body.T], axis=1) / share
    flat = np.concatenate([piece.worn for piece in pattern.flats])
    own = np.concatenate(
        [piece.panel.faces + at for piece, at in zip(pattern.flats, _starts(pattern), strict=True)]
    )
    surface = triangle_slopes(np.pad(flat, [(0, 0), (0, 1)]), own)
    pull = surface.slopes * surface.areas[:, None, None]
    blocks = pull @ surface.slopes.transpose(0, 2, 1)
    rows, columns = np.repeat(faces, 3, axis=1).ravel(), np.tile(faces, 3).ravel()
    stiff = sparse.csc_array(sparse.coo_array((blocks.ravel(), (rows, columns)), (count, count)))
    hold = 1e-9 * float(stiff.diagonal().mean())  # leaves the place of the whole where it is
    solve = splu(sparse.csc_array(stiff + hold * sparse.eye_array(count))).solve
    places = worn
    for _ in range(_MOST_TURNS):
        turned = _turns(places[faces].transpose(0, 2, 1) @ surface.slopes)
        force = pull @ turned.transpose(0, 2, 1)
        right = np.stack(
            [np.bincount(faces.ravel(), force[..., axis].ravel(), count) for axis in range(3)], axis=1
        )
        moved = solve(right + hold * places)
        step, places = float(np.linalg.norm(moved - places, axis=1).max()), moved
        if step < REST:
            break
    return SewnGarment(places, worn, faces, points)


def _starts(pattern: Pattern) -> list[int]:
    return [0, *accumulate(len(piece.worn) for piece in pattern.flats)][:-1]


def _joined(pattern: Pattern) -> tuple[Indices, Faces]:
    """Return the number in the garment of each point of all panels, sewn ones as one, and all triangles."""
    starts = _starts(pattern)
    total = sum(len(piece.worn) for piece in pattern.flats)
    pairs = [np.empty((0, 2), dtype=np.int64)]
    for seam in pattern.matched.seams:
        one, two = (points + starts[panel] for panel, points in zip(seam.panels, seam.points, strict=True))
        pairs.append(np.stack([one, two], axis=1))
    joins = np.concatenate(pairs)
    graph = sparse.coo_array((np.ones(len(joins)), joins.T), (total, total))
    points = sparse.csgraph.connected_components(graph, directed=False)[1].astype(np.int64)
    faces = [piece.panel.faces + start for piece, start in zip(pattern.flats, starts, strict=True)]
    return points, points[np.concatenate(faces)]


def _turns(gradient: Floats) -> Floats:
    """Return the nearest isometries (m, 3, 2) of the plane into space to ``gradient`` (m, 3, 2)."""
    metric = gradient.transpose(0, 2, 1) @ gradient
    a, b, d = metric[:, 0, 0], metric[:, 0, 1], metric[:, 1, 1]
    root = np.sqrt(np.maximum(a * d - b**2, 1e-12))
    trace = np.sqrt(a + d + 2.0 * root)
    # The square root of a matrix of two rows is (M + root I) / trace, its inverse the adjugate over root.
    inverse = np.stack([np.stack([d + root, -b], axis=1), np.stack([-b, a + root], axis=1)], axis=1)
    return np.asarray(gradient @ inverse / (trace * root)[:, None, None])
