"""Tape girths of the lower trunk and of the thighs."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from core.geometry.mesh import Points
from core.geometry.plane_sections import hull_perimeter
from core.landmarks.lower_trunk.sections import LowerSections
from core.landmarks.lower_trunk.types import LowerLandmarks
from core.landmarks.torso.girths import Girth
from core.landmarks.types import SIDES

BELOW_FOLD = 15.0
"""The top of a thigh is measured so far below the lower of gluteal fold and crotch [mm]. Ours."""

MARKS = {
    "waist": ("waist",),
    "belly": ("belly",),
    "hip": ("hip",),
    "buttock": ("buttock_left", "buttock_right"),
}
"""Girths of the trunk, and the landmarks that their heights come from."""


def lower_girths(sections: LowerSections, landmarks: LowerLandmarks) -> Mapping[str, Girth]:
    """Return the girths of waist, belly, hip, buttock, thigh_left, thigh_right [mm] that the scan shows.

    Source: ours.
    """
    points, levels, found = landmarks.points, landmarks.levels, {}
    for name, marks in MARKS.items():
        section = sections.at(levels[name])
        if section.trunk is not None:
            sure = min(points[mark].confidence for mark in marks)
            found[name] = _girth(levels[name], section.trunk, section.bridged, sure)
    for k, side in enumerate(SIDES):
        fold = f"gluteal_fold_{side}"
        z = min(levels[fold], levels["crotch"]) - BELOW_FOLD
        section = sections.at(z)
        if (leg := section.legs[k]) is not None:
            sure = min(points[fold].confidence, points["crotch"].confidence)
            found[f"thigh_{side}"] = _girth(z, leg, section.bridged, sure)
    return MappingProxyType(found)


def _girth(z: float, outline: Points, bridged: float, confidence: float) -> Girth:
    skin = float(np.linalg.norm(outline - np.roll(outline, 1, axis=0), axis=1).sum())
    return Girth(z, hull_perimeter(outline), skin, bridged, confidence)
