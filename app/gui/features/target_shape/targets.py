"""Targets: quantities, profiles, and a limit of pressure."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject
from PySide6.QtGui import QUndoCommand, QUndoGroup, QUndoStack

from app.gui.session.session import Session
from app.i18n.catalog import listed, tr
from app.presenters.target_shape import target_title
from core.analysis.inverse_design.profile_curve import ProfileCurve
from core.analysis.inverse_design.profile_quantities import section_of
from core.analysis.inverse_design.quantities import LOWER_TARGETS
from core.analysis.inverse_design.quantity import Goal
from core.document.design import Design
from core.garment.pressure import pressure_limits

if TYPE_CHECKING:
    from app.gui.features.target_shape.controller import TargetShapeController


SEEN = ("lift", "out")
"""Figures of the bust that are always told: what is not asked for may move as well."""

SEEN_LOWER = ("waist girth", "hip girth")
"""The same of the lower trunk."""


def default_quantities(design: Design) -> tuple[str, ...]:
    """Return the figures that are always told of a design: those of the regions that have active lines."""
    bust, *lower = (bool(region.lines) for region in design.regions)
    return (*(SEEN if bust or not any(lower) else ()), *(SEEN_LOWER if any(lower) else ()))


PRESSURE = "pressure"
"""The key of the wish that is a limit [kPa]."""

_SOFTEST, _HARDEST = 0.2, 50.0  # limits that can be set [kPa]


@dataclass
class Targets:
    """Figures by name [mm], profiles by section, what of them is ``drawn``, and a ``limit`` [kPa].

    ``priorities`` are those of figures and sections that are not "normal"; with ``optional`` lines that are
    off may be switched on. Figures that are ``seen`` are told whatever is asked for. A figure without a value
    is shown as it is, and not asked for, nor is a profile without goals. Without a limit of its own the one
    is kept where the red light begins; an infinite one is none.
    """

    figures: dict[str, float | None] = field(default_factory=dict)
    curves: dict[str, tuple[Goal, ...]] = field(default_factory=dict)
    drawn: dict[str, ProfileCurve] = field(default_factory=dict)
    limit: float | None = None
    priorities: dict[str, str] = field(default_factory=dict)
    optional: bool = False
    seen: tuple[str, ...] = SEEN

    @classmethod
    def of(cls, goals: Sequence[Goal], seen: tuple[str, ...] = SEEN) -> Targets:
        """Return the wishes for ``goals``, with the figures beside that are always ``seen``."""
        wishes = cls(seen=seen)
        for goal in goals:
            section = section_of(goal.name)
            if section:
                wishes.curves[section] = (*wishes.curves.get(section, ()), goal)
            else:
                wishes.figures[goal.name] = goal.value
            if goal.priority != "normal":
                wishes.priorities[section or goal.name] = goal.priority
        if not wishes.curves:
            for name in seen:
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
        return tuple(dict.fromkeys((*self.figures, *self.seen)))

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
        """Return what is asked for; with a limit alone that a figure of each region stays as ``now`` [mm]."""
        if self.only_limit is None:
            return self.asked
        first = {name in LOWER_TARGETS: name for name in reversed(tuple(self.figures) or self.seen)}
        return tuple(Goal(name, now[name]) for _, name in sorted(first.items()) if name in now)


@dataclass(frozen=True, eq=False)
class _State:
    """Wishes as they were once, and what the handles dragged then."""

    wishes: Targets
    kind: str

    def changed_from(self, other: _State) -> list[str]:
        """Return the keys of what is asked for, or drawn, in one of both otherwise than in the other."""
        one, two = self.wishes, other.wishes
        keys = dict.fromkeys((*two.figures, *one.figures, *two.drawn, *one.drawn))
        changed = [key for key in keys if one.of_key(key) != two.of_key(key)]
        return changed + ([PRESSURE] if one.limit != two.limit else [])


class _Step(QUndoCommand):
    """One step from a state to another, which has been done when it is pushed."""

    def __init__(self, steps: TargetUndo, before: _State, after: _State, words: str) -> None:
        super().__init__(words)
        self._steps, self._before, self._after = steps, before, after
        self._done = True

    def redo(self) -> None:
        if not self._done:
            self._steps.show(self._after)

    def undo(self) -> None:
        self._done = False
        self._steps.show(self._before)


class TargetUndo(QObject):
    """Keeps a step by ``note`` whenever something else is asked for; they end with the card.

    Once one is kept, undo and redo of the window mean these steps and leave the design alone, until it is
    edited itself.
    """

    def __init__(self, session: Session, group: QUndoGroup, controller: TargetShapeController) -> None:
        super().__init__(controller)
        self._controller = controller
        self._group, self._others = group, session.undo_stack
        self.stack = QUndoStack(self)
        self._group.addStack(self.stack)
        self._last = self._state()

    def forget(self) -> None:
        """Restart with the current targets: undo then applies to the design."""
        self.stack.clear()
        self._last = self._state()
        self._group.setActiveStack(self._others)

    def note(self) -> None:
        """Keep a step if something else is asked for than before."""
        before, self._last = self._last, self._state()
        changed = self._last.changed_from(before)
        if changed:
            titles = [
                tr("Contact pressure limit") if key == PRESSURE else target_title(key) for key in changed
            ]
            self.stack.push(_Step(self, before, self._last, listed(titles)))
            self._group.setActiveStack(self.stack)

    def show(self, state: _State) -> None:
        """Restore earlier targets."""
        self._last = state
        self._controller.handles.let_go()
        self._controller.all_wishes = _copy(state.wishes)
        self._controller.drawing.turn_to(state.kind)

    def _state(self) -> _State:
        return _State(_copy(self._controller.all_wishes), self._controller.handles.kind)


def _copy(wishes: Targets) -> Targets:
    figures, priorities = dict(wishes.figures), dict(wishes.priorities)
    curves, drawn = dict(wishes.curves), dict(wishes.drawn)
    return replace(wishes, figures=figures, curves=curves, drawn=drawn, priorities=priorities)
