"""Pieces for apparel CAD: DXF as AAMA and ASTM D6673 lay it out, one block a piece and nothing else.

Written here because libraries add blocks of layouts, headers and tables, which readers of that trade refuse:
R12 entities, an empty header, no tables, ASCII only (ezdxf, discussion 789 and issue 786).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from core.export.ascii_text import ascii_text
from core.export.report_data import Heading
from core.files.atomic_write import write_text
from core.geometry.mesh import Floats
from core.pattern.allowance import CutPiece
from core.pattern.annotation import STRETCH, annotate, english_words
from core.pattern.layout import Layout
from core.pattern.piece import BOTH, Piece, Points2

STANDARDS = ("aama", "astm")
"""The conventions that readers ask for; they differ in words, notches and quality curves."""

BOUNDARY, TURN, CURVE, NOTCH, GRAIN, INTERNAL, DRILL, SEW, NOTE = 1, 2, 3, 4, 7, 8, 13, 14, 15
"""Layers by what they hold."""

QUALITY = {BOUNDARY: 84, INTERNAL: 85, SEW: 87}
"""Layers on which ASTM wants the same curves again."""

LONGEST_NAME = 20
"""Letters of a name that every reader takes."""

_CORNER = float(np.radians(25.0))  # turn points turn by more
_HOLE = 2.0  # diameter of a drill hole [mm]
_LETTERS = 3.0  # [mm]


@dataclass(frozen=True)
class _Words:
    """The keys of texts under one convention, and what tells its version."""

    piece: tuple[str, str, str, str]
    style: tuple[str, str, str, str, str, str]
    version: str


_WORDS = {
    "aama": _Words(
        ("PIECE NAME", "SIZE", "QUANTITY", "MATERIAL"),
        ("STYLE NAME", "CREATION DATE", "AUTHOR", "SAMPLE SIZE", "GRADE RULE TABLE", "UNITS"),
        "ANSI/AAMA VERSION: 1.0.0",
    ),
    "astm": _Words(
        ("Piece Name", "Size", "Quantity", "Material"),
        ("Style Name", "Creation Date", "Author", "Sample Size", "Grade Rule Table", "Units"),
        "ASTM/D13 Proposal 1 Version: D6673-10",
    ),
}


def write_pattern_dxf(path: Path, layout: Layout, heading: Heading, standard: str = "aama") -> None:
    """Write the pieces of a layout in one of ``STANDARDS``, whole or not at all. Raises ProjectError."""
    tags = [*_section("HEADER"), *_section("BLOCKS")[:-1]]
    names = block_names([each.piece for each in layout.pieces])
    for name, piece in zip(names, layout.pieces, strict=True):
        tags += _block(name, piece, heading, standard)
    tags += [(0, "ENDSEC"), *_section("ENTITIES")[:-1], *_style(layout, heading, standard)]
    for name, piece in zip(names, layout.pieces, strict=True):
        tags += [(0, "INSERT"), (8, BOUNDARY), (2, name), *_place(_corner(piece))]
    tags += [(0, "ENDSEC"), (0, "EOF")]
    text = "\n".join(f"{code:3d}\n{value}" for code, value in tags) + "\n"
    write_text(path, text, "ascii")


def block_names(pieces: Sequence[Piece]) -> list[str]:
    """Return a name for each piece that readers take: capitals without blanks, each another one."""
    names: list[str] = []
    for piece in pieces:
        plain = re.sub(r"[^A-Z0-9]+", "_", ascii_text(piece.key).upper()).strip("_")[:LONGEST_NAME] or "PIECE"
        name, count = plain, 1
        while name in names:
            count += 1
            name = f"{plain[: LONGEST_NAME - 3]}_{count}"
        names.append(name)
    return names


Tag = tuple[int, object]
"""A group code and its value."""


def _section(name: str) -> list[Tag]:
    return [(0, "SECTION"), (2, name), (0, "ENDSEC")]


def _block(name: str, cut: CutPiece, heading: Heading, standard: str) -> Iterator[Tag]:
    """Yield the block of a piece, whose origin is the lower left corner of its cut line."""
    cut = cut.shifted(-_corner(cut))
    yield from ((0, "BLOCK"), (8, BOUNDARY), (2, name), (70, 0), *_place(np.zeros(2)), (3, name))
    note = annotate(cut, english_words(cut.piece, (heading.customer, heading.date)))
    yield from _texts(_piece_texts(name, cut.piece, standard), note.centre - [0.0, 8.0], BOUNDARY)
    yield from _texts([ascii_text(each) for each in note.lines], note.centre, NOTE)
    yield from _curve(cut.cut, BOUNDARY, standard, closed=True)
    yield from _curve(cut.piece.outline, SEW, standard, closed=True)
    for _, points in cut.piece.internal:
        yield from _curve(points, INTERNAL, standard, closed=False)
    for legs, tip in cut.piece.darts:
        yield from _curve(legs, INTERNAL, standard, closed=False)
        yield from _point(tip, DRILL, z=_HOLE)
    yield from _curve(note.stretch, INTERNAL, standard, closed=False)
    yield from _texts([str(STRETCH)], note.stretch_word, NOTE)
    for place, inner in cut.notches:
        way = inner - place
        angle = float(np.degrees(np.arctan2(way[1], way[0]))) % 360.0
        yield from _point(place, NOTCH, z=float(np.linalg.norm(way)), more=((39, _mm(0.0)), (50, _mm(angle))))
    start, end = note.grain
    yield from ((0, "LINE"), (8, GRAIN), *_place(start), (11, _mm(end[0])), (21, _mm(end[1])), (31, _mm(0.0)))
    yield from ((0, "ENDBLK"), (8, BOUNDARY))


def _piece_texts(name: str, piece: Piece, standard: str) -> list[str]:
    half = piece.count // 2
    each_way = (half, piece.count - half) if piece.side == BOTH else (piece.count, 0)
    count = f"{each_way[0]},{each_way[1]}" if standard == "astm" else str(piece.count)
    values = (name, "M2M", count, ascii_text(piece.cloth))
    return [f"{key}: {value}" for key, value in zip(_WORDS[standard].piece, values, strict=True)]


def _style(layout: Layout, heading: Heading, standard: str) -> Iterator[Tag]:
    year, month, day = (*heading.date.split("-"), "", "")[:3]
    date = "-".join(each for each in (day, month, year) if each)
    values = (ascii_text(heading.project)[:LONGEST_NAME] or "STYLE", date, "Busk", "M2M", "", "METRIC")
    words = _WORDS[standard]
    texts = [f"{key}: {value}".strip() for key, value in zip(words.style, values, strict=True)]
    yield from _texts([*texts, words.version], np.array([0.0, -layout.height - 20.0]), BOUNDARY)


def _texts(lines: Iterable[str], start: Floats, layer: int) -> Iterator[Tag]:
    """Yield texts below each other."""
    for count, line in enumerate(lines):
        place = start - [0.0, 1.6 * _LETTERS * count]
        yield from ((0, "TEXT"), (8, layer), *_place(place), (40, _mm(_LETTERS)), (1, line))


def _curve(points: Points2, layer: int, standard: str, closed: bool) -> Iterator[Tag]:
    """Yield a polyline, again for quality under ASTM, and its turn and curve points."""
    yield from _polyline(points, layer, closed)
    if standard == "astm":
        yield from _polyline(points, QUALITY[layer], closed)
    for place, is_corner in zip(points, _corners(points, closed), strict=True):
        yield from _point(place, TURN if is_corner else CURVE)


def _polyline(points: Points2, layer: int, closed: bool) -> Iterator[Tag]:
    yield from ((0, "POLYLINE"), (8, layer), (66, 1), *_place(np.zeros(2)), (70, int(closed)))
    for place in points:
        yield from ((0, "VERTEX"), (8, layer), *_place(place))
    yield from ((0, "SEQEND"), (8, layer))


def _corners(points: Points2, closed: bool) -> list[bool]:
    """Return which points of a curve are corners; both ends of an open one are."""
    before, after = np.roll(points, 1, axis=0), np.roll(points, -1, axis=0)
    a, b = points - before, after - points
    turn = np.abs(np.arctan2(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], (a * b).sum(axis=1)))
    if not closed:
        turn[[0, -1]] = np.pi
    return [bool(each) for each in turn > _CORNER]


def _point(place: Floats, layer: int, z: float = 0.0, more: Iterable[Tag] = ()) -> Iterator[Tag]:
    yield from ((0, "POINT"), (8, layer), *_place(place, z), *more)


def _place(place: Floats, z: float = 0.0) -> tuple[Tag, Tag, Tag]:
    return (10, _mm(place[0])), (20, _mm(place[1])), (30, _mm(z))


def _corner(cut: CutPiece) -> Floats:
    """Return the lower left corner of the room of a piece, (2,) [mm]."""
    return np.asarray(cut.cut.min(axis=0))


def _mm(value: float) -> str:
    return f"{value + 0.0:.4f}"
