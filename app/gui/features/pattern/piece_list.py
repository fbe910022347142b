"""List of pieces: name, cloth, and the strain that the cloth has to take up."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QKeyEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QAbstractButton, QVBoxLayout, QWidget

from app.gui.theme.stylesheet import font, tokens_of
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import number, tr
from app.presenters.pattern import PieceRow

_HEIGHT = 36  # of a row [px]
_APART = 1

ROW = _HEIGHT + _APART
"""From one row to the next [px]."""
_LEFT = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
_RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter


class PieceButton(QAbstractButton):
    """One piece: its title over its cloth, and its strain of what the cloth takes up."""

    def __init__(self) -> None:
        super().__init__()
        self.row: PieceRow | None = None
        self._faint = False
        self.setCheckable(True)
        self.setAutoExclusive(True)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.setAttribute(Qt.WidgetAttribute.WA_Hover)
        self.setFixedHeight(_HEIGHT)

    def sizeHint(self) -> QSize:
        return QSize(280, _HEIGHT)

    def show_row(self, row: PieceRow, faint: bool) -> None:
        """Show a piece, ``faint`` if it is of a former shape."""
        self.row, self._faint = row, faint
        self.setText(row.title)
        set_tip(self, row.reason or row.cloth)
        self.setAccessibleName(f"{row.title}, {row.cloth}")
        self.setAccessibleDescription(row.reason or self._strain())
        self.update()

    def _strain(self) -> str:
        assert self.row is not None
        return tr("{strain} of {limit} %").format(
            strain=number(self.row.strain_percent, 1), limit=number(self.row.limit_percent, 0)
        )

    def paintEvent(self, event: QPaintEvent) -> None:
        if self.row is None:
            return
        tokens, painter = tokens_of(self), QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setOpacity(0.5 if self._faint else 1.0)
        if self.isChecked() or self.underMouse() or self.hasFocus():
            painter.setPen(QPen(QColor(tokens.accent), 2) if self.hasFocus() else Qt.PenStyle.NoPen)
            painter.setBrush(QColor(tokens.selected if self.isChecked() else tokens.hover))
            painter.drawRoundedRect(QRectF(self.rect()).adjusted(1, 1, -1, -1), 7, 7)
        whole = QRectF(self.rect()).adjusted(10, 2, -10, -2)
        wide = 92.0
        painter.setFont(font("body"))
        painter.setPen(QColor(tokens.text))
        words = QRectF(whole.left(), whole.top(), whole.width() - wide, 17)
        title = painter.fontMetrics().elidedText(self.text(), Qt.TextElideMode.ElideRight, int(words.width()))
        painter.drawText(words, _LEFT, title)
        painter.setFont(font("caption"))
        painter.setPen(QColor(tokens.text_caption))
        below = words.translated(0, 16)
        cloth = painter.fontMetrics().elidedText(
            self.row.cloth, Qt.TextElideMode.ElideRight, int(below.width())
        )
        painter.drawText(below, _LEFT, cloth)
        painter.setFont(font("body" if self.row.fits else "name", tabular=True))
        painter.setPen(QColor(tokens.text if self.row.fits else tokens.warn))
        painter.drawText(whole, _RIGHT, self._strain())


class PieceList(QWidget):
    """The pieces one below the other; ``chosen`` names the one that is clicked."""

    chosen = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.setSpacing(_APART)
        self.buttons: list[PieceButton] = []
        self.selected = ""

    def show_rows(self, rows: Sequence[PieceRow], faint: bool, selected: str) -> None:
        """Show these pieces; nothing is emitted."""
        while len(self.buttons) < len(rows):
            made = PieceButton()
            made.clicked.connect(lambda _=False, made=made: self.chosen.emit(made.row.name))
            self.buttons.append(made)
            self._column.addWidget(made)
        for place, each in enumerate(self.buttons):
            each.setVisible(place < len(rows))
            if place < len(rows):
                each.show_row(rows[place], faint)
        self.select(selected)

    def select(self, name: str) -> None:
        """Show which piece is selected, or none."""
        self.selected = name
        for each in self.buttons:
            each.setAutoExclusive(False)
            each.setChecked(each.row is not None and each.row.name == name)
            each.setAutoExclusive(True)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        event.ignore()
