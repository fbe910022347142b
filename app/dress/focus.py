"""A ring round what has the keyboard where it does not show that by itself: the view, lists that scroll."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QRect, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QApplication, QScrollArea, QWidget

from app.dress.theme import tokens_of


class FocusRing(QWidget):
    """Lies over a window and takes no part in it; ``show_round`` is for what is reached by a key."""

    def __init__(self, window: QWidget) -> None:
        super().__init__(window)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.hide()
        app = QApplication.instance()
        assert isinstance(app, QApplication)
        app.focusChanged.connect(self._follow)

    def show_round(self, widget: QWidget) -> None:
        """Lie round a widget that has the focus, until it goes elsewhere."""
        window = self.parentWidget()
        assert window is not None
        self.setGeometry(QRect(widget.mapTo(window, QPoint()), widget.size()))
        self.raise_()
        self.show()

    def _follow(self, _: QWidget | None, now: QWidget | None) -> None:
        if type(now) is QScrollArea and now.window() is self.window():
            self.show_round(now)
        else:
            self.hide()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802
        """Draw two pixels of the colour of focus, inside the edge."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(QColor(tokens_of(self).accent), 2))
        painter.drawRoundedRect(self.rect().adjusted(1, 1, -1, -1), 4, 4)
