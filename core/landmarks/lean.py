"""Lean of the trunk in a level file."""

from __future__ import annotations

import numpy as np

from core.landmarks.body_build import Build
from core.landmarks.torso.cross_sections import Level
from core.landmarks.types import Hint
from core.messages import Message
from core.scan.orientation.lean_angles import corrected_up
from core.scan.orientation.pose import Pose

BACK, UPRIGHT, LEANS = 190.0, 9.0, 11.5
"""So far below the arm-pits [mm] a back slopes backward on its way up by so much [degrees]; one that does so
much more or less leans."""


def lean_hint(build: Build, pose: Pose) -> tuple[Hint, ...]:
    """Return a hint where the trunk leans in a file that is level, and the up that would correct it."""
    levels = [level for level in build.levels if level.z > build.armpit - BACK]
    if len(levels) < 8 or pose.tilt > 0.0:
        return ()
    slope = np.polyfit([level.z for level in levels], [_back(level) for level in levels], 1)[0]
    lean = UPRIGHT - float(np.degrees(np.arctan(slope)))
    if abs(lean) < LEANS:
        return ()
    up = corrected_up(pose, lean, 0.0)
    forward, lean = lean > 0.0, abs(lean)
    if forward:
        sentence = Message(
            "The trunk leans forward by about {lean} degrees, and girths are measured "
            "horizontally. Set it upright at the Scan step.",
            lean=f"{lean:.0f}",
        )
    else:
        sentence = Message(
            "The trunk leans backward by about {lean} degrees, and girths are measured "
            "horizontally. Set it upright at the Scan step.",
            lean=f"{lean:.0f}",
        )
    return (Hint("lean", sentence, up),)


def _back(level: Level) -> float:
    """Return how far back a level reaches near its middle [mm]."""
    x, y = level.points[:, 0], level.points[:, 1]
    low, high = x.min(), x.max()
    return float(y[np.abs(x - 0.5 * (low + high)) < 0.25 * (high - low)].max(initial=y.min()))
