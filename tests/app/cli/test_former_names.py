"""Former names of commands and options are accepted, and no help shows them."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.cli.main import BAD_INPUT, main
from app.cli.parser import (
    COMMANDS,
    FORMER_COMMANDS,
    FORMER_OPTIONS,
    command_options,
    command_parser,
    window_parser,
)

VALUES = {"--iterations": "7", "--target": "lift=1mm", "--custom": "Ribs=girth:900"}
PLACES = {"controls": ["--out", " "], "export": ["gone.ply", "--body", "a.glb"]}


def takes(command: str, option: str) -> bool:
    return option in command_parser(command)._option_string_actions


@pytest.mark.parametrize("former", FORMER_COMMANDS)
def test_a_former_command_runs_the_present_one(
    former: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    present = FORMER_COMMANDS[former]
    words = PLACES.get(present, ["gone.ply", *(["--target", "lift=1mm"] if present == "target" else [])])
    errors = []
    for command in (former, present):
        assert main([command, *words]) == BAD_INPUT
        errors.append(capsys.readouterr().err)
    assert errors[0] == errors[1] != ""


@pytest.mark.parametrize("former", FORMER_OPTIONS)
def test_a_former_option_sets_the_present_one(former: str) -> None:
    present = FORMER_OPTIONS[former]
    commands = [command for command in COMMANDS if takes(command, present)]
    assert commands
    for command in commands:
        action = command_parser(command)._option_string_actions[present]
        place = ["a.ply"] if command not in ("figures", "controls", "demo", "self-test") else []
        needed = [] if not takes(command, "--out") else ["--out", "a"]
        value = [VALUES.get(present, "a")] if action.nargs != 0 else []
        old, new = (command_options(command, [*place, name, *value, *needed]) for name in (former, present))
        assert old == new
        assert getattr(new, action.dest) != action.default


def test_no_help_shows_a_former_name() -> None:
    listed = window_parser().format_help()
    assert not [former for former in FORMER_COMMANDS if f"busk {former} " in listed]
    shown = {option for command in COMMANDS for option in command_parser(command)._option_string_actions}
    assert not {former for former in FORMER_OPTIONS if former in shown}
