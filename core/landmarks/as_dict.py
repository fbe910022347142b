"""Detection results as plain values for other programs: landmarks, levels, girths, pose."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

import numpy as np

from core.geometry.mesh import Points
from core.landmarks.detect import find_landmarks
from core.landmarks.lower_trunk.girths import lower_girths
from core.landmarks.lower_trunk.types import LowerLandmarks
from core.landmarks.torso.girths import girth_warnings, girths, levels
from core.landmarks.types import Landmark, Landmarks
from core.landmarks.warnings import collect_warnings
from core.messages import plain
from core.scan.body import Body

MOST = 60
"""So many points of a curve are told at most."""


def detection(
    body: Body, landmarks: Landmarks | None = None, lower: LowerLandmarks | None = None
) -> dict[str, Any]:
    """Return landmarks, levels [mm], girths [mm] and pose of a body, ready for JSON.

    ``landmarks`` are found if they are not given; those of the ``lower`` trunk stand beside them, and its
    waist and hip in place of theirs. A landmark stands there in the file's own frame and in mm, with at most
    60 points [mm] of the curve that it was read from. Raises LandmarkError.
    """
    landmarks = landmarks or find_landmarks(body)
    found, heights, points = dict(girths(body, landmarks)), dict(levels(landmarks)), dict(landmarks.points)
    doubts = girth_warnings(found)
    if lower is not None:
        found.update(lower_girths(lower.sections, lower))
        heights.update(lower.levels)
        points.update(lower.points)
        doubts = [*doubts, *lower.warnings]
    return {
        "landmarks": _marks(body, points),
        "levels": heights,
        "girths": {name: asdict(girth) for name, girth in found.items()},
        "noise_mm": round(body.noise, 3),
        "unit": body.pose.unit,
        "up": body.pose.up,
        "front": body.pose.front,
        "file_to_mm": body.pose.file_to_mm.tolist(),
        "sure": body.pose.is_certain and not landmarks.size_doubted,
        "hints": [hint.kind for hint in landmarks.hints],
        "upright": landmarks.upright,
        "reason": str(body.pose.reason),
        "repairs": plain(body.repairs),
        "warnings": plain([*collect_warnings(body, landmarks), *doubts]),
    }


def _marks(body: Body, points: Mapping[str, Landmark]) -> dict[str, Any]:
    """Return landmarks in the file's own frame and in mm."""
    to_file = np.linalg.inv(body.pose.file_to_mm)
    return {
        name: {
            "file": (to_file[:3, :3] @ mark.position + to_file[:3, 3]).tolist(),
            "mm": mark.position.tolist(),
            "confidence": float(mark.confidence),
            "rule": str(mark.rule),
            "by_hand": mark.by_hand,
            "evidence": _thinned(mark.evidence),
        }
        for name, mark in points.items()
    }


def _thinned(curve: Points) -> list[list[float]]:
    """Return at most 60 points of a curve, its ends among them, to a hundredth of a mm."""
    rows = np.unique(np.linspace(0, max(len(curve) - 1, 0), min(len(curve), MOST)).astype(np.int64))
    thin: list[list[float]] = np.round(curve[rows], 2).tolist() if len(curve) else []
    return thin
