"""docs/python.md: its examples run in order and print what stands below them."""

from __future__ import annotations

import contextlib
import io
import re
from pathlib import Path
from typing import Any

import pytest
from pages_alike import alike

ROOT = Path(__file__).parents[2]


def test_every_example_prints_what_the_page_says(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    page = (ROOT / "docs/python.md").read_text("utf-8")
    examples = re.findall(r"```python\n(.*?)```(?:\n\n```text\n(.*?)```)?", page, re.DOTALL)
    assert len(examples) == page.count("```python") > 4
    names: dict[str, Any] = {}
    for code, said in examples:
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile(code, "docs/python.md", "exec"), names)
        assert alike(said, printed.getvalue()), printed.getvalue()


def test_other_words_and_other_numbers_are_not_alike() -> None:
    assert alike("Gore 107.5 mm", "Gore   107.6 mm")
    assert not alike("Gore 107.5 mm", "Gore 108.5 mm")
    assert not alike("Gore 107.5 mm", "Ribs 107.5 mm")
