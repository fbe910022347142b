"""The tables of a sheet, row by row, and what is to be known of their figures."""

from __future__ import annotations

from collections.abc import Iterator

from app.reporting.flow import Block, Paint
from app.reporting.grounds import cut_notes, definitions, note_groups
from app.reporting.handout import Handout
from app.reporting.head import WIDE
from app.reporting.marks import paint_chip, paint_light
from app.reporting.paper import Paper, elided, fitting, line_height, text_width, wrapped
from app.reporting.telling import CutView, MeasureRow, cut_views, light_legend, measure_rows
from app.wording.tokens import LIGHT
from app.wording.words import tr
from core.sheet import Sheet

Edges = tuple[float, float, float]
"""Right ends of the figures of a measure: before, after, change [mm]."""

HALF = 88.0
"""The width of a column where two stand beside each other [mm]."""

_ROW, _CUT_ROW = 4.4, 5.6
_FEW = 3  # footnotes that stand below each other
_EDGES = (78.0, 92.0, 105.0, 116.0, 130.0, 144.0, 151.5, 161.5)  # right ends of the figures of a cut
_ELASTIC, _LIGHT, _WORD = 35.0, 164.5, 168.0
_MEASURED = (HALF - 29.0, HALF - 14.5, HALF)  # right ends of before, after, change
_BESIDE = (HALF - 41.3, HALF - 24.1, HALF - 6.9)  # the same where ± stands behind each
_OFF = 6.9  # from a figure's right end to that of its ±
_SECOND = 3.2  # so much higher is a row whose title takes two lines


def heading(title: str, width: float, *, gap: float = 5.0) -> Block:
    """Return the title of what follows, which stays with it."""
    said = elided(title, "heading", width)
    return Block(5.4, lambda paper, x, y: paper.text(x, y + 3.6, said, "heading"), gap=gap, keep=True)


def cut_blocks(handout: Handout) -> list[Block]:
    """Return the cut list with what each band presses with, or what is missing for it."""
    title = heading(tr("Cut list"), WIDE)
    if not handout.sheet.cuts.rows:
        said = tr("No line is worn: set a line shorter, and it stands here with its length and pressure.")
        return [title, _paragraph(said, "body", WIDE)]
    views, footnotes = cut_views(handout.sheet, list(handout.colours))
    blocks = [title, _cut_head(), *(_cut_row(view, handout.colours.get(view.line, "")) for view in views)]
    blocks.append(_legend())
    return [*blocks, *_footnotes(footnotes), _beside([_bullet(note) for note in cut_notes(handout.sheet)])]


def measure_blocks(sheet: Sheet) -> Iterator[Block]:
    """Give the table of measures before and after, group by group."""
    groups = measure_rows(sheet)
    edges = _BESIDE if any(row.off for _, rows in groups for row in rows) else _MEASURED
    yield heading(tr("Measures"), HALF)
    yield _measure_head(edges)
    for group, rows in groups:
        said = elided(group, "strong", HALF)
        yield Block(5.0, _ruled(said, "strong", HALF, 5.0), gap=1.2, keep=True)
        for row in rows:
            yield _measure(row, edges) if row.figures else _paragraph(row.note, "small", HALF, 0.9)


def note_blocks(sheet: Sheet) -> Iterator[Block]:
    """Give what is to be known of the figures."""
    yield heading(tr("What the figures rest on"), HALF)
    for title, sentences in note_groups(sheet):
        yield _title(title)
        for sentence in filter(None, sentences):
            yield _bullet(sentence)


def definition_blocks(sheet: Sheet) -> Iterator[Block]:
    """Give how every measure is taken."""
    yield heading(tr("How measures are taken"), HALF)
    for title, text in definitions(sheet):
        yield _definition(title, text)


def _cut_head() -> Block:
    titles = (
        tr("width mm"),
        tr("worn mm"),
        tr("cut mm"),
        tr("seams"),
        tr("stretch %"),
        tr("tension N"),
        tr("kPa"),
        tr("mmHg"),
    )
    named = (
        (0.0, tr("Line")),
        (_ELASTIC, tr("Elastic")),
        (_LIGHT - 1.2, elided(tr("pressure"), "caption", WIDE - _LIGHT + 1.2)),
    )

    def paint(paper: Paper, x: float, y: float) -> None:
        for left, title in named:
            paper.text(x + left, y + 2.8, title, "caption")
        for edge, title in zip(_EDGES, titles, strict=True):
            paper.text(x + edge, y + 2.8, title, "caption", align="right")
        paper.rule(x, y + 4.2, WIDE, ink=LIGHT.outline)

    return Block(4.2, paint, keep=True)


def _cut_row(view: CutView, colour: str) -> Block:
    marks = " ".join(map(str, view.marks))
    beside = text_width(marks, "axis") + 0.5
    lines = wrapped(view.title, "strong", _ELASTIC - 6.5 - beside)  # a name is never cut: it tells the side
    high = _CUT_ROW + (len(lines) - 1) * line_height("strong")
    room = _EDGES[0] - _ELASTIC - 4.5
    kind = fitting(view.elastic, room)
    elastic = elided(view.elastic, kind, room)
    word = elided(view.word, "body", WIDE - _WORD)
    strong = None if view.front_only else 2

    def paint(paper: Paper, x: float, y: float) -> None:
        base, middle = y + 3.75, y + 2.8
        paint_chip(paper, x, middle, colour or LIGHT.control)
        last = paper.lines(x + 4.6, base - 0.74 * line_height("strong"), lines, "strong")
        above = last - 0.26 * line_height("strong") - 0.9
        paper.text(x + 5.1 + text_width(lines[-1], "strong"), above, marks, "axis")
        paper.text(x + _ELASTIC, base, elastic, kind, ink=LIGHT.text)
        for place, (edge, figure) in enumerate(zip(_EDGES, view.figures, strict=True)):
            paper.text(
                x + edge, base, figure, "figure strong" if place == strong else "figure", align="right"
            )
        if view.light:
            paint_light(paper, x + _LIGHT, middle, view.light)
            paper.text(x + _WORD, base, word, "body")
        paper.rule(x, y + high, WIDE)

    return Block(high, paint)


def _legend() -> Block:
    """Return what the lights say, on one line."""
    said = light_legend()
    before = tr("Tension and pressure are estimates. Largest pressure:")

    def paint(paper: Paper, x: float, y: float) -> None:
        paper.text(x, y + 2.6, before, "small")
        x += text_width(before, "small") + 3.5
        for light, words in said:
            paint_light(paper, x, y + 1.8, light)
            paper.text(x + 2.2, y + 2.6, words, "small")
            x += text_width(words, "small") + 7.5

    return Block(3.8, paint, gap=1.6)


def _footnotes(notes: list[str]) -> Iterator[Block]:
    """Give footnotes, two beside each other where there are many."""
    count = 2 if len(notes) > _FEW else 1
    width = (WIDE - 5.0 * (count - 1)) / count
    numbered = [(str(k), wrapped(note, "small", width - 4.0)) for k, note in enumerate(notes, start=1)]
    for first in range(0, len(numbered), count):
        yield _footnote_row(numbered[first : first + count], width)


def _footnote_row(notes: list[tuple[str, list[str]]], width: float) -> Block:
    def paint(paper: Paper, x: float, y: float) -> None:
        for place, (number, lines) in enumerate(notes):
            left = x + place * (width + 5.0)
            paper.text(left + 2.7, y + 2.3, number, "axis", align="right")
            paper.lines(left + 4.0, y, lines, "small")

    return Block(max(len(lines) for _, lines in notes) * line_height("small"), paint)


def _beside(blocks: list[Block]) -> Block:
    """Return blocks one below the other in two columns that are as even as can be."""

    def high(part: list[Block]) -> float:
        return sum(block.height + block.gap for block in part)

    halves = min(
        ((blocks[:k], blocks[k:]) for k in range(len(blocks), -1, -1)), key=lambda two: max(map(high, two))
    )

    def paint(paper: Paper, x: float, y: float) -> None:
        for left, part in zip((0.0, WIDE - HALF), halves, strict=True):
            down = y
            for block in part:
                block.paint(paper, x + left, down + block.gap)
                down += block.height + block.gap

    return Block(max(map(high, halves)), paint, gap=0.6)


def _measure_head(edges: Edges) -> Block:
    titles = tr("before"), tr("after"), tr("change")
    unit = elided(tr("mm, if not told otherwise"), "caption", edges[0] - 10.0)

    def paint(paper: Paper, x: float, y: float) -> None:
        paper.text(x, y + 2.6, unit, "caption")
        for edge, title in zip(edges, titles, strict=True):
            paper.text(x + edge, y + 2.6, title, "caption", align="right")

    return Block(3.4, paint, keep=True)


def _measure(row: MeasureRow, edges: Edges) -> Block:
    """Return a measure: its figures, behind each how far it may be off; a long title takes two lines."""
    room = edges[0] - 9.5
    unit = elided(row.unit, "caption", room)
    beside = room - (text_width(unit, "caption") + 1.6 if unit else 0.0)
    kind, lines = fitting(row.title, beside), _in_two(row.title, beside)
    high = _ROW + _SECOND * (len(lines) - 1)

    def paint(paper: Paper, x: float, y: float) -> None:
        base = y + 3.2
        for place, line in enumerate(lines):
            paper.text(x, base + place * _SECOND, line, kind, ink=LIGHT.text)
        paper.text(x + text_width(lines[-1], kind) + 1.6, base + (len(lines) - 1) * _SECOND, unit, "caption")
        for edge, figure, type_ in zip(
            edges, row.figures, ("before", "figure strong", "figure"), strict=True
        ):
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
    first, *others = wrapped(title, "small", width)
    return [first, elided("".join(others), "small", width)]


def _title(title: str) -> Block:
    said = elided(title, "small strong", HALF)
    return Block(3.6, lambda paper, x, y: paper.text(x, y + 2.5, said, "small strong"), gap=1.4, keep=True)


def _bullet(sentence: str) -> Block:
    lines = wrapped(sentence, "small", HALF - 3.0)

    def paint(paper: Paper, x: float, y: float) -> None:
        paper.disc(x + 0.9, y + 0.52 * line_height("small"), 0.22, LIGHT.text_caption)
        paper.lines(x + 3.0, y, lines, "small")

    return Block(len(lines) * line_height("small"), paint, gap=0.3)


def _definition(title: str, text: str) -> Block:
    """Return a name and, going on behind it, how that is taken."""
    lead = wrapped(title, "small strong", HALF)
    start = text_width(lead[-1], "small strong") + 1.4
    first = wrapped(text, "small", HALF - start)[0] if HALF - start > 25.0 else ""
    rest = wrapped(text.removeprefix(first).strip(), "small", HALF) if text != first else []
    step = line_height("small")

    def paint(paper: Paper, x: float, y: float) -> None:
        paper.lines(x, y, lead, "small strong")
        last = y + (len(lead) - 1) * step
        paper.text(x + start, last + 0.74 * step, first, "small")
        paper.lines(x, last + step, rest, "small")

    return Block((len(lead) + len(rest)) * step, paint, gap=0.8)


def _paragraph(text: str, kind: str, width: float, gap: float = 0.0) -> Block:
    lines = wrapped(text, kind, width)
    return Block(len(lines) * line_height(kind), lambda paper, x, y: paper.lines(x, y, lines, kind), gap=gap)


def _ruled(text: str, kind: str, width: float, height: float) -> Paint:
    def paint(paper: Paper, x: float, y: float) -> None:
        paper.text(x, y + 3.6, text, kind)
        paper.rule(x, y + height, width, ink=LIGHT.outline)

    return paint
