"""A list whose rows are painted: with a picture, a title with its time, and a few words under it."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from PySide6.QtCore import QModelIndex, QPersistentModelIndex, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QHelpEvent, QImage, QPainter, QPainterPath, QPen
from PySide6.QtWidgets import (
    QAbstractItemView,
    QListWidget,
    QListWidgetItem,
    QStyle,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QWidget,
)

from app.gui.theme.icons import paint_icon
from app.gui.theme.stylesheet import font, tokens_of
from app.gui.widgets.tooltip import show_tip
from app.i18n.catalog import tr

VIEW, PRESENT = Qt.ItemDataRole.UserRole, Qt.ItemDataRole.UserRole + 1
"""Under these roles an item has what is painted of it, and whether it is the one that is shown now."""

_LEFT = Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft


@dataclass(frozen=True, eq=False)
class ThumbnailRow:
    """What a row shows: title, time and a few words, and a picture if there is one.

    ``present`` says that it is what the window shows now; ``mark`` is a tone and an icon before the words.
    """

    title: str
    time: str
    words: tuple[str, ...]
    picture: QImage | None = None
    present: bool = False
    mark: tuple[str, str] | None = None


class ThumbnailList(QListWidget):
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
        item.setData(PRESENT, present)
        if present:
            item.setData(Qt.ItemDataRole.AccessibleTextRole, f"{item.text()}, {tr('shown now')}")
            self.setCurrentItem(item)

    def show_rows(self, views: Sequence[ThumbnailRow]) -> None:
        """Show rows with pictures."""
        self.clear()
        for view in views:
            item = QListWidgetItem(view.title, self)
            item.setData(VIEW, view)
            sentence = "  ".join((view.time, *view.words))
            item.setData(Qt.ItemDataRole.ToolTipRole, f"{view.title}\n{sentence}")
            item.setData(Qt.ItemDataRole.AccessibleDescriptionRole, sentence)
            self.mark(item, view.present)


class RowPainter(QStyledItemDelegate):
    """Paints the ground of a row; what stands on it is painted by those that inherit."""

    HEIGHT = 30

    def sizeHint(self, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex) -> QSize:
        return QSize(100, self.HEIGHT)

    def paint(
        self, painter: QPainter, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex
    ) -> None:
        tokens = tokens_of(self.widget)
        area = QRectF(option.rect).adjusted(1, 1, -1, -1)
        state = option.state
        present = bool(index.data(PRESENT))
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

    def helpEvent(
        self,
        event: QHelpEvent,
        view: QAbstractItemView,
        option: QStyleOptionViewItem,
        index: QModelIndex | QPersistentModelIndex,
    ) -> bool:
        """Show the tooltip of a row."""
        show_tip(event.globalPos(), index.data(Qt.ItemDataRole.ToolTipRole) or "", view.viewport())
        return True

    def paint_row(self, painter: QPainter, area: QRectF, index: QModelIndex | QPersistentModelIndex) -> None:
        """Paint what stands in a row."""
        raise NotImplementedError

    @property
    def widget(self) -> QWidget:
        """Return the widget that the rows are dressed after."""
        widget = self.parent()
        assert isinstance(widget, QWidget)
        return widget

    def write(self, painter: QPainter, area: QRectF, text: str, role: str, token: str) -> None:
        """Write a line of text, cut off where it is too long."""
        painter.setFont(font(role, tabular=role == "caption"))
        painter.setPen(QColor(getattr(tokens_of(self.widget), token)))
        room = round(area.width())
        sentence = painter.fontMetrics().elidedText(text, Qt.TextElideMode.ElideRight, room)
        painter.drawText(area, _LEFT, sentence)


class ThumbnailRowPainter(RowPainter):
    """A small picture, the title with its time, and the words under it."""

    HEIGHT = 72

    def paint_row(self, painter: QPainter, area: QRectF, index: QModelIndex | QPersistentModelIndex) -> None:
        view, tokens = index.data(VIEW), tokens_of(self.widget)
        place = QRectF(area.left() + 6, area.top() + 6, 60, area.height() - 12)
        shape = QPainterPath()
        shape.addRoundedRect(place, 5, 5)
        painter.fillPath(shape, QColor(tokens.app))
        if view.picture is not None:
            painter.setClipPath(shape)
            painter.drawImage(place, view.picture, _middle_of(view.picture, place))
            painter.setClipping(False)
        left, width = place.right() + 10, area.right() - place.right() - 16
        lines = [(view.title, "name", "text"), *((each, "caption", "text_quiet") for each in view.words)]
        time = QFontMetricsF(font("caption", tabular=True)).horizontalAdvance(view.time)
        self.write(
            painter,
            QRectF(area.right() - time - 8, area.top() + 8, time + 8, 18),
            view.time,
            "caption",
            "text_caption",
        )
        for line, (text, role, token) in enumerate(lines):
            room = width - (time + 8 if line == 0 else 0)
            place = QRectF(left, area.top() + 7 + 19 * line, room, 19)
            if line == 1 and view.mark is not None:
                tone, drawing = view.mark
                ink = getattr(tokens, "text_quiet" if tone == "plain" else tone)
                paint_icon(painter, drawing, ink, QRectF(left, place.center().y() - 7, 14, 14))
                place.setLeft(left + 19)
            self.write(painter, place, text, role, token)


def _middle_of(picture: QImage, place: QRectF) -> QRectF:
    """Return the middle part of a picture that has the shape of ``place`` [px]."""
    width, height = float(picture.width()), float(picture.height())
    across, down = (
        min(width, height * place.width() / place.height()),
        min(height, width * place.height() / place.width()),
    )
    return QRectF((width - across) / 2, (height - down) / 2, across, down)
