"""The unit of lengths in the window: a length as text, and typed text as a length.

Files keep millimetres: JSON, CSV, SVG, DXF and documents never pass through here.
"""

from __future__ import annotations

import re
import unicodedata

from app.wording.words import number

UNITS = {"mm": 1.0, "cm": 10.0, "in": 25.4}
"""Units in which lengths can be shown [mm]."""

_TYPED = UNITS | {"m": 1000.0, "inch": 25.4, '"': 25.4}
_LENGTH = re.compile(r"^\s*([+-]?)\s*(\d+(?:[.,]\d*)?)\s*([a-z\"]*)\s*$")
_unit = "mm"


def use_unit(code: str) -> None:
    """Set the unit of all lengths shown from now on; an unknown one leaves millimetres.

    Call it once, before the first widget is built: a widget keeps the texts it was built with.
    """
    global _unit  # noqa: PLW0603 - one unit at a time
    _unit = code if code in UNITS else "mm"


def length_unit() -> str:
    """Return the unit in use: "mm", "cm" or "in"."""
    return _unit


def shown_unit(unit: str) -> str:
    """Return the unit in which a value in ``unit`` is shown: only millimetres are converted."""
    return _unit if unit == "mm" else unit


def shown_value(value: float, unit: str = "mm") -> float:
    """Return a value in ``unit`` as it is shown: only millimetres are converted."""
    return value / UNITS[_unit] if unit == "mm" else value


def shown_digits(digits: int, unit: str = "mm") -> int:
    """Return how many decimals are shown of a value with ``digits`` decimals in ``unit``."""
    if unit != "mm" or _unit == "mm":
        return digits
    return digits + 1 if _unit == "cm" else max(digits + 1, 2)  # 0.01 in is a quarter of a millimetre


def length_number(mm: float, digits: int = 1, signed: bool = False) -> str:
    """Return a length [mm] in the unit in use, without it; ``digits`` are those of millimetres."""
    return number(shown_value(mm), shown_digits(digits), signed)


def length(mm: float, digits: int = 1, signed: bool = False) -> str:
    """Return a length [mm] in the unit in use, with it; ``digits`` are those of millimetres."""
    return f"{length_number(mm, digits, signed)} {_unit}"


def read_length(text: str) -> float | None:
    """Return a typed length [mm], or None if it is not one.

    ``692mm``, ``69.2cm``, ``27.2in`` or ``27.2"``; a bare number is in the unit in use.
    """
    plain = unicodedata.normalize("NFKC", text).replace("\N{MINUS SIGN}", "-").lower()
    match = _LENGTH.match(plain)
    if match is None or (match[3] and match[3] not in _TYPED):
        return None
    size = float(match[2].replace(",", ".")) * _TYPED[match[3] or _unit]
    return -size if match[1] == "-" else size
