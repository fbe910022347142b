"""The commands on README.md and docs/: finding and running them."""

from __future__ import annotations

import contextlib
import io
import re
import shlex
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from coarse_bodies import coarse_body
from graded_runs import made_rows, write_run

from app.cli.main import main
from app.presenters.samples import sample_design
from core.document.document import Document
from core.document.storage.project_file import read_scan_file, save_project

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]

CODE = re.compile(r"^```.*?^```", re.DOTALL | re.MULTILINE)
INLINE = re.compile(r"(?<!`)`busk ([a-z][^`]*)`")
PLACEHOLDER = re.compile(r"\b(?:DIR|FOLDER|FILE|COMMAND|LINE|NAME)\b")
"""What stands for something of the reader's: such a command is parsed alone."""

SCANS = {"scan": "mannequin", "worn": "person", "trunk": "trunk"}
"""Scans that pages name, and the samples that stand for them."""

VARIANTS = ("Soft bra", "Underwired bra")
"""Designs of the results of a run that pages name."""


def commands_of(path: Path) -> Iterator[str]:
    """Yield the commands that a page shows on lines of their own."""
    yield from re.findall(r"(?m)^    +(busk .*)$", CODE.sub("", path.read_text("utf-8")))


def inline_of(path: Path) -> Iterator[str]:
    """Yield what follows busk in running text, as ``cut --keep-fit``."""
    yield from INLINE.findall(CODE.sub("", path.read_text("utf-8")))


def words_of(command: str) -> list[str]:
    """Split a command as a shell does, without ``busk`` and its comment."""
    return shlex.split(command, comments=True)[1:]


def furnish(folder: Path) -> None:
    """Put the scans, on few vertices, the project and the results that pages name into an empty folder."""
    for name, sample in SCANS.items():
        coarse_body(sample, folder).rename(folder / f"{name}.ply")
    design = replace(sample_design().with_line("mid-bust", 0.95), volume="exact")
    design = replace(design, scan=replace(design.scan, path=str(folder / "scan.ply")))
    save_project(folder / "design.busk", Document.single(design), read_scan_file(design.scan), b"")
    rows = [row for name in VARIANTS for row in made_rows(12, variant=name)]
    write_run(folder / "results", rows, VARIANTS)


def run(command: str) -> tuple[int, str]:
    """Run a command in the current folder; return its exit code and what it prints."""
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
        code = main(words_of(command))
    return code, printed.getvalue()
