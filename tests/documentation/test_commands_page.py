"""README.md and docs/: every command there is one of Busk, runs, and prints what stands below it."""

from __future__ import annotations

import contextlib
import re
from pathlib import Path

import pytest
from page_commands import (
    PAGES,
    ROOT,
    Example,
    agrees,
    examples_of,
    furnish,
    inline_of,
    options,
    run,
    runs,
    words_of,
)

from app.cli.commands.self_test import PARTS
from app.cli.exit_code import SETTLED
from app.cli.parser import COMMANDS, command_options, command_parser, window_options
from core.errors import UserError

COMMANDS_PAGE = ROOT / "docs" / "commands.md"
REFRESH = "if the page is to follow: python benchmarks/commands_page.py [PAGE ...]"
ELSEWHERE = ("docs/export.md",)
"""Pages whose commands another test runs."""

names = [path.relative_to(ROOT).as_posix() for path in PAGES]


def parsed(command: str) -> None:
    """Let the program's own parser read a command, without its doing anything."""
    tool, *words = words_of(command)
    if tool == "busk":
        with contextlib.suppress(SystemExit):  # --help and --version end so; what is wrong is a UserError
            command_options(words[0], words[1:]) if words and words[0] in COMMANDS else window_options(words)


@pytest.mark.parametrize("path", PAGES, ids=names)
def test_the_program_understands_every_command(path: Path) -> None:
    for example in examples_of(path):
        for command in example.commands:
            parsed(command)
    for told in inline_of(path):
        command, *words = told.split()
        if command in COMMANDS:
            known = {option for each in command_parser(command)._actions for option in each.option_strings}
            assert {word.split("=")[0] for word in words if word.startswith("--")} <= known, told
        else:
            assert Path(command).suffix == ".busk", f"{path.name} names a command that there is not: {told}"


@pytest.mark.parametrize("path", [path for path in PAGES if any(map(runs, examples_of(path)))], ids=str)
def test_a_page_says_what_its_commands_print(
    path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if path.relative_to(ROOT).as_posix() in ELSEWHERE:
        return
    furnish(tmp_path)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "100")
    # The pages tell what is said at a terminal; on a desktop a window would open and say it.
    monkeypatch.setattr("app.cli.main.is_seen_in_window", lambda file: False)
    for example in filter(runs, examples_of(path)):
        printed, code = run(example)
        if example.said is None:
            assert code == SETTLED, f"{example}\n{printed}"
        else:
            assert agrees(example.said, printed), f"{example}\n{REFRESH}\n{printed}"


def test_the_page_shows_what_each_command_prints() -> None:
    shown = [example for example in examples_of(COMMANDS_PAGE) if example.said]
    named = {words_of(command)[1] for example in shown for command in example.commands if " " in command}
    assert set(COMMANDS) <= named


def test_the_page_has_every_option_in_the_words_of_the_program() -> None:
    page = COMMANDS_PAGE.read_text("utf-8")
    for option, of, told in options():
        assert re.search(rf"^\| {re.escape(option)} \| {of} \|\s?{re.escape(told)} ?\|$", page, re.M), (
            f"{option}: {REFRESH}"
        )
    assert page.count("\n| `--") == len(list(options()))


def test_the_page_names_every_part_of_the_self_test() -> None:
    said = next(each.said for each in examples_of(COMMANDS_PAGE) if each.commands == ("busk self-test",))
    first, *lines, last = (said or "").splitlines()
    assert [re.split(r"  +", line.strip())[0] for line in lines] == [part.name for part in PARTS[1:]], REFRESH
    assert (first, last.partition("  ")[0]) == ("...", "all is well")


@pytest.mark.parametrize("path", PAGES, ids=names)
def test_what_else_is_called_is_there(path: Path) -> None:
    page = path.read_text("utf-8")
    targets = set(re.findall(r"(?m)^([a-z-]+):", (ROOT / "Makefile").read_text("utf-8")))
    assert set(re.findall(r"(?:`|^    )make ([a-z-]+)", page, re.M)) <= targets
    scripts = re.findall(r"python ((?:benchmarks|packaging)/\w+\.py)", page)
    assert all((ROOT / script).is_file() for script in scripts)


@pytest.mark.parametrize("path", PAGES, ids=names)
def test_every_link_and_picture_leads_to_a_file(path: Path) -> None:
    links = re.findall(r"\]\(([^)#:\s]+)(?:#[^)]*)?\)", path.read_text("utf-8"))
    assert [link for link in links if not (path.parent / link).exists()] == []


def test_a_renamed_option_and_another_figure_do_not_pass() -> None:
    with pytest.raises(UserError, match="--line-length"):
        parsed("busk solve scan.ply --line-length mid-bust=97% --out result")
    assert agrees("set 363.7 mm, 12.0 s\n", "set 363.8 mm, 3.4 s\n")
    assert not agrees("set 363.7 mm\n", "set 363.9 mm\n")
    assert not agrees("after 116 turns\n", "after 117 turns\n")
    assert not agrees("settled\n", "vibrating\n")
    assert agrees("a 1.0\n...\nz 2.0\n", "a 1.0\nb\nc\nz 2.0\n")
    assert not agrees("a 1.0\n...\nz 2.0\n", "a 1.0\nz 2.0\n"), "dots stand for a line at least"
    assert not agrees("a 1.0\n...\nz 2.0\n", "a 1.0\nb\nz 3.0\n")


def test_long_examples_and_placeholders_are_only_parsed() -> None:
    assert not runs(Example("a page", ("busk figures --out figures",)))
    assert not runs(Example("a page", ("busk accuracy DIR --out FOLDER",)))
    assert runs(Example("a page", ("busk sweep --quick --out sweep",)))
