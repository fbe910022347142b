"""Band and cup: the size in the system of the house, the other systems beside it, and how it was found."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QGridLayout, QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from app.gui.theme.stylesheet import font, label, set_tag
from app.gui.widgets.basic import Disclosure, button, hairline, sentence
from app.gui.widgets.tooltip import set_tip
from app.gui.widgets.value_edit import ValueEdit
from app.i18n.catalog import tr
from app.i18n.lengths import length, length_number
from app.presenters.sizes import SizeView
from core.measurements.sizes import ALLOWANCE

COLUMNS = 3
"""Other systems that stand beside each other."""


class SizeCard(QWidget):
    """The sizes of a body; ``chosen`` carries another system, ``allowed`` another allowance [mm]."""

    chosen = Signal(str)
    allowed = Signal(float)

    def __init__(self) -> None:
        super().__init__()
        self.views: tuple[SizeView, ...] = ()
        self.main, self.caution = label("", "hero"), _caution(Qt.AlignmentFlag.AlignLeft)
        self.others = QWidget()
        self._grid = QGridLayout(self.others)
        self._grid.setContentsMargins(0, 0, 0, 4)
        self._grid.setSpacing(2)
        self.within, self.rule, self.doubt, self.near = (sentence("", "secondary") for _ in range(4))
        set_tag(self.doubt, "tone", "warn")
        self.fold, self.doubts = Disclosure(tr("Notes on the size charts")), sentence("", "caption")
        self.fold.toggled.connect(self.doubts.setVisible)
        self.allowance = _AllowanceField("mm", tr("Tape tension allowance"), widest="20.0")
        self.allowance.entered.connect(self.allowed)
        column = QVBoxLayout(self)
        column.setContentsMargins(4, 2, 4, 6)
        column.setSpacing(4)
        column.addWidget(label(tr("Band and cup size, original body"), "caption"))
        column.addLayout(self._make_head())
        for each in (
            self.within,
            self.others,
            self.rule,
            self.doubt,
            self.near,
            self.fold,
            self.doubts,
            self._make_allowance(),
        ):
            column.addWidget(each)
        column.addWidget(hairline())
        self.hide()

    def set_sizes(self, views: Sequence[SizeView], chosen: str, allowance_mm: float, why: str = "") -> None:
        """Show sizes, the ``chosen`` system large; without any, ``why`` there is none, or nothing at all."""
        self.views = tuple(views)
        self.setVisible(bool(views or why))
        parts = (self.main, self.caution, self.others, self.doubt, self.near, self.fold, self._allowed)
        for each in (*parts, self.within):
            each.setVisible(bool(views))
        self.doubts.setVisible(bool(views) and self.fold.isChecked())
        self.allowance.show_value(allowance_mm)
        if not views:
            self.rule.setText(why)
            return
        main = next((view for view in views if view.key == chosen), views[0])
        self.main.setText(main.title)
        set_tip(self.main, main.tip)
        self.caution.setText(main.caution)
        self.within.setText(main.within)
        self.within.setVisible(bool(main.within))
        self.rule.setText(main.rule)
        self.doubt.setText(main.doubt)
        self.doubt.setVisible(bool(main.doubt))
        self.near.setText("\n".join(main.near))
        self.doubts.setText("\n".join((main.system, *(f"• {each}" for each in main.doubts))))
        self._show_others([view for view in views if view is not main])

    def button(self, key: str) -> QPushButton:
        """Return the button of a system that is not the chosen one."""
        return self.others.findChild(QPushButton, key)  # type: ignore[return-value]

    def _show_others(self, views: Sequence[SizeView]) -> None:
        keys = [view.key for view in views]
        if keys != [each.objectName() for each in self.others.findChildren(QPushButton)]:
            for each in self.others.findChildren(QWidget, options=Qt.FindChildOption.FindDirectChildrenOnly):
                each.hide()  # or a layout that has just taken it shows it as a window of its own
                each.setParent(None)
                each.deleteLater()
            self._cautions = {view.key: _caution() for view in views}
            for place, view in enumerate(views):
                row, column = divmod(place, COLUMNS)
                self._grid.addWidget(self._make_other(view.key), 2 * row, column)
                self._grid.addWidget(self._cautions[view.key], 2 * row + 1, column)
        for view in views:
            press = self.button(view.key)
            press.setText(view.title)
            set_tip(press, view.tip)
            press.setAccessibleName(f"{view.title} {view.caution}".rstrip())
            self._cautions[view.key].setText(view.caution)
            self._cautions[view.key].setVisible(bool(view.caution))

    def _make_other(self, key: str) -> QPushButton:
        press = button("", "word")
        press.setObjectName(key)
        press.setFont(font("secondary", tabular=True))
        press.setFixedHeight(22)
        press.clicked.connect(lambda: self.chosen.emit(key))
        return press

    def _make_head(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(8)
        row.addWidget(self.main)
        row.addWidget(self.caution, 1)
        return row

    def _make_allowance(self) -> QWidget:
        self._allowed = QWidget()
        row = QHBoxLayout(self._allowed)
        row.setContentsMargins(0, 0, 0, 0)
        row.addWidget(label(self.allowance.accessibleName(), "secondary"), 1, Qt.AlignmentFlag.AlignLeft)
        row.addWidget(self.allowance)
        return self._allowed


def _caution(side: Qt.AlignmentFlag = Qt.AlignmentFlag.AlignHCenter) -> QLabel:
    """Return a place for the few words beside a size that others may find otherwise."""
    result = label("", "caption")
    result.setAlignment(side | Qt.AlignmentFlag.AlignVCenter)
    set_tag(result, "tone", "warn")
    return result


class _AllowanceField(ValueEdit):
    """What a tape that is worn tight takes off: an estimate, and not much."""

    def _read(self, text: str) -> float:
        value, (low, high) = super()._read(text), ALLOWANCE
        if not low <= value <= high:
            refusal = tr("Enter {low} to {high} (typical range, no standard).")
            raise ValueError(refusal.format(low=length_number(low, 0), high=length(high, 0)))
        return value
