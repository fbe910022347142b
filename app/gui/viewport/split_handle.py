"""The handle of a wipe: a line across the view that is dragged over it, with a knob."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen, QWheelEvent
from PySide6.QtWidgets import QAbstractSlider, QWidget

from app.gui.theme.icons import pixmap
from app.gui.theme.stylesheet import tokens_of
from app.gui.widgets.accessibility import speak_value
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr

REACH = 12
"""How near to the line the pointer takes hold of it [px]."""

WHOLE = 1000
"""Value of a handle at the right edge; 0 is the left one."""

_KNOB = (22.0, 32.0)


def keys_in_words() -> list[tuple[str, str]]:
    """Return what the keys do on the handle, ready to read."""
    return [("← →", tr("Wipe by 1 %")), ("Page Up, Page Down", tr("Wipe by 10 %"))]


class SplitHandle(QAbstractSlider):
    """A slider as high as the view, ``2 REACH`` wide; its parent puts it where its value says."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setOrientation(Qt.Orientation.Horizontal)
        self.setRange(0, WHOLE)
        self.setSingleStep(WHOLE // 100)
        self.setPageStep(WHOLE // 10)
        self.setValue(WHOLE // 2)
        self.setFixedWidth(2 * REACH)
        self.setCursor(Qt.CursorShape.SplitHCursor)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAccessibleName(tr("Border between before and after"))
        set_tip(self, tr("Drag, or use the arrow keys. A double click puts it in the middle."))
        self._room = parent
        self._grip = 0.0
        self._bare = False
        self.valueChanged.connect(lambda _: self._speak())
        self._speak()

    def _speak(self) -> None:
        speak_value(self, f"{100.0 * self.share():.0f} %")

    def set_bare(self, bare: bool) -> None:
        """Leave the knob out, which is for the hand, or draw it again; the line stays."""
        self._bare = bare
        self.update()

    def share(self) -> float:
        """Return where the line is: 0 at the left edge of the view, 1 at the right one."""
        return self.value() / WHOLE

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton:
            self._grip = event.position().x() - self.width() / 2.0
            self.setSliderDown(True)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self.isSliderDown():
            x = self.mapToParent(event.position()).x() - self._grip
            self.setValue(round(WHOLE * x / max(self._room.width(), 1)))

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        self.setSliderDown(False)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        self.setValue(WHOLE // 2)

    def wheelEvent(self, event: QWheelEvent) -> None:
        event.ignore()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Take the keys that move it sideways; up and down are those of the lines."""
        if event.key() in (Qt.Key.Key_Left, Qt.Key.Key_Right, Qt.Key.Key_PageUp, Qt.Key.Key_PageDown):
            super().keyPressEvent(event)
        else:
            event.ignore()

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens = tokens_of(self)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        middle = self.width() / 2.0
        painter.fillRect(QRectF(middle - 2.0, 0.0, 4.0, self.height()), QColor(0, 0, 0, 40))
        painter.fillRect(QRectF(middle - 1.0, 0.0, 2.0, self.height()), QColor("#FFFFFF"))
        if self._bare:
            return
        knob = QRectF(0.0, 0.0, *_KNOB)
        knob.moveCenter(QPointF(middle, self.height() / 2.0))
        lively = self.hasFocus() or self.isSliderDown()
        painter.setPen(QPen(QColor(tokens.accent if lively else tokens.outline), 2.0 if lively else 1.0))
        painter.setBrush(QColor(tokens.raised))
        painter.drawRoundedRect(knob, 11.0, 11.0)
        for name, x in (("caret-left", -8.5), ("caret-right", 0.5)):
            caret = pixmap(name, tokens.text, 8, self.devicePixelRatioF())
            painter.drawPixmap(QPointF(middle + x, knob.center().y() - 4.0), caret)
