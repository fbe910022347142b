"""Canvas of a plot: the wheel zooms, a drag moves, the pointer reads the curves."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from PySide6.QtCore import QEvent, QLineF, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import (
    QColor,
    QContextMenuEvent,
    QFontMetricsF,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QPixmap,
    QResizeEvent,
    QWheelEvent,
)
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.gui.plots.painting import ROLE_COLORS, Scale, paint_dot, paint_plot, plot_area
from app.gui.theme.stylesheet import font, tokens_of
from app.i18n.catalog import number, tr
from app.presenters.plots import Plotted

Turns = tuple[float, float]

_NOTCH = 1.25
_LEAST_TURNS = 6.0
_NEAR_EVENT = 5.0  # [px]
_ROW = 15.0


def keys_in_words() -> list[tuple[str, str]]:
    """Return what the keys do in the plots, ready to read."""
    return [
        ("← →", tr("Previous or next iteration (Shift: 10)")),
        ("+ -", tr("Zoom")),
        ("Home", tr("Show all iterations")),
        ("Esc", tr("Hide iteration values")),
    ]


class PlotCanvas(QWidget):
    """Paints what is plotted; ``pointed`` carries the turn under the pointer or None, ``zoomed`` the turns
    that are wanted in view, or None for all of them.

    With the keyboard: arrows point at a turn, plus and minus zoom, Home shows all, Esc reads no more.
    """

    pointed = Signal(object)
    zoomed = Signal(object)
    menu_requested = Signal(object)

    def __init__(self, digits: int = 2) -> None:
        super().__init__()
        self.plotted, self.smooth = Plotted(), True
        self._digits = digits
        self._values = (0.0, 1.0)
        self.unit = ""
        self.zoom: Turns | None = None
        self._turn: float | None = None
        self._drawn: QPixmap | None = None
        self._held: tuple[float, Turns] | None = None
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Ignored)

    def set_plotted(self, plotted: Plotted, values: Turns, smooth: bool) -> None:
        """Show something else, with room for these values."""
        self.plotted, self._values, self.smooth = plotted, values, smooth
        self._forget()

    def set_turns(self, turns: Turns | None) -> None:
        """Show these turns, or all of them."""
        self.zoom = turns
        self._forget()

    def turns(self) -> Turns:
        """Return the first and the last turn in view."""
        return self.zoom or self.plotted.turns()

    def scale(self, area: QRectF | None = None) -> Scale:
        """Return how turns and values lie on the widget, or on another ``area`` [px]."""
        return Scale(area or plot_area(QRectF(self.rect())), *self.turns(), *self._values)

    def point_at(self, turn: float | None) -> None:
        """Read the curves at the turn nearest to this one, or read no more."""
        turn = None if turn is None else self.plotted.nearest(turn)
        if turn != self._turn:
            self._turn = turn
            self.setAccessibleDescription("; ".join(f"{name} {value}" for name, value, _ in self.readout()))
            self.update()

    def readout(self) -> list[tuple[str, str, str]]:
        """Return what is read at the pointed turn: names, values and colour tokens, the turn first."""
        if self._turn is None:
            return []
        plotted = self.plotted
        rows = [(tr("iteration"), number(self._turn, 0), "")]
        for curve, value in plotted.at(self._turn):
            rows.append((curve.name, self._said(value), ROLE_COLORS[curve.role]))
        if plotted.exact is not None:
            token = "accent" if plotted.exact_is_main else "exact_curve"
            rows.append((tr("Exact"), self._said(plotted.exact), token))
        reach = _NEAR_EVENT / self.scale().turn_width
        rows += [(event.words, "", "") for event in plotted.events if abs(event.turn - self._turn) <= reach]
        return rows

    def _said(self, value: float) -> str:
        return f"{number(value, self._digits)} {self.unit}"

    def sizeHint(self) -> QSize:
        return QSize(300, 120)

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange:
            self._forget()

    def resizeEvent(self, event: QResizeEvent) -> None:
        self._forget()

    # -- touched

    def wheelEvent(self, event: QWheelEvent) -> None:
        notches = event.angleDelta().y() / 120.0
        if notches:
            self._zoom(_NOTCH**-notches, self.scale().turn_at(event.position().x()))
        event.accept()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton:
            self._held = (event.position().x(), self.turns())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._held is not None and event.buttons() & Qt.MouseButton.LeftButton:
            start, (first, last) = self._held
            shift = (start - event.position().x()) / self.scale().turn_width
            self._show_turns(first + shift, last + shift)
        self.pointed.emit(self.scale().turn_at(event.position().x()))

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        self._held = None

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        self.zoomed.emit(None)

    def leaveEvent(self, event: QEvent) -> None:
        self.pointed.emit(None)

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        self.menu_requested.emit(event.globalPos())

    def event(self, event: QEvent) -> bool:
        """Take Home, which elsewhere shows all of the body."""
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent):
            event.setAccepted(event.key() == Qt.Key.Key_Home)
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        key = event.key()
        at = self._turn if self._turn is not None else self.turns()[1]
        if key in (Qt.Key.Key_Left, Qt.Key.Key_Right):
            step = (1.0 if key == Qt.Key.Key_Right else -1.0) * (10.0 if _shifted(event) else 1.0)
            self.pointed.emit(at if self._turn is None else at + step)
        elif key in (Qt.Key.Key_Plus, Qt.Key.Key_Equal, Qt.Key.Key_Minus):
            self._zoom(_NOTCH if key == Qt.Key.Key_Minus else 1.0 / _NOTCH, at)
        elif key == Qt.Key.Key_Home:
            self.zoomed.emit(None)
        elif key == Qt.Key.Key_Escape and self._turn is not None:
            self.pointed.emit(None)
        else:
            super().keyPressEvent(event)

    def _zoom(self, factor: float, about: float) -> None:
        first, last = self.turns()
        about = min(max(about, first), last)
        self._show_turns(about + (first - about) * factor, about + (last - about) * factor)

    def _show_turns(self, first: float, last: float) -> None:
        """Ask for these turns, as far as there are any; for all of them if there are no others."""
        start, end = self.plotted.turns()
        wide = max(last - first, _LEAST_TURNS)
        if wide >= end - start:
            self.zoomed.emit(None)
            return
        first = min(max(first, start), end - wide)
        self.zoomed.emit((first, first + wide))

    # -- painted

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens, scale = tokens_of(self), self.scale()
        if self._drawn is None or self._drawn.devicePixelRatioF() != self.devicePixelRatioF():
            self._drawn = self._draw(scale)
        painter = QPainter(self)
        painter.drawPixmap(0, 0, self._drawn)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        if self._turn is not None and scale.first <= self._turn <= scale.last:
            self._paint_cursor(painter, scale)
        if self.hasFocus():
            painter.setPen(QPen(QColor(tokens.accent), 2))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawRoundedRect(QRectF(self.rect()).adjusted(1, 1, -1, -1), 5, 5)

    def _draw(self, scale: Scale) -> QPixmap:
        """Draw the plot once: under a moving pointer only what is read is painted anew."""
        ratio = self.devicePixelRatioF()
        result = QPixmap(self.size() * ratio)
        result.setDevicePixelRatio(ratio)
        result.fill(Qt.GlobalColor.transparent)
        painter = QPainter(result)
        paint_plot(painter, self.plotted, scale, tokens_of(self), self.smooth)
        painter.end()
        return result

    def _forget(self) -> None:
        self._drawn = None
        self.update()

    def _paint_cursor(self, painter: QPainter, scale: Scale) -> None:
        tokens, turn = tokens_of(self), self._turn or 0.0
        x = round(scale.x(turn))
        painter.setPen(QPen(QColor(tokens.control), 1))
        painter.drawLine(QLineF(x, scale.area.top(), x, scale.area.bottom()))
        for curve, value in reversed(self.plotted.at(turn)):
            paint_dot(painter, scale, turn, value, getattr(tokens, ROLE_COLORS[curve.role]), tokens, 3.0)
        rows = self.readout()
        type_ = font("axis", tabular=True)
        wide = QFontMetricsF(type_).horizontalAdvance
        names = max(wide(name) for name, value, _ in rows if value)
        values = max(wide(value) for _, value, _ in rows)
        width = max(names + values + 40, max(wide(name) for name, _, _ in rows) + 14)
        box = QRectF(x + 10, scale.area.top(), width, _ROW * len(rows) + 6)
        if x > self.width() / 2:
            box.moveRight(x - 10.0)
        box.moveLeft(min(max(box.left(), 0.0), max(self.width() - width, 0.0)))
        box.moveBottom(min(box.bottom(), float(self.height())))
        fill = QColor(tokens.raised)
        fill.setAlphaF(0.94)
        painter.setPen(QPen(QColor(tokens.outline), 1))
        painter.setBrush(fill)
        painter.drawRoundedRect(box.adjusted(0.5, 0.5, -0.5, -0.5), 5, 5)
        painter.setFont(type_)
        for place, row in enumerate(rows):
            room = QRectF(box.left() + 7, box.top() + 3 + place * _ROW, width - 14, _ROW)
            self._paint_row(painter, room, row)

    def _paint_row(self, painter: QPainter, room: QRectF, row: tuple[str, str, str]) -> None:
        tokens, (name, value, token) = tokens_of(self), row
        left, right = Qt.AlignmentFlag.AlignLeft, Qt.AlignmentFlag.AlignRight
        if token:
            painter.setPen(QPen(QColor(getattr(tokens, token)), 2))
            middle = room.center().y()
            painter.drawLine(QPointF(room.left(), middle), QPointF(room.left() + 9, middle))
        painter.setPen(QColor(tokens.text_quiet))
        behind = room.adjusted(14 if token else 0, 0, 0, 0)
        painter.drawText(behind, Qt.AlignmentFlag.AlignVCenter | left, name)
        painter.setPen(QColor(tokens.text))
        painter.drawText(room, Qt.AlignmentFlag.AlignVCenter | right, value)


def _shifted(event: QKeyEvent) -> bool:
    return bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
