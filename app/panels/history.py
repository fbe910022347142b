"""What was done, edit by edit, and the results that it led to; a click goes back to either."""

# ruff: noqa: N802 - Qt names its events and says what they are
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from PySide6.QtCore import QModelIndex, QPersistentModelIndex, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QFontMetricsF, QImage, QPainter, QPainterPath, QPen
from PySide6.QtWidgets import (
    QAbstractItemView,
    QListWidget,
    QListWidgetItem,
    QSplitter,
    QStyle,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QVBoxLayout,
    QWidget,
)

from app.dress.parts import sentence
from app.dress.theme import font, label, tokens_of
from app.wording.words import tr

_VIEW, _PRESENT = Qt.ItemDataRole.UserRole, Qt.ItemDataRole.UserRole + 1
_LEFT = Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft


@dataclass(frozen=True, eq=False)
class SnapshotView:
    """A settled result: the edit that led to it, when, its main figures, and a picture if there is one.

    ``present`` says that its design is the one that is shown.
    """

    title: str
    time: str
    figures: tuple[str, ...]
    picture: QImage | None = None
    present: bool = False


class HistoryPanel(QWidget):
    """Two lists: ``jumped`` carries the number of edits that shall stand, ``restored`` that of a snapshot."""

    jumped = Signal(int)
    restored = Signal(int)

    def __init__(self) -> None:
        super().__init__()
        self.edits, self.snapshots = _List(_EditRow(self)), _List(_SnapshotRow(self))
        self.edits.setAccessibleName(tr("History"))
        self.snapshots.setAccessibleName(tr("Settled results"))
        self._hint = sentence(tr("Each result that settles after an edit is kept here until Busk closes."))
        self._hint.setContentsMargins(4, 2, 4, 8)
        self._parts = QSplitter(Qt.Orientation.Vertical)
        self._parts.setHandleWidth(1)
        self._parts.setChildrenCollapsible(False)
        for title, *inside in (
            (tr("History"), self.edits),
            (tr("Settled results"), self._hint, self.snapshots),
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
            item.setData(_VIEW, place - present)
            self.edits.mark(item, place == present)
        self.edits.scrollToItem(self.edits.item(present))

    def set_snapshots(self, views: Sequence[SnapshotView]) -> None:
        """Show snapshots, the newest first."""
        self._hint.setVisible(not views)
        self.snapshots.setVisible(bool(views))
        self.snapshots.clear()
        for view in views:
            item = QListWidgetItem(view.title, self.snapshots)
            item.setData(_VIEW, view)
            said = "  ".join((view.time, *view.figures))
            item.setToolTip(f"{view.title}\n{said}")
            item.setData(Qt.ItemDataRole.AccessibleDescriptionRole, said)
            self.snapshots.mark(item, view.present)


def _part(title: str, inside: Sequence[QWidget]) -> QWidget:
    part = QWidget()
    column = QVBoxLayout(part)
    column.setContentsMargins(0, 0, 0, 8)
    column.setSpacing(4)
    heading = label(title, "heading")
    heading.setContentsMargins(4, 10, 0, 2)
    column.addWidget(heading)
    for each in inside:
        column.addWidget(each, 1 if isinstance(each, _List) else 0)
    column.addStretch(0)
    return part


class _List(QListWidget):
    """Rows that are painted by a delegate and can be walked through by keys."""

    def __init__(self, delegate: QStyledItemDelegate) -> None:
        super().__init__()
        self.setItemDelegate(delegate)
        self.setFrameShape(QListWidget.Shape.NoFrame)
        self.setProperty("scrolled", "true")
        self.setMouseTracking(True)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setVerticalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        self.viewport().setAutoFillBackground(False)

    def mark(self, item: QListWidgetItem, present: bool) -> None:
        """Mark the row that is present, for the eye and for the ear."""
        item.setData(_PRESENT, present)
        if present:
            item.setData(Qt.ItemDataRole.AccessibleTextRole, f"{item.text()}, {tr('shown now')}")
            self.setCurrentItem(item)


class _Row(QStyledItemDelegate):
    """Paints the ground of a row; what stands on it is painted by those that inherit."""

    HEIGHT = 30

    def sizeHint(self, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex) -> QSize:
        return QSize(100, self.HEIGHT)

    def paint(
        self, painter: QPainter, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex
    ) -> None:
        tokens = tokens_of(self._widget)
        area = QRectF(option.rect).adjusted(1, 1, -1, -1)
        state = option.state
        present = bool(index.data(_PRESENT))
        painter.save()
        painter.setRenderHints(QPainter.RenderHint.Antialiasing | QPainter.RenderHint.SmoothPixmapTransform)
        focused = bool(state & QStyle.StateFlag.State_HasFocus)
        painter.setPen(QPen(QColor(tokens.accent), 2) if focused else Qt.PenStyle.NoPen)
        hovered = bool(state & QStyle.StateFlag.State_MouseOver)
        painter.setBrush(
            QColor(tokens.selected if present else tokens.hover)
            if present or hovered
            else Qt.BrushStyle.NoBrush
        )
        painter.drawRoundedRect(area, 6, 6)
        self.paint_row(painter, area, index)
        painter.restore()

    def paint_row(self, painter: QPainter, area: QRectF, index: QModelIndex | QPersistentModelIndex) -> None:
        """Paint what stands in a row."""
        raise NotImplementedError

    @property
    def _widget(self) -> QWidget:
        widget = self.parent()
        assert isinstance(widget, QWidget)
        return widget

    def _write(self, painter: QPainter, area: QRectF, text: str, role: str, token: str) -> None:
        painter.setFont(font(role, tabular=role == "caption"))
        painter.setPen(QColor(getattr(tokens_of(self._widget), token)))
        room = round(area.width())
        said = painter.fontMetrics().elidedText(text, Qt.TextElideMode.ElideRight, room)
        painter.drawText(area, _LEFT, said)


class _EditRow(_Row):
    """The name of an edit beside a dot: full where the document stands, hollow where it was undone."""

    def paint_row(self, painter: QPainter, area: QRectF, index: QModelIndex | QPersistentModelIndex) -> None:
        tokens, ahead = tokens_of(self._widget), int(index.data(_VIEW))
        dot = QRectF(area.left() + 9, area.center().y() - 3.5, 7, 7)
        color = QColor(tokens.accent if ahead == 0 else tokens.control)
        painter.setPen(QPen(color, 1.4))
        painter.setBrush(color if ahead <= 0 else Qt.BrushStyle.NoBrush)
        painter.drawEllipse(dot)
        words = area.adjusted(27, 0, -8, 0)
        token = "text_caption" if ahead > 0 else "text"
        self._write(
            painter, words, index.data(Qt.ItemDataRole.DisplayRole), "name" if ahead == 0 else "body", token
        )


class _SnapshotRow(_Row):
    """A small picture, the edit's name with its time, and the main figures under it."""

    HEIGHT = 72

    def paint_row(self, painter: QPainter, area: QRectF, index: QModelIndex | QPersistentModelIndex) -> None:
        view, tokens = index.data(_VIEW), tokens_of(self._widget)
        place = QRectF(area.left() + 6, area.top() + 6, 60, area.height() - 12)
        shape = QPainterPath()
        shape.addRoundedRect(place, 5, 5)
        painter.fillPath(shape, QColor(tokens.app))
        if view.picture is not None:
            painter.setClipPath(shape)
            painter.drawImage(place, view.picture, _middle_of(view.picture, place))
            painter.setClipping(False)
        left, width = place.right() + 10, area.right() - place.right() - 16
        lines = [(view.title, "name", "text"), *((each, "caption", "text_quiet") for each in view.figures)]
        time = QFontMetricsF(font("caption", tabular=True)).horizontalAdvance(view.time)
        self._write(
            painter,
            QRectF(area.right() - time - 8, area.top() + 8, time + 8, 18),
            view.time,
            "caption",
            "text_caption",
        )
        for line, (text, role, token) in enumerate(lines):
            room = width - (time + 8 if line == 0 else 0)
            self._write(painter, QRectF(left, area.top() + 7 + 19 * line, room, 19), text, role, token)


def _middle_of(picture: QImage, place: QRectF) -> QRectF:
    """Return the middle part of a picture that has the shape of ``place`` [px]."""
    width, height = float(picture.width()), float(picture.height())
    across, down = (
        min(width, height * place.width() / place.height()),
        min(height, width * place.height() / place.width()),
    )
    return QRectF((width - across) / 2, (height - down) / 2, across, down)
