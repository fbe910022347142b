"""Distributions of the numeric columns of a batch run: titles by group, bins, and their summary."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from app.i18n.catalog import listed, number, tr
from app.i18n.lengths import shown_digits, shown_unit, shown_value
from app.presenters.batch import BatchRow
from app.presenters.measurements import measure_title
from app.presenters.messages import line_title, render
from app.presenters.plots import round_ticks
from core.geometry.mesh import Floats
from core.measurements.definitions import definition_of
from core.messages import Message, PieceName, SeamName

USUAL = "bust_mm"
"""The column whose distribution is shown first."""

_BINS = 16
_DIGITS = {"mm": 1, "ml": 0, "%": 1, "kPa": 2, "N": 2, "s": 1, "cm2": 1}
_UNITS = {"cm2": "cm\N{SUPERSCRIPT TWO}"}
_LINE = re.compile(
    r"(set|reached|cut_length|elongation|tension|pressure_mean|pressure_max)_(.+)_(?:percent|mm|n|kpa)"
)
_PIECE = re.compile(r"(area|strain|seam)_(.+)_(?:cm2|percent|mm)")
_HIDDEN = ("memory_mb",)


@dataclass(frozen=True)
class PlottedColumn:
    """A numeric column: its ``name`` in the table, ``group`` and ``title`` in a menu, and its ``unit``.

    One ``of_scan`` is the same for all variants.
    """

    name: str
    group: str
    title: str
    unit: str
    of_scan: bool = False

    @property
    def heading(self) -> str:
        """Return title and unit as shown."""
        unit = _UNITS.get(self.unit, shown_unit(self.unit))
        return f"{self.title} [{unit}]" if unit else self.title

    def value_text(self, value: float) -> str:
        """Return a value of the column as shown."""
        return number(shown_value(value, self.unit), shown_digits(_DIGITS.get(self.unit, 2), self.unit))


def plotted_columns(
    columns: Sequence[tuple[str, str]], measures: Mapping[str, tuple[str, bool]]
) -> list[PlottedColumn]:
    """Return the numeric ``columns``, names and units, in the order of groups; ``measures`` are by column."""
    found = [_column(name, unit, measures) for name, unit in columns if name not in _HIDDEN]
    groups = list(dict.fromkeys(each.group for each in found))
    return sorted(found, key=lambda each: groups.index(each.group))


def _column(name: str, unit: str, measures: Mapping[str, tuple[str, bool]]) -> PlottedColumn:
    if name in measures or name.startswith("own_"):
        after = measures[name][1] if name in measures else name.endswith("_after_mm")
        group = tr("Reshaped body") if after else tr("Original body")
        return PlottedColumn(name, group, _measure(name, measures), unit, not after)
    if line := _LINE.fullmatch(name):
        return PlottedColumn(name, line_title(line[2]), _line_titles()[line[1]], unit)
    if piece := _PIECE.fullmatch(name):
        kind = SeamName if piece[1] == "seam" else PieceName
        title = render(Message("{name}", name=kind(piece[2])))
        return PlottedColumn(name, _pattern_groups()[piece[1]], title, unit)
    return PlottedColumn(name, tr("Result"), _result_titles().get(name, name), unit)


def _measure(name: str, measures: Mapping[str, tuple[str, bool]]) -> str:
    if name not in measures:
        return name.removeprefix("own_").removesuffix("_mm").removesuffix("_after")
    definition, side = definition_of(measures[name][0])
    return measure_title({"title": definition.title, "side": side})


def _result_titles() -> dict[str, str]:
    left, right = tr("{what}, left"), tr("{what}, right")
    lift, forward = tr("Bust point lift"), tr("Bust point, forward")
    return {
        "lift_left_mm": left.format(what=lift),
        "lift_right_mm": right.format(what=lift),
        "forward_left_mm": left.format(what=forward),
        "forward_right_mm": right.format(what=forward),
        "volume_error_percent": tr("Volume error"),
        "lower_volume_error_ml": tr("Volume error, waist and hips"),
        "target_miss_mm": tr("Deviation from targets"),
        "seconds": tr("Computing time"),
    }


def _line_titles() -> dict[str, str]:
    return {
        "set": tr("Set length"),
        "reached": tr("Reached length"),
        "cut_length": tr("Cut length"),
        "elongation": tr("Elongation"),
        "tension": tr("Tension"),
        "pressure_mean": tr("Mean pressure"),
        "pressure_max": tr("Maximum pressure"),
    }


def _pattern_groups() -> dict[str, str]:
    return {
        "area": tr("Areas of pieces"),
        "strain": tr("Strain of pieces"),
        "seam": tr("Lengths of seams"),
    }


@dataclass(frozen=True, eq=False)
class Distribution:
    """Counts of values between ``edges`` for each series (variant); ``ticks`` are values of the axis.

    All values are in the unit shown; ``summary`` holds a line for each series.
    """

    heading: str
    edges: Floats
    series: tuple[tuple[str, Floats], ...]
    ticks: tuple[float, ...]
    summary: tuple[str, ...]

    @property
    def most(self) -> float:
        """Return the largest count."""
        return float(max((counts.max() for _, counts in self.series), default=0.0))

    def bin_text(self, place: int) -> str:
        """Return range and counts of a bin."""
        low, high = (number(edge, 1) for edge in self.edges[place : place + 2])
        counts = (
            f"{title}: {number(each[place], 0)}" if title else number(each[place], 0)
            for title, each in self.series
        )
        return tr("{low} to {high}: {counts}").format(low=low, high=high, counts=listed(counts))


def distribution(
    rows: Sequence[BatchRow], column: PlottedColumn, place: int, variants: Sequence[str]
) -> Distribution | None:
    """Return the distribution of a column, the ``place``-th number of each row, or None without values."""
    scale = shown_value(1.0, column.unit)
    rows = list({row.scan: row for row in rows}.values()) if column.of_scan else rows
    values = {
        name: scale * np.array([row.numbers[place] for row in rows if name in ("", row.variant)], float)
        for name in (("",) if column.of_scan else variants)
    }
    known = {name: each[np.isfinite(each)] for name, each in values.items()}
    known = {name: each for name, each in known.items() if len(each)}
    if not known:
        return None
    edges = _edges(np.concatenate(list(known.values())))
    several = len(known) > 1
    series = tuple(
        (name if several else "", np.histogram(each, edges)[0].astype(float)) for name, each in known.items()
    )
    summary = tuple(_summary(name if several else "", each / scale, column) for name, each in known.items())
    return Distribution(column.heading, edges, series, tuple(round_ticks(edges[0], edges[-1])), summary)


def _edges(values: Floats) -> Floats:
    """Return the edges of bins of a round width that hold all values."""
    low, high = float(values.min()), float(values.max())
    if high - low < 1e-9 * max(abs(high), 1.0):
        return np.array([low - 0.5, low + 0.5])
    bins = max(min(_BINS, round(2.0 * len(values) ** 0.5)), 4)
    steps = round_ticks(low, high, bins)
    step = steps[1] - steps[0] if len(steps) > 1 else high - low
    first = np.floor(low / step + 1e-9)
    count = max(int(np.ceil(high / step - 1e-9) - first), 1)
    edges: Floats = step * (first + np.arange(count + 1))
    return edges


def _summary(title: str, values: Floats, column: PlottedColumn) -> str:
    texts = {
        "mean": column.value_text(float(values.mean())),
        "low": column.value_text(float(values.min())),
        "high": column.value_text(float(values.max())),
        "count": number(len(values), 0),
    }
    spread = column.value_text(float(values.std(ddof=1))) if len(values) > 1 else "\N{EN DASH}"
    text = tr("n {count}, mean {mean}, SD {spread}, {low} to {high}").format(**texts, spread=spread)
    return f"{title}: {text}" if title else text
