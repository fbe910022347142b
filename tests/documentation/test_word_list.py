"""The words of the window in Japanese are those of docs/contributors/words.md, and no others."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from app.i18n.catalog import translations

ROOT = Path(__file__).parents[2]


def refused() -> list[tuple[str, str]]:
    """Return each English word of the list with a pattern that no Japanese sentence may hold."""
    rows = (
        line.split("|")
        for line in (ROOT / "docs/contributors/words.md").read_text(encoding="utf-8").splitlines()
    )
    found = []
    # A pattern may hold the sign that parts the columns: the last column is all that is left.
    for row in rows:
        for each in re.findall(r"`(.+?)`", "|".join(row[3:])):
            pattern = each[1:-1] if each.startswith("/") else re.escape(each)
            found.append((row[1].strip(), pattern))
    return found


def sentences() -> list[str]:
    return [text for forms in translations("ja").values() for text in forms]


def test_the_list_refuses_words() -> None:
    assert len(refused()) >= 15


@pytest.mark.parametrize(("english", "pattern"), refused())
def test_a_thing_has_one_word(english: str, pattern: str) -> None:
    wrong = [said for said in sentences() if re.search(pattern, said)]
    assert wrong == [], f"docs/contributors/words.md has another word for {english}"


@pytest.mark.parametrize("path", sorted((ROOT / "docs" / "ja").glob("*.md")), ids=lambda path: path.name)
def test_japanese_pages_use_the_same_words(path: Path) -> None:
    page = path.read_text("utf-8")
    wrong = {english: re.findall(pattern, page) for english, pattern in refused()}
    assert {english: found for english, found in wrong.items() if found} == {}
    assert not re.search(r"[ぁ-んァ-ヶ一-龥][,?!]", page), "commas and question marks are full-width"


def test_names_of_lines_and_signs_are_set_as_in_japanese() -> None:
    for said in sentences():
        assert not re.search(r"\{line\} [ぁ-ん]", said), said
        assert not re.search(r"[ぁ-んァ-ヶ一-龥}]: |[ぁ-ん]\?$", said), said
