"""Card of the cups above the lines: their kind, shape and wire, and what they do."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QCheckBox, QFrame, QGridLayout, QHBoxLayout, QLabel, QVBoxLayout, QWidget

from app.gui.theme.stylesheet import font, label, set_tag
from app.gui.widgets.amount_slider import AmountSlider
from app.gui.widgets.basic import Segment, ToolButton, button, hairline, sentence
from app.gui.widgets.option_field import AmountEdit
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr
from app.presenters.cups import (
    AMOUNTS,
    NO_CUPS,
    CupFitView,
    FitRow,
    amounts,
    coverage_choice,
    cup_notes,
    kind_choice,
    wire_texts,
)
from app.presenters.model_options import Amount, Choice
from core.document.cup import Cup
from core.document.design import Design

_RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
_COLUMN = 44  # width of the values of one side [px]


class AmountRow(QWidget):
    """One number of a cup: its title, a slider, and a field to type it in."""

    previewed = Signal(float)
    committed = Signal(float)
    cancelled = Signal()

    def __init__(self, amount: Amount, neutral: float, room: int) -> None:
        super().__init__()
        title = label(amount.title, "secondary")
        title.setMinimumWidth(room)
        self.slider = AmountSlider(amount, 0.01 if amount.unit == "%" else 1.0, neutral)
        self.edit = AmountEdit(amount)
        self.edit.setFixedWidth(70)
        self.edit.setProperty("kind", "number")
        self.edit.setAccessibleName(amount.title)
        self.edit.setAccessibleDescription(amount.tip)
        self.edit.tip = amount.tip
        for each in (title, self.slider, self.edit):
            set_tip(each, amount.tip)
        self.slider.previewed.connect(self.previewed)
        self.slider.previewed.connect(self.edit.show_value)
        self.slider.committed.connect(self.committed)
        self.slider.cancelled.connect(self.cancelled)
        self.edit.entered.connect(self.committed.emit)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(4)
        row.addWidget(title)
        row.addWidget(self.slider, 1)
        row.addWidget(self.edit)

    def show_value(self, value: float) -> None:
        """Show a value; nothing is emitted."""
        self.slider.show_amount(value)
        self.edit.show_value(value)


class FitTable(QWidget):
    """What cups do: values of the left and the right one beside each other."""

    def __init__(self) -> None:
        super().__init__()
        self._grid = QGridLayout(self)
        self._grid.setContentsMargins(0, 0, 0, 0)
        self._grid.setHorizontalSpacing(6)
        self._grid.setVerticalSpacing(2)
        self._grid.setColumnStretch(0, 1)
        for column, title in enumerate((tr("left"), tr("right")), start=1):
            head = label(title, "caption")
            head.setAlignment(_RIGHT)
            head.setMinimumWidth(_COLUMN)
            self._grid.addWidget(head, 0, column)
        self.rows: list[tuple[QLabel, ...]] = []

    def show_rows(self, rows: tuple[FitRow, ...], faint: bool) -> None:
        """Show these values; ``faint`` ones are of a former shape."""
        while len(self.rows) < len(rows):
            self._add()
        for place, parts in enumerate(self.rows):
            for part in parts:
                part.setVisible(place < len(rows))
        for row, parts in zip(rows, self.rows, strict=False):
            texts = (row.title, *row.values, row.unit)
            tones = ("", *row.tones, "")
            for part, text, tone in zip(parts, texts, tones, strict=True):
                part.setText(text)
                set_tip(part, row.tip)
                set_tag(part, "tone", "faint" if faint else tone)
            parts[0].setAccessibleName(f"{row.title}: {' / '.join(row.values)} {row.unit}")

    def _add(self) -> None:
        at = len(self.rows) + 1
        roles = "secondary", "title", "title", "caption"
        parts = tuple(label("", role, tabular=True) for role in roles)
        for column, part in enumerate(parts):
            if column in (1, 2):
                part.setAlignment(_RIGHT)
            self._grid.addWidget(part, at, column)
        self.rows.append(parts)


class CupCard(QFrame):
    """The cups of a design; signals name a field of ``Cup`` and carry its value.

    ``kind_chosen`` carries a kind, or an empty text for no cups; ``map_requested`` whether the map of
    contact pressure is to be shown.
    """

    kind_chosen = Signal(str)
    previewed = Signal(str, float)
    changed = Signal(str, object)
    cancelled = Signal()
    map_requested = Signal(bool)

    def __init__(self) -> None:
        super().__init__()
        self._mapped = self._folded = False
        self._kind = NO_CUPS
        set_tag(self, "kind", "card")
        self.setAccessibleName(tr("Cups"))
        self.kind, self.coverage = _segment(kind_choice()), _segment(coverage_choice())
        self.kind.chosen.connect(self.kind_chosen)
        self.coverage.chosen.connect(lambda name: self.changed.emit("coverage", name))
        self.fold = ToolButton("caret-down", tr("Hide or show the settings of the cups"), size=12, room=22)
        self.fold.clicked.connect(self._toggle)
        self.notes, self.warnings = sentence("", "caption"), sentence("", "secondary")
        set_tag(self.warnings, "tone", "warn")
        self._make_rows()
        column = QVBoxLayout(self)
        column.setContentsMargins(10, 6, 8, 8)
        column.setSpacing(4)
        head = QHBoxLayout()
        head.setSpacing(2)
        head.addWidget(label(tr("Cups"), "name"))
        head.addWidget(self.fold)
        head.addStretch(1)
        head.addWidget(self.kind)
        column.addLayout(head)
        column.addWidget(self._make_body())
        column.addWidget(self.notes)
        self.show_design(None)
        self.show_fit(None, faint=False)

    def show_design(self, design: Design | None) -> None:
        """Show the cups of a design; nothing is emitted."""
        cup = design.cup if design is not None else None
        former, self._kind = self._kind, NO_CUPS if cup is None else cup.kind
        if former == NO_CUPS and self._kind != NO_CUPS:
            self._folded = False  # who chooses cups wants to shape them
        self.kind.set_choice(self._kind)
        values = cup or Cup()
        self.coverage.set_choice(values.coverage)
        for key, row in self.rows.items():
            row.show_value(getattr(values, key))
            row.setVisible(values.wire if key == "wire_width" else key in AMOUNTS.get(self._kind, ()))
        self.wire.setChecked(values.wire)
        self.notes.setText("" if design is None else cup_notes(design))
        self._show_parts()

    def show_fit(self, view: CupFitView | None, faint: bool) -> None:
        """Show what the cups do, ``faint`` where that was of a former shape."""
        self._fit.setVisible(view is not None)
        if view is None:
            return
        self.lift.setText(view.lift)
        self.lift.setVisible(bool(view.lift))
        set_tag(self.lift, "tone", "faint" if faint else "")
        self.word.setText(view.word)
        self.word.setVisible(bool(view.word) and not faint)
        set_tag(self.word, "tone", view.tone)
        self.table.show_rows(view.rows, faint)
        self.table.setVisible(bool(view.rows))
        self.warnings.setText("\n".join(view.warnings))
        self.warnings.setVisible(bool(view.warnings))

    def show_map(self, on: bool) -> None:
        """Show by the button whether the map of contact pressure is on the body."""
        self._mapped = on
        self.look.setText(tr("Hide map") if on else tr("Show on body"))

    def _make_rows(self) -> None:
        self.rows: dict[str, AmountRow] = {}
        every = amounts()
        room = max(label(each.title, "secondary").sizeHint().width() for each in every.values())
        for key, amount in every.items():
            row = self.rows[key] = AmountRow(amount, getattr(Cup(), key), room)
            row.previewed.connect(lambda value, key=key: self.previewed.emit(key, value))
            row.committed.connect(lambda value, key=key: self.changed.emit(key, value))
            row.cancelled.connect(self.cancelled)

    def _make_body(self) -> QWidget:
        self._body = QWidget()
        column = QVBoxLayout(self._body)
        column.setContentsMargins(0, 2, 0, 0)
        column.setSpacing(2)
        choice = coverage_choice()
        row, title = QHBoxLayout(), label(choice.title, "secondary")
        set_tip(title, choice.tip)
        row.addWidget(title)
        row.addStretch(1)
        row.addWidget(self.coverage)
        column.addLayout(row)
        column.addSpacing(2)
        for key, each in self.rows.items():
            if key != "wire_width":
                column.addWidget(each)
        self.wire = QCheckBox(wire_texts()[0])
        self.wire.setFont(font("secondary"))
        set_tip(self.wire, wire_texts()[1])
        self.wire.clicked.connect(lambda on: self.changed.emit("wire", on))
        column.addWidget(self.wire)
        column.addWidget(self.rows["wire_width"])
        column.addWidget(self._make_fit())
        return self._body

    def _make_fit(self) -> QWidget:
        self._fit, self.table = QWidget(), FitTable()
        self.lift, self.word = label("", "title", tabular=True), label("", "secondary")
        self.look = button(tr("Show on body"), "word")
        set_tip(self.look, tr("Show the contact pressure map on the body"))
        self.look.clicked.connect(lambda: self.map_requested.emit(not self._mapped))
        column, head, foot = QVBoxLayout(self._fit), QHBoxLayout(), QHBoxLayout()
        column.setContentsMargins(0, 4, 0, 0)
        column.setSpacing(4)
        column.addWidget(hairline())
        head.addWidget(self.lift, 1)
        column.addLayout(head)
        column.addWidget(self.table)
        column.addWidget(self.warnings)
        foot.setSpacing(4)
        foot.addWidget(self.word)
        foot.addStretch(1)
        foot.addWidget(self.look)
        column.addLayout(foot)
        return self._fit

    def _toggle(self) -> None:
        self._folded = not self._folded
        self._show_parts()

    def _show_parts(self) -> None:
        some = self._kind != NO_CUPS
        self.fold.setVisible(some)
        self.fold.show_icon("caret-right" if self._folded else "caret-down")
        self._body.setVisible(some and not self._folded)
        self.notes.setVisible(bool(self.notes.text()) and not (some and self._folded))


def _segment(choice: Choice) -> Segment:
    segment = Segment(choice.options, small=True)
    segment.setAccessibleName(choice.title)
    segment.setAccessibleDescription(choice.tip)
    for name, _ in choice.options:
        set_tip(segment.button(name), choice.tip)
    return segment
