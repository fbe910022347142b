"""The handle of the section plane in a 3D view: it is dragged along the plane's normal."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

import numpy as np
from PySide6.QtCore import QPointF, Qt, Signal
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen, QPolygonF

from app.gui.theme.stylesheet import tokens_of
from app.gui.viewport.handle import Handle
from app.gui.viewport.viewport import Viewport
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr
from app.rendering.camera import sheet_ends
from core.geometry.mesh import Floats, Points
from core.geometry.planar_curves import Plane

SIZE = 48
"""Width and height of the handle with its arrows [px]."""

_HOME = np.array([0.72, 0.2])  # where it stands if the sheet is seen there, as shares of the view
_MARGIN = 30.0  # from the edges of the view [px]
_CELLS = 24  # the sheet is looked through in so many rows and columns, then its best cell again
_FLATTEST = 0.35  # a normal seen shorter than this points at the eye: the drag then goes up and down


class PlaneHandle(Handle):
    """A knob that stands on the plane's sheet and stays there until the camera moves.

    ``dragged`` carries each step along the normal [mm], a tenth of it while Shift is held. Where the normal
    points at the eye, up is away from it.
    """

    dragged = Signal(float)

    def __init__(self, viewport: Viewport) -> None:
        name = tr("Section plane handle")
        super().__init__(
            viewport, SIZE, name, tr("Drag to move the section plane (Shift: fine, Esc: cancel)")
        )
        self._plane = Plane("x", 0.0)
        self._ends = np.zeros(2), np.zeros(2)
        self._flat: Floats | None = None  # where it stands on the plane [mm]
        self._way = np.array([1.0, 0.0])  # of one mm along the normal over the view [px]
        self.at_eye = False  # whether the normal points at it

    def show_plane(self, plane: Plane, low: Floats, high: Floats) -> None:
        """Place the handle on a plane through the box from ``low`` to ``high``, each (3,) [mm]."""
        if plane.axis != self._plane.axis:
            self._flat = None
        self._plane, self._ends = plane, sheet_ends(plane, low, high)
        self.show()
        self._stand()

    # -- where it stands

    def _stand_anew(self) -> None:
        if self._last is None:
            self._flat = None
        if not self.isHidden():
            self._stand()

    def _stand(self) -> None:
        """Go where the plane is; look for another place on it only if this one is not in the picture."""
        if self._flat is None or (self._last is None and not self._inside(self._spots(self._flat[None]))[0]):
            self._flat = self._best()
        spot = self._spots(self._flat[None])[0]
        self._way = self._way_of(spot)
        self.move(*(round(each) - SIZE // 2 for each in spot[:2]))
        self._show_cursor()
        self.update()

    def _best(self) -> Floats:
        """Return the flat place of the sheet, (2,) [mm], that is seen nearest to the handle's home."""
        low, high = self._ends
        home = _HOME * [self._viewport.width(), self._viewport.height()]
        best = 0.5 * (low + high)
        for _ in range(2):
            steps = np.linspace(0.0, 1.0, _CELLS + 1)
            grid = np.stack(np.meshgrid(*(low + steps[:, None] * (high - low)).T), axis=-1).reshape(-1, 2)
            spots = self._spots(grid)
            away = np.linalg.norm(spots[:, :2] - home, axis=1)
            best = grid[int(np.argmin(np.where(self._inside(spots), away, away + 1e6)))]
            cell = (high - low) / _CELLS
            low, high = np.maximum(best - cell, self._ends[0]), np.minimum(best + cell, self._ends[1])
        return np.asarray(best)

    def _way_of(self, spot: Floats) -> Floats:
        """Return the way of one mm along the normal, (2,) [px], for a handle that is seen at ``spot``."""
        assert self._flat is not None
        view, plane = self._viewport.scene.view, self._plane
        further = Plane(plane.axis, plane.at + 1.0).in_space(self._flat[None])
        way = np.asarray(view.to_picture(further, self._viewport.width(), self._viewport.height())[0] - spot)
        right, _, back = view.axes
        beside = plane.in_space(self._flat[None]) + right
        across = view.to_picture(beside, self._viewport.width(), self._viewport.height())[0] - spot
        full = float(np.linalg.norm(across[:2]))
        self.at_eye = bool(np.linalg.norm(way[:2]) < _FLATTEST * full)
        text = tr("Drag to move the section plane (Shift: fine, Esc: cancel)")
        towards = tr("Drag up to move the plane away from you, down to move it towards you.")
        set_tip(self, "\n".join((text, towards)) if self.at_eye else text)
        if not self.at_eye:
            return way[:2]
        return np.array([0.0, full if plane.normal @ back > 0.0 else -full])

    def _spots(self, flat: Floats) -> Points:
        places = self._plane.in_space(flat)
        return self._viewport.scene.view.to_picture(places, self._viewport.width(), self._viewport.height())

    def _inside(self, spots: Points) -> Floats:
        """Return which places are seen well within the view, shape (k,)."""
        room = np.array([self._viewport.width(), self._viewport.height()]) - _MARGIN
        within = (spots[:, :2] >= _MARGIN) & (spots[:, :2] <= room)
        return np.asarray(within.all(axis=1) & (spots[:, 2] > 0.0))

    # -- the hand

    def _pull(self, over: Floats) -> None:
        self.dragged.emit(float(self._way @ over) / max(float(self._way @ self._way), 1e-6))

    def open_hand(self) -> None:
        self._last = None
        self._stand()  # elsewhere on the plane, if it was dragged out of the picture

    # -- painting

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens, painter = tokens_of(self), QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.translate(SIZE / 2.0, SIZE / 2.0)
        lively = self._hovered or self._last is not None
        if lively:
            halo = QColor(tokens.accent)
            halo.setAlpha(60)
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(halo)
            painter.drawEllipse(QPointF(), 13.0, 13.0)
        if self.at_eye:
            painter.rotate(-90.0)
        else:
            painter.rotate(float(np.degrees(np.arctan2(self._way[1], self._way[0]))))
        # A rim of the other brightness keeps arrows and knob apart from any skin behind them.
        painter.setPen(QPen(QColor(tokens.raised), 1.4))
        painter.setBrush(QColor(tokens.accent))
        for side in (-1.0, 1.0):
            # What goes away from the eye, up here, is seen smaller than what comes towards it.
            size = 1.0 if not self.at_eye else 0.75 if side > 0.0 else 1.2
            corners = ((0.0, -5.5), (8.0, 0.0), (0.0, 5.5))
            painter.drawPolygon(QPolygonF([QPointF(side * (13.0 + size * x), size * y) for x, y in corners]))
        painter.setPen(QPen(QColor(tokens.accent), 2.4 if lively else 1.8))
        painter.setBrush(QColor(tokens.raised))
        painter.drawEllipse(QPointF(), 8.5, 8.5)
        if self.at_eye:  # an arrow seen from its point
            painter.setBrush(QColor(tokens.accent))
            painter.drawEllipse(QPointF(), 2.0, 2.0)
