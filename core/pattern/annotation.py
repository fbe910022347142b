"""What is written on a piece: its words, the grain line and the arrow of greatest stretch, all inside it."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from core.geometry.mesh import Floats
from core.messages import ClothName, Length, LineName, Message, PieceName, SideName
from core.pattern.allowance import CutPiece, sew_shape
from core.pattern.piece import BOTH, EdgeElastic, Piece

Say = Callable[[Message], str]
"""Returns a message as it is to be written."""

STRETCH = Message("stretch")
"""What is written at the arrow of the greatest stretch."""

STRETCH_LETTERS = 2.4
"""Size of its letters [mm]."""

_LETTERS = (4.0, 3.4, 2.8, 2.3)  # sizes that are tried [mm]
_NARROW = 8.0  # width of a line in a narrow piece, in sizes of letters [1]
_LINE = 1.4  # from line to line, in sizes of letters [1]
_FREE = 2.5  # between words and the sew line, and between arrows and words [mm]
_LEAST = 0.8  # the same on a strip that is too narrow for that [mm]
_STEP = 3.0  # between places that are tried [mm]
_LONGEST = (90.0, 40.0)  # grain line and stretch [mm]
_ENDS = 5.0  # from an arrow to the sew line and to words [mm]
_SHORTEST = 12.0  # of an arrow, before it comes nearer to them or crosses the other one [mm]


@dataclass(frozen=True, eq=False)
class Annotation:
    """``lines`` of words about ``centre`` (2,), their letters of a ``size``; the ``grain`` line and the arrow
    of greatest ``stretch`` from end to end, (2, 2) [mm].
    """

    lines: tuple[str, ...]
    centre: Floats
    size: float
    grain: Floats
    stretch: Floats

    @property
    def stretch_word(self) -> Floats:
        """Return where the word at the arrow of greatest stretch stands, in its middle, (2,) [mm]."""
        across, along = np.abs(self.stretch[1] - self.stretch[0])
        beside = [0.0, 1.7] if across >= along else [6.5, -0.8]  # above the arrow, or to its right
        return np.asarray(self.stretch.mean(axis=0) + np.array(beside))

    @property
    def bases(self) -> Floats:
        """Return where the letters of each line stand, in its middle, (k, 2) [mm]."""
        step = _LINE * self.size
        top = self.centre[1] + 0.5 * step * len(self.lines)
        rows = np.arange(len(self.lines))
        return np.stack([np.full(len(rows), self.centre[0]), top - (rows + 0.75) * step], axis=1)


def piece_words(piece: Piece, say: Say = str, about: Sequence[str] = ()) -> tuple[str, ...]:
    """Return the words on a piece: name, cloth, number, elastics, and what is on all pieces (``about``)."""
    name = PieceName(piece.name)
    alone = Message("{name}", name=name)
    named = Message("{name}, {side}", name=name, side=SideName(piece.side))
    title = piece.title or say(alone if piece.side in ("", BOTH) else named)
    count = (
        Message("cut {count}, mirrored", count=piece.count)
        if piece.side == BOTH
        else Message("cut {count}", count=piece.count)
    )
    cloth = piece.cloth_title or say(Message("{cloth}", cloth=ClothName(piece.cloth)))
    carried = map(say, _elastic_words([each for side in piece.sides if (each := side.elastic)]))
    return (title[:1].upper() + title[1:], cloth, say(count), *carried, *filter(None, about))


def english_words(piece: Piece, about: Sequence[str] = ()) -> tuple[str, ...]:
    """Return the words on a piece for formats without letters of other languages, from keys alone."""
    return piece_words(replace(piece, title="", cloth_title=""), str, about)


def elastic_words(line: str, part: float | None, whole: float | None) -> Message:
    """Return what is said of an elastic, of which a ``part`` lies on edges and the ``whole`` is cut [mm]."""
    if part is None or whole is None:
        return Message("{line}: elastic, length not known", line=LineName(line))
    return Message(
        "{line}: elastic, {part} of {whole} to cut",
        line=LineName(line),
        part=Length(part),
        whole=Length(whole),
    )


def _elastic_words(elastics: Sequence[EdgeElastic]) -> Iterator[Message]:
    """Yield what is said of each elastic on a piece, of which it may carry parts on several edges."""
    for line in dict.fromkeys(each.line for each in elastics):
        own = [each for each in elastics if each.line == line]
        yield elastic_words(line, sum(each.part_mm or 0.0 for each in own) or None, own[0].cut_mm)


def annotate(cut: CutPiece, lines: Sequence[str]) -> Annotation:
    """Place words, grain line and stretch inside the sew line, where they cross neither it nor each other.

    The letters are as large as fits; where no size does, lines are broken, then left out from the last on.
    """
    piece, shape = cut.piece, sew_shape(cut.piece)
    inner = [shapely.LineString(points).buffer(1.0) for _, points in piece.internal]
    free = shape.difference(shapely.union_all(inner)) if inner else shape
    written, size, centre = _place_words(free, tuple(lines))
    half = 0.5 * np.array(_extent(written, size))
    for ends, crossing in ((_ENDS, False), (_FREE, False), (_FREE, True)):
        room = half + np.array([ends, _ENDS])  # the word at an arrow fits between it and a line of words
        rest = free.buffer(-ends).difference(shapely.box(*(centre - room), *(centre + room)))
        grain = _arrow(rest, np.array(piece.grain), centre, _LONGEST[0])
        beside = rest if crossing else rest.difference(shapely.LineString(grain).buffer(ends))
        stretch = _arrow(beside, np.array(piece.stretch), centre, _LONGEST[1])
        if min(np.linalg.norm(each[1] - each[0]) for each in (grain, stretch)) >= _SHORTEST:
            break
    return Annotation(written, centre, size, grain, stretch)


def text_width(text: str) -> float:
    """Return about how wide a text is in sizes of its letters [1]: those of the East are as wide as high."""
    return sum(1.0 if unicodedata.east_asian_width(each) in "WF" else 0.56 for each in text)


def _extent(lines: Sequence[str], size: float) -> tuple[float, float]:
    return max((text_width(each) for each in lines), default=0.0) * size, _LINE * size * len(lines)


def _place_words(free: BaseGeometry, lines: tuple[str, ...]) -> tuple[tuple[str, ...], float, Floats]:
    """Return the lines that fit, the size of their letters and the middle of the room that they take."""
    places = _grid(free)
    depth = shapely.distance(shapely.points(places), free.boundary)
    row = (" · ".join(lines),)  # on a strip
    tries = (lines, row, _broken(lines), _broken(lines[:3]), _broken(lines[:3:2]), lines[:1])
    for written, around in (*((each, _FREE) for each in tries), (row, _LEAST), (lines[:1], _LEAST)):
        for size in _LETTERS:
            half = 0.5 * np.array(_extent(written, size)) + around
            boxes = shapely.box(*(places - half).T, *(places + half).T)
            fits = shapely.contains_properly(free, boxes)
            if fits.any():
                return written, size, places[np.flatnonzero(fits)[np.argmax(depth[fits])]]
    return lines[:1], _LETTERS[-1], places[np.argmax(depth)]


def _broken(lines: Sequence[str]) -> tuple[str, ...]:
    """Return lines of at most ``_NARROW`` letters' width, broken at blanks, or between wide letters."""
    found = []
    for line in lines:
        found.append("")
        for part in re.findall(r"\s*(?:[!-\u2e7f]+|\S)", line):
            if found[-1] and text_width(found[-1] + part) > _NARROW:
                found.append("")
            found[-1] += part if found[-1] else part.lstrip()
    return tuple(found)


def _grid(free: BaseGeometry) -> Floats:
    """Return places inside a shape, (k, 2), at least one."""
    left, low, right, top = free.bounds
    x, y = np.meshgrid(np.arange(left, right, _STEP), np.arange(low, top, _STEP))
    places = np.stack([x.ravel(), y.ravel()], axis=1)
    shapely.prepare(free)
    inside = places[shapely.contains_xy(free, places[:, 0], places[:, 1])]
    return inside if len(inside) else np.array([free.representative_point().coords[0]])


def _arrow(free: BaseGeometry, way: Floats, near: Floats, longest: float) -> Floats:
    """Return the ends of a long straight line of a direction in a shape, not far from a place, (2, 2)."""
    if free.is_empty:
        return np.array([near, near])
    left, low, right, top = free.bounds
    reach = float(np.hypot(right - left, top - low))
    across = np.array([-way[1], way[0]])
    middle = np.array([left + right, low + top]) / 2.0
    best, score = np.array([middle, middle]), -np.inf
    count = int(0.5 * reach / _STEP)
    for shift in _STEP * np.arange(-count, count + 1):  # a narrow strip has room in its middle only
        centre = middle + shift * across
        beam = shapely.LineString([centre - reach * way, centre + reach * way]).intersection(free)
        for part in shapely.get_parts(beam):
            ends = shapely.get_coordinates(part)
            if len(ends) < 2:
                continue
            foot = np.sort((ends[[0, -1]] - centre) @ way)
            length = min(float(foot[1] - foot[0]), longest)
            at = centre + way * np.clip((near - centre) @ way, foot[0] + length / 2.0, foot[1] - length / 2.0)
            value = length - 0.4 * float(np.linalg.norm(at - near))
            if value > score:
                best, score = np.array([at - way * length / 2.0, at + way * length / 2.0]), value
    return best


def arrow_heads(line: Floats, long: float = 3.5, wide: float = 1.1) -> tuple[Floats, Floats]:
    """Return the heads at both ends of a line (2, 2): a side, the tip and the other side, (3, 2) [mm]."""
    way = line[1] - line[0]
    way = way / max(float(np.linalg.norm(way)), 1e-9)
    across = np.array([-way[1], way[0]])
    first, last = (
        np.array([tip + back * long * way + wide * across, tip, tip + back * long * way - wide * across])
        for tip, back in ((line[0], 1.0), (line[1], -1.0))
    )
    return first, last
