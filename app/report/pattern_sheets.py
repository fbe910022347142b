"""Pattern pieces on paper at full size: an overview, then sheets that are glued together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from PySide6.QtGui import QPainter
from shapely.geometry.base import BaseGeometry

from app.i18n.catalog import tr, using_language
from app.presenters.messages import render, sided_title
from app.rendering.palette import LIGHT
from app.report.painter import PagePainter, elide, line_height, text_width, wrap
from core.export.report_data import Heading
from core.geometry.mesh import Floats
from core.messages import PieceName
from core.pattern.allowance import CutPiece
from core.pattern.annotation import (
    STRETCH,
    STRETCH_LETTERS,
    Annotation,
    annotate,
    arrow_heads,
    piece_words,
)
from core.pattern.layout import MARGIN, OVERLAP, SQUARE, SQUARE_WORDS, Tile, Tiling, cut_shape
from core.pattern.piece import Points2

CUT, SEW, FINE = 0.5, 0.25, 0.15
"""Weights of cut lines and notches, of sew lines and arrows, and of what is no part of a piece [mm]."""

_HEAD, _FOOT = 24.0, 14.0  # of the overview [mm]
_KEY = 14.0  # length of a sample of a line [mm]
_SHEET = (7.0, 4.0)  # of that in the small picture [mm]
_NAME = (36.0, 20.0)  # of the room for the name of a sheet [mm]


@dataclass(frozen=True, eq=False)
class PatternSheets:
    """The sheets of a ``tiling``, after an overview unless there is only one; ``notes`` are of its pieces."""

    tiling: Tiling
    heading: Heading
    notes: tuple[Annotation, ...]
    language: str

    @property
    def count(self) -> int:
        """Return the number of pages."""
        return len(self.tiling.tiles) + self._has_overview

    @property
    def size(self) -> tuple[float, float]:
        """Return width and height of each page [mm]."""
        return self.tiling.size

    @property
    def _has_overview(self) -> bool:
        return len(self.tiling.tiles) > 1

    def paint(self, painter: QPainter, page: int) -> None:
        """Paint a page, counted from 0; ``painter`` has ``painter.UNITS`` to a millimetre."""
        paper = PagePainter(painter)
        with using_language(self.language):
            if self._has_overview and page == 0:
                _Overview(self, paper).paint()
            else:
                _Sheet(self, paper, self.tiling.tiles[page - self._has_overview]).paint()

    @property
    def about(self) -> str:
        """Return what stands on each page: style, customer and date."""
        heading = self.heading
        return " · ".join(filter(None, (heading.project, heading.customer, heading.variant, heading.date)))


def pattern_sheets(tiling: Tiling, heading: Heading, language: str) -> PatternSheets:
    """Return the sheets of a tiling in a language of ``app.i18n.catalog.LANGUAGES``."""
    with using_language(language):
        about = (heading.customer, heading.date)
        notes = tuple(annotate(each, piece_words(each.piece, render, about)) for each in tiling.layout.pieces)
        return PatternSheets(tiling, heading, notes, language)


class _Drawing:
    """Draws the layout at a scale: ``origin`` is where its top left corner is on the page, (2,) [mm]."""

    def __init__(self, paper: PagePainter, origin: Floats, scale: float = 1.0) -> None:
        self.paper, self._origin, self._scale = paper, origin, scale

    def on_page(self, places: Points2) -> Points2:
        """Return places of the layout on the page, (k, 2) [mm]."""
        return np.asarray(self._origin + self._scale * np.asarray(places) * [1.0, -1.0])

    def line(self, places: Points2, weight: float, ink: str = LIGHT.text, *, dashed: bool = False) -> None:
        """Draw a line."""
        self.paper.curve(self.on_page(places).tolist(), ink, weight, dashed=dashed)

    def outline(self, places: Points2, weight: float, ink: str = LIGHT.text, *, dashed: bool = False) -> None:
        """Draw a closed line."""
        self.line(np.concatenate([places, places[:1]]), weight, ink, dashed=dashed)

    def words(
        self, place: Floats, text: str, size: float, ink: str = LIGHT.text, *, strong: bool = False
    ) -> None:
        """Write a line of text about a place on which its letters stand, of a size [mm]."""
        x, y = self.on_page(place[None])[0]
        self.paper.letters(x, y, text, size, ink, strong=strong)

    def piece(self, cut: CutPiece, note: Annotation) -> None:
        """Draw a piece with everything on it."""
        self.outline(cut.piece.outline, SEW, LIGHT.bad, dashed=True)
        for _, points in cut.piece.internal:
            self.line(points, SEW, LIGHT.info, dashed=True)
        self.outline(cut.cut, CUT)
        for points in cut.notches:
            self.line(points, CUT)
        self.line(note.grain, SEW)
        for head in arrow_heads(note.grain):
            self.paper.shape(self.on_page(head).tolist(), LIGHT.text)
        self.line(note.stretch, SEW, LIGHT.info)
        for head in arrow_heads(note.stretch):
            self.line(head, SEW, LIGHT.info)
        self.words(note.stretch_word, render(STRETCH), STRETCH_LETTERS, LIGHT.info)
        for number, (line, base) in enumerate(zip(note.lines, note.bases, strict=True)):
            self.words(base, line, note.size, strong=number == 0)

    def square(self, corner: Floats) -> None:
        """Draw the test square with what to do with it."""
        corners = corner + SQUARE * np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
        self.outline(corners, SEW)
        middle = corners.mean(axis=0)
        self.words(middle, SQUARE_WORDS, 5.0)
        text = tr("Measure after printing. Otherwise print again at 100 %.")
        for count, line in enumerate(wrap(text, "small", SQUARE + 4.0)):
            below = corner + np.array([SQUARE / 2.0, -4.0 - 3.6 * count])
            self.words(below, line, 2.65, LIGHT.text_quiet)


class _Sheet:
    """One sheet of paper with its part of the layout."""

    def __init__(self, sheets: PatternSheets, paper: PagePainter, tile: Tile) -> None:
        self._sheets, self._paper, self._tile = sheets, paper, tile
        self._width, self._height = sheets.size
        self._names = {each.name for each in sheets.tiling.tiles}

    def paint(self) -> None:
        """Paint the sheet."""
        left, low, right, top = self._tile.window
        paper, wide, high = self._paper, right - left, top - low
        drawing = _Drawing(paper, np.array([MARGIN - left, MARGIN + top]))
        window = shapely.box(left, low, right, top)
        paper.clip(MARGIN, MARGIN, wide, high)
        if len(self._names) > 1:
            self._name(drawing)
        for each, note in zip(self._sheets.tiling.layout.pieces, self._sheets.notes, strict=True):
            if window.intersects(cut_shape(each)):
                drawing.piece(each, note)
        drawing.square(self._sheets.tiling.layout.square)
        paper.unclip()
        if len(self._names) > 1:
            self._frame(wide, high)
        self._foot()

    def _name(self, drawing: _Drawing) -> None:
        """Write large and pale where the sheet belongs, in a corner that is free if there is one."""
        left, low, right, top = self._tile.window
        inset = np.array(_NAME) / 2.0
        corners = np.array(
            [[right, top], [left, top], [right, low + OVERLAP], [left, low + OVERLAP]]
        ) + inset * np.array([[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]])
        layout = self._sheets.tiling.layout
        square = shapely.box(*(layout.square - [0.0, 16.0]), *(layout.square + SQUARE))
        taken = [square, *map(cut_shape, layout.pieces)]
        free = (
            each
            for each in corners
            if not any(shapely.box(*(each - inset), *(each + inset)).intersects(shape) for shape in taken)
        )
        centre = next(free, corners[0])
        drawing.words(centre - np.array([0.0, 5.0]), self._tile.name, 14.0, LIGHT.line)

    def _frame(self, wide: float, high: float) -> None:
        """Draw where the sheet is cut, and where its neighbours are glued on, with a mark on both."""
        paper, tile = self._paper, self._tile
        x0, y0, x1, y1 = MARGIN, MARGIN, MARGIN + wide, MARGIN + high
        paper.curve([(x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)], LIGHT.text_caption, FINE)
        middle = (0.5 * (x0 + x1), 0.5 * (y0 + y1))
        for row, column, at in ((0, -1, x0), (0, 1, x1 - OVERLAP)):
            if (name := f"{tile.row + row}-{tile.column + column}") in self._names:
                paper.curve([(at, y0), (at, y1)], LIGHT.text_caption, FINE, dashed=column > 0)
                self._mark(at, middle[1])
                self._neighbour(at + (OVERLAP / 2.0 if column > 0 else -5.0), middle[1] - 6.0, name)
        for row, column, at in ((-1, 0, y0), (1, 0, y1 - OVERLAP)):
            if (name := f"{tile.row + row}-{tile.column + column}") in self._names:
                paper.curve([(x0, at), (x1, at)], LIGHT.text_caption, FINE, dashed=row > 0)
                self._mark(middle[0], at)
                self._neighbour(middle[0] + 10.0, at + (OVERLAP / 2.0 + 1.0 if row > 0 else -3.0), name)

    def _mark(self, x: float, y: float) -> None:
        """Draw a mark that must meet that of the neighbour."""
        self._paper.curve(
            [(x - 3.0, y), (x, y - 3.0), (x + 3.0, y), (x, y + 3.0), (x - 3.0, y)], LIGHT.text, FINE
        )

    def _neighbour(self, x: float, y: float, name: str) -> None:
        self._paper.letters(x, y, name, 3.0, LIGHT.text_quiet)

    def _foot(self) -> None:
        base = self._height - 4.6
        right = tr("Print at 100 %, do not fit to the page")
        room = self._width - 2.0 * MARGIN
        name = self._tile.name if len(self._names) > 1 else ""
        indent = text_width(name, "small strong") + 4.0 if name else 0.0
        about = elide(self._sheets.about, "caption", room - indent - text_width(right, "small strong") - 8.0)
        self._paper.text(MARGIN, base, name, "small strong")
        self._paper.text(MARGIN + indent, base, about, "caption")
        self._paper.text(MARGIN + room, base, right, "small strong", align="right")


class _Overview:
    """The first page: what is printed, how the sheets are put together, and the list of pieces."""

    def __init__(self, sheets: PatternSheets, paper: PagePainter) -> None:
        self._sheets, self._paper = sheets, paper
        self._width, self._height = sheets.size
        self._room = self._width - 2.0 * MARGIN

    def paint(self) -> None:
        """Paint the page."""
        paper, about = self._paper, self._sheets.about
        paper.text(MARGIN, MARGIN + 7.0, tr("Pattern pieces"), "title")
        paper.text(MARGIN, MARGIN + 13.5, elide(about, "name", self._room), "name")
        paper.rule(MARGIN, MARGIN + 17.0, self._room, ink=LIGHT.line)
        wide = self._width > self._height
        column = 0.40 * self._room if wide else self._room
        foot = self._height - MARGIN
        if wide:
            self._picture(
                MARGIN + column + 8.0, MARGIN + _HEAD, self._room - column - 8.0, foot - MARGIN - _HEAD
            )
            self._words(MARGIN, MARGIN + _HEAD, column)
        else:
            half = 0.5 * (foot - MARGIN - _HEAD)
            self._picture(MARGIN, MARGIN + _HEAD, self._room, half)
            self._words(MARGIN, MARGIN + _HEAD + half + 6.0, self._room)

    def _picture(self, x: float, y: float, wide: float, high: float) -> None:
        """Draw the layout small with the edges and names of its sheets."""
        tiling, paper = self._sheets.tiling, self._paper
        left, low, right, top = (
            float(pick([each.window[k] for each in tiling.tiles]))
            for k, pick in enumerate((min, min, max, max))
        )
        scale = min(wide / (right - left), high / (top - low))
        drawing = _Drawing(paper, np.array([x, y]) + scale * np.array([-left, top]), scale)
        for each in tiling.layout.pieces:
            drawing.outline(each.cut, SEW)
        square = tiling.layout.square
        corners = square + SQUARE * np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
        drawing.outline(corners, FINE)
        taken = self._piece_names(drawing)
        for tile in tiling.tiles:
            x0, y0, x1, y1 = tile.window
            corners = np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])
            drawing.outline(corners, FINE, LIGHT.text_caption, dashed=True)
            upper, lower = (drawing.on_page(corners[[k]])[0] for k in (3, 1))
            rooms = [
                shapely.box(left, top, left + _SHEET[0], top + _SHEET[1])
                for left in (lower[0] - _SHEET[0] - 1.0, upper[0] + 1.0)
                for top in (upper[1] + 1.0, lower[1] - _SHEET[1] - 1.0)
            ]
            room = next((each for each in rooms if not each.intersects(taken)), rooms[0])
            paper.letters(room.centroid.x, room.bounds[3] - 1.0, tile.name, 2.65, LIGHT.info, strong=True)
            taken = taken.union(room)

    def _piece_names(self, drawing: _Drawing) -> BaseGeometry:
        """Write the names of pieces into the small picture, and return what they take of the page."""
        boxes = []
        for each, note in zip(self._sheets.tiling.layout.pieces, self._sheets.notes, strict=True):
            name = sided_title(PieceName(each.piece.name))
            x, y = drawing.on_page(note.centre[None])[0]
            self._paper.letters(x, y + 1.0, name, 2.6)
            half = 0.5 * text_width(name, "body")
            boxes.append(shapely.box(x - half, y - 2.0, x + half, y + 2.0))
        return shapely.union_all(boxes)

    def _words(self, x: float, y: float, wide: float) -> None:
        """Write how to put the sheets together, what the lines mean, and which pieces there are."""
        paper, tiling = self._paper, self._sheets.tiling
        square = next(each.name for each in tiling.tiles if _holds(each, tiling.layout.square))
        steps = (
            tr("Print all sheets at 100 %; do not let the printer fit them to the page."),
            tr("Measure the square on sheet {sheet}: its sides must be {length} long.").format(
                sheet=square, length=SQUARE_WORDS
            ),
            tr(
                "Sheets are named row-column. Cut each along its left and upper edge, lay it on the dashed "
                "line of its neighbour so that the marks meet, and glue."
            ),
        )
        y = paper.lines(x, y, [tr("How to put the sheets together")], "heading") + 1.0
        for count, step in enumerate(steps, start=1):
            paper.text(x, y + 0.74 * line_height("body"), f"{count}.", "body")
            y = paper.lines(x + 5.0, y, wrap(step, "body", wide - 5.0), "body") + 0.8
        y = self._key(x, y + 3.0)
        y = paper.lines(x, y + 3.0, [tr("Pieces")], "heading") + 1.0
        for each in tiling.layout.pieces:
            title, cloth, number, *_ = piece_words(each.piece, render)
            words = elide(f"{title} · {cloth}", "body", wide - text_width(number, "figure strong") - 4.0)
            paper.text(x, y + 0.74 * line_height("body"), words, "body")
            paper.text(x + wide, y + 0.74 * line_height("body"), number, "figure strong", align="right")
            y += line_height("body")

    def _key(self, x: float, y: float) -> float:
        """Draw a sample of each line with its name, and return where they end."""
        paper = self._paper
        rows: Sequence[tuple[str, str, float, bool]] = (
            (tr("cut line and notches"), LIGHT.text, CUT, False),
            (tr("sew line"), LIGHT.bad, SEW, True),
            (tr("grain line"), LIGHT.text, SEW, False),
            (tr("greatest stretch"), LIGHT.info, SEW, False),
        )
        for number, (name, ink, weight, dashed) in enumerate(rows):
            level = y + 0.5 * line_height("body")
            line = np.array([[x, -level], [x + _KEY, -level]])
            drawing = _Drawing(paper, np.zeros(2))
            drawing.line(line, weight, ink, dashed=dashed)
            if number == 0:
                drawing.line(np.array([[x + 5.0, -level], [x + 5.0, -level - 2.0]]), weight, ink)
            if number == 2:
                for head in arrow_heads(line):
                    paper.shape(drawing.on_page(head).tolist(), ink)
            if number == 3:
                for head in arrow_heads(line):
                    drawing.line(head, weight, ink)
            paper.text(x + _KEY + 3.0, y + 0.74 * line_height("body"), name, "body")
            y += line_height("body")
        return y


def _holds(tile: Tile, square: Floats) -> bool:
    """Return whether a sheet shows the whole test square."""
    left, low, right, top = tile.window
    (x, y), (x1, y1) = square, square + SQUARE
    return bool(left <= x and x1 <= right and low <= y and y1 <= top)
