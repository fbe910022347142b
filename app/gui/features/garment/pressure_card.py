"""Contact pressure under the cut list: the largest, all of the force, a small scale, and how sure that is."""

# ruff: noqa: N802 - Qt names its events and says what they are
from __future__ import annotations

from math import inf

from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QHBoxLayout, QSizePolicy, QVBoxLayout, QWidget

from app.gui.theme.stylesheet import font, label, set_tag, tokens_of
from app.gui.widgets.basic import ToolButton, button, folded_list, hairline, sentence
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import number, tr
from app.presenters.pressure import TONES, PressureSummary, RatingLimits

LIGHTS = ("green", "amber", "red")
"""The lights, the best first."""


_ZONES = {"green": "zone_ok", "amber": "zone_warn", "red": "zone_bad"}
_FADED = 0.4  # how strongly figures of a former shape are seen


class RatingMark(QWidget):
    """A light and its word: never the colour alone."""

    def __init__(self) -> None:
        super().__init__()
        self.light, self.word = "", ""
        self.setFont(font("secondary"))

    def sizeHint(self) -> QSize:
        """Return the size of mark and text."""
        return QSize(self.fontMetrics().horizontalAdvance(self.word) + 18, 20)

    def show_light(self, light: str, word: str) -> None:
        """Show one of ``LIGHTS`` with its word."""
        self.light, self.word = light, word
        self.setAccessibleName(word)
        self.setFixedSize(self.sizeHint())
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint a dot and the word."""
        if not self.light:
            return
        painter, tone = QPainter(self), QColor(getattr(tokens_of(self), TONES[self.light]))
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(tone)
        painter.drawEllipse(QRectF(2, 6, 8, 8))
        painter.setPen(tone)
        painter.drawText(QRectF(15, 0, self.width() - 15, 20), Qt.AlignmentFlag.AlignVCenter, self.word)


class PressureScale(QWidget):
    """Three zones with their words and limits, and over them where each line stands."""

    def __init__(self, limits: RatingLimits) -> None:
        super().__init__()
        self._limits = limits
        self.marks: tuple[tuple[str, str, float], ...] = ()
        self._faint = False
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)

    def sizeHint(self) -> QSize:
        """Return the size of marks, zones and two rows of text."""
        return QSize(200, 56)

    def show_marks(self, marks: tuple[tuple[str, str, float], ...], faint: bool) -> None:
        """Show where lines stand: title, colour, pressure [kPa]."""
        self.marks, self._faint = marks, faint
        texts = [f"{title} {number(kpa)} kPa" for title, _, kpa in marks]
        set_tip(self, "\n".join(texts))
        self.setAccessibleName(", ".join(texts))
        self.update()

    def x_of(self, kpa: float) -> float:
        """Return where a pressure stands [px]; what is far beyond the last limit stands at the end."""
        end = self._limits.amber_kpa + self._limits.red_kpa
        return 6.0 + min(kpa / end, 1.0) * (self.width() - 12.0)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint zones, words, limits and marks."""
        tokens, painter, limits = tokens_of(self), QPainter(self), self._limits
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setFont(font("caption", tabular=True))
        ends = [self.x_of(kpa) for kpa in (0.0, limits.amber_kpa, limits.red_kpa, inf)]
        centred = Qt.AlignmentFlag.AlignCenter
        for place, light in enumerate(LIGHTS):
            zone = QRectF(ends[place] + (place > 0), 16, ends[place + 1] - ends[place] - (place > 0), 6)
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(QColor(getattr(tokens, _ZONES[light])))
            painter.drawRoundedRect(zone, 2, 2)
            painter.setPen(QColor(getattr(tokens, TONES[light])))
            painter.drawText(QRectF(zone.left(), 38, zone.width(), 16), centred, limits.words[place])
        painter.setPen(QColor(tokens.text_caption))
        for x, kpa in zip(ends[1:3], (limits.amber_kpa, limits.red_kpa), strict=True):
            painter.drawText(QRectF(x - 25, 24, 50, 16), centred, f"{number(kpa, 0)} kPa")
        painter.setOpacity(_FADED if self._faint else 1.0)
        for _, colour, kpa in self.marks:
            x = self.x_of(kpa)
            painter.setPen(QPen(QColor(tokens.panel), 1.0))
            painter.setBrush(QColor(colour))
            painter.drawPolygon(QPolygonF([QPointF(x - 5, 4), QPointF(x + 5, 4), QPointF(x, 15)]))


class PressureCard(QWidget):
    """The summary, the scale and two folds; ``place_requested`` by a click on where it presses most."""

    place_requested = Signal()

    def __init__(self, limits: RatingLimits) -> None:
        super().__init__()
        self.largest, self.light = label("", "heading", tabular=True), RatingMark()
        self.says, self.force = sentence("", "secondary"), label("", "secondary", tabular=True)
        self.place = button("", "word")
        self.place.clicked.connect(self.place_requested)
        self.scale = PressureScale(limits)
        self.limits = sentence(
            tr("The limits are estimates, interpolated between measured values such as {source}.").format(
                source=limits.source
            ),
            "caption",
        )
        self.sure = sentence(tr("Upper estimate: use it to compare designs on one body."), "caption")
        column = QVBoxLayout(self)
        column.setContentsMargins(8, 2, 8, 2)
        column.setSpacing(3)
        column.addWidget(hairline())
        column.addWidget(label(tr("Contact pressure"), "heading"))
        column.addLayout(self._head())
        column.addLayout(self._where())
        for each in (self.says, self.force, self.scale, self.sure, self.limits):
            column.addWidget(each)
        self.folds = [
            folded_list(column, tr("Sources of the limits"), limits.sources),
            folded_list(column, tr("Not included"), limits.left_out),
        ]

    def show_summary(self, view: PressureSummary, faint: bool) -> None:
        """Show what bands press with; ``faint`` figures are of a former shape."""
        some = bool(view.largest)
        self.largest.setText(view.largest)
        self.light.show_light(view.light, view.word)
        self.place.setText(view.place)
        set_tip(self.place, view.place_tip)
        self.place.setEnabled(not faint)
        self.eye.setEnabled(not faint)
        self.says.setText(view.says)
        self.force.setText(view.force)
        self.scale.show_marks(view.marks, faint)
        for each in (self.largest, self._most, self.place, self.eye, self.force, self.scale):
            each.setVisible(some)
        self.light.setVisible(some and not faint)  # a former shape has no light
        for each in (self.largest, self.says, self.force):
            set_tag(each, "tone", "faint" if faint else "")

    def _where(self) -> QHBoxLayout:
        self._most = label(tr("Maximum:"), "secondary")
        self.eye = ToolButton("eye", tr("Show location on the contact pressure map"), size=14, room=24)
        self.eye.setFocusPolicy(Qt.FocusPolicy.NoFocus)  # the words beside it do the same by keyboard
        self.eye.clicked.connect(self.place_requested)
        row = QHBoxLayout()
        row.setSpacing(0)
        row.addWidget(self._most)
        row.addWidget(self.place)
        row.addWidget(self.eye)
        row.addStretch(1)
        return row

    def _head(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(8)
        row.addWidget(self.largest)
        row.addWidget(self.light)
        row.addStretch(1)
        return row
