"""Compute the cut list: the cut length of each active line."""

from __future__ import annotations

import json
from argparse import ArgumentParser, Namespace
from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import partial

from app.cli.design import design_of
from app.cli.options import add_forms, add_lines, add_scan, form_of
from app.cli.output import csv_text, finish, table_lines, write_output
from app.cli.solved_design import SolvedDesign, solve_design
from app.presenters.cut_list import as_table
from app.presenters.elastics import choice_view, mode_text, title_of
from core import __version__
from core.errors import LineError, UserError
from core.garment.cut_list import CutList, CutRow, cut_list_of
from core.garment.elastic_library import library
from core.garment.elastic_options import KEEP_CUT, KEEP_FIT, elastic_option
from core.garment.line_requests import with_lines_and_elastics
from core.messages import LineName, Message, plain
from core.pipeline.build import Stages, build

COLUMNS = tuple(field.name for field in fields(CutRow))
"""Columns of the output as CSV: all fields of a row, also a new one. The text has those of ``_SHOWN``."""

_SHOWN = ("line", "cut", "elongation", "tension", "front", "whole", "elastic", "notes")
"""Columns of ``as_table`` that are printed as text; the last is printed below its row."""


@dataclass(frozen=True)
class Cut:
    """A cut list, and the solved design that it belongs to."""

    cuts: CutList
    solved: SolvedDesign


def add_options(parser: ArgumentParser) -> None:
    """Add the options of ``busk cut``."""
    add_scan(parser)
    add_lines(parser)
    listed = "list all elastics for a line with their results, or the reason why an elastic cannot be used"
    parser.add_argument("--elastics", metavar="LINE", help=listed)
    same = "lines with an elastic keep the length that they reach without it; the cut length changes"
    parser.add_argument("--keep-fit", action="store_true", help=same)
    add_forms(parser, table=True)


def run(options: Namespace) -> int:
    """Print or write the cut list, or the elastics for a line."""
    design, lines, elastics = design_of(options), options.line or [], options.elastic or []
    if options.elastics is not None:
        stages = with_lines_and_elastics(build(design), lines, elastics)
        make = partial(elastics_text, stages, options.elastics, keep_fit=options.keep_fit)
        forms: dict[str, Callable[[Callable[[], str]], str]] = {"": lambda make: make()}
        forms |= dict.fromkeys(("csv", "json"), _refused)
        return finish(write_output(forms, make, form_of(options), options.out), True)
    solved = solve_design(design, lines, elastics, keep_fit=options.keep_fit)
    cuts = cut_list_of(solved.solution)
    text = write_output(FORMS, Cut(cuts, solved), form_of(options), options.out)
    return finish(text, solved.converged, solved.warnings)


def _text(found: Cut) -> str:
    table = as_table(found.solved.solution.stages, found.cuts, None, _SHOWN)
    first, *lines = table_lines([row[:-1] for row in table])
    lines = [text for line, row in zip(lines, table[1:], strict=True) for text in (line, f"  {row[-1]}")]
    notes = [*filter(str.strip, lines), *map(str, found.cuts.notes)]
    return "\n".join([*found.solved.verdict, *found.solved.effect, "", first, *notes])


def _json(found: Cut) -> str:
    whole = {**found.cuts.as_data(), "assessment": found.solved.assessment.as_data()}
    whole |= {"warnings": plain(found.solved.warnings), "versions": {"busk": __version__}}
    return json.dumps(whole, indent=1, ensure_ascii=False)


def _csv(found: Cut) -> str:
    return csv_text(COLUMNS, found.cuts.rows)


FORMS = {"": _text, "json": _json, "csv": _csv}
"""How a cut list is written."""


def elastics_text(stages: Stages, name: str, *, keep_fit: bool = False) -> str:
    """Return the elastics of the library for a line, and its linked partner, as a table. Raises UserError."""
    design, mode = stages.design, KEEP_FIT if keep_fit else KEEP_CUT
    line = next((each.name for each in stages.model.lines if each.name.lower() == name.strip().lower()), None)
    if line is None:
        known = ", ".join(each.name for each in stages.model.lines)
        raise LineError(
            Message("There is no line '{line}'.", line=LineName(name)),
            Message("Available lines: {known}.", known=known),
        )
    names, rigid = design.linked_lines(line), None
    rows = [["", "elong. %", "cut mm", "body mm", "lift mm", ""]]
    for elastic in (None, *library().values()):
        option = elastic_option(stages, names, elastic, mode)
        rigid = option.outcome if elastic is None else rigid
        view = choice_view(title_of(elastic), option, rigid, names, design)
        values = (each or "-" for each in (view.stretch, view.cut, view.reached, view.lift))
        rows.append([view.title, *values, view.note])
    return "\n".join([mode_text(mode, design), "", *table_lines(rows)])


def _refused(_: object) -> str:
    raise UserError(
        Message("The list of elastics is available as text only."),
        Message("Remove --json, --csv and file names with these endings."),
    )
