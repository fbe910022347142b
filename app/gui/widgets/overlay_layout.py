"""Places for the panels that float on a view: its corners and the middles of its upper and lower edge."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QMargins, QObject, QPoint, QRect, Signal
from PySide6.QtWidgets import QWidget

from app.gui.widgets.basic import FloatingPanel

GAP = 14
"""Distance of what is seen of a panel from the edges of the view [px]."""

APART = 8
"""Least distance between two panels [px]."""

CORNERS = ("bottom", "bottom-left", "bottom-right", "top-left", "top-right", "top")
"""Where panels can be; panels of one corner are piled up, the first one at the edge."""


class OverlayLayout(QObject):
    """Keeps panels in their corners of ``view`` while it, or what they hold, changes its size.

    What stands in the middle of the lower edge keeps its place: a panel of a corner that would lie on it
    moves up. In the middle of the upper edge a panel moves sideways, where there is room, else below others.
    A panel that ``yields`` gets its place after all others. ``rearranged``: one of those others came, went,
    grew or moved.
    """

    rearranged = Signal()

    def __init__(self, view: QWidget) -> None:
        super().__init__(view)
        self._view = view
        self._yielding: set[QWidget] = set()
        self._firm: list[QRect] = []
        self._piles: dict[str, list[QWidget]] = {corner: [] for corner in CORNERS}
        view.installEventFilter(self)

    def place(self, panel: QWidget, corner: str, yields: bool = False) -> None:
        """Keep ``panel`` in one of ``CORNERS`` from now on; raises KeyError for another word."""
        pile = self._piles[corner]
        if yields:
            self._yielding.add(panel)
        if panel.parentWidget() is not self._view:
            panel.setParent(self._view)
        pile.append(panel)
        panel.installEventFilter(self)
        panel.raise_()
        self.settle()

    def corner_of(self, panel: QWidget) -> str:
        """Return the corner that a panel is kept in."""
        return next(corner for corner, pile in self._piles.items() if panel in pile)

    def move(self, panel: QWidget, corner: str) -> None:
        """Keep a panel in another corner from now on, behind those that are there."""
        if corner != self.corner_of(panel):
            self._piles[self.corner_of(panel)].remove(panel)
            self._piles[corner].append(panel)
        self.settle()

    def seen(self, panel: QWidget) -> QRect:
        """Return where the visible part of a panel is."""
        return panel.geometry().marginsRemoved(_shadow(panel))

    def remove(self, panel: QWidget) -> None:
        """Leave ``panel`` where it is from now on."""
        for pile in self._piles.values():
            if panel in pile:
                pile.remove(panel)
                panel.removeEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
        """Place the panels in their places when one comes, goes or grows."""
        kinds = (QEvent.Type.Show, QEvent.Type.Hide, QEvent.Type.LayoutRequest)
        if event.type() in kinds or (watched is self._view and event.type() == QEvent.Type.Resize):
            self.settle()
        return False

    def settle(self) -> None:
        """Place all panels in their places."""
        taken: dict[bool, list[QRect]] = {True: [], False: []}
        self._put(self._shown(yields=False), taken)
        firm = [*taken[True], *taken[False]]
        self._put(self._shown(yields=True), taken)
        if firm != self._firm:
            self._firm = firm
            self.rearranged.emit()

    def _put(self, panels: list[tuple[str, QWidget]], taken: dict[bool, list[QRect]]) -> None:
        """Place panels in their corners, off what is ``taken`` at the lower edge (True) and at the upper."""
        for corner, panel in panels:
            low = corner.startswith("bottom")
            panel.adjustSize()
            room = self._room(panel, corner)
            if corner == "top":
                room = _between(room, taken[low], self._view.rect().adjusted(GAP, GAP, -GAP, -GAP))
            room = _cleared(room, taken[low], low)
            taken[low].append(room)
            panel.move(room.topLeft() - QPoint(_shadow(panel).left(), _shadow(panel).top()))

    def clashes(self, panel: QWidget) -> int:
        """Return how many others ``panel`` lies on, and one more if it reaches out of the view."""
        room = self.seen(panel)
        shown = [each for yields in (False, True) for _, each in self._shown(yields) if each is not panel]
        over = sum(room.intersects(self.seen(each)) for each in shown)
        return over + (not self._view.rect().contains(room))

    def headroom(self, panel: QWidget) -> int:
        """Return how high the visible part of a panel of the lower edge may be where it stands [px].

        What is piled on it stays within the view.
        """
        room, pile = self.seen(panel), self._piles[self.corner_of(panel)]
        on_it = [self.seen(each) for each in pile[pile.index(panel) + 1 :] if not each.isHidden()]
        above = [self.seen(each) for corner, each in self._shown(yields=False) if corner.startswith("top")]
        low = [
            each.bottom() + APART
            for each in above
            if room.left() <= each.right() and each.left() <= room.right()
        ]
        return room.bottom() - max([GAP - 1, *low]) - sum(each.height() + APART for each in on_it)

    def _shown(self, yields: bool) -> list[tuple[str, QWidget]]:
        """Return the panels that are not hidden with their corners, in the order they get their places."""
        both = [(corner, panel) for corner in CORNERS for panel in self._piles[corner]]
        return [each for each in both if not each[1].isHidden() and (each[1] in self._yielding) == yields]

    def _room(self, panel: QWidget, corner: str) -> QRect:
        """Return where the visible part of a panel belongs, if nothing else is there."""
        room = QRect(QPoint(), panel.size()).marginsRemoved(_shadow(panel))
        area = self._view.rect().adjusted(GAP, GAP, -GAP, -GAP)
        room.moveCenter(area.center())
        if corner.endswith("left"):
            room.moveLeft(area.left())
        elif corner.endswith("right"):
            room.moveRight(area.right())
        if corner.startswith("top"):
            room.moveTop(area.top())
        else:
            room.moveBottom(area.bottom())
        return room


def _between(room: QRect, taken: list[QRect], area: QRect) -> QRect:
    """Return ``room`` moved sideways between those at its left and at its right, if it fits there."""
    level = [each for each in taken if each.top() <= room.bottom() and room.top() <= each.bottom()]
    middle = area.center().x()
    low = max([area.left(), *(each.right() + 1 + APART for each in level if each.center().x() < middle)])
    high = min([area.right(), *(each.left() - 1 - APART for each in level if each.center().x() >= middle)])
    if high - low + 1 < room.width():
        return room
    return QRect(QPoint(max(low, min(room.left(), high + 1 - room.width())), room.top()), room.size())


def _cleared(room: QRect, taken: list[QRect], upwards: bool) -> QRect:
    """Return ``room`` moved away from the edge until it lies on none of those that are taken."""
    for other in taken:
        if room.adjusted(-APART, -APART, APART, APART).intersects(other):
            room.moveTop(other.top() - APART - room.height() if upwards else other.bottom() + 1 + APART)
    return room


def _shadow(panel: QWidget) -> QMargins:
    """Return how much of a panel is only its shadow."""
    return QMargins(*panel.MARGINS) if isinstance(panel, FloatingPanel) else QMargins()
