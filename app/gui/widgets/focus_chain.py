"""Keyboard focus in reading order; a ring where a widget shows no focus itself."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QPoint, QRect, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QAbstractButton, QAbstractScrollArea, QApplication, QScrollArea, QWidget

from app.gui.theme.stylesheet import tokens_of

_LINE = 12
"""Pixels that the middles of widgets may lie apart in height, and be read as one line."""


def stops(pane: QWidget) -> list[QWidget]:
    """Return what of a pane takes the keyboard, line by line from left to right.

    Of buttons of which one is on there is one stop: arrow keys go among them. What is scrolled is read as a
    whole, where it stands, however far its rows reach beyond.
    """
    blocks: dict[QWidget, list[QWidget]] = {}
    for each in pane.findChildren(QWidget):
        if _is_stop(each):
            blocks.setdefault(_block(each, pane), []).append(each)
    lines: list[tuple[int, list[tuple[int, QWidget]]]] = []
    places = [(each.mapTo(pane, each.rect().center()), each) for each in blocks]
    for place, each in sorted(places, key=lambda at: at[0].y()):
        if not lines or place.y() - lines[-1][0] > _LINE:
            lines.append((place.y(), []))
        lines[-1][1].append((place.x(), each))
    order = [each for _, line in lines for _, each in sorted(line, key=lambda at: at[0])]
    return [stop for each in order for stop in _within(each, blocks[each])]


def next_stop(order: Sequence[QWidget], forward: bool) -> bool:
    """Move the keyboard focus in an order of stops; returns whether it did.

    From what takes it no longer, because it has gone, it goes to what stood nearest in the same part; from
    a panel that has it as a whole to what stands first in it.
    """
    if not order:
        return False
    has, reason = QApplication.focusWidget(), Qt.FocusReason.TabFocusReason
    if has in order:
        target = order[(order.index(has) + (1 if forward else -1)) % len(order)]
    else:
        inside = [each for each in order if has is not None and has.isAncestorOf(each)]
        target = (inside or order)[0 if forward else -1]
        if not inside:
            target = _nearest(has, order) or target
    target.setFocus(reason if forward else Qt.FocusReason.BacktabFocusReason)
    bring_in(target)
    return True


def _block(widget: QWidget, pane: QWidget) -> QWidget:
    """Return the outermost scrolled area of a pane that a widget stands in, or itself."""
    block, parent = widget, widget.parentWidget()
    while parent is not None and parent is not pane:
        if isinstance(parent, QScrollArea):
            block = parent
        parent = parent.parentWidget()
    return block


def _within(block: QWidget, found: Sequence[QWidget]) -> list[QWidget]:
    """Return what takes the keyboard of a block: a scrolled area itself, if it does, then what is in it."""
    inside = block.widget() if isinstance(block, QScrollArea) else None
    return [each for each in found if each is block] + (stops(inside) if inside is not None else [])


def bring_in(widget: QWidget) -> None:
    """Scroll to where a widget is seen; what is higher than the room stays as it is."""
    parent = widget.parentWidget()
    while parent is not None and not parent.isWindow():
        if isinstance(parent, QScrollArea) and widget.height() <= parent.viewport().height():
            parent.ensureWidgetVisible(widget, 0, _LINE)
        parent = parent.parentWidget()


def _nearest(lost: QWidget | None, order: Sequence[QWidget]) -> QWidget | None:
    """Return the stop nearest to a widget, within the smallest part round it that has one."""
    part = lost.parentWidget() if lost is not None else None
    while lost is not None and part is not None:
        inside = [each for each in order if part.isAncestorOf(each)]
        if inside:
            places = [each.mapTo(part, each.rect().center()) for each in (lost, *inside)]
            away = [(place - places[0]).manhattanLength() for place in places[1:]]
            return inside[away.index(min(away))]
        part = part.parentWidget()
    return None


def _is_stop(widget: QWidget) -> bool:
    if not (widget.isVisible() and widget.isEnabled()) or widget.focusProxy() is not None:
        return False
    group = widget.group() if isinstance(widget, QAbstractButton) else None
    if group is not None and group.exclusive():
        usable = [each for each in group.buttons() if each.isVisible() and each.isEnabled()]
        return widget is (group.checkedButton() if group.checkedButton() in usable else usable[0])
    return bool(widget.focusPolicy() & Qt.FocusPolicy.TabFocus) and not _is_folded_away(widget)


def _is_folded_away(widget: QWidget) -> bool:
    """Return whether a widget lies outside of what it stands in, which has been made small."""
    parent = widget.parentWidget()
    while parent is not None and not isinstance(parent.parentWidget(), QAbstractScrollArea):
        if not parent.rect().intersects(QRect(widget.mapTo(parent, QPoint()), widget.size())):
            return True
        # A dialog lies in no part of the window that it belongs to.
        parent = parent.parentWidget() if not parent.isWindow() else None
    return False


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
        """Surround a widget while it has the focus."""
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
