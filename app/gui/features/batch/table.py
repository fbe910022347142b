"""The table of a batch run: sorted and filtered rows, the doubtful ones first if wanted."""

# ruff: noqa: N802 - Qt names its methods and events
from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from typing import Any

from PySide6.QtCore import QAbstractTableModel, QEvent, QModelIndex, QPersistentModelIndex, Qt, QTimer, Signal
from PySide6.QtGui import QHelpEvent, QKeyEvent
from PySide6.QtWidgets import QAbstractItemView, QHeaderView, QTreeView

from app.gui.theme.icons import icon
from app.gui.theme.stylesheet import font, tokens_of
from app.gui.widgets.tooltip import show_tip
from app.i18n.catalog import tr
from app.presenters.batch import ALL, BatchRow, Cells

_Index = QModelIndex | QPersistentModelIndex
_NUMBERS = ("bust", "underbust", "lift")
_WIDTHS = {
    "scan": 156,
    "variant": 120,
    "verdict": 176,
    "bust": 72,
    "underbust": 104,
    "size": 72,
    "lift": 68,
    "remarks": 60,
}
_LEAST_MS, _SHARE = 300, 12  # arranging rows takes a twelfth of the time at most
_RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
_LEFT = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter


class BatchModel(QAbstractTableModel):
    """All rows by scan and variant, and those ``shown`` in their order; ``arranged`` when these change."""

    arranged = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.rows: dict[tuple[str, str], BatchRow] = {}
        self.shown: list[BatchRow] = []
        self.columns: list[str] = []
        self.view: QTreeView | None = None
        self._cells, self._titles = Cells({}, "jp"), dict[str, str]()
        self._words: list[str] = []
        self._only, self._doubtful_first = ALL, True
        self._sorted_by, self._descending = "scan", False
        self._wait = QTimer(self, singleShot=True, interval=_LEAST_MS)
        self._wait.timeout.connect(self.arrange)

    def begin(self, cells: Cells, *, several: bool) -> None:
        """Remove all rows; those that follow have these cells, and are of ``several`` variants or of one."""
        self.beginResetModel()
        self.rows.clear()
        self.shown = []
        self._cells, self._titles = cells, cells.titles()
        self.columns = [name for name in self._titles if several or name != "variant"]
        self.endResetModel()
        self.arranged.emit()

    def add(self, rows: Iterable[BatchRow]) -> None:
        """Add rows, in the place of former ones of the same scan and variant; they are shown soon."""
        self.rows |= {row.key: row for row in rows}
        if not self._wait.isActive():
            self._wait.start()

    def set_filter(self, text: str, only: str) -> None:
        """Show only rows that hold all words of a text and pass a filter."""
        self._words, self._only = text.lower().split(), only
        self.arrange()

    def set_doubtful_first(self, on: bool) -> None:
        """Show doubtful rows before the others."""
        self._doubtful_first = on
        self.arrange()

    def sort(self, column: int, order: Qt.SortOrder = Qt.SortOrder.AscendingOrder) -> None:
        """Sort by a column."""
        if 0 <= column < len(self.columns):
            self._sorted_by = self.columns[column]
            self._descending = order == Qt.SortOrder.DescendingOrder
            self.arrange()

    def arrange(self) -> None:
        """Filter and sort all rows now."""
        start = time.monotonic()
        self._wait.stop()
        self.beginResetModel()
        self.shown = self._arranged()
        self.endResetModel()
        self._wait.setInterval(max(_LEAST_MS, int(1000 * _SHARE * (time.monotonic() - start))))
        self.arranged.emit()

    def _arranged(self) -> list[BatchRow]:
        column, key = self._sorted_by, self._cells.sort_key
        rows = [row for row in self.rows.values() if row.holds(self._words, self._only)]
        rows.sort(key=lambda row: (row.name.lower(), row.key))
        rows.sort(key=lambda row: key(row, column)[1:], reverse=self._descending)
        rows.sort(key=lambda row: key(row, column)[0])
        if self._doubtful_first:
            rows.sort(key=lambda row: -row.doubt)
        return rows

    def place_of(self, key: tuple[str, str]) -> int:
        """Return where a row is shown, -1 if it is not."""
        return next((place for place, row in enumerate(self.shown) if row.key == key), -1)

    def rowCount(self, parent: _Index = QModelIndex()) -> int:  # noqa: B008 (as Qt has it)
        """Return the number of rows shown."""
        return 0 if parent.isValid() else len(self.shown)

    def columnCount(self, parent: _Index = QModelIndex()) -> int:  # noqa: B008 (as Qt has it)
        """Return the number of columns."""
        return 0 if parent.isValid() else len(self.columns)

    def data(self, index: _Index, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        """Return what a cell shows."""
        row, column = self.shown[index.row()], self.columns[index.column()]
        if role == Qt.ItemDataRole.DisplayRole:
            return self._cells.text(row, column)
        if role == Qt.ItemDataRole.DecorationRole and column == "verdict" and self.view:
            tokens = tokens_of(self.view)
            return icon(row.icon, getattr(tokens, row.tone), 16)
        if role == Qt.ItemDataRole.TextAlignmentRole:
            return _RIGHT if column in _NUMBERS else _LEFT
        return None

    def headerData(
        self, section: int, orientation: Qt.Orientation, role: int = Qt.ItemDataRole.DisplayRole
    ) -> Any:
        """Return the title of a column."""
        if orientation != Qt.Orientation.Horizontal or not 0 <= section < len(self.columns):
            return None
        if role == Qt.ItemDataRole.DisplayRole:
            return self._titles[self.columns[section]]
        if role == Qt.ItemDataRole.TextAlignmentRole:
            return _RIGHT if self.columns[section] in _NUMBERS else _LEFT
        return None

    def tip(self, index: _Index) -> str:
        """Return what a cell has no room for."""
        return self._cells.tip(self.shown[index.row()], self.columns[index.column()])


class BatchTable(QTreeView):
    """Shows the rows; ``chosen`` carries one that is to be opened, ``marked`` whether one is marked."""

    chosen = Signal(object)
    marked = Signal(bool)

    def __init__(self, model: BatchModel) -> None:
        super().__init__()
        self.rows = model
        model.view = self
        self.setModel(model)
        self.setRootIsDecorated(False)
        self.setUniformRowHeights(True)
        self.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.setVerticalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        self.setAccessibleName(tr("Results"))
        self.setFont(font("body", tabular=True))
        header = self.header()
        header.setFont(font("caption"))
        header.setSectionsMovable(False)
        header.setMinimumSectionSize(56)
        header.setSortIndicator(0, Qt.SortOrder.AscendingOrder)
        header.setSectionResizeMode(QHeaderView.ResizeMode.Interactive)
        self.setSortingEnabled(True)
        self.doubleClicked.connect(lambda index: self.chosen.emit(model.shown[index.row()]))
        self._key: tuple[str, str] | None = None
        self._columns: Sequence[str] = ()
        model.modelAboutToBeReset.connect(self._note)
        model.arranged.connect(self._restore)

    @property
    def current(self) -> BatchRow | None:
        """Return the row that is marked."""
        place = self.currentIndex().row()
        return self.rows.shown[place] if 0 <= place < len(self.rows.shown) else None

    def currentChanged(self, current: _Index, previous: _Index) -> None:
        """Report whether a row is marked."""
        super().currentChanged(current, previous)
        self.marked.emit(self.current is not None)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Open the row that is marked by Enter."""
        row = self.current
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and row is not None:
            self.chosen.emit(row)
        else:
            super().keyPressEvent(event)

    def viewportEvent(self, event: QEvent) -> bool:
        """Show the tooltip of a cell as plain text."""
        if not isinstance(event, QHelpEvent):
            return super().viewportEvent(event)
        index = self.indexAt(event.pos())
        show_tip(event.globalPos(), self.rows.tip(index) if index.isValid() else "", self)
        return True

    def _note(self) -> None:
        row = self.current
        self._key = row.key if row is not None else self._key
        self._scrolled = self.verticalScrollBar().value()

    def _restore(self) -> None:
        """Mark the same row again, and scroll to the same place."""
        if self._columns != self.rows.columns:
            self._columns = list(self.rows.columns)
            for place, name in enumerate(self._columns):
                if name in _WIDTHS:
                    self.setColumnWidth(place, _WIDTHS[name])
        place = self.rows.place_of(self._key) if self._key is not None else -1
        if place >= 0:
            self.setCurrentIndex(self.rows.index(place, 0))
        self.verticalScrollBar().setValue(self._scrolled)
        self.marked.emit(self.current is not None)
