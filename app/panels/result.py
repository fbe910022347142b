"""What the garment does to the measures of the body: before, after and the change."""

# ruff: noqa: N802 - Qt names its events and says what they are
from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

from PySide6.QtCore import QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QShowEvent
from PySide6.QtWidgets import QFrame, QHBoxLayout, QScrollArea, QVBoxLayout, QWidget

from app.dress.parts import EmptyState, button, sentence
from app.dress.theme import font, set_tag, tokens_of
from app.wording.words import number, tr


@dataclass(frozen=True)
class MeasureView:
    """One measure before and after, in ``unit``; ``after`` is None before a run.

    ``reference`` says from where it is counted.
    """

    label: str
    unit: str
    before: float
    after: float | None
    reference: str = ""

    @property
    def change(self) -> float | None:
        """By how much it grew, if that is known."""
        return None if self.after is None else self.after - self.before


class ResultPanel(QWidget):
    """The table of measures; ``opened`` when it comes to be seen, and what it shows has to be new.

    ``copy_asked`` and ``table_asked`` are for the measures as text, on the clipboard or in a file.
    """

    opened = Signal()
    copy_asked = Signal()
    table_asked = Signal()

    def __init__(self) -> None:
        super().__init__()
        column = QVBoxLayout(self)
        column.setContentsMargins(14, 8, 14, 12)
        column.setSpacing(4)
        self._empty = EmptyState(
            "result", tr("Nothing solved yet"), tr("Set a line shorter and see it here.")
        )
        self._table, self._doubt = _Table(), sentence("", "secondary")
        self._doubt.setContentsMargins(4, 2, 4, 4)
        set_tag(self._doubt, "tone", "warn")
        self._note = sentence(tr("The bars show the change: blue less, orange more."), "caption")
        self._note.setContentsMargins(4, 8, 4, 8)
        inside = QWidget()
        inside.setProperty("scrolled", "true")
        rows = QVBoxLayout(inside)
        rows.setContentsMargins(0, 0, 0, 0)
        rows.addWidget(self._table)
        rows.addWidget(self._note)
        rows.addStretch(1)
        self._area = QScrollArea()
        self._area.setAccessibleName(tr("Measures"))
        self._area.setWidgetResizable(True)
        self._area.setFrameShape(QFrame.Shape.NoFrame)
        self._area.setWidget(inside)
        for each in (self._empty, self._doubt):
            column.addWidget(each)
        column.addWidget(self._area, 1)
        column.addWidget(self._make_buttons())
        column.addStretch(0)
        self.set_rows([])

    def set_rows(self, rows: Sequence[MeasureView], doubt: str = "") -> None:
        """Show these measures, or that there is none; ``doubt`` says why they are no result."""
        for part in (self._area, self._buttons):
            part.setVisible(bool(rows))
        self._empty.setVisible(not rows)
        self._doubt.setText(doubt)
        self._doubt.setVisible(bool(doubt))
        self._table.set_rows(rows)

    @property
    def rows(self) -> tuple[MeasureView, ...]:
        """The measures that are shown."""
        return self._table.rows

    @property
    def doubt(self) -> str:
        """Why the measures are no result, or nothing."""
        return self._doubt.text()

    def _make_buttons(self) -> QWidget:
        self._buttons = QWidget()
        row = QHBoxLayout(self._buttons)
        row.setContentsMargins(0, 4, 0, 0)
        row.setSpacing(6)
        for text, tip, signal in (
            (tr("Copy"), tr("Copy the table, to paste into a spreadsheet or a letter"), self.copy_asked),
            (tr("CSV…"), tr("Write the table to a file (CSV)"), self.table_asked),
        ):
            press = button(text)
            press.setToolTip(tip)
            press.clicked.connect(signal)
            row.addWidget(press)
        row.addStretch(1)
        return self._buttons

    def showEvent(self, event: QShowEvent) -> None:
        """Ask for the measures of now."""
        self.opened.emit()


class _Table(QWidget):
    """The measures, painted: a name, under it before, after, change and a bar about a middle line."""

    HEAD, ROW, MORE, BAR = 26, 52, 15, 44

    def __init__(self) -> None:
        super().__init__()
        self.rows: tuple[MeasureView, ...] = ()

    def sizeHint(self) -> QSize:
        return QSize(280, self.HEAD + sum(map(self._height, self.rows)) + 1)

    def minimumSizeHint(self) -> QSize:
        return self.sizeHint()

    def set_rows(self, rows: Sequence[MeasureView]) -> None:
        """Show these measures."""
        self.rows = tuple(rows)
        self.setAccessibleName("; ".join(_spoken(each) for each in rows))
        self.updateGeometry()
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens = tokens_of(self)
        painter = QPainter(self)
        painter.setPen(QColor(tokens.text_caption))
        painter.setFont(font("caption"))
        titles = (tr("Before"), tr("After"), tr("Change"))
        for cell, title in zip(self._cells(0, self.HEAD), titles, strict=False):
            painter.drawText(cell, _RIGHT, title)
        top = self.HEAD
        for row in self.rows:
            self._paint_row(painter, row, top)
            top += self._height(row)

    def _paint_row(self, painter: QPainter, row: MeasureView, top: float) -> None:
        tokens = tokens_of(self)
        painter.fillRect(QRectF(4, top, self.width() - 8, 1), QColor(tokens.line))
        before, after, change, bar = self._cells(top + self._height(row) - 28, 24)
        painter.setFont(font("body"))
        painter.setPen(QColor(tokens.text))
        painter.drawText(QRectF(4, top + 4, self.width() - 8, 22), _LEFT, row.label)
        painter.setFont(font("caption"))
        painter.setPen(QColor(tokens.text_caption))
        painter.drawText(QRectF(4, top + 23, self.width() - 8, 18), _LEFT, row.reference)
        painter.setFont(font("body", tabular=True))
        painter.setPen(QColor(tokens.text_caption))
        painter.drawText(before, _RIGHT, _written(row.before, row.unit))
        if row.after is None or row.change is None:
            return
        painter.setPen(QColor(tokens.text_quiet))
        painter.drawText(change, _RIGHT, _written(row.change, row.unit, signed=True))
        painter.setFont(font("name", tabular=True))
        painter.setPen(QColor(tokens.text))
        painter.drawText(after, _RIGHT, _written(row.after, row.unit))
        self._paint_bar(painter, bar, row.change / _full_bar(row.unit))

    def _height(self, row: MeasureView) -> int:
        return self.ROW + (self.MORE if row.reference else 0)

    def _cells(self, top: float, height: float) -> tuple[QRectF, QRectF, QRectF, QRectF]:
        """Return the cells before, after, change and bar of a line of the table."""
        room = self.width() - 8 - self.BAR - 14
        edges = [4.0, 4 + 0.32 * room, 4 + 0.66 * room, 4.0 + room]
        before, after, change = (
            QRectF(left, top, right - left, height) for left, right in itertools.pairwise(edges)
        )
        return before, after, change, QRectF(edges[-1] + 14, top, self.BAR, height)

    def _paint_bar(self, painter: QPainter, cell: QRectF, share: float) -> None:
        tokens = tokens_of(self)
        middle = cell.center().x()
        length = min(max(share, -1.0), 1.0) * self.BAR / 2
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(tokens.more if share > 0 else tokens.less))
        painter.drawRect(QRectF(min(middle, middle + length), cell.center().y() - 3, abs(length), 6))
        painter.fillRect(QRectF(middle - 0.5, cell.center().y() - 7, 1, 14), QColor(tokens.control))


_LEFT = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
_RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter


def _digits(unit: str) -> int:
    return 0 if unit == "ml" else 1


def _written(value: float, unit: str, signed: bool = False) -> str:
    return f"{number(value, _digits(unit), signed)} {unit}"


def _full_bar(unit: str) -> float:
    """Return the change that fills half a bar, in ``unit``."""
    return {"ml": 100.0, "mm": 30.0}.get(unit, 10.0)


def _spoken(row: MeasureView) -> str:
    after = "" if row.after is None else f" → {_written(row.after, row.unit)}"
    return f"{row.label}: {_written(row.before, row.unit)}{after} {row.reference}".rstrip()
