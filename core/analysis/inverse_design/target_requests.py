"""Targets as text requests: NAME=VALUE, with a unit and a priority."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence
from dataclasses import replace

from core.analysis.inverse_design.profile_quantities import is_signed
from core.analysis.inverse_design.quantities import NAMES, reading
from core.analysis.inverse_design.quantity import Goal
from core.errors import UserError
from core.messages import Message
from core.pipeline.build import Stages

_TARGET = re.compile(
    r"\s*([a-z ]+?)\s*=\s*([+-]?\d+(?:[.,]\d+)?)\s*(mm|cm|in)?\s*(?:@\s*(high|normal|low)\s*)?"
)
_MM = {None: 1.0, "mm": 1.0, "cm": 10.0, "in": 25.4}
_LARGEST = 10_000.0  # mm


def changes_of(texts: Sequence[str]) -> frozenset[str]:
    """Return the names of girths that texts, NAME=VALUE, give with a sign: changes from the original body."""
    matches = filter(None, map(_matched, texts))
    return frozenset(name for name, value, *_ in matches if value[0] in "+-" and not is_signed(name))


def _matched(text: str) -> tuple[str, str, str | None, str | None] | None:
    """Return name, value, unit and priority of a text, NAME=VALUE, None if it is none."""
    plain = unicodedata.normalize("NFKC", text).replace("\N{MINUS SIGN}", "-").lower()
    match = _TARGET.fullmatch(plain)
    return None if match is None else (" ".join(match[1].split()), match[2], match[3], match[4])


def goals_of(texts: Sequence[str]) -> tuple[Goal, ...]:
    """Return the goals of NAME=VALUE texts. Raises UserError with the valid names."""
    goals: dict[str, Goal] = {}
    for text in texts:
        name, number, unit, priority = _matched(text) or ("", "0", None, None)
        if name not in NAMES:
            names = ", ".join(NAMES)
            raise UserError(
                Message("'{text}' is not a target.", text=text),
                Message("Enter NAME=12mm. Names: {names}.", names=names),
            )
        value = float(number.replace(",", ".")) * _MM[unit]
        if abs(value) > _LARGEST:
            raise UserError(
                Message("'{text}' is not a valid body length.", text=text),
                Message("Enter millimetres, or append cm or in."),
            )
        if name in goals:
            raise UserError(
                Message("{name} is specified twice.", name=name), Message("Specify each name only once.")
            )
        goals[name] = Goal(name, value, priority or "normal")
    return tuple(goals.values())


def absolute(stages: Stages, goal: Goal) -> Goal:
    """Return the goal of a girth that was given as a change from the original body."""
    return replace(goal, value=goal.value + reading(stages, goal.name)(stages.rest_points).value)
