"""A file that was open before, as a card with its picture."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QEvent, QRectF, QSize, Qt, Signal
from PySide6.QtGui import (
    QAction,
    QColor,
    QContextMenuEvent,
    QEnterEvent,
    QFocusEvent,
    QImage,
    QKeyEvent,
    QPainter,
    QPainterPath,
    QPaintEvent,
    QPen,
    QRadialGradient,
)
from PySide6.QtWidgets import QAbstractButton

from app.gui.theme.icons import paint_icon
from app.gui.theme.stylesheet import font, tokens_of
from app.gui.widgets.basic import ToolButton
from app.gui.widgets.menu import Menu
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr

WIDTH, HEIGHT, PICTURE = 218, 272, 208
"""Size of a card and height of its picture [px]."""

_RADIUS = 9.0


@dataclass(frozen=True, eq=False)
class ProjectView:
    """What is shown of a file: its name, when it was opened last, its picture if it has one.

    ``gone`` says that it is no longer there; ``look`` in words why its result wants to be looked at, or "".
    """

    path: str
    name: str
    day: str
    picture: QImage | None = None
    gone: bool = False
    look: str = ""


def keys_in_words() -> list[tuple[str, str]]:
    """Return what the keys do on a picture of the start page, ready to read."""
    return [("← → ↑ ↓", tr("Select another project")), ("Enter", tr("Open")), ("Del", tr("Remove from list"))]


class ProjectCard(QAbstractButton):
    """Opens its file, or asks where one that is gone has moved to; Delete takes it off the list."""

    opened = Signal(str)
    located = Signal(str)
    forgotten = Signal(str)

    def __init__(self, view: ProjectView) -> None:
        super().__init__()
        self.view = view
        self.setFixedSize(WIDTH, HEIGHT)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAttribute(Qt.WidgetAttribute.WA_Hover)
        sentence = tr("File not found.") if view.gone else view.look
        self.setAccessibleName(view.name)
        self.setAccessibleDescription("  ".join(filter(None, (view.day, sentence))))
        set_tip(self, "\n".join(filter(None, (view.path, sentence))))
        self.clicked.connect(self._act)
        self._remove = ToolButton("x", tr("Remove from list (Del)"), size=14, room=26)
        self._remove.setParent(self)
        self._remove.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._remove.setCursor(Qt.CursorShape.ArrowCursor)
        self._remove.move(WIDTH - 32, 6)
        self._remove.clicked.connect(self._forget)
        self._remove.hide()

    def sizeHint(self) -> QSize:
        return QSize(WIDTH, HEIGHT)

    def enterEvent(self, event: QEnterEvent) -> None:
        self._remove.show()

    def leaveEvent(self, event: QEvent) -> None:
        self._remove.setVisible(self.hasFocus())

    def focusInEvent(self, event: QFocusEvent) -> None:
        super().focusInEvent(event)
        self._remove.show()

    def focusOutEvent(self, event: QFocusEvent) -> None:
        super().focusOutEvent(event)
        self._remove.setVisible(self.underMouse())

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self.click()
        elif event.key() in (Qt.Key.Key_Delete, Qt.Key.Key_Backspace):
            self._forget()
        else:
            super().keyPressEvent(event)

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        menu = Menu(self)
        for text, act in (
            (tr("Locate…") if self.view.gone else tr("Open"), self._act),
            (tr("Remove from list"), self._forget),
        ):
            entry = QAction(text, menu)
            entry.triggered.connect(act)
            menu.addAction(entry)
        menu.exec(event.globalPos())

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens = tokens_of(self)
        painter = QPainter(self)
        painter.setRenderHints(QPainter.RenderHint.Antialiasing | QPainter.RenderHint.SmoothPixmapTransform)
        card = QRectF(self.rect()).adjusted(1.0, 1.0, -1.0, -1.0)
        shape = QPainterPath()
        shape.addRoundedRect(card, _RADIUS, _RADIUS)
        hovered = self.underMouse() or self.isDown()
        painter.fillPath(shape, QColor(tokens.hover if hovered else tokens.raised))
        painter.save()
        painter.setClipPath(shape)
        self._paint_picture(painter, QRectF(card.left(), card.top(), card.width(), PICTURE))
        painter.restore()
        focused = self.hasFocus()
        outline = tokens.accent if focused else tokens.outline if hovered else tokens.line
        painter.setPen(QPen(QColor(outline), 2.0 if focused else 1.0))
        painter.drawPath(shape)
        self._paint_words(painter)

    def _paint_picture(self, painter: QPainter, area: QRectF) -> None:
        tokens, picture = tokens_of(self), self.view.picture
        if picture is not None and not self.view.gone:
            painter.drawImage(area, picture, _middle_of(picture, area))
            return
        light = QRadialGradient(area.center(), 0.75 * area.width())
        light.setColorAt(0.0, QColor(tokens.app if self.view.gone else tokens.raised))
        light.setColorAt(1.0, QColor(tokens.app))
        painter.fillRect(area, light)
        drawing, ink = ("file-gone", tokens.text_caption) if self.view.gone else ("view-front", tokens.line)
        size = 28.0 if self.view.gone else 104.0
        middle = QRectF(area.center().x() - size / 2, area.center().y() - size / 2, size, size)
        paint_icon(painter, drawing, ink, middle)

    def _paint_words(self, painter: QPainter) -> None:
        tokens, left = tokens_of(self), 12.0
        room = self.width() - 2 * left - (18.0 if self.view.look else 0.0)
        painter.setFont(font("name"))
        painter.setPen(QColor(tokens.text_caption if self.view.gone else tokens.text))
        name = painter.fontMetrics().elidedText(self.view.name, Qt.TextElideMode.ElideMiddle, round(room))
        upright = Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft
        painter.drawText(QRectF(left, PICTURE + 9, room, 24), upright, name)
        painter.setFont(font("caption"))
        painter.setPen(QColor(tokens.accent if self.view.gone else tokens.text_caption))
        sentence = tr("Missing · Locate…") if self.view.gone else self.view.day
        painter.drawText(QRectF(left, PICTURE + 33, room, 20), upright, sentence)
        if self.view.look and not self.view.gone:
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(QColor(tokens.warn_mark))
            painter.drawEllipse(QRectF(self.width() - left - 8, PICTURE + 17, 8, 8))

    def _act(self) -> None:
        (self.located if self.view.gone else self.opened).emit(self.view.path)

    def _forget(self) -> None:
        self.forgotten.emit(self.view.path)


def _middle_of(picture: QImage, area: QRectF) -> QRectF:
    """Return the middle part of a picture that has the shape of ``area`` [px]."""
    width, height = float(picture.width()), float(picture.height())
    shape = area.width() / area.height()
    across, down = min(width, height * shape), min(height, width / shape)
    return QRectF((width - across) / 2, (height - down) / 2, across, down)
