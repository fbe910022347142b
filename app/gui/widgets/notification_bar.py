"""The card of notices: what happened, and what to do about it."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from html import escape

from PySide6.QtCore import QRectF, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QResizeEvent
from PySide6.QtWidgets import QHBoxLayout, QPushButton, QVBoxLayout

from app.gui.theme.stylesheet import faded, label, tokens_of
from app.gui.widgets.basic import FloatingPanel, IconLabel, ToolButton, button
from app.gui.widgets.dialog import text_viewer
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import add_word_joiners, tr
from app.presenters.messages import Text, render

Action = tuple[str, Callable[[], None]]
"""The word on a button and what it does."""

TONE_ICONS = {"ok": "check-circle", "info": "info", "warn": "warning", "bad": "warning-octagon"}
"""The tones of a notice with their drawings."""

REFUSED, FILES, FAULT, SCAN = "refused", "files", "fault", "scan"
"""Causes of notices: a refused edit or scan, a file not written, a fault of the solver, a bad scan."""

_LEAVES_AFTER_MS = 8000
_LEAST_WORDS = 400  # of the width for words, with icon and cross, where buttons stand beside them [px]
_MOST_LINES = 16  # of details that are seen at once; the others are scrolled to
_WIDEST, _NARROWEST = 680, 420  # of what is seen of the card on the view [px]
_MOST_HIGH = 0.6  # of the view, for card and details together
_NO_LIMIT = 16_777_215  # of a width, in the words of Qt
_BUTTON_KINDS = ("primary", "secondary", "quiet")


@dataclass(frozen=True)
class Notification:
    """One thing to say; ``lasting`` keeps it until it is closed, or until what it is ``about`` is over."""

    tone: str
    sentence: str
    hint: str
    actions: tuple[Action, ...]
    lasting: bool
    details: str = ""
    about: str = ""


class NotificationBar(FloatingPanel):
    """A card with one notice at a time, the others wait; it takes no room while there is none.

    What goes wrong now, or goes away by itself, is said at once: what stands there waits, if it lasts.
    """

    closed = Signal()

    def __init__(self) -> None:
        super().__init__()
        self._shown: Notification | None = None
        self._waiting: deque[Notification] = deque()
        self._lines, self._aside = _MOST_LINES, False
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.timeout.connect(self.close_notice)
        self._build()
        self.hide()

    def show_notice(
        self,
        tone: str,
        sentence: Text,
        hint: Text = "",
        actions: Sequence[Action] = (),
        lasting: bool = False,
        details: str = "",
        about: str = "",
    ) -> None:
        """Show ``sentence`` in the tone ok, info, warn or bad; the first action is the main one.

        ``details`` unfold when they are asked for; by what it is ``about`` it can be withdrawn.
        A sentence that already stands or waits there is not said twice.
        """
        text = render(sentence)
        notice = Notification(tone, text, render(hint), tuple(actions), lasting, details, about)
        if any(each.sentence == text for each in (self._shown, *self._waiting) if each):
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

    def notice(self) -> Notification | None:
        """Return the notice that stands there."""
        return self._shown

    def says(self, about: str) -> bool:
        """Return whether something about this stands or waits there."""
        return any(each is not None and each.about == about for each in (self._shown, *self._waiting))

    def close_notice(self) -> None:
        """Remove the notice and show the next."""
        self._shown = None
        self._next()
        self.closed.emit()

    def clear(self) -> None:
        """Remove all notices."""
        self._waiting.clear()
        self.close_notice()

    def withdraw(self, about: str) -> None:
        """Remove what was said about something: it is no longer so."""
        self._waiting = deque(each for each in self._waiting if each.about != about)
        if self._shown is not None and self._shown.about == about:
            self.close_notice()
        self._show_waiting()

    def keep_only(self, about: str, sentences: Collection[Text]) -> None:
        """Remove the notices about something whose sentence holds no longer."""
        texts = set(map(render, sentences))
        self._waiting = deque(e for e in self._waiting if e.about != about or e.sentence in texts)
        shown = self._shown
        if shown is not None and shown.about == about and shown.sentence not in texts:
            self.close_notice()
        self._show_waiting()

    def set_room(self, width: int | None, height: int) -> None:
        """Take at most this width and a part of this height of the view [px]; None: the width of a page."""
        left, top, right, bottom = self.MARGINS
        if width is None:
            self.setMinimumWidth(0)
            self.setMaximumWidth(_NO_LIMIT)
        else:
            self.setFixedWidth(max(min(width, _WIDEST), _NARROWEST) + left + right)
        rest = self._words.fontMetrics().lineSpacing() * 3 + top + bottom
        line = max(self.details.fontMetrics().lineSpacing(), 1)
        self._lines = max(3, min(_MOST_LINES, int(_MOST_HIGH * height - rest) // line))
        self._fit_details()

    def set_aside(self, aside: bool) -> None:
        """Hide the card while a hand carries something over the view, which it may cover; then show it."""
        self._aside = aside
        self.setVisible(self._shown is not None and not aside)

    def sizeHint(self) -> QSize:
        hint, layout = super().sizeHint(), self.layout()
        width = self.minimumWidth() if self.minimumWidth() == self.maximumWidth() else hint.width()
        return QSize(width, layout.totalHeightForWidth(width) if layout is not None else hint.height())

    def paintEvent(self, event: QPaintEvent) -> None:
        super().paintEvent(event)
        if self._shown is None:
            return
        tokens, painter = tokens_of(self), QPainter(self)
        left, top, right, bottom = self.MARGINS
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(faded(getattr(tokens, self._shown.tone), tokens.panel, 0.35))
        painter.setBrush(QColor(getattr(tokens, f"{self._shown.tone}_fill")))
        card = QRectF(self.rect()).adjusted(left + 0.5, top + 0.5, -right - 0.5, -bottom - 0.5)
        painter.drawRoundedRect(card, self.RADIUS, self.RADIUS)

    def _build(self) -> None:
        left, top, right, bottom = self.MARGINS
        self.row.setContentsMargins(left + 14, top + 6, right + 8, bottom + 6)
        column = QVBoxLayout()
        self.row.addLayout(column)
        column.setSpacing(4)
        row = QHBoxLayout()
        column.addLayout(row)
        row.setSpacing(8)
        self._icon = IconLabel("info", "info", 19)
        self._words, self.more = label("", "body"), button("", "quiet")
        set_tip(self.more, tr("Show next notice"))
        self.more.clicked.connect(self._turn_over)
        self._words.setTextFormat(Qt.TextFormat.RichText)
        self._words.setWordWrap(True)
        row.addWidget(self._icon)
        row.addSpacing(2)
        row.addWidget(self._words, 1)
        row.addWidget(self.more)
        self.buttons: list[QPushButton] = []
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
        self.details = text_viewer("", tr("Details"), code=True)
        self.details.document().documentLayout().documentSizeChanged.connect(self._fit_details)
        column.addWidget(self.details)

    def _next(self) -> None:
        self._timer.stop()
        if not self._waiting:
            self.hide()
            return
        notice = self._shown = self._waiting.popleft()
        self._icon.show_icon(TONE_ICONS[notice.tone], notice.tone)
        message, hint = (add_word_joiners(escape(each)) for each in (notice.sentence, notice.hint))
        self._words.setText(f'<span style="font-weight:600">{message}</span>&nbsp; {hint}')
        self._set_buttons(notice.actions)
        self.details.setPlainText(notice.details)
        self.unfold.setChecked(False)
        self.unfold.setVisible(bool(notice.details))
        self.details.hide()
        self._show_waiting()
        if not notice.lasting:
            self._timer.start(_LEAVES_AFTER_MS)
        self.set_aside(self._aside)
        self.update()

    def _fit_details(self) -> None:
        """Give the details room for all their lines, or for the first of them, and cut none in half."""
        document, high, lines = self.details.document(), 0.0, 0
        block = document.begin()
        while block.isValid() and lines + block.lineCount() <= self._lines:
            lines += block.lineCount()
            high += document.documentLayout().blockBoundingRect(block).height()
            block = block.next()
        frame = self.details.height() - self.details.contentsRect().height()
        margins = (
            1 if block.isValid() else 2
        ) * document.documentMargin()  # no half of a line below the last
        self.details.setFixedHeight(math.ceil(high + margins) + frame)

    def _show_details(self, shown: bool) -> None:
        self.details.setVisible(shown)
        # Whoever reads on is not to be hurried.
        self._timer.stop()

    def _set_buttons(self, actions: tuple[Action, ...]) -> None:
        for old in self.buttons:
            for row in (self._row, self._below):
                row.removeWidget(old)
            old.deleteLater()
        self.buttons = []
        for (text, act), kind in zip(actions, _BUTTON_KINDS, strict=False):
            each = button(text, kind)
            each.clicked.connect(lambda _=False, chosen=act: self._act(chosen))
            self.buttons.append(each)
        self._place_buttons()

    def _place_buttons(self) -> None:
        """Place the buttons beside the words, or under them where those would be squeezed into a column."""
        others = (each for each in (self.more, self.unfold) if not each.isHidden())
        taken = sum(each.sizeHint().width() + 8 for each in (*self.buttons, *others))
        wide = self.width() - taken < _LEAST_WORDS
        row, other = (self._below, self._row) if wide else (self._row, self._below)
        first = 0 if wide else self._row.count() - 2 - sum(self._row.indexOf(b) >= 0 for b in self.buttons)
        aside = self.row.contentsMargins(), self._below.contentsMargins()
        room = self.width() - sum(each.left() + each.right() for each in aside)
        for place, each in enumerate(self.buttons):
            other.removeWidget(each)
            row.removeWidget(each)
            row.insertWidget(first + place, each)
            room -= each.sizeHint().width() + 8
            each.setVisible(not wide or place == 0 or room >= 0)  # a word cut in half offers nothing

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._place_buttons()

    def _act(self, act: Callable[[], None]) -> None:
        self.close_notice()
        act()

    def _show_waiting(self) -> None:
        self.more.setText(tr("{count} more").format(count=len(self._waiting)))
        self.more.setVisible(bool(self._waiting))
        self._place_buttons()

    def _turn_over(self) -> None:
        """Show the next notice, and let the one that stands there wait behind all others."""
        if self._shown is not None:
            self._waiting.append(self._shown)
        self._next()
