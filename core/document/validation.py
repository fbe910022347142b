"""Validation of settings: choices and ranges."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from core.errors import UserError
from core.messages import Message, SettingName


def check_words(settings: Iterable[tuple[object, Sequence[object], SettingName]]) -> None:
    """Raise UserError for the first value that is none of its choices; each with what it is the value of."""
    for value, choices, what in settings:
        if value not in choices:
            raise UserError(
                Message("There is no {what} '{value}'.", what=what, value=str(value)),
                Message("Choose one of: {choices}.", choices=tuple(map(str, choices))),
            )


def check_flags(settings: Iterable[tuple[object, SettingName]]) -> None:
    """Raise UserError for the first value that is neither true nor false."""
    for value, what in settings:
        if not isinstance(value, bool):
            raise UserError(
                Message("The {what} must be on or off.", what=what), Message("Enter true or false.")
            )


def check_numbers(settings: Iterable[tuple[float, float, float, SettingName]]) -> None:
    """Raise UserError for the first number out of its range, from the least to the largest."""
    for number, low, high, what in settings:
        if not low <= number <= high:
            raise UserError(
                Message("The {what} {number} is out of range.", what=what, number=f"{number:g}"),
                Message("Enter a value from {low} to {high}.", low=f"{low:g}", high=f"{high:g}"),
            )
