"""The card on the view in which the result is asked for: wishes, the answer, what would change."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QGridLayout, QHBoxLayout, QLabel, QVBoxLayout, QWidget

from app.dress.parts import IconLabel, OverCard, Segment, ToolButton, button, sentence
from app.dress.theme import label, set_tag
from app.panels.figure_field import FigureField
from app.wording.words import tr

WIDTH = 674
"""Width of what the card holds [px]."""

_COLUMNS = 2
_BETWEEN = 20  # columns [px]
_WAS = 44  # of what it was [px]


@dataclass(frozen=True)
class WishView:
    """One wish: its ``key``, ``title`` and ``value`` in ``unit``; None cannot be typed.

    ``now`` says what it is now; a ``set_`` one is asked for, another shows what is. One that is ``kept``
    cannot be taken away.
    """

    key: str
    title: str
    value: float | None
    now: str
    unit: str = "mm"
    signed: bool = True
    set_: bool = True
    kept: bool = False


class _WishField(FigureField):
    """A field that leaves Esc to the card unless something was typed.

    What is selected as a whole stays so when its value changes: the next figure is typed over it.
    """

    def _show(self) -> None:
        whole = self.hasSelectedText() and self.selectedText() == self.text()
        super()._show()
        if whole:
            self.selectAll()

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 - Qt names its events
        if event.key() == Qt.Key.Key_Escape and not self.isModified():
            event.ignore()
        else:
            super().keyPressEvent(event)


class _Wish(QWidget):
    """A wish in a row: title, field, what it is now, and the cross that takes it away."""

    def __init__(self, view: WishView) -> None:
        super().__init__()
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(6)
        self.title = label(view.title, "body")
        self.field = _WishField(view.unit, view.title, signed=view.signed, widest="+1000.0")
        set_tag(self.field, "ring", True)
        self.field.setVisible(view.value is not None)
        self.now = label("", "caption")
        self.remove = ToolButton("x", tr("Ask for this no longer"), size=12, room=22)
        row.addWidget(self.title)
        row.addStretch(1)
        row.addWidget(self.now)
        row.addWidget(self.field)
        row.addWidget(self.remove)

    def show_view(self, view: WishView) -> None:
        """Bring value and words up to date."""
        self.remove.setVisible(not view.kept)
        self.now.setText(view.now if view.set_ else tr("free"))
        if view.value is not None:
            self.field.show_value(view.value)


class AskCard(OverCard):
    """Takes wishes and shows what comes of them.

    ``entered`` carries a wish's key and its value, ``removed`` its key; ``add_asked`` wants the menu under
    ``add``. ``hand_chosen`` carries what the handles drag: "bust", "apex" or "profile"; ``linked`` whether
    they move both sides. ``applied`` and ``left`` end it; ``helped`` is the button that shows when nothing
    can be asked.
    """

    entered = Signal(str, float)
    removed = Signal(str)
    add_asked = Signal()
    hand_chosen = Signal(str)
    linked = Signal(bool)
    applied = Signal()
    left = Signal()
    helped = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.wishes: dict[str, _Wish] = {}
        self._shape: list[tuple[str, str]] = []
        column = QVBoxLayout()
        column.setSpacing(8)
        column.addLayout(self._head())
        self._hint = sentence("")
        column.addWidget(self._hint)
        self._grid = QGridLayout()
        self._grid.setHorizontalSpacing(_BETWEEN)
        self._grid.setVerticalSpacing(4)
        for at in range(_COLUMNS):
            self._grid.setColumnStretch(at, 1)
        column.addLayout(self._grid)
        column.addLayout(self._said())
        column.addLayout(self._foot())
        self.row.setContentsMargins(30, 20, 30, 30)
        self.row.addLayout(column)
        self.setFixedWidth(WIDTH + 60)
        self.hide()

    def _head(self) -> QHBoxLayout:
        head = QHBoxLayout()
        head.setSpacing(8)
        head.addWidget(IconLabel("target", "accent", 18))
        head.addWidget(label(tr("Ask for the result"), "heading"))
        head.addStretch(1)
        close = ToolButton("x", tr("Leave without a change (Esc)"), size=14, room=26)
        close.clicked.connect(self.left)
        head.addWidget(close)
        return head

    def _said(self) -> QVBoxLayout:
        said = QVBoxLayout()
        said.setSpacing(2)
        self.answer, self.changes, self.note = sentence("", "name"), sentence(""), sentence("", "caption")
        for part in (self.answer, self.changes, self.note):
            said.addWidget(part)
        return said

    def _foot(self) -> QHBoxLayout:
        """Return the row of what is pressed: the card grows upwards from it, so it keeps its place."""
        foot = QHBoxLayout()
        foot.setSpacing(4)
        hands = [("bust", tr("Bust point")), ("apex", tr("Foremost place")), ("profile", tr("Profile"))]
        self.hand = Segment(hands, small=True)
        self.hand.setAccessibleName(tr("What is dragged on the body"))
        self.hand.chosen.connect(self.hand_chosen)
        self.link = ToolButton("link", tr("Drag left and right together"), size=16, room=28)
        self.link.setCheckable(True)
        self.link.setChecked(True)
        self.link.toggled.connect(self.linked)
        self.add = button(tr("Add a wish"), "quiet")
        self.add.clicked.connect(self.add_asked)
        self.help_ = button(tr("Choose lines"), "secondary")
        self.help_.clicked.connect(self.helped)
        self.help_.hide()
        self.apply = button(tr("Apply"), "primary")
        self.apply.clicked.connect(self.applied)
        self.cancel = button(tr("Cancel"), "quiet")
        self.cancel.clicked.connect(self.left)
        for part in (self.hand, self.link, self.add):
            foot.addWidget(part)
        foot.addStretch(1)
        for part in (self.help_, self.apply, self.cancel):
            foot.addWidget(part)
        return foot

    # -- what it shows

    def show_wishes(self, wishes: Sequence[WishView], hint: str = "") -> None:
        """Show these wishes; a field that is typed into keeps what is typed."""
        shape = [(wish.key, wish.title) for wish in wishes]
        if shape != self._shape:
            self._lay(wishes)
            self._shape = shape
        for wish in wishes:
            self.wishes[wish.key].show_view(wish)
        self._hint.setText(hint)
        self._hint.setVisible(bool(hint))
        self._fit()

    def show_answer(
        self, answer: str = "", tone: str = "", changes: str = "", note: str = "", *, can_apply: bool = False
    ) -> None:
        """Show what came out: a sentence in a ``tone`` of "", "ok" or "warn", changes of lines, a note."""
        for part, words in ((self.answer, answer), (self.changes, changes), (self.note, note)):
            part.setText(words)
            part.setVisible(bool(words))
        set_tag(self.answer, "tone", tone)
        self.apply.setEnabled(can_apply)
        self._fit()

    def show_hand(self, kind: str) -> None:
        """Show what the handles drag; a profile is that of one side."""
        self.hand.set_choice(kind)
        self.link.setEnabled(kind != "profile")

    def show_help(self, shown: bool, locked: bool = False) -> None:
        """Take Apply away while lines are missing, or all ``locked``; the button leads out of that."""
        self.help_.setText(tr("Unlock them") if locked else tr("Choose lines"))
        self.help_.setVisible(shown)
        self.apply.setVisible(not shown)
        for part in (self.add, self.link, self.hand):
            part.setVisible(not shown)

    def take_focus(self, key: str) -> None:
        """Let a wish be typed at once."""
        if key in self.wishes:
            self.wishes[key].field.setFocus(Qt.FocusReason.TabFocusReason)
            self.wishes[key].field.selectAll()

    def _lay(self, wishes: Sequence[WishView]) -> None:
        for old in self.wishes.values():
            self._grid.removeWidget(old)
            old.hide()
            old.deleteLater()
        self.wishes = {}
        at = 0
        for wish in wishes:
            row = _Wish(wish)
            row.field.entered.connect(partial(self.entered.emit, wish.key))
            row.remove.clicked.connect(partial(self._remove, wish.key))
            self.wishes[wish.key] = row
            wide = wish.value is None or row.sizeHint().width() + _WAS > (WIDTH - _BETWEEN) // _COLUMNS
            at += at % _COLUMNS if wide else 0  # a long title is not cut: it takes a line of its own
            self._grid.addWidget(row, at // _COLUMNS, at % _COLUMNS, 1, _COLUMNS if wide else 1)
            at += _COLUMNS if wide else 1

    def _remove(self, key: str, _: bool = False) -> None:
        self.removed.emit(key)

    def _fit(self) -> None:
        parts: list[QLabel] = [self._hint, self.answer, self.changes, self.note]
        for part in parts:
            # A sentence that wraps is as high as it is at the width that it really gets.
            part.setMinimumHeight(part.heightForWidth(WIDTH) if part.text() else 0)
            part.updateGeometry()
        self.adjustSize()
