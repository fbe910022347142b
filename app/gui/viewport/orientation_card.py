"""The question which way a body faces: four pictures of it, one of which is right."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QImage, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QAbstractButton, QHBoxLayout, QVBoxLayout, QWidget

from app.gui.theme.stylesheet import font, label, tokens_of
from app.gui.widgets.basic import FloatingPanel, ToolButton, sentence
from app.i18n.catalog import tr

PICTURE = (132, 168)
"""Width and height of a picture [px]."""

PICTURES = 4
"""Pictures that are offered."""


@dataclass(frozen=True, eq=False)
class OrientationChoice:
    """What can be answered: ``up`` and ``front`` as the scan is told, a ``picture`` of it and its words."""

    up: str
    front: str
    picture: QImage
    words: str


class OrientationCard(FloatingPanel):
    """Asks once, calmly; ``answered`` with (up, front), ``closed`` when it is closed without an answer."""

    answered = Signal(str, str)
    closed = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.pictures: list[OrientationButton] = []
        column = QVBoxLayout()
        column.setSpacing(4)
        head = QHBoxLayout()
        head.addWidget(label(tr("Which image shows the front?"), "heading"), 1)
        close = ToolButton("x", tr("Keep current"), size=14, room=26)
        close.clicked.connect(self._leave)
        head.addWidget(close)
        self._pictures = QHBoxLayout()
        self._pictures.setSpacing(8)
        column.addLayout(head)
        column.addWidget(sentence(tr("Click the image in which the body is upright and faces you.")))
        column.addSpacing(8)
        column.addLayout(self._pictures)
        self.row.setContentsMargins(28, 20, 24, 28)
        self.row.addLayout(column)
        self.hide()

    def ask(self, answers: Sequence[OrientationChoice]) -> None:
        """Show these pictures, the likeliest first."""
        for old in self.pictures:
            self._pictures.removeWidget(old)
            old.deleteLater()
        self.pictures = [OrientationButton(answer) for answer in answers[:PICTURES]]
        for each in self.pictures:
            self._pictures.addWidget(each)
            each.clicked.connect(lambda _=False, given=each.answer: self._answer(given))
        self.setVisible(bool(self.pictures))
        self.adjustSize()

    def _answer(self, answer: OrientationChoice) -> None:
        self.hide()
        self.answered.emit(answer.up, answer.front)

    def _leave(self) -> None:
        self.hide()
        self.closed.emit()


class OrientationButton(QAbstractButton):
    """A picture of the body as it would stand, with how the file lies then."""

    def __init__(self, answer: OrientationChoice) -> None:
        super().__init__()
        self.answer = answer
        self.setText(answer.words)
        self.setAccessibleName(answer.words)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAttribute(Qt.WidgetAttribute.WA_Hover)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setFixedSize(self.sizeHint())

    def sizeHint(self) -> QSize:
        return QSize(PICTURE[0] + 8, PICTURE[1] + 34)

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens = tokens_of(self)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
        chosen = self.underMouse() or self.hasFocus()
        painter.setPen(QPen(QColor(tokens.accent if chosen else tokens.line), 2 if chosen else 1))
        painter.setBrush(QColor(tokens.selected if chosen else tokens.raised))
        painter.drawRoundedRect(QRectF(self.rect()).adjusted(1, 1, -1, -1), 8, 8)
        painter.drawImage(QRectF(QPointF(4, 4), QSize(*PICTURE)), self.answer.picture)
        painter.setFont(font("title"))
        painter.setPen(QColor(tokens.text))
        foot = QRectF(4, PICTURE[1] + 6, PICTURE[0], 22)
        painter.drawText(foot, Qt.AlignmentFlag.AlignCenter, self.text())
