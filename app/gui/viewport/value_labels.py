"""Values pinned on the body: small flags that Qt draws over the 3D view, and the clicks that pin them."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QEvent, QObject, QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QColor, QFontMetricsF, QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget

from app.gui.theme.stylesheet import font, tokens_of
from app.gui.viewport.viewport import Viewport
from core.geometry.mesh import Floats

_CLICK = 3.0  # pixels that the pointer may stray within a click
_REACH = 10.0  # how near to a flag's foot it is taken hold of [px]
_MAST = QPointF(14.0, -22.0)  # from the foot to the lower left of the flag [px]


@dataclass(frozen=True, eq=False)
class ValueFlag:
    """A value at a place of the shown body, shape (3,) [mm]."""

    place: Floats
    text: str


class ValueFlags(QWidget):
    """A transparent sheet over one viewport.

    ``pinned`` carries the place that was clicked on, (3,) [mm], and the line on it, if there is one;
    ``dragged`` the number of the flag that was clicked on.
    """

    pinned = Signal(object, str)
    dragged = Signal(int)

    def __init__(self, viewport: Viewport) -> None:
        super().__init__(viewport)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._viewport = viewport
        self._flags: tuple[ValueFlag, ...] = ()
        self._pressed: QPointF | None = None
        self.listening = False
        self._canvas = viewport.overlay.parentWidget() or viewport
        viewport.installEventFilter(self)
        self._canvas.installEventFilter(self)
        viewport.view_changed.connect(self.update)
        self.hide()

    @property
    def flags(self) -> tuple[ValueFlag, ...]:
        """Return the flags that are shown."""
        return self._flags

    def show_flags(self, flags: Iterable[ValueFlag]) -> None:
        """Show these flags in place of the former ones."""
        self._flags = tuple(flags)
        self.setGeometry(self._viewport.rect())
        self.setVisible(bool(self._flags))
        self.raise_()
        self.update()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if watched is self._viewport and event.type() == QEvent.Type.Resize:
            self.setGeometry(self._viewport.rect())
        if self.listening and watched is self._canvas and isinstance(event, QMouseEvent):
            if event.type() == QEvent.Type.MouseButtonPress:
                plain = event.button() == Qt.MouseButton.LeftButton and not event.modifiers().value
                self._pressed = event.position() if plain else None
            elif event.type() == QEvent.Type.MouseButtonRelease and self._pressed is not None:
                stray, self._pressed = (event.position() - self._pressed).manhattanLength(), None
                if stray <= _CLICK and not self._viewport.overlay.pin_at(event.position()):
                    self._click(event.position())
        return False

    def words(self) -> list[QRectF]:
        """Return where the values are written."""
        metrics = QFontMetricsF(font("title", tabular=True))
        return [_pill(spot, flag.text, metrics) for flag, spot in self._placed()]

    def _placed(self) -> list[tuple[ValueFlag, QPointF]]:
        return list(zip(self._flags, self._spots(), strict=True))

    def _click(self, at: QPointF) -> None:
        spots = self._spots()
        away = [float(np.hypot(spot.x() - at.x(), spot.y() - at.y())) for spot in spots]
        if away and min(away) < _REACH:
            self.dragged.emit(int(np.argmin(away)))
            return
        scene, width, height = self._viewport.scene, self._viewport.width(), self._viewport.height()
        start, sight = scene.view.ray(at.x(), at.y(), width, height)
        skin = scene.hit_body(start, start + 3.0 * scene.view.distance * sight)
        if skin is not None:
            self.pinned.emit(skin, scene.band_at(at.x(), at.y(), width, height))

    def _spots(self) -> list[QPointF]:
        if not self._flags:
            return []
        places = np.array([flag.place for flag in self._flags])
        view = self._viewport.scene.view
        return [QPointF(x, y) for x, y, *_ in view.to_picture(places, self.width(), self.height()).tolist()]

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        tokens = tokens_of(self)
        painter.setFont(font("title", tabular=True))
        metrics = QFontMetricsF(painter.font())
        for flag, spot in self._placed():
            hidden = self._viewport.scene.hidden(flag.place)
            top = spot + _MAST
            pen = QPen(QColor(tokens.ink), 1.4)
            if hidden:
                pen.setDashPattern([3.0, 2.5])
            painter.setPen(pen)
            painter.drawLine(spot, top)
            painter.setPen(QPen(QColor(tokens.on_ink), 1.5))
            painter.setBrush(Qt.BrushStyle.NoBrush if hidden else QColor(tokens.ink))
            painter.drawEllipse(spot, 4.0, 4.0)
            pill = _pill(spot, flag.text, metrics)
            painter.setPen(QPen(QColor(tokens.on_ink), 1.0))
            painter.setBrush(QColor(tokens.ink))
            painter.drawRoundedRect(pill, 5.0, 5.0)
            painter.drawText(pill, Qt.AlignmentFlag.AlignCenter, flag.text)


def _pill(spot: QPointF, text: str, metrics: QFontMetricsF) -> QRectF:
    """Return where the flag flies whose foot is on a spot."""
    top = spot + _MAST
    return QRectF(top.x() - 4.0, top.y() - 20.0, metrics.horizontalAdvance(text) + 14.0, 21.0)
