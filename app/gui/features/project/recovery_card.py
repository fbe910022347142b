"""The offer of what was not saved when Busk did not close in order: its picture, its name and two ways."""

# ruff: noqa: N802 - Qt names its events and says what they are
from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QImage, QPainter, QPainterPath, QPaintEvent
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from app.gui.theme.stylesheet import label
from app.gui.widgets.basic import OverlayCard, ToolButton, button, sentence
from app.i18n.catalog import tr

_PICTURE = QSize(116, 110)


@dataclass(frozen=True, eq=False)
class RecoveryView:
    """What is offered: the document's name, when it was kept, its picture, and how many more there are."""

    name: str
    time: str
    picture: QImage | None = None
    more: int = 0


class RecoveryCard(OverlayCard):
    """Asks once, calmly; ``later`` leaves the offer to the next start."""

    restore = Signal()
    discard = Signal()
    later = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._picture = _Picture()
        self._heading, self._words = label("", "heading"), sentence()
        self._more = label("", "caption")
        # Two lines in any language: a label that wraps does not ask for the second one.
        self._words.setMinimumHeight(2 * self._words.fontMetrics().lineSpacing() + 6)
        close = ToolButton("x", tr("Decide at the next start"), size=14, room=26)
        close.clicked.connect(self.later)
        self.given_up.connect(self.later)
        self.take, self.drop = button(tr("Restore"), "primary"), button(tr("Discard"))
        self.take.clicked.connect(self.restore)
        self.drop.clicked.connect(self.discard)
        head, ways, column = QHBoxLayout(), QHBoxLayout(), QVBoxLayout()
        head.addWidget(self._heading, 1)
        head.addWidget(close, alignment=Qt.AlignmentFlag.AlignTop)
        for way in (self.take, self.drop):
            ways.addWidget(way)
        ways.addStretch(1)
        ways.addWidget(self._more)
        column.addLayout(head)
        column.addWidget(self._words, 1)
        column.addLayout(ways)
        self.row.setContentsMargins(26, 22, 24, 26)
        self.row.setSpacing(16)
        self.row.addWidget(self._picture, alignment=Qt.AlignmentFlag.AlignTop)
        self.row.addLayout(column, 1)
        self.setFixedWidth(540)
        self.hide()

    def offer(self, view: RecoveryView) -> None:
        """Offer one document."""
        self._heading.setText(tr("{name} was not saved").format(name=view.name))
        said = tr("Busk did not close in order. Kept: {time}. Anything done after that is gone.")
        said = said.format(time=view.time)
        self._words.setText(said)
        self._more.setText(tr("{count} more").format(count=view.more) if view.more else "")
        self._picture.show_image(view.picture)
        self.setAccessibleName(f"{self._heading.text()}. {said}")
        self.adjustSize()
        self.show()
        self.raise_()
        self.take.setFocus(Qt.FocusReason.OtherFocusReason)


class _Picture(QWidget):
    """A picture with round corners; it takes no room where there is none."""

    def __init__(self) -> None:
        super().__init__()
        self.setFixedSize(_PICTURE)
        self._image: QImage | None = None

    def show_image(self, image: QImage | None) -> None:
        self._image = image
        self.setVisible(image is not None)
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        if self._image is None:
            return
        painter = QPainter(self)
        painter.setRenderHints(QPainter.RenderHint.Antialiasing | QPainter.RenderHint.SmoothPixmapTransform)
        shape = QPainterPath()
        shape.addRoundedRect(self.rect(), 8, 8)
        painter.setClipPath(shape)
        painter.drawImage(self.rect(), self._image)
