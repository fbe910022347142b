"""One step of a tour: a card beside what it speaks of, and a ring round that."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from PySide6.QtCore import QPoint, QRect, QRectF, Qt, Signal
from PySide6.QtGui import QColor, QKeyEvent, QPainter, QPaintEvent, QPen, QRegion
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from app.dress.parts import OverCard, button, sentence
from app.dress.theme import label, tokens_of
from app.wording.words import tr

_WIDTH = 228  # as narrow as leaves the body in sight beside the steps
_AWAY = 8


class CoachMark(OverCard):
    """Title, sentence and the way on; Enter or the right arrow go on, the left one back, Esc skips the rest.

    The space bar is left to the window: it may be what the step speaks of.
    """

    went = Signal(int)
    skipped = Signal()

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self._window = parent
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        column = QVBoxLayout()
        column.setContentsMargins(10, 8, 10, 6)
        column.setSpacing(4)
        self._count = label("", "caption", tabular=True)
        self._title, self._words = label("", "heading"), sentence("", "secondary")
        for text in (self._count, self._title, self._words):
            column.addWidget(text)
        self._words.setFixedWidth(_WIDTH)
        buttons = QHBoxLayout()
        buttons.setSpacing(6)
        self.skip, self.back = button(tr("Skip"), "quiet"), button(tr("Back"), "secondary")
        self.next = button(tr("Next"), "primary")
        for each, act in ((self.skip, self.skipped.emit), (self.back, self._back), (self.next, self._on)):
            each.setFocusPolicy(Qt.FocusPolicy.TabFocus)
            each.clicked.connect(lambda _=False, act=act: act())
        buttons.addWidget(self.skip)
        buttons.addStretch(1)
        buttons.addWidget(self.back)
        buttons.addWidget(self.next)
        column.addSpacing(8)
        column.addLayout(buttons)
        self.row.addLayout(column)
        self.given_up.connect(self.skipped)
        self.ring = Ring(parent)
        self.hide()

    def show_step(self, place: int, count: int, title: str, words: str) -> None:
        """Say step ``place`` of ``count``, counted from 0."""
        self._count.setText(tr("{place} of {count}").format(place=place + 1, count=count))
        self._title.setText(title)
        self._words.setText(words)
        self._words.setFixedHeight(self._words.heightForWidth(_WIDTH) + 3)
        self.back.setVisible(place > 0)
        self.skip.setVisible(place < count - 1)
        self.next.setText(tr("Next") if place < count - 1 else tr("Done"))
        self.setAccessibleName(f"{title}. {words}")
        self.adjustSize()

    def point_at(self, target: QRect, room: QRect) -> None:
        """Stand beside ``target``, a part of the parent, within ``room``, and put the ring round it."""
        self.adjustSize()
        self.move(_beside(target, self.rect(), room))
        self.ring.surround(target)
        for each in (self.ring, self):
            each.show()
            each.raise_()

    def leave(self) -> None:
        """Go away."""
        self.ring.hide()
        self.hide()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        acts = {
            Qt.Key.Key_Return: self._on,
            Qt.Key.Key_Enter: self._on,
            Qt.Key.Key_Right: self._on,
            Qt.Key.Key_Left: self._back,
            Qt.Key.Key_Escape: self.skipped.emit,
        }
        if event.key() in acts:
            acts[Qt.Key(event.key())]()
        else:
            super().keyPressEvent(event)

    def _on(self) -> None:
        self.went.emit(1)

    def _back(self) -> None:
        if not self.back.isHidden():
            self.went.emit(-1)


class Ring(QWidget):
    """A line round a part of the window; the mouse goes through it."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self._window = parent
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.hide()

    def surround(self, target: QRect) -> None:
        """Lie round ``target``; only the line itself is drawn anew, not what is inside it."""
        self.setGeometry(target.adjusted(-3, -3, 3, 3).intersected(self._window.rect()))
        self.setMask(QRegion(self.rect()).subtracted(QRegion(self.rect().adjusted(5, 5, -5, -5))))

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(QColor(tokens_of(self).accent), 2))
        painter.drawRoundedRect(QRectF(self.rect()).adjusted(1.5, 1.5, -1.5, -1.5), 8, 8)


def _beside(target: QRect, card: QRect, room: QRect) -> QPoint:
    """Return where a card has room beside ``target``, or the most: below, right, left or above it.

    Below comes first: what stands at an edge has room there, and the body in the middle is seen. Beside a
    column, such as the rail of steps, right comes first: below, it would cover the other buttons.
    """
    across, down = target.center().x() - card.width() // 2, target.center().y() - card.height() // 2
    places = (
        (room.bottom() - target.bottom() - card.height(), QPoint(across, target.bottom() + _AWAY)),
        (room.right() - target.right() - card.width(), QPoint(target.right() + _AWAY, down)),
        (target.left() - room.left() - card.width(), QPoint(target.left() - card.width() - _AWAY, down)),
        (target.top() - room.top() - card.height(), QPoint(across, target.top() - card.height() - _AWAY)),
    )
    if target.height() > target.width():
        places = (*places[1:3], places[0], places[3])
    _, place = max(places, key=lambda each: min(each[0], _AWAY + 1))
    return QPoint(
        max(room.left(), min(place.x(), room.right() + 1 - card.width())),
        max(room.top(), min(place.y(), room.bottom() + 1 - card.height())),
    )
