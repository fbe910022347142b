"""The garment: what to cut for each worn line, of which elastic, how far stretched, with what tension."""

# ruff: noqa: N802 - Qt names its events and says what they are
from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QFrame, QHBoxLayout, QPushButton, QScrollArea, QVBoxLayout, QWidget

from app.gui.features.garment.row import CUT, NEWTONS, PRESSURE, GarmentRow
from app.gui.features.garment.tissue_card import TissueCard
from app.gui.theme.stylesheet import label, set_tag
from app.gui.widgets.basic import EmptyState, button, sentence
from app.gui.widgets.button_row import button_row
from app.i18n.catalog import tr
from app.i18n.lengths import length_unit
from app.presenters.cut_list import CutListView
from app.presenters.pressure import PressureView


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
            tr("No line is worn"),
            tr("A line that is set shorter pulls: then it can be cut."),
            tr("Set lines"),
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
        """Ask for the pieces of now."""
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
            tr("No elastic chosen yet"),
            tr("Of an elastic, Busk knows how long to cut it. Choose one for all lines, or for each below."),
            tr("Choose for all lines…"),
        )
        card.requested.connect(self.all_requested)
        return card

    def _make_again(self) -> QPushButton:
        """Make what stands under the list once a line is made of an elastic: all can be changed at once."""
        again = button(tr("Choose for all lines…"), "quiet")
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

    def _make_area(self) -> QScrollArea:
        inside = QWidget()
        inside.setProperty("scrolled", "true")
        column = QVBoxLayout(inside)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(8)
        self._list = QVBoxLayout()
        self._list.setSpacing(2)
        column.addWidget(self._make_head())  # with the rows, or a scroll bar shifts them under it
        column.addLayout(self._list)
        column.addWidget(self.again, 0, Qt.AlignmentFlag.AlignLeft)
        column.addLayout(self.cards)
        column.addWidget(self.tissue)
        column.addStretch(1)
        area = QScrollArea()
        area.setAccessibleName(tr("Cut list"))
        area.setWidgetResizable(True)
        area.setFrameShape(QFrame.Shape.NoFrame)
        area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        area.setWidget(inside)
        return area

    def _make_buttons(self) -> QWidget:
        return button_row(
            (
                (
                    tr("Copy"),
                    tr("Copy the cut list, to paste into a spreadsheet or a letter"),
                    self.copy_requested,
                ),
                (tr("CSV…"), tr("Write the cut list to a file (CSV)"), self.table_requested),
                (tr("Elastics…"), tr("See, bring in and hand on elastics"), self.elastics_requested),
            ),
            top=4,
        )
