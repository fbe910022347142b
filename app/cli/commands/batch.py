"""Solve one design, or several variants, on many bodies: a table with a row for each body and variant."""

from __future__ import annotations

import argparse
import json
import math
import os
import signal
import sys
import threading
import time
from argparse import ArgumentParser, Namespace
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from datetime import timedelta
from itertools import count
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Any

from app.batch.batch_design import BatchDesign, batch_design, preset_design
from app.batch.design_file import is_design_file, read_designs
from app.batch.extra import missing_error
from app.batch.inputs import list_scans, printable_path
from app.batch.pending import pending_bodies
from app.batch.schema import DONE
from app.cli.commands.target import TARGET_HELP
from app.cli.design import with_options
from app.cli.options import add_folder_output, add_lines, add_orientation, add_volume
from app.cli.output import DONE as ALL_DONE
from app.cli.output import NOT_CONVERGED, make_folder
from core.document.design import Design, ScanSource
from core.document.storage.project_file import is_project, open_project
from core.errors import UserError
from core.garment.presets import find_preset

if TYPE_CHECKING:
    from app.batch.one_body import Row
    from app.batch.store import ResultStore

SCANS_HELP = (
    "scans or projects, folders with them, patterns such as 'scans/*.ply', or a list as CSV with a column "
    "scan"
)
DESIGN_HELP = (
    "a project, a preset by title or unique words, a preset file, or design.json of another run; of a "
    "project everything but scan, landmarks and customer. May be repeated: each design is a variant with "
    "rows of its own. Without it the design is that of the other options"
)


def add_options(parser: ArgumentParser) -> None:
    """Add the options of ``busk batch``."""
    parser.add_argument("scans", metavar="SCANS", nargs="+", help=SCANS_HELP)
    parser.add_argument("--design", action="append", metavar="PROJECT_OR_PRESET", help=DESIGN_HELP)
    add_orientation(parser)
    add_lines(parser)
    add_volume(parser)
    parser.add_argument("--target", action="append", metavar="NAME=VALUE", help=TARGET_HELP)
    add_folder_output(parser)
    parser.add_argument("--body", action="store_true", help="write the reshaped bodies (PLY)")
    report = "write a report (PDF) of each body, in this language (default: en); takes seconds a body"
    parser.add_argument("--report", nargs="?", const="en", choices=("en", "ja"), help=report)
    parser.add_argument("--no-pictures", action="store_true", help="write no picture of each body")
    parser.add_argument("--json", action="store_true", help="print progress and summary as lines of JSON")
    rows = "with --json, print each row of results as well"
    parser.add_argument("--rows", action="store_true", help=rows)
    parser.add_argument(
        "--restart", action="store_true", help="remove the results in the output folder first"
    )
    parser.add_argument("--retry", action="store_true", help="repeat bodies that crashed or ran out of time")
    processes = "processes on this machine (default: one for each processor)"
    parser.add_argument("--workers", type=_count, metavar="N", default=os.cpu_count() or 1, help=processes)
    address = "use a Dask cluster that is running instead, such as tcp://host:8786"
    parser.add_argument("--scheduler", metavar="ADDRESS", default="", help=address)
    ship = "send scans to the workers instead of paths, for a cluster without a shared file system"
    parser.add_argument("--ship", action="store_true", help=ship)
    limit = "time for one body (default: 300)"
    parser.add_argument("--timeout", type=_positive, metavar="SECONDS", default=300.0, help=limit)
    memory = "memory for one body (default: 4000)"
    parser.add_argument("--memory", type=_positive, metavar="MB", default=4000.0, help=memory)


def _count(text: str) -> int:
    if not (text.isdecimal() and 1 <= int(text) <= 1024):
        raise argparse.ArgumentTypeError(f"'{text}' is not a number of processes from 1 to 1024")
    return int(text)


def _positive(text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = 0.0
    if not 0.0 < number < math.inf:
        raise argparse.ArgumentTypeError(f"'{text}' is not a positive number")
    return number


def run(options: Namespace) -> int:
    """Compute all bodies that are not in the output folder yet. Raises UserError, KeyboardInterrupt."""
    try:
        designs, scans = designs_of(options), list_scans(options.scans, Path(options.out))
        store = _store(options, designs)
        progress = Progress(len(scans) * len(designs), as_json=options.json, with_rows=options.rows)
        try:
            return _run(options, scans, store, progress)
        finally:
            store.close()
    except UserError as problem:
        if options.json:
            print(json.dumps(_error_event(problem)), flush=True)
        raise


def _error_event(problem: UserError) -> dict[str, Any]:
    """Return an error for other programs; ``sentences`` are those of the catalogue with what fills them."""
    sentences = [
        [each.msgid, {name: str(value) for name, value in each.items}] for each in problem.text.sentences
    ]
    return {"event": "error", "message": str(problem), "sentences": sentences}


def _run(options: Namespace, scans: list[str], store: ResultStore, progress: Progress) -> int:
    from app.batch.body_worker import Limits  # noqa: PLC0415 (psutil comes with Dask)
    from app.batch.engine import Run, run_batch  # noqa: PLC0415 (Dask is loaded for a run alone)

    limits = Limits(options.timeout, options.memory)
    run = Run(store.designs, options.workers, limits, options.scheduler, Path(options.out), _files(options))
    pending = pending_bodies(scans, store, progress.skip, ship=options.ship, retry=options.retry)
    interrupted = True
    try:
        with noticed_interrupts() as check:
            for rows in run_batch(run, pending):
                store.add(rows)
                progress.add(rows)
                check()
        interrupted = False
    finally:
        order = [printable_path(scan) for scan in scans]
        summary = store.finish(order, progress.seconds, interrupted=interrupted)
        progress.end(summary, options.out)
    return ALL_DONE if summary["rows"] == summary["states"][DONE] else NOT_CONVERGED


@contextmanager
def noticed_interrupts() -> Iterator[Callable[[], None]]:
    """Yield a check that raises KeyboardInterrupt if Ctrl+C was pressed and the exception was lost.

    Python drops what is raised in a finalizer, and Dask has many.
    """
    came = False

    def notice(number: int, frame: FrameType | None) -> None:
        nonlocal came
        came = True
        raise KeyboardInterrupt

    def check() -> None:
        if came:
            raise KeyboardInterrupt

    if threading.current_thread() is not threading.main_thread():
        yield check  # signals are for the main thread
        return
    former = signal.signal(signal.SIGINT, notice)
    try:
        yield check
    finally:
        signal.signal(signal.SIGINT, former)


def _files(options: Namespace) -> dict[str, str]:
    """Return the kinds of files that are wanted of each body, with the manner of each."""
    wanted = {"picture": not options.no_pictures, "body": options.body, "report": options.report}
    return {kind: options.report if kind == "report" else "" for kind, on in wanted.items() if on}


def _store(options: Namespace, designs: Sequence[BatchDesign]) -> ResultStore:
    try:
        import distributed  # noqa: F401, PLC0415 (an extra)

        from app.batch.store import ResultStore  # noqa: PLC0415
    except ImportError as missing:
        raise missing_error(str(missing)) from missing
    return ResultStore(make_folder(options.out), designs, restart=options.restart)


def designs_of(options: Namespace) -> list[BatchDesign]:
    """Return the variants of a run, each named after its project or preset. Raises UserError."""
    designs: dict[str, BatchDesign] = {}
    for text in options.design or [""]:
        for chosen in _chosen(text):
            name = next(each for each in _numbered(chosen.name) if each not in designs)
            designs[name] = _with_options(replace(chosen, name=name), options)
    return list(designs.values())


def _with_options(chosen: BatchDesign, options: Namespace) -> BatchDesign:
    axes = {key: getattr(options, key) for key in ("unit", "up", "front") if getattr(options, key)}
    design = with_options(replace(chosen.design, scan=replace(chosen.design.scan, **axes)), options)
    lines, targets = (*chosen.lines, *(options.line or [])), (*chosen.targets, *(options.target or []))
    found = batch_design(chosen.name, design, lines, options.elastic or [], targets)
    return replace(found, elastics=(*chosen.elastics, *found.elastics))


def _chosen(text: str) -> list[BatchDesign]:
    """Return the designs of a text: several of a file of designs, else one. Raises UserError."""
    if is_design_file(text):
        return read_designs(Path(text))
    name, design = _design(text)
    return [BatchDesign(name, replace(design, scan=ScanSource("")))]


def _design(text: str) -> tuple[str, Design]:
    if not text:
        return "design", Design(ScanSource(""))
    if is_project(text):
        return printable_path(Path(text).stem), open_project(text).design
    return preset_design(find_preset(text))


def _numbered(name: str) -> Iterator[str]:
    yield name
    yield from (f"{name} {number}" for number in count(2))


class Progress:
    """Shows how many of ``total`` rows are done, with rate and time left, as text or JSON."""

    def __init__(self, total: int, *, as_json: bool, with_rows: bool = False) -> None:
        self._total, self._json, self._rows = total, as_json, as_json and with_rows
        self._start, self._shown = time.monotonic(), -math.inf
        self._done = self._skipped = 0
        self._line = not as_json and sys.stderr.isatty()

    @property
    def seconds(self) -> float:
        """Return the time since the start [s]."""
        return time.monotonic() - self._start

    def skip(self) -> None:
        """Count a row that is there already."""
        self._skipped += 1

    def add(self, rows: Sequence[Row]) -> None:
        """Count rows that are done, and show the state now and then: often on a terminal, else seldom."""
        self._done += len(rows)
        if self._rows:
            print(json.dumps({"event": "rows", "rows": rows}), flush=True)
        if time.monotonic() - self._shown >= (0.2 if self._line or self._json else 10.0):
            self._shown = time.monotonic()
            self._show()

    def end(self, summary: dict[str, Any], out: str) -> None:
        """Show the state and the summary of the run."""
        self._show()
        if self._json:
            print(json.dumps({"event": "summary", **summary}), flush=True)
            return
        states = ", ".join(f"{count} {state}" for state, count in summary["states"].items() if count)
        print(end="\n" if self._line else "", file=sys.stderr)
        print(f"{states or 'no rows'}; written to {out}", flush=True)

    def _show(self) -> None:
        done, rate = self._done + self._skipped, self._done / max(self.seconds, 1e-3)
        left = (self._total - done) / rate if rate else None
        if self._json:
            values = {"event": "progress", "done": done, "total": self._total, "rows_per_s": round(rate, 3)}
            print(json.dumps({**values, "seconds_left": left and round(left, 1)}), flush=True)
            return
        end = "" if left is None else f", {timedelta(seconds=round(left))} left"
        text = f"{done} of {self._total}, {rate:.2f} per second{end}"
        print(
            f"\r{text:<70}" if self._line else text,
            end="" if self._line else "\n",
            file=sys.stderr,
            flush=True,
        )
