"""A landmark in the list: what it is called, how sure it is, and the rule it was found by."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import (
    QColor,
    QEnterEvent,
    QFocusEvent,
    QFontMetrics,
    QKeyEvent,
    QPainter,
    QPaintEvent,
    QPen,
)
from PySide6.QtWidgets import QAbstractButton, QSizePolicy

from app.gui.theme.stylesheet import font, tokens_of
from app.gui.widgets.basic import paint_card
from app.gui.widgets.tooltip import set_tip
from app.presenters.landmarks import LandmarkView
from core.landmarks.types import CERTAIN

_MARKS = {
    "certain": (((-2.6, 0.2), (-0.7, 2.1), (2.7, -1.9)),),
    "doubtful": (((0.0, -2.9), (0.0, 0.5)), ((0.0, 2.9), (0.0, 2.95))),
}
"""The strokes on a dot, which tell without its colour what that says [px about its middle]."""


class LandmarkRow(QAbstractButton):
    """A landmark: dot, name, bar and percent of confidence; ``hovered`` while the pointer is over it.

    ``reached`` when the keyboard comes to it. Arrows and Enter are left to the list.
    """

    hovered = Signal(bool)
    reached = Signal()

    def __init__(self, view: LandmarkView) -> None:
        super().__init__()
        self.view = view
        self.setCheckable(True)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.setAttribute(Qt.WidgetAttribute.WA_Hover)
        # A button would rather widen the list than be narrower than it likes: the figures would be cut off.
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.setMinimumHeight(34)

    def sizeHint(self) -> QSize:
        type_ = font("name")
        self.setFont(type_)
        return QSize(self.fontMetrics().horizontalAdvance(self.text()) + 150, 34)

    def show_view(self, view: LandmarkView) -> None:
        """Show new values of the same landmark."""
        self.view = view
        self.setText(view.title)
        set_tip(self, view.words())
        self.setAccessibleName(f"{view.title} {view.state}")
        self.update()

    def enterEvent(self, event: QEnterEvent) -> None:
        self.hovered.emit(True)

    def focusInEvent(self, event: QFocusEvent) -> None:
        super().focusInEvent(event)
        if event.reason() in (Qt.FocusReason.TabFocusReason, Qt.FocusReason.BacktabFocusReason):
            self.reached.emit()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Space:
            super().keyPressEvent(event)
        else:
            event.ignore()

    def leaveEvent(self, event: QEvent) -> None:
        self.hovered.emit(False)

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens = tokens_of(self)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        paint_card(painter, self, "selected", 7)
        tone, state = getattr(tokens, self.view.tone), self.view.state
        middle, right = self.height() / 2, self.width() - 10
        self._paint_mark(painter, QPointF(14, middle))
        painter.setFont(font("name" if self.isChecked() else "body"))
        painter.setPen(QColor(tokens.text_quiet if self.view.absent else tokens.text))
        left = Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft
        plain = self.view.by_hand or self.view.absent
        extent = QFontMetrics(font("secondary", tabular=True)).horizontalAdvance(state)
        room = self.width() - 28 - (extent + 18 if plain else 112)
        title = painter.fontMetrics().elidedText(self.text(), Qt.TextElideMode.ElideRight, room)
        painter.drawText(QRectF(28, 0, room, self.height()), left, title)
        painter.setFont(font("secondary", tabular=True))
        painter.setPen(QColor(tokens.text if self.isChecked() else tokens.text_quiet))
        past = Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight
        painter.drawText(QRectF(right - 180, 0, 180, self.height()), past, state)
        if plain:
            return
        painter.setPen(Qt.PenStyle.NoPen)
        bar = QRectF(right - 48 - 52, middle - 1.5, 52, 3)
        painter.setBrush(QColor(tokens.groove))
        painter.drawRoundedRect(bar, 1.5, 1.5)
        bar.setWidth(52 * min(max(self.view.confidence, 0.0), 1.0))
        painter.setBrush(QColor(tone))
        painter.drawRoundedRect(bar, 1.5, 1.5)
        # So far it has to reach: what is certain has passed the notch.
        painter.fillRect(
            QRectF(bar.left() + 52 * CERTAIN - 0.5, middle - 4, 1, 8), QColor(tokens.text_caption)
        )

    def _paint_mark(self, painter: QPainter, at: QPointF) -> None:
        """Paint the dot: ticked if certain, with a stroke and a point if doubtful, a ring if absent."""
        tokens, view = tokens_of(self), self.view
        painter.setPen(QPen(QColor(tokens.text_caption if view.absent else tokens.raised), 1.5))
        painter.setBrush(Qt.BrushStyle.NoBrush if view.absent else QColor(getattr(tokens, view.tone)))
        painter.drawEllipse(at, 6.0, 6.0)
        round_cap = Qt.PenCapStyle.RoundCap
        painter.setPen(
            QPen(QColor(tokens.raised), 1.5, Qt.PenStyle.SolidLine, round_cap, Qt.PenJoinStyle.RoundJoin)
        )
        for mark in _MARKS.get(view.sureness, ()):
            painter.drawPolyline([at + QPointF(*place) for place in mark])
