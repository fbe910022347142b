"""Compute the uncertainty (±) of the results of a design, its sources, and what is not included."""

from __future__ import annotations

import json
from argparse import ArgumentParser, Namespace
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from app.cli.design import design_of
from app.cli.options import add_forms, add_lines, add_scan, form_of
from app.cli.output import finish, table_lines, write_output
from app.cli.solved_design import SolvedDesign, solve_design
from app.presenters.uncertainty import limitation_sentences
from core import __version__
from core.analysis.uncertainty.estimate import estimate_uncertainty
from core.analysis.uncertainty.input_uncertainty import NUMBERS, default_uncertainty, origins, with_overrides
from core.analysis.uncertainty.outputs import output_values
from core.export.csv_cells import csv_text
from core.export.report_data import NOT_MODELLED
from core.garment.pressure import LEFT_OUT
from core.measurements.table import before_after, measure_rows
from core.measurements.uncertain_value import (
    AFTER,
    BEFORE,
    CHANGE,
    LANDMARKS,
    ROOT,
    SCAN,
    SOURCES,
    OutputUncertainties,
    format_range,
    format_uncertainty,
)
from core.messages import plain

COLUMNS = ("key", "title", "unit", "value", "plus_minus", "low", "high", *SOURCES, "other_contact")
KINDS = {BEFORE: "before", AFTER: "after", CHANGE: "difference"}
OF_LINES = {
    "cut": ("cut length", "mm"),
    "tension": ("tension", "N"),
    "max_kpa": ("maximum contact pressure", "kPa"),
    "mean_kpa": ("mean contact pressure", "kPa"),
}
OF_BUST = {"lift": "Bust point lift", "out": "Bust point, forward"}
WORDS = {"glued": "bonded", "sliding": "sliding"}


@dataclass(frozen=True)
class Value:
    """One result: ``key`` see ``uncertain_value``; ``value`` is None where it is not known."""

    key: str
    title: str
    unit: str
    value: float | None


@dataclass(frozen=True)
class Uncertainties:
    """The ``spread`` of all ``values`` of a solved design."""

    spread: OutputUncertainties
    values: list[Value]
    solved: SolvedDesign


def add_options(parser: ArgumentParser) -> None:
    """Add the options of ``busk uncertainty``."""
    add_scan(parser)
    add_lines(parser)
    assume = f"set a standard deviation; may be repeated. Names: {', '.join(NUMBERS)}"
    parser.add_argument("--assume", action="append", metavar="NAME=NUMBER", help=assume)
    add_forms(parser, table=True)


def run(options: Namespace) -> int:
    """Print or write the results with their uncertainties. Raises UserError."""
    wanted = with_overrides(options.assume or [], default_uncertainty())
    solved = solve_design(design_of(options), options.line or [], options.elastic or [], bare=True)
    stages, points = solved.solution.stages, solved.solution.control_points
    values = [*_of_measures(measure_rows(*before_after(stages, *solved.solution.region_points)))]
    if stages.design.active_lines():
        values += _of_lines(output_values(stages, points))
    spread = estimate_uncertainty(stages, wanted)
    known = {value.key for value in values}
    below = {key: value for key, value in spread.values.items() if _of_line(key) and key not in known}
    values += _of_lines(below if stages.lower is not None else {})
    found = Uncertainties(spread, values, solved)
    text = write_output(_FORMS, found, form_of(options), options.out)
    return finish(text, solved.converged, solved.warnings)


def _of_measures(rows: Sequence[Mapping[str, Any]]) -> Iterator[Value]:
    for row in rows:
        title = f"{row['title']}, {row['side']}" if row["side"] else str(row["title"])
        for kind, column in KINDS.items():
            yield Value(f"{kind}:{row['key']}", title, row["unit"], row[column])


def _of_line(key: str) -> bool:
    return key.partition(":")[0] in OF_LINES


def _of_lines(outputs: Mapping[str, float]) -> Iterator[Value]:
    for key, value in outputs.items():
        kind, _, line = key.partition(":")
        if line:
            words, unit = OF_LINES[kind]
            yield Value(key, f"{line}: {words}", unit, max(value, 0.0))  # a slack line does not push
        else:
            what, _, side = key.partition(" ")
            yield Value(key, f"{OF_BUST[what]}, {side or 'mean'}", "mm", value)


def _text(found: Uncertainties) -> str:
    if found.spread.bare:
        body = table_lines(_body_rows(found, ("before",)))
        tables = ["No active lines: values of the original body.", *body]
    else:
        body = table_lines(_body_rows(found, tuple(KINDS.values())))
        tables = [*body, "", *table_lines(_line_rows(found))]
    return "\n".join([*found.solved.verdict, "", *tables, "", *_meaning(found)])


def _body_rows(found: Uncertainties, columns: Sequence[str]) -> Iterator[Sequence[str]]:
    """Yield a heading, then the measurements that are known."""
    yield ("", *columns, "")
    measured = [value for value in found.values if value.key.partition(":")[0] in KINDS]
    for first in range(0, len(measured), len(KINDS)):
        shown = measured[first : first + len(columns)]
        if any(value.value is not None for value in shown):
            yield (shown[0].title, *(_cell(found.spread, value) for value in shown), shown[0].unit)


def _line_rows(found: Uncertainties) -> Iterator[Sequence[str]]:
    """Yield a heading, then the results of the lines, also with the other skin contact."""
    spread = found.spread
    yield ("", "as set", f"skin contact {WORDS[spread.contact]}" if spread.contact else "", "")
    for value in found.values:
        if value.key.partition(":")[0] not in KINDS:
            other = spread.other.get(value.key)
            blank = "-" if spread.contact else ""
            beside = blank if other is None else f"{max(other, 0.0) if value.unit == 'N' else other:.1f}"
            yield (value.title, _cell(spread, value), beside, value.unit)


def _cell(spread: OutputUncertainties, result: Value) -> str:
    if result.value is None:
        return "-"
    sign = "+" if result.key.startswith((CHANGE, "lift", "out")) else ""
    value = format(result.value, f"{sign}z.1f")
    off, between = spread.plus_minus(result.key), spread.between(result.key, result.value)
    if off is not None:
        return f"{value} ± {format_uncertainty(off):>4}"
    return f"{value} ({format_range(*between)})" if between else value


def _meaning(found: Uncertainties) -> Iterator[str]:
    spread = found.spread
    yield f"± is {spread.sds:g} standard deviations (2: 95 % of cases for normal errors), from:"
    sources = (LANDMARKS, SCAN, ROOT) if spread.bare else SOURCES
    yield from (f"  {words.en}" for name, words in origins().items() if name in sources)
    if any(spread.factor(value.key) for value in found.values) and not spread.bare:
        yield "(a to b): asymmetric range of a parameter known to a factor only."
    if spread.contact:
        yield ("The skin contact is a model option and not included in ±: the real value is between the two.")
    yield from map(str, spread.cautions)
    if spread.failed:
        yield f"Excluded, no solution: {spread.failed} samples."
    yield "Not included:"
    yield from (f"  {each}" for each in (NOT_MODELLED if spread.bare else limitation_sentences()))


def _json(found: Uncertainties) -> str:
    spread = found.spread
    table = {}
    for result in found.values:
        doubt = spread.by_output.get(result.key)
        row: dict[str, Any] = {"title": result.title, "unit": result.unit, "value": result.value}
        low, high = _ends(spread, result)
        row |= {"plus_minus": spread.plus_minus(result.key), "low": low, "high": high}
        row |= {"shares": doubt.shares if doubt else None, "other_contact": spread.other.get(result.key)}
        table[result.key] = row
    whole = {
        "figures": table,
        "standard_deviations": spread.sds,
        "skin_mm": {"before": spread.sds * spread.rest, "after_most": spread.sds * float(spread.skin.max())},
        "contact": spread.contact,
        "failed": spread.failed,
        "sources": {name: words.en for name, words in origins().items()},
        "left_out": plain([*NOT_MODELLED, *LEFT_OUT]),
        "cautions": plain(spread.cautions),
        "assessment": found.solved.assessment.as_data(),
        "warnings": plain(found.solved.warnings),
        "versions": {"busk": __version__},
    }
    return json.dumps(whole, indent=1, ensure_ascii=False)


def _ends(spread: OutputUncertainties, result: Value) -> tuple[float | None, float | None]:
    """Return the range of a result, or None of one that is not known."""
    return (None if result.value is None else spread.between(result.key, result.value)) or (None, None)


def _csv(found: Uncertainties) -> str:
    rows = []
    for result in found.values:
        doubt = found.spread.by_output.get(result.key)
        by = doubt.by_source if doubt else {}
        off, ends = found.spread.plus_minus(result.key), _ends(found.spread, result)
        sources = [by.get(name) for name in SOURCES]
        other = found.spread.other.get(result.key)
        rows.append([result.key, result.title, result.unit, result.value, off, *ends, *sources, other])
    return csv_text(COLUMNS, rows).rstrip("\n")


_FORMS = {"": _text, "json": _json, "csv": _csv}
