"""The files of a comparison of two designs: a row for each body, the differences, and all of it as JSON."""

from __future__ import annotations

import json
from math import isnan
from pathlib import Path
from typing import Any

from app.batch.compared_designs import LIFT, PRESSURE, RESOLUTIONS, VERDICTS, DesignComparison
from core import __version__
from core.analysis.comparison.paired import PairedDifference
from core.export.csv_cells import ENCODING, csv_text
from core.files.atomic_write import write_text

BODIES, DIFFERENCES, SUMMARY = "compare.csv", "differences.csv", "compare.json"
BODY_COLUMNS = ("scan", "first_verdict", "second_verdict", "lift_and_pressure")
"""Columns before those of the quantities."""

DIFFERENCE_COLUMNS = (
    *("quantity", "unit", "bodies", "first_mean", "second_mean", "mean_difference", "low_95", "high_95"),
    *("standard_deviation", "least", "quartile_1", "median", "quartile_3", "most", "more", "equal", "less"),
)


def write_comparison(folder: Path, found: DesignComparison) -> None:
    """Write the files of a comparison. Raises UserError."""
    columns = [*BODY_COLUMNS]
    columns += [f"{part}_{name}" for name in found.values for part in ("first", "second", "difference")]
    _write(folder / BODIES, columns, (_body(found, at) for at in range(len(found.scans))))
    rows = [(name, found.units[name], *_difference(each)) for name, each in found.differences.items()]
    _write(folder / DIFFERENCES, DIFFERENCE_COLUMNS, rows)
    write_text(folder / SUMMARY, json.dumps(summary_of(found), indent=1, ensure_ascii=False) + "\n")


def _write(path: Path, columns: Any, rows: Any) -> None:
    write_text(path, csv_text(columns, rows), encoding=ENCODING)


def outcome(found: DesignComparison, at: int) -> str:
    """Return in one word how lift and pressure of a body change, nothing if they are not known."""
    return next((word for word, bodies in found.tradeoff.outcomes.items() if bodies[at]), "")


def _body(found: DesignComparison, at: int) -> list[object]:
    row: list[object] = [found.scans[at], *found.verdicts[at], outcome(found, at)]
    for first, second in found.values.values():
        row += [known(each) for each in (first[at], second[at], second[at] - first[at])]
    return row


def known(value: float) -> float | None:
    """Return a value, None for not a number."""
    return None if isnan(value) else float(value)


def _difference(each: PairedDifference) -> tuple[object, ...]:
    ends = (each.interval.low, each.interval.high) if each.interval else (None, None)
    means = (each.first_mean, each.second_mean, each.mean)
    signs = (each.more, each.equal, each.less)
    return (each.count, *means, *ends, each.deviation, *each.quantiles, *signs)


def summary_of(found: DesignComparison) -> dict[str, Any]:
    """Return the counts of a comparison as data of JSON."""
    change, unmatched = found.tradeoff, found.unmatched
    return {
        "first": found.names[0],
        "second": found.names[1],
        "bodies": len(found.scans),
        "without_first": list(unmatched.first),
        "without_second": list(unmatched.second),
        "without_both": list(unmatched.both),
        "lift_and_pressure": {
            "bodies": change.count,
            "more_lift_at_no_more_pressure": change.gains_at_no_cost,
            **{word: int(bodies.sum()) for word, bodies in change.outcomes.items()},
            "counts": change.counts.tolist(),
        },
        "verdicts": {"order": list(VERDICTS), "counts": found.verdict_counts.tolist()},
        "equal_up_to": {name: RESOLUTIONS[name] for name in (LIFT, PRESSURE)},
        "versions": {"busk": __version__},
    }
