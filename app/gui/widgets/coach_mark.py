"""One step of a tour: a card beside what it speaks of, and a ring round that."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QMargins, QPoint, QRect, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QKeyEvent, QPainter, QPaintEvent, QPen, QRegion
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from app.gui.theme.stylesheet import label, tokens_of
from app.gui.widgets.basic import OverlayCard, button, sentence
from app.i18n.catalog import tr

_WIDTH = 228  # as narrow as leaves the body in sight beside the steps
_AWAY = 8


class CoachMark(OverlayCard):
    """Title, sentence and the way on; Enter or the right arrow go on, the left one back, Esc skips the rest.

    The space bar is left to the window: it may be what the step speaks of.
    """

    advanced = Signal(int)
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
        """Show step ``place`` of ``count``, counted from 0."""
        self._count.setText(tr("{place} of {count}").format(place=place + 1, count=count))
        self._title.setText(title)
        self._words.setText(words)
        self._words.setMinimumHeight(0)  # else the height of the step before would be the least
        self._words.setFixedHeight(self._words.heightForWidth(_WIDTH) + 3)
        self.back.setVisible(place > 0)
        self.skip.setVisible(place < count - 1)
        self.next.setText(tr("Next") if place < count - 1 else tr("Done"))
        self.setAccessibleName(f"{title}. {words}")
        self.adjustSize()

    def point_at(self, target: QRect, room: QRect, clear: Sequence[QRect] = ()) -> None:
        """Place the ring round ``target``, a part of the parent, and the card next to it within ``room``.

        What must be seen besides is in ``clear``.
        """
        self.adjustSize()
        left, top, right, bottom = self.MARGINS
        shadow = QMargins(left, top, right, bottom)  # may lie over what must be seen
        card = self.size().shrunkBy(shadow)
        self.move(_beside(target, card, room.marginsRemoved(shadow), clear) - QPoint(left, top))
        self.ring.surround(target)
        for each in (self.ring, self):
            each.show()
            each.raise_()

    def leave(self) -> None:
        """Close the mark."""
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
        self.advanced.emit(1)

    def _back(self) -> None:
        if not self.back.isHidden():
            self.advanced.emit(-1)


class Ring(QWidget):
    """A line round a part of the window; the mouse goes through it."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self._window = parent
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.hide()

    def surround(self, target: QRect) -> None:
        """Surround ``target``; only the outline is redrawn, not its content."""
        self.setGeometry(target.adjusted(-3, -3, 3, 3).intersected(self._window.rect()))
        self.setMask(QRegion(self.rect()).subtracted(QRegion(self.rect().adjusted(5, 5, -5, -5))))

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(QColor(tokens_of(self).accent), 2))
        painter.drawRoundedRect(QRectF(self.rect()).adjusted(1.5, 1.5, -1.5, -1.5), 8, 8)


def _beside(target: QRect, card: QSize, room: QRect, clear: Sequence[QRect]) -> QPoint:
    """Return where a card lies within ``room``, next to ``target`` but neither over it nor over ``clear``.

    Where there is no such place, it covers as little of them as can be.
    """
    keep = (target, *clear)
    across = [room.left(), room.right(), target.center().x() - card.width() // 2]
    down = [room.top(), room.bottom(), target.center().y() - card.height() // 2]
    for each in keep:
        across += each.right() + _AWAY, each.left() - _AWAY - card.width()
        down += each.bottom() + _AWAY, each.top() - _AWAY - card.height()
    low = QPoint(room.right() + 1 - card.width(), room.bottom() + 1 - card.height())
    places = (
        QRect(QPoint(max(room.left(), min(x, low.x())), max(room.top(), min(y, low.y()))), card)
        for x in across
        for y in down
    )
    return min(places, key=lambda place: _unfit(place, target, keep)).topLeft()


def _unfit(place: QRect, target: QRect, keep: Sequence[QRect]) -> tuple[int, int, int]:
    """Return how much of ``keep`` a place covers [px²], then how far it is from ``target``, two ways [px]."""
    shared = [each.intersected(place) for each in keep]
    covered = sum(each.width() * each.height() for each in shared if not each.isEmpty())
    apart = (
        max(target.left() - place.right(), place.left() - target.right(), 0),
        max(target.top() - place.bottom(), place.top() - target.bottom(), 0),
    )
    return covered, sum(apart), (place.center() - target.center()).manhattanLength()
