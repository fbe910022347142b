"""Measures before and after in groups, painted: values, the change and a bar about a middle line."""

# ruff: noqa: N802 - Qt names its events and says what they are

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import groupby

from PySide6.QtCore import QEvent, QPoint, QRect, QRectF, Qt, Signal
from PySide6.QtGui import QColor, QFontMetrics, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QResizeEvent
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.gui.theme.stylesheet import faded, font, tokens_of
from app.gui.widgets.basic import announce, button_row
from app.i18n.catalog import tr
from app.presenters.measurements import MeasureView
from app.rendering.palette import Tokens

ROW, NAME, FOOT, EDGE = 30, 20, 30, 4
"""Heights of a row, of a name on a line of its own and of the buttons of an open row; the margin [px]."""

OFF = 13
"""What a row is higher by where ± stands under its figures [px]."""

CELLS, BAR = (48, 54, 48), 28
"""Widths of the figures before, after and change, and of the bar [px]."""

LEFT = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
_WRAPPED = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop | Qt.TextFlag.TextWordWrap
_FAINT = 0.5  # of what is of a former shape, or of none that is a result
_GAP = 4  # over each paragraph of an open row


@dataclass(frozen=True)
class RowGeometry:
    """Where a row stands: ``wide`` if its name takes a line of its own, ``opened`` if it tells its details.

    ``mixed`` if its unit is not that of the heading.
    """

    view: MeasureView
    top: int
    width: int
    mixed: bool
    opened: bool = False

    @cached_property
    def wide(self) -> bool:
        """Return whether the name does not fit beside the figures."""
        advance = _advance(self.view.label, "body")
        if self.mixed:
            advance += 10 + _advance(self.view.unit_shown, "caption")
        return self.view.known and advance > name_width(self.width, alone=False)

    @property
    def figures(self) -> int:
        """Return where the line with the values begins."""
        return self.top + (NAME if self.wide else 0)

    @property
    def line(self) -> int:
        """Return how high the line with the figures is, with ± under them [px]."""
        return ROW + (OFF if self.view.off else 0)

    @cached_property
    def texts(self) -> list[tuple[str, str, QRect]]:
        """Return the texts below the values: words, type and position."""
        told = [(self.view.caption, "caption")] if self.view.caption else []
        told += [(each, "secondary") for each in self.view.details] if self.opened else []
        result, top = [], self.figures + self.line - 4
        for words, role in told:
            wide = max(self.width - 2 * EDGE, 60)
            high = _wrapped_height(words, role, wide)
            result.append((words, role, QRect(EDGE, top, wide, high)))
            top += high + (_GAP if self.opened else 0)
        return result

    @property
    def foot(self) -> QRect:
        """Return the position of the buttons of an opened custom row."""
        low = self.texts[-1][2].bottom() + _GAP if self.texts else self.figures + self.line
        return QRect(EDGE, low, self.width - 2 * EDGE, FOOT if self.opened and self.view.own else 0)

    @cached_property
    def height(self) -> int:
        """Return how high the row is [px]."""
        high = self.figures + self.line - self.top
        if self.texts:
            high += sum(rect.height() for _, _, rect in self.texts)
        if self.opened:
            high += _GAP * (len(self.texts) + 1)
        return high + self.foot.height()

    def holds(self, place: QPoint) -> bool:
        """Return whether a position is on the row."""
        return self.top <= place.y() < self.top + self.height


@lru_cache(maxsize=1000)  # a table is laid out with each frame, and few of its words are others
def _advance(words: str, role: str) -> int:
    return QFontMetrics(font(role)).horizontalAdvance(words)


@lru_cache(maxsize=1000)
def _wrapped_height(words: str, role: str, width: int) -> int:
    return QFontMetrics(font(role)).boundingRect(QRect(0, 0, width, 1000), _WRAPPED, words).height()


def name_width(width: int, alone: bool) -> int:
    """Return the room for a name in a table so wide, ``alone`` on its line or beside the figures [px]."""
    return width - 2 * EDGE - (0 if alone else sum(CELLS) + BAR + 8)


def cells(width: int, top: float, height: float) -> list[QRectF]:
    """Return the cells before, after, change and bar of a line of a table so wide."""
    left = width - EDGE - BAR
    result = [QRectF(left, top, BAR, height)]
    left -= 6
    for room in reversed(CELLS):
        left -= room
        result.append(QRectF(left, top, room, height))
    return result[::-1]


def paint_row(
    painter: QPainter, tokens: Tokens, spot: RowGeometry, focused: bool, doubtful: bool = False
) -> None:
    """Paint a row; an opened one has a ground, and a rim if the keyboard is there.

    What is ``doubtful`` is no result: figures after and changes are pale, and no bar tells them.
    """
    view, wide = spot.view, spot.wide
    if spot.opened:
        painter.setPen(QColor(tokens.accent) if focused else Qt.PenStyle.NoPen)
        painter.setBrush(QColor(tokens.selected))
        painter.drawRoundedRect(QRectF(0.5, spot.top + 1.5, spot.width - 1, spot.height - 3), 5, 5)
    name = QRectF(
        EDGE,
        spot.top + (3 if wide else 0),
        name_width(spot.width, wide or not view.known),
        NAME if wide else ROW,
    )
    painter.setFont(font("body"))
    painter.setPen(QColor(tokens.text))
    shown = painter.fontMetrics().elidedText(view.label, Qt.TextElideMode.ElideRight, int(name.width()))
    painter.drawText(name, LEFT, shown)
    if spot.mixed and view.known:
        extent = painter.fontMetrics().horizontalAdvance(view.label) + 6
        painter.setFont(font("caption"))
        painter.setPen(QColor(tokens.text_caption))
        painter.drawText(name.adjusted(extent, 1, 0, 1), LEFT, view.unit_shown)
    if view.known:
        _paint_figures(painter, tokens, spot, doubtful)
    for words, role, room in spot.texts:
        painter.setFont(font(role))
        painter.setPen(QColor(tokens.text_caption if role == "caption" else tokens.text_quiet))
        painter.drawText(room, _WRAPPED, words)


def _paint_figures(painter: QPainter, tokens: Tokens, spot: RowGeometry, doubtful: bool) -> None:
    view, places = spot.view, cells(spot.width, spot.figures, ROW)
    pale = faded(tokens.text_caption, tokens.panel, _FAINT).name() if doubtful else ""
    values = (
        (view.before, "body", tokens.text_caption, False),
        (view.after, "body" if doubtful else "name", pale or tokens.text, False),
        (view.change, "body", pale or tokens.text_quiet, True),
    )
    for cell, (value, role, color, signed) in zip(places, values, strict=False):
        painter.setFont(font(role, tabular=True))
        painter.setPen(QColor(color))
        painter.drawText(cell, RIGHT, view.written(value, signed))
    if view.off:
        _paint_off(painter, tokens, spot)
    if view.change is not None and not doubtful:
        _paint_bar(painter, tokens, places[-1], view.change / _full_bar(view.unit))


def _paint_off(painter: QPainter, tokens: Tokens, spot: RowGeometry) -> None:
    """Paint how far figures may be off, under them."""
    painter.save()
    painter.setOpacity(painter.opacity() * (_FAINT if spot.view.off_faint else 1.0))
    painter.setFont(font("caption", tabular=True))
    painter.setPen(QColor(tokens.text_caption))
    for cell, off in zip(cells(spot.width, spot.figures + ROW - 9, OFF + 4), spot.view.off, strict=False):
        if off is not None:
            painter.drawText(cell, RIGHT, spot.view.written_off(off))
    painter.restore()


def _paint_bar(painter: QPainter, tokens: Tokens, cell: QRectF, share: float) -> None:
    middle = cell.center()
    length = min(max(share, -1.0), 1.0) * BAR / 2
    bar = QRectF(min(middle.x(), middle.x() + length), middle.y() - 3, abs(length), 6)
    painter.fillRect(bar, QColor(tokens.more if share > 0 else tokens.less))
    painter.fillRect(QRectF(middle.x() - 0.5, middle.y() - 7, 1, 14), QColor(tokens.control))


def _full_bar(unit: str) -> float:
    """Return the change that fills half a bar, in ``unit``, which a ratio has not."""
    return {"ml": 100.0, "mm": 30.0, "": 0.1}.get(unit, 10.0)


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
        ("↑ ↓", tr("Select previous or next measurement")),
        ("Home, End", tr("Select first or last measurement")),
        ("Enter", tr("Zoom to the measurement")),
        ("F2", tr("Edit custom measurement")),
        ("Del", tr("Delete custom measurement")),
        ("Esc", tr("Clear selection")),
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
                (tr("Edit…"), tr("Edit measurement (F2)"), self._change),
                (tr("Delete"), tr("Delete measurement (Del)"), self._remove),
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
        """Zoom to the measurement that the first click has opened."""
        if self.mark:
            self.framed.emit()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Select the next or previous measurement; Enter zooms, F2 edits, Del deletes a custom one."""
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
        """Show the definition of a row, and keep the keys that the menus have too."""
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
            extent = painter.fontMetrics().horizontalAdvance(title) + 6
            painter.setFont(font("caption"))
            painter.setPen(QColor(tokens.text_caption))
            painter.drawText(line.adjusted(extent, 1, 0, 1), LEFT, units)
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
