"""Targets: quantities, profiles, and a limit of pressure."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from core.analysis.inverse_design.profile_curve import ProfileCurve
from core.analysis.inverse_design.quantities import Goal, section_of
from core.garment.pressure_limits import pressure_limits

SEEN = ("lift", "out")
"""Figures that are always told: what is not asked for may move as well."""

PRESSURE = "pressure"
"""The key of the wish that is a limit [kPa]."""

_SOFTEST, _HARDEST = 0.2, 50.0  # limits that can be set [kPa]


@dataclass
class Targets:
    """Figures by name [mm], profiles by section, what of them is ``drawn``, and a ``limit`` [kPa].

    ``priorities`` are those of figures and sections that are not "normal"; with ``optional`` lines that are
    off may be switched on. A figure without a value is shown as it is, and not asked for, nor is a profile
    without goals. Without a limit of its own the one is kept where the red light begins; an infinite one
    is none.
    """

    figures: dict[str, float | None] = field(default_factory=dict)
    curves: dict[str, tuple[Goal, ...]] = field(default_factory=dict)
    drawn: dict[str, ProfileCurve] = field(default_factory=dict)
    limit: float | None = None
    priorities: dict[str, str] = field(default_factory=dict)
    optional: bool = False

    @classmethod
    def of(cls, goals: Sequence[Goal]) -> Targets:
        """Return the wishes for ``goals``, with the figures beside that are always told."""
        wishes = cls()
        for goal in goals:
            section = section_of(goal.name)
            if section:
                wishes.curves[section] = (*wishes.curves.get(section, ()), goal)
            else:
                wishes.figures[goal.name] = goal.value
            if goal.priority != "normal":
                wishes.priorities[section or goal.name] = goal.priority
        if not wishes.curves:
            for name in SEEN:
                wishes.figures.setdefault(name, None)
        return wishes

    def set(self, key: str, value: float) -> None:
        """Set the target of a quantity [mm], or the limit [kPa]."""
        if key == PRESSURE:
            self.limit = min(max(value, _SOFTEST), _HARDEST)
        else:
            self.figures[key] = value

    def set_curve(self, section: str, goals: tuple[Goal, ...], profile: ProfileCurve) -> None:
        """Set the target profile of a section, from the next request on."""
        self.curves[section], self.drawn[section] = goals, profile

    def drop(self, key: str) -> None:
        """Remove the target of a quantity or profile."""
        self.figures.pop(key, None)
        self.curves.pop(key, None)
        self.drawn.pop(key, None)
        self.priorities.pop(key, None)

    def of_key(self, key: str) -> tuple[object, ...]:
        """Return all that is wished by a key, to be compared; a free figure is as good as none."""
        return self.figures.get(key), self.curves.get(key, ()), key in self.drawn, self.priorities.get(key)

    @property
    def asked(self) -> tuple[Goal, ...]:
        """Return the targets by name."""
        single = [
            Goal(name, value, self.priorities.get(name, "normal"))
            for name, value in self.figures.items()
            if value is not None
        ]
        curves = (
            replace(goal, priority=self.priorities.get(section, "normal"))
            for section, curve in self.curves.items()
            for goal in curve
        )
        return (*single, *curves)

    @property
    def told(self) -> tuple[str, ...]:
        """Return the figures that are told of an answer."""
        return tuple(dict.fromkeys((*self.figures, *SEEN)))

    @property
    def most_kpa(self) -> float:
        """Return the limit of pressure that is kept [kPa]; infinite if it is off."""
        return pressure_limits().red_kpa if self.limit is None else self.limit

    @property
    def set_limit(self) -> float | None:
        """Return the limit of its own, if there is one."""
        return None if self.limit is None or math.isinf(self.limit) else self.limit

    @property
    def only_limit(self) -> float | None:
        """Return the limit of its own, if nothing else is wished."""
        return None if self.asked else self.set_limit

    def goals(self, now: Mapping[str, float]) -> tuple[Goal, ...]:
        """Return what is asked for; with a limit alone that the first figure stays as ``now`` [mm]."""
        if self.only_limit is None:
            return self.asked
        name = next(iter(self.figures), SEEN[0])
        return (Goal(name, now[name]),) if name in now else ()
