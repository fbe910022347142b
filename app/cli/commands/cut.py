"""The cut list as the command line prints and writes it."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, fields

from app.cli.output import csv_text, told
from app.cli.solve_design import Worn, run_worn
from core import __version__
from core.document.design import Design
from core.garment.cut_list import CutList, CutRow, cut_list

COLUMNS = tuple(field.name for field in fields(CutRow))


@dataclass(frozen=True)
class Cut:
    """A cut list, and the solved design that it is of."""

    cuts: CutList
    worn: Worn


def run_cut(design: Design, lines: Sequence[str], elastics: Sequence[str], same: bool = False) -> Cut:
    """Solve a design with lines and elastics as requested, and make its cut list. Raises UserError.

    If ``same`` lines made of elastics reach what they reach without them.
    """
    worn = run_worn(design, lines, elastics, same=same)
    solution = worn.solution
    return Cut(cut_list(solution.stages, solution.control_points), worn)


def cut_text(found: Cut, kind: str, out: str | None) -> str:
    """Return what to print, or write it to a file ``out``; see ``told``. Raises UserError."""
    return told(_FORMS, found, kind, out)


def _plain(found: Cut) -> str:
    heading = f"{'':22}{'cut mm':>9}{'elong. %':>11}{'tension N':>11}{'front mm':>10}{'full mm':>10}  elastic"
    rows = (line for row in found.cuts.rows for line in _lines(row))
    return "\n".join([*found.worn.verdict, *found.worn.effect, "", heading, *rows, *found.cuts.notes])


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
    whole = {**found.cuts.as_data(), "assessment": found.worn.assessment.as_data()}
    whole |= {"warnings": found.worn.warnings, "versions": {"busk": __version__}}
    return json.dumps(whole, indent=1, ensure_ascii=False)


def _as_csv(found: Cut) -> str:
    return csv_text(COLUMNS, found.cuts.rows)


_FORMS = {"": _plain, "json": _as_json, "csv": _as_csv}
