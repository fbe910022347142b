"""Landmarks of the lower trunk and their levels."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from core.geometry.mesh import Points
from core.landmarks.lower_trunk.sections import LowerSections
from core.landmarks.types import Landmark
from core.messages import Message


@dataclass(frozen=True, eq=False)
class LowerLandmarks:
    """The landmarks of the lower trunk by name, of ``LOWER_NAMES``, and the heights of its ``levels`` [mm].

    Levels are waist, belly, hip, crotch, those of buttocks and gluteal folds of both sides, and buttock, the
    mean of these. ``sections`` are those that they were read from. ``warnings`` hold one sentence each.
    """

    points: Mapping[str, Landmark]
    levels: Mapping[str, float]
    sections: LowerSections
    warnings: tuple[Message, ...] = ()

    def position(self, name: str) -> Points:
        """Return where landmark ``name`` is, shape (3,) [mm]."""
        return self.points[name].position
