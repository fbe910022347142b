"""What the guide quotes from the screen stands there, in both languages; it keeps to docs/words.md."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import pytest

from app.i18n.catalog import read_words, say, speaking, tr
from app.presenters.elastics import kind_title
from app.presenters.model_options import Choice, groups
from app.presenters.samples import SAMPLES
from core.document.presets import built_in as presets
from core.garment.elastic_library import built_in as elastics
from tests.app.i18n.test_words import asked_words
from tests.documentation.test_word_list import refused

DOCS = Path(__file__).parents[2] / "docs"
PAGES = ("first.md", "screens.md")
PAIRS = [(language, name) for language in ("en", "ja") for name in PAGES]


def page_of(language: str, name: str) -> str:
    return (DOCS / ("" if language == "en" else language) / name).read_text("utf-8")


def quoted(text: str) -> list[str]:
    """What stands in bold, which on these pages is what stands on the screen."""
    return re.findall(r"\*\*(.+?)\*\*", text)


@cache
def on_the_screen(language: str) -> set[str]:
    """The words of the window, the names of presets, of kinds of elastic and of samples."""
    table = read_words("ja")
    words = {word if language == "en" else table[word] for word in asked_words()}
    with speaking(language):
        names = {say(each.title) for each in presets()} | {kind_title(each) for each in elastics()}
        names |= {tr(title) for title in SAMPLES.values()}
    # A label may be set in lines of its own.
    return {word.replace("\n", "") for word in words | names}


@pytest.mark.parametrize(("language", "name"), PAIRS)
def test_what_is_quoted_from_the_screen_stands_there(language: str, name: str) -> None:
    found, there = quoted(page_of(language, name)), on_the_screen(language)
    assert len(found) > 20
    assert [each for each in found if each not in there] == []


@pytest.mark.parametrize("name", PAGES)
def test_both_languages_quote_the_same(name: str) -> None:
    """A step or a label that one of the pages lacks is seen here; order and repetition are free."""
    table = read_words("ja")
    with speaking("ja"):
        names = {each.title: say(each.title) for each in presets()}
        kinds = {each.name: kind_title(each) for each in elastics()}
    with speaking("en"):
        kinds = {kind_title(each): kinds[each.name] for each in elastics()}
    table = table | names | kinds
    english = {table[each] for each in quoted(page_of("en", name))}
    assert english ^ set(quoted(page_of("ja", name))) == set()


@pytest.mark.parametrize("name", PAGES)
def test_both_languages_show_the_same_pictures_in_the_same_order(name: str) -> None:
    shown = [
        [Path(place).name for place in re.findall(r"!\[.*?\]\((.+?)\)", page_of(language, name))]
        for language in ("en", "ja")
    ]
    same = [each for each in shown[0] if each != "vibrating.png"]
    assert same == shown[1]


@pytest.mark.parametrize("name", [*PAGES, "index.md"])
def test_the_japanese_guide_keeps_to_the_list_of_words(name: str) -> None:
    text = page_of("ja", name)
    wrong = {english: re.findall(pattern, text) for english, pattern in refused()}
    assert {english: found for english, found in wrong.items() if found} == {}
    assert not re.search(r"[ぁ-んァ-ヶ一-龥][,?!]", text), "commas and question marks are full-width"


def test_the_guide_names_the_choices_of_the_model_as_the_window_does() -> None:
    rows = [line for line in page_of("en", "guide.md").splitlines() if line.startswith("| ")]
    unnamed = []
    for _, settings in groups():
        for setting in settings:
            key = "`--volume`" if setting.key == "volume" else f"`{setting.key}`"
            row = next((each for each in rows if key in each), "")
            words = [title for _, title in setting.options] if isinstance(setting, Choice) else []
            unnamed += [each for each in words if f"**{each}**" not in row]
            unnamed += [setting.title] if setting.title not in row else []
    assert unnamed == []


@pytest.mark.parametrize("heading", ["Five ways to treat the volume", "Choices of the model"])
def test_the_method_calls_its_choices_as_the_window_does(heading: str) -> None:
    section = page_of("en", "method.md").partition(f"## {heading}\n")[2].partition("\n## ")[0]
    table = "\n".join(line for line in section.splitlines() if line.startswith("| "))
    named = [each for each in quoted(table) if "vibrates" not in each]
    assert len(named) > 4
    assert [each for each in named if each not in on_the_screen("en")] == []
