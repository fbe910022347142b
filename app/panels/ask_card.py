"""The card on the view in which the result is asked for: wishes, the answer, what would change."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from PySide6.QtCore import QEvent, QObject, Qt, Signal
from PySide6.QtGui import QHideEvent
from PySide6.QtWidgets import QGridLayout, QHBoxLayout, QLabel, QVBoxLayout, QWidget

from app.dress.parts import IconLabel, OverCard, Segment, ToolButton, button, sentence
from app.dress.theme import label, set_tag
from app.dress.tip import set_tip
from app.panels.wish_row import WishRow, WishView
from app.wording.words import tr

WIDTH = 674
"""Width of what the card holds [px]."""

_COLUMNS = 2
_BETWEEN = 20  # columns [px]
_MOST = 0.5  # of the height of the view: what is more hides what is asked for [1]


class AskCard(OverCard):
    """Takes wishes and shows what comes of them.

    ``entered`` carries a wish's key and its value, ``removed`` its key; ``add_asked`` wants the menu under
    ``add``. ``hand_chosen`` carries what the handles drag: "bust", "apex" or "profile"; ``linked`` whether
    they move both sides; ``prioritized`` a wish's key and its priority, ``optional_chosen`` whether lines
    that are off may be switched on. ``applied`` and ``left`` end it; ``helped`` is the button that shows when
    nothing can be asked.
    """

    entered = Signal(str, float)
    removed = Signal(str)
    prioritized = Signal(str, str)
    optional_chosen = Signal(bool)
    add_asked = Signal()
    hand_chosen = Signal(str)
    linked = Signal(bool)
    applied = Signal()
    left = Signal()
    helped = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.wishes: dict[str, WishRow] = {}
        self._kind, self._tone, self._can_apply = "bust", "", False
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
        if parent is not None:
            parent.installEventFilter(self)
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
        self.answer, self.price = sentence("", "name"), sentence("")
        self.changes, self.note = sentence(""), sentence("", "caption")
        for part in (self.answer, self.price, self.changes, self.note):
            said.addWidget(part)
        return said

    def _foot(self) -> QHBoxLayout:
        """Return the row of what is pressed: the card grows upwards from it, so it keeps its place."""
        foot = QHBoxLayout()
        foot.setSpacing(4)
        hands = [("bust", tr("Bust point")), ("apex", tr("Foremost place")), ("profile", tr("Profile"))]
        self.hand = Segment(hands, small=True)
        self.hand.setAccessibleName(tr("What is dragged on the body"))
        self.hand.chosen.connect(self._choose_hand)
        self.link = ToolButton("link", tr("Drag left and right together"), size=16, room=28)
        self.link.setCheckable(True)
        self.link.setChecked(True)
        self.link.toggled.connect(self.linked)
        self.add = button(tr("Add a wish"), "quiet")
        self.add.clicked.connect(self._ask_more)
        self.details = button(tr("Details"), "quiet")
        self.details.setCheckable(True)
        self.details.clicked.connect(self._fit)
        self.help_ = button(tr("Choose lines"), "secondary")
        self.help_.clicked.connect(self.helped)
        self.help_.hide()
        self.apply = button(tr("Apply"), "primary")
        self.apply.clicked.connect(self._take)
        self.cancel = button(tr("Cancel"), "quiet")
        self.cancel.clicked.connect(self.left)
        self.optional = ToolButton("bands", size=16, room=28)
        self.optional.setCheckable(True)
        self.optional.setAccessibleName(tr("Use inactive lines"))
        self.optional.clicked.connect(self.optional_chosen)
        for part in (self.hand, self.link, self.optional, self.add, self.details):
            foot.addWidget(part)
        foot.addStretch(1)
        for part in (self.help_, self.apply, self.cancel):
            foot.addWidget(part)
        return foot

    # -- what it shows

    def show_wishes(self, wishes: Sequence[WishView], hint: str = "") -> None:
        """Show these wishes; a field that is typed into keeps what is typed."""
        if [wish.key for wish in wishes] != list(self.wishes):
            self._lay(wishes)
        for wish in wishes:
            self.wishes[wish.key].show_view(wish)
        self._hint.setText(hint)
        self._hint.setVisible(bool(hint))
        self._fit()

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
        """Show what came out: a sentence in a ``tone`` of "", "ok" or "warn", and what moves with it.

        ``changes`` of lines and a ``note`` are folded where they would hide what is asked for.
        """
        parts = (self.answer, self.price, self.changes, self.note)
        for part, words in zip(parts, (answer, price, changes, note), strict=True):
            part.setText(words)
            part.setVisible(bool(words))
        self._tone, self._can_apply = tone, can_apply
        self._follow_typing()
        self._fit()

    def show_hand(self, kind: str) -> None:
        """Show what the handles drag; a profile is that of one side."""
        self._kind = kind
        self.hand.set_choice(kind)
        self.link.setEnabled(kind != "profile")

    def show_help(self, shown: bool, locked: bool = False) -> None:
        """Take Apply away while lines are missing, or all ``locked``; the button leads out of that."""
        self.help_.setText(tr("Unlock them") if locked else tr("Choose lines"))
        self.help_.setVisible(shown)
        self.apply.setVisible(not shown)
        for part in (self.add, self.link, self.optional, self.hand):
            part.setVisible(not shown)

    def show_optional(self, words: str, chosen: bool) -> None:
        """Show whether lines that are off may be switched on; without ``words`` there are none."""
        set_tip(self.optional, words or tr("No inactive line can move the body"))
        self.optional.setEnabled(bool(words))
        self.optional.setChecked(chosen)

    def take_focus(self, key: str) -> None:
        """Let a wish be typed at once."""
        if key in self.wishes:
            self.wishes[key].field.setFocus(Qt.FocusReason.TabFocusReason)
            self.wishes[key].field.selectAll()

    def _lay(self, wishes: Sequence[WishView]) -> None:
        """Lay out the rows of these wishes: those that are there stay what they are."""
        kept = {wish.key: self.wishes.get(wish.key) or self._made(wish) for wish in wishes}
        gone = [row for key, row in self.wishes.items() if key not in kept]
        self.wishes = kept
        for row in (*gone, *kept.values()):
            self._grid.removeWidget(row)
        at = 0
        for row in kept.values():
            wide = row.breadth is None or row.breadth > (WIDTH - _BETWEEN) // _COLUMNS
            at += at % _COLUMNS if wide else 0
            self._grid.addWidget(row, at // _COLUMNS, at % _COLUMNS, 1, _COLUMNS if wide else 1)
            at += _COLUMNS if wide else 1
        for row in gone:
            self._put_away(row)

    def _made(self, wish: WishView) -> WishRow:
        row = WishRow(wish)
        row.field.entered.connect(partial(self.entered.emit, wish.key))
        row.field.typed.connect(self._follow_typing)
        row.prioritized.connect(partial(self.prioritized.emit, wish.key))
        row.remove.clicked.connect(partial(self._remove, wish.key))
        return row

    def _put_away(self, row: WishRow) -> None:
        """Let a row go; what is typed in it asks for nothing any more, and the keyboard stays near."""
        row.field.blockSignals(True)
        had = self.focusWidget()
        if had is not None and row.isAncestorOf(had) and had.hasFocus() and self.hand.isVisible():
            self.hand.button(self._kind).setFocus(Qt.FocusReason.OtherFocusReason)
        row.hide()
        row.deleteLater()

    # -- what is typed

    def commit(self) -> bool:
        """Ask for what is still being typed; tells whether it can be."""
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
        self.add_asked.emit()

    def _remove(self, key: str, _: bool = False) -> None:
        self.wishes[key].field.drop()
        self.commit()
        self.removed.emit(key)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 - Qt names it
        """Fold and unfold as the view gets lower and higher."""
        if event.type() == QEvent.Type.Resize and self.isVisible():
            self._fit()
        return super().eventFilter(watched, event)

    def hideEvent(self, event: QHideEvent) -> None:  # noqa: N802 - Qt names it
        """Begin folded the next time."""
        super().hideEvent(event)
        self.details.setChecked(False)

    def _fit(self) -> None:
        """Be as high as what is shown; changes and note are folded where that is too high, unless opened."""
        self._grow(folded=False)
        view, (_, above, _, below) = self.parentWidget(), self.MARGINS
        foldable = bool(self.changes.text() or self.note.text())
        tight = view is not None and self.height() - above - below > _MOST * view.height()
        self.details.setVisible(foldable and tight)
        if foldable and tight:
            self._grow(folded=not self.details.isChecked())

    def _grow(self, *, folded: bool) -> None:
        for part in (self.changes, self.note):
            part.setVisible(bool(part.text()) and not folded)
        parts: list[QLabel] = [self._hint, self.answer, self.price, self.changes, self.note]
        for part in parts:
            # A sentence that wraps is as high as it is at the width that it really gets.
            part.setMinimumHeight(part.heightForWidth(WIDTH) if part.text() else 0)
            part.updateGeometry()
        self.adjustSize()
