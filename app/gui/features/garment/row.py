"""One piece to cut in the list: colour, name, what it is made of, figures, and how hard it presses."""

# ruff: noqa: N802 - Qt names its events and says what they are
from __future__ import annotations

from PySide6.QtCore import QRectF, Qt, Signal
from PySide6.QtGui import QColor, QMouseEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QFrame, QGridLayout, QSizePolicy, QWidget

from app.gui.theme.stylesheet import font, label, set_tag, tokens_of
from app.gui.widgets.basic import ElidedLabel, sentence
from app.gui.widgets.elastic_button import ElasticButton
from app.gui.widgets.line_widgets import LineChip
from app.gui.widgets.tooltip import set_tip
from app.gui.widgets.value_edit import ValueEdit
from app.i18n.catalog import number, tr
from app.i18n.lengths import length_unit
from app.presenters.cut_list import CutView
from app.presenters.pressure import PressureView

CHIP, CUT, NEWTONS, PRESSURE = 20, 54, 52, 56
"""Room of the columns [px]; the name has the rest."""

NOTHING = "\N{EN DASH}"

_RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter


class PressureMark(QWidget):
    """How hard a line presses: kPa, and under it a light with its word."""

    def __init__(self) -> None:
        super().__init__()
        self.view = PressureView("", "", "", "")
        self.setFixedSize(PRESSURE, 42)

    def show_pressure(self, view: PressureView) -> None:
        """Show what a line presses with."""
        if view != self.view:
            self.view = view
            set_tip(self, view.tip)
            self.setAccessibleName(f"{view.kpa} kPa {view.word}" if view.kpa else "")
            self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint figure, light and word, at the right."""
        tokens, painter, view = tokens_of(self), QPainter(self), self.view
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setFont(font("body", tabular=True))
        painter.setPen(QColor(tokens.text if view.kpa and not view.stale else tokens.text_caption))
        painter.drawText(QRectF(0, 0, PRESSURE, 21), _RIGHT, view.kpa or NOTHING)
        if not view.light:
            return
        tone = {"green": "ok", "amber": "warn", "red": "bad"}[view.light]
        painter.setFont(font("caption"))
        painter.setPen(QColor(getattr(tokens, tone)))
        word = painter.fontMetrics().elidedText(view.word, Qt.TextElideMode.ElideRight, PRESSURE - 12)
        painter.drawText(QRectF(0, 21, PRESSURE, 18), _RIGHT, word)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(getattr(tokens, tone)))
        painter.drawEllipse(QRectF(PRESSURE - painter.fontMetrics().horizontalAdvance(word) - 12, 26, 8, 8))


class GarmentRow(QFrame):
    """The row of one line; ``pressed`` by a click, ``elastic_requested`` at its choice of elastics.

    ``stretched`` carries how far its elastic shall be stretched [1], where the designer sets that.
    """

    pressed = Signal()
    stretched = Signal(float)
    elastic_requested = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.view: CutView | None = None
        self._selected = False
        self._chip, self.title = LineChip(), ElidedLabel()
        self.title.setFont(font("name"))
        self.title.setProperty("role", "name")
        self.title.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.cut = label("", "heading", tabular=True)
        self.tension, self.stretch = label("", "body", tabular=True), label("", "caption", tabular=True)
        self.elastic, self.pressure, self.set_stretch = ElasticButton(), PressureMark(), _StretchField()
        self.set_stretch.entered.connect(lambda percent: self.stretched.emit(percent / 100.0))
        self.elastic.clicked.connect(self.elastic_requested)
        self.notes = sentence("", "caption")
        self._build()

    def show_view(self, view: CutView, stale: bool) -> None:
        """Show a piece; ``stale`` figures are those of a former shape."""
        self.view = view
        self._chip.show_line(view.color, view.width_mm, True)
        self.title.setText(view.title)
        set_tip(self.title, view.title)
        self.cut.setText(view.cut or NOTHING)
        self.cut.setFont(font("body" if view.front_only else "heading", tabular=True))
        self.tension.setText(view.tension or NOTHING)
        self.stretch.setText(view.stretch)
        self.stretch.setVisible(view.stretch_percent is None)
        self.set_stretch.setVisible(view.stretch_percent is not None)
        self.set_stretch.show_value(view.stretch_percent or 0.0)
        self.set_stretch.setAccessibleName(tr("{line}: stretched by, in percent").format(line=view.title))
        for each in (self.cut, self.tension, self.stretch):
            far = "warn" if view.far and each is self.stretch else ""
            set_tag(each, "tone", "faint" if stale else far)
        set_tag(self.set_stretch, "tone", "warn" if view.far and not stale else "")
        self.elastic.show_elastic(view.title, view.elastic)
        self.notes.setText("\n".join(view.notes))
        self.notes.setVisible(bool(view.notes))
        self.setAccessibleName(accessible_text(view))

    def set_selected(self, selected: bool) -> None:
        """Mark the row of the line that is selected on the body."""
        if selected != self._selected:
            self._selected = selected
            self.update()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Select the line."""
        self.pressed.emit()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the selected row as a card with the line's colour at its edge."""
        if not self._selected or self.view is None:
            return
        tokens, painter = tokens_of(self), QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QColor(tokens.outline))
        painter.setBrush(QColor(tokens.raised))
        painter.drawRoundedRect(QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5), 8, 8)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(self.view.color))
        painter.drawRoundedRect(QRectF(0, 10, 3, self.height() - 20), 1.5, 1.5)

    def _build(self) -> None:
        grid = QGridLayout(self)
        grid.setContentsMargins(8, 6, 8, 6)
        grid.setHorizontalSpacing(0)
        grid.setVerticalSpacing(0)
        for column, room in enumerate((CHIP, 0, CUT, NEWTONS)):
            grid.setColumnMinimumWidth(column, room)
        grid.setColumnStretch(1, 1)
        grid.addWidget(self._chip, 0, 0)
        grid.addWidget(self.title, 0, 1)
        for column, each in enumerate((self.cut, self.tension), start=2):
            grid.addWidget(each, 0, column, _RIGHT)
        grid.setRowMinimumHeight(0, 21)
        grid.setRowMinimumHeight(1, 21)
        grid.addWidget(self.elastic, 1, 1, 1, 2)
        grid.addWidget(self.stretch, 1, 3, _RIGHT)
        grid.addWidget(self.set_stretch, 1, 3, _RIGHT)
        grid.addWidget(self.pressure, 0, 4, 2, 1, Qt.AlignmentFlag.AlignTop)
        grid.addWidget(self.notes, 2, 1, 1, 4)
        self.notes.setContentsMargins(5, 2, 0, 2)


class _StretchField(ValueEdit):
    """How far a band that does not move the body is stretched: the designer says it."""

    MOST = 100.0

    def __init__(self) -> None:
        said = tr("How far it is stretched on the body")
        super().__init__("%", said, digits=0, signed=True, widest="+100")
        self.setFont(font("caption", tabular=True))
        self.setProperty("ring", "true")  # beside figures that cannot be set
        self.setFixedSize(NEWTONS, 20)

    def _read(self, text: str) -> float:
        value = super()._read(text)
        if not 0.0 <= value <= self.MOST:
            raise ValueError(tr("Choose 0 to {most} %.").format(most=number(self.MOST, 0)))
        return value


def accessible_text(view: CutView) -> str:
    """Return a piece for ears."""
    cut = view.cut and f"{view.cut} {length_unit()}"
    figures = (
        (cut, tr("front part {value}") if view.front_only else tr("cut {value}")),
        (view.stretch, tr("stretched by {value}")),
        (view.tension, "{value} N"),
    )
    told = [words.format(value=value) for value, words in figures if value]
    return f"{view.title}: {', '.join([*told, *view.notes])}".rstrip(": ")
