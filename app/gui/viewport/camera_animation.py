"""The way of a camera from one view to another, with time."""

from __future__ import annotations

from PySide6.QtCore import QEasingCurve, QObject, QVariantAnimation, Signal

from app.rendering.camera import View

GLIDE = 220
"""Duration of a move to another view [ms]."""


class CameraAnimation(QVariantAnimation):
    """Says by ``passed`` which views are seen on the way."""

    passed = Signal(View)

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self.setDuration(GLIDE)
        self.setEasingCurve(QEasingCurve.Type.OutCubic)
        self.setStartValue(0.0)
        self.setEndValue(1.0)
        self._ends = (View(), View())
        self.valueChanged.connect(lambda part: self.passed.emit(self._ends[0].towards(self._ends[1], part)))

    def go(self, start: View, end: View) -> None:
        """Start an animation."""
        self._ends = start, end
        self.start()

    @property
    def end(self) -> View:
        """Return the view that the last way leads to."""
        return self._ends[1]

    @property
    def running(self) -> bool:
        """Return whether the camera is on its way."""
        return self.state() == QVariantAnimation.State.Running
