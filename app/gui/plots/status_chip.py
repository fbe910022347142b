"""Status chip: icon and word on a coloured pill, with one line of details."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QElapsedTimer, QPointF, QRectF, QSize, Qt, QTimer
from PySide6.QtGui import QColor, QHideEvent, QPainter, QPaintEvent, QPen, QShowEvent
from PySide6.QtWidgets import QAbstractButton, QLabel, QSizePolicy

from app.gui.theme.icons import paint_icon, pixmap
from app.gui.theme.stylesheet import font, tokens_of
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr
from app.presenters.status import TONES, TROUBLED, state_title

_SPINNING = ("settling", "pending")

SHORTEST_SHOW_MS = 250
"""A state stays at least so long, so that the chip does not flicker."""

_TURN_MS, _STEP_MS = 1200, 150
_CARET = 11
_GAP = "     "


class StatusChip(QAbstractButton):
    """The pill; 32 pixels high, or 22 when ``small``. It can be pressed in the states that are TROUBLED."""

    def __init__(self, small: bool = False) -> None:
        super().__init__()
        self._small = small
        self._state = self._next = "stale"
        self._words = self._next_words = state_title("stale")
        self.setAttribute(Qt.WidgetAttribute.WA_Hover)
        self._angle = 0.0
        self._since = QElapsedTimer()
        self._change, self._spin = QTimer(self), QTimer(self)
        self._change.setSingleShot(True)
        self._change.timeout.connect(self._take)
        self._spin.setInterval(_STEP_MS)
        self._spin.timeout.connect(self._turn)
        self.setFont(font("title" if small else "heading"))
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
        self._take()

    def state(self) -> str:
        """Return the state that is shown."""
        return self._state

    def spinning(self) -> bool:
        """Return whether the arc turns."""
        return self._spin.isActive()

    def set_state(self, state: str, words: str = "") -> None:
        """Show a state of ``TONES``, at the latest when the last one has been seen long enough.

        ``words`` are those of a level; a state of a run has its own.
        """
        if state not in TONES:
            raise ValueError(state)
        self._next, self._next_words = state, words or state_title(state)
        left = SHORTEST_SHOW_MS - self._since.elapsed() if self._since.isValid() else 0
        if state == self._state or left <= 0:
            self._take()
        else:
            self._change.start(left)

    def sizeHint(self) -> QSize:
        word = self.fontMetrics().horizontalAdvance(self._words)
        room = (36 if self._small else 50) + (_CARET + 5 if self._state in TROUBLED else 0)
        return QSize(word + room, 22 if self._small else 32)

    def showEvent(self, event: QShowEvent) -> None:
        self._run_spin()

    def hideEvent(self, event: QHideEvent) -> None:
        self._spin.stop()

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens = tokens_of(self)
        tone, drawing = TONES[self._state]
        ink = tokens.text_quiet if tone == "plain" else getattr(tokens, tone)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        lit = self._state in TROUBLED and (self.underMouse() or self.hasFocus())
        rim = QColor(tokens.accent if self.hasFocus() else ink)
        painter.setPen(QPen(rim, 2.0 if self.hasFocus() else 1.0) if lit else Qt.PenStyle.NoPen)
        painter.setBrush(QColor(tokens.pressed if tone == "plain" else getattr(tokens, f"{tone}_fill")))
        ground = QRectF(self.rect()).adjusted(1, 1, -1, -1) if lit else QRectF(self.rect())
        painter.drawRoundedRect(ground, ground.height() / 2, ground.height() / 2)
        size, left = (14.0, 8.0) if self._small else (19.0, 11.0)
        painter.save()
        painter.translate(left + size / 2, self.height() / 2)
        painter.rotate(self._angle if self._state in _SPINNING else 0.0)
        paint_icon(painter, drawing, ink, QRectF(-size / 2, -size / 2, size, size))
        painter.restore()
        painter.setPen(QColor(ink))
        painter.setFont(self.font())
        word = QRectF(left + size + 6, 0, self.width(), self.height())
        painter.drawText(word, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft, self._words)
        if self._state in TROUBLED:
            place = QPointF(self.width() - _CARET - 9.0, 0.5 * (self.height() - _CARET))
            painter.drawPixmap(place, pixmap("caret-right", ink, _CARET, self.devicePixelRatioF()))

    def _take(self) -> None:
        self._change.stop()
        if self._next == self._state and self._since.isValid():
            return
        if self._next != self._state or not self._since.isValid():
            self._since.restart()
        self._state, self._words = self._next, self._next_words
        self.setAccessibleName(self._words)
        self._let_press(self._state in TROUBLED)
        self._run_spin()
        self.setFixedSize(self.sizeHint())
        self.update()

    def _let_press(self, on: bool) -> None:
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents, not on)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus if on else Qt.FocusPolicy.NoFocus)
        self.setCursor(Qt.CursorShape.PointingHandCursor if on else Qt.CursorShape.ArrowCursor)
        set_tip(self, tr("Find conflicting lines and suggest a fix") if on else "")

    def _run_spin(self) -> None:
        if self._state in _SPINNING and self.isVisible():
            self._spin.start()
        else:
            self._spin.stop()

    def _turn(self) -> None:
        self._angle = (self._angle + 360.0 * _STEP_MS / _TURN_MS) % 360.0
        self.update()


class StatusLine(QLabel):
    """Words in parts on one line, the first ones first: what has no room is left out whole.

    Only the first one ends in dots, where it does not fit alone; the pointer is told all of it.
    """

    def __init__(self) -> None:
        super().__init__()
        self._parts: tuple[str, ...] = ()
        self.setTextFormat(Qt.TextFormat.PlainText)
        self.setFont(font("secondary", tabular=True))
        self.setProperty("role", "secondary")
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)

    def show_parts(self, parts: Sequence[str]) -> None:
        """Show these parts; empty ones are none."""
        self._parts = tuple(filter(None, parts))
        self.setText(_GAP.join(self._parts))
        set_tip(self, self.text() if self._parts else "")

    def seen(self) -> str:
        """Return what there is room for."""
        measure, parts = self.fontMetrics(), self._parts
        while len(parts) > 1 and measure.horizontalAdvance(_GAP.join(parts)) > self.width():
            parts = parts[:-1]
        return measure.elidedText(_GAP.join(parts), Qt.TextElideMode.ElideRight, self.width())

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setPen(self.palette().color(self.foregroundRole()))
        painter.drawText(self.rect(), Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter, self.seen())
