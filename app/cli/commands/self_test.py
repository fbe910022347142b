"""The installed program tests itself on the sample: one line a part, exit code 0 if all is well."""

from __future__ import annotations

import tempfile
import time
from argparse import ArgumentParser, Namespace
from pathlib import Path

from app.cli.options import add_folder_output
from app.cli.output import make_folder
from app.cli.self_test import analysis_checks as advice
from app.cli.self_test import core_checks as figures
from app.cli.self_test import fonts as letters
from app.cli.self_test import installation as program
from app.cli.self_test import outputs as papers
from app.cli.self_test import window as screen
from app.cli.self_test.checks import Part, try_parts
from app.cli.self_test.fixture import Bench
from app.cli.self_test.sandbox import apart

FAILED = 1
"""The exit code if a part is not well."""

LINES = "self-test.txt"
"""The file in the folder of ``--out`` that holds the lines: without a console they have no other place."""

_SAMPLE = ("landmarks", "solver")

PARTS: tuple[Part[Bench], ...] = (
    Part("versions", program.versions),
    Part("shipped files", program.shipped_files),
    Part("guide", program.guide),
    Part("scan formats", figures.scan_formats),
    Part("landmarks", figures.landmarks),
    Part("solver", figures.solver, ("landmarks",)),
    Part("advice", advice.advice, _SAMPLE),
    Part("compiled loops", figures.compiled_loops, ("landmarks",)),
    Part("projects", figures.projects, _SAMPLE),
    Part("damaged project", figures.damaged_projects, ("projects",)),
    Part("exported files", papers.exports, _SAMPLE),
    Part("3D drawing", papers.drawing, _SAMPLE),
    Part("turntable", papers.turntable, (*_SAMPLE, "3D drawing")),
    Part("Qt", screen.toolkit),
    Part("Latin font", letters.latin, ("Qt",)),
    Part("Japanese font", letters.japanese, ("Qt",)),
    Part("report", papers.report, ("Qt", *_SAMPLE, "3D drawing")),
    Part("window", screen.window, ("Qt", "projects")),
    Part("slider", screen.slider, ("window",)),
    Part("file dialog", screen.file_dialog, ("window",)),
    Part("closing", screen.closing, ("window",)),
)
"""What is tried, in order: what may take the whole program with it, graphics and windows, comes late."""


def add_options(parser: ArgumentParser) -> None:
    """Add the options of ``busk self-test``."""
    add_folder_output(parser, required=False)


def run(options: Namespace) -> int:
    """Check the installed program, one line a part."""
    return run_self_test(make_folder(options.out) if options.out is not None else None)


def run_self_test(out: Path | None = None) -> int:
    """Try every part, print a line for each, and return the exit code.

    ``out`` keeps what was made: pictures, sheets, a project, and the lines themselves.
    """
    begun = time.perf_counter()
    with tempfile.TemporaryDirectory(prefix="busk-") as own:
        folder = (out or Path(own) / "made").resolve()
        folder.mkdir(parents=True, exist_ok=True)
        with open(folder / LINES, "w", encoding="utf-8") as lines, apart(Path(own).resolve()):

            def say(text: str) -> None:
                print(text, end="", file=lines, flush=True)
                print(text, end="", flush=True)

            bench = Bench(folder)
            with bench.held:
                lost = try_parts(PARTS, bench, say)
            said = f"failed: {', '.join(lost)}" if lost else "all checks passed"
            say(f"{said}  ({time.perf_counter() - begun:.0f} s)\n")
    return FAILED if lost else 0
