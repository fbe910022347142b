"""Panel of measurements: before, after and change."""

# ruff: noqa: N802 - Qt names its events and says what they are
from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtGui import QHideEvent, QShowEvent
from PySide6.QtWidgets import QStackedWidget, QVBoxLayout, QWidget

from app.gui.features.measurements.custom_measure_editor import MeasurementEditor
from app.gui.features.measurements.size_card import SizeCard
from app.gui.features.measurements.table import MeasurementsTable
from app.gui.theme.stylesheet import font, set_tag
from app.gui.widgets.basic import EmptyState, ScrollColumn, button, button_row, sentence
from app.i18n.catalog import tr
from app.presenters.measurements import MeasureView


class MeasurementsPanel(QStackedWidget):
    """The table of measures, or the form for one's own; ``opened`` when it comes to be seen.

    ``summary`` stands at the head, a line on uncertainties. ``marked`` carries the key of the measure to be
    shown on the body, empty for none; ``framed`` when it is to be looked at. ``adding`` asks for one more,
    ``changing`` and ``removing`` carry the key of one's own. ``copy_requested`` and ``table_requested`` are
    for the measures as text, on the clipboard or in a file.
    """

    opened = Signal()
    summary_clicked = Signal()
    marked = Signal(str)
    framed = Signal()
    adding = Signal()
    changing = Signal(str)
    removing = Signal(str)
    copy_requested = Signal()
    table_requested = Signal()

    def __init__(self) -> None:
        super().__init__()
        self._live: tuple[MeasureView, ...] = ()
        self._measured: tuple[MeasureView, ...] = ()
        self._stale = False
        self._empty = EmptyState(
            "result", tr("No measurements yet"), tr("Landmarks appear when the control mesh has been fitted.")
        )
        self._doubt = sentence("", "secondary")
        self._doubt.setContentsMargins(4, 2, 4, 4)
        set_tag(self._doubt, "tone", "warn")
        self.sizes, self._table = SizeCard(), MeasurementsTable()
        for name in ("framed", "changing", "removing"):
            getattr(self._table, name).connect(getattr(self, name))
        self._table.marked.connect(self._mark)
        self._scroll = QTimer(self, singleShot=True, interval=0)  # once what is opened has got its room
        self._scroll.timeout.connect(self._scroll_to_mark)
        page, column, self.doors = QWidget(), QVBoxLayout(), QVBoxLayout()
        whole = QVBoxLayout(page)
        whole.setContentsMargins(0, 0, 0, 0)
        whole.setSpacing(0)
        whole.addLayout(column, 1)
        whole.addLayout(self.doors)  # under what is measured, as other doors stand under their lists
        column.setContentsMargins(14, 8, 14, 12)
        column.setSpacing(4)
        column.addWidget(self._empty)
        column.addWidget(self._doubt)
        column.addWidget(self._make_area(), 1)
        column.addWidget(self._make_buttons())
        column.addStretch(0)
        self.editor = MeasurementEditor()
        for each in (page, self.editor):
            self.addWidget(each)
        self.set_rows([])

    def _make_area(self) -> ScrollColumn:
        self._note = sentence(tr("Bars show the change: blue decrease, orange increase."), "caption")
        self._note.setContentsMargins(4, 8, 4, 8)
        self._waiting = sentence("", "caption")
        self._waiting.setContentsMargins(4, 6, 4, 6)
        self._waiting.hide()
        self._area = ScrollColumn(tr("Measurements"), (0, 0, 0, 0), sideways=True)
        self._area.setFocusPolicy(Qt.FocusPolicy.TabFocus)  # a click beside its figures is no wish for keys
        self._column = self._area.column
        self.summary = button("", "word")
        self.summary.setFont(font("caption"))
        self.summary.hide()
        self.summary.clicked.connect(lambda _: self.summary_clicked.emit())
        self._column.addWidget(self.summary, 0, Qt.AlignmentFlag.AlignLeft)
        self._column.addWidget(self.sizes)
        self.cards = QVBoxLayout()
        self._column.addLayout(self.cards)
        self.feet = QVBoxLayout()
        for each in (self._waiting, self._table, self._note):
            self._column.addWidget(each)
        self._column.addLayout(self.feet)
        self._column.addStretch(1)
        return self._area

    def set_rows(self, rows: Sequence[MeasureView], doubt: str = "") -> None:
        """Show these figures of the model, or that there is none; ``doubt`` says why they are no result."""
        for part in (self._area, self._buttons):
            part.setVisible(bool(rows))
        self._empty.setVisible(not rows)
        self._doubt.setText(doubt)
        self._doubt.setVisible(bool(doubt))
        self._live = tuple(rows)
        self._show()

    def set_measured(self, measured: Sequence[MeasureView], waiting: str = "") -> None:
        """Show what was measured on the body; ``waiting`` says why there is nothing yet."""
        self._measured, self._stale = tuple(measured), False
        self._waiting.setText(waiting)
        self._waiting.setVisible(bool(waiting))
        self._show()

    def set_stale(self, stale: bool) -> None:
        """Fade what was measured while the body is another one, or let it count again."""
        self._stale = stale
        self._show()

    def show_summary(self, text: str) -> None:
        """Show a line on uncertainties at the head, or none."""
        self.summary.setText(text)
        self.summary.setVisible(bool(text))

    @property
    def editing(self) -> bool:
        """Return whether the form for one's own measure is there."""
        return self.currentWidget() is self.editor

    def set_editing(self, editing: bool) -> None:
        """Show the form in the place of the table, or the table."""
        self.setCurrentIndex(int(editing))
        if not editing and self.isVisible():
            self._table.setFocus()

    @property
    def mark(self) -> str:
        """Return the key of the measure that is shown on the body, or nothing."""
        return self._table.mark

    def select(self, key: str) -> None:
        """Show a measure on the body, or none."""
        self._table.select(key)

    def unmark(self) -> bool:
        """Show no measure on the body any more, nor one that is being made; returns whether there was one."""
        had = bool(self._table.mark) or self.editing
        if self.editing:
            self.editor.closed.emit()
        self._table.select("")
        return had

    @property
    def rows(self) -> tuple[MeasureView, ...]:
        """Return the figures of the model that are shown."""
        return self._live

    @property
    def measured(self) -> tuple[MeasureView, ...]:
        """Return the measurements of the body."""
        return self._measured

    @property
    def stale(self) -> bool:
        """Return whether what was measured was measured on a former body."""
        return self._stale

    def _show(self) -> None:
        there = self._table.place_of(self.mark)
        self._table.set_rows([*self._measured, *self._live], self._stale, bool(self.doubt))
        if self.mark and there.isNull():  # one's own that was added has come
            self._scroll.start()

    @property
    def doubt(self) -> str:
        """Return why the measurements are not valid, or nothing."""
        return self._doubt.text()

    def _mark(self, key: str) -> None:
        if key:
            self._scroll.start()
        self.marked.emit(key)

    def _scroll_to_mark(self) -> None:
        place = self._table.place_of(self.mark).translated(self._table.pos())
        self._area.ensureVisible(0, place.bottom(), 0, 0)
        self._area.ensureVisible(0, place.top(), 0, 0)

    def bring(self, card: QWidget) -> None:
        """Scroll to a card that stands above or below the table."""
        self._area.verticalScrollBar().setValue(card.y())

    def _make_buttons(self) -> QWidget:
        copied = tr("Copy the table for a spreadsheet or document")
        written = tr("Export the table as CSV")
        choices = (
            (tr("Add measurement…"), tr("Measure a distance between two landmarks, or a girth"), self.adding),
            (tr("Copy"), copied, self.copy_requested),
            (tr("CSV…"), written, self.table_requested),
        )
        self._buttons = button_row(choices, top=4)
        return self._buttons

    def showEvent(self, event: QShowEvent) -> None:
        """Request the current measurements."""
        self.opened.emit()

    def hideEvent(self, event: QHideEvent) -> None:
        """Leave the body to what is done next."""
        self.unmark()
