"""How far the figures of a solved design may be off, in words and figures, as JSON or as a table."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from app.cli.output import told
from app.cli.solve_design import Worn, run_worn
from core import __version__
from core.analysis.uncertainty.estimate import spread_of
from core.analysis.uncertainty.input_uncertainty import assumed, assuming, origins
from core.analysis.uncertainty.outputs import figures_of
from core.document.design import Design
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
    Spread,
    told_between,
    told_off,
)

COLUMNS = ("key", "title", "unit", "value", "plus_minus", "low", "high", *SOURCES, "other_contact")
KINDS = {BEFORE: "before", AFTER: "after", CHANGE: "difference"}
OF_LINES = {
    "cut": ("cut length", "mm"),
    "tension": ("tension", "N"),
    "max_kpa": ("maximum contact pressure", "kPa"),
    "mean_kpa": ("mean contact pressure", "kPa"),
}
OF_BUST = {"lift": "Bust point up", "out": "Bust point forward"}
WORDS = {"glued": "bonded", "sliding": "sliding"}


@dataclass(frozen=True)
class Figure:
    """One figure as it stands in a list: ``key`` see ``uncertain_value``; None where not known."""

    key: str
    title: str
    unit: str
    value: float | None


@dataclass(frozen=True)
class Spreading:
    """The ``spread`` of all ``figures`` of a design that was solved."""

    spread: Spread
    figures: list[Figure]
    worn: Worn


def run_spread(
    design: Design, lines: Sequence[str], elastics: Sequence[str], sizes: Sequence[str]
) -> Spreading:
    """Solve a design with lines and elastics as requested, and spread its figures. Raises UserError.

    ``sizes`` like "tape_mm=3" say what is assumed otherwise.
    """
    wanted = assuming(sizes, assumed())
    worn = run_worn(design, lines, elastics, bare=True)
    stages, points = worn.solution.stages, worn.solution.control_points
    figures = [*_of_measures(measure_rows(*before_after(stages, points)))]
    if stages.design.worn():
        figures += _of_lines(figures_of(stages, points))
    return Spreading(spread_of(stages, wanted), figures, worn)


def spread_text(found: Spreading, kind: str, out: str | None) -> str:
    """Return what to print, or write it to a file ``out``; see ``told``. Raises UserError."""
    return told(_FORMS, found, kind, out)


def _of_measures(rows: Sequence[Mapping[str, Any]]) -> Iterator[Figure]:
    for row in rows:
        title = f"{row['title']}, {row['side']}" if row["side"] else row["title"]
        for kind, column in KINDS.items():
            yield Figure(f"{kind}:{row['key']}", title, row["unit"], row[column])


def _of_lines(figures: Mapping[str, float]) -> Iterator[Figure]:
    for key, value in figures.items():
        kind, _, line = key.partition(":")
        if line:
            words, unit = OF_LINES[kind]
            yield Figure(key, f"{line}: {words}", unit, max(value, 0.0))  # a slack line does not push
        else:
            what, _, side = key.partition(" ")
            yield Figure(key, f"{OF_BUST[what]}, {side or 'mean'}", "mm", value)


def _plain(found: Spreading) -> str:
    tables = [_of_body(found)] if found.spread.bare else [_of_both(found), ["", *_of_worn(found)]]
    rows = [line for table in tables for line in table]
    return "\n".join([*found.worn.verdict, "", *rows, "", *_meaning(found)])


def _of_body(found: Spreading) -> list[str]:
    lines = ["No active lines: values of the original body."]
    for figure in found.figures:
        if figure.key.startswith(f"{BEFORE}:") and figure.value is not None:
            lines.append(f"{figure.title:36}{_cell(found.spread, figure):>17} {figure.unit}")
    return lines


def _of_both(found: Spreading) -> list[str]:
    lines = [f"{'':36}{'before':>17}{'after':>17}{'change':>16}"]
    measures = [figure for figure in found.figures if figure.key.partition(":")[0] in KINDS]
    for first in range(0, len(measures), len(KINDS)):
        group = measures[first : first + len(KINDS)]
        if any(figure.value is not None for figure in group):
            cells = [_cell(found.spread, figure) for figure in group]
            lines.append(f"{group[0].title:36}{cells[0]:>17}{cells[1]:>17}{cells[2]:>16} {group[0].unit}")
    return lines


def _of_worn(found: Spreading) -> list[str]:
    lines = [f"{'':36}{'as set':>20}{_contact(found.spread):>30}"]
    for figure in found.figures:
        if figure.key.partition(":")[0] not in KINDS:
            other = found.spread.other.get(figure.key)
            beside = "-" if other is None else f"{max(other, 0.0) if figure.unit == 'N' else other:.1f}"
            lines.append(f"{figure.title:36}{_cell(found.spread, figure):>20}{beside:>30} {figure.unit}")
    return lines


def _cell(spread: Spread, figure: Figure) -> str:
    if figure.value is None:
        return "-"
    sign = "+" if figure.key.startswith((CHANGE, "lift", "out")) else ""
    value = format(figure.value, f"{sign}z.1f")
    off, between = spread.plus_minus(figure.key), spread.between(figure.key, figure.value)
    if off is not None:
        return f"{value} ± {told_off(off):>4}"
    return f"{value} ({told_between(*between)})" if between else value


def _contact(spread: Spread) -> str:
    return f"skin contact {WORDS[spread.contact]}" if spread.contact else ""


def _meaning(found: Spreading) -> Iterator[str]:
    spread = found.spread
    yield f"± is {spread.sds:g} standard deviations (2: 95 % of cases for normal errors), from:"
    yield from (f"  {words.en}" for name, words in origins().items() if name in _sources(spread))
    if not spread.bare:
        yield from _of_lines_worn(found)
    yield from spread.cautions
    if spread.failed:
        yield f"Excluded, no solution: {spread.failed} samples."
    yield "Not included:"
    yield from (f"  {each}" for each in (*NOT_MODELLED, *(() if spread.bare else LEFT_OUT)))


def _sources(spread: Spread) -> Sequence[str]:
    return (LANDMARKS, SCAN, ROOT) if spread.bare else SOURCES


def _of_lines_worn(found: Spreading) -> Iterator[str]:
    """Yield what holds where lines are worn."""
    if any(found.spread.factor(figure.key) for figure in found.figures):
        yield "(a to b): asymmetric range of a parameter known to a factor only."
    yield "The skin contact is a model option and not included in ±: the real value is between the two."


def _as_json(found: Spreading) -> str:
    spread = found.spread
    table = {}
    for figure in found.figures:
        doubt = spread.doubts.get(figure.key)
        told: dict[str, Any] = {"title": figure.title, "unit": figure.unit, "value": figure.value}
        low, high = _ends(spread, figure)
        told |= {"plus_minus": spread.plus_minus(figure.key), "low": low, "high": high}
        told |= {"shares": doubt.shares if doubt else None, "other_contact": spread.other.get(figure.key)}
        table[figure.key] = told
    whole = {
        "figures": table,
        "standard_deviations": spread.sds,
        "skin_mm": {"before": spread.sds * spread.rest, "after_most": spread.sds * float(spread.skin.max())},
        "contact": spread.contact,
        "failed": spread.failed,
        "sources": {name: words.en for name, words in origins().items()},
        "left_out": [*NOT_MODELLED, *LEFT_OUT],
        "cautions": list(spread.cautions),
        "assessment": found.worn.assessment.as_data(),
        "warnings": found.worn.warnings,
        "versions": {"busk": __version__},
    }
    return json.dumps(whole, indent=1, ensure_ascii=False)


def _ends(spread: Spread, figure: Figure) -> tuple[float | None, float | None]:
    """Return between what a figure may lie, or nothing of one that is not known."""
    return (None if figure.value is None else spread.between(figure.key, figure.value)) or (None, None)


def _as_csv(found: Spreading) -> str:
    rows = []
    for figure in found.figures:
        doubt = found.spread.doubts.get(figure.key)
        by = doubt.by_source if doubt else {}
        off, ends = found.spread.plus_minus(figure.key), _ends(found.spread, figure)
        sources = [by.get(name) for name in SOURCES]
        other = found.spread.other.get(figure.key)
        rows.append([figure.key, figure.title, figure.unit, figure.value, off, *ends, *sources, other])
    return csv_text(COLUMNS, rows).rstrip("\n")


_FORMS = {"": _plain, "json": _as_json, "csv": _as_csv}
