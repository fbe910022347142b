"""What a body measures, as the command line prints and writes it."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

from app.cli.output import told
from app.cli.solve_design import run_to_body
from app.presenters.assessment import assessment_lines
from core import __version__
from core.document.design import Design
from core.export.csv_cells import csv_text
from core.garment.assessment import assessed
from core.landmarks.warnings import doubts
from core.measurements.table import before_after, measure_rows, measures
from core.pipeline.build import build, find, read_body
from core.pipeline.warnings import shape_warnings

COLUMNS = (
    *("key", "title", "side", "unit", "before", "after", "difference", "plus_minus"),
    *("confidence", "estimate", "note", "iso", "definition"),
)


@dataclass(frozen=True)
class Measured:
    """The rows of ``measure_rows``, whether there is an after, and what to look at."""

    rows: list[dict[str, Any]]
    solved: bool
    settled: bool
    warnings: list[str]
    verdict: tuple[str, ...] = ()


def run_measure(design: Design, *, solved: bool) -> Measured:
    """Measure the scan of a design, and what becomes of it if it is to be ``solved``. Raises UserError."""
    if not solved:
        _, body = read_body(design.scan)
        landmarks = find(body, design.placed)
        rows = measure_rows(measures(body.calm, landmarks, design.own_measures))
        return Measured(rows, False, True, doubts(body, landmarks))
    solution = run_to_body(build(design))
    stages = solution.stages
    rows = measure_rows(*before_after(stages, solution.control_points))
    settled = solution.verdict.motion == "settled" and solution.verdict.state != "folded"
    warnings = [*doubts(stages.body, stages.landmarks), *shape_warnings(solution)]
    verdict = assessment_lines(assessed(solution), stages.design)
    return Measured(rows, True, settled, warnings, tuple(verdict))


def measured_text(found: Measured, kind: str, out: str | None) -> str:
    """Return what to print, or write it to a file ``out``; see ``told``. Raises UserError."""
    return told(_FORMS, found, kind, out)


def _plain(found: Measured) -> str:
    titles = [f"{row['title']}, {row['side']}" if row["side"] else row["title"] for row in found.rows]
    wide = max(34, *(len(title) + 1 for title in titles))
    heading = f"{'':{wide}}{'before':>9}" + (f"{'after':>9}{'change':>8}" if found.solved else "")
    rows = zip(titles, found.rows, strict=True)
    head = [*found.verdict, ""] if found.verdict else []
    return "\n".join([*head, heading, *(_line(f"{title:{wide}}", row, found.solved) for title, row in rows)])


def _line(title: str, row: dict[str, Any], solved: bool) -> str:
    both = row["before"], row["after"]
    change = None if None in both else round(both[1], 1) - round(both[0], 1)  # so that the columns agree
    values = [both[0], *([both[1], change] if solved else [])]
    if all(value is None for value in values):
        return f"{title}{'-':>9}  {row['note']}"
    told = [f"{'-' if value is None else format(value, 'z.1f'):>9}" for value in values[:2]]
    told += [f"{'' if value is None else format(value, '+z.1f'):>8}" for value in values[2:]]
    unsure = f" ± {row['plus_minus']:.0f}" if row["plus_minus"] >= 0.5 else ""
    note = f"{unsure}  {row['note']}" if row["estimate"] else ""
    return f"{title}{''.join(told)} {row['unit']}{note}"


def _as_json(found: Measured) -> str:
    table = {row["key"]: {key: value for key, value in row.items() if key != "key"} for row in found.rows}
    whole = {"measures": table, "warnings": found.warnings, "versions": {"busk": __version__}}
    return json.dumps(whole, indent=1, ensure_ascii=False)


def _as_csv(found: Measured) -> str:
    return csv_text(COLUMNS, ([row[column] for column in COLUMNS] for row in found.rows)).rstrip("\n")


_FORMS = {"": _plain, "json": _as_json, "csv": _as_csv}
