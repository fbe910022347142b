"""The bar above the view that says what happened and what to do."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from html import escape

from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QResizeEvent
from PySide6.QtWidgets import QHBoxLayout, QPushButton, QVBoxLayout, QWidget

from app.dress.parts import IconLabel, ToolButton, button
from app.dress.sheet import reading
from app.dress.theme import label, tokens_of
from app.dress.tip import set_tip
from app.wording.words import held_together, say, tr

Action = tuple[str, Callable[[], None]]
"""The word on a button and what it does."""

TONE_ICONS = {"ok": "check-circle", "info": "info", "warn": "warning", "bad": "warning-octagon"}
"""The tones of a notice with their drawings."""

REFUSED, FILES, FAULT = "refused", "files", "fault"
"""What notices of failures are about: an edit or a scan that was refused, a file that was not written, a
fault of the solver.
"""

_LEAVES_AFTER_MS = 8000
_MOST_ROOM = 0.4  # of the width that buttons take beside the words
_MOST_LINES = 10  # of details that are seen at once: below them lies the body
_BUTTON_KINDS = ("primary", "secondary", "quiet")


@dataclass(frozen=True)
class Notice:
    """One thing to say; ``lasting`` keeps it until it is closed, or until what it is ``about`` is over."""

    tone: str
    sentence: str
    hint: str
    actions: tuple[Action, ...]
    lasting: bool
    details: str = ""
    about: str = ""


class NoticeBar(QWidget):
    """One notice at a time, the others wait; it takes no room while there is none.

    What goes wrong now, or goes away by itself, is said at once: what stands there waits, if it lasts.
    """

    closed = Signal()

    def __init__(self) -> None:
        super().__init__()
        self._shown: Notice | None = None
        self._waiting: deque[Notice] = deque()
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.timeout.connect(self.close_notice)
        self._build()
        self.hide()

    def show_notice(
        self,
        tone: str,
        sentence: str,
        hint: str = "",
        actions: Sequence[Action] = (),
        lasting: bool = False,
        details: str = "",
        about: str = "",
    ) -> None:
        """Say ``sentence`` in the tone ok, info, warn or bad; the first action is the main one.

        ``details`` unfold when they are asked for; by what it is ``about`` it can be withdrawn.
        A sentence that already stands or waits there is not said twice.
        """
        notice = Notice(tone, sentence, hint, tuple(actions), lasting, details, about)
        if any(each.sentence == sentence for each in (self._shown, *self._waiting) if each):
            return
        if self._shown is None or (lasting and tone != "bad"):
            self._waiting.append(notice)
        else:
            self._waiting.extendleft([self._shown] if self._shown.lasting else [])
            self._waiting.appendleft(notice)
            self._shown = None
        if self._shown is None:
            self._next()
        else:
            self._show_waiting()

    def notice(self) -> Notice | None:
        """Return the notice that stands there."""
        return self._shown

    def says(self, about: str) -> bool:
        """Return whether something about this stands or waits there."""
        return any(each is not None and each.about == about for each in (self._shown, *self._waiting))

    def close_notice(self) -> None:
        """Take the notice away and show the next."""
        self._shown = None
        self._next()
        self.closed.emit()

    def clear(self) -> None:
        """Take all notices away."""
        self._waiting.clear()
        self.close_notice()

    def withdraw(self, about: str) -> None:
        """Take away what was said about something: it is no longer so."""
        self._waiting = deque(each for each in self._waiting if each.about != about)
        if self._shown is not None and self._shown.about == about:
            self.close_notice()
        self._show_waiting()

    def paintEvent(self, event: QPaintEvent) -> None:
        if self._shown is None:
            return
        tokens = tokens_of(self)
        painter = QPainter(self)
        painter.fillRect(self.rect(), QColor(getattr(tokens, f"{self._shown.tone}_fill")))
        painter.fillRect(0, self.height() - 1, self.width(), 1, QColor(tokens.line))

    def _build(self) -> None:
        self.setMinimumHeight(44)
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 5, 10, 6)
        column.setSpacing(4)
        row = QHBoxLayout()
        column.addLayout(row)
        row.setSpacing(8)
        self._icon = IconLabel("info", "info", 19)
        self._words, self.more = label("", "body"), button("", "quiet")
        set_tip(self.more, tr("Show the next of them; this one waits"))
        self.more.clicked.connect(self._turn_over)
        self._words.setTextFormat(Qt.TextFormat.RichText)
        self._words.setWordWrap(True)
        row.addWidget(self._icon)
        row.addSpacing(2)
        row.addWidget(self._words, 1)
        row.addWidget(self.more)
        self._buttons: list[QPushButton] = []
        self._row, self._below = row, QHBoxLayout()
        self._below.setContentsMargins(29, 0, 0, 0)  # under the words
        self._below.addStretch(1)
        column.addLayout(self._below)
        self.unfold = button(tr("Details"), "quiet")
        self.unfold.setCheckable(True)
        self.unfold.toggled.connect(self._show_details)
        row.addWidget(self.unfold)
        close = ToolButton("x", tr("Close"), size=14, room=28)
        close.clicked.connect(self.close_notice)
        row.addWidget(close)
        self.details = reading("", tr("Details"), code=True)
        self.details.document().documentLayout().documentSizeChanged.connect(self._fit_details)
        column.addWidget(self.details)

    def _next(self) -> None:
        self._timer.stop()
        if not self._waiting:
            self.hide()
            return
        notice = self._shown = self._waiting.popleft()
        self._icon.show_icon(TONE_ICONS[notice.tone], notice.tone)
        said, hint = (held_together(escape(say(each))) for each in (notice.sentence, notice.hint))
        self._words.setText(f'<span style="font-weight:600">{said}</span>&nbsp; {hint}')
        self._set_buttons(notice.actions)
        self.details.setPlainText(notice.details)
        self.unfold.setChecked(False)
        self.unfold.setVisible(bool(notice.details))
        self.details.hide()
        self._show_waiting()
        if not notice.lasting:
            self._timer.start(_LEAVES_AFTER_MS)
        self.show()
        self.update()

    def _fit_details(self) -> None:
        """Give the details room for all their lines, or for the first of them, and cut none in half."""
        document, high, lines = self.details.document(), 0.0, 0
        block = document.begin()
        while block.isValid() and lines + block.lineCount() <= _MOST_LINES:
            lines += block.lineCount()
            high += document.documentLayout().blockBoundingRect(block).height()
            block = block.next()
        frame = self.details.height() - self.details.contentsRect().height()
        self.details.setFixedHeight(math.ceil(high + 2 * document.documentMargin()) + frame)

    def _show_details(self, shown: bool) -> None:
        self.details.setVisible(shown)
        # Whoever reads on is not to be hurried.
        self._timer.stop()

    def _set_buttons(self, actions: tuple[Action, ...]) -> None:
        for old in self._buttons:
            for row in (self._row, self._below):
                row.removeWidget(old)
            old.deleteLater()
        self._buttons = []
        for (text, act), kind in zip(actions, _BUTTON_KINDS, strict=False):
            each = button(text, kind)
            each.clicked.connect(lambda _=False, chosen=act: self._act(chosen))
            self._buttons.append(each)
        self._place_buttons()

    def _place_buttons(self) -> None:
        """Put the buttons beside the words, or under them where those would be squeezed into a column."""
        wide = sum(each.sizeHint().width() for each in self._buttons) > _MOST_ROOM * self.width()
        row, other = (self._below, self._row) if wide else (self._row, self._below)
        first = 0 if wide else self._row.count() - 2 - sum(self._row.indexOf(b) >= 0 for b in self._buttons)
        for place, each in enumerate(self._buttons):
            other.removeWidget(each)
            row.removeWidget(each)
            row.insertWidget(first + place, each)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._place_buttons()

    def _act(self, act: Callable[[], None]) -> None:
        self.close_notice()
        act()

    def _show_waiting(self) -> None:
        self.more.setText(tr("{count} more").format(count=len(self._waiting)))
        self.more.setVisible(bool(self._waiting))

    def _turn_over(self) -> None:
        """Show the next notice, and let the one that stands there wait behind all others."""
        if self._shown is not None:
            self._waiting.append(self._shown)
        self._next()
