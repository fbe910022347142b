"""Progress card over the view: current task, progress and cancel button."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QPointF, QRectF, Qt, QTimer, Signal
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QVBoxLayout, QWidget

from app.gui.status_bar import ProgressBar
from app.gui.theme.icons import paint_icon
from app.gui.theme.stylesheet import font, label, tokens_of
from app.gui.widgets.basic import FloatingPanel, button
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr

PATIENCE = 2000
"""Milliseconds of work before it is worth a card; the status bar names it from the beginning."""

WIDTH = 300
"""Width of the bar [px]."""

STEP = 21
"""Height of a step in the list [px]."""


class ProgressCard(FloatingPanel):
    """The work in hand; ``cancelled`` when the user does not want it any more."""

    cancelled = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._words, self._share = label("", "name"), label("", "secondary", tabular=True)
        self._bar = ProgressBar()
        self._steps = Steps()
        self._bar.setFixedWidth(WIDTH)
        self._share.setFixedWidth(42)
        self._share.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        words = QVBoxLayout()
        words.setSpacing(7)
        words.addWidget(self._words)
        words.addWidget(self._bar)
        words.addWidget(self._steps)
        self.stop = button(tr("Cancel"))
        set_tip(self.stop, tr("Keep previous result (Esc)"))
        self.stop.clicked.connect(self.cancelled)
        self.row.setContentsMargins(28, 20, 24, 24)
        self.row.addLayout(words)
        self.row.addWidget(self._share, alignment=Qt.AlignmentFlag.AlignTop)
        self.row.addSpacing(16)
        self.row.addWidget(self.stop, alignment=Qt.AlignmentFlag.AlignTop)
        self._wait = QTimer(self, interval=PATIENCE, singleShot=True)
        self._wait.timeout.connect(self.show)
        self.hide()

    def show_work(
        self, text: str, share: float | None, steps: Sequence[str] = (), at_once: bool = False
    ) -> None:
        """Name the work and the share of it that is done [0..1], if that is known; no text ends it.

        ``steps`` are all that it goes through in order, if it has some: ``text`` is the one in hand.
        It shows after ``PATIENCE``, or ``at_once`` where nothing else is to be seen.
        """
        if not text:
            self._wait.stop()
            self.hide()
            return
        self._words.setText(text)
        self._bar.set_fraction(share)
        self._steps.show_steps(steps, text)
        self._share.setText("" if share is None else f"{100.0 * share:.0f} %")
        if at_once:
            self.show()
        elif self.isHidden() and not self._wait.isActive():
            self._wait.start()


class Steps(QWidget):
    """What the work goes through, one below the other: done, in hand, still to come."""

    def __init__(self) -> None:
        super().__init__()
        self._steps: tuple[str, ...] = ()
        self._here = 0

    def show_steps(self, steps: Sequence[str], here: str) -> None:
        """Show these steps; one that is not among them leaves the mark where it is."""
        self._steps = tuple(steps)
        self._here = self._steps.index(here) if here in self._steps else self._here
        self.setVisible(bool(steps))
        self.setFixedHeight(STEP * len(self._steps) + 4)
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802
        """Paint a tick, a dot or a ring before each step."""
        tokens = tokens_of(self)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        for number, step in enumerate(self._steps):
            row = QRectF(0, 4 + STEP * number, self.width(), STEP)
            middle = QPointF(7, row.center().y())
            if number < self._here:
                paint_icon(painter, "check", tokens.ok, QRectF(0, middle.y() - 7, 14, 14))
            else:
                now = number == self._here
                painter.setPen(QPen(QColor(tokens.accent if now else tokens.control), 1.5))
                painter.setBrush(QColor(tokens.accent) if now else Qt.BrushStyle.NoBrush)
                painter.drawEllipse(middle, 3.5, 3.5)
            painter.setFont(font("title" if number == self._here else "secondary"))
            painter.setPen(QColor(tokens.text if number == self._here else tokens.text_quiet))
            painter.drawText(row.adjusted(22, 0, 0, 0), Qt.AlignmentFlag.AlignVCenter, step)
