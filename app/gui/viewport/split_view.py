"""Views of several bodies through one camera: side by side, or one wiped away from the other."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
# ruff: noqa: N802 - Qt names its events

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QPointF, QRect, QRectF, QSize, Qt
from PySide6.QtGui import (
    QColor,
    QFont,
    QFontMetricsF,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QResizeEvent,
    QWheelEvent,
)
from PySide6.QtWidgets import QAbstractSlider, QWidget

from app.gui.theme.icons import pixmap
from app.gui.theme.stylesheet import font, tokens_of
from app.gui.viewport.viewport import Viewport
from app.gui.widgets.basic import speak_value
from app.gui.widgets.overlay_layout import GAP
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr

REACH = 12
"""How near to the line the pointer takes hold of it [px]."""

WHOLE = 1000
"""Value of a handle at the right edge; 0 is the left one."""

_KNOB = (22.0, 32.0)


def keys_in_words() -> list[tuple[str, str]]:
    """Return what the keys do on the handle, ready to read."""
    return [("← →", tr("Move divider by 1 %")), ("Page Up, Page Down", tr("Move divider by 10 %"))]


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
        self.setAccessibleName(tr("Divider between original and reshaped body"))
        set_tip(self, tr("Drag, or use the arrow keys. Double-click to centre."))
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


class SplitView(QWidget):
    """Holds the ``main`` viewport for good, and others beside it or under it for as long as they are wanted.

    ``obstacle`` is a sibling that floats over the panes: no title is hidden under it.
    """

    def __init__(self, main: Viewport, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.main = main
        self.viewports: tuple[Viewport, ...] = ()
        self.titles: tuple[PaneTitle, ...] = ()
        self.obstacle: QWidget | None = None
        self._wiped = QWidget(self)
        self.handle = SplitHandle(self)
        self.handle.valueChanged.connect(self._lay_out)
        self._take((main,), (), wiped=False)

    def show_alone(self) -> None:
        """Show the main viewport and close all others."""
        self._take((self.main,), (), wiped=False)

    def show_row(self, panes: Sequence[tuple[str, Viewport]]) -> None:
        """Show viewports with their titles beside each other; the main one is among them."""
        self._take(tuple(viewport for _, viewport in panes), [title for title, _ in panes], wiped=False)

    def show_wipe(self, left: tuple[str, Viewport], title: str) -> None:
        """Show another viewport left of a line that can be dragged, and the main one right of it."""
        self._take((left[1], self.main), (left[0], title), wiped=True)

    def set_titles(self, titles: Sequence[str]) -> None:
        """Write other titles over the panes that are shown."""
        if [title.text for title in self.titles] != list(titles):
            for title, text in zip(self.titles, titles, strict=True):
                title.write(text)
            self._lay_out()

    @property
    def is_wiped(self) -> bool:
        """Return whether a wipe is shown."""
        return not self._wiped.isHidden()

    def close_views(self) -> None:
        """Release all 3D objects."""
        self.show_alone()
        self.main.close_view()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Divide the space again."""
        super().resizeEvent(event)
        self._lay_out()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw what shows between two panes: a hairline."""
        QPainter(self).fillRect(self.rect(), QColor(tokens_of(self).outline))

    def _take(self, viewports: tuple[Viewport, ...], titles: Sequence[str], *, wiped: bool) -> None:
        for old in {*self.viewports} - {*viewports, self.main}:
            if old.hasFocus():
                self.main.setFocus()
            old.close_view()
            old.hide()
            old.deleteLater()
        for title in self.titles:
            title.hide()
            title.deleteLater()
        fresh = [viewport for viewport in viewports if viewport not in self.viewports]
        self.viewports = viewports
        self.titles = tuple(PaneTitle(title, self) for title in titles)
        held = self.handle.hasFocus()
        self._wiped.setVisible(wiped)
        self.handle.setVisible(wiped)
        if wiped and self.main.hasFocus():
            self.handle.setFocus()
        elif held and not wiped:
            self.main.setFocus()
        for viewport in viewports:
            viewport.setParent(self._wiped if wiped and viewport is not self.main else self)
        self._lay_out()
        for viewport in viewports:
            viewport.show()
        for part in (self._wiped, self.handle, *self.titles):
            part.raise_()
        for viewport in fresh:
            viewport.view_changed.connect(lambda viewport=viewport: self._share(viewport))

    def _share(self, viewport: Viewport) -> None:
        """Let all see from where one sees."""
        for other in self.viewports:
            if other is not viewport:
                other.look_from(viewport.scene.view)

    def _lay_out(self) -> None:
        edges = [round(self.width() * self.handle.share())]
        if self.is_wiped:
            for viewport in self.viewports:
                viewport.setGeometry(self.rect())
            self._wiped.setGeometry(0, 0, edges[0], self.height())
            self.handle.setGeometry(edges[0] - self.handle.width() // 2, 0, 0, self.height())
        else:
            count = len(self.viewports)
            edges = [round(k * (self.width() + 1) / count) for k in range(1, count)]
            ends = [*edges, self.width() + 1]
            for viewport, left, end in zip(self.viewports, [0, *edges], ends, strict=True):
                viewport.setGeometry(left, 0, end - left - 1, self.height())
        self._share(self.main)
        self._place_titles([0, *edges, self.width()])

    def _place_titles(self, edges: Sequence[int]) -> None:
        """Place each title at the border to the next pane, the last one at the border before it.

        All stand at one height: where one would be hidden, under what hides it.
        """
        for place, title in enumerate(self.titles):
            left, end = edges[place], edges[place + 1]
            title.fit(end - left - 2 * GAP)
            last = place == len(self.titles) - 1
            title.move(left + GAP if last else end - GAP - title.width(), GAP)
            title.setHidden(end - left < title.width() + 2 * GAP)
        taken = QRect()
        if self.obstacle is not None and self.obstacle.isVisible():
            taken = self.obstacle.geometry()
        if any(title.geometry().intersects(taken) and not title.isHidden() for title in self.titles):
            for title in self.titles:
                title.move(title.x(), taken.bottom())


class PaneTitle(QWidget):
    """What a pane shows, in a small pill; the pointer goes through it.

    The first line of a longer text is its heading, which stays alone where the others have no room.
    """

    LINE, EDGE = 18, 22

    def __init__(self, text: str, parent: QWidget) -> None:
        super().__init__(parent)
        self._room = 10_000
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.write(text)

    def write(self, text: str) -> None:
        """Set the text."""
        self.text = text
        self.setAccessibleName(text.replace("\n", ", "))
        self.update()

    def fit(self, room: int) -> None:
        """Take as much of a width as is needed [px]."""
        self._room = room
        self.resize(self.sizeHint())

    def sizeHint(self) -> QSize:
        """Return room for what is written."""
        lines = self._lines()
        return QSize(self._width(lines), 26 + self.LINE * (len(lines) - 1))

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the pill."""
        tokens = tokens_of(self)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        fill = QColor(tokens.floating)
        fill.setAlpha(tokens.floating_alpha)
        painter.setBrush(fill)
        painter.setPen(QColor(tokens.line))
        painter.drawRoundedRect(QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5), 13.0, 13.0)
        for place, text in enumerate(self._lines()):
            painter.setFont(_face(place))
            painter.setPen(QColor(tokens.text if place == 0 else tokens.text_quiet))
            line = QRectF(0, 4 + self.LINE * place, self.width(), self.LINE)
            painter.drawText(line, Qt.AlignmentFlag.AlignCenter, text)

    def _lines(self) -> list[str]:
        lines = self.text.split("\n")
        return lines if self._width(lines) <= self._room else lines[:1]

    def _width(self, lines: Sequence[str]) -> int:
        wide = (QFontMetricsF(_face(place)).horizontalAdvance(text) for place, text in enumerate(lines))
        return round(max(wide)) + self.EDGE


def _face(line: int) -> QFont:
    return font("title" if line == 0 else "caption", tabular=line > 0)
