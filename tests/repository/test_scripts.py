"""Scripts beside the program, which no other test runs, import only what there is."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SCRIPTS = sorted(path for folder in ("benchmarks", "packaging") for path in (ROOT / folder).glob("**/*.py"))


def imported(path: Path) -> Iterator[tuple[str, str]]:
    """Yield each module of the program that a script imports anywhere, with the name taken from it."""
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.ImportFrom) and not node.level:
            pairs = [(node.module or "", alias.name) for alias in node.names]
        elif isinstance(node, ast.Import):
            pairs = [(alias.name, "") for alias in node.names]
        else:
            continue
        yield from (each for each in pairs if each[0].partition(".")[0] in ("core", "app"))


def is_there(module: str, name: str) -> bool:
    """Return whether a module has a name, or is a package with a module of it."""
    try:
        found = import_module(module)
        return not name or hasattr(found, name) or find_spec(f"{module}.{name}") is not None
    except ModuleNotFoundError:
        return False


def test_names_that_are_missing_are_found() -> None:
    assert is_there("core.messages", "Message")
    assert is_there("core", "pattern")
    assert not is_there("core.messages", "Massage")
    assert not is_there("core.massages", "Message")


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_a_script_imports_only_what_there_is(path: Path) -> None:
    missing = [f"{module}.{name}" for module, name in imported(path) if not is_there(module, name)]
    assert missing == []
