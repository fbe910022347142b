"""Settings and lines as they are written on the command line: KEY=VALUE, NAME=LENGTH."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from core.document.design import TEMPLATES, WEIGHTS, Design
from core.errors import LineError, UserError
from core.garment.elastic_library import find_elastic, read_elastic
from core.mechanics.constraint_lines import Line, length_ratio
from core.mechanics.options import CHOICES, RANGES

WORDS = {**CHOICES, "weights": WEIGHTS, "template": TEMPLATES}
"""Settings that are a word, and the words that each allows."""

NUMBERS = (*RANGES, "gain", "line_height", "tissue_stiffness")
"""Settings that are a number."""

SWITCHES = ("scaled_normals", "dense_volume")
"""Settings that are on or off."""

_ON = dict.fromkeys(("yes", "on", "true", "1"), True) | dict.fromkeys(("no", "off", "false", "0"), False)
_FIRM = {"yes": 0.1, "on": 0.1, "firm": 0.1, "no": 0.0, "off": 0.0, "free": 0.0}


def settings_of(pairs: Sequence[str]) -> dict[str, Any]:
    """Return the fields of a design that ``KEY=VALUE`` pairs name; hyphens and underscores mean the same.

    Raises UserError with the right keys or words; ranges are the design's own business.
    """
    values: dict[str, Any] = {}
    for pair in pairs:
        key, equals, value = pair.partition("=")
        key, value = key.strip().lower().replace("-", "_"), value.strip().lower()
        if not equals or key not in _READERS:
            raise UserError(f"'{pair}' is not a setting.", f"Enter KEY=VALUE. Keys: {', '.join(_READERS)}.")
        values[key] = _READERS[key](key, value)
    return values


def dressed(design: Design, lines: Sequence[Line], requests: Sequence[str]) -> Design:
    """Return a design with the ``lines`` worn as requested: NAME=LENGTH each. Raises LineError."""
    for request in requests:
        name, equals, text = request.partition("=")
        line = next((line for line in lines if line.name.lower() == name.strip().lower()), None)
        if line is None or not equals:
            names = ", ".join(line.name for line in lines)
            raise LineError(f"'{request}' is not a line.", f"Enter NAME=LENGTH. Lines: {names}.")
        ratio = length_ratio(text, line.name, line.rest_length, line.whole_length)
        design = design.with_line(line.name, ratio)
    return design


WANT_HELP = (
    "target value in mm (also cm, in); may be repeated. If targets conflict, append @high or "
    "@low (lift=12mm@high) for four times or a quarter of the weight. lift, out: upward and "
    "forward movement of the bust points from the original body; apex: the same for the "
    "foremost point of the breast; girth: girth at bust point height; left higher, left "
    "further out: difference of left and right. Names: lift, lift left, lift right, out, out "
    "left, out right, apex lift, apex lift left, apex lift right, apex out, apex out left, "
    "apex out right, girth, left higher, left further out"
)
"""What a user has to know to ask for a result."""

PROFILE_HELP = (
    "target profile of the skin in a section, fitted by least squares: a table with the "
    "columns height_mm and out_mm, or an exported section. SECTION is left (default) or "
    "right, through that bust point, or x in mm; may be repeated, with optional priority: "
    "left@high=FILE.csv"
)
"""What a user has to know to ask for a profile."""

PRESSURE_HELP = (
    "maximum contact pressure of lines with an elastic in kPa (default: the upper limit of "
    "the rating), or off"
)
"""What a user has to know of the limit that is kept while asking."""

OPTIONAL_HELP = (
    "an inactive line that may be activated if the active lines do not reach the targets, or "
    "all; may be repeated"
)
"""What a user has to know of lines that may be switched on."""

ELASTIC_HELP = (
    "elastic of an active line: an elastic of the library, by name or unique words "
    "('mid-bust=plush 12'), or a measured table ('mid-bust=roll.csv'). The line length is "
    "then the unstretched length of the elastic. An unknown name prints all names"
)
"""What a user has to know to choose an elastic."""


def made_of(design: Design, requests: Sequence[str]) -> Design:
    """Return a design with lines made of elastics as requested: LINE=ELASTIC each. Raises LineError."""
    for request in requests:
        name, equals, elastic = (part.strip() for part in request.partition("="))
        line = next((each for each in design.worn() if each.lower() == name.lower()), None)
        if line is None or not equals:
            worn = ", ".join(sorted(design.worn())) or "none"
            raise LineError(
                f"'{request}' is not an active line.", f"Enter LINE=ELASTIC. Active lines: {worn}."
            )
        chosen = read_elastic(Path(elastic)) if elastic.lower().endswith(".csv") else find_elastic(elastic)
        design = design.with_elastic(line, chosen)
    return design


def help_text() -> str:
    """Return the keys with what each takes, for a command's help."""
    numbers = f"{', '.join(NUMBERS)} (a number; firm_chest also on, off; gain also auto)"
    words = [f"{key} ({', '.join(choices)})" for key, choices in WORDS.items()]
    return ", ".join([numbers, *words, *(f"{key} (yes, no)" for key in SWITCHES)])


def _word(key: str, value: str) -> str:
    plain = value.replace("_", "-").replace(" ", "-")
    if plain not in WORDS[key]:
        raise UserError(f"'{value}' is not a value of {key}.", f"Choose one of: {', '.join(WORDS[key])}.")
    return plain


def _number(key: str, value: str) -> float:
    try:
        return float(value.replace(",", "."))
    except ValueError:
        raise UserError(f"The {key} '{value}' is not a number.", f"Enter for example {key}=1.5.") from None


def _gain(key: str, value: str) -> float | None:
    return None if value == "auto" else _number(key, value)


def _firm_chest(key: str, value: str) -> float:
    return _FIRM[value] if value in _FIRM else _number(key, value)


def _switch(key: str, value: str) -> bool:
    if value not in _ON:
        raise UserError(f"'{value}' is not a value of {key}.", "Choose one of: yes, no.")
    return _ON[value]


_READERS: dict[str, Callable[[str, str], Any]] = {
    **dict.fromkeys(WORDS, _word),
    **dict.fromkeys(NUMBERS, _number),
    **dict.fromkeys(SWITCHES, _switch),
    "gain": _gain,
    "firm_chest": _firm_chest,
}
