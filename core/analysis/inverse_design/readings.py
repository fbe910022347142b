"""Everything that can be asked for, family by family: one row of the table each (ours)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from core.analysis.inverse_design.apex_quantity import APEX
from core.analysis.inverse_design.balance_quantity import EVEN
from core.analysis.inverse_design.bust_quantity import BUST
from core.analysis.inverse_design.girth_quantity import GIRTHS
from core.analysis.inverse_design.profile_quantity import OUTLINE, heights_of, section_of
from core.analysis.inverse_design.quantities import Family, Read, ReadMany
from core.errors import UserError
from core.geometry.mesh import Floats, Points
from core.pipeline.build import Stages

FAMILIES: tuple[Family, ...] = (BUST, APEX, GIRTHS, EVEN, OUTLINE)
"""A family of figures more is one row more; each has a file of its own beside this one."""

NAMES = tuple(name for family in FAMILIES for name in family.names)
"""What can be asked for by name, in millimetres."""


def reading(stages: Stages, name: str) -> Read:
    """Return what reads the figure ``name``. Raises UserError if there is none of that name."""
    for family in FAMILIES:
        if family.has(name):
            return family.read(stages, name)
    raise UserError(f"'{name}' cannot be asked for.", f"Ask for one of: {', '.join(NAMES)}.")


def tolerance(name: str) -> float:
    """Return the tolerance [mm] of the quantity ``name``; 1 if there is none of that name."""
    return next((family.tolerance for family in FAMILIES if family.has(name)), 1.0)


class Figures:
    """The figures of one body, whatever its lines are; what was made for one question is kept."""

    def __init__(self, stages: Stages) -> None:
        self._stages = stages
        self._single: dict[str, Read] = {}
        self._heights: dict[tuple[str, ...], ReadMany] = {}

    def of(self, names: Sequence[str]) -> ReadMany:
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
                self._heights[names] = heights_of(self._stages, names)
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
