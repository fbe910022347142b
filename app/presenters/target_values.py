"""Values in the rows of targets: what is now, and the result with its change."""

from __future__ import annotations

from collections.abc import Mapping

from app.i18n.catalog import number
from app.i18n.lengths import length_number
from app.presenters.target_shape import is_signed


def value_words(value: float | None, signed: bool) -> str:
    """Return what a figure is now [mm], without its unit; nothing before it is known."""
    return "" if value is None else length_number(value, 1, signed=signed)


def result_words(now: Mapping[str, float], then: Mapping[str, float], name: str) -> str:
    """Return what a figure comes to with its change, as "+0.4 (+0.2)"; nothing before it is known."""
    if name not in then or name not in now:
        return ""
    return _with_change(then[name], then[name] - now[name], is_signed(name))


def _with_change(value: float, change: float, signed: bool) -> str:
    return f"{length_number(value, 1, signed=signed)} ({length_number(change, 1, signed=True)})"


def pressure_words(now: Mapping[str, float], then: Mapping[str, float]) -> tuple[str, str]:
    """Return what lines press with at most now [kPa], and what they come to with its change."""
    before = number(most := max(now.values())) if now else ""
    if not now or not then:
        return before, ""
    result = max(then.values())
    return before, f"{number(result)} ({number(result - most, 1, True)})"
