"""Edits of the scan: crop by height, mirror one half, fill holes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from app.gui.theme.stylesheet import label
from app.gui.widgets.basic import Segment, button, hairline, sentence
from app.gui.widgets.tooltip import set_tip
from app.gui.widgets.value_edit import ValueEdit
from app.i18n.catalog import tr
from app.i18n.lengths import length
from app.presenters.messages import render
from app.presenters.scan import EditsView, HoleView
from core.errors import UserError
from core.scan.source import UNEDITED, ScanEdits


class LevelField(ValueEdit):
    """A level of the crop; ``check`` raises UserError for one that cannot be."""

    def __init__(self, name: str, check: Callable[[float], object]) -> None:
        super().__init__("mm", name, digits=0, widest="0000")
        self._check = check

    def _read(self, text: str) -> float:
        value = super()._read(text)
        try:
            self._check(value)
        except UserError as refused:
            raise ValueError(render(refused.text)) from None
        return value


class ScanEditor(QWidget):
    """The edits of the scan; ``edited`` carries other edits and their name for undo."""

    edited = Signal(object, str)

    def __init__(self) -> None:
        super().__init__()
        self._view = EditsView(UNEDITED, 0.0)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(3)
        self.low = LevelField(tr("Lower crop height above the lowest point of the scan"), self._with_low)
        self.high = LevelField(tr("Upper crop height above the lowest point of the scan"), self._with_high)
        self.low.entered.connect(lambda value: self._emit(self._with_low(value), tr("Crop scan")))
        self.high.entered.connect(lambda value: self._emit(self._with_high(value), tr("Crop scan")))
        self._extent = label("", "secondary")
        self.sides = Segment(
            [("", tr("Off")), ("left", tr("Keep left side")), ("right", tr("Keep right side"))], small=True
        )
        set_tip(self.sides, tr("Replace the other half of the body with a mirror image of the kept half"))
        self.sides.chosen.connect(
            lambda side: self._emit(replace(self._view.edits, kept=side), tr("Mirror scan"))
        )
        self._list = QVBoxLayout()
        self._list.setSpacing(3)
        self.fills: list[QWidget] = []
        self._add(column, tr("Crop by height"), self._crop())
        self._add(column, tr("Mirror half"), self.sides)
        self._add(column, tr("Open holes"), None)
        self._none = sentence(tr("None, apart from the cut edges at neck, arms and hips."))
        self._more = sentence()
        column.addWidget(self._none)
        column.addLayout(self._list)
        column.addWidget(self._more)
        column.addWidget(self._all_holes())

    def show_edits(self, view: EditsView) -> None:
        """Show the edits of a scan, and a row for each open hole."""
        self._view, edits = view, view.edits
        self.low.show_value(edits.low or 0.0)
        self.high.show_value(view.height if edits.high is None else edits.high)
        self._extent.setText(tr("of {height}").format(height=length(view.height, 0)))
        self.sides.set_choice(edits.kept)
        for row in self.fills:
            self._list.removeWidget(row)
            row.hide()
            row.deleteLater()
        self.fills = [self._row(hole) for hole in view.holes]
        for row in self.fills:
            self._list.addWidget(row)
        self._none.setVisible(not view.holes)
        self._more.setText(view.more)
        self._more.setVisible(bool(view.more))
        self.fill_all.setVisible(len(view.holes) > 1)
        self.reopen.setVisible(bool(edits.filled) or edits.fill_all)

    def _with_low(self, value: float) -> ScanEdits:
        return replace(self._view.edits, low=value if round(value) else None)

    def _with_high(self, value: float) -> ScanEdits:
        return replace(self._view.edits, high=value if value < round(self._view.height) else None)

    def _emit(self, edits: ScanEdits, text: str) -> None:
        if edits != self._view.edits:
            self.edited.emit(edits, text)

    def _crop(self) -> QWidget:
        result = QWidget()
        row = QHBoxLayout(result)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(6)
        dash = label("\N{EN DASH}")
        for each in (self.low, dash, self.high, self._extent):
            row.addWidget(each)
        row.addStretch(1)
        return result

    def _row(self, hole: HoleView) -> QWidget:
        result = QWidget()
        row = QHBoxLayout(result)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(8)
        fill = button(tr("Fill"))
        set_tip(fill, tr("Fill this hole following the curvature of the surrounding skin"))
        fill.setAccessibleDescription(hole.text)
        fill.clicked.connect(lambda: self._emit(self._view.edits.with_filled(hole.centre), tr("Fill hole")))
        row.addWidget(sentence(hole.text), 1)
        row.addWidget(fill, alignment=Qt.AlignmentFlag.AlignTop)
        return result

    def _all_holes(self) -> QWidget:
        result = QWidget()
        row = QHBoxLayout(result)
        row.setContentsMargins(0, 3, 0, 0)
        row.setSpacing(6)
        self.fill_all, self.reopen = button(tr("Fill all")), button(tr("Reopen holes"), "quiet")
        set_tip(self.fill_all, tr("Fill all holes in the scan"))
        set_tip(self.reopen, tr("Reopen all holes that were filled manually"))
        self.fill_all.clicked.connect(
            lambda: self._emit(replace(self._view.edits, filled=(), fill_all=True), tr("Fill all holes"))
        )
        self.reopen.clicked.connect(lambda: self._emit(self._view.edits.without_filled(), tr("Reopen holes")))
        row.addWidget(self.fill_all)
        row.addWidget(self.reopen)
        row.addStretch(1)
        return result

    @staticmethod
    def _add(column: QVBoxLayout, title: str, widget: QWidget | None) -> None:
        column.addSpacing(9)
        column.addWidget(hairline())
        column.addSpacing(9)
        column.addWidget(label(title, "caption"))
        if widget is not None:
            column.addWidget(widget)
            column.addSpacing(5)
