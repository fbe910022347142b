"""Measure a scan, or a project before and after."""

from __future__ import annotations

import json
from argparse import ArgumentParser, Namespace
from dataclasses import dataclass
from typing import Any

from app.cli.design import design_of
from app.cli.options import add_forms, add_scan, form_of
from app.cli.output import finish, table_lines, write_output
from app.cli.solved_design import is_converged
from app.presenters.assessment import assessment_lines
from app.presenters.measurements import MeasureView, measured_views
from core import __version__
from core.document.custom_measures import HELP as CUSTOM_HELP
from core.document.custom_measures import parse_measurement
from core.document.design import Design
from core.document.storage.project_file import is_project
from core.export.csv_cells import csv_text
from core.garment.assessment import assess
from core.landmarks.warnings import collect_warnings
from core.measurements.table import before_after, measure_rows, measures
from core.messages import Message, plain
from core.pipeline.build import build, detect_landmarks, read_body
from core.pipeline.solve import solve_valid
from core.pipeline.warnings import shape_warnings

COLUMNS = (
    *("key", "title", "side", "unit", "before", "after", "difference", "plus_minus"),
    *("confidence", "estimate", "note", "iso", "definition"),
)


@dataclass(frozen=True)
class Measured:
    """The rows of ``measure_rows`` and their views; the ``verdict`` is empty if there is no after."""

    rows: list[dict[str, Any]]
    views: list[MeasureView]
    converged: bool
    warnings: list[Message]
    verdict: tuple[str, ...] = ()


def add_options(parser: ArgumentParser) -> None:
    """Add the options of ``busk measure``."""
    add_scan(parser)
    add_forms(parser, table=True)
    parser.add_argument("--custom", action="append", metavar="NAME=KIND:PLACES", help=CUSTOM_HELP)


def run(options: Namespace) -> int:
    """Print or write the measurements of a scan, or of a project before and after."""
    design = design_of(options)
    for custom in map(parse_measurement, options.custom or []):
        design = design.with_custom_measurement(custom)
    found = _measured(design) if is_project(options.input) else _measured_scan(design)
    text = write_output(_FORMS, found, form_of(options), options.out)
    return finish(text, found.converged, found.warnings)


def _measured_scan(design: Design) -> Measured:
    _, body = read_body(design.scan)
    landmarks = detect_landmarks(body, design.placed)
    before = measures(body.smoothed, landmarks, design.own_measures)
    rows, views = measure_rows(before), measured_views(before, None)
    return Measured(rows, views, True, collect_warnings(body, landmarks))


def _measured(design: Design) -> Measured:
    solution = solve_valid(build(design))
    stages = solution.stages
    both = before_after(stages, *solution.region_points)
    warnings = [*collect_warnings(stages.body, stages.landmarks), *shape_warnings(solution)]
    verdict = tuple(assessment_lines(assess(solution), stages.design))
    views = measured_views(*both)
    return Measured(measure_rows(*both), views, is_converged(solution), warnings, verdict)


def _text(found: Measured) -> str:
    heading = ("", "before", *(("after", "change") if found.verdict else ()), "unit", "")
    lines = table_lines([heading, *(_cells(view, bool(found.verdict)) for view in found.views)])
    return "\n".join([*found.verdict, *([""] if found.verdict else []), *lines])


def _cells(view: MeasureView, solved: bool) -> tuple[str, ...]:
    values = view.written(view.before), view.written(view.after), view.written(view.change, signed=True)
    shown = values if solved else values[:1]
    return (view.label, *(each or "-" for each in shown), view.unit_shown, view.caption)


def _json(found: Measured) -> str:
    table = {row["key"]: {key: value for key, value in row.items() if key != "key"} for row in found.rows}
    whole = {"measures": plain(table), "warnings": plain(found.warnings), "versions": {"busk": __version__}}
    return json.dumps(whole, indent=1, ensure_ascii=False)


def _csv(found: Measured) -> str:
    return csv_text(COLUMNS, ([row[column] for column in COLUMNS] for row in found.rows)).rstrip("\n")


_FORMS = {"": _text, "json": _json, "csv": _csv}
