"""Version, licences and system information, to read and to copy."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from PySide6.QtCore import Signal
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QHBoxLayout, QPushButton, QStackedWidget, QWidget

from app.gui.theme.stylesheet import label
from app.gui.widgets.basic import Segment, button, sentence
from app.gui.widgets.dialog import Dialog, text_viewer
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr

Facts = Sequence[tuple[str, Sequence[tuple[str, str]]]]
"""Groups of facts, each with its title: name and value, ready to read."""


class AboutDialog(Dialog):
    """What Busk is, with the licences to read."""

    def __init__(self, parent: QWidget, version: str, licences: Sequence[tuple[str, str]]) -> None:
        super().__init__(parent, tr("Busk {version}").format(version=version), (680, 560))
        self.body.addWidget(sentence(tr("Simulate how a foundation garment reshapes a body."), "body"))
        self.body.addWidget(sentence(tr("Apache-2.0. All data stays on this computer."), "secondary"))
        names = [str(place) for place in range(len(licences))]
        self.tabs = Segment([(name, title) for name, (title, _) in zip(names, licences, strict=True)])
        self.texts = QStackedWidget()
        for title, text in licences:
            self.texts.addWidget(text_viewer(text, title, code=True))
        self.tabs.chosen.connect(lambda name: self.show_licence(int(name)))
        self.body.addSpacing(4)
        self.body.addWidget(self.tabs)
        self.body.addWidget(self.texts, 1)
        self.add_close()
        self.show_licence(0)

    def show_licence(self, place: int) -> None:
        """Show one of the licences."""
        self.texts.setCurrentIndex(place)
        self.tabs.set_choice(str(place))


class DiagnosticsDialog(Dialog):
    """Facts about program and machine, to copy for whoever is asked for help.

    ``folders`` are those that the program writes to; ``folder_requested`` carries the path of one to be
    shown.
    """

    folder_requested = Signal(object)

    def __init__(self, parent: QWidget, facts: Facts, folders: Sequence[tuple[str, Path]]) -> None:
        super().__init__(parent, tr("Diagnostics"), (680, 560))
        message = tr("System information for bug reports. Contains no scans, measurements or file names.")
        self.body.addWidget(sentence(message))
        self.text = as_text(facts)
        self.body.addWidget(text_viewer(self.text, tr("Diagnostics"), code=True), 1)
        self.body.addLayout(self._openers(folders))
        self.copy = self.add_button(tr("Copy"), self._copy)
        self.add_close()

    def _openers(self, folders: Sequence[tuple[str, Path]]) -> QHBoxLayout:
        """Return a row with a button for each folder; one that nothing was written to yet waits."""
        row = QHBoxLayout()
        row.setSpacing(6)
        row.addWidget(label(tr("Open folder:"), "secondary"))
        self.openers: dict[str, QPushButton] = {}
        for title, folder in folders:
            opener = self.openers[title] = button(title)
            opener.setEnabled(folder.is_dir())
            set_tip(opener, str(folder) if folder.is_dir() else tr("This folder is empty."))
            opener.setAccessibleName(tr("Open folder: {name}").format(name=title))
            opener.setAutoDefault(False)
            opener.clicked.connect(lambda _=False, folder=folder: self.folder_requested.emit(folder))
            row.addWidget(opener)
        row.addStretch(1)
        return row

    def _copy(self) -> None:
        QGuiApplication.clipboard().setText(self.text)
        self.copy.setText(tr("Copied"))


def as_text(facts: Facts) -> str:
    """Return facts as lines, in two columns."""
    width = max((len(name) for _, group in facts for name, _ in group), default=0) + 2
    groups = ((title, (f"  {name:{width}}{value}" for name, value in group)) for title, group in facts)
    return "\n\n".join("\n".join((title, *lines)) for title, lines in groups)
