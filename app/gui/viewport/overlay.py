"""Pins and labels that Qt draws over the 3D view: crisp at every scale, and in any language."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget

from app.gui.theme.stylesheet import font, tokens_of
from app.rendering.camera import View
from core.geometry.mesh import Floats, Points

PILL = 24.0
"""Height of a label [px]."""

SPACING = 28.0
"""Least distance between two labels of a column [px]."""

COLUMN_GAP = 50.0
"""Distance between the outermost pin and its column of labels [px]."""

MARGIN = 12.0
"""Least distance between a label and the rim of the view [px]."""

GRIP = 11.0
"""How near to a pin the pointer takes hold of it [px]."""


@dataclass(frozen=True, eq=False)
class Pin:
    """A landmark: its name, what is written beside it, position (3,) [mm], and how it stands.

    ``tone`` is the token of its dot, ``state`` a word or two behind its label.
    """

    name: str
    label: str
    position: Floats
    tone: str
    state: str


@dataclass(frozen=True, eq=False)
class BandLabel:
    """What is written beside the selected line: a bold text, a quiet detail and the line's colour.

    ``anchor``, shape (3,) [mm], is the place on the line; ``spine``, shape (k, 3) [mm], its whole length.
    """

    text: str
    detail: str
    colour: str
    anchor: Floats
    spine: Points


def spread(heights: Sequence[float], low: float, high: float) -> list[float]:
    """Return label centres near ``heights``, at least ``SPACING`` apart, between ``low`` and ``high`` [px].

    The order of the heights stays; where there is no room for all, the lowest ones pass ``high``.
    """
    order = np.argsort(heights, kind="stable")
    steps = SPACING * np.arange(len(order))
    level = np.asarray(heights, dtype=np.float64)[order] - steps
    # Between labels that push each other the best common level is their mean; lower ones may not pass it.
    groups: list[list[float]] = []
    for value in level:
        groups.append([value, 1.0])
        while len(groups) > 1 and groups[-2][0] >= groups[-1][0]:
            (a, m), (b, n) = groups[-2:]
            groups[-2:] = [[(a * m + b * n) / (m + n), m + n]]
    placed = np.concatenate([np.full(int(n), value) for value, n in groups]) if groups else level
    room = max(high - low - SPACING * (len(order) - 1), 0.0)
    result = np.empty(len(order))
    result[order] = np.clip(placed, low, low + room) + steps
    return [float(y) for y in result]


class Overlay(QWidget):
    """A transparent sheet over the 3D view; the pointer goes through it."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setAttribute(Qt.WidgetAttribute.WA_NoSystemBackground)
        self.setAttribute(Qt.WidgetAttribute.WA_TranslucentBackground)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._pins: tuple[Pin, ...] = ()
        self._selected = ""
        self._band: BandLabel | None = None
        self._view = View()
        self._hidden: frozenset[str] = frozenset()

    @property
    def pins(self) -> tuple[Pin, ...]:
        """Return the pins that are shown."""
        return self._pins

    def set_pins(self, pins: Iterable[Pin], selected: str = "") -> None:
        """Show these pins in place of the former ones, one of them selected."""
        self._pins, self._selected = tuple(pins), selected
        self.update()

    def set_band(self, band: BandLabel | None) -> None:
        """Show a label at a line, or none."""
        self._band = band
        self.update()

    def follow(self, view: View, hidden: Iterable[str]) -> None:
        """Set the camera to ``view``; ``hidden`` pins are behind the body and drawn hollow."""
        self._view, self._hidden = view, frozenset(hidden)
        self.update()

    def pin_at(self, place: QPointF) -> str:
        """Return the name of the pin under the pointer, or an empty string.

        Of pins behind the body only the selected one is taken: no other was meant.
        """
        pins = [pin for pin in self._pins if pin.name == self._selected or pin.name not in self._hidden]
        if not pins:
            return ""
        spots = self.spots([pin.position for pin in pins])
        away = np.hypot(spots[:, 0] - place.x(), spots[:, 1] - place.y())
        nearest = int(np.argmin(away))
        return pins[nearest].name if away[nearest] <= GRIP else ""

    def chosen_at(self, place: QPointF) -> str:
        """Return the name of the pin that is under the pointer, or whose label is, or an empty string."""
        labels = zip(self._pins, self.pills() if self._pins else (), strict=True)
        labelled = (pin.name for pin, pill in labels if pill.contains(place))
        return self.pin_at(place) or next(labelled, "")

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802
        """Draw leaders first, then pins, then labels, so that no line crosses a word."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        if self._band is not None:
            self._paint_band(painter, self._band)
        if self._pins:
            self._paint_pins(painter)
        painter.end()

    # -- where things are

    def spots(self, points: Sequence[Floats] | Points) -> Points:
        """Return where points, shape (n, 3) [mm], are in the picture: x, y [px] and depth."""
        return self._view.to_picture(np.asarray(points), self.width(), self.height())

    def pills(self) -> list[QRectF]:
        """Return the label of each pin: two columns left and right, sorted by height."""
        spots = self.spots([pin.position for pin in self._pins])
        middle = 0.5 * (spots[:, 0].min() + spots[:, 0].max())
        pills = [QRectF()] * len(self._pins)
        for left in (True, False):
            column = np.flatnonzero((spots[:, 0] < middle) == left)
            low, high = MARGIN + PILL / 2.0, self.height() - MARGIN - PILL / 2.0
            centres = spread([float(spots[i, 1]) for i in column], low, high)
            for i, y in zip(column, centres, strict=True):
                width = self._pin_width(self._pins[i])
                if left:
                    x = max(float(spots[:, 0].min()) - COLUMN_GAP - width, MARGIN)
                else:
                    x = min(float(spots[:, 0].max()) + COLUMN_GAP, self.width() - MARGIN - width)
                pills[i] = QRectF(x, y - PILL / 2.0, width, PILL)
        return pills

    def words(self) -> list[QRectF]:
        """Return where anything is written over the view."""
        band = [self._band_pill(self._band)[0]] if self._band is not None else []
        return [*band, *(self.pills() if self._pins else ())]

    def _pin_width(self, pin: Pin) -> float:
        return _width(pin.label, pin.state)

    # -- painting

    def _paint_pins(self, painter: QPainter) -> None:
        spots = self.spots([pin.position for pin in self._pins])
        pills = self.pills()
        for pin, spot, pill in zip(self._pins, spots, pills, strict=True):
            at = QPointF(spot[0], spot[1])
            end = QPointF(pill.left() if pill.left() > at.x() else pill.right(), pill.center().y())
            self._leader(painter, at, end, pin.name in self._hidden, pin.name == self._selected)
        for pin, spot in zip(self._pins, spots, strict=True):
            self._head(painter, QPointF(spot[0], spot[1]), pin)
        tokens = tokens_of(self)
        for pin, pill in zip(self._pins, pills, strict=True):
            dot = getattr(tokens, pin.tone)
            self._pill(painter, pill, pin.name == self._selected)
            self._words(painter, pill, dot, pin.label, pin.state)

    def _band_pill(self, band: BandLabel) -> tuple[QRectF, bool]:
        """Return where the label of a band is, and whether it is beside the body."""
        x, y, _ = self.spots([band.anchor])[0]
        reach = float(self.spots(band.spine)[:, 0].max())
        width = _width(band.text, band.detail)
        beside = max(reach + 18.0, x + 60.0)
        left = min(beside, self.width() - MARGIN - width)
        # Where there is no room beside the body, the label hangs under the line instead of lying on it.
        drop = 18.0 if left == beside else 64.0
        top = min(max(y + drop, MARGIN), self.height() - MARGIN - PILL)
        pill = QRectF(left, top, width, PILL)
        return pill, left == beside

    def _paint_band(self, painter: QPainter, band: BandLabel) -> None:
        x, y, _ = self.spots([band.anchor])[0]
        pill, beside = self._band_pill(band)
        at = QPointF(x, y)
        foot = QPointF(min(max(x, pill.left() + 12.0), pill.right() - 12.0), pill.top())
        end = QPointF(pill.left(), pill.center().y()) if beside else foot
        self._leader(painter, at, end, False, False)
        painter.setPen(QPen(QColor("#FFFFFF"), 2.0))
        painter.setBrush(QColor(band.colour))
        painter.drawEllipse(at, 5.0, 5.0)
        self._pill(painter, pill, False)
        self._words(painter, pill, band.colour, band.text, band.detail)

    def _leader(self, painter: QPainter, at: QPointF, end: QPointF, hidden: bool, selected: bool) -> None:
        tokens = tokens_of(self)
        away = end - at
        length = float(np.hypot(away.x(), away.y()))
        at = at + away * min(7.0 / max(length, 1.0), 1.0)  # from its rim: a hollow pin stays hollow
        under = QColor("#000000" if tokens.dark else "#FFFFFF")
        under.setAlpha(150)
        painter.setPen(QPen(under, 3.0))
        painter.drawLine(at, end)
        pen = QPen(QColor(tokens.accent if selected else tokens.text), 1.3)
        if hidden:
            pen.setDashPattern([3.0, 2.5])
        painter.setPen(pen)
        painter.drawLine(at, end)

    def _head(self, painter: QPainter, at: QPointF, pin: Pin) -> None:
        tokens = tokens_of(self)
        selected, hidden = pin.name == self._selected, pin.name in self._hidden
        colour = QColor(tokens.accent if selected else tokens.text)
        radius = 7.0 if selected else 5.0
        if selected:
            halo = QColor(tokens.accent)
            halo.setAlpha(60)
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(halo)
            painter.drawEllipse(at, 15.0, 15.0)
        ring = QColor("#16171A" if tokens.dark else "#FFFFFF")
        painter.setBrush(Qt.BrushStyle.NoBrush if hidden else colour)
        painter.setPen(QPen(ring, 4.5 if hidden else 2.0))
        painter.drawEllipse(at, radius, radius)
        if hidden:
            painter.setPen(QPen(colour, 2.0))
            painter.drawEllipse(at, radius, radius)

    def _pill(self, painter: QPainter, pill: QRectF, selected: bool) -> None:
        tokens = tokens_of(self)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(0, 0, 0, 2 * tokens.shadow_alpha))
        for grow in (1.0, 2.0, 3.0):
            painter.drawRoundedRect(
                pill.adjusted(-grow, 1.0 - grow, grow, 1.0 + grow), 6.0 + grow, 6.0 + grow
            )
        fill = QColor(tokens.raised)
        fill.setAlpha(242)
        painter.setBrush(fill)
        painter.setPen(QPen(QColor(tokens.accent if selected else tokens.line), 1.5 if selected else 1.0))
        painter.drawRoundedRect(pill, 6.0, 6.0)

    def _words(self, painter: QPainter, pill: QRectF, dot: str, text: str, detail: str) -> None:
        tokens = tokens_of(self)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(dot))
        painter.drawEllipse(QPointF(pill.left() + 12.0, pill.center().y()), 3.5, 3.5)
        across = Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft
        painter.setFont(font("title"))
        painter.setPen(QColor(tokens.text))
        painter.drawText(pill.adjusted(22.0, 0.0, 0.0, 0.0), across, text)
        painter.setFont(font("secondary"))
        painter.setPen(QColor(tokens.text_quiet))
        start = 22.0 + QFontMetricsF(font("title")).horizontalAdvance(text) + 8.0
        painter.drawText(pill.adjusted(start, 0.0, 0.0, 0.0), across, detail)


def _width(text: str, detail: str) -> float:
    """Return the width of a label with a dot, a bold text and a quiet detail [px]."""
    bold = QFontMetricsF(font("title")).horizontalAdvance(text)
    quiet = QFontMetricsF(font("secondary")).horizontalAdvance(detail)
    return 22.0 + bold + (8.0 + quiet if detail else 0.0) + 10.0
