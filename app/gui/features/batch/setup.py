"""Setup of a batch run: scans, design with its variants, folder of results, processes."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QCheckBox, QGridLayout, QHBoxLayout, QSizePolicy, QWidget

from app.gui.session.app_folders import shown_folder
from app.gui.theme.stylesheet import font, label
from app.gui.widgets.menu import Menu, pull_down
from app.gui.widgets.option_field import AmountField, OptionCombo
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr
from app.presenters.batch import paths_text
from app.presenters.model_options import Amount

_MOST_PROCESSES = 1024


class PullField(OptionCombo):
    """A button that opens ``menu``; a text without room for all of it is elided in the middle."""

    def __init__(self, title: str) -> None:
        super().__init__(elides=Qt.TextElideMode.ElideMiddle)
        self.menu_ = Menu(self)
        self.setAccessibleName(title)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.clicked.connect(lambda: pull_down(self.menu_, self))

    def show_text(self, text: str, tip: str = "") -> None:
        """Show a text, and a tooltip with what it has no room for."""
        self.setText(text)
        self.setAccessibleDescription(text)
        set_tip(self, tip)


class BatchSetup(QWidget):
    """Fields of a run; the controller fills the menu of designs.

    ``changed`` when scans, variants or the folder of results are others; the requests open dialogs.
    """

    changed = Signal()
    folder_requested = Signal()
    files_requested = Signal()
    out_requested = Signal()
    results_requested = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.scans: list[str] = []
        self.out: Path | None = None
        self.scan_field, self.out_field = PullField(tr("Scans")), PullField(tr("Results"))
        self.design_field = PullField(tr("Design"))
        self.variants: dict[str, QCheckBox] = {}
        self.workers = max((os.cpu_count() or 1) - 1, 1)
        self._fill_menus()
        self._lay_out()
        self.set_scans([])
        self.set_out(None)

    def _fill_menus(self) -> None:
        menu = self.scan_field.menu_
        menu.addAction(tr("Choose folder…"), self.folder_requested.emit)
        menu.addAction(tr("Choose scans or list…"), self.files_requested.emit)
        menu = self.out_field.menu_
        menu.addAction(tr("Choose folder…"), self.out_requested.emit)
        menu.addAction(tr("Open results…"), self.results_requested.emit)

    def _lay_out(self) -> None:
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(12)
        grid.setVerticalSpacing(8)
        fields = ((tr("Scans"), self.scan_field), (tr("Results"), self.out_field))
        for row, (title, field) in enumerate(fields):
            grid.addWidget(label(title, "secondary"), row, 0)
            grid.addWidget(field, row, 1)
        grid.addWidget(label(tr("Design"), "secondary"), 0, 3)
        grid.addLayout(self._make_designs(), 0, 4)
        grid.addWidget(label(tr("Processes"), "secondary"), 1, 3)
        grid.addLayout(self._make_options(), 1, 4)
        grid.setColumnMinimumWidth(2, 12)
        grid.setColumnStretch(1, 1)
        grid.setColumnStretch(4, 1)

    def _make_designs(self) -> QHBoxLayout:
        row, self._boxes = QHBoxLayout(), QHBoxLayout()
        self._boxes.setSpacing(10)
        row.setSpacing(12)
        row.addWidget(self.design_field, 1)
        row.addLayout(self._boxes)
        return row

    def _make_options(self) -> QHBoxLayout:
        text = tr("Number of bodies computed at the same time")
        amount = Amount("workers", tr("Processes"), text, "", 1.0, 0, (1, _MOST_PROCESSES))
        self.worker_field = AmountField(amount)
        self.worker_field.describe(amount.title, text)
        self.worker_field.edit.setProperty("ring", "true")
        self.worker_field.show_value(float(self.workers))
        self.worker_field.chosen.connect(self._choose_workers)
        self.bodies, self.reports = QCheckBox(tr("Bodies (PLY)")), QCheckBox(tr("Reports (PDF)"))
        set_tip(self.bodies, tr("Write each reshaped body to the folder of results"))
        set_tip(self.reports, tr("Write a report of each body to the folder of results; takes longer"))
        row = QHBoxLayout()
        row.setSpacing(16)
        row.addWidget(self.worker_field)
        for box in (self.bodies, self.reports):
            box.setFont(font("body"))
            row.addWidget(box)
        row.addStretch(1)
        return row

    def set_scans(self, scans: Sequence[str], count_text: str = "") -> None:
        """Set files and folders with scans, and how many scans these hold, as far as that is known."""
        self.scans = list(scans)
        text = paths_text([shown_folder(Path(each)) for each in scans])
        shown = f"{text}  ({count_text})" if count_text else text
        self.scan_field.show_text(shown if scans else tr("Choose folder…"), "\n".join(scans))

    def set_out(self, out: Path | None) -> None:
        """Set the folder of results."""
        self.out = out
        text = shown_folder(out) if out is not None else tr("Choose folder…")
        self.out_field.show_text(text, str(out or ""))

    def set_design(self, title: str, variants: Sequence[tuple[str, bool]]) -> None:
        """Show a design, with a box for each variant, by name and whether it is chosen, if it has several."""
        self.design_field.show_text(title, title)
        for box in self.variants.values():
            self._boxes.removeWidget(box)
            box.hide()
            box.deleteLater()
        self.variants = {}
        for name, chosen in variants if len(variants) > 1 else ():
            box = self.variants[name] = QCheckBox(name)
            box.setFont(font("body"))
            box.setChecked(chosen)
            set_tip(box, tr("Compute variant {name}").format(name=name))
            box.clicked.connect(self.changed)
            self._boxes.addWidget(box)

    @property
    def files(self) -> frozenset[str]:
        """Return the kinds of files that are wanted of each body."""
        boxes = {"body": self.bodies, "report": self.reports}
        return frozenset(kind for kind, box in boxes.items() if box.isChecked())

    @property
    def chosen_variants(self) -> list[str]:
        """Return the names of the variants that are chosen; none if the design has one only."""
        return [name for name, box in self.variants.items() if box.isChecked()]

    def _choose_workers(self, value: float) -> None:
        self.workers = round(value)
        self.worker_field.show_value(float(self.workers))
