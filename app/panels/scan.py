"""How the scan was understood: its unit, which way it stands, what was repaired."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QFrame, QLabel, QScrollArea, QVBoxLayout, QWidget

from app.parts import EmptyState, Segment, button, hairline, sentence
from app.theme import label, set_tag
from app.words import number, say, tr

UNITS = ("mm", "cm", "m", "inch")
"""Units that a scan can be in."""


@dataclass(frozen=True)
class ScanView:
    """What is shown of a scan: ``reason`` why this ``unit``; ``up`` and ``front`` are axes of the file."""

    file: str
    unit: str
    reason: str
    sure: bool
    up: str
    front: str
    triangles: int
    repairs: tuple[str, ...]


class ScanPanel(QWidget):
    """The facts of the scan; ``unit_chosen`` when another unit is said, ``open_asked`` for another file."""

    unit_chosen = Signal(str)
    open_asked = Signal()

    def __init__(self) -> None:
        super().__init__()
        outer = QVBoxLayout(self)
        outer.setContentsMargins(0, 0, 0, 0)
        self._empty = EmptyState(
            "folder-open",
            tr("No scan yet"),
            tr("Open a body scan, or drop one on the window: PLY, OBJ or STL."),
            tr("Open a scan…"),
        )
        self._empty.asked.connect(self.open_asked)
        head = QVBoxLayout()
        head.setContentsMargins(18, 14, 18, 8)
        head.addWidget(label(tr("Scan"), "heading"))
        head.addWidget(self._empty)
        outer.addLayout(head)
        outer.addWidget(self._facts(), 1)
        self.set_scan(None)

    def set_scan(self, view: ScanView | None) -> None:
        """Show the facts of a scan, or that there is none."""
        self._empty.setVisible(view is None)
        self._area.setVisible(view is not None)
        if view is None:
            return
        self._file.setText(view.file)
        self._triangles.setText(tr("{count} triangles").format(count=number(view.triangles, 0)))
        self._units.set_choice(view.unit)
        self._reason.setText(say(view.reason))
        set_tag(self._reason, "tone", "" if view.sure else "warn")
        self._up.setText(view.up.replace("-", "\N{MINUS SIGN}"))
        self._front.setText(view.front.replace("-", "\N{MINUS SIGN}"))
        self._repairs.setText("\n".join(map(say, view.repairs)) or tr("Nothing had to be repaired."))

    def _facts(self) -> QScrollArea:
        inside = QWidget()
        inside.setProperty("scrolled", "true")
        column = QVBoxLayout(inside)
        column.setContentsMargins(18, 0, 18, 14)
        column.setSpacing(3)
        self._file, self._triangles = sentence("", "name"), label("", "secondary")
        self._file.setTextFormat(Qt.TextFormat.PlainText)
        self._reason, self._repairs = sentence(), sentence()
        self._up, self._front = label("", "body"), label("", "body")
        self._units = Segment([(unit, tr(unit)) for unit in UNITS], small=True)
        self._units.chosen.connect(self.unit_chosen)
        another = button(tr("Open another scan…"))
        another.clicked.connect(self.open_asked)
        for each in (self._file, self._triangles):
            column.addWidget(each)
        self._group(column, tr("Unit of the file"), self._units)
        self._group(column, tr("Axis of the file that points up"), self._up)
        self._group(column, tr("Axis of the file that the chest faces"), self._front)
        self._group(column, tr("Why"), self._reason)
        self._group(column, tr("Repairs"), self._repairs)
        column.addSpacing(14)
        column.addWidget(another, alignment=Qt.AlignmentFlag.AlignLeft)
        column.addStretch(1)
        self._area = QScrollArea()
        self._area.setWidgetResizable(True)
        self._area.setFrameShape(QFrame.Shape.NoFrame)
        self._area.setWidget(inside)
        return self._area

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
