"""The line at the foot of the window: plain facts, the running job, when it was saved."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QRectF, Qt, Signal
from PySide6.QtGui import QColor, QPainter, QPaintEvent
from PySide6.QtWidgets import QHBoxLayout, QWidget

from app.gui.theme.stylesheet import label, tokens_of
from app.gui.widgets.basic import ToolButton
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import number, tr


class StatusBar(QWidget):
    """Facts and volume on the left; the job and the saved time on the right.

    ``job_cancelled`` when the user does not want the job that is shown any more.
    """

    job_cancelled = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.setFixedHeight(26)
        row = self._row = QHBoxLayout(self)
        row.setContentsMargins(14, 1, 14, 0)
        row.setSpacing(16)
        self._facts = label("", "caption")
        self._volume = label("", "caption", tabular=True)
        row.addWidget(self._facts)
        self._taken_up = label("", "caption", tabular=True)
        row.addWidget(self._volume)
        row.addWidget(self._taken_up)
        row.addStretch(1)
        self._job = QWidget()
        job = QHBoxLayout(self._job)
        job.setContentsMargins(0, 0, 0, 0)
        job.setSpacing(8)
        self._job_name, self._bar = label("", "caption"), ProgressBar()
        self.stop = ToolButton("x", tr("Cancel task"), size=10, room=20)
        self.stop.clicked.connect(self.job_cancelled)
        for each in (self._job_name, self._bar, self.stop):
            job.addWidget(each)
        self._job.hide()
        self._saved = label("", "caption")
        row.addWidget(self._job)
        row.addWidget(self._saved)

    def place(self, widget: QWidget) -> None:
        """Place what a feature shows before the job."""
        self._row.insertWidget(self._row.indexOf(self._job), widget)

    def set_facts(self, facts: Sequence[str]) -> None:
        """Show facts such as the unit and the number of triangles, ready to read."""
        self._facts.setText("     ".join(facts))

    def set_volume(self, error_percent: float | None, error_ml: float = 0.0) -> None:
        """Show how far the volume is from the one to keep [%, ml], or nothing."""
        if error_percent is None:
            self._volume.setText("")
            return
        text = tr("Volume {percent} % ({millilitres} ml)")
        percent, millilitres = number(error_percent, 2, signed=True), number(error_ml, 1, signed=True)
        self._volume.setText(text.format(percent=percent, millilitres=millilitres))

    def set_taken_up(self, text: str, tip: str) -> None:
        """Show how much volume is taken up inside, ready to read, with what that means."""
        self._taken_up.setText(text)
        self._taken_up.setVisible(bool(text))
        set_tip(self._taken_up, tip)

    def set_job(self, text: str, fraction: float | None = None) -> None:
        """Show the running job and how much is done [0..1], None when unknown; an empty text ends it."""
        self._job_name.setText(text)
        self._job.setVisible(bool(text))
        # The window may be too busy to lay itself out again before it is painted.
        self._row.activate()
        self._bar.set_fraction(fraction)

    def set_saved(self, text: str) -> None:
        """Show when the project was saved, ready to read."""
        self._saved.setText(text)

    def paintEvent(self, event: QPaintEvent) -> None:
        QPainter(self).fillRect(0, 0, self.width(), 1, QColor(tokens_of(self).line))


class ProgressBar(QWidget):
    """A thin bar; half as strong and full when nobody knows how long it takes."""

    def __init__(self) -> None:
        super().__init__()
        self.setFixedSize(120, 4)
        self._fraction: float | None = None

    def set_fraction(self, fraction: float | None) -> None:
        """Show how much is done [0..1]."""
        self._fraction = fraction
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens = tokens_of(self)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(tokens.groove))
        painter.drawRoundedRect(QRectF(self.rect()), 2, 2)
        done = 1.0 if self._fraction is None else min(max(self._fraction, 0.0), 1.0)
        painter.setOpacity(0.5 if self._fraction is None else 1.0)
        painter.setBrush(QColor(tokens.accent))
        painter.drawRoundedRect(QRectF(0, 0, self.width() * done, self.height()), 2, 2)
