"""The commands on README.md and docs/: finding them, running them, and comparing what they print."""

from __future__ import annotations

import argparse
import contextlib
import io
import json
import os
import re
import shlex
import shutil
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from app.cli.main import main
from app.cli.parser import COMMANDS, command_parser
from app.presenters.samples import sample_design
from core.document.custom_measures import OwnMeasure
from core.document.document import Document
from core.document.storage.project_file import read_scan_file, save_project

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]

FENCE = re.compile(r"```(?P<kind>\w*)\n(?P<body>.*?)```(?:\n+```text\n(?P<said>.*?)```)?", re.DOTALL)
INLINE = re.compile(r"(?<!`)`busk ([a-z][^`]*)`")
SHELL = ("busk", "ls", "head", "echo")
"""What can be run: Busk, and what shows what it wrote and how it ended."""

SHELLS = ("", "sh", "bash", "console")
"""How a frame with commands is marked on a page."""

LENGTHY = ("calibrate", "demo", "figures", "self-test", "spread", "sweep")
"""Commands that take long: only what a page says of them is parsed, but for sweep --quick."""

PLACEHOLDER = re.compile(r"\b(?:DIR|FOLDER|BODIES|MADE|SCAN|PROJECT|FILE|KEY=VALUE|COMMAND)\b|=\.\.\.")
"""What stands for something of the reader's: such a command is parsed alone."""

LONG_MARK = "<!-- takes long -->\n"
"""Stands before an example that is run when the page is refreshed, not by the test."""

NUMBER = re.compile(r"(?<![\w.])[+-]?\d+(?:\.\d+)?")
TIMES = re.compile(r"\d+(?:\.\d+)? s\b")
VERSION = re.compile(r"\b(busk) \d+\.\d+\.\d+\S*", re.IGNORECASE)


@dataclass(frozen=True)
class Example:
    """Commands that stand together on a page, and what the page says they print, None if nothing.

    ``span`` is where that stands in the text of the page; ``long`` is one that no test runs.
    """

    page: str
    commands: tuple[str, ...]
    said: str | None = None
    long: bool = False
    span: tuple[int, int] = (0, 0)

    def __str__(self) -> str:
        return f"{self.page}: {self.commands[0]}"


def examples_of(path: Path) -> Iterator[Example]:
    """Yield all commands of a page, those that are fenced before those that are indented."""
    page = path.read_text(encoding="utf-8")
    name = path.relative_to(ROOT).as_posix()
    for fence in FENCE.finditer(page):
        said = fence["said"] if fence["kind"] == "sh" else None
        commands = tuple(_commands(fence["body"]))
        if commands and fence["kind"] in SHELLS:
            yield Example(name, commands, said, page[: fence.start()].endswith(LONG_MARK), fence.span("said"))
    for line in _commands("\n".join(re.findall(r"(?m)^    +(busk .*)$", FENCE.sub("", page)))):
        yield Example(name, (line,))


def inline_of(path: Path) -> Iterator[str]:
    """Yield what follows busk in running text, as ``cut --as-worn``."""
    yield from INLINE.findall(FENCE.sub("", path.read_text(encoding="utf-8")))


def _commands(block: str) -> Iterator[str]:
    for line in re.sub(r"\\\n\s*", "", block).splitlines():
        told = line.removeprefix("$ ")
        if told.split(" ")[0] in SHELL:
            yield told


def words_of(command: str) -> list[str]:
    """Split a command as a shell does, without its comment."""
    return shlex.split(command, comments=True)


def runs(example: Example) -> bool:
    """Tell whether a test runs an example: it takes no long, and names what is there."""
    for command in example.commands:
        words = words_of(command)
        lengthy = words[1:2] and words[1] in LENGTHY and "--quick" not in words
        if lengthy or PLACEHOLDER.search(command.partition(" #")[0]):
            return False
    return not example.long


def furnish(folder: Path) -> None:
    """Put into an empty folder what the pages call by name: scans, projects, bodies with known answers."""
    samples = ROOT / "resources" / "samples"
    (folder / "resources").symlink_to(ROOT / "resources", target_is_directory=True)
    for name, source in (("scan", "mannequin"), ("mannequin", "mannequin"), ("person", "person")):
        shutil.copy(samples / f"{source}.ply", folder / f"{name}.ply")
    design = sample_design().with_line("mid-bust", 0.95)
    measured = design.with_own_measure(
        OwnMeasure("Gore", "straight", ("bust_point_left", "bust_point_right"))
    )
    for name, each in (("design", design), ("anna", measured)):
        document = Document.of(replace(each, volume="exact"))
        save_project(folder / f"{name}.busk", document, read_scan_file(each.scan), b"")
    truths = json.loads((ROOT / "tests/data/truth.json").read_text(encoding="utf-8"))
    (folder / "bodies").mkdir()
    shutil.copy(samples / "mannequin.ply", folder / "bodies")
    bodies = {"bodies": {"mannequin": {"file": "mannequin.ply", **truths["mannequin"]}}}
    (folder / "bodies" / "truth.json").write_text(json.dumps(bodies), encoding="utf-8")


def run(example: Example) -> tuple[str, int]:
    """Run an example in the folder that is current; return all that it prints and its last exit code."""
    told = io.StringIO()
    code = 0
    with contextlib.redirect_stdout(told), contextlib.redirect_stderr(told):
        for command in example.commands:
            tool, *words = words_of(command)
            if tool == "busk":
                code = _busk(words)
            else:
                print(*_shown(tool, words, code), sep="\n")
    # A terminal shows what stands behind the last return of a line.
    return re.sub(r"(?m)^[^\n]*\r(?=[^\n])", "", told.getvalue()).replace("\r", ""), code


def _busk(words: list[str]) -> int:
    try:
        return main(words)
    except SystemExit as ended:  # what --help and --version do
        return int(ended.code or 0)


def _shown(tool: str, words: list[str], code: int) -> list[str]:
    if tool == "ls":
        place = Path(words[0])
        return sorted(os.listdir(place)) if place.is_dir() else [str(place.relative_to("."))]
    if tool == "head":
        count, file = words
        return Path(file).read_text(encoding="utf-8-sig").splitlines()[: int(count.removeprefix("-"))]
    assert words == ["$?"], f"echo is for $? alone, not for {words}"
    return [str(code)]


def options() -> Iterator[tuple[str, str, str]]:
    """Yield every option with the commands that take it and what it does, as the program's own help says."""
    of: dict[tuple[str, str], list[str]] = {}
    for command in COMMANDS:
        for each in command_parser(command)._actions:
            if each.option_strings and each.dest != "help":
                of.setdefault(_option(each), []).append(command)
    for (option, help_), commands in of.items():
        yield f"`{option}`", ", ".join(commands), help_


def _option(action: argparse.Action) -> tuple[str, str]:
    choices = "|".join(action.choices or ())
    value = f" {action.metavar or choices}".rstrip() if action.nargs != 0 else ""
    more = " ..." if isinstance(action, argparse._AppendAction) else ""
    told = (action.help or "").replace("%%", "%").replace("|", "\\|")
    return f"{action.option_strings[0]}{value}{more}".replace("|", "\\|"), told


def agrees(said: str, printed: str) -> bool:
    """Tell whether a page says what is printed: a line of dots stands for any lines."""
    head, dots, tail = _parts(said)
    lines = printed.splitlines()
    if not dots:
        return _alike(head, lines)
    room = len(lines) - len(head) - len(tail)
    return room > 0 and _alike(head, lines[: len(head)]) and _alike(tail, lines[len(head) + room :])


def shortened(said: str, printed: str) -> str:
    """Return what is printed with dots where the page has them."""
    head, dots, tail = _parts(said)
    lines = printed.splitlines()
    if dots:
        lines = [*lines[: len(head)], "...", *lines[len(lines) - len(tail) :]]
    return "".join(f"{line.rstrip()}\n" for line in lines)


def _parts(said: str) -> tuple[list[str], bool, list[str]]:
    lines = said.splitlines()
    if "..." not in lines:
        return lines, False, []
    at = lines.index("...")
    return lines[:at], True, lines[at + 1 :]


def _alike(said: list[str], printed: list[str]) -> bool:
    """Tell whether lines agree but for times, versions and the last digit of numbers."""
    return len(said) == len(printed) and all(map(_same, said, printed))


def _same(said: str, printed: str) -> bool:
    said, printed = (VERSION.sub(r"\1", TIMES.sub("# s", each)) for each in (said, printed))
    if NUMBER.sub("#", said).split() != NUMBER.sub("#", printed).split():
        return False
    return all(map(_near, NUMBER.findall(said), NUMBER.findall(printed)))


def _near(said: str, printed: str) -> bool:
    """Tell whether two numbers agree to one in the last digit; of more than six digits, to 0.001."""
    digits = len(said.partition(".")[2])
    room = 1.5 * 10.0**-digits if 0 < digits <= 6 else 0.001
    return abs(float(said) - float(printed)) <= room
