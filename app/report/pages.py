"""Pages of a report: layout of their blocks, painted on paper, screen or PDF."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from PySide6.QtGui import QPainter

from app.i18n.catalog import tr, using_language
from app.rendering.palette import LIGHT
from app.report.curves import LOWEST, curve_block, lower_section_blocks
from app.report.cut_rows import force_range_warning
from app.report.cut_table import cut_blocks
from app.report.document import ReportDocument
from app.report.header import WIDE, head_blocks
from app.report.layout import Block, Column, PlacedBlock, place_blocks
from app.report.painter import A4, MARGIN, PagePainter, elide, text_width
from app.report.pattern_page import pattern_blocks
from app.report.tables import (
    HALF,
    bullet,
    heading,
    key_blocks,
    line_note_blocks,
    measure_blocks,
    note_blocks,
)
from app.report.text import cut_notes, foot_words

BOTTOM = A4[1] - MARGIN - 6.0
"""Down to where blocks stand; below it is the foot of the page [mm]."""


_GAP = 5.0  # over the key measures, and under the curves [mm]
_SMALLER = (1.0, 0.9, 0.8, 0.7, 0.6, 0.5)  # of the height of the pictures, until the first page holds all
_CURVES = (100.0, 84.0, 70.0, 60.0, 50.0, 42.0)  # heights of the curves at the head of the appendix [mm]


_SEVERAL_PAGES = 84.0
"""The height of the curves where the levels of waist and hip follow [mm]."""


@dataclass(frozen=True, eq=False)
class Pages:
    """Blocks in their places on ``count`` pages; ``foot`` stands at the foot of each."""

    placed: tuple[PlacedBlock, ...]
    count: int
    foot: str

    @property
    def size(self) -> tuple[float, float]:
        """Return width and height of each page [mm]."""
        return A4

    def paint(self, painter: QPainter, page: int) -> None:
        """Paint a page, counted from 0; ``painter`` has ``paper.UNITS`` to a millimetre."""
        paper = PagePainter(painter)
        for each in self.placed:
            if each.page == page:
                each.block.paint(paper, each.x, each.y)
        base, number = A4[1] - MARGIN, f"{page + 1} / {self.count}"
        foot = elide(self.foot, "caption", WIDE - text_width(number, "caption") - 6.0)
        paper.rule(MARGIN, base - 3.6, WIDE, ink=LIGHT.line)
        paper.text(MARGIN, base, foot, "caption")
        paper.text(MARGIN + WIDE, base, number, "caption", align="right")


def pages_of(handout: ReportDocument, language: str) -> Pages:
    """Return the pages of a sheet in a language of ``app.i18n.catalog.LANGUAGES``.

    The first page is for the sample room: verdict, pictures, what to cut, key measures. All else is appendix.
    """
    with using_language(language):
        placed = _first(handout)
        if handout.pattern is not None:
            placed += _pattern(handout, max(each.page for each in placed) + 1)
        placed += _appendix(handout, max(each.page for each in placed) + 1)
        return Pages(tuple(placed), max(each.page for each in placed) + 1, foot_words(handout.report))


def _first(handout: ReportDocument) -> list[PlacedBlock]:
    """Return what the sample room needs; where the cut list is long, pictures give way to it."""
    cuts, measures, notes = cut_blocks(handout), list(key_blocks(handout.report)), _cutting(handout)
    for share in _SMALLER:
        placed, left = place_blocks([*head_blocks(handout, share), *cuts], _whole(0))
        below = [
            each
            for x, blocks in ((MARGIN, measures), (MARGIN + WIDE - HALF, notes))
            for each in place_blocks(blocks, _halves_at(left, x))[0]
        ]
        if all(each.page == 0 for each in below):
            break
    return placed + below


def _appendix(handout: ReportDocument, page: int) -> list[PlacedBlock]:
    """Return curves, notes and all other measures; where these are many, curves give way to them."""
    sheet, title = handout.report, heading(tr("Appendix"), WIDE)
    words: list[Block] = [
        *lower_section_blocks(sheet, HALF),
        *line_note_blocks(handout),
        *measure_blocks(sheet),
        *note_blocks(sheet),
    ]
    top = MARGIN + title.height + 2.0
    for height in _CURVES:
        below = place_blocks(words, _halves(page, top + height + _GAP))[0]
        if all(each.page == page for each in below):
            break
    else:
        if sheet.lower_sections:  # these fill more than a page whatever gives way
            height = _SEVERAL_PAGES
            below = place_blocks(words, _halves(page, top + height + _GAP))[0]
    curves = PlacedBlock(page, MARGIN, top, curve_block(handout, height))
    return [PlacedBlock(page, MARGIN, MARGIN, title), curves, *below]


def _pattern(handout: ReportDocument, page: int) -> list[PlacedBlock]:
    """Return the page of the pattern pieces, which goes on where their tables are long."""
    head, pieces, seams = pattern_blocks(handout)
    placed, left = place_blocks(head, _whole(page))
    for x, blocks in ((MARGIN, pieces), (MARGIN + WIDE - HALF, seams)):
        placed += place_blocks(blocks, _halves_at(left, x))[0]
    return placed


def _cutting(handout: ReportDocument) -> list[Block]:
    """Return what has to be known to cut by the list, and how far its forces are known."""
    sheet = handout.report
    notes = [force_range_warning(sheet), *cut_notes(sheet)] if sheet.cuts.rows else []
    return [heading(tr("Cutting notes"), HALF), *map(bullet, filter(None, notes))] if notes else []


def _whole(page: int) -> Iterator[Column]:
    while True:
        yield Column(page, MARGIN, MARGIN, BOTTOM)
        page += 1


def _halves_at(left: Column, x: float) -> Iterator[Column]:
    """Give half a page below what stands on it, then that of the pages after it."""
    yield Column(left.page, x, left.top + _GAP, left.bottom)
    page = left.page
    while True:
        page += 1
        yield Column(page, x, MARGIN, BOTTOM)


def _halves(page: int, top: float) -> Iterator[Column]:
    """Give both columns of page after page, below what stands on the first one."""
    if BOTTOM - top < LOWEST:
        page, top = page + 1, MARGIN
    while True:
        yield Column(page, MARGIN, top, BOTTOM)
        yield Column(page, MARGIN + WIDE - HALF, top, BOTTOM)
        page, top = page + 1, MARGIN
