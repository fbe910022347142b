"""English sentences of files in the language and the unit in use, as far as the catalogue has them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache, lru_cache

from app.i18n.catalog import language, translations
from app.i18n.lengths import length, length_unit
from app.presenters.messages import line_title
from core.messages import (
    ElasticName,
    LandmarkName,
    PieceName,
    SeamName,
    SettingName,
    SideName,
)

_FIELD = re.compile(r"\{(\w+)\}")
_BETWEEN = re.compile(r"(?<=[.!?])\s+")
_LENGTH = re.compile(r"(?<![\d.])(\d+(?:\.(\d+))?) mm\b")
_NAMES = (LandmarkName, SideName, PieceName, SeamName, SettingName, ElasticName)
_PART = r"(?:(?![.!?]\s).)+?"  # of one sentence
_LEAST = 8  # letters without parameters, fewer would match anything


@dataclass(frozen=True)
class _Sentence:
    """A text of the catalogue, with an expression for all that it may be filled with."""

    english: str
    filled: re.Pattern[str]

    @property
    def letters(self) -> int:
        return len(_FIELD.sub("", self.english))


def shown_text(english: str) -> str:
    """Return sentences in the language and the unit in use; those that are not in the catalogue stay.

    They are found by what their texts have in common, the longest first, with names and lengths in them.
    """
    return _shown(english, language(), length_unit())


@lru_cache(maxsize=4096)
def _shown(english: str, code: str, unit: str) -> str:
    if code == "en":
        return _with_unit(english)
    parts, result = _BETWEEN.split(english), ""
    while parts:
        for count in range(len(parts), 0, -1):
            found = _translated(" ".join(parts[:count]), code)
            if found is not None or count == 1:
                result += " " if result.endswith((".", "!", "?")) else ""  # after one that stays English
                result += found if found is not None else _with_unit(parts[0])
                parts = parts[count:]
                break
    return result


def _translated(text: str, code: str) -> str | None:
    """Return one text of the catalogue in the language, None if it is not there."""
    exact = translations(code).get(("", text))
    if exact and exact[0]:
        return _with_unit(exact[0])
    for sentence in _sentences(code):
        match = sentence.filled.fullmatch(text)
        if match is not None:
            values = {name: _value(each, code) for name, each in match.groupdict().items()}
            return _with_unit(translations(code)["", sentence.english][0].format_map(values))
    return None


def _value(text: str, code: str) -> str:
    """Return what fills a sentence: a name or a sentence of the catalogue, else the text itself."""
    title = line_title(text)
    if title.lower().replace("-", " ") != text.lower().replace("-", " "):
        return title
    for kind in _NAMES:
        known = translations(code).get((kind.context, text))
        if known and known[0]:
            return known[0]
    return _shown(text, code, length_unit()) if text.endswith(".") else text


def _with_unit(text: str) -> str:
    """Return a text with its lengths in the unit in use."""
    if length_unit() == "mm":
        return text
    return _LENGTH.sub(lambda found: length(float(found[1]), len(found[2] or "")), text)


@cache
def _sentences(code: str) -> list[_Sentence]:
    """Return the texts with parameters, those with most letters of their own first."""
    return sorted(_with_fields(code), key=lambda each: -each.letters)


def _with_fields(code: str) -> Iterator[_Sentence]:
    for (context, english), forms in translations(code).items():
        if not context and forms[0] and len(forms) == 1 and _FIELD.search(english):
            pieces, seen, pattern = _FIELD.split(english), set[str](), ""
            for place, piece in enumerate(pieces):
                if place % 2 == 0:
                    pattern += re.escape(piece)
                else:
                    pattern += f"(?P={piece})" if piece in seen else f"(?P<{piece}>{_PART})"
                    seen.add(piece)
            sentence = _Sentence(english, re.compile(pattern, re.DOTALL))
            if sentence.letters >= _LEAST:
                yield sentence
