"""The words of the window: English in the code, other languages in ``resources/words``."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from functools import cache, lru_cache
from importlib import resources

from app.i18n.lengths import length_unit, with_lengths
from app.i18n.numerals import number as number  # noqa: PLC0414 - lengths, which words need, write numbers too

LANGUAGES = {"en": "English", "ja": "日本語"}
"""The languages that can be chosen, by code, each in its own words."""

_code = "en"
_JOINER = "\N{WORD JOINER}"
_END = re.compile(r"[\u3001-\u30ff\u4e00-\u9fff\uff09]{2,4}$", re.MULTILINE)  # kana, kanji, their marks
_SENTENCE_END = re.compile(r"(?<=[.?!]) (?=[A-Z'])")


def use_language(code: str) -> None:
    """Set the language of all words asked for from now on; an unknown one leaves English.

    Call it once, before the first widget is built: a widget keeps the words it was built with.
    """
    global _code  # noqa: PLW0603 - one language at a time
    _code = code if code in LANGUAGES else "en"


@contextmanager
def speaking(code: str) -> Iterator[None]:
    """Ask for words of another language meanwhile: of a sheet that is for somebody else than the window."""
    before = _code
    use_language(code)
    try:
        yield
    finally:
        use_language(before)


def language() -> str:
    """Return the code of the language in use, for texts that bring their own words."""
    return _code


@cache
def read_words(name: str) -> dict[str, str]:
    """Return one table of ``resources/words``, English to translated."""
    text = (resources.files("resources") / "words" / f"{name}.json").read_text(encoding="utf-8")
    table: dict[str, str] = json.loads(text)
    return table


def tr(english: str) -> str:
    """Return ``english`` in the language of the window, or as it is where no translation is known."""
    return _table(_code).get(english, english)


def say(english: str, unit: str = "") -> str:
    """Return what the core says in the language of the window.

    ``english`` is one or more sentences with names and numbers filled in; one that no pattern fits stays.
    Lengths in millimetres get the unit in use; with "mm", as in files, they stay.
    """
    return _said(_code, unit or length_unit(), english)


@lru_cache(4096)  # the same is said again and again, and hundreds of patterns are tried for each
def _said(code: str, unit: str, english: str) -> str:
    messages = _messages(code, unit)
    for pattern, translated in messages:
        match = pattern.fullmatch(english)
        if match:
            places = match.groupdict()
            template, places = (translated, places) if unit == "mm" else with_lengths(translated, places)
            return template.format(**{name: _said(code, unit, value) for name, value in places.items()})
    sentences = _SENTENCE_END.split(english) if messages else [english]
    if len(sentences) > 1:
        return ("" if code == "ja" else " ").join(_said(code, unit, each) for each in sentences)
    # A sentence that begins with the name of a line; a name of a file, with its dot, stays as it is.
    begins_small = english.endswith((".", "?")) and re.match(r"[a-z][a-z-]* ", english)
    return english[0].upper() + english[1:] if begins_small else english


def in_all_languages(shown: str) -> list[str]:
    """Return words of the window as they are shown, and as they are in every other language."""
    english = next((text for text, translated in _table(_code).items() if translated == shown), shown)
    others = (read_words(code).get(english) for code in LANGUAGES if code != "en")
    return [shown, english, *(other for other in others if other)]


@cache
def _table(code: str) -> dict[str, str]:
    return {} if code == "en" else read_words(code)


@cache
def _messages(code: str, unit: str) -> list[tuple[re.Pattern[str], str]]:
    """Return what the core may say, as patterns with their translations; none if it stays as it is."""
    if code == "en":  # which numbers are lengths is read off the patterns, which every other language has
        messages = {} if unit == "mm" else {english: english for english in read_words("ja_messages")}
    else:
        messages = read_words(f"{code}_messages")
    # The more words a pattern holds, the surer its match: the longest is tried first.
    longest = sorted(messages, key=lambda text: -len(re.sub(r"\{\w*\}", "", text)))
    return [(_pattern(english), messages[english]) for english in longest]


def _pattern(english: str) -> re.Pattern[str]:
    """Return what a message looks like with its places filled."""
    return re.compile(re.sub(r"\\\{(\w+)\\\}", r"(?P<\1>.+)", re.escape(english)), re.DOTALL)


def listed(names: Iterable[str]) -> str:
    """Return names one after the other, as the language in use parts them."""
    return ("、" if _code == "ja" else ", ").join(names)


def colon() -> str:
    """Return a colon as the language in use writes it, with the room after it."""
    return "：" if _code == "ja" else ": "


def joined(sentences: Iterable[str]) -> str:
    """Return sentences one after the other, those that are empty left out."""
    return ("" if _code == "ja" else " ").join(filter(None, sentences))


def held_together(text: str) -> str:
    """Return text whose paragraphs never end in a line of a letter or two, where any two letters may part."""
    return _END.sub(lambda end: _JOINER.join(end[0]), text)


def let_apart(text: str) -> str:
    """Return text that was ``held_together`` as it was."""
    return text.replace(_JOINER, "")
