"""Measures before and after in groups, painted: values, the change and a bar about a middle line."""

# ruff: noqa: N802 - Qt names its events and says what they are
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

from PySide6.QtCore import QEvent, QPoint, QRect, QRectF, Qt, Signal
from PySide6.QtGui import (
    QColor,
    QFontMetrics,
    QHelpEvent,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QResizeEvent,
)
from PySide6.QtWidgets import QSizePolicy, QToolTip, QWidget

from app.dress.theme import font, tokens_of
from app.wording.words import number, tr


@dataclass(frozen=True)
class MeasureView:
    """One measure before and after, in ``unit``; what is not known is None, and ``note`` may say why.

    ``reference`` says from where it is counted, ``tip`` how it is taken. An ``estimate`` may be off by
    ``plus_minus``. ``key`` is that of a measure of the body; ``group`` is its heading.
    """

    label: str
    unit: str
    before: float | None
    after: float | None
    reference: str = ""
    key: str = ""
    group: str = ""
    note: str = ""
    plus_minus: float = 0.0
    estimate: bool = False
    tip: str = ""

    @property
    def change(self) -> float | None:
        """By how much it grew, if that is known."""
        return None if self.after is None or self.before is None else self.after - self.before

    @property
    def known(self) -> bool:
        """Whether it was measured at all."""
        return self.before is not None or self.after is not None

    @property
    def caption(self) -> str:
        """What stands under it: from where it is counted, how sure it is, or why it is missing."""
        if not self.known:
            return self.note
        if not self.estimate:
            return self.reference
        if not self.plus_minus:
            return tr("an estimate")
        off = number(self.plus_minus, _digits(self.unit))
        return tr("an estimate, ± {off} {unit}").format(off=off, unit=self.unit)


@dataclass(frozen=True)
class _Spot:
    """Where a row stands: ``wide`` if its name takes a line of its own."""

    view: MeasureView
    top: int
    height: int
    wide: bool
    mixed: bool


_LEFT = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
_RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
_WRAPPED = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop | Qt.TextFlag.TextWordWrap


class MeasureTable(QWidget):
    """Measures in groups; those with a key fade while they are ``stale``.

    ``marked`` carries the key of the one that a click or an arrow key goes to, empty for none; ``framed``
    when it is clicked twice.
    """

    marked = Signal(str)
    framed = Signal()

    TOP, HEAD, ROW, NAME, CELLS, BAR, EDGE = 24, 30, 30, 20, (48, 54, 48), 28, 4

    def __init__(self) -> None:
        super().__init__()
        self.rows: tuple[MeasureView, ...] = ()
        self.stale, self.mark = False, ""
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self._spots: list[_Spot] = []
        self._heads: list[tuple[str, str, int]] = []
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)

    def set_rows(self, rows: Sequence[MeasureView], stale: bool = False) -> None:
        """Show these measures."""
        if (tuple(rows), stale) == (self.rows, self.stale):
            return
        self.rows, self.stale = tuple(rows), stale
        self.setAccessibleName("; ".join(_spoken(each) for each in rows))
        self._lay_out()
        self.update()

    def select(self, key: str) -> None:
        """Mark the measure of this key, or none."""
        if key != self.mark:
            self.mark = key
            self.update()
            self.marked.emit(key)

    def place_of(self, key: str) -> QRect:
        """Return where a measure stands."""
        spots = (spot for spot in self._spots if spot.view.key == key)
        return next((QRect(0, spot.top, self.width(), spot.height) for spot in spots), QRect())

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Mark the measure under the pointer."""
        view = self._view_at(event.position().toPoint())
        self.select(view.key if view is not None and view.known else "")

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Ask for the measure to be looked at."""
        self.mousePressEvent(event)
        if self.mark:
            self.framed.emit()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Go to the next measure or the one before; Esc marks none."""
        if event.key() == Qt.Key.Key_Escape and self.mark:
            self.select("")
            return
        turn = {Qt.Key.Key_Down: 1, Qt.Key.Key_Up: -1}.get(Qt.Key(event.key()), 0)
        keys = [view.key for view in self.rows if view.key and view.known]
        if not turn or not keys:
            super().keyPressEvent(event)
            return
        at = keys.index(self.mark) + turn if self.mark in keys else 0
        self.select(keys[min(max(at, 0), len(keys) - 1)])

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Let names and reasons wrap anew."""
        self._lay_out()

    def event(self, event: QEvent) -> bool:
        """Tell over a row how it is taken."""
        if not isinstance(event, QHelpEvent) or event.type() != QEvent.Type.ToolTip:
            return super().event(event)
        view = self._view_at(event.pos())
        QToolTip.showText(event.globalPos(), "" if view is None else _told(view), self)
        return True

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint what lies in the part that is asked for."""
        tokens, painter = tokens_of(self), QPainter(self)
        painter.setPen(QColor(tokens.text_caption))
        painter.setFont(font("caption"))
        titles = (tr("Before"), tr("After"), tr("Change"))
        for cell, title in zip(self._cells(0, self.TOP), titles, strict=False):
            painter.drawText(cell, _RIGHT, title)
        for title, units, top in self._heads:
            line = QRectF(self.EDGE, top, self.width() - 2 * self.EDGE, self.HEAD)
            painter.fillRect(QRectF(line.left(), line.bottom() - 1, line.width(), 1), QColor(tokens.line))
            painter.setFont(font("title"))
            painter.setPen(QColor(tokens.text))
            painter.drawText(line, _LEFT, title)
            painter.setFont(font("caption"))
            painter.setPen(QColor(tokens.text_caption))
            painter.drawText(self._cells(top, self.HEAD)[1], _RIGHT, units)
        for spot in self._spots:
            if event.rect().intersects(QRect(0, spot.top, self.width(), spot.height)):
                painter.setOpacity(0.45 if self.stale and spot.view.key else 1.0)
                self._paint_row(painter, spot)

    def _paint_row(self, painter: QPainter, spot: _Spot) -> None:
        tokens, view = tokens_of(self), spot.view
        missing = not view.known
        high, long = self.NAME if spot.wide else self.ROW, self._name_width(spot.wide or missing)
        name = QRectF(self.EDGE, spot.top + (3 if spot.wide else 0), long, high)
        if view.key and view.key == self.mark:
            painter.setPen(QColor(tokens.accent) if self.hasFocus() else Qt.PenStyle.NoPen)
            painter.setBrush(QColor(tokens.selected))
            painter.drawRoundedRect(QRectF(0.5, spot.top + 1.5, self.width() - 1, spot.height - 3), 5, 5)
        painter.setFont(font("body"))
        painter.setPen(QColor(tokens.text))
        painter.drawText(name, _LEFT, view.label)
        figures = spot.top + (self.NAME if spot.wide else 0)
        if spot.mixed and not missing:
            said = painter.fontMetrics().horizontalAdvance(view.label) + 6
            painter.setFont(font("caption"))
            painter.setPen(QColor(tokens.text_caption))
            painter.drawText(name.adjusted(said, 1, 0, 1), _LEFT, view.unit)
        if not missing:
            self._paint_figures(painter, view, figures)
        below = figures + self.ROW - 4
        painter.setFont(font("caption"))
        painter.setPen(QColor(tokens.text_caption))
        room = QRectF(self.EDGE, below, self.width() - 2 * self.EDGE, spot.top + spot.height - below)
        painter.drawText(room, _WRAPPED, view.caption)

    def _paint_figures(self, painter: QPainter, view: MeasureView, top: int) -> None:
        tokens = tokens_of(self)
        values = (
            (view.before, "body", tokens.text_caption, False),
            (view.after, "name", tokens.text, False),
            (view.change, "body", tokens.text_quiet, True),
        )
        cells = self._cells(top, self.ROW)
        for cell, (value, role, color, signed) in zip(cells, values, strict=False):
            painter.setFont(font(role, tabular=True))
            painter.setPen(QColor(color))
            painter.drawText(cell, _RIGHT, _written(value, view.unit, signed))
        if view.change is not None:
            self._paint_bar(painter, cells[-1], view.change / _full_bar(view.unit))

    def _paint_bar(self, painter: QPainter, cell: QRectF, share: float) -> None:
        tokens, middle = tokens_of(self), cell.center()
        length = min(max(share, -1.0), 1.0) * self.BAR / 2
        bar = QRectF(min(middle.x(), middle.x() + length), middle.y() - 3, abs(length), 6)
        painter.fillRect(bar, QColor(tokens.more if share > 0 else tokens.less))
        painter.fillRect(QRectF(middle.x() - 0.5, middle.y() - 7, 1, 14), QColor(tokens.control))

    def _lay_out(self) -> None:
        """Find where headings and rows stand, and how high all of it is."""
        self._spots, self._heads, top = [], [], self.TOP
        for group, rows in groupby(self.rows, key=lambda view: view.group):
            views = list(rows)
            units = list(dict.fromkeys(view.unit for view in views))
            if group:
                self._heads.append((group, units[0] if len(units) == 1 else "", top))
                top += self.HEAD
            for view in views:
                spot = self._spot(view, top, len(units) > 1 or not group)
                self._spots.append(spot)
                top += spot.height
        self.setFixedHeight(top + 1)

    def _spot(self, view: MeasureView, top: int, mixed: bool) -> _Spot:
        advance = QFontMetrics(font("body")).horizontalAdvance(view.label)
        advance += 4 + QFontMetrics(font("caption")).horizontalAdvance(view.unit) + 6 if mixed else 0
        missing = not view.known
        wide = advance > self._name_width(False) and not missing
        height = self.ROW + (self.NAME if wide else 0)
        if view.caption:
            room = QRect(0, 0, max(self.width() - 2 * self.EDGE, 60), 1000)
            height += QFontMetrics(font("caption")).boundingRect(room, _WRAPPED, view.caption).height()
        return _Spot(view, top, height, wide, mixed)

    def _name_width(self, wide: bool) -> int:
        return self.width() - 2 * self.EDGE - (0 if wide else sum(self.CELLS) + self.BAR + 8)

    def _cells(self, top: float, height: float) -> list[QRectF]:
        """Return the cells before, after, change and bar of a line of the table."""
        left = self.width() - self.EDGE - self.BAR
        cells = [QRectF(left, top, self.BAR, height)]
        left -= 6
        for room in reversed(self.CELLS):
            left -= room
            cells.append(QRectF(left, top, room, height))
        return cells[::-1]

    def _view_at(self, place: QPoint) -> MeasureView | None:
        spots = (each for each in self._spots if each.top <= place.y() < each.top + each.height)
        return next((spot.view for spot in spots), None)


def _digits(unit: str) -> int:
    return 0 if unit == "ml" else 1


def _written(value: float | None, unit: str, signed: bool = False) -> str:
    return "" if value is None else number(value, _digits(unit), signed)


def _full_bar(unit: str) -> float:
    """Return the change that fills half a bar, in ``unit``."""
    return {"ml": 100.0, "mm": 30.0}.get(unit, 10.0)


def _told(view: MeasureView) -> str:
    note = "" if view.note == view.caption else view.note
    return "\n".join(each for each in (view.label, view.tip, note) if each)


def _spoken(view: MeasureView) -> str:
    values = [
        f"{_written(each, view.unit)} {view.unit}" for each in (view.before, view.after) if each is not None
    ]
    return f"{view.label}: {' → '.join(values)} {view.caption}".rstrip()
