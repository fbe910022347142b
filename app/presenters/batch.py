"""A batch run in words: rows of its table, the order by doubt, filters, counts and progress."""

from __future__ import annotations

import os
from array import array
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from app.i18n.catalog import joined, listed, number, tr, tr_plural
from app.i18n.lengths import length_number, length_unit
from app.presenters.assessment import headline
from app.presenters.english_text import shown_text
from app.presenters.messages import sentence_text
from core.garment.assessment import BAD, CAUTION, GOOD
from core.measurements.sizes import built_in

NOT_COMPUTED = ("refused", "crashed", "timeout")
"""States of rows without results; the level of the others is that of their verdict."""

FAILURES = NOT_COMPUTED[1:]
"""States that can be others when a body is computed again."""

_DOUBT = {**dict.fromkeys(NOT_COMPUTED, 8), BAD: 4, CAUTION: 2, GOOD: 0}
_TONES = {GOOD: "ok", CAUTION: "warn", BAD: "bad"}
_ICONS = {GOOD: "check-circle", CAUTION: "warning", BAD: "warning-octagon"}
_MINUTE, _HOUR = 60, 3600

ALL, DOUBTFUL, FAILED = "all", "doubtful", "failed"


def filter_titles() -> tuple[tuple[str, str], ...]:
    """Return the filters of rows by name with their titles."""
    return (ALL, tr("All")), (DOUBTFUL, tr("To check")), (FAILED, tr("Not computed"))


@dataclass(frozen=True, eq=False)
class BatchRow:
    """A body and variant; ``level`` is that of its verdict, or its state if there are no results.

    ``message`` and ``doubts`` are English, as in the files. ``numbers`` are the values of the numeric columns
    of the run, in their order, not a number where unknown; ``picture`` and ``report`` are files in the folder
    of results, empty without one.
    """

    scan: str
    variant: str
    level: str
    message: str
    doubts: str
    sizes: Mapping[str, tuple[str, str]]
    numbers: array[float]
    picture: str = ""
    report: str = ""

    @property
    def key(self) -> tuple[str, str]:
        """Return what the row is of: there is one row of each."""
        return self.scan, self.variant

    @cached_property
    def name(self) -> str:
        """Return the name of the scan without its folder."""
        return os.path.basename(self.scan)

    @property
    def doubt(self) -> int:
        """Return how doubtful the row is: 0 if nothing is."""
        return _DOUBT.get(self.level, 8) + bool(self.doubts)

    @cached_property
    def verdict(self) -> str:
        """Return the verdict, or why there is none."""
        return level_title(self.level)

    @cached_property
    def remarks(self) -> str:
        """Return all that is to be known of the row."""
        return joined((shown_text(self.message), shown_text(self.doubts)))

    @property
    def tone(self) -> str:
        """Return the tone of the verdict."""
        return _TONES.get(self.level, "bad")

    @property
    def icon(self) -> str:
        """Return the drawing of the verdict."""
        return _ICONS.get(self.level, "x")

    def holds(self, words: Sequence[str], only: str) -> bool:
        """Return whether the row passes a filter, and all ``words``, in small letters, are in its texts."""
        if only != ALL and not (self.doubt if only == DOUBTFUL else self.level in NOT_COMPUTED):
            return False
        return not words or all(each in self._searched for each in words)

    @cached_property
    def _searched(self) -> str:
        return " ".join((self.scan, self.variant, self.verdict, self.message, self.doubts)).lower()


def level_title(level: str) -> str:
    """Return the words for a verdict, or for the state of a row without one."""
    states = {"refused": tr("Refused"), "crashed": tr("Failed"), "timeout": tr("Out of time")}
    return states.get(level) or headline(level if level in _TONES else BAD)


def row_heading(row: BatchRow) -> str:
    """Return which row it is, with its verdict."""
    return f"{row.name} \N{MIDDLE DOT} {row.variant} \N{MIDDLE DOT} {row.verdict}"


def batch_row(values: Mapping[str, Any], numbers: Sequence[str]) -> BatchRow:
    """Return a row of results; ``numbers`` are the names of its numeric columns."""
    state = values.get("state") or "crashed"
    sizes = {
        table.key: (values.get(f"band_{table.key}"), values.get(f"cup_{table.key}")) for table in built_in()
    }
    known = (values.get(name) for name in numbers)
    return BatchRow(
        values["scan"],
        values["variant"],
        (values.get("verdict") or BAD) if state == "done" else state,
        values.get("message") or "",
        values.get("doubts") or "",
        {key: (band, cup) for key, (band, cup) in sizes.items() if band and cup},
        array("d", [float("nan") if each is None else each for each in known]),
        values.get("picture_file") or "",
        values.get("report_file") or "",
    )


# -- the cells of the table


@dataclass(frozen=True)
class Cells:
    """The columns of the table: what a row shows and is sorted by in each, with sizes of one system."""

    numbers: Mapping[str, int]
    system: str

    def titles(self) -> dict[str, str]:
        """Return the columns with their titles."""
        unit = length_unit()
        return {
            "scan": tr("Scan"),
            "variant": tr("Design"),
            "verdict": tr("Verdict"),
            "bust": tr("Bust {unit}").format(unit=unit),
            "underbust": tr("Under-bust {unit}").format(unit=unit),
            "size": tr("Size {system}").format(system=self.system.upper()),
            "lift": tr("Lift {unit}").format(unit=unit),
            "remarks": tr("Remarks"),
        }

    def text(self, row: BatchRow, column: str) -> str:
        """Return what a cell shows."""
        if column == "size":
            return self._size(row)
        if column == "lift":
            return _length(self._mean(row, "lift_left_mm", "lift_right_mm"), 1, signed=True)
        if column in ("bust", "underbust"):
            return _length(self._number(row, f"{column}_mm"), 0)
        texts = {"scan": row.name, "variant": row.variant, "verdict": row.verdict, "remarks": row.remarks}
        return texts[column]

    def sort_key(self, row: BatchRow, column: str) -> tuple[bool, float, str]:
        """Return what a row is sorted by in a column; unknown values are last."""
        match column:
            case "bust" | "underbust":
                value = self._number(row, f"{column}_mm")
            case "lift":
                value = self._mean(row, "lift_left_mm", "lift_right_mm")
            case "size":
                under, bust = (self._number(row, name) for name in ("underbust_mm", "bust_mm"))
                band, cup = row.sizes.get(self.system, ("", ""))
                digits = "".join(filter(str.isdigit, band))
                value = float(digits) + (bust - under) / 1e4 if cup and digits else float("nan")
            case "verdict":
                return False, -row.doubt, ""
            case _:
                text = row.message if column == "remarks" else self.text(row, column)
                return False, 0.0, text.lower()
        return value != value, value if value == value else 0.0, ""  # noqa: PLR0124 (not a number)

    def tip(self, row: BatchRow, column: str) -> str:
        """Return what a cell has no room for."""
        if column == "scan":
            return row.scan
        if column == "lift" and self.text(row, column):
            sides = (self._number(row, f"lift_{side}_mm") for side in ("left", "right"))
            left, right = (_length(each, 1, signed=True) for each in sides)
            return tr("Left {left}, right {right}").format(left=left, right=right)
        return row.remarks if column in ("remarks", "verdict") else ""

    def _size(self, row: BatchRow) -> str:
        band, cup = row.sizes.get(self.system, ("", ""))
        labels = (table.label for table in built_in() if table.key == self.system)
        return next(labels).format(band=band, cup=cup) if band else ""

    def _number(self, row: BatchRow, name: str) -> float:
        return row.numbers[self.numbers[name]] if name in self.numbers else float("nan")

    def _mean(self, row: BatchRow, one: str, other: str) -> float:
        return 0.5 * (self._number(row, one) + self._number(row, other))


def _length(mm: float, digits: int, signed: bool = False) -> str:
    return length_number(mm, digits, signed) if mm == mm else ""  # noqa: PLR0124 (not a number)


# -- the run


def counts_text(rows: Iterable[BatchRow]) -> str:
    """Return how many rows there are of each verdict and state, the best first."""
    counts = Counter(row.level for row in rows)
    order = (GOOD, CAUTION, BAD, *NOT_COMPUTED)
    text = tr("{verdict}: {count}")
    return listed(
        text.format(verdict=level_title(level), count=number(counts[level], 0))
        for level in order
        if counts[level]
    )


def paths_text(paths: Sequence[str]) -> str:
    """Return paths on one line: the first one, and how many others there are."""
    if len(paths) < 2:
        return "".join(paths)
    others = tr_plural("{path} and {count} other", "{path} and {count} others", len(paths) - 1)
    return others.format(path=paths[0], count=number(len(paths) - 1, 0))


def failures_text(count: int) -> str:
    """Return how many bodies failed or ran out of time."""
    text = tr_plural(
        "{count} body failed or ran out of time.", "{count} bodies failed or ran out of time.", count
    )
    return text.format(count=number(count, 0))


def scans_text(count: int) -> str:
    """Return how many scans there are."""
    return tr_plural("{count} scan", "{count} scans", count).format(count=number(count, 0))


def progress_text(done: int, total: int, rate: float, seconds_left: float | None) -> str:
    """Return how far a run is, with bodies per minute and the time left."""
    parts = [tr("{done} of {total}").format(done=number(done, 0), total=number(total, 0))]
    if rate > 0.0:
        per_minute = number(60.0 * rate, 0 if rate > 1 / 6 else 1)
        parts.append(tr("{count} per minute").format(count=per_minute))
    if seconds_left:
        parts.append(tr("{time} left").format(time=duration_text(seconds_left)))
    return listed(parts)


def duration_text(seconds: float) -> str:
    """Return a time in its two largest units."""
    whole = round(seconds)
    if whole >= _HOUR:
        return tr("{hours} h {minutes} min").format(hours=whole // _HOUR, minutes=whole % _HOUR // _MINUTE)
    if whole >= _MINUTE:
        return tr("{minutes} min {seconds} s").format(minutes=whole // _MINUTE, seconds=whole % _MINUTE)
    return tr("{seconds} s").format(seconds=whole)


def error_text(event: Mapping[str, Any]) -> tuple[str, str]:
    """Return message and hint of an error of the command, in the language in use."""
    texts = [sentence_text(text, values) for text, values in event.get("sentences", ())]
    first, *rest = texts or [str(event.get("message", ""))]
    return first, joined(rest)
