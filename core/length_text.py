"""Lengths as people type them: with a unit or without, with decimals or, of inches, with fractions."""

from __future__ import annotations

import re
import unicodedata

_UNITS = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4, "inch": 25.4, '"': 25.4}
_LENGTH = re.compile(
    r"""\s*(?P<sign>[+-]?)\s*
    (?:(?P<whole>\d+(?:[.,]\d*)?)(?!\d*/))?
    (?:(?:(?<=\d)(?:-|\s+)|(?<!\d))(?P<over>\d+)/(?P<under>[1-9]\d*))?
    \s*(?P<unit>[a-z%"]*)\s*""",
    re.VERBOSE,
)


def parse_length(text: str) -> tuple[str, float, str] | None:
    """Split a typed length into sign ("", "+", "-"), number and unit ("" for none); None if it is no length.

    ``692``, ``69,2cm``, ``+1.5 mm``, ``27 1/4"``, ``27-1/4 in``, ``¾ inch``, also in full width.
    """
    match = _LENGTH.fullmatch(_plain(text))
    if match is None or not (match["whole"] or match["over"]):
        return None
    number = float((match["whole"] or "0").replace(",", "."))
    if match["over"]:
        part = float(match["over"]) / float(match["under"])
        if part >= 1.0 or not number.is_integer():
            return None
        number += part
    return match["sign"], number, match["unit"]


def millimetres(number: float, unit: str) -> float | None:
    """Return a length [mm] of a number in a typed unit, or None for an unknown unit."""
    return number * _UNITS[unit] if unit in _UNITS else None


def _plain(text: str) -> str:
    """Return text with plain digits, signs and fractions: ``27¼`` is ``27 1/4``."""
    parted = re.sub(r"(?<=\d)(?=[¼½¾⅛⅜⅝⅞])", " ", text)
    plain = unicodedata.normalize("NFKC", parted).replace("\N{FRACTION SLASH}", "/")
    return plain.replace("\N{MINUS SIGN}", "-").replace("\N{RIGHT DOUBLE QUOTATION MARK}", '"').lower()
