"""All quantities of the body that can be targets, by name, with their slopes by the control points (ours)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from core.analysis.inverse_design.bust_quantities import APEX, BUST, EVEN, GIRTHS
from core.analysis.inverse_design.lower_quantities import BELLY, LOWER_GIRTHS, SEAT, SEAT_EVEN
from core.analysis.inverse_design.profile_quantities import OUTLINE, profile_reader, section_of
from core.analysis.inverse_design.quantity import QuantityFamily, Read, Reading, ReadMany
from core.errors import UserError
from core.geometry.mesh import Floats, Points
from core.messages import Message
from core.pipeline.build import Stages

FAMILIES: tuple[QuantityFamily, ...] = (
    *(BUST, APEX, GIRTHS, EVEN, OUTLINE),
    *(LOWER_GIRTHS, SEAT, SEAT_EVEN, BELLY),
)
"""All families of figures."""

NAMES = tuple(name for family in FAMILIES for name in family.names)
"""What can be asked for by name, in millimetres."""

LOWER_TARGETS = tuple(name for family in FAMILIES if family.region == "lower" for name in family.names)
"""Those of the lower trunk."""


def reading(stages: Stages, name: str) -> Read:
    """Return what reads the figure ``name`` off the control points of all regions, ``Stages.rest_points``.

    Raises UserError if there is none of that name, or the design has no such region.
    """
    for family in FAMILIES:
        if family.has(name):
            if family.region == "lower" and stages.lower is None:
                raise stages.lower_problem or UserError(
                    Message("'{name}' is a target of the lower trunk, which is not in use.", name=name),
                    Message("Activate a line of waist, hips or seat first."),
                )
            return _of_region(family.read(stages, name), stages, family.region)
    raise UserError(
        Message("'{name}' is not a target.", name=name),
        Message("Choose one of: {names}.", names=", ".join(NAMES)),
    )


def _of_region(read: Read, stages: Stages, region: str) -> Read:
    """Return what reads off the control points of all regions what ``read`` does off those of one."""
    if len(stages.regions) == 1 or not region:
        return read
    part = stages.region_rows[("bust", "lower").index(region)]

    def whole(points: Points) -> Reading:
        own, slopes = read(points[part]), np.zeros_like(points)
        slopes[part] = own.slopes
        return Reading(own.value, slopes)

    return whole


def tolerance(name: str) -> float:
    """Return the tolerance [mm] of the quantity ``name``; 1 if there is none of that name."""
    return next((family.tolerance for family in FAMILIES if family.has(name)), 1.0)


class QuantityReaders:
    """The figures of one body, whatever its lines are; what was made for one question is kept."""

    def __init__(self, stages: Stages) -> None:
        self._stages = stages
        self._single: dict[str, Read] = {}
        self._heights: dict[tuple[str, ...], ReadMany] = {}

    def reader(self, names: Sequence[str]) -> ReadMany:
        """Return what reads these figures together: all heights of a section at once. Raises UserError."""
        sections: dict[str, list[int]] = {}
        for at, name in enumerate(names):
            sections.setdefault(section_of(name) or name, []).append(at)
        parts = [(at, self._together(tuple(names[each] for each in at))) for at in sections.values()]

        def read(control_points: Points) -> tuple[Floats, Floats]:
            values, slopes = np.zeros(len(names)), np.zeros((len(names), *control_points.shape))
            for at, part in parts:
                values[at], slopes[at] = part(control_points)
            return values, slopes

        return read

    def _together(self, names: tuple[str, ...]) -> ReadMany:
        if section_of(names[0]):
            if names not in self._heights:
                self._heights[names] = profile_reader(self._stages, names)
            return self._heights[names]
        name = names[0]
        read = self._known(name)

        def alone(control_points: Points) -> tuple[Floats, Floats]:
            found = read(control_points)
            return np.array([found.value]), found.slopes[None]

        return alone

    def _known(self, name: str) -> Read:
        if name not in self._single:
            self._single[name] = reading(self._stages, name)
        return self._single[name]
