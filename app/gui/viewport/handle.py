"""A knob in a 3D view that a hand takes hold of, drags and lets go."""

# ruff: noqa: D102, N802 - Qt names its events
from __future__ import annotations

import numpy as np
from PySide6.QtCore import QEvent, QObject, QPointF, Qt, Signal
from PySide6.QtGui import QEnterEvent, QHideEvent, QMouseEvent
from PySide6.QtWidgets import QWidget

from app.gui.viewport.viewport import Viewport
from app.gui.widgets.tooltip import set_tip
from core.geometry.mesh import Floats

FINE = 0.1
"""What is left of a drag while Shift is held [1]."""


class Handle(QWidget):
    """Stands where its place is seen and keeps the hand that holds it; what a step means says ``_pull``.

    ``taken`` and ``dropped`` when a hand closes and opens, or what it holds is hidden.
    """

    taken = Signal()
    dropped = Signal()

    def __init__(self, viewport: Viewport, size: int, name: str, tip: str) -> None:
        super().__init__(viewport.overlay.parentWidget())
        self._viewport = viewport
        self._last: QPointF | None = None
        self._hovered = False
        self.setFixedSize(size, size)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setAccessibleName(name)
        set_tip(self, tip)
        viewport.view_changed.connect(self._stand_anew)
        viewport.installEventFilter(self)
        self.hide()

    def _stand_anew(self) -> None:
        """Go to where the place is seen now."""
        raise NotImplementedError

    def _pull(self, over: Floats) -> None:
        """Tell of a step over the picture, (2,) [px]."""
        raise NotImplementedError

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Resize:
            self._stand_anew()
        return False

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() != Qt.MouseButton.LeftButton:
            event.ignore()
            return
        self._last = event.globalPosition()
        self._show_cursor()
        self.taken.emit()
        self.update()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._last is None:
            event.ignore()
            return
        step, self._last = event.globalPosition() - self._last, event.globalPosition()
        fine = FINE if event.modifiers() & Qt.KeyboardModifier.ShiftModifier else 1.0
        self._pull(fine * np.array([step.x(), step.y()]))

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if self._last is None or event.button() != Qt.MouseButton.LeftButton:
            event.ignore()
            return
        self.open_hand()
        self.dropped.emit()

    def open_hand(self) -> None:
        """Release the handle without a signal."""
        self._last = None
        self._show_cursor()
        self.update()

    def hideEvent(self, event: QHideEvent) -> None:
        if self._last is not None:  # the hand will open over something else
            self._last = None
            self._show_cursor()
            self.dropped.emit()

    def enterEvent(self, event: QEnterEvent) -> None:
        self._hovered = True
        self.update()

    def leaveEvent(self, event: QEvent) -> None:
        self._hovered = False
        self.update()

    def _show_cursor(self) -> None:
        held = self._last is not None
        self.setCursor(Qt.CursorShape.ClosedHandCursor if held else Qt.CursorShape.OpenHandCursor)
