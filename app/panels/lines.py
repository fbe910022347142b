"""The list of constraining lines, where each is set shorter or longer."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QFrame, QHBoxLayout, QScrollArea, QVBoxLayout, QWidget

from app.dress.parts import EmptyState, ToolButton
from app.dress.theme import label
from app.panels.line_row import LineRow, LineView
from app.wording.words import tr

__all__ = ["LineView", "LinesPanel"]


class _Area(QScrollArea):
    """An area that leaves the keys to the list: arrows go from line to line."""

    def keyPressEvent(self, event: QKeyEvent) -> None:
        event.ignore()


class LinesPanel(QWidget):
    """All lines, one row each; lengths in the signals are shares of the rest length [1]."""

    length_previewed = Signal(str, float)
    length_committed = Signal(str, float)
    drag_cancelled = Signal(str)
    selected = Signal(str)
    visibility_changed = Signal(str, bool)
    removed = Signal(str)
    add_asked = Signal()
    reset_all = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.rows: dict[str, LineRow] = {}
        self._selected: str | None = None
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addLayout(self._head())
        self._empty = EmptyState(
            "lines", tr("No lines yet"), tr("They appear once the control mesh lies on the body.")
        )
        frame = QVBoxLayout()
        frame.setContentsMargins(14, 4, 14, 0)
        frame.addWidget(self._empty)
        frame.addStretch(1)
        column.addLayout(frame)
        column.addWidget(self._scroll_area(), 1)
        self.set_lines([])

    def set_lines(self, lines: Sequence[LineView]) -> None:
        """Show these lines; rows stay the same widgets while names and order stay, even during a drag."""
        if [view.name for view in lines] != list(self.rows):
            self._rebuild(lines)
        for view in lines:
            self.rows[view.name].show_view(view)
        self._empty.setVisible(not lines)
        self.add.setEnabled(bool(lines))
        self._scroll.setVisible(bool(lines))
        self._reset.setEnabled(any(view.constrained and view.ratio != 1.0 for view in lines))

    def select(self, name: str | None) -> None:
        """Open the row of a line and close the others; nothing is emitted."""
        self._selected = name
        for each, row in self.rows.items():
            row.set_open(each == name)
        if name in self.rows:
            self._scroll.ensureWidgetVisible(self.rows[name], 0, 8)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        steps = {Qt.Key.Key_Up: -1, Qt.Key.Key_Down: 1}
        row = self.rows.get(self._selected or "")
        if event.key() in steps and self.rows:
            self._step(steps[Qt.Key(event.key())])
        elif event.key() == Qt.Key.Key_H and row is not None:
            self.visibility_changed.emit(row.view.name, not row.view.visible)
        elif event.key() == Qt.Key.Key_Delete and row is not None and row.view.own:
            self.removed.emit(row.view.name)
        elif (
            event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and row is not None and row.view.constrained
        ):
            row.percent.setFocus(Qt.FocusReason.ShortcutFocusReason)
        else:
            super().keyPressEvent(event)

    def _head(self) -> QHBoxLayout:
        head = QHBoxLayout()
        head.setContentsMargins(18, 12, 14, 8)
        head.addWidget(label(tr("Lines"), "heading"))
        head.addStretch(1)
        self.add = ToolButton("plus", tr("Add a line of your own"))
        self.add.clicked.connect(self.add_asked)
        head.addWidget(self.add)
        self._reset = ToolButton("arrow-counter-clockwise", tr("Set all lines back to their length at rest"))
        self._reset.clicked.connect(self.reset_all)
        head.addWidget(self._reset)
        return head

    def _scroll_area(self) -> QScrollArea:
        inside = QWidget()
        inside.setProperty("scrolled", "true")
        self._list = QVBoxLayout(inside)
        self._list.setContentsMargins(8, 0, 8, 12)
        self._list.setSpacing(2)
        self._list.addStretch(1)
        self._scroll = _Area()
        self._scroll.setWidgetResizable(True)
        self._scroll.setFrameShape(QFrame.Shape.NoFrame)
        self._scroll.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self._scroll.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._scroll.setWidget(inside)
        return self._scroll

    def _rebuild(self, lines: Sequence[LineView]) -> None:
        for row in self.rows.values():
            self._list.removeWidget(row)
            row.deleteLater()
        self.rows = {view.name: LineRow(view) for view in lines}
        for place, (name, row) in enumerate(self.rows.items()):
            self._list.insertWidget(place, row)
            self._connect(name, row)
        self.select(self._selected if self._selected in self.rows else None)

    def _connect(self, name: str, row: LineRow) -> None:
        row.previewed.connect(lambda ratio: self.length_previewed.emit(name, ratio))
        row.committed.connect(lambda ratio: self.length_committed.emit(name, ratio))
        row.cancelled.connect(lambda: self.drag_cancelled.emit(name))
        row.pressed.connect(lambda: self._choose(name))
        row.removed.connect(lambda: self.removed.emit(name))
        row.visibility_changed.connect(lambda visible: self.visibility_changed.emit(name, visible))

    def _choose(self, name: str) -> None:
        if name != self._selected:
            self.select(name)
            self.selected.emit(name)

    def _step(self, step: int) -> None:
        names = list(self.rows)
        here = names.index(self._selected) if self._selected in names else -1 if step > 0 else len(names)
        name = names[min(max(here + step, 0), len(names) - 1)]
        self._choose(name)
        row = self.rows[name]
        (row.slider if row.view.constrained else row).setFocus(Qt.FocusReason.OtherFocusReason)
