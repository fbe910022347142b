"""A row of the card in which the result is asked for: one wish, typed over, and taken away by its cross."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

from PySide6.QtCore import QRegularExpression, Qt, Signal
from PySide6.QtGui import QKeyEvent, QRegularExpressionValidator
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from app.gui.theme.stylesheet import font, label, set_tag
from app.gui.widgets.basic import Segment, ToolButton, sentence
from app.gui.widgets.menu import Menu, pull_down
from app.gui.widgets.option_field import OptionCombo
from app.gui.widgets.tooltip import set_tip
from app.gui.widgets.value_edit import ValueEdit
from app.i18n.catalog import tr
from app.i18n.lengths import shown_unit

_NOW, _SPACING = 62, 8  # width of the values that are now, and between columns [px]
_UNITS = {"mm": '(mm|cm|m|in|"|)', "kPa": "(kPa|)"}
"""What may be typed behind a figure, by its own unit: letters that are no unit are not taken."""


@dataclass(frozen=True)
class TargetView:
    """One wish: its ``key``, ``title`` and ``value`` in ``unit``; without a value it is not asked for.

    ``now`` is what it is before, ``result`` what it comes to with its change. One that is not ``typed``, as a
    profile, shows ``now`` alone. ``priority`` is "high", "normal" or "low", empty where there is none. A
    limit has ``on``: whether it is. One that is ``kept`` cannot be taken away. The ``tone`` of a result is
    "", "warn" or "bad".
    """

    key: str
    title: str
    value: float | None
    now: str
    result: str = ""
    unit: str = "mm"
    signed: bool = True
    typed: bool = True
    kept: bool = False
    priority: str = "normal"
    on: bool | None = None
    tone: str = ""


class _WishField(ValueEdit):
    """A field that leaves Esc to the card unless something was typed; ``typed`` when that begins or ends.

    Without a value it is empty but for words in grey. What is selected as a whole stays so when its value
    changes: the next figure is typed over it. Letters that are no unit are not taken.
    """

    typed = Signal()

    def __init__(self, view: TargetView) -> None:
        super().__init__(view.unit, view.title, signed=view.signed, widest="+1000.0")
        self._typed, self._empty = False, True
        figure = QRegularExpression(r"[\s+\-−＋－]*[\s\d.,．，/⁄¼½¾⅛⅜⅝⅞-]*" + _UNITS[view.unit])
        self.setValidator(QRegularExpressionValidator(figure, self))
        self.textEdited.connect(self._tell)

    def show_wish(self, value: float | None, without: str) -> None:
        """Show a value, or the words ``without`` one, unless something is being typed."""
        self._empty = value is None
        self.setPlaceholderText(without)
        self.show_value(value or 0.0)
        self._name_unit()

    def drop(self) -> None:
        """Leave what is typed as it was."""
        self._show()

    def commit(self) -> bool:
        """Take what is typed; tells whether it could be."""
        self._enter()
        return not self.isModified()

    def _words(self) -> str:
        return "" if self._empty else super()._words()

    def _take(self, value: float) -> None:
        self._empty = False
        self._name_unit()
        super()._take(value)

    def _name_unit(self) -> None:
        """Write the unit behind a value, and behind no word."""
        self._unit = "" if self._empty else shown_unit(self._of)
        self.update()

    def _show(self) -> None:
        whole = self.hasSelectedText() and self.selectedText() == self.text()
        super()._show()
        if whole:
            self.selectAll()
        self._tell()

    def _tell(self) -> None:
        if self._typed != self.isModified():
            self._typed = self.isModified()
            self.typed.emit()

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 - Qt names its events
        if event.key() == Qt.Key.Key_Escape and not self.isModified():
            event.ignore()
        else:
            super().keyPressEvent(event)


def columns(row: QHBoxLayout, now: QWidget, field: QWidget, result: QWidget) -> None:
    """Lay out three columns as in all rows of the card and in their heading."""
    row.setContentsMargins(0, 0, 0, 0)
    row.setSpacing(_SPACING)
    now.setFixedWidth(_NOW)
    row.addWidget(now)
    row.addWidget(field)
    row.addWidget(result, 1)


class TargetRow(QWidget):
    """A wish: its title with priority and the cross that takes it away, then now, the field and the result.

    It is as high without a result as with one, so that no row moves when an answer comes. ``prioritized``
    carries a priority, ``switched`` whether a limit is on.
    """

    prioritized = Signal(str)
    switched = Signal(bool)

    def __init__(self, view: TargetView) -> None:
        super().__init__()
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 3, 0, 7)
        column.setSpacing(3)
        column.addLayout(self._head(view))
        values = QHBoxLayout()
        self.now, self.result = label("", "secondary"), label("", "secondary")
        self.now.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        self.field = _WishField(view)
        set_tag(self.field, "ring", True)
        if view.typed:
            columns(values, self.now, self.field, self.result)
        else:
            values.addWidget(self.now)
            values.addStretch(1)
            self.field.setParent(self)
            self.field.hide()
            self.now.setMinimumHeight(self.field.height())
        column.addLayout(values)

    def _head(self, view: TargetView) -> QHBoxLayout:
        head = QHBoxLayout()
        head.setSpacing(4)
        self.title = sentence(view.title, "body")
        self.title.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        head.addWidget(self.title, 1)
        self.priority, self._titles = OptionCombo(), priority_titles()
        self.priority.setFont(font("caption"))
        self.priority.setProperty("kind", "choice")
        set_tip(self.priority, tr("Set the priority of this target if not all targets can be reached"))
        menu = Menu(self)
        for name, title in self._titles.items():
            menu.addAction(title, partial(self.prioritized.emit, name))
        self.priority.clicked.connect(lambda: pull_down(menu, self.priority))
        self.limit = Segment([("on", tr("On")), ("off", tr("Off"))], small=True)
        self.limit.setAccessibleName(view.title)
        self.limit.chosen.connect(lambda name: self.switched.emit(name == "on"))
        self.remove = ToolButton("x", tr("Remove target"), size=12, room=22)
        for part, shown in ((self.priority, bool(view.priority)), (self.limit, view.on is not None)):
            head.addWidget(part)
            part.setVisible(shown)
        head.addWidget(self.remove)
        return head

    def show_view(self, view: TargetView) -> None:
        """Update values and texts."""
        self.remove.setVisible(not view.kept)
        self.now.setText(view.now)
        self.result.setText(view.result)
        set_tag(self.result, "tone", view.tone)
        self.priority.setText(tr("Priority: {level}").format(level=self._titles.get(view.priority, "")))
        self.priority.setEnabled(view.value is not None or not view.typed)
        if view.on is not None:
            self.limit.set_choice("on" if view.on else "off")
        self.field.show_wish(view.value, tr("Off") if view.on is False else tr("no target"))


def priority_titles() -> dict[str, str]:
    """Return what priorities are called."""
    return {"high": tr("High"), "normal": tr("Normal"), "low": tr("Low")}
