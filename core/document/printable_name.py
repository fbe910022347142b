"""Names that people give to lines, elastics, measures and customers, so that every file can hold them."""

from __future__ import annotations

import re
from collections.abc import Iterable
from unicodedata import category

from core.errors import LineError
from core.messages import LineName, Message

LONGEST_NAME = 120
"""Letters of the name of a line."""

_UNPRINTABLE = ("Cc", "Cs", "Zl", "Zp")
"""Control characters, halves of letters, and what ends a line or a paragraph, by Unicode's categories."""

_TURNING = frozenset("\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069")
"""Controls of writing direction: with them a text reads otherwise than it is."""

_CONTROLS = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069\ud800-\udfff]")


def is_printable(name: str, longest: int) -> bool:
    """Return whether a text of so many letters at most can be shown and written to every kind of file."""
    return len(name) <= longest and not any(map(_is_unprintable, name))


def is_blank(name: str) -> bool:
    """Return whether nothing of a name can be seen."""
    return all(letter.isspace() or category(letter) in ("Cc", "Cf") for letter in name)


def printable(text: str) -> str:
    """Return a text whose letters every kind of file can hold, the others replaced; lines stay lines."""
    return "".join(
        "\N{REPLACEMENT CHARACTER}" if letter not in "\t\r\n" and _is_unprintable(letter) else letter
        for letter in text
    )


def repeated(names: Iterable[str]) -> str:
    """Return the first name that is there twice, or an empty text."""
    known = set[str]()
    for name in names:
        if name in known:
            return name
        known.add(name)
    return ""


def check_line_name(name: str) -> None:
    """Raise LineError if a line cannot have this name."""
    if not is_printable(name, LONGEST_NAME):
        told = " ".join(shown(name[:LONGEST_NAME]).split())
        raise LineError(
            Message(
                "The name of the line '{name}' is too long or contains unprintable characters.",
                name=LineName(told),
            ),
            Message("Use at most {count} characters.", count=LONGEST_NAME),
        )


def shown(text: str) -> str:
    """Return a text with its control characters spelled, as a terminal would obey them; lines stay lines."""
    return _CONTROLS.sub(lambda found: ascii(found[0])[1:-1], text)


def shown_line(text: str) -> str:
    """Return a text that is one line with the ends of lines in it spelled too: a name may hold some."""
    return re.sub("[\t\r\n]", lambda found: ascii(found[0])[1:-1], shown(text))


def _is_unprintable(letter: str) -> bool:
    noncharacter = ord(letter) & 0xFFFE == 0xFFFE  # no XML file may hold one
    return category(letter) in _UNPRINTABLE or letter in _TURNING or noncharacter
