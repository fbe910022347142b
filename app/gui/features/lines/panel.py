"""The list of constraining lines, where each is set shorter or longer."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QRectF, Qt, Signal
from PySide6.QtGui import QKeyEvent, QPainter, QPaintEvent, QShowEvent
from PySide6.QtWidgets import (
    QApplication,
    QHBoxLayout,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from app.gui.features.lines.groups import LineGroups
from app.gui.features.lines.row import LineRow, LineView
from app.gui.theme.icons import paint_icon
from app.gui.theme.stylesheet import font, tokens_of
from app.gui.widgets.basic import EmptyState, ScrollColumn, ToolButton, button, sentence
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr
from app.i18n.lengths import length_unit

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
            tr("Reset all unlocked lines to their original length (Ctrl+R)"),
        )
        self.draw = _in_words(tr("Draw"), tr("Draw line on body (N)"))
        self.add = _in_words(tr("Add"), tr("Add lines: pairs, or lines through control points"))
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
        set_tip(self, tr("Load or save presets"))

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


__all__ = ["LineView", "LinesPanel"]


def keys_in_words() -> list[tuple[str, str]]:
    """Return what the keys do in the list and on a slider that no menu has, ready to read."""
    return [
        ("↑ ↓", tr("Select previous or next line")),
        ("← →, - +", tr("Shorten or lengthen by 0.1 % (Shift 1 %, Alt 0.01 %)")),
        ("Backspace", tr("Reset to original length")),
        ("Enter", tr("Enter the length in percent (Tab: in {unit})").format(unit=length_unit())),
        ("Esc", tr("Cancel the drag")),
    ]


def _no_lines() -> tuple[str, str]:
    return tr("No lines yet"), tr("Landmarks appear when the control mesh has been fitted.")


class LinesPanel(QWidget):
    """All lines, one row each, a linked pair in one; lengths in the signals are shares of those at rest [1].

    ``cards`` takes what stands above them in the list. Lines below the bust stand under headings.
    Signals name a line, a pair by its left one; ``decided`` carries one of its traits and the value,
    ``elastic_requested`` one whose elastic is to be chosen; ``opened`` when the list comes to be seen.
    """

    opened = Signal()

    length_previewed = Signal(str, float)
    length_committed = Signal(str, float)
    drag_cancelled = Signal(str)
    selected = Signal(str)
    visibility_changed = Signal(str, bool)
    decided = Signal(str, str, object)
    removed = Signal(str)
    path_requested = Signal(str)
    elastic_requested = Signal(str)
    draw_requested = Signal()
    add_requested = Signal()
    presets_requested = Signal()
    lower_trunk_requested = Signal()
    reset_all = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.rows: dict[str, LineRow] = {}
        self._selected: str | None = None
        self._of: dict[str, str] = {}
        self._bereft = False
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        self.head = LinesHeader()
        self.head.reset_requested.connect(self.reset_all)
        self.head.draw_requested.connect(self.draw_requested)
        self.head.add_requested.connect(self.add_requested)
        self.head.presets_requested.connect(self.presets_requested)
        column.addWidget(self.head)
        self._empty = EmptyState("lines", *_no_lines())
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
        self._of = {name: view.name for view in lines for name in view.names}
        for view in lines:
            self.rows[view.name].show_view(view)
        self._show_rows()
        if self._bereft and self.rows:
            # What had the keyboard is gone: it goes on in the line that is selected now.
            row = self.rows.get(self._selected or "") or next(iter(self.rows.values()))
            row.take_focus(Qt.FocusReason.OtherFocusReason)
        self._bereft = False
        self._empty.setVisible(not lines)
        for tool in (self.head.presets, self.head.add, self.head.draw):
            tool.setEnabled(bool(lines))
        self._scroll.setVisible(bool(lines))
        self.head.reset.setEnabled(any(view.settable and view.ratio != 1.0 for view in lines))

    def show_lower_trunk(self, *, offered: bool, why_not: str) -> None:
        """Show whether the lower trunk can be added, or why there is none though the design has it."""
        self.add_lower.setVisible(offered)
        self._why_not.setText(why_not)
        self._why_not.setVisible(bool(why_not))

    def _show_rows(self) -> None:
        self.groups.show(list(self.rows.values()), self._selected)

    def show_opening(self, name: str) -> None:
        """Show that a document is being opened in place of lines; an empty name: that there are none."""
        if name:
            hint = tr("Lines appear when the control mesh has been fitted.")
            self._empty.show_words(tr("Opening {name}…").format(name=name), hint)
        else:
            self._empty.show_words(*_no_lines())

    def select(self, name: str | None) -> None:
        """Open the row of a line and close the others; nothing is emitted."""
        self._selected = self._of.get(name or "", name)
        for each, row in self.rows.items():
            row.set_open(each == self._selected)
        self._show_rows()
        if self._selected in self.rows:
            self._scroll.ensureWidgetVisible(self.rows[self._selected], 0, 8)

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self.opened.emit()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        step = {Qt.Key.Key_Up: -1, Qt.Key.Key_Down: 1}.get(Qt.Key(event.key()))
        row = self.rows.get(self._selected or "")
        if step is not None and self.rows:
            self._step(step)
        elif (
            event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and row is not None and row.slider.hasFocus()
        ):
            row.percent.setFocus(Qt.FocusReason.ShortcutFocusReason)
        else:
            super().keyPressEvent(event)

    def do(self, what: str) -> None:
        """Run an action on the selected line: hide, lock, link, split, rename, remove."""
        row = self.rows.get(self._selected or "")
        if row is None:
            return
        view = row.view
        if what == "hide":
            self.visibility_changed.emit(view.name, not view.visible)
        elif what == "lock":
            self.decided.emit(view.name, "locked", not view.locked)
        elif what == "link" and (view.partner or view.splits):
            self.decided.emit(view.name, "linked", not (view.sides or view.splits))
        elif what == "split" and view.splits:
            self.decided.emit(view.name, "linked", False)
        elif what == "rename":
            row.title.begin()
        elif what == "remove" and view.own:
            self.removed.emit(view.name)

    def _scroll_area(self) -> ScrollColumn:
        self._scroll = ScrollColumn("", (8, 0, 8, 12), 2, keys=False)
        self.cards, self._list = QVBoxLayout(), QVBoxLayout()
        self._list.setSpacing(2)
        self._scroll.column.addLayout(self.cards)
        self._scroll.column.addLayout(self._list)
        self.groups = LineGroups(self._list, self, self._show_rows)
        self.add_lower = button(tr("Add waist, hips and seat"))
        set_tip(self.add_lower, tr("Lines below the under-bust: requires a scan down to mid-thigh"))
        self.add_lower.clicked.connect(self.lower_trunk_requested)
        self._why_not = sentence("", "caption")
        self._why_not.setContentsMargins(10, 10, 10, 0)
        for part in (self.add_lower, self._why_not):
            self._scroll.column.addWidget(part)
        self.show_lower_trunk(offered=False, why_not="")
        self._scroll.column.addStretch(1)
        return self._scroll

    def _rebuild(self, lines: Sequence[LineView]) -> None:
        """Make the rows anew; those of lines that stay are kept, one of them may be in the user's hand."""
        names = [view.name for view in lines]
        for name, row in self.rows.items():
            self._list.removeWidget(row)
            if name not in names:
                if row.slider.isSliderDown():
                    self.drag_cancelled.emit(name)
                has = QApplication.focusWidget()
                self._bereft = self._bereft or (has is not None and (has is row or row.isAncestorOf(has)))
                row.deleteLater()
        former, self.rows = self.rows, {}
        for view in lines:
            row = self.rows[view.name] = former.get(view.name) or LineRow(view)
            if view.name not in former:
                self._connect(view.name, row)
        self.groups.lay(list(self.rows.values()))
        self.select(self._selected if self._selected in self.rows else None)

    def _connect(self, name: str, row: LineRow) -> None:
        row.previewed.connect(lambda ratio: self.length_previewed.emit(name, ratio))
        row.committed.connect(lambda ratio: self.length_committed.emit(name, ratio))
        row.cancelled.connect(lambda: self.drag_cancelled.emit(name))
        row.pressed.connect(lambda: self._choose(name))
        row.removed.connect(lambda: self.removed.emit(name))
        row.decided.connect(lambda trait, value: self.decided.emit(name, trait, value))
        row.path_requested.connect(lambda: self.path_requested.emit(name))
        row.elastic_requested.connect(lambda: self.elastic_requested.emit(name))
        row.visibility_changed.connect(lambda visible: self.visibility_changed.emit(name, visible))

    def _choose(self, name: str) -> None:
        if name != self._selected:
            self.select(name)
            self.selected.emit(name)

    def _step(self, step: int) -> None:
        names = [name for name, row in self.rows.items() if not row.isHidden()]
        here = names.index(self._selected) if self._selected in names else -1 if step > 0 else len(names)
        name = names[min(max(here + step, 0), len(names) - 1)]
        self._choose(name)
        self.rows[name].take_focus(Qt.FocusReason.OtherFocusReason)
