"""What stands over the list of lines: the set that is worn, and the tools for new lines."""

# ruff: noqa: N802 - Qt names its events and says what they are
from __future__ import annotations

from PySide6.QtCore import QRectF, Qt, Signal
from PySide6.QtGui import QKeyEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QHBoxLayout, QPushButton, QVBoxLayout, QWidget

from app.gui.theme.icons import paint_icon
from app.gui.theme.stylesheet import font, tokens_of
from app.gui.widgets.basic import ToolButton, button, sentence
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr

_WIDEST = 170  # room for the title of a preset [px]


class LinesHeader(QWidget):
    """The pull-down of presets, with what the worn one leaves out, and three tools.

    Signals: ``presets_requested``, ``reset_requested``, ``draw_requested``, ``add_requested``.
    """

    presets_requested = Signal()
    reset_requested = Signal()
    draw_requested = Signal()
    add_requested = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.presets = _PullDown()
        self.presets.clicked.connect(self.presets_requested)
        self.reset = ToolButton(
            "arrow-counter-clockwise",
            tr("Set all lines back to their length at rest, but for locked ones (Ctrl+R)"),
        )
        self.draw = _in_words(tr("Draw"), tr("Draw a line on the body (N)"))
        self.add = _in_words(tr("Add"), tr("Add lines: a pair, or through control points"))
        self.note = sentence("", "caption")
        for tool, signal in (
            (self.reset, self.reset_requested),
            (self.draw, self.draw_requested),
            (self.add, self.add_requested),
        ):
            tool.clicked.connect(signal)
        column, row = QVBoxLayout(self), QHBoxLayout()
        column.setContentsMargins(10, 8, 10, 4)
        column.setSpacing(2)
        for part in (self.presets, self.reset, self.draw, self.add):
            row.addWidget(part)
        row.insertStretch(1)
        row.setSpacing(0)
        column.addLayout(row)
        column.addWidget(self.note)
        self.note.setContentsMargins(8, 0, 4, 4)
        self.show_preset("", "")

    def show_preset(self, title: str, leaves_out: str) -> None:
        """Show which preset is worn, if any, and what of the garment it leaves out."""
        self.presets.setText(title or tr("Presets"))
        self.note.setText(leaves_out)
        self.note.setVisible(bool(leaves_out))


def _in_words(text: str, tip: str) -> QPushButton:
    result = button(text, "word")
    result.setFixedWidth(result.fontMetrics().horizontalAdvance(text) + 20)
    result.setFocusPolicy(Qt.FocusPolicy.TabFocus)
    set_tip(result, tip)
    result.setAccessibleName(tip)
    return result


class _PullDown(QPushButton):
    """A button that opens the menu of presets."""

    def __init__(self) -> None:
        super().__init__()
        self.setProperty("kind", "heading")
        self.setFont(font("name"))
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        set_tip(self, tr("Sets of lines to begin with, and your own"))

    def setText(self, text: str) -> None:
        """Show a title, shortened where there is no room for it."""
        shown = self.fontMetrics().elidedText(text, Qt.TextElideMode.ElideRight, _WIDEST)
        super().setText(shown)
        self.setFixedWidth(self.fontMetrics().horizontalAdvance(shown) + 36)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Down:
            self.click()  # a button of Qt would go on to the next one
        else:
            super().keyPressEvent(event)

    def paintEvent(self, event: QPaintEvent) -> None:
        super().paintEvent(event)
        place = QRectF(self.width() - 20, self.height() / 2 - 5, 10, 10)
        paint_icon(QPainter(self), "caret-down", tokens_of(self).text_quiet, place)
