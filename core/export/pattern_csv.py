"""Pieces and seams as tables of comma-separated values."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from core.export.csv_cells import ENCODING, csv_text
from core.files.atomic_write import write_text
from core.pattern.piece import Piece, Side, sewn_length

PIECE_COLUMNS = (
    "piece",
    "side",
    "cloth",
    "cut",
    "area_cm2",
    "width_mm",
    "height_mm",
    "outline_mm",
    "notches",
)

SEAM_COLUMNS = (
    "piece",
    "side",
    "number",
    "seam",
    "sewn_to",
    "sewn_to_number",
    "length_mm",
    "sewn_to_length_mm",
    "difference_mm",
    "allowance_mm",
    "notches",
    "notches_at_mm",
    "elastic_of_line",
    "elastic",
    "elastic_cut_mm",
    "elastic_part_mm",
)


def write_pieces(path: Path, pieces: Sequence[Piece]) -> None:
    """Write a row for each piece, its sizes on the sew line; whole or not at all. Raises ProjectError."""
    write_text(path, csv_text(PIECE_COLUMNS, map(_piece_row, pieces)), ENCODING)


def write_seams(path: Path, pieces: Sequence[Piece]) -> None:
    """Write a row for each side of each piece with the length of what is sewn to it; whole or not at all.

    Raises ProjectError.
    """
    known = {each.key: each for each in pieces}
    rows = [
        _seam_row(piece, number, side, sewn_length(known, side))
        for piece in pieces
        for number, side in enumerate(piece.sides, start=1)
    ]
    write_text(path, csv_text(SEAM_COLUMNS, rows), ENCODING)


def _piece_row(piece: Piece) -> tuple[object, ...]:
    width, height = (float(each) for each in piece.outline.max(axis=0) - piece.outline.min(axis=0))
    length = sum(each.length for each in piece.sides)
    notches = sum(len(each.notches) for each in piece.sides)
    area = piece.area / 100.0
    return piece.name, piece.side, piece.cloth, piece.count, area, width, height, length, notches


def _seam_row(piece: Piece, number: int, side: Side, sewn: float | None) -> tuple[object, ...]:
    partner, elastic = side.partner, side.elastic
    carried = (elastic.line, elastic.elastic, elastic.cut_mm, elastic.part_mm) if elastic else (None,) * 4
    return (
        piece.name,
        piece.side,
        number,
        side.name,
        partner[0] if partner else None,
        partner[1] + 1 if partner else None,
        side.length,
        sewn,
        None if sewn is None else side.length - sewn,
        side.allowance,
        len(side.notches),
        tuple(round(share * side.length, 1) for share in side.notches),
        *carried,
    )
