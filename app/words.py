"""The words of the window: English in the code, other languages in ``resources/words``."""

from __future__ import annotations

import json
from importlib import resources

LANGUAGES = {"en": "English", "ja": "日本語"}
"""The languages that can be chosen, by code, each in its own words."""

_table: dict[str, str] = {}


def use_language(code: str) -> None:
    """Set the language of all words asked for from now on; an unknown one leaves English.

    Call it once, before the first widget is built: a widget keeps the words it was built with.
    """
    _table.clear()
    if code in LANGUAGES and code != "en":
        _table.update(read_words(code))


def read_words(code: str) -> dict[str, str]:
    """Return the table of one language, English to translated."""
    text = (resources.files("resources") / "words" / f"{code}.json").read_text(encoding="utf-8")
    table: dict[str, str] = json.loads(text)
    return table


def tr(english: str) -> str:
    """Return ``english`` in the language of the window, or as it is where no translation is known."""
    return _table.get(english, english)


def number(value: float, digits: int = 1, signed: bool = False) -> str:
    """Return ``value`` with thousands commas and a real minus sign; ``signed`` writes the plus too."""
    text = f"{value:{'+' if signed else ''},.{digits}f}"
    if not text.strip("+-0.,"):
        text = text.lstrip("+-")
    return text.replace("-", "\N{MINUS SIGN}")
