"""Compute the contact pressure of each active line, and rate it."""

from __future__ import annotations

import json
from argparse import ArgumentParser, Namespace
from collections.abc import Iterator
from dataclasses import dataclass, fields

from app.cli.design import design_of
from app.cli.options import add_forms, add_lines, add_scan, form_of
from app.cli.output import csv_text, finish, table_lines, write_output
from app.cli.solved_design import SolvedDesign, solve_design
from app.presenters.messages import line_title
from app.presenters.pressure import place_text, rating_limits, rating_text, total_text
from core import __version__
from core.document.design import Design
from core.garment.pressure_list import PressureList, PressureRow, pressure_list_of
from core.messages import plain

COLUMNS = tuple(field.name for field in fields(PressureRow))
_HEADING = ("", "mean kPa", "mmHg", "max kPa", "mmHg", "rating", "force N", "bridged mm", "maximum at")


@dataclass(frozen=True)
class Pressures:
    """The contact pressures of lines, and the solved design that they belong to."""

    listed: PressureList
    solved: SolvedDesign


def add_options(parser: ArgumentParser) -> None:
    """Add the options of ``busk pressure``."""
    add_scan(parser)
    add_lines(parser)
    add_forms(parser, table=True)


def run(options: Namespace) -> int:
    """Print or write the contact pressures."""
    solved = solve_design(design_of(options), options.line or [], options.elastic or [])
    listed = pressure_list_of(solved.solution)
    text = write_output(_FORMS, Pressures(listed, solved), form_of(options), options.out)
    return finish(text, solved.converged, solved.warnings)


def _text(found: Pressures) -> str:
    listed, design = found.listed, found.solved.solution.stages.design
    heading, *lines = table_lines([_HEADING, *(_cells(row, design) for row in listed.rows)])
    notes = ([f"  {note}" for note in row.notes] for row in listed.rows)
    rows = (text for line, below in zip(lines, notes, strict=True) for text in (line, *below))
    lines = [heading, *rows, "", f"{total_text(listed)}.", "", *_limits()]
    return "\n".join([*found.solved.verdict, *found.solved.effect, "", *lines])


def _cells(row: PressureRow, design: Design) -> tuple[str, ...]:
    pressures = (row.mean_kpa, 2), (row.mean_mmhg, 1), (row.max_kpa, 2), (row.max_mmhg, 1)
    others = (row.force_n, 1), (row.bridged_mm, 0)
    return (
        line_title(row.line, design),
        *_written(pressures),
        rating_text(row.light) if row.light else "-",
        *_written(others),
        place_text(row) if row.where else "",
    )


def _written(values: tuple[tuple[float | None, int], ...]) -> Iterator[str]:
    return ("-" if value is None else f"{value:.{digits}f}" for value, digits in values)


def _limits() -> Iterator[str]:
    limits = rating_limits()
    gentle, snug, tight = limits.words
    amber, red = f"{limits.amber_kpa:g} kPa", f"{limits.red_kpa:g} kPa"
    rating = f"{gentle} below {amber}, {snug} from {amber}, {tight} from {red}"
    yield f"Rating by the maximum contact pressure: {rating}."
    yield from (f"  {sentence}" for sentence in limits.sources)
    yield "Not included in the values:"
    yield from (f"  {sentence}" for sentence in limits.left_out)


def _json(found: Pressures) -> str:
    whole = {**found.listed.as_data(), "assessment": found.solved.assessment.as_data()}
    whole |= {"warnings": plain(found.solved.warnings), "versions": {"busk": __version__}}
    return json.dumps(whole, indent=1, ensure_ascii=False)


def _csv(found: Pressures) -> str:
    return csv_text(COLUMNS, found.listed.rows)


_FORMS = {"": _text, "json": _json, "csv": _csv}
