"""Measure the accuracy on a folder of bodies with known values: a table, and pictures of every body."""

from __future__ import annotations

import json as json_text
import sys
from argparse import ArgumentParser, Namespace
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

from app.cli.options import add_forms
from app.cli.output import DONE, NOT_CONVERGED
from app.research.accuracy import OFF, TRUSTED, Case, Mark, Spread, judged, spreads
from app.research.accuracy_figures import save_sheets, verdict
from app.research.ground_truth import read_truths
from core.files.atomic_write import write_text

SIGNED = ("height", "level", "girth")
BY_KIND = ("bust point to nipple-apex", "fold height", "bust girth", "underbust girth")


def add_options(parser: ArgumentParser) -> None:
    """Add the options of ``busk accuracy``."""
    parser.add_argument("folder", metavar="DIR", help="folder of scans with a truth.json")
    add_forms(parser)
    parser.add_argument("--out", metavar="PLACE", help="output folder")


def run(options: Namespace) -> int:
    """Print the accuracy, and write tables and pictures."""
    return run_accuracy(options.folder, options.out, options.json)


def run_accuracy(folder: Path, out: Path | None, json: bool) -> int:
    """Find the landmarks of every file that truth.json in ``folder`` knows, and print how far off they are.

    With ``out``, tables and pictures of every body are written there as well. Returns 0 if every file was
    read the right way round and nothing crashed, else 3. Raises UserError.
    """
    folder = Path(folder)
    truths, strange = read_truths(folder)
    cases = []
    for case in judged(folder, truths):
        cases.append(case)
        print(f"\r{len(cases)} of {len(truths)} files ", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    text = "\n".join(accuracy_text(cases, strange)) + "\n"
    values = json_text.dumps(accuracy_values(cases), indent=1, allow_nan=False)
    print(values if json else text, end="\n" if json else "")
    if out is not None:
        out = Path(out)
        out.mkdir(parents=True, exist_ok=True)
        for name, content in (("accuracy.md", text), ("accuracy.json", values + "\n")):
            write_text(out / name, content)
        save_sheets(cases, folder, out)
        print(f"tables and pictures written to {out}", file=sys.stderr)
    return DONE if all(_as_wished(case) for case in cases) else NOT_CONVERGED


def accuracy_text(cases: Sequence[Case], strange: Sequence[str] = ()) -> Iterator[str]:
    """Yield the lines of the report, in Markdown."""
    bodies = [case for case in cases if not case.truth.refuse]
    groups = grouped(bodies)
    yield from ("# Accuracy on bodies with known landmarks", "", *_counts(cases, bodies))
    if strange:
        yield f"Not evaluated (unknown names): {', '.join(strange)}."
    yield from (
        "",
        "## Summary",
        "",
        "Mean / 95 % / worst of the files with correct orientation.",
        "",
    )
    yield from _glance(groups)
    heads = ("what", "count", "mean", "95 %", "worst", "signed mean", "worst in")
    for name, group in groups.items():
        yield from ("", f"## Errors: {name}", "")
        yield from _table(heads, [_spread_row(spread) for spread in spreads(group)])
    lacking = Counter(name.replace("_", " ") for case in bodies if case.right for name in case.lacking)
    if lacking:
        known = ", ".join(f"{name} ({count})" for name, count in sorted(lacking.items()))
        yield from ("", f"Known but not detected: {known}.")
    yield from ("", "## Confidence", "", *_confidence(bodies))
    kinds = sorted({kind for case in bodies for kind in case.truth.kinds})
    if kinds:
        yield from ("", "## By kind", "", "Means [mm]; a file may belong to several kinds.", "")
        yield from _table(("kind", "files", "right", *BY_KIND), [_kind_row(kind, bodies) for kind in kinds])
    failures = [case for case in cases if not _as_wished(case)]
    yield from ("", "## Failures", "")
    yield from (f"* {case.truth.name}: {verdict(case)}" for case in failures)
    if not failures:
        yield "None."
    yield from ("", "## Landmarks with large errors", "")
    yield from _far(bodies)


def grouped(bodies: Sequence[Case]) -> dict[str, list[Case]]:
    """Return clean bodies and degraded scans apart, without a group of none."""
    groups = {
        "clean bodies": [case for case in bodies if not case.truth.degraded],
        "degraded scans": [case for case in bodies if case.truth.degraded],
    }
    return {name: group for name, group in groups.items() if group}


def accuracy_values(cases: Sequence[Case]) -> dict[str, Any]:
    """Return the same as plain values, ready for JSON."""
    return {
        "files": [_case_values(case) for case in cases],
        "spreads": [spread.__dict__ for spread in spreads([case for case in cases if not case.truth.refuse])],
    }


def _case_values(case: Case) -> dict[str, Any]:
    return {
        "name": case.truth.name,
        "file": case.truth.file,
        "kinds": list(case.truth.kinds),
        "degraded": case.truth.degraded,
        "right": case.right,
        "sure": case.sure,
        "failed": case.failed,
        "crashed": case.crashed,
        "turned_degrees": case.turned,
        "unit_right": case.unit_right,
        "sides_right": case.sides_right,
        "seconds": round(case.seconds, 3),
        "errors": {name: float(error) for name, error in case.errors.items()},
        "landmarks": {m.name: {"off_mm": m.off, "confidence": m.confidence} for m in case.marks},
        "lacking": list(case.lacking),
        "invented": dict(case.invented),
    }


def _as_wished(case: Case) -> bool:
    return bool(case.failed) and not case.crashed if case.truth.refuse else case.right


def _counts(cases: Sequence[Case], bodies: Sequence[Case]) -> Iterator[str]:
    read = [case for case in bodies if not case.failed]
    right = [case for case in read if case.right]
    wrong = [case for case in read if not case.right]
    crashed = sum(case.crashed for case in cases)
    seconds = [case.seconds for case in cases]
    count = f"{len(bodies)} {'body' if len(bodies) == 1 else 'bodies'}"
    yield (
        f"{count}: {len(right)} with correct orientation, {sum(not c.sure for c in right)} of "
        f"these flagged; {len(wrong)} with wrong orientation, {sum(not c.sure for c in wrong)} "
        f"of these flagged ({sum(not c.unit_right for c in wrong)} with a wrong unit, "
        f"{sum(not c.sides_right for c in wrong)} with sides swapped); "
        f"{sum(bool(c.failed) and (not c.crashed) for c in bodies)} refused; {crashed} crashed."
    )
    others = [case for case in cases if case.truth.refuse]
    if others:
        refused = sum(_as_wished(case) for case in others)
        files = "file" if len(others) == 1 else "files"
        yield f"{len(others)} {files} without a body: {refused} rejected, as required."
    yield f"CPU time per file: {median(seconds):.1f} s median, {max(seconds):.1f} s maximum."


def _glance(groups: Mapping[str, Sequence[Case]]) -> Iterator[str]:
    """Yield one table with a column for each group of files: what a page on accuracy needs."""
    columns = [dict(_figures(group)) for group in groups.values()]
    whats = dict.fromkeys(what for column in columns for what in column)
    rows = [(what, *(column.get(what, "-") for column in columns)) for what in whats]
    yield from _table(("", *(f"{name} ({len(group)})" for name, group in groups.items())), rows)


def _figures(cases: Sequence[Case]) -> Iterator[tuple[str, str]]:
    """Yield the results of a group of files, in words and numbers."""
    right = [case for case in cases if case.right]
    asked = sum(not case.sure for case in right)
    yield "correct orientation", f"{len(right)}{f'; {asked} of these asked about' if asked else ''}"
    yield "wrong orientation", str(sum(not case.right and not case.failed for case in cases))
    yield "rejected or crashed", str(sum(bool(case.failed) for case in cases))
    for spread in spreads(cases):
        yield _with_unit(spread.what), f"{spread.mean:.1f} / {spread.most:.1f} / {spread.worst:.1f}"
    for name, marks in _by_landmark(cases).items():
        _, count, off, unsure, sure, wrong = _confidence_row(name, marks)
        yield (
            f"{name} error above {OFF:g} mm, of these with confidence below {TRUSTED:g}",
            f"{off} of {count}, {unsure}",
        )
        yield f"{name} from {TRUSTED:g} confidence and above, of these with a large error", f"{sure}, {wrong}"
    seconds = [case.seconds for case in cases]
    yield "CPU time per file [s], median / worst", f"{median(seconds):.1f} / {max(seconds):.1f}"


def _spread_row(spread: Spread) -> tuple[str, ...]:
    numbers = (spread.mean, spread.most, spread.worst)
    signed = f"{spread.bias:+.1f}" if any(word in spread.what for word in SIGNED) else ""
    return (
        _with_unit(spread.what),
        str(spread.count),
        *(f"{number:.1f}" for number in numbers),
        signed,
        spread.where,
    )


def _with_unit(what: str) -> str:
    return what if "[" in what else f"{what} [mm]"


def _by_landmark(bodies: Sequence[Case]) -> dict[str, list[Mark]]:
    """Return the judged landmarks of all files by their kind, and all together."""
    groups = {"bust points": "bust_point", "folds": "fold", "lowest points": "lowest"}
    marks = [mark for case in bodies if case.right for mark in case.marks]
    named = {name: [m for m in marks if m.name.startswith(start)] for name, start in groups.items()}
    named["others"] = [m for m in marks if not m.name.startswith(tuple(groups.values()))]
    return {name: group for name, group in named.items() if group} | {"all": marks}


def _confidence(bodies: Sequence[Case]) -> Iterator[str]:
    """Say how many landmarks that are off are unsure, and how many that are sure are off."""
    rows = [_confidence_row(name, marks) for name, marks in _by_landmark(bodies).items()]
    heads = ("landmarks", "count", f"error > {OFF:g} mm", f"of these < {TRUSTED:g}")
    yield from _table((*heads, f"all >= {TRUSTED:g}", f"of these error > {OFF:g} mm"), rows)
    invented = [sure for case in bodies if case.right for sure in case.invented.values()]
    if invented:
        yield ""
        yield (
            f"False detections of breasts: {len(invented)}, with confidence {np.mean(invented):.2f} "
            f"on average, {max(invented):.2f} at most."
        )


def _confidence_row(name: str, marks: Sequence[Mark]) -> tuple[str, str, str, str, str, str]:
    off = [mark for mark in marks if mark.off > OFF]
    sure = [mark for mark in marks if mark.confidence >= TRUSTED]
    unsure = sum(mark.confidence < TRUSTED for mark in off)
    wrong = sum(mark.off > OFF for mark in sure)
    return name, str(len(marks)), str(len(off)), str(unsure), str(len(sure)), str(wrong)


def _kind_row(kind: str, bodies: Sequence[Case]) -> tuple[str, ...]:
    of_it = [case for case in bodies if kind in case.truth.kinds]
    means = {spread.what: f"{spread.mean:.1f}" for spread in spreads(of_it)}
    right = sum(case.right for case in of_it)
    return (kind, str(len(of_it)), str(right), *(means.get(what, "-") for what in BY_KIND))


def _far(bodies: Sequence[Case]) -> Iterator[str]:
    far = [(mark, case) for case in bodies if case.right for mark in case.marks if mark.off > OFF]
    for mark, case in sorted(far, key=lambda pair: -pair[0].off):
        name = mark.name.replace("_", " ")
        yield f"* {case.truth.name}: {name} {mark.off:.1f} mm error, confidence {mark.confidence:.2f}"
    if not far:
        yield "None."


def _table(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> Iterator[str]:
    """Yield a Markdown table whose columns line up."""
    widths = [max(len(row[k]) for row in (heads, *rows)) for k in range(len(heads))]
    lines = [heads, ["-" * width for width in widths], *rows]
    for line in lines:
        cells = [
            cell.ljust(w) if k == 0 else cell.rjust(w)
            for k, (cell, w) in enumerate(zip(line, widths, strict=True))
        ]
        yield f"| {' | '.join(cells)} |"
