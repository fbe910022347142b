"""Labels that pages set in single emphasis exist in the window, in both languages."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import pytest
from page_commands import PAGES, ROOT

from app.i18n.catalog import tr_context, translations, using_language
from app.presenters.messages import elastic_kind, preset_title
from app.presenters.samples import SAMPLES
from core.garment.elastic_library import built_in as elastics
from core.garment.presets import built_in as presets

CODE = re.compile(r"^```.*?^```|`[^`\n]*`", re.DOTALL | re.MULTILINE)
LABEL = re.compile(r"(?<![*\w])\*(\w[^*]*)\*(?!\*)")
OTHERS = ("contributors", "changes", "licences")
"""Pages whose emphasis is none of a label."""

LABELLED = [path for path in PAGES if not any(other in path.as_posix() for other in OTHERS)]


def labels_of(path: Path) -> list[str]:
    """Return the labels that a page quotes, those of a path through menus one by one."""
    quoted = LABEL.findall(CODE.sub("", path.read_text("utf-8")))
    return [label for each in quoted for label in " ".join(each.split()).split(" > ")]


@cache
def labels_in_window(language: str) -> set[str]:
    """Return the texts of the window, and the names of presets, elastics and samples."""
    pairs = [(english, forms[0]) for (_, english), forms in translations("ja").items()]
    with using_language(language):
        names = {preset_title(each) for each in presets()} | {elastic_kind(each.name) for each in elastics()}
        names |= {tr_context("sample", title) for title in SAMPLES.values()}
    return {pair[language != "en"].replace("\n", "") for pair in pairs} | names


@pytest.mark.parametrize("path", LABELLED, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_quoted_labels_are_in_the_window(path: Path) -> None:
    language = "ja" if "ja" in path.relative_to(ROOT).parts else "en"
    assert [each for each in labels_of(path) if each not in labels_in_window(language)] == []


def test_labels_are_found_in_lists_tables_and_menu_paths() -> None:
    found = LABEL.findall("| *Set* | **bold** |\n- *File > Open*, 2 * 3 * 4")
    assert found == ["Set", "File > Open"]
