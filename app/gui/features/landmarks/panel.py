"""The landmarks of the body, how sure each is, and the rule it was found by."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QElapsedTimer, QRectF, Qt, Signal
from PySide6.QtGui import QColor, QKeyEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QApplication, QFrame, QHBoxLayout, QVBoxLayout, QWidget

from app.gui.features.landmarks.row import LandmarkRow
from app.gui.theme.stylesheet import label, tokens_of
from app.gui.widgets.basic import Disclosure, EmptyState, ScrollColumn, ToolButton, button, hairline, sentence
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import joined, tr
from app.i18n.lengths import arrow_step, length
from app.presenters.landmarks import LandmarkView
from app.presenters.messages import render


def keys_in_words() -> list[tuple[str, str]]:
    """Return what the keys do in the list and then on a pin, ready to read."""
    return [
        ("↑ ↓", tr("Select previous or next landmark")),
        ("Enter", tr("Start or end pin movement with the arrow keys")),
        ("← → ↑ ↓", tr("Move pin by {step} (Shift: {far})").format(**_steps())),
    ]


def _steps() -> dict[str, str]:
    """Return what arrow keys move a pin by, alone and with Shift."""
    return {"step": length(arrow_step(), 0), "far": length(arrow_step(far=True), 0)}


class LandmarksPanel(QWidget):
    """All landmarks, one row each; under them the rule of the selected one.

    ``reset_requested`` names the landmarks, a tuple, that are to be found again, ``confirmed`` those that are
    right; ``place_requested`` one that was not found and is to be placed; ``hovered`` the one under the
    pointer,
    or none. ``keys_requested``: the selected one is to be moved by keys. ``linked`` tells whether the other
    side goes with one.
    """

    landmark_selected = Signal(str)
    place_requested = Signal(str)
    reset_requested = Signal(object)
    confirmed = Signal(object)
    hovered = Signal(str)
    keys_requested = Signal()
    linked = Signal(bool)

    def __init__(self) -> None:
        super().__init__()
        self.rows: dict[str, LandmarkRow] = {}
        self._selected: str | None = None
        self._answered = QElapsedTimer()
        column = QVBoxLayout(self)
        column.setContentsMargins(14, 14, 14, 14)
        column.setSpacing(2)
        self._summary = sentence()
        self._summary.setContentsMargins(4, 2, 0, 6)
        self._doubts = LandmarkWarnings()
        self._empty = EmptyState(
            "map-pin", tr("No landmarks yet"), tr("Landmarks are detected on a scan. Open a scan first.")
        )
        column.addLayout(self._head())
        for each in (self._summary, self._doubts, self._empty):
            column.addWidget(each)
        column.addWidget(self._list(), 1)
        column.addWidget(self._foot())
        column.addStretch(0)
        self.set_landmarks([])

    def _head(self) -> QHBoxLayout:
        head = QHBoxLayout()
        heading = label(tr("Landmarks"), "heading")
        heading.setContentsMargins(4, 0, 0, 0)
        self.link = ToolButton("link", tr("Move left and right landmarks symmetrically"))
        self.link.setCheckable(True)
        self.link.toggled.connect(self.linked)
        head.addWidget(heading, 1)
        head.addWidget(self.link)
        return head

    def _list(self) -> ScrollColumn:
        self._area = ScrollColumn(tr("Landmarks"), (0, 0, 6, 0), 0, keys=False)  # its rows take the keyboard
        column = self._area.column
        self._groups: dict[str, QVBoxLayout] = {}
        self._heads: dict[str, QWidget] = {
            "bust": label(tr("Bust"), "caption"),
            "under": label(tr("Folds and breast roots"), "caption"),
            "lower": label(tr("Waist, hips and seat"), "caption"),
            "further": Disclosure(tr("Other landmarks")),
        }
        self.further = QWidget()
        for name, head in self._heads.items():
            head.setContentsMargins(4, 8, 0, 3)
            column.addWidget(head)
            holder = self.further if name == "further" else QWidget()
            rows = self._groups[name] = QVBoxLayout(holder)
            rows.setContentsMargins(0, 0, 0, 0)
            rows.setSpacing(0)
            column.addWidget(holder)
        disclosure = self._heads["further"]
        assert isinstance(disclosure, Disclosure)
        disclosure.toggled.connect(self.further.setVisible)
        self.further.hide()
        column.addStretch(1)
        return self._area

    def _foot(self) -> QWidget:
        self._rule_box = QWidget()
        rule = QVBoxLayout(self._rule_box)
        rule.setContentsMargins(4, 8, 4, 12)
        rule.setSpacing(3)
        self._rule_title, self._rule = sentence("", "name"), sentence()
        self._hint = sentence(role="caption")
        self.place, self.right = button(tr("Place")), button(tr("Confirm"))
        set_tip(self.right, tr("Confirm the detected position"))
        self.reset, self.reset_all = button(tr("Reset")), button(tr("Reset all"), "quiet")
        self.place.clicked.connect(lambda: self.place_requested.emit(self._selected))
        self.right.clicked.connect(self._confirm)
        self.reset.clicked.connect(lambda: self.reset_requested.emit((self._selected,)))
        self.reset_all.clicked.connect(lambda: self.reset_requested.emit(self._placed()))
        # Each answer has a place of its own: none may lie where another was under the pointer a moment ago.
        buttons = QHBoxLayout()
        buttons.addWidget(self.place)
        buttons.addWidget(self.right)
        buttons.addStretch(1)
        buttons.addWidget(self.reset)
        rule.addWidget(hairline())
        rule.addSpacing(8)
        for part in (self._rule_title, self._rule, self._hint):
            rule.addWidget(part)
        rule.addSpacing(4)
        rule.addLayout(buttons)
        rule.addWidget(self.reset_all, alignment=Qt.AlignmentFlag.AlignLeft)
        return self._rule_box

    def set_landmarks(
        self, landmarks: Sequence[LandmarkView], doubts: Sequence[str] = (), *, placing: bool = True
    ) -> None:
        """Show these landmarks and the ``doubts`` about them; rows stay while names and order stay.

        ``placing``: those that are absent can be placed.
        """
        self._placing = placing
        if [view.name for view in landmarks] != list(self.rows):
            self._rebuild(landmarks)
        for view in landmarks:
            self.rows[view.name].show_view(view)
        self.link.setVisible(bool(landmarks))
        self._doubts.show_doubts(sum(view.weak for view in landmarks), doubts)
        self._summary.setText(tr("Drag a pin over the skin to move the landmark; the model is updated."))
        self._summary.setVisible(bool(landmarks) and placing)
        self._empty.setVisible(not landmarks)
        self._area.setVisible(bool(landmarks))
        for name, head in self._heads.items():
            head.setVisible(any(view.group == name for view in landmarks))
        self.select(self._selected if self._selected in self.rows else None)

    def select(self, name: str | None) -> None:
        """Show the rule of a landmark; nothing is emitted."""
        self._selected = name
        for each, row in self.rows.items():
            row.setChecked(each == name)
        placed = self._placed()
        self._rule_box.setVisible(name is not None or bool(placed))
        for part in (self._rule_title, self._rule, self._hint):
            part.setVisible(name is not None)
        absent = name is not None and self.rows[name].view.absent
        self.place.setVisible(absent and self._placing)
        self.right.setVisible(name is not None and self.rows[name].view.weak)
        self.reset.setVisible(name in placed)
        self.reset_all.setVisible(bool(placed) and placed != (name,))
        if name is not None:
            view = self.rows[name].view
            self._rule_title.setText(view.title)
            self._rule.setText(view.words())
            drag = tr(
                "Drag the pin to correct the landmark, or press Enter and use the arrow keys: "
                "{step}, Shift {far}."
            )
            drag = drag.format(**_steps())
            self._hint.setText(tr("Place the landmark in the middle of the view.") if absent else drag)
            self._hint.setVisible(self._placing or not absent)
            if view.group == "further":
                self._open_further()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        step = {Qt.Key.Key_Up: -1, Qt.Key.Key_Down: 1}.get(Qt.Key(event.key()))
        names = [name for name, row in self.rows.items() if row.isVisible()]
        chosen = self.rows.get(self._selected or "")
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and chosen is not None and chosen.hasFocus():
            self.keys_requested.emit()
            return
        if step is None or not names:
            super().keyPressEvent(event)
            return
        here = names.index(self._selected) if self._selected in names else -1
        name = names[min(max(here + step, 0), len(names) - 1)]
        self._reach(name)
        self.rows[name].setFocus(Qt.FocusReason.OtherFocusReason)

    def _reach(self, name: str) -> None:
        """Select the landmark that the keyboard has come to."""
        self._area.ensureWidgetVisible(self.rows[name])
        if name != self._selected:
            self._choose(name)

    def _confirm(self) -> None:
        """Say that the selected landmark is right, and go on to the next one that wants a look."""
        name, rows = self._selected, list(self.rows)
        # The second click of a double click would answer for the next landmark, unseen.
        again = self._answered.isValid() and self._answered.elapsed() < QApplication.doubleClickInterval()
        if name is None or again:
            return
        self._answered.start()
        at = rows.index(name)
        weak = [each for each in rows[at + 1 :] + rows[:at] if self.rows[each].view.weak]
        self.confirmed.emit((name,))
        if weak:
            self._reach(weak[0])
        elif self.right.hasFocus():
            self.rows[name].setFocus(Qt.FocusReason.OtherFocusReason)

    def _placed(self) -> tuple[str, ...]:
        return tuple(name for name, row in self.rows.items() if row.view.by_hand)

    def _open_further(self) -> None:
        disclosure = self._heads["further"]
        assert isinstance(disclosure, Disclosure)
        disclosure.setChecked(True)

    def _rebuild(self, landmarks: Sequence[LandmarkView]) -> None:
        for row in self.rows.values():
            row.hide()  # or a layout that has just taken it shows it as a window of its own
            row.setParent(None)
            row.deleteLater()
        self.rows = {view.name: LandmarkRow(view) for view in landmarks}
        for name, row in self.rows.items():
            self._groups[row.view.group].addWidget(row)
            row.clicked.connect(lambda _=False, chosen=name: self._choose(chosen))
            row.reached.connect(lambda chosen=name: self._reach(chosen))
            row.hovered.connect(lambda over, name=name: self.hovered.emit(name if over else ""))
        self._heads["lower"].setVisible(any(view.group == "lower" for view in landmarks))

    def _choose(self, name: str) -> None:
        self.select(name)
        self.landmark_selected.emit(name)


class LandmarkWarnings(QFrame):
    """What wants a look, and what to do about it; it takes no room while all is well."""

    def __init__(self) -> None:
        super().__init__()
        column = QVBoxLayout(self)
        column.setContentsMargins(12, 9, 12, 11)
        column.setSpacing(4)
        self._count, self._said = sentence("", "name"), sentence()
        column.addWidget(self._count)
        column.addWidget(self._said)

    def show_doubts(self, count: int, doubts: Sequence[str]) -> None:
        """Show how many landmarks have low confidence, and all warnings."""
        do = tr("Select each landmark: drag its pin to correct it, or confirm it.")
        self._count.setText(tr("To review: {count}").format(count=count))
        self._count.setVisible(bool(count))
        self._said.setText(joined([*map(render, doubts), *[do] * bool(count)]))
        self.setVisible(bool(doubts) or bool(count))

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(tokens_of(self).warn_fill))
        painter.drawRoundedRect(QRectF(self.rect()), 8, 8)
