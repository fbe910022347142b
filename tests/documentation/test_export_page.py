"""docs/export.md: its commands run in order and print what stands below them."""

import re
import shlex
from pathlib import Path

import pytest
from pages_alike import alike

from app.cli.main import main

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs/export.md").read_text("utf-8")
EXAMPLES = re.findall(r"```sh\n(.*?)```\s+```text\n(.*?)```", PAGE, re.DOTALL)


def test_no_command_stands_without_what_it_prints():
    assert PAGE.count("busk export resources") == sum(said.count("busk export") for said, _ in EXAMPLES) == 6


@pytest.mark.parametrize(("commands", "said"), EXAMPLES)
def test_a_command_prints_what_stands_below_it(tmp_path, monkeypatch, capsys, commands, said):
    monkeypatch.chdir(tmp_path)
    for command in commands.replace("\\\n", "").splitlines():
        words = [str(ROOT / word) if word.startswith("resources/") else word for word in shlex.split(command)]
        main(words[1:])
    printed = capsys.readouterr()
    assert alike(said, printed.out + printed.err), printed.out + printed.err
