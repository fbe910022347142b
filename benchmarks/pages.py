"""Measured tables in the pages of docs/: what stands between two marks of a page is replaced."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path

DOCS = Path(__file__).parents[1] / "docs"
MARKED = "<!-- {0} -->\n{1}<!-- end of {0} -->\n"


def put(page: str, name: str, text: str) -> None:
    """Put ``text`` between the marks ``name`` of a page of docs/."""
    path = DOCS / page
    told = MARKED.format(name, f"\n{text}\n\n")
    whole, changes = re.subn(
        MARKED.format(name, "(?s:.*?)"), lambda _: told, path.read_text(encoding="utf-8")
    )
    assert changes == 1, f"{page} has no place for {name}"
    path.write_text(whole, encoding="utf-8")


def table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table in Markdown."""
    told = ["| " + " | ".join(line) + " |" for line in (heads, *rows)]
    return "\n".join([told[0], "|" + "---|" * len(heads), *told[1:]]).replace("|  |", "| |")
