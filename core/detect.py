"""What is found on a scan, as plain values for other programs: landmarks, levels, girths, pose."""

from __future__ import annotations

from typing import Any

import numpy as np

from core.body import Body
from core.doubts import doubts
from core.landmark import Landmarks
from core.landmarks import find_landmarks
from core.measure import girths


def detection(body: Body, landmarks: Landmarks | None = None) -> dict[str, Any]:
    """Return landmarks, levels [mm], girths [mm] and pose of a body, ready for JSON.

    ``landmarks`` are found if they are not given. A landmark stands there in the file's own frame and in mm.
    Raises LandmarkError.
    """
    landmarks = landmarks or find_landmarks(body)
    to_file = np.linalg.inv(body.pose.file_to_mm)
    marks = {
        name: {
            "file": (to_file[:3, :3] @ mark.position + to_file[:3, 3]).tolist(),
            "mm": mark.position.tolist(),
            "confidence": float(mark.confidence),
            "rule": mark.rule,
        }
        for name, mark in landmarks.points.items()
    }
    return {
        "landmarks": marks,
        "levels": {"bust": float(landmarks.bust_level), "underbust": float(landmarks.underbust_level)},
        "girths": {
            name: {"level_mm": girth.level_mm, "tape_mm": girth.tape_mm, "skin_mm": girth.skin_mm}
            for name, girth in girths(body, landmarks).items()
        },
        "unit": body.pose.unit,
        "up": body.pose.up,
        "front": body.pose.front,
        "file_to_mm": body.pose.file_to_mm.tolist(),
        "sure": body.pose.sure,
        "reason": body.pose.reason,
        "repairs": list(body.repairs),
        "warnings": doubts(body, landmarks),
    }
