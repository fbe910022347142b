"""Panel of the scan: unit, orientation and repairs, each with a manual override."""

from __future__ import annotations

import re
from collections.abc import Sequence
from html import escape

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QVBoxLayout, QWidget

from app.gui.features.scan.edits import ScanEditor
from app.gui.theme.stylesheet import label, set_tag
from app.gui.widgets.basic import EmptyState, ScrollColumn, Segment, button, hairline, sentence
from app.gui.widgets.tooltip import set_tip
from app.gui.widgets.value_edit import ValueEdit
from app.i18n.catalog import number, tr, tr_context
from app.presenters.messages import render
from app.presenters.scan import KINDS, LeanView, ScanView

MOST = 45.0
"""The largest lean that can be typed [degrees]."""


UNITS = ("mm", "cm", "m", "inch")
"""Units that a scan can be in."""

AXES = tuple(f"{sign}{name}" for name in "xyz" for sign in "+-")
"""Axes of a file, as a scan is told them."""


class AngleField(ValueEdit):
    """An angle within 45 degrees."""

    def __init__(self, name: str) -> None:
        super().__init__("°", name, signed=True, widest="+00.0")

    def _read(self, text: str) -> float:
        value = super()._read(text)
        if abs(value) > MOST:
            raise ValueError(tr("Enter an angle from −45 to 45°."))
        return value


class LeanEditor(QWidget):
    """The two angles; ``leaned`` carries both, ``up_chosen`` the direction that sets the body upright."""

    leaned = Signal(float, float)
    up_chosen = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self._view = LeanView(0.0, 0.0)
        self.forward = AngleField(tr("Forward lean of the body in the file (negative: backward)"))
        self.left = AngleField(tr("Lean of the body in the file to its left (negative: to its right)"))
        self.forward.entered.connect(lambda value: self.leaned.emit(value, self._view.left))
        self.left.entered.connect(lambda value: self.leaned.emit(self._view.forward, value))
        self.upright = button(tr("Set upright"))
        set_tip(self.upright, tr("Rotate the body until its back has the slope of an upright body"))
        self.upright.clicked.connect(lambda: self.up_chosen.emit(self._view.upright))
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(6)
        row = QHBoxLayout()
        row.setSpacing(6)
        for words, field in ((tr("Forward"), self.forward), (tr("To the left"), self.left)):
            row.addWidget(label(words, "secondary"))
            row.addWidget(field)
            row.addSpacing(8)
        row.addStretch(1)
        column.addLayout(row)
        below = QHBoxLayout()
        below.addWidget(self.upright)
        below.addStretch(1)
        column.addLayout(below)

    def show_lean(self, view: LeanView) -> None:
        """Show the angles of a body, and the button if it leans."""
        self._view = view
        self.forward.show_value(view.forward)
        self.left.show_value(view.left)
        self.upright.setVisible(bool(view.upright))


class ScanPanel(QWidget):
    """The facts of the scan; ``value_set`` with "unit", "up" or "front" and what it is, an empty key forgets
    all.

    ``open_requested`` for another file; ``front_requested`` when the pictures are wanted. ``edits`` edits
    the scan, ``lean`` its lean.
    """

    value_set = Signal(str, str)
    open_requested = Signal()
    front_requested = Signal()

    def __init__(self) -> None:
        super().__init__()
        outer = QVBoxLayout(self)
        outer.setContentsMargins(0, 0, 0, 0)
        self._empty = EmptyState(
            "folder-open",
            tr("No scan yet"),
            tr("Open a body scan, or drop a file on the window: {kinds}.").format(kinds=KINDS),
            tr("Open scan…"),
        )
        self._empty.requested.connect(self.open_requested)
        head = QVBoxLayout()
        head.setContentsMargins(18, 14, 18, 8)
        head.addWidget(label(tr("Scan"), "heading"))
        head.addWidget(self._empty)
        outer.addLayout(head)
        outer.addWidget(self._facts(), 1)
        outer.addStretch(0)
        self.set_scan(None)

    def set_scan(self, view: ScanView | None) -> None:
        """Show the facts of a scan, or that there is none."""
        self._empty.setVisible(view is None)
        self._area.setVisible(view is not None)
        if view is None:
            return
        self._file.setText(view.file)
        words = tr("{count} triangles with colours") if view.coloured else tr("{count} triangles")
        self._triangles.setText(words.format(count=number(view.triangles, 0)))
        self.units.set_choice(view.unit)
        self.ups.set_choice(view.up)
        self.fronts.set_choice(view.front)
        for axis in AXES:
            self.fronts.button(axis).setEnabled(axis[1] != view.up[1])
        self._reason.setText(re.sub(r"(?<!\S)-(?=[xyz])", "\N{MINUS SIGN}", render(view.reason)))
        set_tag(self._reason, "tone", "" if view.sure else "warn")
        self._forget.setVisible(bool(view.told))
        self._notes.setText("\n".join(view.notes))
        self._notes.setVisible(bool(view.notes))
        done = [each for each in view.repairs if not _stays(each)]
        self._repairs.setText(_listed(done) or tr("No repairs needed."))
        self.lean.setEnabled(view.lean is not None)
        self.lean.show_lean(view.lean or LeanView(0.0, 0.0))
        self.edits.setVisible(view.edits is not None)
        if view.edits is not None:
            self.edits.show_edits(view.edits)

    def _facts(self) -> ScrollColumn:
        self._area = ScrollColumn(tr("Scan"), (18, 0, 18, 14), 3, sideways=True)
        column = self._area.column
        self._file, self._triangles = sentence("", "name"), label("", "secondary")
        self._notes, self._reason = sentence(), sentence()
        self._repairs, self.edits, self.lean = sentence(), ScanEditor(), LeanEditor()
        self._repairs.setTextFormat(Qt.TextFormat.RichText)
        self.units = self._choices("unit", [(unit, tr_context("unit", unit)) for unit in UNITS])
        axes = [(axis, axis.replace("-", "\N{MINUS SIGN}")) for axis in AXES]
        self.ups, self.fronts = self._choices("up", axes), self._choices("front", axes)
        another = button(tr("Open another scan…"))
        another.clicked.connect(self.open_requested)
        for each in (self._file, self._triangles, self._notes):
            column.addWidget(each)
        self._group(column, tr("Unit of the file"), self.units)
        self._group(column, tr("Orientation in the file"), self._ways())
        self._group(column, tr("Axis that points up"), self.ups)
        self._group(column, tr("Axis that the chest faces"), self.fronts)
        self._group(column, tr("Lean of the body in the file"), self.lean)
        self._group(column, tr("Reasons"), self._reason)
        column.addWidget(self.edits)
        self._group(column, tr("Repairs"), self._repairs)
        column.addSpacing(14)
        column.addWidget(another, alignment=Qt.AlignmentFlag.AlignLeft)
        column.addStretch(1)
        return self._area

    def _choices(self, key: str, choices: list[tuple[str, str]]) -> Segment:
        result = Segment(choices, small=True)
        tips = {
            "unit": tr("Choose the length unit of the file; all measurements depend on it"),
            "up": tr("Choose the axis of the file that points to the head"),
            "front": tr("Choose the axis of the file that the body faces"),
        }
        set_tip(result, tips[key])
        result.chosen.connect(lambda value: self.value_set.emit(key, value))
        return result

    def _ways(self) -> QWidget:
        """Return the buttons that ask by pictures, and that forget what was told."""
        result = QWidget()
        row = QHBoxLayout(result)
        row.setContentsMargins(0, 3, 0, 0)
        row.setSpacing(6)
        self.pictures = button(tr("Choose from images…"))
        self.pictures.clicked.connect(self.front_requested)
        self._forget = button(tr("Reset"), "quiet")
        set_tip(self._forget, tr("Reset unit and up and front axes to the detected values"))
        self._forget.clicked.connect(lambda: self.value_set.emit("", ""))
        for each in (self.pictures, self._forget):
            row.addWidget(each)
        row.addStretch(1)
        return result

    @staticmethod
    def _group(column: QVBoxLayout, title: str, *widgets: QWidget) -> None:
        column.addSpacing(9)
        column.addWidget(hairline())
        column.addSpacing(9)
        column.addWidget(label(title, "caption"))
        for each in widgets:
            column.addWidget(each)
            if not isinstance(each, QLabel):
                column.addSpacing(5)


def _stays(sentence: str) -> bool:
    """Return whether a sentence is on a hole that was left open, and not on a repair."""
    return "stays open" in sentence or "stay open" in sentence


def _listed(sentences: Sequence[str]) -> str:
    """Return sentences one under the other, with a little room between them."""
    return "".join(f'<p style="margin:0 0 4px 0">{escape(each)}</p>' for each in sentences)
