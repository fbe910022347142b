"""Landmarks of the lower trunk: names, levels, and what belongs together."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from core.geometry.mesh import Points
from core.landmarks.lower_trunk.sections import LowerSections
from core.landmarks.types import SIDES, Landmark
from core.messages import Message


@dataclass(frozen=True, eq=False)
class LowerLandmarks:
    """The landmarks of the lower trunk by name, and the ``sections`` that they were read from.

    ``points`` have names of ``LOWER_NAMES``; _left is +x. ``warnings`` are sentences.
    """

    points: Mapping[str, Landmark]
    sections: LowerSections
    warnings: tuple[Message, ...] = ()

    def level(self, name: str) -> float:
        """Return the height of a landmark [mm]; that of a pair without its side is the mean of both."""
        if name in self.points:
            return float(self.points[name].position[2])
        return sum(float(self.points[f"{name}_{side}"].position[2]) for side in SIDES) / len(SIDES)

    def position(self, name: str) -> Points:
        """Return where landmark ``name`` is, shape (3,) [mm]."""
        return self.points[name].position
