"""How turns and values lie on the pixels of a plot, and the round numbers beside it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QByteArray, QDataStream, QRectF
from PySide6.QtGui import QPainterPath

from app.presenters.plots import Numbers, round_ticks
from core.geometry.mesh import Floats

_ROOM = 0.08  # of the range of values, above and below
_END = 0.02  # of the turns, behind the last


# An element of a QPainterPath as QDataStream reads it: 0 moves to the point, 1 draws a line to it.
_ELEMENT = np.dtype([("kind", ">i4"), ("point", ">f8", 2)])


def curve_path(points: Floats) -> QPainterPath:
    """Return a polyline through ``points`` (n, 2) [px], broken where one is not finite.

    The points are handed to Qt as one block of memory: one call a point takes six times as long.
    """
    kept = np.flatnonzero(np.isfinite(points).all(axis=1))
    elements = np.zeros(len(kept), _ELEMENT)
    elements["point"] = points[kept]
    elements["kind"][1:] = np.diff(kept) == 1
    start_and_fill_rule = bytes(8)
    path = QPainterPath()
    stream = QDataStream(
        QByteArray(np.array(len(kept), ">i4").tobytes() + elements.tobytes() + start_and_fill_rule)
    )
    stream >> path
    return path


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
        x = self.area.left() + (turns - self.first) * self.turn_width
        y = self.area.bottom() - ((values - self.low) / self._span + _ROOM) * self._height
        return curve_path(np.column_stack((x, y)))

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
