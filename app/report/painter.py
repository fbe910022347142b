"""Paper: a painter in millimetres, with the few kinds of type, rules and marks that a sheet is made of."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache

from PySide6.QtCore import QPointF, QRectF, QSizeF, Qt
from PySide6.QtGui import (
    QColor,
    QFont,
    QFontMetricsF,
    QImage,
    QPainter,
    QPainterPath,
    QPen,
    QPolygonF,
    QTextLayout,
    QTextOption,
)

from app.rendering.palette import LIGHT
from core.garment.assessment import BAD, CAUTION, GOOD

A4 = (210.0, 297.0)
"""Width and height of a page [mm]."""

MARGIN = 14.0
"""What stays empty round a page [mm]."""

UNITS = 100
"""Units of the painter in a millimetre: type has whole sizes there, and a hundredth is fine enough."""

_POINT = 25.4 / 72.0  # [mm]

FAMILIES = ("Inter", "Inter Variable", "Noto Sans JP")
FIGURES = ("Inter Figures", *FAMILIES)  # of equal width; see resources/fonts/README.md

_STRONG = 640  # 600 in Inter, and in Noto Sans JP, which has no 600, rather bold than medium

TYPES = {
    "title": (17.0, _STRONG, "text", False),
    "name": (10.0, _STRONG, "text", False),
    "quiet": (8.0, 400, "text_quiet", False),
    "hero": (21.0, _STRONG, "text", True),
    "large": (13.5, _STRONG, "text", True),
    "heading": (9.5, _STRONG, "text", False),
    "body": (7.8, 400, "text", False),
    "strong": (7.8, _STRONG, "text", False),
    "figure": (7.8, 400, "text", True),
    "before": (7.8, 400, "text_caption", True),
    "figure strong": (7.8, _STRONG, "text", True),
    "caption": (7.5, 400, "text_caption", False),
    "axis": (7.0, 400, "text_caption", True),
    "small": (7.5, 400, "text_quiet", False),
    "small strong": (7.5, _STRONG, "text", False),
    "warning": (7.8, _STRONG, "bad", False),
    "caution": (7.8, _STRONG, "warn", False),
}
"""Size [pt], weight, colour token of each kind of type, and whether its figures have one width."""

_FEWEST = 4  # letters on the last line of a text
_NARROWER = (0.96, 0.92, 0.88, 0.84)  # columns in which more of them go over to it

_ALIGNED = {"left": 0.0, "middle": 0.5, "right": 1.0}


@cache
def _font(kind: str) -> QFont:
    size, weight, _, figures = TYPES[kind]
    result = QFont(list(FIGURES if figures else FAMILIES))
    result.setPixelSize(round(size * _POINT * UNITS))
    result.setWeight(QFont.Weight(weight))
    result.setHintingPreference(QFont.HintingPreference.PreferNoHinting)
    # Letters that change with their neighbours cannot be found again in the text of a PDF.
    result.setFeature(QFont.Tag("calt"), 0)
    return result


@cache
def _metrics(kind: str) -> QFontMetricsF:
    return QFontMetricsF(_font(kind))


def text_width(text: str, kind: str) -> float:
    """Return how wide a line of text is [mm]."""
    return _metrics(kind).horizontalAdvance(text) / UNITS


def elide(text: str, kind: str, width: float) -> str:
    """Return a text that ends in dots where it would be wider [mm]."""
    plain = " ".join(text.split())
    return _metrics(kind).elidedText(plain, Qt.TextElideMode.ElideRight, width * UNITS)


def fitting_font(text: str, width: float) -> str:
    """Return the kind of type in which a name fits a cell, or is the least cut off [mm]."""
    return "body" if text_width(text, "body") <= width else "small"


def wrap(text: str, kind: str, width: float) -> list[str]:
    """Return the lines of a text in a column of a ``width`` [mm]; the last is never a letter or two."""
    lines = _broken(text, kind, width)
    for share in _NARROWER:
        if len(lines) < 2 or len(lines[-1]) >= _FEWEST:
            break
        narrower = _broken(text, kind, share * width)
        lines = narrower if len(narrower) == len(lines) else lines
    return lines


def _broken(text: str, kind: str, width: float) -> list[str]:
    lines = []
    for part in text.splitlines():
        layout = QTextLayout(part, _font(kind))
        option = QTextOption()
        option.setWrapMode(QTextOption.WrapMode.WrapAtWordBoundaryOrAnywhere)
        layout.setTextOption(option)
        layout.beginLayout()
        while (line := layout.createLine()).isValid():
            line.setLineWidth(width * UNITS)
            lines.append(part[line.textStart() : line.textStart() + line.textLength()].rstrip())
        layout.endLayout()
    return lines


def line_height(kind: str) -> float:
    """Return how far lines of a text are apart [mm]: room for letters of every language."""
    return 1.4 * TYPES[kind][0] * _POINT


class PagePainter:
    """Paints in millimetres from the top left of a page; ``painter`` has ``UNITS`` to each of them."""

    def __init__(self, painter: QPainter) -> None:
        self.painter = painter
        painter.setRenderHints(
            QPainter.RenderHint.Antialiasing
            | QPainter.RenderHint.TextAntialiasing
            | QPainter.RenderHint.SmoothPixmapTransform
        )

    def text(
        self, x: float, base: float, text: str, kind: str, *, align: str = "left", ink: str = ""
    ) -> None:
        """Write a line whose letters stand on ``base``; ``x`` is its left, middle or right end."""
        if not text:
            return
        self.painter.setFont(_font(kind))
        self.painter.setPen(QColor(ink or getattr(LIGHT, TYPES[kind][2])))
        left = x - _ALIGNED[align] * text_width(text, kind)
        self.painter.drawText(QPointF(left * UNITS, base * UNITS), text)

    def letters(
        self, x: float, base: float, text: str, size: float, ink: str = LIGHT.text, *, strong: bool = False
    ) -> None:
        """Write a line about ``x`` whose letters are of any ``size`` [mm]."""
        font = QFont(_font("strong" if strong else "body"))
        font.setPixelSize(round(size * UNITS))
        self.painter.setFont(font)
        self.painter.setPen(QColor(ink))
        left = x * UNITS - 0.5 * QFontMetricsF(font).horizontalAdvance(text)
        self.painter.drawText(QPointF(left, base * UNITS), text)

    def lines(self, x: float, top: float, lines: Iterable[str], kind: str, *, ink: str = "") -> float:
        """Write lines below each other and return where they end."""
        step = line_height(kind)
        for line in lines:
            self.text(x, top + 0.74 * step, line, kind, ink=ink)
            top += step
        return top

    def rule(self, x: float, y: float, width: float, *, ink: str = LIGHT.line, weight: float = 0.15) -> None:
        """Draw a level line [mm]."""
        self._pen(ink, weight)
        self.painter.drawLine(QPointF(x * UNITS, y * UNITS), QPointF((x + width) * UNITS, y * UNITS))

    def stroke(self, x: float, top: float, bottom: float, *, ink: str, weight: float = 0.15) -> None:
        """Draw an upright line [mm]."""
        self._pen(ink, weight)
        self.painter.drawLine(QPointF(x * UNITS, top * UNITS), QPointF(x * UNITS, bottom * UNITS))

    def box(self, x: float, y: float, width: float, height: float, ink: str, radius: float = 0.0) -> None:
        """Fill a box with round corners [mm]."""
        self._fill(ink)
        self.painter.drawRoundedRect(_rect(x, y, width, height), radius * UNITS, radius * UNITS)

    def disc(self, x: float, y: float, radius: float, ink: str, *, filled: bool = True) -> None:
        """Draw a disc or a ring about a place [mm]."""
        self._pen(ink, 0.3)
        self.painter.setBrush(QColor(ink) if filled else Qt.BrushStyle.NoBrush)
        self.painter.drawEllipse(QPointF(x * UNITS, y * UNITS), radius * UNITS, radius * UNITS)

    def shape(self, places: Iterable[tuple[float, float]], ink: str) -> None:
        """Fill a shape with straight sides [mm]."""
        self._fill(ink)
        self.painter.drawPolygon(QPolygonF([QPointF(x * UNITS, y * UNITS) for x, y in places]))

    def curve(
        self, places: Iterable[tuple[float, float]], ink: str, weight: float, *, dashed: bool = False
    ) -> None:
        """Draw a curve through places on the page [mm]."""
        path = QPainterPath()
        for number, (x, y) in enumerate(places):
            place = QPointF(x * UNITS, y * UNITS)
            if number:
                path.lineTo(place)
            else:
                path.moveTo(place)
        self._pen(ink, weight, dashed=dashed)
        self.painter.setBrush(Qt.BrushStyle.NoBrush)
        self.painter.drawPath(path)

    def area(self, places: Iterable[tuple[float, float]], ink: str) -> None:
        """Fill what a curve through places on the page encloses [mm], palely."""
        path = QPainterPath()
        path.addPolygon(QPolygonF([QPointF(x * UNITS, y * UNITS) for x, y in places]))
        path.setFillRule(Qt.FillRule.WindingFill)
        colour = QColor(ink)
        colour.setAlphaF(0.25)
        self.painter.fillPath(path, colour)

    def picture(self, x: float, y: float, width: float, height: float, picture: QImage) -> None:
        """Draw a picture as large as goes into a box, at its foot and in its middle [mm]."""
        size = QSizeF(picture.size()).scaled(
            QSizeF(width, height) * UNITS, Qt.AspectRatioMode.KeepAspectRatio
        )
        left = x * UNITS + (width * UNITS - size.width()) / 2
        top = (y + height) * UNITS - size.height()
        self.painter.drawImage(QRectF(QPointF(left, top), size), picture)

    def clip(self, x: float, y: float, width: float, height: float) -> None:
        """Draw nothing outside a box [mm] until ``unclip``."""
        self.painter.save()
        self.painter.setClipRect(_rect(x, y, width, height))

    def unclip(self) -> None:
        """Draw everywhere again."""
        self.painter.restore()

    def _pen(self, ink: str, weight: float, *, dashed: bool = False) -> None:
        pen = QPen(QColor(ink), weight * UNITS)
        pen.setCapStyle(Qt.PenCapStyle.FlatCap if dashed else Qt.PenCapStyle.RoundCap)
        pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
        if dashed:
            pen.setDashPattern([4.0, 3.0])
        self.painter.setPen(pen)

    def _fill(self, ink: str) -> None:
        self.painter.setPen(Qt.PenStyle.NoPen)
        self.painter.setBrush(QColor(ink))


def _rect(x: float, y: float, width: float, height: float) -> QRectF:
    return QRectF(x * UNITS, y * UNITS, width * UNITS, height * UNITS)


LIGHTS = {"green": LIGHT.ok, "amber": LIGHT.warn_mark, "red": LIGHT.bad}
"""The colours of the lights; each has a shape of its own."""


def paint_light(paper: PagePainter, x: float, y: float, light: str) -> None:
    """Paint a light about a place [mm]: a ring for green, a triangle for amber, a full square for red."""
    ink = LIGHTS[light]
    if light == "green":
        paper.disc(x, y, 0.95, ink, filled=False)
    elif light == "amber":
        paper.shape([(x - 1.25, y + 1.0), (x + 1.25, y + 1.0), (x, y - 1.2)], ink)
    else:
        paper.box(x - 1.05, y - 1.05, 2.1, 2.1, ink)


def paint_level(paper: PagePainter, x: float, y: float, level: str) -> None:
    """Paint a level of an overall verdict about a place [mm]: a tick, a triangle, a square, or a ring."""
    light = {CAUTION: "amber", BAD: "red"}.get(level)
    if level == GOOD:
        paper.curve([(x - 1.1, y), (x - 0.3, y + 0.8), (x + 1.2, y - 0.9)], LIGHT.ok, 0.45)
    elif light:
        paint_light(paper, x, y, light)
    else:
        paper.disc(x, y, 0.95, LIGHT.text_quiet, filled=False)


def paint_chip(paper: PagePainter, x: float, y: float, colour: str) -> None:
    """Paint the colour of a line about a height [mm], with an edge where it is pale."""
    paper.box(x, y - 1.1, 3.2, 2.2, LIGHT.control, 0.5)
    paper.box(x + 0.12, y - 0.98, 2.96, 1.96, colour, 0.4)
