"""The garment: what to cut for each worn line, of which elastic, how far stretched, with what tension."""

# ruff: noqa: N802 - Qt names its events and says what they are

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape

from PySide6.QtCore import QRectF, Qt, Signal
from PySide6.QtGui import QColor, QMouseEvent, QPainter, QPaintEvent, QShowEvent
from PySide6.QtWidgets import (
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QPushButton,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from app.gui.theme.stylesheet import font, label, set_tag, tokens_of
from app.gui.widgets.basic import (
    ElidedLabel,
    EmptyState,
    ScrollColumn,
    button,
    button_row,
    hairline,
    sentence,
)
from app.gui.widgets.line_widgets import ElasticButton, LineChip
from app.gui.widgets.tooltip import set_tip
from app.gui.widgets.value_edit import ValueEdit
from app.i18n.catalog import number, tr
from app.i18n.lengths import length_unit
from app.presenters.cut_list import CutListView, CutView
from app.presenters.pressure import PressureView
from core.document.elastic import TISSUE_LIMITS, TISSUE_STIFFNESS


class TissueCard(QWidget):
    """Stiffness of tissue [N/m] with what is said of it and of the figures; ``entered`` carries another."""

    entered = Signal(float)

    def __init__(self) -> None:
        super().__init__()
        self.field = _TissueField()
        self.field.entered.connect(self.entered)
        self.notes = sentence("", "caption")
        self.notes.setTextFormat(Qt.TextFormat.RichText)
        column = QVBoxLayout(self)
        column.setContentsMargins(8, 4, 8, 4)
        column.setSpacing(4)
        row = QHBoxLayout()
        self._words = label(tr("Tissue stiffness"), "secondary")
        set_tip(self._words, self.field.toolTip())
        row.addWidget(self._words, 1)
        row.addWidget(self.field)
        column.addWidget(hairline())
        column.addLayout(row)
        column.addWidget(self.notes)

    def show_tissue(self, stiffness: float | None, notes: Sequence[str]) -> None:
        """Show the stiffness, if newtons depend on it, and what holds for all figures."""
        for each in (self._words, self.field):
            each.setVisible(stiffness is not None)
        if stiffness is not None:
            self.field.show_value(stiffness)
        self.notes.setText("".join(f'<p style="margin:0 0 4px 0">{escape(note)}</p>' for note in notes))


class _TissueField(ValueEdit):
    """A stiffness within what tissue may have."""

    def __init__(self) -> None:
        super().__init__("N/m", tr("Tissue stiffness"), digits=0, widest="2000")
        tip = tr(
            "Set the tissue stiffness, {low}–{high} N/m (default {usual}). Assumed, not "
            "measured; all forces scale with it."
        )
        low, high = TISSUE_LIMITS
        set_tip(self, tip.format(low=f"{low:g}", high=f"{high:g}", usual=f"{TISSUE_STIFFNESS:g}"))

    def _read(self, text: str) -> float:
        value, (low, high) = super()._read(text.replace("N/m", "")), TISSUE_LIMITS
        if not low <= value <= high:
            words = tr("Enter {low} to {high} N/m. Measured values of skin alone are 160 to 1150 N/m.")
            raise ValueError(words.format(low=number(low, 0), high=f"{high:g}"))
        return value


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
        self.set_stretch.setAccessibleName(tr("{line}: elongation in percent").format(line=view.title))
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
        chip, title, cut, tension, pressure = range(5)
        for column, room in ((chip, CHIP), (cut, CUT), (tension, NEWTONS)):
            grid.setColumnMinimumWidth(column, room)
        grid.setColumnStretch(title, 1)
        grid.addWidget(self._chip, 0, chip)
        grid.addWidget(self.title, 0, title)
        grid.addWidget(self.cut, 0, cut, _RIGHT)
        grid.addWidget(self.tension, 0, tension, _RIGHT)
        grid.setRowMinimumHeight(0, 21)
        grid.setRowMinimumHeight(1, 21)
        grid.addWidget(self.elastic, 1, title, 1, tension - title)
        grid.addWidget(self.stretch, 1, tension, _RIGHT)
        grid.addWidget(self.set_stretch, 1, tension, _RIGHT)
        grid.addWidget(self.pressure, 0, pressure, 2, 1, Qt.AlignmentFlag.AlignTop)
        grid.addWidget(self.notes, 2, title, 1, -1)
        self.notes.setContentsMargins(5, 2, 0, 2)


class _StretchField(ValueEdit):
    """How far a band that does not move the body is stretched: the designer says it."""

    MOST = 100.0

    def __init__(self) -> None:
        message = tr("Elongation on the body")
        super().__init__("%", message, digits=0, signed=True, widest="+100")
        self.setFont(font("caption", tabular=True))
        self.setProperty("ring", "true")  # beside figures that cannot be set
        self.setFixedSize(NEWTONS, 20)

    def _read(self, text: str) -> float:
        value = super()._read(text)
        if not 0.0 <= value <= self.MOST:
            raise ValueError(tr("Enter 0 to {most} %.").format(most=number(self.MOST, 0)))
        return value


def accessible_text(view: CutView) -> str:
    """Return a piece for ears."""
    cut = view.cut and f"{view.cut} {length_unit()}"
    figures = (
        (cut, tr("front part {value}") if view.front_only else tr("cut {value}")),
        (view.stretch, tr("elongation {value}")),
        (view.tension, "{value} N"),
    )
    told = [words.format(value=value) for value, words in figures if value]
    return f"{view.title}: {', '.join([*told, *view.notes])}".rstrip(": ")


class GarmentPanel(QWidget):
    """The cut list; ``cards`` takes what stands below its rows.

    ``opened`` when it comes to be seen, and what it shows has to be new. ``selected`` names a line,
    ``elastic_requested`` one whose elastic is to be chosen, ``all_requested`` is for all active lines,
    ``stretched``
    a line and how far its elastic shall be stretched [1]. ``copy_requested`` and ``table_requested`` are for
    the list as text, ``elastics_requested`` for the elastics there are.
    """

    opened = Signal()
    selected = Signal(str)
    elastic_requested = Signal(str)
    all_requested = Signal()
    stretched = Signal(str, float)
    lines_requested = Signal()
    copy_requested = Signal()
    table_requested = Signal()
    elastics_requested = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.view: CutListView | None = None
        self.stale = False
        self.rows: dict[str, GarmentRow] = {}
        self._selected = ""
        self._pressures: Mapping[str, PressureView] = {}
        self.cards = QVBoxLayout()
        self.nothing = EmptyState(
            "lines",
            tr("No active lines"),
            tr("Shorten a line to add it to the cut list."),
            tr("Edit lines"),
        )
        self.nothing.requested.connect(self.lines_requested)
        self.offer = self._make_offer()
        self.again = self._make_again()
        self._doubt, self.tissue = sentence("", "secondary"), TissueCard()
        set_tag(self._doubt, "tone", "warn")
        column = QVBoxLayout(self)
        column.setContentsMargins(10, 8, 10, 12)
        column.setSpacing(4)
        self._area = self._make_area()
        for each in (self.nothing, self._doubt, self.offer):
            column.addWidget(each)
        column.addWidget(self._area, 1)
        self._buttons = self._make_buttons()
        column.addWidget(self._buttons)
        column.addStretch(0)
        self.set_view(CutListView(()))

    def set_view(self, view: CutListView, doubt: str = "") -> None:
        """Show these pieces; ``doubt`` says why their figures are no result."""
        self.view, self.stale = view, False
        self._doubt.setText(doubt)
        self._doubt.setVisible(bool(doubt))
        self.tissue.show_tissue(view.tissue, view.notes)
        self.tissue.setVisible(view.worn)
        self.nothing.setVisible(not view.worn)
        self.offer.setVisible(view.worn and view.bare)
        self.again.setVisible(view.worn and not view.bare and len(view.rows) > 1)
        self._area.setVisible(bool(view.rows))
        if [row.line for row in view.rows] != list(self.rows):
            self._rebuild()
        self._show()

    def set_stale(self) -> None:
        """Fade the figures, and let no list leave: the body is another one meanwhile."""
        if not self.stale:
            self.stale = True
            self._show()

    def set_pressures(self, pressures: Mapping[str, PressureView]) -> None:
        """Show what lines press with, by line."""
        self._pressures = dict(pressures)
        self._show_pressures()

    def select(self, line: str) -> None:
        """Mark the row of a line."""
        self._selected = line
        for name, row in self.rows.items():
            row.set_selected(name == line)

    def showEvent(self, event: QShowEvent) -> None:
        """Request the current cut list."""
        super().showEvent(event)
        self.opened.emit()

    def _show(self) -> None:
        worn = self.view is not None and self.view.worn
        for leaves in self._buttons.findChildren(QPushButton)[:2]:
            leaves.setEnabled(worn and not self.stale)  # without a piece there is no list
        for view in self.view.rows if self.view is not None else ():
            self.rows[view.line].show_view(view, self.stale)
        self._show_pressures()

    def _show_pressures(self) -> None:
        for name, row in self.rows.items():
            row.pressure.show_pressure(self._pressures.get(name, PressureView("", "", "", "")))

    def _rebuild(self) -> None:
        """Make the rows anew; those of lines that stay are kept, one of them may have the keyboard."""
        assert self.view is not None
        former, self.rows = self.rows, {}
        for place, view in enumerate(self.view.rows):
            row = former.pop(view.line, None) or self._make_row(view.line)
            self.rows[view.line] = row
            self._list.insertWidget(place, row)
        for row in former.values():
            self._list.removeWidget(row)
            row.hide()
            row.deleteLater()
        self.select(self._selected)

    def _make_row(self, name: str) -> GarmentRow:
        row = GarmentRow()
        row.pressed.connect(lambda: self.selected.emit(name))
        row.elastic_requested.connect(lambda: self.elastic_requested.emit(name))
        row.stretched.connect(lambda share: self.stretched.emit(name, share))
        return row

    def _make_offer(self) -> EmptyState:
        """Make what stands over the list while no line is made of an elastic."""
        card = EmptyState(
            "bands",
            tr("No elastic chosen"),
            tr("Cut lengths depend on the elastic. Choose one for all lines or for each line below."),
            tr("Choose elastic for all…"),
        )
        card.requested.connect(self.all_requested)
        return card

    def _make_again(self) -> QPushButton:
        """Make what stands under the list once a line is made of an elastic: all can be changed at once."""
        again = button(tr("Choose elastic for all…"), "quiet")
        again.clicked.connect(self.all_requested)
        return again

    def _make_head(self) -> QWidget:
        """Make the heading with the units, which stand nowhere else."""
        head = QWidget()
        row = QHBoxLayout(head)
        row.setContentsMargins(8, 4, 8, 0)
        row.setSpacing(0)
        row.addWidget(label(tr("Cut list"), "heading"), 1)
        right = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignBottom
        for title, room in (
            (tr("cut {unit}").format(unit=length_unit()), CUT),
            ("N", NEWTONS),
            ("kPa", PRESSURE),
        ):
            each = label(title, "caption")
            each.setFixedWidth(room)
            each.setAlignment(right)
            row.addWidget(each)
        return head

    def _make_area(self) -> ScrollColumn:
        area = ScrollColumn(tr("Cut list"), (0, 0, 0, 0), 8)
        column = area.column
        self._list = QVBoxLayout()
        self._list.setSpacing(2)
        column.addWidget(self._make_head())  # with the rows, or a scroll bar shifts them under it
        column.addLayout(self._list)
        column.addWidget(self.again, 0, Qt.AlignmentFlag.AlignLeft)
        column.addLayout(self.cards)
        column.addWidget(self.tissue)
        column.addStretch(1)
        return area

    def _make_buttons(self) -> QWidget:
        return button_row(
            (
                (
                    tr("Copy"),
                    tr("Copy the cut list for a spreadsheet or document"),
                    self.copy_requested,
                ),
                (tr("CSV…"), tr("Export the cut list as CSV"), self.table_requested),
                (tr("Elastics…"), tr("View, import and export elastics"), self.elastics_requested),
            ),
            top=4,
        )
