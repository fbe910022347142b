"""The unit of lengths in the window: a length as text, and typed text as a length.

Whole millimetres are as fine as a tape, and are shown as inches and sixteenths; tenths of a millimetre as
0.01 in. Files keep millimetres: JSON, CSV, SVG, DXF and documents never pass through here.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from fractions import Fraction

from app.i18n.numerals import number
from core.length_text import millimetres, parse_length

UNITS = {"mm": 1.0, "cm": 10.0, "in": 25.4}
"""Units in which lengths can be shown [mm]."""

_STEPS = {"mm": (1.0, 5.0), "cm": (1.0, 5.0), "in": (25.4 / 16, 25.4 / 4)}  # of arrow keys [mm]
_SIXTEENTHS = 16
_unit = "mm"


def use_unit(code: str) -> None:
    """Set the unit of all lengths shown from now on; an unknown one leaves millimetres.

    Call it once, before the first widget is built: a widget keeps the texts it was built with.
    """
    global _unit  # noqa: PLW0603 - one unit at a time
    _unit = code if code in UNITS else "mm"


@contextmanager
def using_unit(code: str) -> Iterator[None]:
    """Use another unit meanwhile: files keep millimetres."""
    before = _unit
    use_unit(code)
    try:
        yield
    finally:
        use_unit(before)


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


def decimal_length(mm: float, digits: int = 1, signed: bool = False) -> str:
    """Return a length [mm] as ``length_number`` does, with decimals whatever the unit."""
    return number(shown_value(mm), shown_digits(digits), signed)


def length_number(mm: float, digits: int = 1, signed: bool = False) -> str:
    """Return a length [mm] in the unit in use, without it; ``digits`` are those of millimetres."""
    if _unit == "in" and digits == 0:
        return _sixteenths(shown_value(mm), signed)
    return decimal_length(mm, digits, signed)


def length(mm: float, digits: int = 1, signed: bool = False) -> str:
    """Return a length [mm] in the unit in use, with it; ``digits`` are those of millimetres."""
    return f"{length_number(mm, digits, signed)} {_unit}"


def widest_length(widest: str, digits: int) -> str:
    """Return the widest length that has to have room where ``widest`` is that of millimetres."""
    return "88\N{NO-BREAK SPACE}15/16" if _unit == "in" and digits == 0 else widest


def width_number(mm: float) -> str:
    """Return the width of a tape [mm] as it is ordered, without decimals that are not there or its unit."""
    return length_number(mm, 0 if float(mm).is_integer() else 1)


def width(mm: float) -> str:
    """Return the width of a tape [mm] as it is ordered, with its unit."""
    return f"{width_number(mm)} {_unit}"


def arrow_step(far: bool = False) -> float:
    """Return what an arrow key moves by [mm]; ``far`` with Shift."""
    return _STEPS[_unit][far]


def read_length(text: str) -> float | None:
    """Return a typed length [mm], or None if it is not one.

    ``692mm``, ``69.2cm``, ``27.2in`` or ``27 1/4"``; a bare number is in the unit in use.
    """
    typed = parse_length(text)
    if typed is None:
        return None
    sign, size, unit = typed
    mm = millimetres(size, unit or _unit)
    return -mm if mm is not None and sign == "-" else mm


def _sixteenths(inches: float, signed: bool) -> str:
    """Return inches to the nearest sixteenth as a tape is read: ``27 1/4``."""
    steps = round(abs(inches) * _SIXTEENTHS)
    sign = "" if not steps else "\N{MINUS SIGN}" if inches < 0.0 else "+" if signed else ""
    whole, part = divmod(steps, _SIXTEENTHS)
    figures = [number(whole, 0)] if whole or not part else []
    if part:
        figures.append(str(Fraction(part, _SIXTEENTHS)))
    return sign + "\N{NO-BREAK SPACE}".join(figures)
