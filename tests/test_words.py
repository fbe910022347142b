"""The words of the window: complete in every language, and made of letters that the shipped type has."""

from __future__ import annotations

import ast
import re
import struct
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.words import LANGUAGES, number, read_words, tr, use_language

ROOT = Path(__file__).parent.parent
TRANSLATIONS = [code for code in LANGUAGES if code != "en"]


@pytest.fixture(autouse=True)
def english() -> Iterator[None]:
    yield
    use_language("en")


def asked_words() -> set[str]:
    """Return every literal that the program asks a translation for."""
    calls = (
        node
        for path in (ROOT / "app").rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "tr"
    )
    return {
        each.value
        for call in calls
        for each in ast.walk(call.args[0])
        if isinstance(each, ast.Constant) and isinstance(each.value, str)
    }


def places(text: str) -> list[str]:
    return sorted(re.findall(r"\{(\w*)", text))


@pytest.mark.parametrize("code", TRANSLATIONS)
def test_every_word_is_translated(code: str) -> None:
    asked = asked_words()
    assert len(asked) > 50
    assert sorted(asked - read_words(code).keys()) == []


@pytest.mark.parametrize("code", TRANSLATIONS)
def test_a_translation_has_the_same_places_to_fill(code: str) -> None:
    for english_text, translated in read_words(code).items():
        assert places(english_text) == places(translated), english_text
        assert translated.strip()


def letters_of(path: Path) -> set[int]:
    """Return the code points of a font file, from its character map of format 12 or 4."""
    data = path.read_bytes()
    tables = {data[at : at + 4]: struct.unpack(">I", data[at + 8 : at + 12])[0] for at in _records(data)}
    start = tables[b"cmap"]
    count = struct.unpack(">H", data[start + 2 : start + 4])[0]
    offsets = {
        start + struct.unpack(">I", data[at + 4 : at + 8])[0]
        for at in range(start + 4, start + 4 + 8 * count, 8)
    }
    return set().union(*(_segments(data, at) for at in offsets))


def _records(data: bytes) -> range:
    return range(12, 12 + 16 * struct.unpack(">H", data[4:6])[0], 16)


def _segments(data: bytes, at: int) -> set[int]:
    kind = struct.unpack(">H", data[at : at + 2])[0]
    if kind == 12:
        groups = struct.unpack(">I", data[at + 12 : at + 16])[0]
        ends = (struct.unpack(">II", data[at + 16 + 12 * i : at + 24 + 12 * i]) for i in range(groups))
        return {letter for first, last in ends for letter in range(first, last + 1)}
    if kind == 4:
        twice = struct.unpack(">H", data[at + 6 : at + 8])[0]
        shorts = struct.unpack(f">{twice + 1}H", data[at + 14 : at + 14 + 2 * (twice + 1)])
        ends, starts = shorts[: twice // 2], shorts[twice // 2 + 1 :]
        return {letter for a, b in zip(starts, ends, strict=True) for letter in range(a, min(b, 0xFFFE) + 1)}
    return set()


@pytest.mark.parametrize("code", TRANSLATIONS)
def test_the_shipped_type_has_every_letter(code: str) -> None:
    fonts = [path for path in (ROOT / "resources" / "fonts").iterdir() if path.suffix in (".ttf", ".otf")]
    has = set().union(*(letters_of(path) for path in fonts if "Regular" in path.stem))
    written = {letter for text in read_words(code).values() for letter in text if not letter.isspace()}
    assert sorted(letter for letter in written if ord(letter) not in has) == []


def test_language_is_chosen_once_and_unknown_words_stay() -> None:
    assert tr("Scan") == "Scan"
    use_language("ja")
    assert tr("Scan") == "スキャン"
    assert tr("no such sentence") == "no such sentence"
    use_language("xx")
    assert tr("Scan") == "Scan"


@pytest.mark.parametrize(
    ("value", "digits", "signed", "text"),
    [
        (1234.56, 1, False, "1,234.6"),
        (-0.02, 2, True, "−0.02"),
        (-0.004, 2, True, "0.00"),
        (-0.004, 2, False, "0.00"),
        (18.6, 1, True, "+18.6"),
        (0.0, 0, True, "0"),
    ],
)
def test_numbers_are_written_with_a_real_minus(value: float, digits: int, signed: bool, text: str) -> None:
    assert number(value, digits, signed) == text
