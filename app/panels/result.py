"""What the garment does to the measures of the body: before, after and the change."""

# ruff: noqa: N802 - Qt names its events and says what they are
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent
from PySide6.QtWidgets import QFrame, QScrollArea, QVBoxLayout, QWidget

from app.parts import EmptyState, sentence
from app.theme import font, label, tokens_of
from app.words import number, tr


@dataclass(frozen=True)
class MeasureView:
    """One measure before and after, in ``unit``; ``after`` is None before a run."""

    label: str
    unit: str
    before: float
    after: float | None


class ResultPanel(QWidget):
    """The table of measures."""

    def __init__(self) -> None:
        super().__init__()
        column = QVBoxLayout(self)
        column.setContentsMargins(14, 14, 14, 0)
        column.setSpacing(4)
        heading = label(tr("Result"), "heading")
        heading.setContentsMargins(4, 0, 0, 0)
        self._empty = EmptyState(
            "result", tr("Nothing solved yet"), tr("Set a line shorter and see it here.")
        )
        self._table = _Table()
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
        self._area.setWidgetResizable(True)
        self._area.setFrameShape(QFrame.Shape.NoFrame)
        self._area.setWidget(inside)
        for each in (heading, self._empty):
            column.addWidget(each)
        column.addWidget(self._area, 1)
        column.addStretch(0)
        self.set_rows([])

    def set_rows(self, rows: Sequence[MeasureView]) -> None:
        """Show these measures, or that there is none."""
        self._empty.setVisible(not rows)
        self._area.setVisible(bool(rows))
        self._table.set_rows(rows)


class _Table(QWidget):
    """The rows, painted: name, before, after, change and a bar about a middle line."""

    ROW, BAR = 30, 44

    def __init__(self) -> None:
        super().__init__()
        self._rows: tuple[MeasureView, ...] = ()

    def sizeHint(self) -> QSize:
        return QSize(300, self.ROW * (len(self._rows) + 1) + 4)

    def minimumSizeHint(self) -> QSize:
        return self.sizeHint()

    def set_rows(self, rows: Sequence[MeasureView]) -> None:
        """Show these measures."""
        self._rows = tuple(rows)
        self.setAccessibleName("; ".join(_spoken(each) for each in rows))
        self.updateGeometry()
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens = tokens_of(self)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        columns = self._columns()
        painter.setPen(QColor(tokens.text_caption))
        painter.setFont(font("caption"))
        for at, title in zip(columns[1:], (tr("Before"), tr("After"), tr("Change")), strict=False):
            painter.drawText(at, _RIGHT, title)
        changes = [_change(each) for each in self._rows]
        for place, (row, change) in enumerate(zip(self._rows, changes, strict=True), start=1):
            top = place * self.ROW
            painter.fillRect(QRectF(4, top, self.width() - 8, 1), QColor(tokens.line))
            cells = [each.translated(0, top) for each in columns]
            painter.setFont(font("body"))
            painter.setPen(QColor(tokens.text))
            painter.drawText(cells[0], _LEFT, row.label)
            painter.setPen(QColor(tokens.text_caption))
            painter.drawText(cells[1], _RIGHT, _written(row.before, row.unit))
            if row.after is None or change is None:
                continue
            painter.setPen(QColor(tokens.text_quiet))
            painter.drawText(cells[3], _RIGHT, number(change, _digits(row.unit), signed=True))
            painter.setFont(font("name"))
            painter.setPen(QColor(tokens.text))
            painter.drawText(cells[2], _RIGHT, _written(row.after, row.unit))
            self._paint_bar(painter, cells[4], change / _full_bar(row.unit))

    def _columns(self) -> list[QRectF]:
        """Return the cells of the head row: name, before, after, change, bar."""
        right = self.width() - 4.0
        cells: list[QRectF] = []
        for width, gap in ((self.BAR, 8), (46, 4), (62, 4), (62, 4)):
            cells.insert(0, QRectF(right - width, 0, width, self.ROW))
            right -= width + gap
        return [QRectF(4, 0, right - 4, self.ROW), *cells]

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


def _change(row: MeasureView) -> float | None:
    return None if row.after is None else row.after - row.before


def _digits(unit: str) -> int:
    return 0 if unit == "ml" else 1


def _written(value: float, unit: str) -> str:
    return f"{number(value, _digits(unit))} {unit}"


def _full_bar(unit: str) -> float:
    """Return the change that fills half a bar, in ``unit``."""
    return {"ml": 100.0, "mm": 30.0}.get(unit, 10.0)


def _spoken(row: MeasureView) -> str:
    after = "" if row.after is None else f" → {_written(row.after, row.unit)}"
    return f"{row.label}: {_written(row.before, row.unit)}{after}"
