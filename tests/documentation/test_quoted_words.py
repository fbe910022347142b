"""What the pages quote from the program, sentences and names of commands, stands in the program."""

from __future__ import annotations

import ast
import json
import re
from functools import cache
from pathlib import Path

import pytest
from page_commands import PAGES, ROOT

QUOTING = [ROOT / "docs" / name for name in ("trouble.md", "honest.md")]
ENGLISH = [path for path in PAGES if "ja" not in path.relative_to(ROOT).parts]

QUOTE = re.compile(r"“(.*?)”", re.DOTALL)
MENU = re.compile(r"(?<![*\w])\*([A-Z][^*\n]* > [^*\n]+)\*(?!\*)")
REFUSALS = ("ScanError", "LandmarkError", "FitError", "ProjectError")
ELSEWHERE = re.compile(
    "is not known|three numbers|places no landmark|no landmark …|placed twice|[Tt]emplate|line height"
    "|border of the control mesh"
)
"""Of refusals that the page leaves out: typed amiss on the command line, or a template of one's own."""

FILLED = "…"
"""Stands in a quotation for what the program fills in."""


@cache
def texts() -> frozenset[str]:
    """Return all texts of the program, with dots where something is filled in."""
    found = {
        text for path in (*ROOT.glob("core/**/*.py"), *ROOT.glob("app/**/*.py")) for text in literals(path)
    }
    for words in ("ja.json", "ja_messages.json"):
        found |= set(json.loads((ROOT / "resources" / "words" / words).read_text("utf-8")))
    return frozenset(re.sub(r"\{[^}]*\}", FILLED, text) for text in found)


def modules(*folders: str) -> list[Path]:
    """Return the modules in folders of the program."""
    return [path for folder in folders for path in sorted((ROOT / folder).rglob("*.py"))]


def refusals() -> set[str]:
    """Return how scans, landmarks and projects are refused, with dots where something is filled in."""
    calls = (node for path in modules("core") for node in ast.walk(ast.parse(path.read_text("utf-8"))))
    said = set()
    for call in calls:
        if isinstance(call, ast.Call) and isinstance(call.func, ast.Name) and call.func.id in REFUSALS:
            what = call.args[0]
            said.add("".join(map(_part, what.values)) if isinstance(what, ast.JoinedStr) else _part(what))
    return said


def literals(path: Path) -> set[str]:
    """Return the texts that stand in a module, but for those about the code."""
    tree = ast.parse(path.read_text("utf-8"))
    about = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    plain = {
        node.value
        for node in ast.walk(tree)
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in about
    }
    joined = (node for node in ast.walk(tree) if isinstance(node, ast.JoinedStr))
    return plain | {"".join(map(_part, node.values)) for node in joined}


def _part(value: ast.expr) -> str:
    return str(value.value) if isinstance(value, ast.Constant) else FILLED


def quoted(page: str) -> list[str]:
    """Return what a page quotes, on one line each."""
    return [" ".join(quote.split()) for quote in QUOTE.findall(page)]


def in_program(quote: str) -> bool:
    """Tell whether a quotation stands in a text of the program."""
    return any(quote in text for text in texts())


def is_command(name: str) -> bool:
    """Tell whether a menu or command has a name, with or without its key letter and dots."""
    plain = name.rstrip(FILLED)
    return any(plain == text.replace("&", "").rstrip(FILLED) for text in texts())


@pytest.mark.parametrize("path", QUOTING, ids=lambda path: path.name)
def test_every_quoted_sentence_is_one_of_the_program(path: Path) -> None:
    page = path.read_text("utf-8")
    assert page.count("“") == page.count("”") == len(quoted(page)) > 2
    assert [quote for quote in quoted(page) if not in_program(quote)] == []


@pytest.mark.parametrize("path", ENGLISH, ids=lambda path: path.name)
def test_every_way_through_a_menu_is_there(path: Path) -> None:
    ways = [way for told in MENU.findall(path.read_text("utf-8")) for way in told.split(" > ")]
    assert [name for name in ways if not is_command(name)] == []


def test_the_page_answers_every_refusal_of_a_scan_or_project() -> None:
    page = quoted((ROOT / "docs" / "trouble.md").read_text("utf-8"))
    left = {said for said in refusals() if not any(said in quote for quote in page)}
    assert {said for said in left if not ELSEWHERE.search(said)} == set()


def test_the_figures_of_what_is_measured_are_those_of_the_page_that_measures() -> None:
    honest, accuracy = (
        (ROOT / "docs" / name).read_text("utf-8").partition(f"<!-- {mark} -->")[2].partition("<!-- end")[0]
        for name, mark in (("honest.md", "measured"), ("accuracy.md", "made"))
    )
    known = [cells(line)[1:] for line in accuracy.splitlines()]
    told = [cells(line)[1:] for line in honest.splitlines() if re.search(r"\d \|", line)]
    assert len(told) > 5
    assert [figures for figures in told if figures not in known] == []


def cells(line: str) -> list[str]:
    """Return the cells of a row of a table."""
    return [cell.strip() for cell in line.strip("|").split("|")]


def test_other_words_are_not_in_the_program() -> None:
    assert in_program("… is empty.")
    assert not in_program("… is quite empty.")
    assert is_command("Open a backup")
    assert not is_command("Open a back-up")
