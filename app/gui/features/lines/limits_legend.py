"""The key to the groove of a slider: what each kind of its zones means, and from where to where it goes."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QPainter, QPaintEvent
from PySide6.QtWidgets import QGridLayout, QLabel, QWidget

from app.gui.features.lines.slider import GROOVE_HEIGHT, STALE, paint_zone
from app.gui.theme.stylesheet import set_tag, tokens_of
from app.gui.widgets.basic import sentence
from app.i18n.catalog import tr
from app.presenters.length_limits import KEY_ORDER, legend_entries, tone_at
from core.analysis.length_limits.zones import LengthLimits

_ORDER = ("", "warn", "bad")


class Swatch(QWidget):
    """A piece of the groove as a zone of one ``tone`` is painted; faint where that is old."""

    def __init__(self, tone: str) -> None:
        super().__init__()
        self._tone, self._stale = tone, False
        self.setFixedSize(QSize(16, 16))  # as high as a line of words, so that both lie on one level

    def show_stale(self, stale: bool) -> None:
        """Show that what it stands for is of the design before, or that it is not."""
        if stale != self._stale:
            self._stale = stale
            self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setOpacity(STALE if self._stale else 1.0)
        top = (self.height() - GROOVE_HEIGHT) / 2.0
        paint_zone(painter, tokens_of(self), QRectF(0.0, top, self.width(), GROOVE_HEIGHT), self._tone)


class LimitsLegend(QWidget):
    """A row for each kind of zone that a line has: a swatch and words; the one it stands in is told apart.

    Beneath them is the ``pressure`` at the present length. A length in a green zone whose pressure is too
    high has the tone of the pressure.
    """

    def __init__(self) -> None:
        super().__init__()
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 3)
        grid.setHorizontalSpacing(7)
        grid.setVerticalSpacing(1)
        grid.setColumnStretch(1, 1)
        self.rows: dict[str, tuple[Swatch, QLabel]] = {}
        for row, tone in enumerate(KEY_ORDER):
            swatch, words = self.rows[tone] = Swatch(tone), sentence("", "secondary")
            grid.addWidget(swatch, row, 0, Qt.AlignmentFlag.AlignTop)
            grid.addWidget(words, row, 1)
        self.pressure = sentence("", "caption")
        grid.addWidget(self.pressure, len(KEY_ORDER), 1)

    def show_leeway(
        self, leeway: LengthLimits, ratio: float, stale: bool, pressed: str = "", pressed_tone: str = ""
    ) -> None:
        """Show the leeway of a line set to ``ratio`` [1]; ``stale``: of the design before.

        ``pressed`` is its pressure now in words, in the tone of its light, empty where that is not known.
        """
        told, here = legend_entries(leeway), leeway.at(ratio).tone
        in_force = max(tone_at(leeway, ratio), pressed_tone.replace("ok", ""), key=_ORDER.index)
        for tone, (swatch, words) in self.rows.items():
            words.setText(told.get(tone, ""))
            set_tag(words, "tone", "faint" if stale else in_force if tone == here else "")
            swatch.show_stale(stale)
            for each in (swatch, words):
                each.setVisible(tone in told)
        self.pressure.setText(tr("Contact pressure: {pressure}").format(pressure=pressed))
        set_tag(self.pressure, "tone", pressed_tone)
        self.pressure.setVisible(bool(pressed))
