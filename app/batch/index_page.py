"""The page of a run: one HTML file with a table that sorts and filters, and distributions; no network."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Sequence
from html import escape
from importlib import resources
from typing import Any

import numpy as np
import pyarrow as pa

from app.batch.batch_design import BatchDesign
from app.batch.one_body import Row
from app.batch.schema import DONE, FOLDERS, columns_of
from app.batch.svg_plots import histogram, number_axis

MOST_ROWS = 20_000
"""Rows of the page: a browser shows no more with ease. The doubtful come first, the table has all."""

SHOWN = (
    *("scan", "variant", "state", "verdict", "message", "doubts", "band_eu", "cup_eu", "band_jp", "cup_jp"),
    *("bust_mm", "underbust_mm", "lift_left_mm", "lift_right_mm", "volume_error_percent", "target_miss_mm"),
)
"""Columns that the page begins with, if there are values; those of lines follow."""

_LINE_PARTS = ("cut_length_", "pressure_max_")
_PLOTTED = ("bust_mm", "underbust_mm", "lift_left_mm", "target_miss_mm", *_LINE_PARTS)
_DOUBTFUL = {"": 3, "bad": 2, "caution": 1, "good": 0}


def index_page(table: pa.Table, designs: Sequence[BatchDesign]) -> str:
    """Return the page of all rows of a ``table``, the doubtful ones first."""
    marks = table.select(["state", "verdict", "doubts"]).to_pylist()
    ranked = sorted(range(len(marks)), key=lambda at: (marks[at]["state"] == DONE, -_doubt(marks[at])))
    rows = table.take(pa.array(ranked[:MOST_ROWS], pa.int64())).to_pylist()
    columns = [name for name in _columns(rows) if name != "variant" or len(designs) > 1]
    units = {each.name: each.unit for each in columns_of(designs)}
    values = {
        "columns": columns,
        "labels": [label_of(name, units[name]) for name in columns],
        "units": [units[name] for name in columns],
        "rows": [[_short(row.get(name)) for name in columns] for row in rows],
        "files": [{kind: row.get(f"{kind}_file") or "" for kind in FOLDERS} for row in rows],
    }
    # "<" would end the script wherever a name of a file says so.
    data = json.dumps(values, ensure_ascii=False).replace("<", "\\u003c")
    page = (resources.files("resources") / "pages" / "batch.html").read_text(encoding="utf-8")
    note = f"The page shows {len(rows)} of {len(marks)} rows." if len(rows) < len(marks) else ""
    parts = {
        "variants": escape(", ".join(each.name for each in designs)),
        "counts": escape(_counts(marks)),
        "note": note,
        "plots": "".join(_plot(name, units[name], table) for name in columns if name.startswith(_PLOTTED)),
        "data": data,
    }
    for name, text in parts.items():
        page = page.replace(f"<!--{name}-->", text)
    return page


def label_of(name: str, unit: str) -> str:
    """Return the name of a column as words, without its ``unit``."""
    stem = name.rpartition("_")[0] if unit else name
    words = stem.replace("_", " ").replace("underbust", "under-bust")
    words = words.removesuffix(" eu") + " (EU)" if words.endswith(" eu") else words
    words = words.removesuffix(" jp") + " (JP)" if words.endswith(" jp") else words
    return words[:1].upper() + words[1:]


def _doubt(row: Row) -> int:
    return 2 * _DOUBTFUL.get(row.get("verdict") or "", 3) + bool(row.get("doubts"))


def _columns(rows: Sequence[Row]) -> list[str]:
    names = dict.fromkeys(name for row in rows for name in row)
    lines = (name for name in names if name.startswith(_LINE_PARTS))
    return [name for name in (*SHOWN, *lines) if any(row.get(name) not in (None, "") for row in rows)]


def _short(value: Any) -> Any:
    return round(value, 2) if isinstance(value, float) else value


def _counts(rows: Sequence[Row]) -> str:
    words = [row["verdict"] if row["state"] == DONE else row["state"] for row in rows]
    return ", ".join(f"{count} {word}" for word, count in sorted(Counter(words).items())) or "no rows"


def _plot(name: str, unit: str, table: pa.Table) -> str:
    """Return the distribution of a column with its mean and standard deviation, empty without one."""
    values = table.column(name).drop_null().to_numpy()
    if len(values) < 2 or np.ptp(values) == 0.0:
        return ""
    about = f"mean {values.mean():.4g}, SD {values.std(ddof=1):.3g}"
    return histogram(f"{label_of(name, unit)} [{unit}]: {about}", number_axis("", values), values)
