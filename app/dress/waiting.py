"""What is seen of the window while its libraries are loaded: its place, its ground and its name."""

# ruff: noqa: N802 - Qt names its events
from __future__ import annotations

import time

from PySide6.QtCore import QEventLoop, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent
from PySide6.QtWidgets import QApplication, QWidget

from app.dress.place import put_as_last
from app.dress.theme import font, tokens_of
from app.wording.words import tr

_PATIENCE = 0.3  # seconds after which the start goes on, whether a screen has shown anything or not


class Waiting(QWidget):
    """Stands where the window will stand, until that is there."""

    def __init__(self) -> None:
        super().__init__()
        self.painted = False
        self.setWindowTitle("Busk")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setAttribute(Qt.WidgetAttribute.WA_QuitOnClose, False)
        put_as_last(self)

    @classmethod
    def shown(cls) -> Waiting:
        """Return one that has been painted."""
        waiting, begun = cls(), time.monotonic()
        waiting.show()
        while not waiting.painted and time.monotonic() - begun < _PATIENCE:
            QApplication.processEvents(QEventLoop.ProcessEventsFlag.ExcludeUserInputEvents, 20)
        return waiting

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the ground and, quietly, that it will not be long."""
        tokens, painter = tokens_of(self), QPainter(self)
        painter.fillRect(self.rect(), QColor(tokens.app))
        middle = self.rect().translated(0, -12)
        for face, colour, words in (
            (font("hero"), tokens.text, "Busk"),
            (font("body"), tokens.text_quiet, tr("Getting the 3D view ready…")),
        ):
            painter.setFont(face)
            painter.setPen(QColor(colour))
            painter.drawText(middle, Qt.AlignmentFlag.AlignCenter, words)
            middle.translate(0, 32)
        painter.end()
        self.painted = True
