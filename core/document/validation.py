"""What a design may say: words among those that there are, numbers within their range."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from core.errors import UserError


def check_words(said: Iterable[tuple[object, Sequence[object], str]]) -> None:
    """Raise UserError for the first value that is none of its choices; each with what it is the value of."""
    for value, choices, what in said:
        if value not in choices:
            raise UserError(
                f"There is no {what} '{value}'.", f"Choose one of: {', '.join(map(str, choices))}."
            )


def check_flags(said: Iterable[tuple[object, str]]) -> None:
    """Raise UserError for the first value that is neither true nor false."""
    for value, what in said:
        if not isinstance(value, bool):
            raise UserError(f"The {what} can be on or off only.", "Write true or false.")


def check_numbers(said: Iterable[tuple[float, float, float, str]]) -> None:
    """Raise UserError for the first number out of its range, from the least to the largest."""
    for number, low, high, what in said:
        if not low <= number <= high:
            raise UserError(f"The {what} {number:g} is out of range.", f"It goes from {low:g} to {high:g}.")
