"""Measured tables in RESULTS.md: what is between two marks is replaced."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path

RESULTS = Path(__file__).parent / "RESULTS.md"
MARKED = "<!-- {0} -->\n{1}<!-- end of {0} -->\n"


def put(name: str, text: str, path: Path = RESULTS) -> None:
    """Put ``text`` between the marks ``name`` of a page."""
    told = MARKED.format(name, f"\n{text}\n\n")
    whole, changes = re.subn(
        MARKED.format(name, "(?s:.*?)"), lambda _: told, path.read_text(encoding="utf-8")
    )
    assert changes == 1, f"{path.name} has no place for {name}"
    path.write_text(whole, encoding="utf-8")


def table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table in Markdown."""
    told = ["| " + " | ".join(line) + " |" for line in (heads, *rows)]
    return "\n".join([told[0], "|" + "---|" * len(heads), *told[1:]]).replace("|  |", "| |")
