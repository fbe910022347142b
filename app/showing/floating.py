"""Places for the panels that float on a view: its corners and the middles of its upper and lower edge."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QMargins, QObject, QPoint, QRect
from PySide6.QtWidgets import QWidget

from app.dress.parts import FloatingPanel

GAP = 14
"""Distance of what is seen of a panel from the edges of the view [px]."""

APART = 8
"""Least distance between two panels [px]."""

CORNERS = ("bottom", "bottom-left", "bottom-right", "top", "top-left", "top-right")
"""Where panels can be; panels of one corner are piled up, the first one at the edge."""


class Floating(QObject):
    """Keeps panels in their corners of ``view`` while it, or what they hold, changes its size.

    What stands in the middle keeps its place: a panel of a corner that would lie on it moves up or down.
    """

    def __init__(self, view: QWidget) -> None:
        super().__init__(view)
        self._view = view
        self._piles: dict[str, list[QWidget]] = {corner: [] for corner in CORNERS}
        view.installEventFilter(self)

    def place(self, panel: QWidget, corner: str) -> None:
        """Keep ``panel`` in one of ``CORNERS`` from now on; raises KeyError for another word."""
        pile = self._piles[corner]
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
        """Put the panels in their places when one comes, goes or grows."""
        kinds = (QEvent.Type.Show, QEvent.Type.Hide, QEvent.Type.LayoutRequest)
        if event.type() in kinds or (watched is self._view and event.type() == QEvent.Type.Resize):
            self.settle()
        return False

    def settle(self) -> None:
        """Put all panels in their places."""
        for edge in ("bottom", "top"):
            taken: list[QRect] = []
            for corner in CORNERS:
                for panel in self._piles[corner] if corner.startswith(edge) else ():
                    if not panel.isHidden():
                        panel.adjustSize()
                        room = _cleared(self._room(panel, corner), taken, edge == "bottom")
                        taken.append(room)
                        panel.move(room.topLeft() - QPoint(_shadow(panel).left(), _shadow(panel).top()))

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


def _cleared(room: QRect, taken: list[QRect], upwards: bool) -> QRect:
    """Return ``room`` moved away from the edge until it lies on none of those that are taken."""
    for other in taken:
        if room.adjusted(-APART, -APART, APART, APART).intersects(other):
            room.moveTop(other.top() - APART - room.height() if upwards else other.bottom() + 1 + APART)
    return room


def _shadow(panel: QWidget) -> QMargins:
    """Return how much of a panel is only its shadow."""
    return QMargins(*panel.MARGINS) if isinstance(panel, FloatingPanel) else QMargins()
