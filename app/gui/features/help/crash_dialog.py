"""The one dialog that a fault of Busk itself may open."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QWidget

from app.gui.widgets.basic import Disclosure, sentence
from app.gui.widgets.dialog import Dialog, text_viewer
from app.i18n.catalog import tr


class CrashDialog(Dialog):
    """Says that something went wrong, where the design was kept, and what can be done."""

    quit_requested = Signal()

    def __init__(self, parent: QWidget, kept: str, trace: str, machine: str) -> None:
        super().__init__(parent, tr("Something went wrong inside Busk"), (620, 0))
        self._trace, self._machine = trace, machine
        said = (
            tr("Your design is kept aside until you save or discard it: {place}").format(place=kept)
            if kept
            else tr("Your design is still open. Save it under a new name to be safe.")
        )
        self.said = sentence(said, "body")
        self.body.addWidget(self.said)
        self.body.addWidget(sentence(tr("You can go on. If it happens again, start Busk anew.")))
        self._unfold = Disclosure(tr("Details for a report"))
        self._unfold.setAccessibleName(tr("Details for a report"))
        self.details = text_viewer(self.report(), tr("Details for a report"), code=True)
        self.details.setMinimumHeight(220)
        self.details.hide()
        self._unfold.toggled.connect(self._show_details)
        self.body.addWidget(self._unfold)
        self.body.addWidget(self.details, 1)
        self.body.addStretch(0)
        self.copy = self.add_button(tr("Copy details"), self._copy)
        self.leave = self.add_button(tr("Quit"), self._quit)
        self.go_on = self.add_button(tr("Go on"), self.accept, "primary")
        self.go_on.setFocus()

    def report(self) -> str:
        """Return what somebody who is to mend it has to know."""
        return f"{self._trace}\n{self._machine}"

    def add_details(self, trace: str) -> None:
        """Take in one more fault, while this one is still asked about."""
        self._trace = f"{self._trace}\n{trace}"
        self.details.setPlainText(self.report())

    def _show_details(self, shown: bool) -> None:
        self.details.setVisible(shown)
        self.fit()

    def _copy(self) -> None:
        QGuiApplication.clipboard().setText(self.report())
        self.copy.setText(tr("Copied"))

    def _quit(self) -> None:
        self.accept()
        self.quit_requested.emit()
