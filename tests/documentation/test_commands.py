"""README.md and docs/: every command that is shown is understood, and those that take no long are run."""

from __future__ import annotations

import contextlib
import re
from pathlib import Path

import pytest
from page_commands import PAGES, PLACEHOLDER, ROOT, commands_of, furnish, inline_of, run, words_of

from app.cli.parser import COMMANDS, command_options, command_parser, window_options
from core.errors import UserError

LENGTHY = ("batch", "calibrate", "demo", "figures", "self-test", "uncertainty", "controls")
"""Commands that take long: they are parsed alone."""

DONE = (0, 3)
"""Exit codes of a command that wrote its results, converged or not."""

SHOWN = sorted({re.sub(r"\s+#.*", "", each) for page in PAGES for each in commands_of(page)})


def parsed(words: list[str]) -> None:
    """Let the program's own parser read a command, without executing it."""
    with contextlib.suppress(SystemExit):  # --help and --version end so; an error is a UserError
        command_options(words[0], words[1:]) if words and words[0] in COMMANDS else window_options(words)


@pytest.mark.parametrize("command", SHOWN)
def test_a_shown_command_is_understood(command: str) -> None:
    parsed(words_of(command))


def test_shown_commands_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    furnish(tmp_path)
    monkeypatch.chdir(tmp_path)
    failed = {}
    for command in SHOWN:
        if words_of(command)[0] in LENGTHY or "--uncertainty" in command or PLACEHOLDER.search(command):
            continue
        code, printed = run(command)
        if code not in DONE:
            failed[command] = printed
    assert failed == {}


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_commands_in_running_text_have_known_names_and_options(path: Path) -> None:
    for told in inline_of(path):
        command, *words = told.split()
        assert command in COMMANDS, told
        known = {option for each in command_parser(command)._actions for option in each.option_strings}
        assert {word.split("=")[0] for word in words if word.startswith("--")} <= known, told


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_make_targets_and_scripts_on_pages_exist(path: Path) -> None:
    page = path.read_text("utf-8")
    targets = set(re.findall(r"(?m)^([a-z-]+):", (ROOT / "Makefile").read_text("utf-8")))
    assert set(re.findall(r"(?:`|^    )make ([a-z-]+)", page, re.M)) <= targets
    scripts = re.findall(r"python ((?:benchmarks|packaging)/\w+\.py)", page)
    assert all((ROOT / script).is_file() for script in scripts)


def test_a_renamed_option_is_an_error() -> None:
    with pytest.raises(UserError, match="--line-length"):
        parsed(words_of("busk solve scan.ply --line-length mid-bust=97% --out result"))
