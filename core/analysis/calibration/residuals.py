"""Predicted less real: how far the skin that was predicted stands before that of the worn scan (ours)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from core.analysis.calibration.registration import Alignment, transform_points
from core.analysis.calibration.surface_distance import ScanSurface, Surface, curvature, is_valid
from core.analysis.uncertainty.input_uncertainty import default_uncertainty
from core.errors import LandmarkError, ScanError
from core.geometry.mesh import Floats, Mesh, Points
from core.geometry.mirror_plane import mirror
from core.landmarks.detect import find_landmarks
from core.landmarks.types import CERTAIN, SIDES, Landmark
from core.messages import Message
from core.pipeline.build import Stages
from core.scan.body import Body

THICKEST = 20.0
"""Cloth is not thicker than this [mm]."""

_MIRRORED = 2.0
"""A worn scan whose mirror image lies so many times nearer to the moving skin is one itself [1]."""

_OFF = 2.0  # and which lies at least this far from it [mm]: less is no matter
_SEVERAL = 2.0  # points round a vertex, counted by their share of it, whose mean tells more than one triangle
_ANY = 0.25  # and where no triangle is met


@dataclass(frozen=True, eq=False)
class FittingScan:
    """A scan with the garment on, ``name`` its file, laid on the first: its ``skin`` in that frame [mm].

    ``bust_points`` by side are (3,) [mm], and ``sure`` how sure they are (0..1); both empty where none show.
    """

    name: str
    body: Body
    alignment: Alignment
    skin: ScanSurface
    bust_points: Mapping[str, Points]
    sure: Mapping[str, float]


@dataclass(frozen=True)
class ResidualSummary:
    """Predicted less real [mm] of some skin: the mean, the root of the mean square, 95 % of all sizes.

    ``seen`` [1] is the share of it that the worn scan shows.
    """

    mean: float
    rms: float
    most: float
    seen: float


@dataclass(frozen=True, eq=False)
class Residuals:
    """Predicted less real at each of the moving vertices, ``values`` (k,) [mm] along the predicted normal.

    Positive where the predicted skin stands before the real one; not a number where the worn scan shows none.
    ``total`` and ``sides`` sum it up; ``bust_points`` (3,) [mm] by side, where they are sure on the scan,
    and the ± of each along the skin, ``bust_unsure`` [mm], as both scans tell where it is.
    """

    values: Floats
    total: ResidualSummary
    sides: Mapping[str, ResidualSummary]
    bust_points: Mapping[str, Points]
    bust_unsure: Mapping[str, float]


def aligned_fitting_scan(name: str, body: Body, alignment: Alignment) -> FittingScan:
    """Return the body of a worn scan, ``name`` its file, laid on the first by an alignment."""
    points: dict[str, Points] = {}
    sure: dict[str, float] = {}
    try:
        found = find_landmarks(body).points
    except LandmarkError:
        found = {}
    for side in SIDES:
        if mark := found.get(f"bust_point_{side}"):
            points[side] = transform_points(alignment.matrix, mark.position[None])[0]
            sure[side] = mark.confidence
    return FittingScan(
        name, body, alignment, ScanSurface(alignment.transform(body.mesh), body.noise), points, sure
    )


def require_not_mirrored(stages: Stages, worn: FittingScan) -> None:
    """Raise ScanError for a scan that fits far better left for right: still skin may be too even to tell."""
    points, mesh = stages.rest_points, worn.skin.mesh
    other = Mesh(mirror(mesh.vertices, stages.moving.middle), mesh.faces[:, ::-1])
    skins = worn.skin, ScanSurface(other, worn.skin.noise)
    off, mirrored = (summarize(residuals_at(stages, points, skin, 0.0)).rms for skin in skins)
    if off > max(_OFF, _MIRRORED * mirrored):
        raise ScanError(
            Message(
                "The fitting scan appears to be a mirror image of the first scan: left and right are swapped."
            ),
            Message("Export the fitting scan again without mirroring."),
        )


def residuals_at(stages: Stages, points: Points, skin: ScanSurface, thickness: float) -> Floats:
    """Return predicted less real of the moving vertices of ``stages.skin``, shape (k,) [mm].

    ``points`` (n, 3) [mm] are the control points of all regions. The real skin is taken to lie ``thickness``
    [mm] under the scanned one. Where the scan is finer than the predicted skin it is the mean of the points
    round a vertex, else where its normal meets the scan.
    """
    skin_faces = stages.skin.faces
    count, corners = skin_faces.count, skin_faces.corners
    places, normals = stages.skin.shape([points[rows] for rows in stages.region_rows])
    curved = curvature(places, normals, corners)[:count]
    met = skin.gaps(places[:count], normals[:count], curved)
    ground = Surface(places, normals, corners)
    feet = ground.project(skin.mesh.vertices, skin.vertex_directions, skin.noise)
    many = np.bincount(feet.corners.ravel(), feet.parts.ravel(), len(places))[:count]
    sums = np.bincount(feet.corners.ravel(), (feet.parts * feet.gaps[:, None]).ravel(), len(places))[:count]
    several = many >= np.where(is_valid(met), _SEVERAL, _ANY)
    return np.asarray(np.where(several, sums / np.where(several, many, 1.0), met) + thickness)


def compare(stages: Stages, points: Points, worn: FittingScan, thickness: float = 0.0) -> Residuals:
    """Compare what control ``points`` of all regions, (n, 3) [mm], predict with a worn scan."""
    values = residuals_at(stages, points, worn.skin, thickness)
    left = stages.skin.faces.rest[: len(values), 0] > stages.moving.middle
    marks = dict(zip(SIDES, stages.watch.bust_points(points[stages.region_rows[0]]), strict=True))
    inward = np.array([0.0, thickness, 0.0])
    shown = [side for side in worn.bust_points if worn.sure[side] >= CERTAIN]
    return Residuals(
        values,
        summarize(values),
        {"left": summarize(values[left]), "right": summarize(values[~left])},
        {side: marks[side] - (worn.bust_points[side] + inward) for side in shown},
        {side: bust_point_uncertainty(stages.landmarks.points[f"bust_point_{side}"]) for side in shown},
    )


def bust_point_uncertainty(first: Landmark) -> float:
    """Return the ± along the skin of a bust point of both scans, ``first`` that of the first [mm]."""
    told = default_uncertainty()
    return told.sds * math.hypot(told.of_landmark(first), told.landmark_mm)


def summarize(values: Floats) -> ResidualSummary:
    """Return what sums up ``values`` (k,) [mm], of which some may be no number."""
    seen = is_valid(values)
    real = values[seen]
    if not len(real):
        return ResidualSummary(np.nan, np.nan, np.nan, 0.0)
    return ResidualSummary(
        float(real.mean()),
        float(np.sqrt(np.mean(real**2))),
        float(np.quantile(np.abs(real), 0.95)),
        float(seen.mean()),
    )
