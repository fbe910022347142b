"""Cards of what is selected: a piece with its cloth, a seam with its lengths and a knob to walk it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import Qt, Signal, SignalInstance
from PySide6.QtGui import QAction
from PySide6.QtWidgets import (
    QCheckBox,
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QSlider,
    QVBoxLayout,
    QWidget,
)

from app.gui.features.pattern.dart_view import DartChartView
from app.gui.theme.stylesheet import font, label, set_tag
from app.gui.widgets.basic import button, sentence
from app.gui.widgets.menu import Menu, pull_down
from app.gui.widgets.option_field import AmountEdit, OptionCombo
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import number, tr
from app.i18n.lengths import length, length_number
from app.presenters.messages import own_title
from app.presenters.model_options import Amount, length_amount
from app.presenters.pattern import PieceRow, SeamRow
from core.document.block import LARGEST_ALLOWANCE, WAY, Seam
from core.document.cloth import Cloth
from core.messages import ClothName

if TYPE_CHECKING:
    from core.pattern.dart_chart import DartChart

STEPS = 200
"""Places of the knob along a seam."""

_RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
_MOST_FIXES = 4  # fixes that are suggested at once


class _Card(QFrame):
    """A framed card with a heading and rows of a title and a field."""

    def __init__(self) -> None:
        super().__init__()
        set_tag(self, "kind", "card")
        self.column = QVBoxLayout(self)
        self.column.setContentsMargins(12, 10, 12, 12)
        self.column.setSpacing(6)
        self.heading = label("", "name")
        self.column.addWidget(self.heading)
        self.hide()

    def add_field(self, title: str, tip: str, field: QWidget) -> None:
        """Add a row with a field at the right."""
        row, words = QHBoxLayout(), label(title, "secondary")
        field.setAccessibleName(title)
        for each in (words, field):
            set_tip(each, tip)
        row.addWidget(words)
        row.addStretch(1)
        row.addWidget(field)
        self.column.addLayout(row)


class PieceCard(_Card):
    """The selected piece: its strain, its cloth and grain line, and fixes where it exceeds the limit.

    ``fixes_requested`` and ``chart_requested`` start their computation; ``fix_chosen`` carries the number of
    a fix, ``dart_chosen`` and ``dart_requested`` a Dart of the chart: one to show, one to add. ``extended``:
    fixes, a note or a chart were added at its end.
    """

    cloth_chosen = Signal(str)
    cloth_table_requested = Signal()
    stretch_test_requested = Signal()
    turn_changed = Signal(float)
    fixes_requested = Signal()
    fix_chosen = Signal(int)
    chart_requested = Signal()
    dart_chosen = Signal(object)
    dart_requested = Signal(object)
    extended = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.reason, self.facts = sentence("", "secondary"), sentence("", "secondary")
        set_tag(self.reason, "tone", "warn")
        self.cloth = OptionCombo(elides=Qt.TextElideMode.ElideRight)
        self.cloth.setMinimumHeight(28)
        self._menu = Menu(self)
        self.cloth.clicked.connect(lambda: pull_down(self._menu, self.cloth))
        turn = Amount("turn", tr("Grain line rotation"), "", "°", 1.0, 0, (-90.0, 90.0))
        self.turn = AmountEdit(turn)
        self.turn.entered.connect(self.turn_changed.emit)
        self.column.addWidget(self.reason)
        self.column.addWidget(self.facts)
        self.add_field(tr("Cloth"), tr("Set the cloth of the piece on both sides"), self.cloth)
        tip = tr("Rotate the grain line: 0° is up on the body")
        self.add_field(turn.title, tip, self.turn)
        self._fixes = QVBoxLayout()
        self._fixes.setSpacing(4)
        self.column.addLayout(self._fixes)
        self.column.addWidget(self._make_chart())
        self.column.addLayout(self._make_buttons())

    def _make_buttons(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(6)
        self.suggest = button(tr("Suggest fixes"))
        set_tip(self.suggest, tr("Compute the strain with a dart, another cloth or one more seam"))
        self.suggest.clicked.connect(self.fixes_requested)
        self.chart = button(tr("Dart chart"))
        set_tip(self.chart, tr("Compute the remaining strain for darts all round the piece"))
        self.chart.clicked.connect(self.chart_requested)
        row.addWidget(self.suggest)
        row.addWidget(self.chart)
        row.addStretch(1)
        return row

    def _make_chart(self) -> QWidget:
        holder = self._charted = QWidget()
        column, row = QVBoxLayout(holder), QHBoxLayout()
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(4)
        self.darts, self.dart_words = DartChartView(), sentence("", "secondary")
        self.darts.chosen.connect(self.dart_chosen)
        self.darts.chosen.connect(lambda _: self.dart_words.setText(self.darts.words()))
        add = button(tr("Add dart"))
        add.clicked.connect(lambda: self.dart_requested.emit(self.darts.dart))
        row.addWidget(self.dart_words, 1)
        row.addWidget(add)
        column.addWidget(self.darts)
        column.addLayout(row)
        holder.hide()
        return holder

    def show_chart(self, chart: DartChart | None, limit: float) -> None:
        """Show what darts leave, beside the limit of the cloth [1]; None hides the chart."""
        self._charted.setVisible(chart is not None)
        if chart is not None:
            self.darts.show_chart(chart, limit)
            self.dart_words.setText(self.darts.words())
            self.extended.emit()

    def show_piece(self, row: PieceRow | None, cloths: Sequence[Cloth], cloth: str, turn: float) -> None:
        """Show a piece, made of the cloth of this name; None hides the card."""
        self.setVisible(row is not None)
        if row is None:
            return
        self.heading.setText(row.title)
        self.reason.setText(row.reason or row.note)
        self.reason.setVisible(bool(self.reason.text()))
        self.facts.setText(_facts(row))
        self.suggest.setVisible(not row.fits)
        self.turn.show_value(turn)
        self._fill_menu(cloths, cloth)

    def _fill_menu(self, cloths: Sequence[Cloth], chosen: str) -> None:
        self._menu.clear()
        for cloth in cloths:
            title = own_title(ClothName(cloth.title))
            action = self._menu.addAction(title)
            action.setCheckable(True)
            action.setChecked(cloth.name == chosen)
            action.triggered.connect(lambda _=False, name=cloth.name: self.cloth_chosen.emit(name))
            if cloth.name == chosen:
                self.cloth.setText(title)
        self._menu.addSeparator()
        self._menu.addAction(tr("Cloth from table…")).triggered.connect(self.cloth_table_requested)
        self._menu.addAction(tr("Save table of the 10 cm test…")).triggered.connect(
            self.stretch_test_requested
        )

    def show_fixes(self, words: Sequence[str], note: str = "") -> None:
        """Show fixes by their sentences, the best first, or a ``note``."""
        while self._fixes.count():
            item = self._fixes.takeAt(0)
            if item is not None and (old := item.widget()) is not None:
                old.deleteLater()
        if note:
            self._fixes.addWidget(sentence(note, "caption"))
        for place, text in enumerate(words[:_MOST_FIXES]):
            press = _FixButton(text)
            press.clicked.connect(_emitting(self.fix_chosen.emit, place))
            self._fixes.addWidget(press)
        if note or words:
            self.extended.emit()


def _facts(row: PieceRow) -> str:
    """Return strain, area and stretch of a piece; its strain is left out where the reason has it."""
    strain = tr("Strain {strain} % on 95 % of the area, limit {limit} %.").format(
        strain=number(row.strain_percent, 1), limit=number(row.limit_percent, 0)
    )
    across, down = (number(value, 1) for value in row.stretch_percent)
    facts = (
        "" if row.is_overstrained else strain,
        tr("Area {area} cm².").format(area=number(row.area_cm2, 0)),
        tr("Mean stretch when worn: {across} % across, {down} % down.").format(across=across, down=down),
    )
    return " ".join(filter(None, facts))


class _FixButton(QFrame):
    """A fix: its strain, and a button that applies it."""

    def __init__(self, text: str) -> None:
        super().__init__()
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(8)
        row.addWidget(sentence(text, "secondary"), 1)
        self._press = button(tr("Apply"))
        self._press.setAccessibleDescription(text)
        self.clicked = self._press.clicked
        row.addWidget(self._press, alignment=Qt.AlignmentFlag.AlignTop)


class SeamCard(_Card):
    """The selected seam: its lengths on the body and on both pieces, its allowance, and a knob to walk it.

    ``walked`` carries the share of the length at the knob [1], ``notch_requested`` that of a new notch,
    ``notches_changed`` an empty tuple for none or None for the usual ones.
    """

    allowance_changed = Signal(object)
    walked = Signal(object)
    apart_changed = Signal(bool)
    joined_changed = Signal(bool)
    reset_requested = Signal()
    point_requested = Signal()
    point_removed = Signal()
    seam_removed = Signal()
    notch_requested = Signal(object)
    notches_changed = Signal(object)

    def __init__(self) -> None:
        super().__init__()
        self._grid = QGridLayout()
        self._grid.setHorizontalSpacing(10)
        self._grid.setVerticalSpacing(3)
        self._grid.setColumnStretch(0, 1)
        self._cells: list[QLabel] = []
        self.note = sentence("", "secondary")
        set_tag(self.note, "tone", "warn")
        self.hint = sentence(
            tr("Drag points on the body to move them; double-click the seam to add one."), "caption"
        )
        amount = length_amount("allowance", tr("Seam allowance"), "", (0.0, LARGEST_ALLOWANCE), optional=True)
        self.allowance = AmountEdit(amount)
        self.allowance.entered.connect(self.allowance_changed.emit)
        self.column.addLayout(self._grid)
        self.column.addWidget(self.note)
        tip = tr("Leave empty to use the allowance of the pattern")
        self.add_field(amount.title, tip, self.allowance)
        self.column.addLayout(self._make_walk())
        self.joined = QCheckBox(tr("Pieces edge to edge"))
        self.joined.setFont(font("secondary"))
        set_tip(
            self.joined, tr("Lay both pieces edge to edge at the slider position to check corners and curves")
        )
        self.joined.clicked.connect(self.joined_changed)
        self.column.addWidget(self.joined)
        self.column.addLayout(self._make_menus())
        self.apart = QCheckBox(tr("Edit sides separately"))
        self.apart.setFont(font("secondary"))
        set_tip(self.apart, tr("Move points of the left and right seam separately"))
        self.apart.clicked.connect(self.apart_changed)
        self.column.addWidget(self.apart)
        self.column.addWidget(self.hint)

    def _make_menus(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(6)
        self.edit, menu = OptionCombo(), Menu(self)
        self.edit.setText(tr("Edit seam"))
        self.edit.clicked.connect(lambda: pull_down(menu, self.edit))
        self.add_point = _entry(menu, tr("Add point"), self.point_requested)
        self.remove_point = _entry(menu, tr("Remove point"), self.point_removed)
        self.reset = _entry(menu, tr("Reset seam"), self.reset_requested)
        self.remove = _entry(menu, tr("Remove seam"), self.seam_removed)
        self.notches, marks = OptionCombo(), Menu(self)
        self.notches.clicked.connect(lambda: pull_down(marks, self.notches))
        self.add_notch = marks.addAction(tr("Add notch here"))
        self.add_notch.triggered.connect(lambda: self.notch_requested.emit(self.knob.value() / STEPS))
        none, usual = marks.addAction(tr("No notches")), marks.addAction(tr("Default notches"))
        none.triggered.connect(lambda: self.notches_changed.emit(()))
        usual.triggered.connect(lambda: self.notches_changed.emit(None))
        for each in (self.edit, self.notches):
            each.setMinimumHeight(28)
            row.addWidget(each)
        row.addStretch(1)
        return row

    def _make_walk(self) -> QHBoxLayout:
        row = QHBoxLayout()
        self.knob = QSlider(Qt.Orientation.Horizontal)
        self.knob.setRange(0, STEPS)
        self.knob.setAccessibleName(tr("Walk the seam"))
        self.so_far = label("", "caption", tabular=True)
        set_tip(self.knob, tr("Show the same position on the body and on both pieces"))
        self.knob.valueChanged.connect(lambda value: self.walked.emit(value / STEPS))
        row.addWidget(label(tr("Walk the seam"), "secondary"))
        row.addWidget(self.knob, 1)
        row.addWidget(self.so_far)
        return row

    def show_seam(
        self, title: str, rows: Sequence[SeamRow] | None, seam: Seam, usual: float, *, can_reset: bool
    ) -> None:
        """Show a seam by all pairs of pieces that it joins; one without pairs is an edge.

        None in place of ``rows``: lengths are not computed yet, those of the same seam stay. Without an
        allowance of its own it has the ``usual`` one [mm]. It ``can_reset`` where it differs from the
        built-in block.
        """
        if rows is not None or title != self.heading.text():
            self._show_rows(rows)
        self.show()
        self.heading.setText(title)
        self.allowance.show_value(seam.allowance)
        self.allowance.setPlaceholderText(length_number(usual, 1))
        self.apart.setVisible(seam.each and seam.kind == WAY)
        self.apart.setChecked(bool(seam.right))
        self.reset.setEnabled(can_reset)
        self.add_point.setEnabled(seam.kind == WAY)
        count = None if seam.notches is None else len(seam.notches)
        words = tr("Notches: default") if count is None else tr("Notches: {count}").format(count=count)
        self.notches.setText(words)

    def _show_rows(self, rows: Sequence[SeamRow] | None) -> None:
        if rows is None:
            self.note.hide()
            self._show_lines([])
            return
        self.add_notch.setEnabled(bool(rows))
        self.joined.setEnabled(bool(rows))
        self.note.setText(" ".join(row.note for row in rows if row.note))
        self.note.setVisible(bool(self.note.text()))
        lines: list[tuple[str, str]] = []
        for row in rows:
            if len(rows) > 1:
                lines.append((" | ".join(row.pieces), ""))
            (first, second), (one, other) = row.lengths_mm, row.alone_mm
            lines += [
                (tr("On the body"), length(row.on_body_mm, 1)),
                (tr("Each piece alone"), f"{length_number(one, 1)} / {length(other, 1)}"),
                (tr("Matched"), f"{length_number(first, 1)} / {length(second, 1)}"),
            ]
        self._show_lines(lines or [(tr("Edge, not sewn"), "")])

    def show_walked(self, words: str) -> None:
        """Show the lengths up to the knob."""
        self.so_far.setText(words)

    def _show_lines(self, lines: Sequence[tuple[str, str]]) -> None:
        for old in self._cells:
            old.deleteLater()
        self._cells = []
        for at, (title, value) in enumerate(lines):
            words, figure = label(title, "secondary"), label(value, "secondary", tabular=True)
            self._grid.addWidget(words, at, 0)
            self._grid.addWidget(figure, at, 1, _RIGHT)
            self._cells += [words, figure]


def _entry(menu: Menu, text: str, signal: SignalInstance) -> QAction:
    """Add an entry to a menu that emits a signal."""
    action = menu.addAction(text)
    action.triggered.connect(lambda _=False: signal.emit())
    return action


def _emitting(emit: Callable[[int], Any], place: int) -> Callable[[], None]:
    return lambda: emit(place)
