"""The measures of a sheet, row by row, and what is to be known of its figures."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from app.i18n.catalog import tr
from app.i18n.lengths import length_unit
from app.rendering.palette import LIGHT
from app.report.cut_rows import line_notes
from app.report.document import ReportDocument
from app.report.layout import Block, Paint
from app.report.painter import PagePainter, elide, fitting_font, line_height, text_width, wrap
from app.report.text import MeasureRow, key_measures, measure_rows, note_groups
from core.export.report_data import Report

Edges = tuple[float, float, float]
"""Right ends of the figures of a measure: before, after, change [mm]."""

HALF = 88.0
"""The width of a column where two stand beside each other [mm]."""

_ROW = 4.4
_MEASURED = (HALF - 29.0, HALF - 14.5, HALF)  # right ends of before, after, change
_BESIDE = (HALF - 41.3, HALF - 24.1, HALF - 6.9)  # the same where ± stands behind each
_OFF = 6.9  # from a figure's right end to that of its ±
_SECOND = 3.2  # so much higher is a row whose title takes two lines


def heading(title: str, width: float, *, gap: float = 5.0) -> Block:
    """Return the title of what follows, which stays with it."""
    message = elide(title, "heading", width)
    return Block(5.4, lambda paper, x, y: paper.text(x, y + 3.6, message, "heading"), gap=gap, keep=True)


def key_blocks(sheet: Report) -> Iterator[Block]:
    """Return the few measurements that a garment is made to."""
    groups = measure_rows(replace(sheet, measures=key_measures(sheet)))
    edges = _edges(groups)
    yield heading(tr("Key measurements"), HALF)
    yield _measure_head(edges)
    for _, rows in groups:
        yield from (_measure(row, edges) for row in rows if row.values)


def _edges(groups: list[tuple[str, list[MeasureRow]]]) -> Edges:
    return _BESIDE if any(row.off for _, rows in groups for row in rows) else _MEASURED


def measure_blocks(sheet: Report) -> Iterator[Block]:
    """Return the table of all other measurements before and after, group by group."""
    key = {row["key"] for row in key_measures(sheet)}
    others = tuple(row for row in sheet.measures if row["key"] not in key)
    groups = measure_rows(replace(sheet, measures=others))
    edges = _edges(groups)
    yield heading(tr("Other measurements"), HALF)
    yield _measure_head(edges)
    for group, rows in groups:
        message = elide(group, "strong", HALF)
        yield Block(5.0, _ruled(message, "strong", HALF, 5.0), gap=1.2, keep=True)
        for row in rows:
            yield _measure(row, edges) if row.values else paragraph(row.note, "small", HALF, 0.9)


def note_blocks(sheet: Report) -> Iterator[Block]:
    """Return the notes on the values."""
    yield heading(tr("Assumptions and sources"), HALF)
    for title, sentences in note_groups(sheet):
        yield _title(title)
        for sentence in filter(None, sentences):
            yield bullet(sentence)


def line_note_blocks(handout: ReportDocument) -> Iterator[Block]:
    """Return the notes on each line."""
    notes = line_notes(handout.report, list(handout.colours))
    if notes:
        yield heading(tr("Line notes"), HALF)
    for title, sentences in notes:
        yield _title(title or tr("All lines"))
        yield from map(bullet, sentences)


def _measure_head(edges: Edges) -> Block:
    titles = tr("before"), tr("after"), tr("change")
    unit = elide(tr("{unit} unless noted").format(unit=length_unit()), "caption", edges[0] - 10.0)

    def paint(paper: PagePainter, x: float, y: float) -> None:
        paper.text(x, y + 2.6, unit, "caption")
        for edge, title in zip(edges, titles, strict=True):
            paper.text(x + edge, y + 2.6, title, "caption", align="right")

    return Block(3.4, paint, keep=True)


def _measure(row: MeasureRow, edges: Edges) -> Block:
    """Return a measure: its figures, behind each how far it may be off; a long title takes two lines."""
    room = edges[0] - 9.5
    unit = elide(row.unit, "caption", room)
    beside = room - (text_width(unit, "caption") + 1.6 if unit else 0.0)
    kind, lines = fitting_font(row.title, beside), _in_two(row.title, beside)
    high = _ROW + _SECOND * (len(lines) - 1)

    def paint(paper: PagePainter, x: float, y: float) -> None:
        base = y + 3.2
        for place, line in enumerate(lines):
            paper.text(x, base + place * _SECOND, line, kind, ink=LIGHT.text)
        paper.text(x + text_width(lines[-1], kind) + 1.6, base + (len(lines) - 1) * _SECOND, unit, "caption")
        for edge, figure, type_ in zip(edges, row.values, ("before", "figure strong", "figure"), strict=True):
            paper.text(x + edge, base, figure, type_, align="right")
        for edge, off in zip(edges, row.off, strict=False):
            paper.text(x + edge + _OFF, base, off, "axis", align="right")
        paper.rule(x, y + high, HALF, weight=0.1)

    return Block(high, paint)


def _in_two(title: str, width: float) -> list[str]:
    """Return a title on one line, or on two: a side in Japanese brackets stands on the second by itself."""
    name, bracket, side = title.rpartition("（")
    if text_width(title, "small") <= width:
        return [title]
    if name and text_width(name, "small") <= width:
        return [name, f"{bracket}{side}"]
    first, *others = wrap(title, "small", width)
    return [first, elide("".join(others), "small", width)]


def _title(title: str) -> Block:
    message = elide(title, "small strong", HALF)
    return Block(3.6, lambda paper, x, y: paper.text(x, y + 2.5, message, "small strong"), gap=1.4, keep=True)


def bullet(sentence: str) -> Block:
    """Return a sentence behind a bullet, half as wide as the page."""
    lines = wrap(sentence, "small", HALF - 3.0)

    def paint(paper: PagePainter, x: float, y: float) -> None:
        paper.disc(x + 0.9, y + 0.52 * line_height("small"), 0.22, LIGHT.text_caption)
        paper.lines(x + 3.0, y, lines, "small")

    return Block(len(lines) * line_height("small"), paint, gap=0.3)


def paragraph(text: str, kind: str, width: float, gap: float = 0.0) -> Block:
    """Return a text in a column of a ``width`` [mm], ``gap`` [mm] below what stands over it."""
    lines = wrap(text, kind, width)
    return Block(len(lines) * line_height(kind), lambda paper, x, y: paper.lines(x, y, lines, kind), gap=gap)


def _ruled(text: str, kind: str, width: float, height: float) -> Paint:
    def paint(paper: PagePainter, x: float, y: float) -> None:
        paper.text(x, y + 3.6, text, kind)
        paper.rule(x, y + height, width, ink=LIGHT.outline)

    return paint
