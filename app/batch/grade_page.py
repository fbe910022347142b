"""The page of a grading: grade rules, plots of measures over sizes, whom sizes serve, and new sizes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from html import escape

import numpy as np

from app.batch.grade_files import note_of
from app.batch.graded_bodies import BAND, CUP, SIZE
from app.batch.grading import Grading, ServiceCount
from app.batch.page_parts import (
    UNKNOWN,
    Cell,
    Row,
    counted,
    folded,
    number,
    page,
    paragraph,
    percent,
    table,
)
from app.batch.svg_plots import Axis, Point, Series, curve_plot, error_plot, label_axis, legend, number_axis
from core.analysis.grading.coverage import Coverage
from core.analysis.grading.grade_rule import GradeRule, StepIncrement
from core.analysis.grading.increments import interval_of
from core.analysis.grading.service import MEAN, RULE, Deviation, Served
from core.analysis.grading.size_groups import SizeCode, SizeSpread
from core.analysis.grading.tolerance import LEAST_MM

MOST_ROWS = 2000
"""Bodies that the page lists; served.csv lists all."""

NONLINEAR = 0.05
GARMENT_WORDS = {RULE: "the grade rule", MEAN: "the mean of the size"}
TITLE = "Grading"


def grade_page(gradings: Sequence[Grading]) -> str:
    """Return the page of the gradings of all variants."""
    return page(TITLE, "".join(_section(each) for each in gradings))


def headline(grading: Grading) -> str:
    """Return how many bodies in how many sizes are graded, and who is left out."""
    graded = grading.graded
    left_out = graded.left_out.sentences
    bodies = counted(graded.bodies.count, "body", "bodies")
    text = f"{bodies} in {_sizes(grading.sizes)} ({graded.grouping.table.title.en})."
    return text + (f" Left out: {', '.join(left_out)}." if left_out else "")


def service_sentences(grading: Grading) -> Iterator[str]:
    """Yield how many bodies are served by their own size and by any size."""
    shares = grading.shares[np.isfinite(grading.shares)]
    ends = dict.fromkeys(f"{100.0 * share:g}" for share in (shares.min(), shares.max()))
    limit = f"{' to '.join(ends)} % (or {LEAST_MM:g} mm) of that of the body"
    measures = "the measure" if len(shares) == 1 else f"each of {len(shares)} measures"
    yield f"A size serves a body if {measures} of its garment is within {limit}."
    for garments, words in GARMENT_WORDS.items():
        own, best = grading.by_own[garments], grading.by_best[garments]
        yield f"Garments by {words}: own size serves {_of(own)}, any size {_of(best)}."


def _of(count: ServiceCount) -> str:
    return (
        f"{count.served} of {count.compared} ({percent(count.share)})" if count.compared else "none compared"
    )


def coverage_sentence(grading: Grading) -> str:
    """Return how many new sizes serve the share that is wanted."""
    found = grading.coverage
    if found is None:
        return "New sizes are not computed: no body has all measures."
    least = "" if found.is_smallest else f" (at least {found.least} are needed)"
    served = f"{found.served} of {found.count}"
    text = f"{_sizes(len(found.sizes))} would serve {100.0 * found.share:g} % of bodies ({served}){least}."
    if found.held_out is not None:
        text += (
            f" As many, chosen from four fifths of the bodies, serve {percent(found.held_out)} of the others."
        )
    return text + (" The bodies are a sample of all." if found.sampled else "")


def _sizes(count: int) -> str:
    return counted(count, "size", "sizes")


def _section(grading: Grading) -> str:
    plots, names = _plots(grading)
    parts = [
        f"<h2>{escape(grading.graded.variant)}</h2>",
        paragraph(headline(grading)),
        "<h3>Grade rules</h3>",
        paragraph(_RULE_NOTE, note=True),
        _rule_table(grading),
        folded("Increments between sizes", paragraph(_STEP_NOTE, note=True) + _increment_table(grading)),
        "<h3>Measures over sizes</h3>",
        paragraph(_PLOT_NOTE, note=True),
        legend(names) if len(names) > 1 else "",
        f'<div class="plots">{"".join(plots)}</div>',
        "<h3>Bodies that sizes serve</h3>",
        *(paragraph(each) for each in service_sentences(grading)),
        paragraph(_SERVED_NOTE, note=True),
        _served_table(grading),
        "<h3>New sizes</h3>",
        paragraph(coverage_sentence(grading)),
        _coverage(grading, grading.coverage) if grading.coverage else "",
    ]
    return "".join(parts)


_RULE_NOTE = (
    "Value = value at the base size + increment per band step and per cup step, by least squares over all "
    "bodies, with 95 % confidence intervals; a dash where the bodies do not determine it. Spread: standard "
    "deviation of bodies from the rule. Explained: share of the variance that the size explains. Within: "
    "share of bodies for which the own size is within the tolerance of this measure; a dash if it does not "
    "decide. *: increments differ between sizes (p below 0.05): use those between sizes."
)
_STEP_NOTE = "Differences of the means of neighbouring sizes, with 95 % intervals where both have two bodies."
_PLOT_NOTE = (
    "Points are means of sizes, lines the grade rule. Bars are 95 % intervals of the mean of sizes with two "
    "bodies or more; long ones are cut off. A point without a bar is a single body."
)
_SERVED_NOTE = (
    "The garment of a size is made without the body that it is compared with. The measure is the one that "
    "deviates most; its deviation is given in shares of the tolerance: up to 1 the garment serves the body."
)


def _rule_table(grading: Grading) -> str:
    by, label = grading.graded.grouping.by, grading.graded.grouping.label
    heading = ["measure", f"at {label(grading.rules[0].base)}", "unit"]
    heading += (
        ["per band step"] * (by != CUP)
        + ["per cup step"] * (by != BAND)
        + ["spread", "explained", "within", ""]
    )
    return table(heading, (_rule_row(grading, rule) for rule in grading.rules))


def _rule_row(grading: Grading, rule: GradeRule) -> Row:
    by = grading.graded.grouping.by
    row: Row = [rule.measure.name, number(rule.at_base), rule.measure.unit]
    row += [_step(rule.per_band)] if by != CUP else []
    row += [_step(rule.per_cup)] if by != BAND else []
    differ = "*" if rule.nonlinearity is not None and rule.nonlinearity < NONLINEAR else ""
    within = grading.service.within(rule.measure)
    shares = [Cell(percent(share), "number") for share in (rule.explained, within)]
    return [*row, number(rule.residual), *shares, differ]


def step_text(step: StepIncrement | None) -> str:
    """Return an increment with half of its confidence interval."""
    if step is None:
        return UNKNOWN
    half = "" if step.interval is None else f" ± {0.5 * (step.interval.high - step.interval.low):.1f}"
    return number(step.value, signed=True).text + half


def _step(step: StepIncrement | None) -> Cell:
    return Cell(step_text(step), "number")


def _increment_table(grading: Grading) -> str:
    label = grading.graded.grouping.label
    rows = []
    for each in grading.increments[:MOST_ROWS]:
        ends = (each.interval.low, each.interval.high) if each.interval else (None, None)
        counts = [Cell(str(count), "number") for count in each.counts]
        head: Row = [
            each.measure.name,
            each.part,
            label(each.smaller),
            label(each.larger),
            *counts,
        ]
        rows.append([*head, *(number(value, signed=True) for value in (each.value, *ends))])
    heading = ("measure", "step", "from", "to", "bodies", "bodies", "increment", "low", "high")
    return table(heading, rows) if rows else paragraph("No neighbouring sizes have bodies.")


def _plots(grading: Grading) -> tuple[list[str], list[str]]:
    """Return a plot of each measure over cups, or over bands, and the names of its series."""
    grouping, codes = grading.graded.grouping, grading.graded.bodies.codes
    across = BAND if grouping.by == BAND else CUP
    steps = [step.name for step in (grouping.table.bands if across == BAND else grouping.table.cups).steps]
    places = [_place(code, across) for code in codes]
    first, last = min(places), max(places)
    x = label_axis(across, steps[first : last + 1])
    bands = sorted({code.band for code in codes}) if grouping.by == SIZE else [0]
    names = [f"band {grouping.table.bands.steps[at].name}" for at in bands] if grouping.by == SIZE else [""]
    plots = []
    for rule in grading.rules:
        spreads = [each for each in grading.spreads if each.measure == rule.measure and each.spread.count]
        series = []
        for band, name in zip(bands, names, strict=True):
            chosen = [each for each in spreads if grouping.by != SIZE or each.code.band == band]
            points = tuple(_point(each, _place(each.code, across) - first) for each in chosen)
            ends = dict.fromkeys(_place(each.code, across) for each in (*chosen[:1], *chosen[-1:]))
            line = [
                (at - first, _at(rule, SizeCode(at, 0) if across == BAND else SizeCode(band, at)))
                for at in ends
            ]
            drawn = tuple((float(at), value) for at, value in line if value is not None)
            series.append(Series(name, points, drawn if len(drawn) > 1 else ()))
        plots.append(error_plot(rule.measure.name, x, _y_axis(rule.measure.unit, series), series))
    return plots, names


def _place(code: SizeCode, across: str) -> int:
    return code.band if across == BAND else code.cup


def _at(rule: GradeRule, code: SizeCode) -> float | None:
    """Return the rule at a size, None where an increment that is needed is not known."""
    value = rule.at_base
    for step, count in (
        (rule.per_band, code.band - rule.base.band),
        (rule.per_cup, code.cup - rule.base.cup),
    ):
        if count and (step is None or value is None):
            return None
        if step is not None and value is not None:
            value += count * step.value
    return value


def _point(each: SizeSpread, place: int) -> Point:
    of = each.spread
    assert of.mean is not None
    half = None if of.error is None else interval_of(0.0, of.error, of.count - 1).high
    return Point(float(place), of.mean, half)


def _y_axis(unit: str, series: Sequence[Series]) -> Axis:
    """Return the axis of means and rules; error bars of two bodies, often far longer, may leave it."""
    drawn = [
        *(point.y for each in series for point in each.points),
        *(y for each in series for _, y in each.line),
    ]
    low, high = min(drawn), max(drawn)
    reach = 0.25 * (high - low)
    bars = [
        point.y + sign * (point.half or 0.0)
        for each in series
        for point in each.points
        for sign in (-1.0, 1.0)
    ]
    return number_axis(unit, [*drawn, *(min(max(bar, low - reach), high + reach) for bar in bars)])


def _served_table(grading: Grading) -> str:
    """Return the bodies that their own size does not serve, the worst first."""
    missed = [each for each in grading.service.bodies if each.by_own is not True]
    missed.sort(key=lambda each: -(each.own.excess if each.own else 0.0))
    if not missed:
        return paragraph("Every body is served by its own size.")
    heading = ("scan", "size", "measure", "garment", "body", "deviation", "best size", "deviation there", "")
    return table(heading, (_served_row(grading, each) for each in missed[:MOST_ROWS]))


def _served_row(grading: Grading, each: Served) -> Row:
    label, own = grading.graded.grouping.label, each.own
    row: Row = [grading.graded.bodies.names[each.body], label(each.code)]
    row += [own.measure.name if own else UNKNOWN]
    row += [number(own.garment if own else None), number(own.body if own else None), _excess(own)]
    row += [label(each.best_code) if each.best_code else UNKNOWN, _excess(each.best)]
    return [*row, note_of(each)]


def _excess(deviation: Deviation | None) -> Cell:
    return number(deviation.excess if deviation else None, 2)


def _coverage(grading: Grading, found: Coverage) -> str:
    grouping, names = grading.graded.grouping, grading.graded.bodies.names
    shown = max(next((at for at, share in enumerate(found.curve) if share >= 0.99), len(found.curve) - 1), 1)
    points = [(0.0, 0.0), *((at + 1.0, 100.0 * share) for at, share in enumerate(found.curve[: shown + 1]))]
    x, y = number_axis("sizes", [0.0, points[-1][0]]), number_axis("bodies served, %", [0.0, 100.0])
    plot = curve_plot(
        "Bodies served by a number of sizes, each added to the former", x, y, points, 100.0 * found.share
    )
    rows: list[Row] = []
    for at, size in enumerate(found.sizes, 1):
        served = Cell(str(len(size.serves)), "number")
        body = grading.service.bodies[size.body]
        rows.append([Cell(str(at), "number"), names[size.body], grouping.label(body.code), served])
    note = paragraph(
        "A new size is the garment of one body, which serves others too; a body counts once.", note=True
    )
    return f'<div class="plots">{plot}</div>{note}' + table(("size", "made for", "its size", "serves"), rows)
