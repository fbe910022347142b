"""Placement of the legend of a map, off other panels, bands, labels and flags."""

# ruff: noqa: N802 - Qt names its events
from __future__ import annotations

import numpy as np
from PySide6.QtCore import QEvent, QObject, QPointF, QRect, QRectF, QTimer
from PySide6.QtWidgets import QApplication

from app.gui.features.maps.legend import SIZES, Legend
from app.gui.viewport.value_labels import ValueFlags
from app.gui.viewport.view_area import ViewArea
from core.geometry.mesh import Floats

CORNERS = ("top-right", "bottom-right", "top-left", "bottom-left")
"""Where it can be, the usual place first."""

_REST = 200  # a view that has not moved for so long rests [ms]
_WORD = 20  # a label that is covered is as bad as so many places of a band
_AIR = 6  # least distance from what it must not cover [px]


class LegendPlacement(QObject):
    """Moves a legend once what is seen rests; it stays where it covers nothing, and else becomes smaller.

    It folds where even the smaller one would lie on another panel or reach out of the view.
    """

    def __init__(self, view: ViewArea, legend: Legend, flags: ValueFlags) -> None:
        super().__init__(legend)
        self._view, self._legend, self._flags = view, legend, flags
        self._clock = QTimer(self, interval=_REST, singleShot=True)
        self._clock.timeout.connect(self.choose)
        view.viewport.view_changed.connect(self.consider)
        view.compared.connect(self.consider)
        view.floating.rearranged.connect(self.consider)
        view.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Check the placement when the size of the view changes."""
        if event.type() == QEvent.Type.Resize:
            self.consider()
        return False

    def consider(self) -> None:
        """Check soon whether the legend covers something."""
        if not self._legend.isHidden():
            self._clock.start()

    def choose(self) -> None:
        """Keep a place that covers nothing, else choose the first such place, else that which covers least.

        Between places that all cover something it stays, unless another covers a quarter less.
        """
        if self._legend.isHidden():
            return
        if QApplication.mouseButtons().value:  # it must not go from under the pointer
            self._clock.start()
            return
        size, here = self._legend.size_taken(), self._view.floating.corner_of(self._legend)
        order = sorted(CORNERS, key=lambda corner: corner != here)
        places, words = self._places(), self._words()
        full, small, folded = ([(each, corner) for corner in order] for each in SIZES)
        first = [full[0], (size, here)] if size != SIZES[-1] else []
        costs: dict[tuple[str, str], tuple[int, int]] = {}
        for spot in dict.fromkeys((*first, *full, *small)):
            costs[spot] = self._cost(*spot, places, words)
            if costs[spot] == (0, 0):
                return
        free = [spot for spot in small if not costs[spot][0]]
        if not free:
            free, costs = folded, {spot: self._cost(*spot, places, words) for spot in folded}
        best, stays = min(free, key=costs.__getitem__), free[0]
        (clashes, covered), (fewest, least) = costs[stays], costs[best]
        self._go(*(best if clashes > fewest or 0.75 * covered > least else stays))

    def _go(self, size: str, corner: str) -> None:
        self._legend.set_size(size)
        self._view.floating.move(self._legend, corner)

    def _cost(self, size: str, corner: str, places: Floats, words: list[QRectF]) -> tuple[int, int]:
        """Return how many panels the legend lies on there, and how much else it covers; it stays there."""
        self._go(size, corner)
        room = self._view.floating.seen(self._legend)
        return self._view.floating.clashes(self._legend), _covered(room, places, words)

    def _places(self) -> Floats:
        """Return places along all bands that are seen, shape (k, 2) [px of the view]."""
        found = [np.empty((0, 2))]
        for body in self._view.beside.bodies:
            viewport = body.viewport
            bands, origin = viewport.scene.bands, viewport.mapTo(self._view, QRect().topLeft())
            for name in set(bands.names) - body.hidden_lines if viewport.isVisible() else ():
                spine, _ = bands.spine(name)
                spots = viewport.view.to_picture(spine, viewport.width(), viewport.height())
                found.append(spots[:, :2] + (origin.x(), origin.y()))
        return np.concatenate(found)

    def _words(self) -> list[QRectF]:
        """Return where something is written over the view."""
        main = self._view.viewport.mapTo(self._view, QRect().topLeft())
        found = [each.translated(QPointF(main)) for each in self._flags.words()]
        for body in self._view.beside.bodies:
            origin = body.viewport.mapTo(self._view, QRect().topLeft())
            found += [each.translated(QPointF(origin)) for each in body.viewport.overlay.words()]
        return found + [QRectF(title.geometry()) for title in self._view.panes.titles]


def _covered(room: QRect, places: Floats, words: list[QRectF]) -> int:
    """Return how much a panel in this room would cover."""
    wide = room.adjusted(-_AIR, -_AIR, _AIR, _AIR)
    low, high = (wide.left(), wide.top()), (wide.right(), wide.bottom())
    inside = ((places >= low) & (places <= high)).all(axis=1).sum()
    return int(inside) + _WORD * sum(QRectF(wide).intersects(each) for each in words)
