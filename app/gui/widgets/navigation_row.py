"""A door: a row at the foot of a panel that leads somewhere else, with a line of what is there; and back."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from PySide6.QtCore import QEvent, QRectF, QSize, Qt, SignalInstance
from PySide6.QtGui import QColor, QEnterEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QAbstractButton, QHBoxLayout, QPushButton

from app.gui.theme.icons import icon, paint_icon
from app.gui.theme.stylesheet import font, label, tokens_of
from app.gui.widgets.basic import ToolButton
from app.gui.widgets.tooltip import set_tip

DOOR_HEIGHT = 52
"""Height of a door at the foot of the inspector [px]."""

_LEFT = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter


class NavigationRow(QAbstractButton):
    """A title over a quiet line of words."""

    def __init__(self, title: str, words: str = "") -> None:
        super().__init__()
        self._said = ""
        self.setFixedHeight(DOOR_HEIGHT)
        self.setText(title)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.show_words(words)

    def show_words(self, words: str) -> None:
        """Set the description."""
        self._said = words
        self.setAccessibleDescription(self._said)
        set_tip(self, self._said)
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens = tokens_of(self)
        painter = QPainter(self)
        painter.fillRect(0, 0, self.width(), 1, QColor(tokens.line))
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        if self.underMouse() or self.hasFocus():
            painter.setPen(QPen(QColor(tokens.accent), 2) if self.hasFocus() else Qt.PenStyle.NoPen)
            painter.setBrush(QColor(tokens.hover))
            painter.drawRoundedRect(QRectF(self.rect()).adjusted(6, 6, -6, -5), 8, 8)
        room = QRectF(18, 8, self.width() - 56, 20)
        painter.setFont(font("secondary"))
        painter.setPen(QColor(tokens.text))
        painter.drawText(room, _LEFT, self.text())
        painter.setFont(font("caption"))
        painter.setPen(QColor(tokens.text_caption))
        sentence = painter.fontMetrics().elidedText(
            self._said, Qt.TextElideMode.ElideRight, int(room.width())
        )
        painter.drawText(room.translated(0, 18), _LEFT, sentence)
        paint_icon(
            painter,
            "caret-right",
            tokens.text_quiet,
            QRectF(self.width() - 32, self.height() / 2 - 7, 14, 14),
        )

    def enterEvent(self, event: QEnterEvent) -> None:
        self.update()

    def leaveEvent(self, event: QEvent) -> None:
        self.update()


def page_head(title: str, back: str, left: SignalInstance) -> QHBoxLayout:
    """Return the head of what is behind a door: the arrow ``back``, which emits ``left``, and a title."""
    head = QHBoxLayout()
    head.setContentsMargins(10, 9, 10, 6)
    head.setSpacing(4)
    arrow = ToolButton("caret-left", back, size=16, room=30)
    arrow.clicked.connect(left)
    head.addWidget(arrow)
    head.addWidget(label(title, "heading"))
    head.addStretch(1)
    return head


class BackButton(QPushButton):
    """An arrow and words that lead back from a page that fills the window."""

    def __init__(self, text: str) -> None:
        super().__init__(text)
        self.setFont(font("button"))
        self.setProperty("kind", "word")
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.setIconSize(QSize(14, 14))
        self._draw_arrow()

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange:
            self._draw_arrow()

    def _draw_arrow(self) -> None:
        self.setIcon(icon("caret-left", tokens_of(self).text_quiet, 14))
