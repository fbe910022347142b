"""The cut list of a sheet for the sample room: what to cut, of what, how long, and where it is worn."""

from __future__ import annotations

from app.i18n.catalog import tr
from app.i18n.lengths import length_unit
from app.presenters.messages import line_title
from app.presenters.pressure import rating_text
from app.rendering.palette import CUP_COLOUR, LIGHT
from app.report.cut_rows import CutRowText, cut_views
from app.report.document import ReportDocument
from app.report.header import WIDE
from app.report.layout import Block
from app.report.painter import (
    PagePainter,
    elide,
    fitting_font,
    line_height,
    paint_chip,
    paint_light,
    text_width,
    wrap,
)
from app.report.tables import heading, paragraph
from app.report.text import NOTHING, pressure_legend, value_text
from core.garment.pressure_list import PressureRow

_ROW, _REMARK = 5.6, 4.0
EDGES = {
    "width": 71.0,
    "cut": 84.5,
    "allowance": 95.0,
    "elongation": 109.5,
    "whole": 124.0,
    "height": 139.0,
    "tension": 153.0,
    "pressure": 162.0,
}
"""The columns of figures from left to right, and their right ends [mm]."""

_OF_PIECE = ("cut", "allowance", "elongation")  # side by side; a line without a piece has none of them
_ELASTIC, _LIGHT, _WORD = 35.0, 165.0, 168.0


def cut_blocks(handout: ReportDocument) -> list[Block]:
    """Return the cut list with what each band presses with, or what is missing for it."""
    title = heading(tr("Cut list"), WIDE)
    sheet = handout.report
    cups = [_cup_row(row, sheet.is_valid) for row in sheet.cups]
    if not (sheet.cuts.rows or cups):
        text = tr("No active lines. Shorten a line to add it to this list.")
        return [title, paragraph(text, "body", WIDE)]
    views = cut_views(sheet, list(handout.colours))
    rows = (_cut_row(view, handout.colours.get(view.line, "")) for view in views)
    return [title, _cut_head(), *rows, *cups, _legend()]


def _cut_head() -> Block:
    titles = {
        "width": tr("width {unit}").format(unit=length_unit()),
        "cut": tr("cut {unit}").format(unit=length_unit()),
        "allowance": tr("seams"),
        "elongation": tr("elong. %"),
        "whole": tr("worn {unit}").format(unit=length_unit()),
        "height": tr("height {unit}").format(unit=length_unit()),
        "tension": tr("tension N"),
        "pressure": tr("kPa"),
    }
    named = (
        (0.0, tr("Line")),
        (_ELASTIC, tr("Elastic")),
        (_LIGHT - 1.2, elide(tr("pressure"), "caption", WIDE - _LIGHT + 1.2)),
    )

    def paint(paper: PagePainter, x: float, y: float) -> None:
        for left, title in named:
            paper.text(x + left, y + 2.8, title, "caption")
        for key, edge in EDGES.items():
            paper.text(x + edge, y + 2.8, titles[key], "caption", align="right")
        paper.rule(x, y + 4.2, WIDE, ink=LIGHT.outline)

    return Block(4.2, paint, keep=True)


def _cut_row(view: CutRowText, colour: str) -> Block:
    lines = wrap(view.title, "strong", _ELASTIC - 6.5)  # a name is never cut: it tells the side
    high = _ROW + (len(lines) - 1) * line_height("strong")
    remark = elide(view.remark, "small", WIDE - 6.0)
    room = EDGES["width"] - _ELASTIC - 8.0
    kind = fitting_font(view.elastic, room)
    elastic = elide(view.elastic, kind, room)
    word = elide(view.word, "body", WIDE - _WORD)
    end = EDGES[_OF_PIECE[-1]]
    refused = elide(tr("DO NOT CUT"), "strong", end - EDGES["width"] - 3.0)

    def paint(paper: PagePainter, x: float, y: float) -> None:
        base, middle = y + 3.75, y + 2.8
        paint_chip(paper, x, middle, colour or LIGHT.control)
        paper.lines(x + 4.6, base - 0.74 * line_height("strong"), lines, "strong")
        paper.text(x + _ELASTIC, base, elastic, kind, ink=LIGHT.text)
        for key, edge in EDGES.items():
            if view.to_cut or key not in _OF_PIECE:
                strong = key == "cut" and not view.front_only
                type_ = "figure strong" if strong else "figure"
                paper.text(x + edge, base, view.values[key], type_, align="right")
        if not view.to_cut:
            paper.text(x + end, base, refused, "strong", align="right", ink=LIGHT.bad)
        if view.rating:
            paint_light(paper, x + _LIGHT, middle, view.rating)
            paper.text(x + _WORD, base, word, "body")
        paper.text(x + 4.6, y + high + 2.2, remark, "small")
        paper.rule(x, y + high + (_REMARK if remark else 0.0), WIDE)

    return Block(high + (_REMARK if remark else 0.0), paint)


def _cup_row(row: PressureRow, valid: bool) -> Block:
    """Return what a cup presses with, under the columns of the lines: it is no piece of this list."""
    title, kpa = line_title(row.line), value_text(row.max_kpa, 1) if valid else NOTHING
    word = elide(rating_text(row.light), "body", WIDE - _WORD) if valid else ""

    def paint(paper: PagePainter, x: float, y: float) -> None:
        base, middle = y + 3.75, y + 2.8
        paint_chip(paper, x, middle, CUP_COLOUR)
        paper.text(x + 4.6, base, title, "strong")
        paper.text(x + EDGES["pressure"], base, kpa, "figure", align="right")
        if word:
            paint_light(paper, x + _LIGHT, middle, row.light)
            paper.text(x + _WORD, base, word, "body")
        paper.rule(x, y + _ROW, WIDE)

    return Block(_ROW, paint)


def _legend() -> Block:
    """Return what the lights say, on one line."""
    legend = pressure_legend()
    before = tr("Tension and contact pressure are estimates. Maximum pressure:")

    def paint(paper: PagePainter, x: float, y: float) -> None:
        paper.text(x, y + 2.6, before, "small")
        x += text_width(before, "small") + 3.5
        for light, words in legend:
            paint_light(paper, x, y + 1.8, light)
            paper.text(x + 2.2, y + 2.6, words, "small")
            x += text_width(words, "small") + 7.5

    return Block(3.8, paint, gap=1.6)
