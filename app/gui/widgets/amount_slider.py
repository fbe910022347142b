"""Quiet slider for an amount, with a mark at its neutral value."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen, QWheelEvent
from PySide6.QtWidgets import QAbstractSlider, QSizePolicy

from app.gui.theme.stylesheet import tokens_of
from app.gui.widgets.basic import speak_value
from app.presenters.model_options import Amount

_END, _RADIUS, _GROOVE = 11.0, 7.0, 5.0  # room at the ends, handle and height of the groove [px]
_PAGE = 5  # steps of a larger move

_KEYS = {
    Qt.Key.Key_Left: -1,
    Qt.Key.Key_Down: -1,
    Qt.Key.Key_Minus: -1,
    Qt.Key.Key_Right: 1,
    Qt.Key.Key_Up: 1,
    Qt.Key.Key_Plus: 1,
    Qt.Key.Key_PageDown: -_PAGE,
    Qt.Key.Key_PageUp: _PAGE,
}


def paint_handle(painter: QPainter, slider: QAbstractSlider, at: QPointF, radius: float) -> None:
    """Paint the handle of a ``slider``, with a halo while it has the focus or is held."""
    tokens = tokens_of(slider)
    painter.setPen(Qt.PenStyle.NoPen)
    if slider.hasFocus() or slider.isSliderDown():
        halo = QColor(tokens.accent)
        halo.setAlpha(76)
        painter.setBrush(halo)
        painter.drawEllipse(at, radius + 4, radius + 4)
    painter.setBrush(QColor(0, 0, 0, 40))
    painter.drawEllipse(at + QPointF(0, 0.8), radius + 0.5, radius + 0.5)
    painter.setBrush(QColor("#FFFFFF"))
    painter.setPen(QPen(QColor(tokens.control if slider.underMouse() else tokens.outline), 1))
    painter.drawEllipse(at, radius, radius)


class AmountSlider(QAbstractSlider):
    """A slider over the limits of an amount in steps of ``step``, with a mark at ``neutral``.

    ``previewed`` while the handle is dragged; ``committed`` once on release or at a key; ``cancelled`` when
    Esc ends a drag and the old value is back.
    """

    previewed = Signal(float)
    committed = Signal(float)
    cancelled = Signal()

    def __init__(self, amount: Amount, step: float, neutral: float) -> None:
        super().__init__()
        self._amount, self._step, self._neutral = amount, step, neutral
        self._before_drag, self._moved = 0, False
        self.setOrientation(Qt.Orientation.Horizontal)
        self.setRange(*(round(limit / step) for limit in amount.limits))
        self.setPageStep(_PAGE)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAttribute(Qt.WidgetAttribute.WA_Hover)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setAccessibleName(amount.title)
        self.valueChanged.connect(lambda _: speak_value(self, amount.words(self.amount())))

    def sizeHint(self) -> QSize:
        return QSize(150, 28)

    def minimumSizeHint(self) -> QSize:
        return QSize(80, 28)

    def amount(self) -> float:
        """Return the set amount."""
        return self.value() * self._step

    def show_amount(self, value: float) -> None:
        """Show an amount; nothing is emitted, and a handle in the user's hand stays where it is."""
        if not self.isSliderDown():
            self.setValue(round(value / self._step))

    def x_of(self, value: float) -> float:
        """Return where an amount is on the groove [px]."""
        low, high = self._amount.limits
        return _END + (value - low) / (high - low) * (self.width() - 2 * _END)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() != Qt.MouseButton.LeftButton:
            event.ignore()
            return
        self._before_drag, self._moved = self.value(), False
        self.setSliderDown(True)
        if abs(event.position().x() - self.x_of(self.amount())) > _RADIUS + 3:
            self._drag_to(event.position().x())
        self.update()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self.isSliderDown():
            self._drag_to(event.position().x())

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if self.isSliderDown() and event.button() == Qt.MouseButton.LeftButton:
            self.setSliderDown(False)
            self.update()
            if self._moved:
                self.committed.emit(self.amount())

    def keyPressEvent(self, event: QKeyEvent) -> None:
        key = Qt.Key(event.key())
        if key == Qt.Key.Key_Escape and self.isSliderDown():
            self.setSliderDown(False)
            self.setValue(self._before_drag)
            self.cancelled.emit()
        elif key in _KEYS:
            large = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
            self._commit(self.value() + _KEYS[key] * (_PAGE if large else 1))
        elif key == Qt.Key.Key_Backspace:
            self._commit(round(self._neutral / self._step))
        else:
            event.ignore()

    def wheelEvent(self, event: QWheelEvent) -> None:
        turned = event.angleDelta().y() or event.angleDelta().x()
        if self.hasFocus() and turned:
            self._commit(self.value() + (1 if turned > 0 else -1))
            event.accept()
        else:
            event.ignore()

    def paintEvent(self, event: QPaintEvent) -> None:
        painter, tokens, middle = QPainter(self), tokens_of(self), self.height() / 2.0
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(tokens.groove))
        top = middle - _GROOVE / 2.0
        painter.drawRoundedRect(QRectF(_END, top, self.width() - 2 * _END, _GROOVE), 2.5, 2.5)
        neutral, here = self.x_of(self._neutral), self.x_of(self.amount())
        painter.setBrush(QColor(tokens.control))
        painter.drawRect(QRectF(min(neutral, here), top, abs(here - neutral), _GROOVE))
        painter.drawRect(QRectF(neutral - 0.5, top - 3, 1, _GROOVE + 6))
        paint_handle(painter, self, QPointF(here, middle), _RADIUS)

    def _drag_to(self, x: float) -> None:
        low, high = self._amount.limits
        share = (x - _END) / max(self.width() - 2 * _END, 1.0)
        before = self.value()
        self.setValue(round((low + share * (high - low)) / self._step))
        if self.value() != before:
            self._moved = True
            self.previewed.emit(self.amount())

    def _commit(self, value: int) -> None:
        before = self.value()
        self.setValue(value)
        if self.value() != before:
            self.committed.emit(self.amount())
