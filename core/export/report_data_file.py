"""The sheet for other programs: all of it as JSON, its figures as one long table."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

from core.export.csv_cells import csv_text
from core.export.report_data import Report
from core.measurements.uncertain_value import (
    AFTER,
    BEFORE,
    CHANGE,
    CUT,
    LIFT,
    MAX_KPA,
    MEAN_KPA,
    OUT,
    TENSION,
)
from core.messages import join

COLUMNS = (
    *("section", "key", "title", "unit", "before", "after", "difference", "plus_minus", "note"),
    *("off_before", "off_after", "off_difference", "off_factor"),
)
"""The columns of the table; what is told of the body as it is worn stands under *after*."""

Row = dict[str, Any]

_OFF = {BEFORE: "before", AFTER: "after", CHANGE: "difference"}


def report_json(sheet: Report) -> str:
    """Return everything of a sheet as JSON, curves and turns too; lengths in mm, sentences in English."""
    return json.dumps(sheet.as_data(), indent=1, ensure_ascii=False)


def report_csv(sheet: Report) -> str:
    """Return the figures of a sheet as comma-separated values, one a row; curves and turns stay in JSON."""
    return csv_text(COLUMNS, ([row.get(column) for column in COLUMNS] for row in report_rows(sheet)))


def report_rows(sheet: Report) -> Iterator[Row]:
    """Return the rows of the table by column; an empty column may be omitted."""
    heading = sheet.heading
    told = {"customer": heading.customer, "project": heading.project, "variant": heading.variant}
    told |= {"date": heading.date, "scan": sheet.scan, "verdict": sheet.assessment.level}
    told |= {"state": sheet.state, **sheet.versions}
    for key, value in told.items():
        yield {"section": "sheet", "key": key, "title": key.capitalize(), "after": value}
    for each in sheet.sizes:
        size = each["size"] or ""
        yield {"section": "size", "key": each["key"], "title": each["title"], "before": size}
    if sheet.no_size:
        yield {"section": "size", "key": "none", "title": "No size", "note": str(sheet.no_size)}
    for number, reason in enumerate(sheet.assessment.findings, start=1):
        note = str(join((reason.message, reason.action)))
        told = {"key": str(number), "title": reason.topic.capitalize(), "after": reason.level}
        yield {"section": "verdict", **told, "note": note}
    yield from _shape_rows(sheet)
    for row in sheet.measures:
        title = f"{row['title']}, {row['side']}" if row["side"] else str(row["title"])
        known = {key: row[key] for key in ("key", "unit", "before", "after", "difference")}
        off = {f"off_{what}": sheet.off.get(f"{kind}:{row['key']}") for kind, what in _OFF.items()}
        known["note"] = str(row["note"])
        yield {"section": "measure", "title": title, **known, "plus_minus": row["plus_minus"] or None, **off}
    yield from _cut_rows(sheet)
    yield from _pressure_rows(sheet)
    for section, sentences in (("warning", (*sheet.doubts, *sheet.warnings)), ("left out", sheet.left_out)):
        for number, sentence in enumerate(sentences, start=1):
            yield {"section": section, "key": str(number), "note": str(sentence)}


def _shape_rows(sheet: Report) -> Iterator[Row]:
    kept = sheet.volume
    volume = {"before": kept.rest_ml, "after": kept.rest_ml + kept.error_ml, "difference": kept.error_ml}
    yield {"section": "shape", "key": "volume", "title": "Volume of the model", "unit": "ml", **volume}
    if sheet.lift is None:
        return
    for key, value, off in (("up", sheet.lift.up, LIFT), ("forward", sheet.lift.forward, OUT)):
        told = {"key": key, "title": f"Bust points {key}", "unit": "mm", "difference": value}
        yield {"section": "shape", **told, "off_difference": sheet.off.get(off)}


def _cut_rows(sheet: Report) -> Iterator[Row]:
    for row in sheet.cuts.rows:
        about = " ".join(filter(None, (row.elastic, *map(str, row.notes))))
        for key, unit, value, kind in (
            ("cut", "mm", row.cut_mm, CUT),
            ("width", "mm", row.width_mm, ""),
            ("reached front", "mm", row.reached_front_mm, ""),
            ("reached whole", "mm", row.reached_whole_mm, ""),
            ("stretch", "%", None if row.elongation is None else 100.0 * row.elongation, ""),
            ("tension", "N", row.tension_n, TENSION),
        ):
            title = f"{row.title}: {key}"
            told = {"key": f"{row.line}: {key}", "title": title, "unit": unit, "after": value}
            yield {"section": "cut", **told, "note": about, **_off(sheet, kind, row.line)}
    for number, note in enumerate(sheet.cuts.notes, start=1):
        yield {"section": "cut", "key": str(number), "note": str(note)}


def _pressure_rows(sheet: Report) -> Iterator[Row]:
    for row in (*sheet.pressures, *sheet.cups):
        note = " ".join(filter(None, (row.light, row.where, *map(str, row.notes))))
        for key, unit, value, kind in (
            ("largest pressure", "kPa", row.max_kpa, MAX_KPA),
            ("largest pressure", "mmHg", row.max_mmhg, ""),
            ("mean pressure", "kPa", row.mean_kpa, MEAN_KPA),
            ("mean pressure", "mmHg", row.mean_mmhg, ""),
            ("force", "N", row.force_n, ""),
            ("bridged", "mm", row.bridged_mm, ""),
        ):
            told = {"key": f"{row.line}: {key} {unit}", "title": f"{row.title}: {key}", "unit": unit}
            told |= _off(sheet, kind, row.line)
            yield {"section": "pressure", **told, "after": value, "note": note}


def _off(sheet: Report, kind: str, line: str) -> Row:
    """Return how far a figure of a line may be off, in its unit or as a factor [1]; None where not known."""
    key = f"{kind}:{line}"
    return {"off_after": sheet.off.get(key), "off_factor": sheet.off_factor.get(key)}
