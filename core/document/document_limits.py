"""Limits of the contents of a document, the same for edits, saving and opening."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence, Sized
from typing import Any

from core.errors import ProjectError, UserError
from core.messages import Message, SettingName

LARGEST_SCAN = 1_000_000_000
"""Bytes of the scan in a project: more than any file that is read as one."""

LARGEST_TEXT = 20_000_000
"""Bytes of each text in a project."""

LARGEST_PICTURE = 8_000_000
"""Bytes of the picture in a project."""

MOST_VALUES = 700_000
"""Values in each text of a project, roughly: a small file could stand for a large amount of memory."""

MOST_NESTED = 32
"""Levels of what a later version may have written into a design."""

LARGEST_UNKNOWN = 500_000
"""Bytes of what a later version may have written into a design."""

MOST_LINES, MOST_POINTS = 500, 20_000
"""Lines of a design, worn, treated or own ones, and control points of all own lines together."""

MOST_MEASURES = 200
"""Own measures of a design."""

MOST_ELASTICS, MOST_ROWS = 200, 40_000
"""Elastics of a design, and points of all their curves together."""


def check_counts(counted: Iterable[tuple[int, int, Message]]) -> None:
    """Raise UserError for the first count beyond its limit; each with what is counted."""
    for count, most, what in counted:
        if count > most:
            raise UserError(
                Message("This design has too many {what}: {count}.", what=what, count=count),
                Message("Use at most {count}.", count=most),
            )


def check_size(name: str, data: Sized, most: int) -> None:
    """Raise ProjectError if a part of a project is larger than what is read of it [bytes]."""
    if len(data) > most:
        raise too_large(
            name, most, Message("Use fewer lines, shorter tables of elastics, or a scan with fewer points.")
        )


def too_large(name: str, most: int, hint: Message) -> ProjectError:
    """Return what to say of a part of a project that is too large, with a ``hint`` what to do."""
    return ProjectError(
        Message("{name} of this project is larger than {size} MB.", name=name, size=f"{most / 1e6:.0f}"), hint
    )


def check_values(text: str) -> None:
    """Raise ValueError if a JSON text holds more values than a document can."""
    if sum(map(text.count, ",[{:")) > MOST_VALUES:
        raise ValueError("too many values")


def check_nesting(value: Any, most: int = MOST_NESTED) -> None:
    """Raise ProjectError if values of JSON lie more than ``most`` levels deep in each other.

    Raises ValueError for a number that other programs would not read, such as NaN.
    """
    level = [value]
    for _ in range(most + 1):
        level = [inner for each in level for inner in _held(each)]
        if not all(math.isfinite(each) for each in level if isinstance(each, float)):
            raise ValueError("not a number")
        if not level:
            return
    raise ProjectError(
        Message("The project file contains too many nested levels."),
        Message("Open a backup or start from the scan."),
    )


def _held(value: Any) -> Iterable[Any]:
    return value.values() if isinstance(value, dict) else value if isinstance(value, list | tuple) else ()


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
