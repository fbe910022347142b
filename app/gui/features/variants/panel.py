"""The variants of a design in figures, beside each other."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPaintEvent, QShowEvent
from PySide6.QtWidgets import QFrame, QScrollArea, QVBoxLayout, QWidget

from app.gui.theme.stylesheet import font, tokens_of
from app.gui.widgets.basic import EmptyState, button_row, sentence
from app.i18n.catalog import number, tr
from app.presenters.status import TONES
from app.presenters.variants import VariantRow, VariantsView, VariantTexts, VariantValues


class VariantsPanel(QWidget):
    """The table of variants; ``opened`` when it comes to be seen, ``beside_requested`` for their bodies.

    ``copy_requested`` and ``table_requested`` are for the figures as text, on the clipboard or in a file.
    """

    opened = Signal()
    beside_requested = Signal()
    copy_requested = Signal()
    table_requested = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.view: VariantsView | None = None
        column = QVBoxLayout(self)
        column.setContentsMargins(14, 8, 14, 12)
        column.setSpacing(8)
        hint = tr("Choose B or C at the top to create a copy.")
        self._empty = EmptyState("columns", tr("Only one variant."), hint)
        self._table, self._note = _Table(), sentence("", "caption")
        self._area = QScrollArea()
        self._area.setAccessibleName(tr("Variants"))
        self._area.setWidgetResizable(True)
        self._area.setFrameShape(QFrame.Shape.NoFrame)
        self._area.setWidget(self._inside())
        column.addWidget(self._empty)
        column.addWidget(self._area, 1)
        beside = tr("Show all variants side by side with linked cameras")
        copied = tr("Copy the table for a spreadsheet or document")
        written = tr("Export the table as CSV")
        self._buttons = button_row(
            (
                (tr("Side by side"), beside, self.beside_requested),
                (tr("Copy"), copied, self.copy_requested),
                (tr("CSV…"), written, self.table_requested),
            )
        )
        column.addWidget(self._buttons)
        column.addStretch(0)
        self.set_view(None)

    def set_view(self, view: VariantsView | None) -> None:
        """Show these variants, or that there is only one."""
        self.view = view
        self._empty.setVisible(view is None)
        self._area.setVisible(view is not None)
        self._buttons.setVisible(view is not None)
        if view is not None:
            self._table.set_view(view)
            self._note.setText(
                tr("Signed values in small type: difference from {name}.").format(name=view.names[0])
            )

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self.opened.emit()

    def _inside(self) -> QWidget:
        inside = QWidget()
        inside.setProperty("scrolled", "true")
        rows = QVBoxLayout(inside)
        rows.setContentsMargins(0, 0, 0, 0)
        rows.addWidget(self._table)
        self._note.setContentsMargins(4, 6, 4, 4)
        rows.addWidget(self._note)
        rows.addStretch(1)
        return inside


class _Table(QWidget):
    """The variants, painted: a column each; beside a figure what it differs by from the first."""

    HEAD, LABEL, LINE, END = 50, 24, 18, 8

    def __init__(self) -> None:
        super().__init__()
        self._view = VariantsView((), 0, (), (), ())

    def sizeHint(self) -> QSize:
        return QSize(280, self.HEAD + round(sum(map(self._height, self._view.rows))) + 1)

    def minimumSizeHint(self) -> QSize:
        return self.sizeHint()

    def set_view(self, view: VariantsView) -> None:
        """Show these variants."""
        if view != self._view:
            self._view = view
            self.setAccessibleName("; ".join(_spoken(view)))
            self.updateGeometry()
            self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        painter, view, tokens = QPainter(self), self._view, tokens_of(self)
        for place, (name, level) in enumerate(zip(view.names, view.levels, strict=True)):
            worked_on = place == view.shown
            painter.setPen(QColor(tokens.accent if worked_on else tokens.text))
            painter.setFont(font("heading"))
            painter.drawText(self._cell(place, 0, 24), _LEFT, name)
            tone = TONES[level][0] if level else "plain"
            painter.setPen(QColor(tokens.text_caption if tone == "plain" else getattr(tokens, tone)))
            painter.setFont(font("title"))
            painter.drawText(self._cell(place, 24, 20), _LEFT, view.verdicts[place])
        top = float(self.HEAD)
        for row in view.rows:
            self._paint_row(painter, row, top)
            top += self._height(row)

    def _paint_row(self, painter: QPainter, row: VariantRow, top: float) -> None:
        tokens = tokens_of(self)
        painter.fillRect(QRectF(4, top, self.width() - 8, 1), QColor(tokens.line))
        painter.setFont(font("secondary"))
        painter.setPen(QColor(tokens.text_quiet))
        painter.drawText(QRectF(4, top + 3, self.width() - 8, self.LABEL - 3), _LEFT, row.label)
        for line, figure in enumerate(row.figures):
            for place in range(len(self._view.names)):
                cell = self._cell(place, top + self.LABEL + line * self.LINE, self.LINE)
                self._paint_figure(painter, cell, figure, place, first=line == 0)

    def _paint_figure(
        self, painter: QPainter, cell: QRectF, figure: VariantValues | VariantTexts, place: int, first: bool
    ) -> None:
        tokens, type_ = tokens_of(self), font("name" if first else "caption", tabular=True)
        painter.setFont(type_)
        painter.setPen(QColor(tokens.text if first else tokens.text_quiet))
        room = round(cell.width()) - 6
        text = painter.fontMetrics().elidedText(figure.written(place), _ELIDED, room)
        painter.drawText(cell, _LEFT, text)
        apart = figure.apart(place)
        if place and apart is not None and round(apart, figure.digits):
            painter.setFont(font("caption", tabular=True))
            painter.setPen(QColor(tokens.text_caption))
            cell.setLeft(cell.left() + QFontMetricsF(type_).horizontalAdvance(text) + 5)
            painter.drawText(cell, _LEFT, number(apart, figure.digits, signed=True))

    def _height(self, row: VariantRow) -> float:
        return self.LABEL + self.LINE * len(row.figures) + self.END

    def _cell(self, place: int, top: float, height: float) -> QRectF:
        """Return the cell of a variant in a line of the table."""
        room = (self.width() - 8) / max(len(self._view.names), 1)
        return QRectF(4 + place * room, top, room, height)


_ELIDED = Qt.TextElideMode.ElideMiddle  # the width of an elastic stands at its end
_LEFT = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter


def _spoken(view: VariantsView) -> Sequence[str]:
    """Return the table for ears, variant by variant."""
    return [
        ", ".join((name, verdict, *(f"{row.label} {row.figures[0].written(place)}" for row in view.rows)))
        for place, (name, verdict) in enumerate(zip(view.names, view.verdicts, strict=True))
    ]
