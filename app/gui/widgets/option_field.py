"""Field of one setting: two choices side by side, a menu, or a number."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from PySide6.QtCore import QRectF, QSize, Qt, Signal
from PySide6.QtGui import QAction, QActionGroup, QKeyEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QHBoxLayout, QPushButton, QSizePolicy, QStyleOptionButton, QWidget

from app.gui.theme.icons import paint_icon
from app.gui.theme.stylesheet import font, tokens_of
from app.gui.widgets.basic import Segment
from app.gui.widgets.menu import Menu, pull_down
from app.gui.widgets.tooltip import set_tip
from app.gui.widgets.value_edit import InlineEdit, read_number
from app.i18n.catalog import number, tr
from app.presenters.model_options import Amount, Choice, Setting

_BESIDE = 42  # width of margins and arrow beside the text of a menu button [px]
_NARROWEST = 120  # width of one that elides its text [px]


class Field(QWidget):
    """Where one setting is shown and chosen; ``chosen`` tells the new value."""

    chosen = Signal(object)

    def show_value(self, value: Any) -> None:
        """Show a value; nothing is emitted."""
        raise NotImplementedError

    def describe(self, title: str, tip: str) -> None:
        """Set the description for screen readers."""
        set_tip(self, tip)
        self._inside.setAccessibleName(title)
        self._inside.setAccessibleDescription(tip)

    def hold(self, widget: QWidget) -> None:
        """Place the widget that does it inside, and let it have the focus."""
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
        self._menu = Menu(self)
        group = QActionGroup(self._menu)
        self.actions_by_value: dict[Any, QAction] = {}
        for value, words in choice.options:
            action = group.addAction(words)
            action.setCheckable(True)
            action.triggered.connect(lambda _=False, chosen=value: self.chosen.emit(chosen))
            self._menu.addAction(action)
            self.actions_by_value[value] = action
        self._button = OptionCombo()
        self._button.clicked.connect(self._open)
        self.hold(self._button)

    def show_value(self, value: Any) -> None:
        self.actions_by_value[value].setChecked(True)
        self._button.setText(self._choice.words(value))

    def sizeHint(self) -> QSize:
        wide = self._button.fontMetrics().horizontalAdvance
        return QSize(max(wide(words) for _, words in self._choice.options) + _BESIDE, 30)

    def minimumSizeHint(self) -> QSize:
        return self.sizeHint()

    def _open(self) -> None:
        self._menu.popup(self._button.mapToGlobal(self._button.rect().bottomLeft()))


class OptionCombo(QPushButton):
    """A button that opens a menu; one that ``elides`` its text may be narrower than it."""

    def __init__(self, *, elides: Qt.TextElideMode = Qt.TextElideMode.ElideNone) -> None:
        super().__init__()
        self._elides = elides
        if elides != Qt.TextElideMode.ElideNone:
            self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)
        self.setFont(font("body"))
        self.setProperty("kind", "pull")
        self.setCursor(Qt.CursorShape.PointingHandCursor)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Down:
            self.click()  # a button of Qt would go on to the next one
        else:
            super().keyPressEvent(event)

    def minimumSizeHint(self) -> QSize:
        hint = super().minimumSizeHint()
        narrow = self._elides != Qt.TextElideMode.ElideNone
        return QSize(min(hint.width(), _NARROWEST), hint.height()) if narrow else hint

    def initStyleOption(self, option: QStyleOptionButton) -> None:
        super().initStyleOption(option)
        option.text = self.fontMetrics().elidedText(self.text(), self._elides, self.width() - _BESIDE)

    def paintEvent(self, event: QPaintEvent) -> None:
        super().paintEvent(event)
        place = QRectF(self.width() - 24, self.height() / 2 - 6, 12, 12)
        paint_icon(QPainter(self), "caret-down", tokens_of(self).text_quiet, place)


class AmountField(Field):
    """A number with its unit; left empty it is chosen by Busk, where that may be."""

    def __init__(self, amount: Amount) -> None:
        super().__init__()
        self.edit = AmountEdit(amount)
        self.edit.entered.connect(self.chosen)
        self.hold(self.edit)

    def describe(self, title: str, tip: str) -> None:
        self.edit.tip = tip
        super().describe(title, tip)

    def show_value(self, value: Any) -> None:
        self.edit.show_value(value)


class AmountEdit(InlineEdit):
    """The number itself; ``entered`` carries another one that was typed, or None for none."""

    entered = Signal(object)

    def __init__(self, amount: Amount) -> None:
        super().__init__(amount.unit)
        self.tip = ""
        self._amount = amount
        self._value: float | None = None
        self.setFont(font("body", tabular=True))
        self.setAlignment(_RIGHT)
        room = self.fontMetrics().horizontalAdvance(amount.unit) + 6 if amount.unit else 0
        self.setTextMargins(0, 0, room, 0)
        self.setFixedSize(QSize(86, 26))

    def show_value(self, value: float | None) -> None:
        """Show a value, whatever is being typed."""
        self._value = value
        self._show()

    def _words(self) -> str:
        return "" if self._value is None else self._plain(self._value)

    def _read(self, text: str) -> float | None:
        if not text.strip() and self._amount.optional:
            return None
        figure, (low, high) = read_number(text), self._amount.limits
        if figure is None:
            raise ValueError(tr("“{text}” is not a number.").format(text=text))
        if not low <= figure / self._amount.scale <= high:
            sentence = tr("Enter a value from {low} to {high}{unit}.")
            unit = f" {self._amount.unit}" if self._amount.unit else ""
            raise ValueError(sentence.format(low=self._plain(low), high=self._plain(high), unit=unit))
        return figure / self._amount.scale

    def _take(self, value: float | None) -> None:
        # What is shown follows once it is taken: a choice may ask for more, or be refused.
        if value != self._value:
            self.entered.emit(value)

    def _refuse(self, why: str) -> None:
        super()._refuse(why)
        self.setAccessibleDescription(why or self.tip)

    def _plain(self, value: float) -> str:
        return number(self._amount.scale * value, self._amount.digits).replace(",", "")


def field_of(setting: Setting) -> Field:
    """Return the field that suits a setting."""
    if isinstance(setting, Amount):
        return AmountField(setting)
    return SegmentField(setting) if len(setting.options) == 2 else MenuField(setting)


_RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter


class LandmarkCombo(OptionCombo):
    """Shows a landmark and opens the menu of all; ``chosen`` names another one.

    With ``none`` in words none of them can be chosen too: an empty name.
    """

    chosen = Signal(str)

    def __init__(self, title: str, none: str = "") -> None:
        super().__init__()
        self._none = none
        self._titles: Mapping[str, str] = {}
        self._menu = Menu(self)
        self.setAccessibleName(title)
        set_tip(self, tr("Choose a landmark or click it on the body"))
        self.setMinimumHeight(28)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.clicked.connect(lambda: pull_down(self._menu, self))

    def set_marks(self, titles: Mapping[str, str]) -> None:
        """Set the landmarks, by name with their titles."""
        self._titles = titles
        self._menu.clear()
        group = QActionGroup(self._menu)
        offered = {"": self._none, **titles} if self._none else titles
        for name, title in offered.items():
            action = group.addAction(title)
            action.setCheckable(True)
            action.setData(name)
            action.triggered.connect(lambda _=False, name=name: self.chosen.emit(name))
            self._menu.addAction(action)

    def show_mark(self, name: str) -> None:
        """Show a landmark, or that there is none yet."""
        title = self._titles.get(name, self._none or tr("not chosen"))
        self.setText(title)
        self.setAccessibleDescription(title)
        for action in self._menu.actions():
            action.setChecked(action.data() == name)
