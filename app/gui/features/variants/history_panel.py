"""History of edits and results; a click restores either."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QModelIndex, QPersistentModelIndex, QRectF, Qt, Signal
from PySide6.QtGui import QColor, QPainter, QPen
from PySide6.QtWidgets import QListWidgetItem, QSplitter, QVBoxLayout, QWidget

from app.gui.theme.stylesheet import label, tokens_of
from app.gui.widgets.basic import sentence
from app.gui.widgets.thumbnail_list import VIEW, RowPainter, ThumbnailList, ThumbnailRow, ThumbnailRowPainter
from app.i18n.catalog import tr


class HistoryPanel(QWidget):
    """Two lists: ``jumped`` carries the number of edits that shall stand, ``restored`` that of a snapshot."""

    jumped = Signal(int)
    restored = Signal(int)

    def __init__(self) -> None:
        super().__init__()
        self.edits, self.snapshots = ThumbnailList(_EditRow(self)), ThumbnailList(ThumbnailRowPainter(self))
        self.edits.setAccessibleName(tr("History"))
        self.snapshots.setAccessibleName(tr("Results"))
        self._hint = sentence(tr("Results of all edits are kept here until Busk closes."))
        self._hint.setContentsMargins(4, 2, 4, 8)
        self._parts = QSplitter(Qt.Orientation.Vertical)
        self._parts.setHandleWidth(1)
        self._parts.setChildrenCollapsible(False)
        for title, *inside in (
            (tr("History"), self.edits),
            (tr("Results"), self._hint, self.snapshots),
        ):
            self._parts.addWidget(_part(title, inside))
        column = QVBoxLayout(self)
        column.setContentsMargins(12, 2, 12, 4)
        column.addWidget(self._parts)
        for rows, signal in ((self.edits, self.jumped), (self.snapshots, self.restored)):
            rows.itemClicked.connect(lambda item, rows=rows, signal=signal: signal.emit(rows.row(item)))
            rows.itemActivated.connect(lambda item, rows=rows, signal=signal: signal.emit(rows.row(item)))
        self.set_edits([], 0)
        self.set_snapshots([])

    def set_edits(self, names: Sequence[str], present: int) -> None:
        """Show the names of all edits, the first ``present`` of them stand, the others are undone."""
        rows = [tr("Opened"), *names]
        self.edits.clear()
        for place, name in enumerate(rows):
            item = QListWidgetItem(name, self.edits)
            item.setData(VIEW, place - present)
            self.edits.mark(item, place == present)
        self.edits.scrollToItem(self.edits.item(present))

    def set_snapshots(self, views: Sequence[ThumbnailRow]) -> None:
        """Show snapshots, the newest first."""
        if views and self._hint.isVisibleTo(self):
            half = self._parts.height() // 2
            self._parts.setSizes([half, half])
        self._hint.setVisible(not views)
        self.snapshots.setVisible(bool(views))
        self.snapshots.show_rows(views)


def _part(title: str, inside: Sequence[QWidget]) -> QWidget:
    part = QWidget()
    column = QVBoxLayout(part)
    column.setContentsMargins(0, 0, 0, 8)
    column.setSpacing(4)
    heading = label(title, "heading")
    heading.setContentsMargins(4, 10, 0, 2)
    column.addWidget(heading)
    for each in inside:
        column.addWidget(each, 1 if isinstance(each, ThumbnailList) else 0)
    column.addStretch(0)
    return part


class _EditRow(RowPainter):
    """The name of an edit beside a dot: full where the document stands, hollow where it was undone."""

    def paint_row(self, painter: QPainter, area: QRectF, index: QModelIndex | QPersistentModelIndex) -> None:
        tokens, ahead = tokens_of(self.widget), int(index.data(VIEW))
        dot = QRectF(area.left() + 9, area.center().y() - 3.5, 7, 7)
        color = QColor(tokens.accent if ahead == 0 else tokens.control)
        painter.setPen(QPen(color, 1.4))
        painter.setBrush(color if ahead <= 0 else Qt.BrushStyle.NoBrush)
        painter.drawEllipse(dot)
        words = area.adjusted(27, 0, -8, 0)
        token = "text_caption" if ahead > 0 else "text"
        self.write(
            painter, words, index.data(Qt.ItemDataRole.DisplayRole), "name" if ahead == 0 else "body", token
        )
