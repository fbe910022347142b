"""A trunk as it is built: its levels from below the waist to the arm-pits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.geometry.mesh import Mesh
from core.landmarks.torso.cross_sections import Level, trunk_levels
from core.landmarks.types import Landmarks


@dataclass(frozen=True, eq=False)
class Build:
    """A trunk from below the waist to the arm-pits [mm]: its ``levels``, ascending, and those heights."""

    mesh: Mesh
    levels: list[Level]
    armpit: float


def measure_build(mesh: Mesh, landmarks: Landmarks) -> Build:
    """Measure the trunk around the landmarks of the bust."""
    pits = [mark.position[2] for name, mark in landmarks.points.items() if name.startswith("armpit")]
    armpit = float(np.mean(pits)) if pits else landmarks.bust_level + 60.0
    low = max(float(mesh.vertices[:, 2].min()) + 5.0, armpit - 260.0)
    heights = np.linspace(low, armpit - 15.0, 24) if armpit - low > 80.0 else np.empty(0)
    levels = [level for level in trunk_levels(mesh, heights) if len(level.points) > 20]
    return Build(mesh, levels, armpit)
