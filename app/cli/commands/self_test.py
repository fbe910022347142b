"""Check the installed program on the sample: one line a part, exit code 0 if all pass."""

from __future__ import annotations

import tempfile
import time
from argparse import ArgumentParser, Namespace
from pathlib import Path

from app.cli.options import add_folder_output
from app.cli.output import DONE, make_folder
from app.cli.self_test import checks, window
from app.cli.self_test.parts import Part, SelfTestFixture, isolated, try_parts

FAILED = 1
"""The exit code if a part has failed."""

LINES = "self-test.txt"
"""The file in the folder of ``--out`` with the lines: without a console they have no other place."""

_SAMPLE = ("landmarks", "solver")

PARTS: tuple[Part[SelfTestFixture], ...] = (
    Part("versions", checks.versions),
    Part("shipped files", checks.shipped_files),
    Part("landmarks", checks.landmarks),
    Part("solver", checks.solver, ("landmarks",)),
    Part("lower trunk", checks.lower_trunk),
    Part("compiled loops", checks.compiled_loops, ("landmarks",)),
    Part("projects", checks.projects, _SAMPLE),
    Part("exports", checks.exports, _SAMPLE),
    Part("3D drawing", checks.drawing, _SAMPLE),
    Part("Qt", window.toolkit),
    Part("fonts", window.fonts, ("Qt",)),
    Part("report", window.report, ("Qt", *_SAMPLE, "3D drawing")),
    Part("window", window.window, ("Qt", "projects")),
    Part("slider", window.slider, ("window",)),
    Part("closing", window.closing, ("window",)),
)
"""The parts in order: what may end the whole program, graphics and windows, comes late."""


def add_options(parser: ArgumentParser) -> None:
    """Add the options of ``busk self-test``."""
    add_folder_output(parser, required=False)


def run(options: Namespace) -> int:
    """Run every part, and print a line for each; ``--out`` keeps the files and the lines."""
    start = time.perf_counter()
    with tempfile.TemporaryDirectory(prefix="busk-") as own:
        folder = (make_folder(options.out) if options.out is not None else Path(own) / "made").resolve()
        folder.mkdir(parents=True, exist_ok=True)
        with open(folder / LINES, "w", encoding="utf-8") as lines, isolated(Path(own).resolve()):

            def write(text: str) -> None:
                print(text, end="", file=lines, flush=True)
                print(text, end="", flush=True)

            bench = SelfTestFixture(folder)
            with bench.held:
                failed = try_parts(PARTS, bench, write)
            result = f"failed: {', '.join(failed)}" if failed else "all checks passed"
            write(f"{result}  ({time.perf_counter() - start:.0f} s)\n")
    return FAILED if failed else DONE
