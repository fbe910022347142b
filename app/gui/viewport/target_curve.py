"""A profile that is wished, drawn over the body, with the answer's own outline beside it."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

import numpy as np
from PySide6.QtCore import QEvent, QObject, QPointF, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QWidget

from app.gui.theme.stylesheet import tokens_of
from app.gui.viewport.target_handle import faces
from app.gui.viewport.viewport import Viewport
from core.geometry.mesh import Points


class TargetCurve(QWidget):
    """Two curves over one view, seen and never hit: what is wished is dashed, what is reached is not."""

    def __init__(self, viewport: Viewport, side: str) -> None:
        self._canvas = viewport.overlay.parentWidget()
        super().__init__(self._canvas)
        self._viewport, self._side = viewport, side
        self._wished = self._reached = np.zeros((0, 3))
        self._wanted = False
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        viewport.view_changed.connect(self._stand)
        viewport.installEventFilter(self)
        self.hide()

    def show_curves(self, wished: Points, reached: Points) -> None:
        """Draw what is wished and what is reached, each (k, 3) [mm]."""
        self._wished, self._reached, self._wanted = wished, reached, True
        self._stand()

    def put_away(self) -> None:
        """Show them no longer."""
        self._wanted = False
        self._stand()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Resize:
            self._stand()
        return False

    def _stand(self) -> None:
        shown = self._wanted and self._viewport.shows_body and faces(self._viewport.scene.view, self._side)
        if shown and self._canvas is not None:
            self.setGeometry(self._canvas.rect())
        self.setVisible(shown)
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens, painter = tokens_of(self), QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        # A rim of the other brightness keeps the lines apart from any skin behind them.
        for places, dashed in ((self._reached, False), (self._wished, True)):
            line = self._line(places)
            for width, colour in ((4.6, tokens.raised), (2.0, tokens.accent)):
                pen = QPen(QColor(colour), width)
                pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
                if dashed and colour == tokens.accent:
                    pen.setDashPattern([3.0, 2.5])
                painter.setPen(pen)
                painter.drawPolyline(line)

    def _line(self, places: Points) -> QPolygonF:
        view, room = self._viewport.scene.view, (self._viewport.width(), self._viewport.height())
        spots = view.to_picture(places, *room)[:, :2] if len(places) else np.zeros((0, 2))
        return QPolygonF([QPointF(x, y) for x, y in spots.tolist()])
