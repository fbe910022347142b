"""Hands in tests: the button goes down, the pointer moves with keys held, the button goes up."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QMouseEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QWidget

LEFT, SHIFT, PLAIN = (
    Qt.MouseButton.LeftButton,
    Qt.KeyboardModifier.ShiftModifier,
    Qt.KeyboardModifier.NoModifier,
)


def press(widget: QWidget, at: QPoint, held: Qt.KeyboardModifier = PLAIN) -> None:
    QTest.mousePress(widget, LEFT, held, at)


def move(
    widget: QWidget, at: QPoint, held: Qt.KeyboardModifier = PLAIN, button: Qt.MouseButton = LEFT
) -> None:
    """Move the pointer with the button down; QTest's own moves forget the keys."""
    there, kind, none = QPointF(at), QEvent.Type.MouseMove, Qt.MouseButton.NoButton
    event = QMouseEvent(kind, there, QPointF(widget.mapToGlobal(there)), none, button, held)
    QApplication.sendEvent(widget, event)


def release(widget: QWidget, at: QPoint) -> None:
    QTest.mouseRelease(widget, LEFT, PLAIN, at)
