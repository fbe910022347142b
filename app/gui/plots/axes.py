"""How turns and values lie on the pixels of a plot, and the round numbers beside it."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QRectF
from PySide6.QtGui import QPainterPath

from app.presenters.plots import Numbers, round_ticks

_ROOM = 0.08  # of the range of values, above and below
_END = 0.02  # of the turns, behind the last


def load_curves() -> None:
    """Load what curves are drawn with, in whatever thread; at the latest once there are some."""
    import pyqtgraph  # noqa: F401, PLC0415


@dataclass(frozen=True)
class Scale:
    """Turns ``first`` to ``last`` and values ``low`` to ``high`` on ``area`` [px]."""

    area: QRectF
    first: float
    last: float
    low: float
    high: float

    def x(self, turn: float) -> float:
        """Return how far right a turn lies [px]."""
        return self.area.left() + (turn - self.first) * self.turn_width

    def y(self, value: float) -> float:
        """Return how far down a value lies [px]."""
        return self.area.bottom() - ((value - self.low) / self._span + _ROOM) * self._height

    def turn_at(self, x: float) -> float:
        """Return the turn that lies at ``x`` [px]."""
        return self.first + (x - self.area.left()) / self.turn_width

    @property
    def turn_width(self) -> float:
        """Width of one turn [px]."""
        return self.area.width() / ((1.0 + _END) * max(self.last - self.first, 1e-9))

    def path(self, turns: Numbers, values: Numbers) -> QPainterPath:
        """Return a curve [px], broken where a value is not finite."""
        from pyqtgraph import arrayToQPath  # noqa: PLC0415 (see load_curves)

        x = self.area.left() + (turns - self.first) * self.turn_width
        y = self.area.bottom() - ((values - self.low) / self._span + _ROOM) * self._height
        return QPainterPath(arrayToQPath(x, y, connect="finite"))

    def levels(self) -> list[float]:
        """Return the round values that get a line and a number."""
        return round_ticks(self.low, self.high, 4 if self.area.height() > 74 else 3)

    def turn_ticks(self) -> list[float]:
        """Return the round turns that get a number; the last piece is kept for the word."""
        ticks = round_ticks(self.first, self.last, 4)
        room = self.last - max(0.12 * (self.last - self.first), 52.0 / self.turn_width)
        return [tick for tick in ticks if tick < room and tick.is_integer()]

    @property
    def _span(self) -> float:
        return max(self.high - self.low, 1e-12)

    @property
    def _height(self) -> float:
        return self.area.height() / (1.0 + 2.0 * _ROOM)
