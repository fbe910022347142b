"""The page of the inspector in which the result is asked for: wishes, the answer, what would change."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QCheckBox, QHBoxLayout, QVBoxLayout, QWidget

from app.gui.features.target_shape.row import TargetRow, TargetView, columns
from app.gui.theme.stylesheet import label, set_tag
from app.gui.widgets.basic import ScrollColumn, Segment, ToolButton, button, hairline, sentence
from app.gui.widgets.navigation_row import page_head
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr

_SIDES = 16  # room left and right of what it holds [px]


class TargetCard(QWidget):
    """Takes wishes and shows what comes of them; a page in the place of the lines, beside the body.

    Rows stand above what depends on an answer, so that none moves when one comes. ``entered`` carries a
    wish's key and its value, ``removed`` its key; ``add_requested`` wants the menu under ``add``.
    ``hand_chosen``
    carries what the handles drag: "bust", "apex" or "profile"; ``linked`` whether they move both sides;
    ``prioritized`` a wish's key and its priority, ``limited`` whether a limit is on, ``optional_chosen``
    whether lines that are off may be switched on. ``applied`` and ``closed`` end it; ``helped`` is the button
    that shows when nothing can be asked.
    """

    entered = Signal(str, float)
    removed = Signal(str)
    prioritized = Signal(str, str)
    limited = Signal(bool)
    optional_chosen = Signal(bool)
    add_requested = Signal()
    hand_chosen = Signal(str)
    linked = Signal(bool)
    applied = Signal()
    closed = Signal()
    helped = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.wishes: dict[str, TargetRow] = {}
        self._kind, self._tone, self._can_apply = "bust", "", False
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addLayout(page_head(tr("Target shape"), tr("Cancel without changes (Esc)"), self.closed))
        column.addWidget(self._scroll_area(), 1)
        column.addWidget(hairline())
        column.addLayout(self._foot())

    def _scroll_area(self) -> ScrollColumn:
        area = ScrollColumn(tr("Target shape"), (_SIDES, 2, _SIDES, 12), 0)
        column = area.column
        column.addLayout(self._hands())
        self._heading = self._headed()
        column.addWidget(self._heading)
        self._rows = QVBoxLayout()
        self._rows.setSpacing(0)
        column.addLayout(self._rows)
        column.addLayout(self._more())
        column.addSpacing(8)
        column.addLayout(self._said())
        column.addStretch(1)
        area.setFocusPolicy(Qt.FocusPolicy.TabFocus)  # a click on a button leaves the keyboard where it is
        return area

    def _hands(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(4)
        hands = [("bust", tr("Bust point")), ("apex", tr("Apex")), ("profile", tr("Profile"))]
        self.hand = Segment(hands, small=True, wide=True)
        self.hand.setAccessibleName(tr("Type of target"))
        self.hand.chosen.connect(self._choose_hand)
        self.link = ToolButton("link", tr("Drag left and right together"), size=16, room=28)
        self.link.setCheckable(True)
        self.link.setChecked(True)
        self.link.toggled.connect(self.linked)
        row.addWidget(self.hand, 1)
        row.addWidget(self.link, 0, Qt.AlignmentFlag.AlignRight)
        return row

    def _headed(self) -> QWidget:
        """Return the heading of the columns."""
        heading = QWidget()
        row = QHBoxLayout(heading)
        titles = tr("Current"), tr("Target"), tr("Result (change)")
        now, target, result = (label(words, "caption") for words in titles)
        now.setAlignment(Qt.AlignmentFlag.AlignRight)
        columns(row, now, target, result)
        row.setContentsMargins(0, 8, 0, 0)
        self._target = target
        return heading

    def _more(self) -> QVBoxLayout:
        more, row = QVBoxLayout(), QHBoxLayout()
        self.add = button(tr("Add target…"), "quiet")
        self.add.clicked.connect(self._ask_more)
        self.optional = QCheckBox(tr("Include inactive lines"))
        self.optional.clicked.connect(self.optional_chosen)
        row.addWidget(self.add)
        row.addStretch(1)
        row.addWidget(self.optional)
        more.addWidget(hairline())
        more.addSpacing(4)
        more.addLayout(row)
        return more

    def _said(self) -> QVBoxLayout:
        column = QVBoxLayout()
        column.setSpacing(6)
        self.hint = sentence("")
        self.answer, self.price = sentence("", "name"), sentence("")
        self.changes, self.note = sentence(""), sentence("", "caption")
        for part in (self.hint, self.answer, self.price, self.changes, self.note):
            column.addWidget(part)
            part.hide()
        return column

    def _foot(self) -> QHBoxLayout:
        foot = QHBoxLayout()
        foot.setContentsMargins(_SIDES, 10, _SIDES, 12)
        foot.setSpacing(4)
        self.help_ = button(tr("Choose lines"), "secondary")
        self.help_.clicked.connect(self.helped)
        self.help_.hide()
        self.apply = button(tr("Apply"), "primary")
        self.apply.clicked.connect(self._take)
        self.cancel = button(tr("Cancel"), "quiet")
        self.cancel.clicked.connect(self.closed)
        foot.addStretch(1)
        for part in (self.cancel, self.help_, self.apply):
            foot.addWidget(part)
        return foot

    # -- what it shows

    def show_wishes(self, wishes: Sequence[TargetView], hint: str = "") -> None:
        """Show these wishes; a field that is typed into keeps what is typed."""
        if [wish.key for wish in wishes] != list(self.wishes):
            self._lay(wishes)
        for wish in wishes:
            row = self.wishes[wish.key]
            row.show_view(wish)
            self._target.setFixedWidth(row.field.width())
        self._heading.setVisible(bool(wishes))
        self.hint.setText(hint)
        self.hint.setVisible(bool(hint))

    def show_answer(
        self,
        answer: str = "",
        tone: str = "",
        price: str = "",
        changes: str = "",
        note: str = "",
        *,
        can_apply: bool = False,
    ) -> None:
        """Show what came out: a sentence in a ``tone`` of "", "ok" or "warn", and what moves with it."""
        parts = (self.answer, self.price, self.changes, self.note)
        for part, words in zip(parts, (answer, price, changes, note), strict=True):
            part.setText(words)
            part.setVisible(bool(words))
        self._tone, self._can_apply = tone, can_apply
        self._follow_typing()

    def show_hands(self, shown: bool) -> None:
        """Show what handles on the bust are dragged at, unless no line reshapes the bust."""
        self.hand.setVisible(shown)

    def show_hand(self, kind: str) -> None:
        """Show what the handles drag; a profile is that of one side."""
        self._kind = kind
        self.hand.set_choice(kind)
        self.link.setEnabled(kind != "profile")

    def show_help(self, shown: bool, locked: bool = False) -> None:
        """Remove Apply while lines are missing, or all ``locked``; the button leads out of that."""
        self.help_.setText(tr("Unlock lines") if locked else tr("Choose lines"))
        self.help_.setVisible(shown)
        self.apply.setVisible(not shown)
        for part in (self.add, self.link, self.optional, self.hand):
            part.setVisible(not shown)

    def show_optional(self, words: str, chosen: bool) -> None:
        """Show whether lines that are off may be switched on; without ``words`` there are none."""
        set_tip(self.optional, words or tr("No inactive line can reshape the body"))
        self.optional.setEnabled(bool(words))
        self.optional.setChecked(chosen)

    def take_focus(self, key: str) -> None:
        """Let a wish be typed at once."""
        if key in self.wishes:
            self.wishes[key].field.setFocus(Qt.FocusReason.TabFocusReason)
            self.wishes[key].field.selectAll()

    def _lay(self, wishes: Sequence[TargetView]) -> None:
        """Lay out the rows of these wishes: those that are there stay what they are."""
        kept = {wish.key: self.wishes.get(wish.key) or self._made(wish) for wish in wishes}
        gone = [row for key, row in self.wishes.items() if key not in kept]
        self.wishes = kept
        for row in (*gone, *kept.values()):
            self._rows.removeWidget(row)
        for row in kept.values():
            self._rows.addWidget(row)
        for row in gone:
            self._put_away(row)

    def _made(self, wish: TargetView) -> TargetRow:
        row = TargetRow(wish)
        row.field.entered.connect(partial(self.entered.emit, wish.key))
        row.field.typed.connect(self._follow_typing)
        row.prioritized.connect(partial(self.prioritized.emit, wish.key))
        row.switched.connect(self.limited)
        row.remove.clicked.connect(partial(self._remove, wish.key))
        return row

    def _put_away(self, row: TargetRow) -> None:
        """Let a row go; what is typed in it asks for nothing any more, and the keyboard stays near."""
        row.field.blockSignals(True)
        had = self.focusWidget()
        if had is not None and row.isAncestorOf(had) and had.hasFocus() and self.hand.isVisible():
            self.hand.button(self._kind).setFocus(Qt.FocusReason.OtherFocusReason)
        row.hide()
        row.deleteLater()

    # -- what is typed

    def commit(self) -> bool:
        """Submit the value being typed; returns whether it is valid."""
        taken = [row.field.commit() for row in tuple(self.wishes.values())]  # all of them, whatever one says
        return all(taken)

    def drop_typed(self) -> None:
        """Leave what is still being typed as it was."""
        for row in self.wishes.values():
            row.field.drop()

    def _follow_typing(self) -> None:
        """Let the answer be faint while another figure is typed, which can be applied at once."""
        typed = any(row.field.isModified() for row in self.wishes.values())
        set_tag(self.answer, "tone", "faint" if typed else self._tone)
        for part in (self.price, self.changes):
            set_tag(part, "tone", "faint" if typed else "")
        self.apply.setEnabled(typed or self._can_apply)

    def _take(self) -> None:
        if self.commit():
            self.applied.emit()

    def _choose_hand(self, kind: str) -> None:
        self.commit()
        self.hand_chosen.emit(kind)

    def _ask_more(self) -> None:
        self.commit()
        self.add_requested.emit()

    def _remove(self, key: str, _: bool = False) -> None:
        self.wishes[key].field.drop()
        self.commit()
        self.removed.emit(key)
