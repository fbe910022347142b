"""A row of the card in which the result is asked for: one wish, typed over, and taken away by its cross."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

from PySide6.QtCore import QRegularExpression, Qt, Signal
from PySide6.QtGui import QKeyEvent, QRegularExpressionValidator
from PySide6.QtWidgets import QHBoxLayout, QWidget

from app.dress.menu import Menu, pull_down
from app.dress.parts import ToolButton
from app.dress.theme import label, set_tag
from app.dress.tip import set_tip
from app.panels.figure_field import FigureField
from app.wording.words import tr

_WAS = 44  # of what it was [px]
_UNITS = {"mm": '(mm|cm|m|in|"|)', "kPa": "(kPa|)"}
"""What may be typed behind a figure, by its own unit: letters that are no unit are not taken."""


@dataclass(frozen=True)
class WishView:
    """One wish: its ``key``, ``title`` and ``value`` in ``unit``; None cannot be typed.

    ``priority`` is "high", "normal" or "low", empty where there is none. ``now`` says what it is now; a
    ``set_`` one is asked for, another shows what is. One that is ``kept`` cannot be taken away.
    """

    key: str
    title: str
    value: float | None
    now: str
    unit: str = "mm"
    signed: bool = True
    set_: bool = True
    kept: bool = False
    priority: str = "normal"


class _WishField(FigureField):
    """A field that leaves Esc to the card unless something was typed; ``typed`` when that begins or ends.

    What is selected as a whole stays so when its value changes: the next figure is typed over it. Letters
    that are no unit are not taken.
    """

    typed = Signal()

    def __init__(self, view: WishView) -> None:
        super().__init__(view.unit, view.title, signed=view.signed, widest="+1000.0")
        self._typed = False
        figure = QRegularExpression(r"[\s+\-−＋－]*[\s\d.,．，/⁄¼½¾⅛⅜⅝⅞-]*" + _UNITS[view.unit])
        self.setValidator(QRegularExpressionValidator(figure, self))
        self.textEdited.connect(self._tell)

    def drop(self) -> None:
        """Leave what is typed as it was."""
        self._show()

    def commit(self) -> bool:
        """Take what is typed; tells whether it could be."""
        self._enter()
        return not self.isModified()

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


class WishRow(QWidget):
    """A wish in a row: title, field, what it is now, its priority, and the cross that takes it away."""

    prioritized = Signal(str)

    def __init__(self, view: WishView) -> None:
        super().__init__()
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(6)
        self.title = label(view.title, "body")
        self.field = _WishField(view)
        set_tag(self.field, "ring", True)
        self.field.setVisible(view.value is not None)
        self.now = label("", "caption")
        self.remove = ToolButton("x", tr("Ask for this no longer"), size=12, room=22)
        row.addWidget(self.title)
        row.addStretch(1)
        row.addWidget(self.now)
        row.addWidget(self.field)
        self.priority = ToolButton("caret-up", size=12, room=22)
        set_tip(self.priority, tr("Set the priority of this target where not all can be met"))
        titles = {"high": tr("High"), "normal": tr("Normal"), "low": tr("Low")}
        self._titles, menu = titles, Menu(self)
        for name, title in titles.items():
            menu.addAction(title, partial(self.prioritized.emit, name))
        self.priority.clicked.connect(lambda: pull_down(menu, self.priority))
        self.priority.setParent(self)
        self.priority.setVisible(bool(view.priority))
        row.addWidget(self.remove)
        # Told once, as words come in later: a long title is not cut, it takes a line of its own.
        self.breadth = self.sizeHint().width() + _WAS if view.value is not None else None
        if view.priority:
            row.insertWidget(row.count() - 1, self.priority)

    def show_view(self, view: WishView) -> None:
        """Bring value and words up to date."""
        self.remove.setVisible(not view.kept)
        self.now.setText(view.now if view.set_ else tr("free"))
        icons = {"high": "caret-up", "low": "caret-down"}
        self.priority.show_icon(icons.get(view.priority, "caret-right"))
        self.priority.setAccessibleName(self._titles.get(view.priority, ""))
        self.priority.setEnabled(view.set_)
        if view.value is not None:
            self.field.show_value(view.value)
