"""Blocks of a sheet, and how they flow down columns and on to the next page."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from app.report.painter import PagePainter

Paint = Callable[[PagePainter, float, float], object]
"""Paints a block; it hears the left and the top of the place it is given [mm]."""


@dataclass(frozen=True, eq=False)
class Block:
    """A piece that is never parted: its ``height``, the ``gap`` over it but at the head of a column [mm].

    One that is to ``keep`` stands over the next one, in the same column.
    """

    height: float
    paint: Paint
    gap: float = 0.0
    keep: bool = False


@dataclass(frozen=True)
class Column:
    """Where blocks may stand: on which page, from ``x`` and ``top`` on, down to ``bottom`` [mm]."""

    page: int
    x: float
    top: float
    bottom: float


@dataclass(frozen=True, eq=False)
class PlacedBlock:
    """A block in its place [mm]."""

    page: int
    x: float
    y: float
    block: Block


def place_blocks(blocks: Iterable[Block], columns: Iterator[Column]) -> tuple[list[PlacedBlock], Column]:
    """Return blocks in their places, and what is left of the last column.

    A block that no column has room for stands at the head of one all the same.
    """
    column = next(columns)
    placed: list[PlacedBlock] = []
    y, head = column.top, True
    for group in _groups(blocks):
        needed = sum(block.height + block.gap for block in group) - (group[0].gap if head else 0.0)
        if not head and y + needed > column.bottom:
            column = next(columns)
            y, head = column.top, True
        for block in group:
            y += 0.0 if head else block.gap
            placed.append(PlacedBlock(column.page, column.x, y, block))
            y, head = y + block.height, False
    return placed, Column(column.page, column.x, y, column.bottom)


def _groups(blocks: Iterable[Block]) -> Iterator[list[Block]]:
    """Give blocks that stay together, each with those that are kept over it."""
    group: list[Block] = []
    for block in blocks:
        group.append(block)
        if not block.keep:
            yield group
            group = []
    if group:
        yield group
