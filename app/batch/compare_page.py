"""The page of a comparison of two designs: what both change on each body."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from app.batch.compare_files import known, outcome
from app.batch.compared_designs import LIFT, PRESSURE, RESOLUTIONS, VERDICTS, DesignComparison
from app.batch.page_parts import Cell, Row, counted, folded, number, page, paragraph, percent, table
from app.batch.svg_plots import Point, Series, histogram, legend, number_axis, scatter

MOST_ROWS = 2000
"""Bodies that the page lists; compare.csv lists all."""

MOST_NAMES = 30
_DIGITS = {"kPa": 2, "%": 2}
_LOOKS = {"better": "good", "worse": "bad"}


def compare_page(found: DesignComparison) -> str:
    """Return the page of a comparison."""
    points = {word: np.flatnonzero(rows).tolist() for word, rows in found.tradeoff.outcomes.items()}
    parts = [
        *(paragraph(each) for each in sentences(found)),
        paragraph(_NOTE, note=True),
        "<h2>Lift and pressure</h2>",
        _tradeoff_table(found),
        legend([f"{word} ({len(each)})" for word, each in points.items()]),
        f'<div class="plots">{_scatter(found, points)}</div>',
        "<h2>Differences</h2>",
        _difference_table(found),
        f'<div class="plots">{"".join(_histograms(found))}</div>',
        "<h2>Verdicts</h2>",
        _verdict_table(found),
        "<h2>Bodies</h2>",
        _body_table(found),
        *_unmatched(found),
    ]
    return page(f"{found.names[1]} compared with {found.names[0]}", "".join(parts))


_NOTE = (
    "Differences are second design minus first. Lift is the mean of both sides, pressure the largest of all "
    f"lines and cups. Differences up to {RESOLUTIONS[LIFT]:g} mm and {RESOLUTIONS[PRESSURE]:g} kPa count as "
    "none. Better: more lift at no more pressure, or less pressure at no less lift; worse: the reverse. "
    "Intervals (95 %) are those of the mean over bodies like these, without the error of the model."
)


def sentences(found: DesignComparison) -> Iterator[str]:
    """Yield the result in words: bodies, lift at no more pressure, better and worse."""
    first, second = found.names
    change, unmatched = found.tradeoff, found.unmatched
    both = counted(len(found.scans), "body has", "bodies have")
    yield f"First: {first}. Second: {second}. {both} results of both."
    lacking = ((first, unmatched.first), (second, unmatched.second), ("both", unmatched.both))
    counts = [f"{len(scans)} without results of {name}" for name, scans in lacking if scans]
    if counts:
        yield f"Not compared: {', '.join(counts)}."
    if not change.count:
        yield "Lift and pressure are not compared: no body has both."
        return
    gains, whole = change.gains_at_no_cost, change.count
    share = percent(gains / whole)
    yield f"The second design lifts more at no more pressure on {gains} of {whole} bodies ({share})."
    better, worse, same, mixed = (int(rows.sum()) for rows in change.outcomes.values())
    yield (
        f"It is better on {better}, worse on {worse} and equal on {same}; on {mixed} both lift and pressure "
        "are more, or both are less."
    )


def _tradeoff_table(found: DesignComparison) -> str:
    words, counts = ("less", "equal", "more"), found.tradeoff.counts
    rows: list[Row] = [
        [f"{word} lift", *(Cell(str(count), "number") for count in counts[at])]
        for at, word in enumerate(words)
    ]
    return table(("bodies", *(f"{word} pressure" for word in words)), rows)


def _scatter(found: DesignComparison, points: dict[str, list[int]]) -> str:
    lift, pressure = found.change(LIFT), found.change(PRESSURE)
    groups = [
        Series(word, tuple(Point(float(pressure[at]), float(lift[at])) for at in places))
        for word, places in points.items()
    ]
    x = number_axis("change of the largest pressure, kPa", pressure, around=True)
    y = number_axis("change of lift, mm", lift, around=True)
    return scatter("Lift against pressure, a point for each body", x, y, groups)


def _difference_table(found: DesignComparison) -> str:
    rows: list[Row] = []
    for name, each in found.differences.items():
        digits = _DIGITS.get(found.units[name], 1)
        ends = (each.interval.low, each.interval.high) if each.interval else (None, None)
        signed = (each.mean, *ends, *each.quantiles)
        means = [number(value, digits) for value in (each.first_mean, each.second_mean)]
        counts = [Cell(str(count), "number") for count in (each.more, each.equal, each.less)]
        cells = [number(value, digits, signed=True) for value in signed]
        rows.append([name, found.units[name], Cell(str(each.count), "number"), *means, *cells, *counts])
    heading = ("quantity", "unit", "bodies", "first", "second", "difference", "low 95 %", "high 95 %")
    spread = ("least", "quartile", "median", "quartile", "most", "more", "equal", "less")
    return table((*heading, *spread), rows)


def _histograms(found: DesignComparison) -> Iterator[str]:
    for name in found.differences:
        changes = found.change(name)
        changes = changes[np.isfinite(changes)]
        each = found.differences[name]
        if each.count > 1 and each.equal < each.count and np.ptp(changes) > 0.0:
            yield histogram(
                name, number_axis(f"change, {found.units[name]}", changes, around=True), list(changes)
            )


def _verdict_table(found: DesignComparison) -> str:
    rows: list[Row] = [
        [f"first {word}", *(Cell(str(count), "number") for count in found.verdict_counts[at])]
        for at, word in enumerate(VERDICTS)
    ]
    return table(("bodies", *(f"second {word}" for word in VERDICTS)), rows)


def _body_table(found: DesignComparison) -> str:
    lift, pressure = found.change(LIFT), found.change(PRESSURE)
    order = sorted(range(len(found.scans)), key=lambda at: (np.isnan(lift[at]), lift[at], found.scans[at]))
    rows: list[Row] = []
    for at in order[:MOST_ROWS]:
        word = outcome(found, at)
        cells = [number(known(lift[at]), 1, signed=True), number(known(pressure[at]), 2, signed=True)]
        rows.append([found.scans[at], *cells, Cell(word, _LOOKS.get(word, "")), *found.verdicts[at]])
    return table(("scan", "lift, mm", "pressure, kPa", "", "verdict, first", "verdict, second"), rows)


def _unmatched(found: DesignComparison) -> Iterator[str]:
    first, second = found.names
    for name, scans in ((first, found.unmatched.first), (second, found.unmatched.second)):
        if scans:
            more = f" and {len(scans) - MOST_NAMES} more" if len(scans) > MOST_NAMES else ""
            text = ", ".join(scans[:MOST_NAMES]) + more
            yield folded(f"Without results of {name} ({len(scans)})", paragraph(text))
