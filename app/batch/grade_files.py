"""The files of a grading: tables as CSV, and all of it as JSON."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict
from math import isnan
from pathlib import Path
from typing import Any

from app.batch.grading import Grading
from core import __version__
from core.analysis.grading.coverage import Coverage
from core.analysis.grading.grade_rule import StepIncrement
from core.analysis.grading.increments import Interval
from core.analysis.grading.service import Served
from core.analysis.grading.tolerance import LEAST_MM
from core.export.csv_cells import ENCODING, csv_text
from core.files.atomic_write import write_text

Cells = Iterator[tuple[object, ...]]

SIZES, INCREMENTS, RULES = "grade.csv", "increments.csv", "grade_rules.csv"
SERVED, NEW_SIZES, SUMMARY = "served.csv", "new_sizes.csv", "grade.json"

SIZE_COLUMNS = (
    *("variant", "measure", "unit", "size", "bodies", "mean", "standard_deviation", "standard_error"),
    *("least", "most"),
)
INCREMENT_COLUMNS = (
    *("variant", "measure", "unit", "step", "from_size", "to_size", "from_bodies", "to_bodies"),
    *("increment", "standard_error", "low_95", "high_95"),
)
RULE_COLUMNS = (
    *("variant", "measure", "unit", "bodies", "base_size", "at_base_size"),
    *("per_band", "per_band_error", "per_band_low_95", "per_band_high_95"),
    *("per_cup", "per_cup_error", "per_cup_low_95", "per_cup_high_95"),
    *("residual_deviation", "explained_share", "nonlinearity_p", "within_tolerance_share"),
)
SERVED_COLUMNS = (
    *("variant", "scan", "size", "served", "measure", "garment", "body", "unit", "tolerance_share"),
    *("best_size", "served_by_best", "best_measure", "best_tolerance_share", "note"),
)
NEW_SIZE_COLUMNS = ("variant", "number", "scan", "size", "bodies_served")
"""Columns before those of the measures."""

NO_GARMENT = "no garment of this size without this body"


def write_gradings(folder: Path, gradings: Sequence[Grading]) -> None:
    """Write all files of the gradings of the variants of a run. Raises UserError."""
    tables = (
        (SIZES, SIZE_COLUMNS, _sizes),
        (INCREMENTS, INCREMENT_COLUMNS, _increments),
        (RULES, RULE_COLUMNS, _rules),
        (SERVED, SERVED_COLUMNS, _served),
    )
    for name, columns, rows in tables:
        _write(folder / name, columns, (row for each in gradings for row in rows(each)))
    measures = list(dict.fromkeys(m.name for each in gradings for m in each.graded.bodies.measures))
    heading = (*NEW_SIZE_COLUMNS, *measures)
    _write(folder / NEW_SIZES, heading, (row for each in gradings for row in _new_sizes(each, measures)))
    write_text(folder / SUMMARY, json.dumps(summary_of(gradings), indent=1, ensure_ascii=False) + "\n")


def _write(path: Path, columns: Sequence[str], rows: Iterable[Iterable[object]]) -> None:
    write_text(path, csv_text(columns, rows), encoding=ENCODING)


def _sizes(grading: Grading) -> Cells:
    label = grading.graded.grouping.label
    for each in grading.spreads:
        of = each.spread
        numbers = (of.mean, of.deviation, of.error, of.least, of.most)
        yield (
            grading.graded.variant,
            each.measure.name,
            each.measure.unit,
            label(each.code),
            of.count,
            *numbers,
        )


def _increments(grading: Grading) -> Cells:
    label = grading.graded.grouping.label
    for each in grading.increments:
        head = (grading.graded.variant, each.measure.name, each.measure.unit, each.part)
        sizes = (label(each.smaller), label(each.larger), *each.counts)
        yield (*head, *sizes, each.value, each.error, *_ends(each.interval))


def _rules(grading: Grading) -> Cells:
    label = grading.graded.grouping.label
    for rule in grading.rules:
        head = (grading.graded.variant, rule.measure.name, rule.measure.unit, rule.count)
        steps = (*_step(rule.per_band), *_step(rule.per_cup))
        fit = (rule.residual, rule.explained, rule.nonlinearity, grading.service.within(rule.measure))
        yield (*head, label(rule.base), rule.at_base, *steps, *fit)


def _step(step: StepIncrement | None) -> tuple[float | None, ...]:
    return (step.value, step.error, *_ends(step.interval)) if step else (None, None, None, None)


def _ends(interval: Interval | None) -> tuple[float | None, float | None]:
    return (interval.low, interval.high) if interval else (None, None)


def _served(grading: Grading) -> Cells:
    graded = grading.graded
    for each in grading.service.bodies:
        own, best = each.own, each.best
        measured = (
            (own.measure.name, own.garment, own.body, own.measure.unit, own.excess) if own else (None,) * 5
        )
        best_size = graded.grouping.label(each.best_code) if each.best_code else None
        other = (best.measure.name, best.excess) if best else (None, None)
        head = (graded.variant, graded.bodies.names[each.body], graded.grouping.label(each.code))
        yield (*head, each.by_own, *measured, best_size, each.by_best, *other, note_of(each))


def note_of(each: Served) -> str:
    """Return why a body was not compared with its size, nothing if it was."""
    if each.lacking is not None:
        return f"{each.lacking.name} is not known"
    return NO_GARMENT if each.own is None else ""


def _new_sizes(grading: Grading, measures: Sequence[str]) -> Cells:
    if grading.coverage is None:
        return
    graded = grading.graded
    places = {measure.name: at for at, measure in enumerate(graded.bodies.measures)}
    for number, size in enumerate(grading.coverage.sizes, 1):
        label = graded.grouping.label(grading.service.bodies[size.body].code)
        values = [
            float(graded.bodies.values[size.body, places[name]]) if name in places else None
            for name in measures
        ]
        head = (graded.variant, number, graded.bodies.names[size.body], label, len(size.serves))
        yield (*head, *(None if each is None or isnan(each) else each for each in values))


def summary_of(gradings: Sequence[Grading]) -> dict[str, Any]:
    """Return the counts and choices of gradings, as data of JSON."""
    return {"variants": [_summary(each) for each in gradings], "versions": {"busk": __version__}}


def _summary(grading: Grading) -> dict[str, Any]:
    graded, left_out = grading.graded, grading.graded.left_out
    return {
        "variant": graded.variant,
        "by": graded.grouping.by,
        "system": graded.grouping.table.key,
        "bodies": graded.bodies.count,
        "sizes": grading.sizes,
        "left_out": {
            "states": left_out.states,
            "verdicts": left_out.verdicts,
            "no_size": left_out.no_size,
            "copies": left_out.copies,
        },
        "measures": [each.name for each in graded.bodies.measures],
        "tolerance_percent": {
            each.name: 100.0 * float(share)
            for each, share in zip(graded.bodies.measures, grading.shares, strict=True)
            if not isnan(share)
        },
        "least_tolerance_mm": LEAST_MM,
        "garments": grading.options.garments,
        "served": {
            garments: {"own_size": asdict(own), "any_size": asdict(grading.by_best[garments])}
            for garments, own in grading.by_own.items()
        },
        "new_sizes": grading.coverage and _coverage(grading.coverage),
    }


def _coverage(found: Coverage) -> dict[str, Any]:
    return {
        "share_wanted": found.share,
        "bodies": found.count,
        "served": found.served,
        "sizes": len(found.sizes),
        "sizes_at_least": found.least,
        "held_out_share": found.held_out,
        "curve": list(found.curve),
        "sampled": found.sampled,
    }
