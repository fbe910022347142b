"""The choice of an elastic for lines: the effect of each, those that cannot be used grey with the reason."""

# ruff: noqa: N802 - Qt names its events
from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QColor, QKeyEvent
from PySide6.QtWidgets import (
    QHBoxLayout,
    QPushButton,
    QTreeWidgetItem,
    QWidget,
)

from app.gui.features.garment.elastics_dialog import ElasticTable
from app.gui.theme.stylesheet import font, set_tag, tokens_of
from app.gui.widgets.basic import Segment, button, sentence
from app.gui.widgets.dialog import Dialog
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr
from app.i18n.lengths import length_unit
from app.presenters.elastics import AdviceView, ChoiceView
from app.presenters.pressure import TONES

TITLE, STRETCH, CUT, REACHED, LIFT, PRESSURE, NOTE = range(7)
"""The columns of the table."""

_RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter


class ElasticChooser(Dialog):
    """The elastics for some lines; ``chosen`` carries a row and whether it is used at its limit.

    ``mode_requested`` names what is to be kept, ``marked`` the row that advice is wanted for.
    """

    chosen = Signal(int, bool)
    mode_requested = Signal(str)
    marked = Signal(int)
    elastics_requested = Signal()

    def __init__(self, parent: QWidget, title: str, modes: Sequence[tuple[str, str]]) -> None:
        super().__init__(parent, title, (980, 620))
        self.modes, self.meaning = Segment(modes), sentence("", "secondary")
        self.modes.setVisible(bool(modes))
        self.modes.chosen.connect(self.mode_requested)
        self.table, self.advice = _Table(), sentence("", "secondary")
        self.problems = sentence("", "caption")
        self._offers = QHBoxLayout()
        self._offers.setSpacing(8)
        self._views: list[ChoiceView] = []
        self.body.addWidget(self.modes, 0, Qt.AlignmentFlag.AlignLeft)
        for each in (self.meaning, self.problems):
            self.body.addWidget(each)
        self.body.addWidget(self.table, 1)
        foot = QHBoxLayout()
        foot.setSpacing(12)
        self.advice.setMinimumHeight(3 * self.advice.fontMetrics().lineSpacing() + 4)
        foot.addWidget(self.advice, 1)
        foot.addLayout(self._offers)
        self.body.addLayout(foot)
        library = self.add_button(tr("Elastics…"), self.elastics_requested.emit, "quiet")
        set_tip(library, tr("View, import and export elastics"))
        self.foot.removeWidget(library)
        self.foot.insertWidget(0, library)
        self.add_button(tr("Cancel"), self.reject)
        self.use = self.add_button(tr("Use"), self._use, "primary")
        self.table.currentItemChanged.connect(self._mark)
        self.table.itemActivated.connect(lambda *_: self._use())

    def set_mode(self, mode: str, meaning: str) -> None:
        """Show what is kept, and what that means for cutting."""
        self.modes.set_choice(mode)
        self.meaning.setText(meaning)

    def set_problems(self, words: str) -> None:
        """Show which tables of one's own cannot be read."""
        self.problems.setText(words)
        self.problems.setVisible(bool(words))

    def set_rows(self, views: Sequence[ChoiceView]) -> None:
        """Show these elastics, as many as before or all anew."""
        self._views = list(views)
        for row, view in enumerate(views):
            self.table.show_row(row, view)
        self._enable()

    def set_row(self, row: int, view: ChoiceView) -> None:
        """Show one elastic anew."""
        self._views[row] = view
        self.table.show_row(row, view)
        self._enable()

    def set_current(self, row: int) -> None:
        """Mark the row of an elastic; without one the table has no keyboard, or Qt marks the first."""
        item = self.table.topLevelItem(row)
        if item is not None:
            self.table.setCurrentItem(item)
            self.table.setFocus()

    @property
    def current(self) -> int:
        """Return the marked row, or -1."""
        item = self.table.currentItem()
        return -1 if item is None else self.table.indexOfTopLevelItem(item)

    def views(self) -> Sequence[ChoiceView]:
        """Return the elastics as they are shown."""
        return self._views

    def offers(self) -> Sequence[str]:
        """Return the labels of the offers."""
        return [each.text() for each in self._offer_buttons()]

    def press_offer(self, place: int) -> None:
        """Click one of the suggestions."""
        self._offer_buttons()[place].click()

    def set_advice(self, view: AdviceView) -> None:
        """Show what the marked elastic does, with what can be done by one click."""
        self.advice.setText(view.words)
        set_tag(self.advice, "tone", view.tone)
        for each in self._offer_buttons():
            self._offers.removeWidget(each)
            each.hide()
            each.deleteLater()
            each.setParent(None)
        for label, row, limited in view.offers:
            offer = button(label)
            offer.setAutoDefault(False)
            offer.clicked.connect(lambda _=False, row=row, limited=limited: self.chosen.emit(row, limited))
            self._offers.addWidget(offer, 0, Qt.AlignmentFlag.AlignTop)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Let Enter in the table use the marked elastic."""
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and self.table.hasFocus():
            self._use()
            return
        super().keyPressEvent(event)

    def _offer_buttons(self) -> list[QPushButton]:
        items = (self._offers.itemAt(at) for at in range(self._offers.count()))
        widgets = (item.widget() for item in items if item is not None)
        return [each for each in widgets if isinstance(each, QPushButton)]

    def _mark(self) -> None:
        self._enable()
        if self.current >= 0:
            self.marked.emit(self.current)

    def _enable(self) -> None:
        self.use.setEnabled(0 <= self.current < len(self._views) and self._views[self.current].usable)

    def _use(self) -> None:
        if self.use.isEnabled():
            self.chosen.emit(self.current, False)


class _Table(ElasticTable):
    """The elastics with their effect."""

    def __init__(self) -> None:
        unit = length_unit()
        heads = (
            tr("Elastic"),
            tr("Elongation %"),
            tr("cut {unit}"),
            tr("on body {unit}"),
            tr("lift {unit}"),
            tr("pressure kPa"),
            "",
        )
        super().__init__([each.format(unit=unit) for each in heads], NOTE)
        for column in (STRETCH, CUT, REACHED, LIFT, PRESSURE):
            self.headerItem().setTextAlignment(column, _RIGHT)

    def show_row(self, row: int, view: ChoiceView) -> None:
        """Show an elastic in its row, which is made if it is the next one."""
        item = self.topLevelItem(row)
        if item is None:
            item = QTreeWidgetItem()
            for column in (STRETCH, CUT, REACHED, LIFT, PRESSURE):
                item.setTextAlignment(column, _RIGHT)
            self.addTopLevelItem(item)
        tokens = tokens_of(self)
        tones = {NOTE: tokens.text_quiet, STRETCH: tokens.warn if view.far else tokens.text}
        if view.light:
            tones[PRESSURE] = getattr(tokens, TONES[view.light])
        texts = (view.title, view.stretch, view.cut, view.reached, view.lift, view.pressure, view.note)
        model = self.model()
        model.blockSignals(True)  # Else all columns are measured anew for each cell.
        for column, text in enumerate(texts):
            item.setText(column, text)
            tone = tones.get(column, tokens.text) if view.usable else tokens.text_caption
            item.setForeground(column, QColor(tone))
        item.setFont(NOTE, font("secondary"))
        model.blockSignals(False)
        model.dataChanged.emit(model.index(row, 0), model.index(row, self.columnCount() - 1))
