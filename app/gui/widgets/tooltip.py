"""Tooltips: plain text on a rounded card, whatever the text looks like, and never guessed to be HTML."""

# ruff: noqa: N802 - Qt names its events
from __future__ import annotations

from typing import Protocol, runtime_checkable

from PySide6.QtCore import QEvent, QObject, QPoint, QRect, QRectF, QSize, Qt, QTimer
from PySide6.QtGui import (
    QAction,
    QColor,
    QGuiApplication,
    QHelpEvent,
    QPainter,
    QPainterPath,
    QPaintEvent,
    QRegion,
)
from PySide6.QtWidgets import QWidget

from app.gui.theme.stylesheet import font, tokens_of

_WIDEST = 300  # of a line of text [px]
_MARGIN_X, _MARGIN_Y, _RADIUS = 10, 7, 7.0
_BELOW = QPoint(2, 20)  # from the pointer
_SHOWN_MS, _MS_PER_LETTER = 8000, 50
_WRAPPED = int(Qt.TextFlag.TextWordWrap | Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop)
_ENDS = (
    QEvent.Type.Leave,
    QEvent.Type.MouseButtonPress,
    QEvent.Type.KeyPress,
    QEvent.Type.Wheel,
    QEvent.Type.Hide,
    QEvent.Type.WindowDeactivate,
)


@runtime_checkable
class Tipped(Protocol):
    """A widget whose tooltip depends on the place within it."""

    def tip_at(self, place: QPoint) -> str:
        """Return the tooltip at a place of the widget, or an empty text for none."""
        ...


def set_tip(target: QWidget | QAction, tip: str) -> None:
    """Set a tooltip of plain text of a widget or action; an unchanged text makes no event."""
    if target.toolTip() != tip:
        target.setToolTip(tip)
    if isinstance(target, QWidget):
        watch_tip(target)


def watch_tip(widget: QWidget) -> None:
    """Show the tooltip of a widget as plain text from now on."""
    if widget.findChild(_Watch, options=Qt.FindChildOption.FindDirectChildrenOnly) is None:
        _Watch(widget)


def show_tip(at: QPoint, tip: str, widget: QWidget) -> None:
    """Show ``tip`` below a place of the screen until the pointer leaves ``widget``; an empty one hides it."""
    if tip:
        watch_tip(widget)
        (_card_of(widget) or _Card(widget.window())).show_at(at, tip)
    else:
        hide_tip(widget)


def hide_tip(widget: QWidget) -> None:
    """Hide the tooltip that is shown in the window of ``widget``."""
    card = _card_of(widget)
    if card is not None:
        card.hide()


def shown_tip(widget: QWidget) -> str:
    """Return the tooltip that is shown in the window of ``widget``, or an empty text."""
    card = _card_of(widget)
    return card.text if card is not None and card.isVisible() else ""


def round_corners(widget: QWidget, radius: float) -> None:
    """Cut the corners of a window off where no compositor may be there to make them transparent."""
    if QGuiApplication.platformName() == "xcb":
        outline = QPainterPath()
        outline.addRoundedRect(QRectF(widget.rect()), radius, radius)
        widget.setMask(QRegion(outline.toFillPolygon().toPolygon()))


def _card_of(widget: QWidget) -> _Card | None:
    return widget.window().findChild(_Card, options=Qt.FindChildOption.FindDirectChildrenOnly)


class _Watch(QObject):
    """Answers the request for a tooltip in the place of Qt, which would guess whether the text is HTML."""

    def __init__(self, widget: QWidget) -> None:
        super().__init__(widget)
        self._widget = widget
        widget.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() in _ENDS:
            hide_tip(self._widget)
        if not isinstance(event, QHelpEvent) or event.type() != QEvent.Type.ToolTip:
            return False
        widget = self._widget
        tip = widget.tip_at(event.pos()) if isinstance(widget, Tipped) else widget.toolTip()
        show_tip(event.globalPos(), tip, widget)
        return bool(tip)


class _Card(QWidget):
    """The tooltip of one window."""

    def __init__(self, window: QWidget) -> None:
        super().__init__(window, Qt.WindowType.ToolTip | Qt.WindowType.NoDropShadowWindowHint)
        self.text = ""
        self.setAttribute(Qt.WidgetAttribute.WA_TranslucentBackground)
        self.setAttribute(Qt.WidgetAttribute.WA_ShowWithoutActivating)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setFont(font("secondary"))
        self._ends = QTimer(self, singleShot=True)
        self._ends.timeout.connect(self.hide)

    def show_at(self, at: QPoint, text: str) -> None:
        """Show a text below a place of the screen, or above it where there is no room."""
        self.text = text
        words = self.fontMetrics().boundingRect(QRect(0, 0, _WIDEST, 2000), _WRAPPED, text)
        self.resize(words.size() + QSize(2 * _MARGIN_X + 2, 2 * _MARGIN_Y))
        round_corners(self, _RADIUS)
        self.move(self._place(at))
        self._ends.start(_SHOWN_MS + _MS_PER_LETTER * len(text))
        self.show()
        self.raise_()
        self.update()

    def _place(self, at: QPoint) -> QPoint:
        screen = QGuiApplication.screenAt(at) or self.screen()
        room, result = screen.availableGeometry(), at + _BELOW
        if result.y() + self.height() > room.bottom():
            result.setY(at.y() - self.height() - 6)
        result.setX(max(room.left(), min(result.x(), room.right() - self.width())))
        return result

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens, painter = tokens_of(self), QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(tokens.ink))
        painter.drawRoundedRect(QRectF(self.rect()), _RADIUS, _RADIUS)
        painter.setPen(QColor(tokens.on_ink))
        words = self.rect().adjusted(_MARGIN_X, _MARGIN_Y, -_MARGIN_X + 2, -_MARGIN_Y + 2)
        painter.drawText(words, _WRAPPED, self.text)
