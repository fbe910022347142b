"""The pages of a sheet: what stands where, painted on whatever has a painter."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from PySide6.QtGui import QPainter

from app.reporting.curves import HIGHEST, LOWEST, curve_block
from app.reporting.flow import Block, Column, Placed, flow
from app.reporting.handout import Handout
from app.reporting.head import WIDE, head_blocks
from app.reporting.paper import A4, MARGIN, Paper, elided, text_width
from app.reporting.tables import HALF, cut_blocks, definition_blocks, measure_blocks, note_blocks
from app.reporting.telling import foot_words
from app.wording.tokens import LIGHT
from app.wording.words import speaking

BOTTOM = A4[1] - MARGIN - 6.0
"""Down to where blocks stand; below it is the foot of the page [mm]."""


_GAP = 4.0  # over the curves [mm]
_SMALLER = (1.0, 0.85, 0.7, 0.55)  # of the height of the pictures, until the curves have room


@dataclass(frozen=True, eq=False)
class Pages:
    """Blocks in their places on ``count`` pages; ``foot`` stands at the foot of each."""

    placed: tuple[Placed, ...]
    count: int
    foot: str

    def paint(self, painter: QPainter, page: int) -> None:
        """Paint a page, counted from 0; ``painter`` has ``paper.UNITS`` to a millimetre."""
        paper = Paper(painter)
        for each in self.placed:
            if each.page == page:
                each.block.paint(paper, each.x, each.y)
        base, number = A4[1] - MARGIN, f"{page + 1} / {self.count}"
        foot = elided(self.foot, "caption", WIDE - text_width(number, "caption") - 6.0)
        paper.rule(MARGIN, base - 3.6, WIDE, ink=LIGHT.line)
        paper.text(MARGIN, base, foot, "caption")
        paper.text(MARGIN + WIDE, base, number, "caption", align="right")


def pages_of(handout: Handout, language: str) -> Pages:
    """Return the pages of a sheet in a language of ``app.wording.words.LANGUAGES``."""
    with speaking(language):
        placed, left = _first(handout)
        placed += _curves(handout, left)
        last = placed[-1]
        below = last.y + last.block.height if last.page > left.page else BOTTOM
        sheet = handout.sheet
        words: list[Block] = [*measure_blocks(sheet), *note_blocks(sheet), *definition_blocks(sheet)]
        placed += flow(words, _halves(last.page, below))[0]
        return Pages(tuple(placed), max(each.page for each in placed) + 1, foot_words(sheet))


def _first(handout: Handout) -> tuple[list[Placed], Column]:
    """Return the head and the cut list; where that is long, pictures leave room for the curves below it."""
    cuts = cut_blocks(handout)
    for share in _SMALLER:
        placed, left = flow([*head_blocks(handout, share), *cuts], _whole(0))
        if left.page == 0 and _room(left) >= LOWEST:
            return placed, left
    return flow([*head_blocks(handout), *cuts], _whole(0))


def _room(left: Column) -> float:
    return left.bottom - left.top - _GAP


def _curves(handout: Handout, left: Column) -> list[Placed]:
    """Return the curves below the cut list, where they have room, else at the head of the next page."""
    if (room := _room(left)) >= LOWEST:
        return [Placed(left.page, MARGIN, left.top + _GAP, curve_block(handout, min(room, HIGHEST)))]
    return [Placed(left.page + 1, MARGIN, MARGIN, curve_block(handout, LOWEST + 14.0))]


def _whole(page: int) -> Iterator[Column]:
    while True:
        yield Column(page, MARGIN, MARGIN, BOTTOM)
        page += 1


def _halves(page: int, top: float) -> Iterator[Column]:
    """Give both columns of page after page, below what stands on the first one."""
    if BOTTOM - top < LOWEST:
        page, top = page + 1, MARGIN
    while True:
        yield Column(page, MARGIN, top, BOTTOM)
        yield Column(page, MARGIN + WIDE - HALF, top, BOTTOM)
        page, top = page + 1, MARGIN
