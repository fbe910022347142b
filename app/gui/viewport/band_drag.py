"""The selected band in the hand: pulled up it becomes shorter, down longer; any other drag is the view's."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QObject, QPointF, Qt, Signal

FINE = 0.1
"""What is left of a pull while Shift is held [1]."""


class BandHandle(QObject):
    """What a pointer pulls at; ``cursor_of`` tells how it looks over a band, None where that is not pulled.

    ``taken`` names the band, ``dragged`` carries how far it went up since [px], a tenth of it with Shift, and
    whether that was held; ``dropped`` says that the hand is open again.
    """

    taken = Signal(str)
    dragged = Signal(float, bool)
    dropped = Signal()

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self.cursor_of: Callable[[str], Qt.CursorShape | None] = lambda _: None
        self._name = ""

    def reach(self, name: str) -> bool:
        """Be ready to pull at a band, if it can be pulled; tells whether it can."""
        self._name = name if name and self.cursor_of(name) is not None else ""
        return bool(self._name)

    def takes(self, way: QPointF) -> bool:
        """Take what was reached for, if the pointer goes up or down; going across turns the body."""
        held = bool(self._name) and abs(way.y()) > abs(way.x())
        if held:
            self.taken.emit(self._name)
        return held

    def pull(self, step: QPointF, held: Qt.KeyboardModifier) -> None:
        """Pull on by so many pixels, y downwards."""
        fine = bool(held & Qt.KeyboardModifier.ShiftModifier)
        self.dragged.emit(-step.y() * (FINE if fine else 1.0), fine)
