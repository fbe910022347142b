"""Small parts of a line's row: the chip in its colour, its name, its stiffness, the palette."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
# ruff: noqa: N802 - Qt names its events and says what they are

from __future__ import annotations

from PySide6.QtCore import QRectF, QSize, Qt, Signal
from PySide6.QtGui import (
    QColor,
    QIcon,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QPixmap,
    QResizeEvent,
)
from PySide6.QtWidgets import QLineEdit, QPushButton, QSizePolicy, QWidget

from app.gui.theme.icons import paint_icon
from app.gui.theme.stylesheet import font, tokens_of
from app.gui.widgets.basic import ElidedLabel
from app.gui.widgets.menu import Menu
from app.gui.widgets.tooltip import set_tip
from app.gui.widgets.value_edit import InlineEdit, read_number
from app.i18n.catalog import number, tr
from app.rendering.palette import LINE_COLORS
from core.document.lines import LONGEST_TITLE
from core.mechanics.options import RANGES


class LineChip(QWidget):
    """The colour of a line and, by its height, the width of its band; an outline only while it is hidden."""

    def __init__(self) -> None:
        super().__init__()
        self._color, self._width, self._filled = "", 12.0, True
        self.setFixedSize(QSize(14, 18))

    def show_line(self, color: str, width_mm: float, filled: bool) -> None:
        """Show a line's colour and the width of its band, filled or as an outline."""
        if (color, width_mm, filled) != (self._color, self._width, self._filled):
            self._color, self._width, self._filled = color, width_mm, filled
            self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        rim = QColor("#FFFFFF")
        rim.setAlpha(97 if tokens_of(self).dark else 0)
        outline = QColor(self._color).lighter(150) if tokens_of(self).dark else QColor(self._color)
        painter.setPen(QPen(rim, 1) if self._filled else QPen(outline, 1.5))
        painter.setBrush(QColor(self._color) if self._filled else Qt.BrushStyle.NoBrush)
        high = min(max(self._width / 2.0, 4.0), 16.0)
        round_ = min(3.0, high / 2.0)
        painter.drawRoundedRect(QRectF(0.75, (18.0 - high) / 2.0, 12.5, high), round_, round_)


class SideMark(QWidget):
    """The side of a line that is set apart from its partner: a letter in a small frame."""

    def __init__(self) -> None:
        super().__init__()
        self._letter = ""
        self.setFixedSize(QSize(17, 16))
        set_tip(self, tr("Unlinked: left and right have separate lengths"))

    def show_side(self, side: str) -> None:
        """Show "left" or "right"; anything else is no side, and nothing is shown."""
        self._letter = {"left": tr("L"), "right": tr("R")}.get(side, "")
        self.setAccessibleName({"left": tr("left"), "right": tr("right")}.get(side, ""))
        self.setVisible(bool(self._letter))
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens, painter = tokens_of(self), QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QColor(tokens.control))
        painter.drawRoundedRect(QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5), 4, 4)
        painter.setPen(QColor(tokens.text))
        painter.setFont(font("caption"))
        painter.drawText(self.rect(), Qt.AlignmentFlag.AlignCenter, self._letter)


LEAST = 32
"""Room that a title keeps where there is little [px]."""


class LineTitle(ElidedLabel):
    """The name of a line, where there is no room for it its beginning; ``renamed`` when another was typed.

    A double click, or ``begin``, opens it for typing; ``closed`` when that is over.
    """

    renamed = Signal(str)
    closed = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.setFont(font("name"))
        self.setProperty("role", "name")
        self.setMinimumWidth(LEAST)
        self.setSizePolicy(QSizePolicy.Policy.Maximum, QSizePolicy.Policy.Preferred)
        self._editor = _Editor(self)
        self._editor.hide()
        self._editor.editingFinished.connect(self._end)
        self._editor.closed.connect(self._leave)

    def begin(self) -> None:
        """Let another name be typed."""
        self._editor.setText(self.text())
        self._fit()
        self._editor.show()
        self._editor.selectAll()
        self._editor.setFocus(Qt.FocusReason.OtherFocusReason)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        self.begin()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._fit()

    def _fit(self) -> None:
        """Lay the editor over the row's head: a long name needs more room than it has while it stands."""
        row = self.parentWidget()
        if row is not None:
            self._editor.setParent(row)
            self._editor.setGeometry(self.x() - 7, self.y() + (self.height() - 26) // 2, 170, 26)

    def _end(self) -> None:
        if self._editor.isHidden():
            return
        self._leave()
        title = self._editor.text().strip()
        if title != self.text():
            self.renamed.emit(title)

    def _leave(self) -> None:
        was_there = self._editor.hasFocus()
        self._editor.hide()
        if was_there:
            self.closed.emit()


class _Editor(QLineEdit):
    """A line's name while it is typed; ``closed`` at Esc."""

    closed = Signal()

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setMaxLength(LONGEST_TITLE)
        self.setAccessibleName(tr("Line name"))
        set_tip(self, tr("Enter saves the name, Esc cancels, an empty name restores the default."))

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Escape:
            self.closed.emit()
            return
        super().keyPressEvent(event)
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            event.accept()  # the list would open the length for typing


class StiffnessField(InlineEdit):
    """The stiffness of one line; nothing typed means: as the model. ``entered`` carries a number or None."""

    entered = Signal(object)

    def __init__(self) -> None:
        super().__init__()
        self._stiffness: float | None = None
        self.setFont(font("body", tabular=True))
        self.setFixedWidth(104)
        low, high = RANGES["line_stiffness"]
        tip = tr(
            "Set the stiffness of this line, {low} to {high} times that of the skin at a point. "
            "Leave empty for the model value."
        )
        set_tip(self, tip.format(low=low, high=number(high, 0)))
        self.name_line("")

    def name_line(self, title: str) -> None:
        """Set the line name for screen readers."""
        self.setAccessibleName(tr("{line}: stiffness").format(line=title or tr("Line")))

    def show_stiffness(self, own: float | None, usual: float) -> None:
        """Show a line's own stiffness [1], or faintly the usual one."""
        self.setPlaceholderText(tr("model: {value}").format(value=_plain(usual)))
        self._stiffness = own
        self._follow()

    def _words(self) -> str:
        return "" if self._stiffness is None else _plain(self._stiffness)

    def _read(self, text: str) -> float | None:
        plain, (low, high) = text.strip().replace(",", "."), RANGES["line_stiffness"]
        stiffness = (read_number(plain) or 0.0) if plain else None
        if stiffness is not None and not low <= stiffness <= high:
            sentence = tr(
                "Enter a stiffness from {low} to {high}, or leave the field empty for the model value."
            )
            raise ValueError(sentence.format(low=low, high=number(high, 0)))
        return stiffness

    def _take(self, value: float | None) -> None:
        if value != self._stiffness:
            self._stiffness = value
            self.entered.emit(value)


def _plain(value: float) -> str:
    return f"{value:g}"


class PaletteMenu(Menu):
    """The colours that a line can have; ``chosen`` carries one, or an empty text for the usual one."""

    chosen = Signal(str)

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        names = (
            tr("Plum"),
            tr("Rose"),
            tr("Teal"),
            tr("Wine"),
            tr("Amber"),
            tr("Lavender"),
            tr("Sky"),
            tr("Olive"),
            tr("Rust"),
        )
        for colour, name in zip(LINE_COLORS, names, strict=True):
            self.addAction(_swatch(colour), name, lambda colour=colour: self.chosen.emit(colour))
        self.addSeparator()
        self.addAction(tr("Default colour"), lambda: self.chosen.emit(""))


def _swatch(colour: str) -> QIcon:
    picture = QPixmap(32, 32)
    picture.fill(Qt.GlobalColor.transparent)
    painter = QPainter(picture)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(QColor(colour))
    painter.drawRoundedRect(QRectF(3, 6, 26, 20), 5, 5)
    painter.end()
    return QIcon(picture)


class ElasticButton(QPushButton):
    """A word that opens the choice of elastics; of one that does not fit the width at its end stays."""

    def __init__(self) -> None:
        super().__init__()
        self.setFont(font("secondary"))
        self.setProperty("kind", "pick")
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.setFixedHeight(22)
        self._elastic = ""

    def show_elastic(self, line: str, elastic: str) -> None:
        """Show what a line is made of, or that it can be chosen."""
        self._elastic = elastic or tr("Choose elastic…")
        set_tip(self, elastic or tr("Choose an elastic to compute the cut length"))
        self.setAccessibleName(tr("{line}: elastic, {elastic}").format(line=line, elastic=self._elastic))
        self.update()

    def sizeHint(self) -> QSize:
        """Return the size of the text."""
        return QSize(self.fontMetrics().horizontalAdvance(self._elastic) + 26, 24)

    @property
    def words(self) -> str:
        """Return the text of the button."""
        return self._elastic

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint ground and ring as every button, and the words with their caret."""
        super().paintEvent(event)
        tokens, painter = tokens_of(self), QPainter(self)
        painter.setFont(self.font())
        painter.setPen(QColor(tokens.text_quiet if self.isEnabled() else tokens.text_caption))
        words = self.fontMetrics().elidedText(self._elastic, Qt.TextElideMode.ElideMiddle, self.width() - 24)
        painter.drawText(QRectF(5, 0, self.width() - 22, self.height()), Qt.AlignmentFlag.AlignVCenter, words)
        end = 5 + self.fontMetrics().horizontalAdvance(words) + 4
        paint_icon(painter, "caret-down", tokens.text_caption, QRectF(end, self.height() / 2 - 5, 10, 10))
