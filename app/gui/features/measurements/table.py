"""Measures before and after in groups, painted: values, the change and a bar about a middle line."""

# ruff: noqa: N802 - Qt names its events and says what they are
from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

from PySide6.QtCore import QEvent, QPoint, QRect, QRectF, Qt, Signal
from PySide6.QtGui import QColor, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QResizeEvent
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.gui.features.measurements.table_row import EDGE, LEFT, RIGHT, RowGeometry, cells, paint_row
from app.gui.theme.stylesheet import font, tokens_of
from app.gui.widgets.accessibility import announce
from app.gui.widgets.button_row import button_row
from app.i18n.catalog import tr
from app.presenters.measurements import MeasureView

TOP, HEAD = 24, 30
"""Heights of the titles of the columns and of the heading of a group [px]."""

_FARTHEST = 10**5
_STEPS = {
    Qt.Key.Key_Down: 1,
    Qt.Key.Key_Up: -1,
    Qt.Key.Key_Home: -_FARTHEST,
    Qt.Key.Key_End: _FARTHEST,
}
_OWN_KEYS = (Qt.Key.Key_Home, Qt.Key.Key_End, Qt.Key.Key_F2)


def keys_in_words() -> list[tuple[str, str]]:
    """Return what the keys do in the table, ready to read."""
    return [
        ("↑ ↓", tr("Show the measure above or below on the body")),
        ("Home, End", tr("Show the first or the last measure")),
        ("Enter", tr("Bring it near")),
        ("F2", tr("Change it, if it is your own")),
        ("Del", tr("Delete it, if it is your own")),
        ("Esc", tr("Show none")),
    ]


class MeasurementsTable(QWidget):
    """Measures in groups; those with a key fade while they are ``stale``, all after while ``doubtful``.

    ``marked`` carries the key of the one that a click or an arrow key goes to and that is opened, empty for
    none; ``framed`` when it is clicked twice. ``changing`` and ``removing`` carry the key of one's own.
    """

    marked = Signal(str)
    framed = Signal()
    changing = Signal(str)
    removing = Signal(str)
    _change = Signal()
    _remove = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.rows: tuple[MeasureView, ...] = ()
        self.stale, self.doubtful, self.mark = False, False, ""
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self._spots: list[RowGeometry] = []
        self._heads: list[tuple[str, str, int]] = []
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)
        self._change.connect(lambda: self.changing.emit(self.mark))
        self._remove.connect(lambda: self.removing.emit(self.mark))
        self.tools = button_row(
            (
                (tr("Change…"), tr("Change this measure (F2)"), self._change),
                (tr("Delete"), tr("Delete this measure (Del)"), self._remove),
            )
        )
        self.tools.setParent(self)
        self.tools.hide()

    def set_rows(self, rows: Sequence[MeasureView], stale: bool = False, doubtful: bool = False) -> None:
        """Show these measures; if ``doubtful`` those after and changes are no result, and are pale."""
        if (tuple(rows), stale, doubtful) == (self.rows, self.stale, self.doubtful):
            return
        self.rows, self.stale, self.doubtful = tuple(rows), stale, doubtful
        self.setAccessibleName("; ".join(each.spoken() for each in rows))
        self._lay_out()

    def select(self, key: str) -> None:
        """Mark the measure of this key, or none."""
        if key != self.mark:
            self.mark = key
            self._lay_out()
            self.marked.emit(key)

    def place_of(self, key: str) -> QRect:
        """Return where a measure stands."""
        spots = (spot for spot in self._spots if spot.view.key == key)
        return next((QRect(0, spot.top, self.width(), spot.height) for spot in spots), QRect())

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Mark the measure under the pointer."""
        view = self._view_at(event.position().toPoint())
        self.select("" if view is None else view.key)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Ask for the measure to be looked at that the first click has opened."""
        if self.mark:
            self.framed.emit()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Go to the next measure or the one before, Enter looks at it; F2 changes, Del removes one's own."""
        key = Qt.Key(event.key())
        own = any(view.own and view.key == self.mark for view in self.rows)
        if key == Qt.Key.Key_Escape and self.mark:
            self.select("")
        elif key in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and self.mark:
            self.framed.emit()
        elif own and key == Qt.Key.Key_F2:
            self.changing.emit(self.mark)
        elif own and key in (Qt.Key.Key_Delete, Qt.Key.Key_Backspace):
            self.removing.emit(self.mark)
        elif not self._step(_STEPS.get(key, 0)) and key not in _OWN_KEYS:
            super().keyPressEvent(event)

    def _step(self, turn: int) -> bool:
        """Go so many measures on, and read them out; tells whether there was one."""
        views = [view for view in self.rows if view.key]
        if not turn or not views:
            return False
        keys = [view.key for view in views]
        at = keys.index(self.mark) + turn if self.mark in keys else max(turn - 1, 0)
        view = views[min(max(at, 0), len(keys) - 1)]
        self.select(view.key)
        announce(self, "; ".join((view.spoken(), *view.details)))
        return True

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Let names and reasons wrap anew."""
        self._lay_out()

    def event(self, event: QEvent) -> bool:
        """Tell over a row how it is taken, and keep the keys that the menus have too."""
        if isinstance(event, QKeyEvent) and event.type() == QEvent.Type.ShortcutOverride:
            event.setAccepted(event.key() in _OWN_KEYS)
            return True
        return super().event(event)

    def tip_at(self, place: QPoint) -> str:
        """Return how the measure at a place is taken, unless its open row shows that."""
        view = self._view_at(place)
        return "" if view is None or (view.key and view.key == self.mark) else view.told()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint what lies in the part that is asked for."""
        tokens, painter = tokens_of(self), QPainter(self)
        painter.setPen(QColor(tokens.text_caption))
        painter.setFont(font("caption"))
        titles = (tr("Before"), tr("After"), tr("Change"))
        for cell, title in zip(cells(self.width(), 0, TOP), titles, strict=False):
            painter.drawText(cell, RIGHT, title)
        for title, units, top in self._heads:
            line = QRectF(EDGE, top, self.width() - 2 * EDGE, HEAD)
            painter.fillRect(QRectF(line.left(), line.bottom() - 1, line.width(), 1), QColor(tokens.line))
            painter.setFont(font("title"))
            painter.setPen(QColor(tokens.text))
            painter.drawText(line, LEFT, title)
            said = painter.fontMetrics().horizontalAdvance(title) + 6
            painter.setFont(font("caption"))
            painter.setPen(QColor(tokens.text_caption))
            painter.drawText(line.adjusted(said, 1, 0, 1), LEFT, units)
        for spot in self._spots:
            if event.rect().intersects(QRect(0, spot.top, self.width(), spot.height)):
                painter.setOpacity(0.45 if self.stale and spot.view.key else 1.0)
                paint_row(painter, tokens, spot, self.hasFocus(), self.doubtful)

    def _lay_out(self) -> None:
        """Find where headings and rows stand, and how high all of it is."""
        self._spots, self._heads, top = [], [], TOP
        for group, rows in groupby(self.rows, key=lambda view: view.group):
            views = list(rows)
            units = list(dict.fromkeys(view.unit_shown for view in views))
            if group:
                self._heads.append((group, units[0] if len(units) == 1 else "", top))
                top += HEAD
            for view in views:
                opened = bool(view.key) and view.key == self.mark
                spot = RowGeometry(view, top, self.width(), len(units) > 1 or not group, opened)
                self._spots.append(spot)
                top += spot.height
        self.setFixedHeight(top + 1)
        feet = [spot.foot for spot in self._spots if spot.foot.height()]
        self.tools.setVisible(bool(feet))
        if feet:
            self.tools.setGeometry(feet[0])
        self.update()

    def _view_at(self, place: QPoint) -> MeasureView | None:
        return next((spot.view for spot in self._spots if spot.holds(place)), None)
