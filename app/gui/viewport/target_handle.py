"""A handle on the body in a 3D view: it is dragged to where the skin is wished."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QEvent, QObject, QPointF, Qt, Signal
from PySide6.QtGui import QColor, QHideEvent, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QWidget

from app.gui.theme.stylesheet import tokens_of
from app.gui.viewport.handle import Handle
from app.gui.viewport.viewport import Viewport
from app.i18n.catalog import tr
from app.i18n.lengths import arrow_step, length
from app.rendering.camera import View
from core.geometry.mesh import Floats, Points

SIZE, SMALL = 48, 26
"""Width and height of a handle with its arrows, and of one without [px]."""

_FLATTEST = 0.35  # a way seen shorter than this part of a mm across points at the eye
_ASIDE, _AHEAD = 0.42, 0.91  # how far the skin of a side faces to that side, and to front or back [1]


class TargetHandle(Handle):
    """A knob where a place of the body on a ``side`` is wished, with a thread to where it is.

    ``side`` is "left", "right", or nothing in the middle. ``name`` is heard. A ``small`` one has neither
    arrows nor thread. ``ways`` tell whether it goes up, and out: to the front, or ``behind`` to the back.

    ``dragged`` carries each step up and out [mm]: of the two ways those that do not point at the eye. Arrow
    keys are such steps too, between ``taken`` and ``dropped``.
    """

    dragged = Signal(float, float)

    def __init__(
        self,
        viewport: Viewport,
        side: str,
        name: str,
        *,
        small: bool = False,
        behind: bool = False,
        ways: tuple[bool, bool] = (True, True),
    ) -> None:
        self._size = SMALL if small else SIZE
        tip = tr("Drag to the target position (Shift: fine, Esc: cancel). Arrow keys: {step}")
        super().__init__(viewport, self._size, name, tip.format(step=length(arrow_step(), 0)))
        self.side, self._small, self._behind = side, small, behind
        up_and_out = np.array([[0.0, 0.0, 1.0], [0.0, 1.0 if behind else -1.0, 0.0]])
        self._directions = up_and_out * np.array(ways)[:, None]
        self._place, self._foot = np.zeros(3), np.zeros(3)
        self._ways = np.zeros((2, 2))  # of one mm up and out over the picture, as columns [px]
        self._wanted = False
        self._thread = None if small else _Thread(self.parentWidget())
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)

    def show_at(self, place: Floats, foot: Floats) -> None:
        """Place the handle at ``place`` (3,) [mm], its object now at ``foot`` (3,) [mm]."""
        self._place, self._foot, self._wanted = place, foot, True
        self._stand_anew()

    def put_away(self) -> None:
        """Show it no longer."""
        self._wanted = False
        self._stand_anew()

    @property
    def can_be_dragged(self) -> bool:
        """Return whether any of its ways is seen: it may point at the eye."""
        return bool(self._ways.any())

    def _stand_anew(self) -> None:
        facing = faces(self._viewport.scene.view, self.side, self._behind)
        shown = self._wanted and self._viewport.shows_body and facing
        if self._thread is not None:
            self._thread.setVisible(shown)
        if not shown:
            if self.isVisible():
                self.hide()
            return
        view, room = self._viewport.scene.view, (self._viewport.width(), self._viewport.height())
        around = self._place + np.stack([np.zeros(3), *self._directions, view.axes[0]])
        spot, up, out, across = view.to_picture(around, *room)[:, :2]
        full = max(float(np.linalg.norm(across - spot)), 1e-6)
        ways = np.stack([up - spot, out - spot], axis=1)
        self._ways = np.where(np.linalg.norm(ways, axis=0) >= _FLATTEST * full, ways, 0.0)
        self.move(*(round(each) - self._size // 2 for each in spot))
        if self._thread is not None:
            foot = view.to_picture(self._foot[None], *room)[0, :2]
            self._thread.show_between(QPointF(*foot), QPointF(*spot))
        self._show_cursor()
        self.show()
        self.raise_()
        self.update()

    def _pull(self, over: Floats) -> None:
        up, out = np.linalg.lstsq(self._ways, over, rcond=1e-6)[0] if self._ways.any() else (0.0, 0.0)
        self.dragged.emit(float(up), float(out))

    # -- the hand

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton:
            self.setFocus(Qt.FocusReason.MouseFocusReason)
        super().mousePressEvent(event)

    def hideEvent(self, event: QHideEvent) -> None:
        if self._thread is not None:
            self._thread.hide()
        super().hideEvent(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        far = arrow_step(bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier))
        step = {
            Qt.Key.Key_Up: (far, 0.0),
            Qt.Key.Key_Down: (-far, 0.0),
            Qt.Key.Key_Right: (0.0, far * np.sign(self._ways[0, 1])),
            Qt.Key.Key_Left: (0.0, -far * np.sign(self._ways[0, 1])),
        }.get(Qt.Key(event.key()))
        if step is None or not any(step) or (step[0] and not self._ways[:, 0].any()):
            event.ignore()
            return
        self.taken.emit()
        self.dragged.emit(*step)
        self.dropped.emit()

    # -- painting

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens, painter = tokens_of(self), QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.translate(self._size / 2.0, self._size / 2.0)
        lively = self._hovered or self.hasFocus() or self._last is not None
        halo = QColor(tokens.accent)
        halo.setAlpha(90 if lively else 45)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(halo)
        painter.drawEllipse(QPointF(), *(2 * [12.0 if self._small else 14.0]))
        for way in self._ways.T:
            if way.any() and not self._small:
                self._arrows(painter, float(np.arctan2(way[1], way[0])), tokens.accent, tokens.raised)
        painter.setPen(QPen(QColor(tokens.accent), 2.4 if lively else 1.8))
        painter.setBrush(QColor(tokens.raised))
        painter.drawEllipse(QPointF(), *(2 * [6.0 if self._small else 7.5]))
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(tokens.accent))
        painter.drawEllipse(QPointF(), *(2 * [2.5 if self._small else 3.0]))

    def _arrows(self, painter: QPainter, angle: float, ink: str, rim: str) -> None:
        """Paint an arrow each way; a rim keeps them apart from any skin behind them."""
        for turned in (angle, angle + np.pi):
            painter.save()
            painter.rotate(float(np.degrees(turned)))
            for width, colour in ((4.2, rim), (2.0, ink)):
                pen = QPen(QColor(colour), width)
                pen.setCapStyle(Qt.PenCapStyle.RoundCap)
                pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
                painter.setPen(pen)
                painter.drawPolyline([QPointF(17.0, -4.0), QPointF(21.0, 0.0), QPointF(17.0, 4.0)])
            painter.restore()


def faces(view: View, side: str, behind: bool = False) -> bool:
    """Return whether the front of a side, or its back, is visible from a view; the middle is from both."""
    across = {"left": (_ASIDE,), "right": (-_ASIDE,)}.get(side, (_ASIDE, -_ASIDE))
    return any(view.axes[2] @ (x, _AHEAD if behind else -_AHEAD, 0.0) > 0.0 for x in across)


class _Thread(QWidget):
    """A dashed thread from where the bust point is to where it is wished, seen and never hit."""

    def __init__(self, canvas: QWidget | None) -> None:
        super().__init__(canvas)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._foot = self._spot = QPointF()
        self.hide()

    def show_between(self, foot: QPointF, spot: QPointF) -> None:
        """Lead from ``foot`` to ``spot``, both on the canvas."""
        self._foot, self._spot = foot, spot
        parent = self.parentWidget()
        if parent is not None:
            self.setGeometry(parent.rect())
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens, painter = tokens_of(self), QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        for width, colour in ((4.0, tokens.raised), (1.6, tokens.accent)):
            pen = QPen(QColor(colour), width)
            if width < 2.0:
                pen.setDashPattern([3.0, 2.5])
            painter.setPen(pen)
            painter.drawLine(self._foot, self._spot)
        painter.setPen(QPen(QColor(tokens.accent), 1.8))
        painter.setBrush(QColor(tokens.raised))
        painter.drawEllipse(self._foot, 4.0, 4.0)


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
