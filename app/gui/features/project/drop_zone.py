"""Where files can be dropped: the zone of the start page, and the whole window while one hovers over it."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from PySide6.QtCore import QRectF, Qt, Signal
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QFrame, QLabel, QVBoxLayout, QWidget

from app.gui.theme.icons import paint_icon
from app.gui.theme.stylesheet import font, tokens_of
from app.gui.widgets.basic import IconLabel, button, sentence
from app.i18n.catalog import tr
from app.presenters.scan import KINDS


class DropZone(QFrame):
    """Says what can be dropped, with a button for those who would rather choose."""

    requested = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.setMinimumHeight(212)
        column = QVBoxLayout(self)
        column.setContentsMargins(10, 24, 10, 24)
        column.setSpacing(6)
        column.addStretch(1)
        column.addWidget(IconLabel("drop-file", "text_quiet", 30), alignment=Qt.AlignmentFlag.AlignHCenter)
        column.addSpacing(6)
        for text, role in (
            (tr("Drop a scan or a project here"), "name"),
            (tr("{kinds}. The unit is found, and shown.").format(kinds=KINDS), "caption"),
        ):
            column.addWidget(_centred(text, role))
        column.addSpacing(10)
        self.choose = button(tr("Choose a file…"), "primary")
        self.choose.clicked.connect(self.requested)
        column.addWidget(self.choose, alignment=Qt.AlignmentFlag.AlignHCenter)
        column.addStretch(1)

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        pen = QPen(QColor(tokens_of(self).control), 1.4)
        pen.setDashPattern([4.0, 4.0])
        painter.setPen(pen)
        painter.drawRoundedRect(QRectF(self.rect()).adjusted(1, 1, -1, -1), 12, 12)


class DropVeil(QWidget):
    """Lies over the window while a file is dragged over it, and says what letting go will do."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self._window = parent
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self._said = ""
        self.hide()

    def show_for(self, name: str) -> None:
        """Cover the window and name the file."""
        self._said = tr("Let go to open {name}").format(name=name)
        self.setAccessibleName(self._said)
        self.setGeometry(self._window.rect())
        self.raise_()
        self.show()

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens = tokens_of(self)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        veil = QColor(tokens.panel)
        veil.setAlphaF(0.82)
        painter.fillRect(self.rect(), veil)
        pen = QPen(QColor(tokens.accent), 2)
        pen.setDashPattern([4.0, 3.0])
        painter.setPen(pen)
        painter.drawRoundedRect(QRectF(self.rect()).adjusted(16, 16, -16, -16), 12, 12)
        middle = QRectF(self.rect()).center()
        paint_icon(painter, "drop-file", tokens.accent, QRectF(middle.x() - 22, middle.y() - 52, 44, 44))
        painter.setFont(font("page"))
        painter.setPen(QColor(tokens.text))
        words = QRectF(40, middle.y() + 4, self.width() - 80, 40)
        said = painter.fontMetrics().elidedText(
            self._said, Qt.TextElideMode.ElideMiddle, round(words.width())
        )
        painter.drawText(words, Qt.AlignmentFlag.AlignCenter, said)


def _centred(text: str, role: str) -> QLabel:
    result = sentence(text, role)
    result.setAlignment(Qt.AlignmentFlag.AlignHCenter)
    return result
