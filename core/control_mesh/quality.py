"""Quality of a fit: distance to the skin and shape of the triangles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.control_mesh.skin_projection import SurfaceProjector
from core.control_mesh.validation import (
    SAME_WAY,
    agreement,
    bends,
    corner_angles,
    crossing_faces,
    edge_lengths,
    sides,
)
from core.geometry.closest_point import Frames, neighbourhoods
from core.geometry.mesh import Flags, Floats, Mesh
from core.messages import Length, Message

SAMPLES = 2500
"""The deviation is taken at about so many vertices of the skin."""

FARTHEST = 40.0
"""Skin further than this from the control mesh is another part of the body [mm]."""

LOOSE = 4.0
"""From this mean deviation on a fit is called poor [mm] ..."""

POINTED = 15.0
"""... and with angles below this [deg]."""


@dataclass(frozen=True)
class FitQuality:
    """The figures of a fit.

    ``deviation_mean``, ``deviation_95``, ``deviation_max`` [mm]: from the skin behind the control mesh to it,
    by area; the control points lie on the skin, so that this is what flat triangles cut off.
    ``smallest_angle`` [deg] and ``shortest_edge`` [mm] of its triangles; ``largest_bend`` [deg] between two
    of them, the fold row left out; ``crossings``: how many of them cut another one; ``same_way``: the least
    cosine between one of them and the skin. ``bust_off`` and ``fold_off`` [mm]: how far the bust points lie
    from their landmarks, and how much higher or lower than its landmark the fold row passes under them.
    """

    deviation_mean: float
    deviation_95: float
    deviation_max: float
    smallest_angle: float
    shortest_edge: float
    largest_bend: float
    crossings: int
    same_way: float
    bust_off: float
    fold_off: float

    @property
    def warnings(self) -> tuple[Message, ...]:
        """Return a sentence for each deficiency."""
        found = []
        if self.deviation_mean > LOOSE:
            found.append(
                Message(
                    "The control mesh is coarse for this body: its distance to the skin is "
                    "{mean} on average and {most} at most.",
                    mean=Length(self.deviation_mean, 1),
                    most=Length(self.deviation_max),
                )
            )
        if self.smallest_angle < POINTED:
            found.append(
                Message(
                    "The control mesh has sharp triangles with an angle of {angle} degrees. "
                    "Check the bust points and inframammary folds.",
                    angle=f"{self.smallest_angle:.0f}",
                )
            )
        if self.same_way <= SAME_WAY:
            found.append(
                Message(
                    "The control mesh bridges part of an inframammary fold. Check the effect of "
                    "the lines there."
                )
            )
        return tuple(found)


def measure_fit(
    mesh: Mesh, skin: SurfaceProjector, fold: Flags, bust_off: float, fold_off: float
) -> FitQuality:
    """Measure a control mesh on the ``skin`` of its body; ``fold`` (n,) marks the points of the fold row."""
    away, weight = deviations(mesh, skin)
    edges, _, bend = bends(mesh)
    open_bend = bend[~fold[edges].any(axis=1)]
    return FitQuality(
        deviation_mean=float(np.average(away, weights=weight)) if len(away) else float("nan"),
        deviation_95=_share(away, weight, 0.95),
        deviation_max=float(away.max(initial=0.0)),
        smallest_angle=float(corner_angles(mesh).min()),
        shortest_edge=float(edge_lengths(mesh).min()),
        largest_bend=float(open_bend.max(initial=0.0)),
        crossings=int(crossing_faces(mesh).sum()),
        same_way=float(agreement(mesh, skin).min()),
        bust_off=bust_off,
        fold_off=fold_off,
    )


def deviations(mesh: Mesh, skin: SurfaceProjector) -> tuple[Floats, Floats]:
    """Return how far vertices of the skin behind ``mesh`` lie from it, (k,) [mm], and their areas [mm^2].

    Skin whose nearest place is on the border of the mesh lies beside it, skin that faces the other way or is
    too far belongs to an arm or to the back: neither counts.
    """
    body = skin.mesh
    low, high = mesh.vertices.min(axis=0) - FARTHEST, mesh.vertices.max(axis=0) + FARTHEST
    near = np.flatnonzero(((body.vertices > low) & (body.vertices < high)).all(axis=1))
    picked = near[:: max(1, len(near) // SAMPLES)]
    points, normals = body.vertices[picked], body.vertex_normals[picked]
    edges, side = sides(mesh)
    once = np.bincount(side.ravel()) == 1
    frames, at_border = Frames.of(mesh), once[side]
    border = np.isin(np.arange(len(mesh.vertices)), edges[once])
    away = np.full(len(points), np.inf)
    for rows, triangles in neighbourhoods(points, mesh):
        u, v, h = frames.coordinates(points[rows], triangles)
        distance2 = frames.distance2(points[rows], triangles, h)
        best, place = distance2.argmin(axis=0), np.arange(len(rows))
        u, v = (table[best, place] for table in frames.nearest_place(points[rows], triangles, u, v))
        share = np.stack([1.0 - u - v, u, v], axis=1)
        nearest = triangles[best]
        # The side k of a triangle lies opposite to its corner k + 2.
        beside = (at_border[nearest] & (np.roll(share, 1, axis=1) < 1e-9)).any(axis=1)
        beside |= (border[mesh.faces[nearest]] & (share > 1.0 - 1e-9)).any(axis=1)
        facing = (normals[rows] * mesh.face_normals[nearest]).sum(axis=1) > 0.0
        away[rows] = np.where(facing & ~beside, np.sqrt(distance2[best, place]), np.inf)
    counts = away < FARTHEST
    return away[counts], skin.vertex_areas[picked][counts]


def _share(values: Floats, weight: Floats, part: float) -> float:
    """Return the value below which ``part`` [1] of the weight lies; NaN if there is none."""
    if not len(values):
        return float("nan")
    order = np.argsort(values)
    reached = np.cumsum(weight[order])
    return float(values[order][np.searchsorted(reached, part * reached[-1])])
