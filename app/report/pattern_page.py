"""The page of pattern pieces in a report: all pieces small, what they are cut from, and how seams agree."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from app.i18n.catalog import number, tr
from app.i18n.lengths import length_number, length_unit
from app.presenters.messages import render
from app.presenters.pattern import PieceRow, SeamRow, block_title, piece_rows, seam_rows
from app.presenters.pattern_layout import arranged, piece_shapes
from app.rendering.palette import LIGHT
from app.report.document import ReportDocument
from app.report.header import WIDE
from app.report.layout import Block
from app.report.painter import PagePainter, elide
from app.report.tables import HALF, bullet, heading, paragraph
from core.geometry.mesh import Floats
from core.messages import Message

if TYPE_CHECKING:
    from core.pattern.garment import Pattern

HIGH = 128.0
"""Height of the picture of the pieces [mm]."""

_ROW = 4.4
_PIECE = (HALF - 24.0, HALF - 12.0, HALF)  # right ends of area, strain and limit
_SEAM = (HALF - 32.0, HALF - 16.0, HALF)  # of the length on the body and of both sides


def pattern_blocks(handout: ReportDocument) -> tuple[list[Block], list[Block], list[Block]]:
    """Return the head with its picture, the table of pieces, and the table of seams, each a column."""
    pattern = handout.pattern
    assert pattern is not None
    if isinstance(pattern, Message):
        return [heading(tr("Pattern pieces"), WIDE), paragraph(render(pattern), "caution", WIDE)], [], []
    rows = piece_rows(pattern)
    title = tr("Pattern pieces: {block}").format(block=block_title(pattern.garment.block))
    return (
        [heading(title, WIDE), _verdict(rows), _picture(pattern, {row.name: row.title for row in rows})],
        [heading(tr("Pieces"), HALF), _piece_head(), *map(_piece, rows), *_reasons(rows)],
        [heading(tr("Seams"), HALF), _seam_head(), *map(_seam, _joined(seam_rows(pattern)))],
    )


def _verdict(rows: Sequence[PieceRow]) -> Block:
    fits = all(row.fits for row in rows)
    text = (
        tr("All pieces fit their cloths.")
        if fits
        else tr("Pieces in amber do not fit their cloths as they are: do not cut them.")
    )
    return paragraph(text, "body" if fits else "caution", WIDE)


def _picture(pattern: Pattern, titles: dict[str, str]) -> Block:
    """Return all pieces in one scale, in the order of the body."""
    shapes = piece_shapes(pattern, notches=False)
    moves = arranged(shapes, WIDE / HIGH)
    outlines = [
        shape.points[np.concatenate([points[:-1] for _, points, _ in shape.sides])] + move
        for shape, move in zip(shapes, moves, strict=True)
    ]
    every = np.concatenate(outlines)
    low, high = every.min(axis=0), every.max(axis=0)
    scale = float(min(WIDE / (high[0] - low[0]), (HIGH - 4.0) / (high[1] - low[1])))

    def paint(paper: PagePainter, x: float, y: float) -> None:
        corner = np.array([x + 0.5 * (WIDE - scale * (high[0] - low[0])), y + 2.0])
        for shape, move, outline in zip(shapes, moves, outlines, strict=True):
            places = _on_page(outline, low, high, scale) + corner
            ink = LIGHT.text if shape.fits else LIGHT.warn_mark
            paper.curve(np.concatenate([places, places[:1]]).tolist(), ink, 0.3)
            middle = _on_page((shape.label_place + move)[None], low, high, scale)[0] + corner
            room = 0.9 * float(np.ptp(places[:, 0]))
            words = elide(titles[shape.name], "caption", room)
            paper.text(float(middle[0]), float(middle[1]) + 1.0, words, "caption", align="middle")

    return Block(HIGH, paint, gap=2.0)


def _on_page(points: Floats, low: Floats, high: Floats, scale: float) -> Floats:
    return np.asarray(scale * np.stack([points[:, 0] - low[0], high[1] - points[:, 1]], axis=1))


def _piece_head() -> Block:
    return _row("", (tr("cm²"), tr("strain %"), tr("limit %")), _PIECE, "caption", 3.4)


def _piece(row: PieceRow) -> Block:
    values = (
        number(row.area_cm2, 0),
        number(row.strain_percent, 1),
        number(row.limit_percent, 0),
    )
    title = f"{row.title} · {row.cloth}"
    return _row(title, values, _PIECE, "figure" if row.fits else "caution", _ROW)


def _reasons(rows: Sequence[PieceRow]) -> Iterator[Block]:
    """Yield what the table does not show: why a piece cannot be sewn beside its strain, and where it bags."""
    for row in rows:
        strained = row.strain_percent > row.limit_percent
        if words := " ".join(filter(None, ("" if strained else row.reason, row.note))):
            yield bullet(f"{row.title}: {words}")


def _joined(rows: Sequence[SeamRow]) -> list[SeamRow]:
    """Return the seams, the longest of those with one name."""
    longest: dict[str, SeamRow] = {}
    for row in rows:
        if row.name not in longest or row.on_body_mm > longest[row.name].on_body_mm:
            longest[row.name] = row
    return list(longest.values())


def _seam_head() -> Block:
    titles = tr("on body {unit}").format(unit=length_unit()), tr("first"), tr("second")
    return _row("", titles, _SEAM, "caption", 3.4)


def _seam(row: SeamRow) -> Block:
    first, second = row.lengths_mm
    values = length_number(row.on_body_mm), length_number(first), length_number(second)
    return _row(row.title, values, _SEAM, "figure", _ROW)


def _row(title: str, values: Sequence[str], edges: Sequence[float], kind: str, high: float) -> Block:
    """Return a row of a table: a title at the left, figures at their right ends."""
    words = elide(title, "body", edges[0] - 10.0)

    def paint(paper: PagePainter, x: float, y: float) -> None:
        base = y + high - 1.2
        paper.text(x, base, words, "body")
        for edge, value in zip(edges, values, strict=True):
            paper.text(x + edge, base, value, kind, align="right")

    return Block(high, paint)
