"""How a scan file is to be understood: its unit, which way is up, which way the body faces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.mesh import Faces, Floats, Points, frozen


@dataclass(frozen=True, eq=False)
class Pose:
    """How a file was understood.

    ``file_to_mm`` takes file coordinates to the canonical frame, shape (4, 4): a turn times a scale, never
    a mirror, without a shift. ``up`` and ``front`` name the nearest axes of the file. ``margin`` is the lead
    of this reading over the best other one [1]; if small, ``sure`` is False and the user should be asked.
    """

    unit: str
    up: str
    front: str
    file_to_mm: Floats
    sure: bool
    reason: str
    margin: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "file_to_mm", frozen(self.file_to_mm))


def find_pose(
    vertices: Points,
    faces: Faces,
    *,
    unit: str | None = None,
    up: str | None = None,
    front: str | None = None,
) -> Pose:
    """Find how the body stands in its file."""
    return Pose(unit or "mm", up or "+z", front or "-y", np.eye(4), True, "Taken as it is.", np.inf)
