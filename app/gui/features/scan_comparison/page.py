"""A worn scan beside the prediction: how it lies, predicted less real, and the numbers that fit it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QGridLayout, QHBoxLayout, QLabel, QVBoxLayout, QWidget

from app.gui.theme.stylesheet import font, label, set_tag
from app.gui.widgets.basic import ElidedLabel, ScrollColumn, Segment, button, hairline, sentence
from app.gui.widgets.navigation_row import page_head
from app.gui.widgets.tooltip import set_tip
from app.gui.widgets.value_edit import ValueEdit
from app.i18n.catalog import tr
from app.i18n.lengths import length_unit
from app.presenters.scan_comparison import ParameterRow, ResidualRow
from core.analysis.calibration.api import THICKEST


@dataclass(frozen=True)
class ScanComparisonView:
    """All that the page says; empty where there is nothing.

    ``faint``: the comparison is of a former shape. ``ready``: the numbers can be sought. ``helped``: those
    found can be applied, ``doubtful`` that this is not recommended, and ``surely`` says which are told well.
    ``record`` is what the design keeps of a calibration.
    """

    file: str = ""
    lies: str = ""
    rows: tuple[ResidualRow, ...] = ()
    bust: str = ""
    numbers: tuple[ParameterRow, ...] = ()
    surely: str = ""
    kept: str = ""
    better: str = ""
    record: str = ""
    faint: bool = False
    ready: bool = False
    helped: bool = False
    doubtful: bool = False


class ScanComparisonPage(QWidget):
    """``closed`` goes back, ``asked`` wants a file, ``calibrated`` the numbers, ``applied`` takes them.

    ``told`` carries the unit of the scan, empty for that which is guessed; ``thickened`` the cloth [mm],
    ``mapped`` whether the map is to lie on the body.
    """

    closed, asked, calibrated, applied = Signal(), Signal(), Signal(), Signal()
    told, thickened, mapped = Signal(str), Signal(float), Signal(bool)

    def __init__(self) -> None:
        super().__init__()
        self.view = ScanComparisonView()
        self._mapped = False
        self.file, self.lies = ElidedLabel(), sentence("", "secondary")
        self.file.setFont(font("name"))
        self.unsure = sentence(
            tr("± covers 95 % of the scan noise; differences in posture or breathing are not included."),
            "caption",
        )
        self.bust, self.kept, self.better = (sentence("", role) for role in ("secondary", "caption", "name"))
        self.record, self.surely = sentence("", "secondary"), sentence("", "secondary")
        self.choose = button(tr("Choose fitting scan…"))
        self.unit = Segment(
            (("", tr("Automatic")), ("mm", "mm"), ("cm", "cm"), ("m", "m"), ("inch", tr("inch"))),
            True,
            wide=True,
        )
        self.unit.set_choice("")
        self.thickness = ValueEdit("mm", tr("Fabric thickness"), widest="20.0")
        self.thickness.show_value(0.0)
        self.look = button(tr("Show on body"))
        self.calibrate, self.apply = button(tr("Calibrate")), button(tr("Apply"), "primary")
        self._figures, self._numbers = QGridLayout(), QGridLayout()
        self._cells: list[QLabel] = []
        self._lay()
        self._connect()
        self.show_view(self.view)

    def _connect(self) -> None:
        self.choose.clicked.connect(self.asked)
        self.calibrate.clicked.connect(self.calibrated)
        self.apply.clicked.connect(self.applied)
        self.look.clicked.connect(lambda: self.mapped.emit(not self._mapped))
        self.unit.chosen.connect(self._tell)
        self.thickness.entered.connect(lambda mm: self.thickened.emit(min(max(mm, 0.0), THICKEST)))

    def _tell(self, unit: str) -> None:
        self.unit.set_choice(unit)
        self.told.emit(unit)

    def _lay(self) -> None:
        area = ScrollColumn(tr("Fitting scan"), (18, 4, 18, 16), 8)
        column = area.column
        message = tr("Compare the prediction with a scan of the same person in the garment.")
        column.addWidget(sentence(message))
        column.addWidget(self.record)
        for each in (self.file, self.lies):
            column.addWidget(each)
        column.addWidget(self.choose, 0, Qt.AlignmentFlag.AlignLeft)
        column.addWidget(label(tr("Unit of the scan"), "secondary"))
        column.addWidget(self.unit)  # under its title: beside it the page is wider than the inspector
        column.addLayout(_row(tr("Fabric thickness"), self.thickness))
        self._compared, self._found = QWidget(), QWidget()
        self._lay_compared(QVBoxLayout(self._compared))
        self._lay_found(QVBoxLayout(self._found))
        column.addWidget(self._compared)
        column.addWidget(self._found)
        column.addStretch(1)
        area.setFocusPolicy(Qt.FocusPolicy.TabFocus)  # not by a click on a button, which takes none itself
        outer = QVBoxLayout(self)
        outer.setContentsMargins(0, 0, 0, 0)
        outer.setSpacing(0)
        outer.addLayout(page_head(tr("Fitting scan"), tr("Back to measurements"), self.closed))
        outer.addWidget(area, 1)

    def _lay_compared(self, column: QVBoxLayout) -> None:
        column.setContentsMargins(0, 4, 0, 0)
        column.setSpacing(6)
        column.addWidget(hairline())
        column.addWidget(label(f"{tr('Residuals (prediction − scan)')} [{length_unit()}]", "name"))
        column.addLayout(self._figures)
        column.addWidget(self.bust)
        row = QHBoxLayout()
        row.setSpacing(6)
        row.addWidget(self.look)
        row.addWidget(self.calibrate)
        row.addStretch(1)
        column.addLayout(row)
        set_tip(
            self.calibrate,
            tr("Fit tissue and line stiffness to the fitting scan"),
        )

    def _lay_found(self, column: QVBoxLayout) -> None:
        column.setContentsMargins(0, 4, 0, 0)
        column.setSpacing(6)
        column.addWidget(hairline())
        column.addWidget(self.better)
        column.addLayout(self._numbers)
        column.addWidget(self.surely)
        column.addWidget(self.kept)
        column.addWidget(self.unsure)
        column.addWidget(
            sentence(tr("These values are valid for this person and this garment only."), "caption")
        )
        column.addWidget(self.apply, 0, Qt.AlignmentFlag.AlignLeft)
        for grid in (self._figures, self._numbers):
            grid.setHorizontalSpacing(10)
            grid.setVerticalSpacing(2)
            grid.setColumnStretch(0, 1)

    def show_view(self, view: ScanComparisonView) -> None:
        """Show what there is to say."""
        self.view = view
        texts = (self.file, view.file), (self.lies, view.lies), (self.bust, view.bust)
        others = (self.kept, view.kept), (self.better, view.better), (self.record, view.record)
        for part, text in (*texts, *others, (self.surely, view.surely)):
            part.setText(text)
            part.setVisible(bool(text))
        self.choose.setText(tr("Choose another scan…") if view.file else tr("Choose fitting scan…"))
        self._compared.setVisible(bool(view.rows))
        self._found.setVisible(bool(view.better))
        self.calibrate.setEnabled(view.ready)
        self.apply.setVisible(view.helped)
        set_tag(self.apply, "kind", "secondary" if view.doubtful else "primary")
        self.unsure.setVisible(bool(view.numbers))
        for cell in self._cells:
            cell.deleteLater()
        self._cells = []
        rows = [(row.title, row.mean, row.rms, row.most) for row in view.rows]
        self._fill(self._figures, ("", tr("Mean"), tr("RMS"), "95 %"), rows, [view.faint] * len(rows))
        rows = [(row.title, row.before, row.after, row.plus_minus) for row in view.numbers]
        weak = [not row.told for row in view.numbers]
        self._fill(self._numbers, ("", tr("Current"), tr("Calibrated"), "±"), rows, weak)

    def show_map(self, on: bool) -> None:
        """Show by the button whether the map is on the body."""
        self._mapped = on
        self.look.setText(tr("Hide map") if on else tr("Show on body"))

    def _fill(
        self, grid: QGridLayout, heads: Sequence[str], rows: Sequence[Sequence[str]], faint: Sequence[bool]
    ) -> None:
        right = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
        for at, texts in enumerate((heads, *rows) if rows else ()):
            for column, text in enumerate(texts):
                cell = label(text, "caption" if at == 0 else "body", tabular=bool(column))
                set_tag(cell, "tone", "faint" if at and faint[at - 1] else "")
                if column:
                    cell.setAlignment(right)
                grid.addWidget(cell, at, column)
                self._cells.append(cell)


def _row(title: str, field: QWidget) -> QHBoxLayout:
    row = QHBoxLayout()
    row.addWidget(label(title, "secondary"))
    row.addStretch(1)
    row.addWidget(field)
    return row
