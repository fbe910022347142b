"""The root of a breast: the closed curve on the skin along which it passes into the chest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.geometry.closest_point import nearest_faces
from core.geometry.mesh import Floats, Indices, Mesh, Points
from core.landmarks.lower_breast import CREASE, ESTIMATED, NO_CREASE
from core.landmarks.types import SIDES, Landmark, Landmarks
from core.measurements.chest_wall import UnrolledTorso, innermost

POINTS = 96
"""So many points a root has."""

TRACED = (CREASE, NO_CREASE, ESTIMATED)
"""The rules of folds whose evidence is the crease itself."""

TRUSTED = 0.6
"""The crease is followed up to this part of the height from the fold to the ends of the root [1]."""

LEAST_RISE = 0.35
"""The ends of a root lie at least so high over the fold, in parts of half its width [1]."""

HALF_ROUND = 1.0
"""The top of a root lies so high over its ends, in parts of half its width [1]: no skin shows it."""

AROUND = 70.0
"""So far round a root the skin is looked at [mm]."""


@dataclass(frozen=True, eq=False)
class Root:
    """The root of one breast.

    ``loop``: shape (k, 3) [mm], on the skin: from the inner end down under the breast to the outer end, the
    first ``lower`` points, and on over the top. ``chart`` rolls the chest out. ``confidence`` (0..1).
    """

    loop: Points
    lower: int
    chart: UnrolledTorso
    confidence: float

    @property
    def under(self) -> Points:
        """Return the part below the ends, along which a wire would lie, shape (lower, 3) [mm]."""
        return self.loop[: self.lower]

    @property
    def closed(self) -> Points:
        """Return the whole curve, ending where it begins, shape (k + 1, 3) [mm]."""
        return np.concatenate([self.loop, self.loop[:1]])


def chart_of(landmarks: Landmarks, side: str, depth: tuple[float, float]) -> UnrolledTorso:
    """Return a chart about the axis of the trunk, ``depth`` being y of its front and of its back [mm].

    It keeps lengths where the root of the breast of a ``side`` ends.
    """
    busts = np.array([landmarks.position(f"bust_point_{each}") for each in SIDES])
    centre = np.array([busts[:, 0].mean(), 0.5 * (depth[0] + depth[1])])
    ends = [landmarks.points.get(f"root_{name}_{side}") for name in ("inner", "outer")]
    reach = [float(np.linalg.norm(mark.position[:2] - centre)) for mark in ends if mark]
    return UnrolledTorso(centre, float(np.mean(reach)) if reach else 0.5 * abs(depth[1] - depth[0]))


@dataclass(frozen=True, eq=False)
class Side:
    """The skin round one breast: ``piece``, whose vertices are ``rows`` (k,) of the body, and the landmarks.

    ``uvw`` (k, 3) [mm] are its vertices in the ``chart``; ``ends`` (2, 3) [mm] there those of the root, the
    inner one first, and ``fold`` (3,) [mm].
    """

    piece: Mesh
    rows: Indices
    chart: UnrolledTorso
    uvw: Points
    ends: Points
    fold: Points
    marks: tuple[Landmark, ...]

    @property
    def half(self) -> float:
        """Return half the width of the root, round the trunk [mm]."""
        return 0.5 * abs(float(self.ends[1, 0] - self.ends[0, 0]))

    @property
    def bust_point(self) -> Points:
        """Return the position of the bust point, shape (3,) [mm]."""
        return self.marks[3].position


NEEDED = ("root_inner", "root_outer", "fold", "bust_point")
"""The landmarks that a root is taken from."""


def side_of(mesh: Mesh, landmarks: Landmarks, side: str, chart: UnrolledTorso) -> Side | None:
    """Return the skin round the breast of a ``side``; None if its ends or its fold were not found."""
    if not all(f"{name}_{side}" in landmarks.points for name in NEEDED):
        return None
    marks = tuple(landmarks.points[f"{name}_{side}"] for name in NEEDED)
    spots = chart.unroll(np.array([mark.position for mark in marks[:3]]))
    uvw = chart.unroll(mesh.vertices)
    half = 0.5 * abs(float(spots[1, 0] - spots[0, 0]))
    low = spots[:, :2].min(axis=0) - AROUND
    high = spots[:, :2].max(axis=0) + AROUND + np.array([0.0, half])
    near = ((uvw[:, :2] > low) & (uvw[:, :2] < high)).all(axis=1)
    rows, faces = np.unique(mesh.faces[near[mesh.faces].all(axis=1)], return_inverse=True)
    if not len(rows):
        return None
    piece = Mesh(mesh.vertices[rows], faces.reshape(-1, 3))
    return Side(piece, rows, chart, uvw[rows], spots[:2], spots[2], marks)


def root_of(side: Side, rise: float = 0.0) -> Root | None:
    """Return the root of a breast; None where the skin for it is missing.

    Below, it runs from the inner end over the traced crease to the outer end. Its top, which the skin does
    not show, is taken as a half circle over both ends, ``rise`` [mm] higher. Source: ours.
    """
    half, fold = side.half, side.fold
    level = max(float(side.ends[:, 1].mean()), float(fold[1]) + LEAST_RISE * half)
    middle = np.array([side.ends[:, 0].mean(), level])
    angle = np.linspace(0.0, np.pi, 13)
    top = middle + np.stack([half * np.cos(angle), (HALF_ROUND * half + rise) * np.sin(angle)], axis=1)
    top = np.column_stack([top, innermost(side.uvw, side.piece.faces, top)])
    top = top[np.isfinite(top[:, 2])]
    if len(top) < 7:
        return None
    samples = np.concatenate([top, _crease(side, middle)])
    loop, lower = _joined(samples, middle, bool(side.ends[0, 0] < side.ends[1, 0]))
    _, places = nearest_faces(side.piece, side.chart.roll_up(loop))
    return Root(places, lower, side.chart, min(mark.confidence for mark in side.marks[:3]))


def _crease(side: Side, middle: Points) -> Points:
    """Return the places of the crease that the root follows, in the chart, shape (k, 3) [mm]."""
    fold, mark = side.fold, side.marks[2]
    if mark.rule not in TRACED or len(mark.evidence) < 5:
        return fold[None]
    traced = side.chart.unroll(mark.evidence)
    limit = fold[1] + TRUSTED * (middle[1] - fold[1])
    kept = (traced[:, 1] < limit) & (np.abs(traced[:, 0] - middle[0]) < 0.95 * side.half)
    return traced[kept] if kept.sum() > 2 else fold[None]


def _joined(samples: Points, middle: Points, leftward: bool) -> tuple[Points, int]:
    """Return an even closed curve through ``samples`` of the chart, shape (POINTS, 3), and the count below.

    The angle runs from the inner end (0) below the breast to the outer end (pi) and over the top.
    """
    from scipy.interpolate import PchipInterpolator  # noqa: PLC0415 (a fifth of a second that no start needs)

    way = samples[:, :2] - middle
    across = -way[:, 0] if leftward else way[:, 0]
    angle = np.arctan2(-way[:, 1], across) % (2.0 * np.pi)
    order = np.argsort(angle)
    angle, keep = np.unique(np.round(angle[order], 3), return_index=True)
    far = np.hypot(*way.T)[order][keep]
    out = samples[order][keep, 2]
    wrapped = np.concatenate([angle - 2.0 * np.pi, angle, angle + 2.0 * np.pi])
    at = np.linspace(0.0, 2.0 * np.pi, POINTS, endpoint=False)
    values: list[Floats] = [PchipInterpolator(wrapped, np.tile(each, 3))(at) for each in (far, out)]
    sign = -1.0 if leftward else 1.0
    u, v = middle[0] + sign * values[0] * np.cos(at), middle[1] - values[0] * np.sin(at)
    return np.stack([u, v, values[1]], axis=1), POINTS // 2 + 1
