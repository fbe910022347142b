"""Where one setting is shown and chosen: two answers side by side, a menu, or a number."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

import unicodedata
from typing import Any

from PySide6.QtCore import QRectF, QSize, Qt, Signal
from PySide6.QtGui import QAction, QActionGroup, QColor, QKeyEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QHBoxLayout, QLineEdit, QMenu, QPushButton, QSizePolicy, QWidget

from app.dress.icons import paint_icon
from app.dress.parts import Segment
from app.dress.theme import font, tokens_of
from app.wording.model_choices import Amount, Choice, Setting
from app.wording.words import number


class Field(QWidget):
    """Where one setting is shown and chosen; ``chosen`` tells the new value."""

    chosen = Signal(object)

    def show_value(self, value: Any) -> None:
        """Show a value; nothing is emitted."""
        raise NotImplementedError

    def describe(self, title: str, tip: str) -> None:
        """Tell those who do not see the title what this is."""
        self.setToolTip(f"<p>{tip}</p>")
        self._inside.setAccessibleName(title)
        self._inside.setAccessibleDescription(tip)

    def hold(self, widget: QWidget) -> None:
        """Put the widget that does it inside, and let it have the focus."""
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.addWidget(widget)
        self._inside = widget
        self.setFocusProxy(widget)
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)


class SegmentField(Field):
    """Two short answers side by side."""

    def __init__(self, choice: Choice) -> None:
        super().__init__()
        self._values = {str(place): value for place, (value, _) in enumerate(choice.options)}
        titles = (words for _, words in choice.options)
        self.segment = Segment(tuple(zip(self._values, titles, strict=True)), small=True)
        self.segment.chosen.connect(lambda name: self.chosen.emit(self._values[name]))
        self.hold(self.segment)

    def show_value(self, value: Any) -> None:
        names = [name for name, each in self._values.items() if each == value]
        self.segment.set_choice(names[0] if names else list(self._values)[-1])


class MenuField(Field):
    """Several answers: the one that is on, the others in a menu."""

    def __init__(self, choice: Choice) -> None:
        super().__init__()
        self._choice = choice
        self._menu = QMenu(self)
        group = QActionGroup(self._menu)
        self.actions_by_value: dict[Any, QAction] = {}
        for value, words in choice.options:
            action = group.addAction(words)
            action.setCheckable(True)
            action.triggered.connect(lambda _=False, chosen=value: self.chosen.emit(chosen))
            self._menu.addAction(action)
            self.actions_by_value[value] = action
        self._button = PullDown()
        self._button.clicked.connect(self._open)
        self.hold(self._button)

    def show_value(self, value: Any) -> None:
        self.actions_by_value[value].setChecked(True)
        self._button.setText(self._choice.words(value))

    def sizeHint(self) -> QSize:
        wide = self._button.fontMetrics().horizontalAdvance
        return QSize(max(wide(words) for _, words in self._choice.options) + 42, 30)

    def minimumSizeHint(self) -> QSize:
        return self.sizeHint()

    def _open(self) -> None:
        self._menu.popup(self._button.mapToGlobal(self._button.rect().bottomLeft()))


class PullDown(QPushButton):
    """A button that opens a menu."""

    def __init__(self) -> None:
        super().__init__()
        self.setFont(font("body"))
        self.setProperty("kind", "pull")
        self.setCursor(Qt.CursorShape.PointingHandCursor)

    def paintEvent(self, event: QPaintEvent) -> None:
        super().paintEvent(event)
        place = QRectF(self.width() - 24, self.height() / 2 - 6, 12, 12)
        paint_icon(QPainter(self), "caret-down", tokens_of(self).text_quiet, place)


class AmountField(Field):
    """A number with its unit; left empty it is chosen by Busk, where that may be."""

    def __init__(self, amount: Amount) -> None:
        super().__init__()
        self._amount = amount
        self._value: float | None = None
        self.edit = _NumberEdit(amount.unit)
        self.edit.editingFinished.connect(self._enter)
        self.edit.given_up.connect(lambda: self.show_value(self._value))
        self.hold(self.edit)

    def show_value(self, value: Any) -> None:
        self._value = value
        shown = "" if value is None else number(self._amount.scale * value, self._amount.digits)
        self.edit.setText(shown.replace(",", ""))
        self.edit.setModified(False)

    def _enter(self) -> None:
        if not self.edit.isModified():
            return
        self.edit.setModified(False)
        text = unicodedata.normalize("NFKC", self.edit.text()).replace(",", ".").strip("%× ")
        try:
            value = float(text) / self._amount.scale if text or self._amount.key != "gain" else None
        except ValueError:
            value = self._value
        shown = self._value
        self.show_value(shown)
        if value != shown:
            self.chosen.emit(value)


class _NumberEdit(QLineEdit):
    """A number that reads as text with its unit; ``given_up`` at Esc."""

    given_up = Signal()

    def __init__(self, unit: str) -> None:
        super().__init__()
        self._unit = unit
        self.setFont(font("body", tabular=True))
        self.setAlignment(_RIGHT)
        room = self.fontMetrics().horizontalAdvance(unit) + 6 if unit else 0
        self.setTextMargins(0, 0, room, 0)
        self.setFixedSize(QSize(86, 26))

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Escape:
            self.given_up.emit()
        else:
            super().keyPressEvent(event)

    def paintEvent(self, event: QPaintEvent) -> None:
        super().paintEvent(event)
        painter = QPainter(self)
        painter.setFont(font("caption"))
        painter.setPen(QColor(tokens_of(self).text_caption))
        painter.drawText(self.rect().adjusted(0, 1, -8, 0), _RIGHT, self._unit)


def field_of(setting: Setting) -> Field:
    """Return the field that suits a setting."""
    if isinstance(setting, Amount):
        return AmountField(setting)
    return SegmentField(setting) if len(setting.options) == 2 else MenuField(setting)


_RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
