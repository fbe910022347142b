"""What is being done, how much of it is done, and a way to stop it: a card over the view."""

from __future__ import annotations

from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtWidgets import QVBoxLayout, QWidget

from app.dress.parts import FloatingPanel, button
from app.dress.theme import label
from app.panels.status import ProgressBar
from app.wording.words import tr

PATIENCE = 500
"""Milliseconds of work before it is worth a card."""


class BusyCard(FloatingPanel):
    """The work in hand; ``cancelled`` when the user does not want it any more."""

    cancelled = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._words, self._share = label("", "name"), label("", "secondary", tabular=True)
        self._bar = ProgressBar()
        self._bar.setFixedWidth(240)
        self._share.setFixedWidth(42)
        self._share.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        words = QVBoxLayout()
        words.setSpacing(7)
        words.addWidget(self._words)
        words.addWidget(self._bar)
        self.stop = button(tr("Cancel"))
        self.stop.setToolTip(tr("What was there before stays (Esc)"))
        self.stop.clicked.connect(self.cancelled)
        self.row.setContentsMargins(28, 20, 24, 24)
        self.row.addLayout(words)
        self.row.addWidget(self._share)
        self.row.addSpacing(16)
        self.row.addWidget(self.stop)
        self._wait = QTimer(self, interval=PATIENCE, singleShot=True)
        self._wait.timeout.connect(self.show)
        self.hide()

    def show_work(self, text: str, share: float) -> None:
        """Name the work and the share of it that is done [0..1]; no text ends it."""
        if not text:
            self._wait.stop()
            self.hide()
            return
        self._words.setText(text)
        self._bar.set_fraction(share)
        self._share.setText(f"{100.0 * share:.0f} %")
        if self.isHidden() and not self._wait.isActive():
            self._wait.start()
