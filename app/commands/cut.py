"""The cut list as the command line prints and writes it."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import reduce

from app.commands.settings import dressed, made_of
from app.commands.told import told
from core import __version__
from core.cutting import CutList, CutRow, cut_list
from core.design import Design, cannot_hold
from core.errors import LineError
from core.pipeline import build
from core.report import shape_warnings
from core.sewing.as_worn import as_worn
from core.solution import run

COLUMNS = tuple(field.name for field in fields(CutRow))


@dataclass(frozen=True)
class Cut:
    """A cut list, whether the body came to rest, and what to look at."""

    cuts: CutList
    settled: bool
    warnings: list[str]


def run_cut(design: Design, lines: Sequence[str], elastics: Sequence[str], same: bool = False) -> Cut:
    """Solve a design with lines and elastics as requested, and make its cut list. Raises UserError.

    If ``same`` lines made of elastics reach what they reach without them.
    """
    stages = build(design)
    design = dressed(design, stages.model.lines, lines)
    if same:
        bare = build(reduce(lambda bare, name: bare.with_elastic(name, None), design.worn_elastics(), design))
        made = made_of(design, elastics).worn_elastics()
        design = as_worn(bare, run(bare).control_points, made)
    else:
        design = made_of(design, elastics)
    if not design.lines:
        raise LineError("No line is worn.", "Set one: --line mid-bust=75% --elastic 'mid-bust=plush 12'.")
    solution = run(build(design, stages))
    motion = solution.verdict.motion
    if design.line_hold == "held" and motion == "diverging":
        raise cannot_hold(design)
    settled = motion == "settled" and solution.verdict.state != "folded"
    warnings = shape_warnings(solution)
    if motion != "settled":
        warnings.append("The turns have not come to rest: lengths to cut may still change.")
    return Cut(cut_list(solution.stages, solution.control_points), settled, warnings)


def cut_text(found: Cut, kind: str, out: str | None) -> str:
    """Return what to print, or write it to a file ``out``; see ``told``. Raises UserError."""
    return told(_FORMS, found, kind, out)


def _plain(found: Cut) -> str:
    heading = (
        f"{'':22}{'cut mm':>9}{'stretch %':>11}{'tension N':>11}{'front mm':>10}{'whole mm':>10}  elastic"
    )
    return "\n".join([heading, *(line for row in found.cuts.rows for line in _lines(row)), *found.cuts.notes])


def _lines(row: CutRow) -> list[str]:
    figures = (
        (row.cut_mm, 9),
        (None if row.elongation is None else 100.0 * row.elongation, 11),
        (row.tension_n, 11),
        (row.reached_front_mm, 10),
        (row.reached_whole_mm, 10),
    )
    told = "".join(f"{'-' if value is None else format(value, '.1f'):>{wide}}" for value, wide in figures)
    return [f"{row.title[:21]:22}{told}  {row.elastic}".rstrip(), *(f"  {note}" for note in row.notes)]


def _as_json(found: Cut) -> str:
    whole = {**found.cuts.as_data(), "warnings": found.warnings, "versions": {"busk": __version__}}
    return json.dumps(whole, indent=1, ensure_ascii=False)


def _as_csv(found: Cut) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    writer.writerows([_cell(getattr(row, column)) for column in COLUMNS] for row in found.cuts.rows)
    return text.getvalue().rstrip("\n")


def _cell(value: object) -> object:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, tuple):
        return " ".join(value)
    return f"{value:.6g}" if isinstance(value, float) else value


_FORMS = {"": _plain, "json": _as_json, "csv": _as_csv}
