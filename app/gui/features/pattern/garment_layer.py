"""The garment on the body in the 3D view: its seams are pointed at, clicked, and dragged by their points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QObject, QPointF, Qt, QTimer, Signal

from app.gui.viewport.drawing_tool import DrawingTool
from app.rendering.vertex_colors import Colours
from core.geometry.mesh import Faces, Floats, Indices, Points

if TYPE_CHECKING:
    from app.gui.context import AppContext
    from app.rendering.garment_actor import GarmentActor
    from core.pattern.garment import Pattern

_CLICK = 3.0  # pixels that the pointer may stray within a click
_NEAR, _GRIP = 8.0, 13.0  # how near to a seam and to one of its points the pointer means it [px]


@dataclass(frozen=True, eq=False)
class GarmentSeams:
    """The panels of a pattern on the body in one mesh, and its seams.

    ``faces`` (m, 3) are numbers of ``points`` (n, 3) [mm], whose panels are ``owner`` (n,); ``curves`` are
    the stretches of each seam by its name, each (k, 3) [mm].
    """

    points: Points
    faces: Faces
    owner: Indices
    names: tuple[str, ...]
    curves: dict[str, list[Points]] = field(default_factory=dict)

    @classmethod
    def of(cls, pattern: Pattern) -> GarmentSeams:
        """Return the panels and seams of a pattern on the body."""
        sizes = [len(places) for places in pattern.places]
        starts = np.concatenate([[0], np.cumsum(sizes)[:-1]])
        panels = [flat.panel for flat in pattern.flats]
        faces = np.concatenate([panel.faces + start for panel, start in zip(panels, starts, strict=True)])
        number = {panel.name: k for k, panel in enumerate(panels)}
        curves: dict[str, list[Points]] = {}
        for k, panel in enumerate(panels):
            for side in panel.sides:
                if side.partner is None or number.get(side.partner[0], k) >= k:
                    curves.setdefault(side.name, []).append(pattern.places[k][side.points])
        owner = np.repeat(np.arange(len(panels)), sizes)
        names = tuple(panel.name for panel in panels)
        return cls(np.concatenate(pattern.places), faces, owner, names, curves)


class GarmentLayer(QObject):
    """Draws the garment, and listens to the pointer while it is ``at_work``.

    ``seam_chosen``, ``piece_chosen`` and ``seam_hovered`` carry names, empty for none; ``moved`` the number
    of a point of the selected seam and where it is dragged to on the original body, (3,) [mm], then
    ``dropped`` or ``cancelled``. A click on a point selects it as ``handle`` (``handle_chosen``), Delete
    requests its removal (``point_removed``), a double click on the seam a new one (``point_requested``,
    (3,) [mm]).
    """

    seam_chosen = Signal(str)
    piece_chosen = Signal(str)
    seam_hovered = Signal(str)
    moved = Signal(int, object)
    dropped = Signal()
    cancelled = Signal()
    handle_chosen = Signal()
    point_requested = Signal(object)
    point_removed = Signal()

    def __init__(self, context: AppContext) -> None:
        super().__init__(context.session)
        self._viewport = context.view.viewport
        canvas = self._viewport.overlay.parentWidget()
        assert canvas is not None
        self._canvas = canvas
        self.hand = DrawingTool(self._viewport, canvas)
        self.hand.grabs, self.hand.takes = self._grabs, self._takes
        self.hand.clicked.connect(self._click)
        self.hand.hovered.connect(self._hover)
        self.hand.dragged.connect(self._drag)
        self.hand.dropped.connect(self._drop)
        self.hand.double_clicked.connect(self._request_point)
        self.hand.requested.connect(self._press)
        self._actor: GarmentActor | None = None
        self.seams: GarmentSeams | None = None
        self._colours: Colours = np.zeros((0, 3), dtype=np.uint8)
        self.seam = self._hovered = ""
        self._handles: Points = np.empty((0, 3))
        self._knob: Points = np.empty((0, 3))
        self._marks: tuple[Points, ...] = ()
        self._held: int | None = None
        self._moved, self._pressed = False, QPointF()
        self.handle: int | None = None
        self._redraw = QTimer(self, interval=0, singleShot=True)  # what changes together is drawn once
        self._redraw.timeout.connect(self._draw)

    @property
    def carries(self) -> bool:
        """Return whether a hand has hold of a point."""
        return self._held is not None

    def begin(self) -> None:
        """Listen to the pointer."""
        self.hand.begin()
        self._canvas.setCursor(Qt.CursorShape.ArrowCursor)

    def end(self) -> None:
        """Listen no longer, and draw nothing."""
        if self.hand.at_work:
            self.hand.end()
        self.clear()

    def release(self) -> None:
        """Let go of the point that is dragged."""
        self._held = None

    def clear(self) -> None:
        """Draw nothing."""
        self.seams = None
        self._redraw.stop()
        if self._actor is not None and self._actor.is_shown:
            self._actor.clear()
            self._viewport.request_draw()

    def show(self, seams: GarmentSeams, colours: Colours) -> None:
        """Draw a garment in these colours of its points, (n, 3)."""
        self.seams, self._colours = seams, colours
        self._redraw.start()

    def select(self, seam: str, handles: Points) -> None:
        """Mark a seam, with its points on the original body that can be dragged, (h, 3) [mm]."""
        if seam != self.seam or len(handles) != len(self._handles):
            self.handle = None
        self.seam, self._handles = seam, handles
        self._redraw.start()

    def hover(self, seam: str) -> None:
        """Mark the seam under the pointer, here or among the pieces."""
        if seam != self._hovered:
            self._hovered = seam
            self._redraw.start()

    def mark(self, curves: Sequence[Points]) -> None:
        """Draw curves on the cloth beside the seams, each (k, 3) [mm]: a dart that is tried."""
        self._marks = tuple(curves)
        self._redraw.start()

    def walk(self, knob: Points) -> None:
        """Show where a seam is walked, (0 or more, 3) [mm]."""
        self._knob = knob
        self._redraw.start()

    def set_dark(self, dark: bool) -> None:
        """Repaint for one theme."""
        if self._actor is not None:
            self._actor.set_dark(dark)
            self._redraw.start()

    def _draw(self) -> None:
        if self.seams is None or not self._viewport.shows_body:
            return
        from app.rendering.garment_actor import GarmentActor, GarmentDrawing  # noqa: PLC0415 (brings VTK along)

        scene = self._viewport.scene
        if self._actor is None:
            self._actor = GarmentActor(scene.plotter, self._viewport.devicePixelRatioF())
            self._actor.set_dark(scene.dark)
        handles = scene.carried_points(self._handles) if len(self._handles) else self._handles
        marked = [curve for name in {self.seam, self._hovered} for curve in self.seams.curves.get(name, ())]
        marked += self._marks
        plain = [curve for curves in self.seams.curves.values() for curve in curves]
        points = [self._knob] if self.handle is None else [self._knob, handles[[self.handle]]]
        drawn = GarmentDrawing(
            self.seams.points, self.seams.faces, self._colours, plain, marked, handles, np.concatenate(points)
        )
        self._actor.show(drawn)
        self._viewport.request_draw()

    # -- the hand

    def _spots(self, points: Points) -> Floats:
        overlay = self._viewport.overlay
        spots = self._viewport.scene.view.to_picture(points, overlay.width(), overlay.height())
        return np.asarray(spots[:, :2])

    def seam_at(self, spot: QPointF) -> str:
        """Return the seam that is seen at a place of the view, or an empty text."""
        if self.seams is None:
            return ""
        best, found, place = _NEAR, "", np.array([spot.x(), spot.y()])
        for name, curves in self.seams.curves.items():
            for curve in curves:
                away = np.hypot(*(self._spots(curve) - place).T)
                near = int(away.argmin())
                if away[near] < best and not self._viewport.scene.hidden(curve[near]):
                    best, found = float(away[near]), name
        return found

    def _handle_at(self, spot: QPointF) -> int | None:
        if not len(self._handles):
            return None
        shown = self._viewport.scene.carried_points(self._handles)
        away = np.hypot(*(self._spots(shown) - [spot.x(), spot.y()]).T)
        near = int(away.argmin())
        return near if away[near] < _GRIP and not self._viewport.scene.hidden(shown[near]) else None

    def _piece_at(self, spot: QPointF) -> str:
        rest = self._viewport.skin_at(spot)
        if rest is None or self.seams is None:
            return ""
        place = self._viewport.scene.carried_points(rest[None])[0]
        away = np.linalg.norm(self.seams.points - place, axis=1)
        near = int(away.argmin())
        return self.seams.names[int(self.seams.owner[near])] if away[near] < _NEAR else ""

    def _click(self, spot: QPointF) -> None:
        seam = self.seam_at(spot)
        if seam:
            self.seam_chosen.emit(seam)
        else:
            self.piece_chosen.emit(self._piece_at(spot))

    def _hover(self, spot: QPointF) -> None:
        over = self._handle_at(spot) is not None
        self._canvas.setCursor(Qt.CursorShape.OpenHandCursor if over else Qt.CursorShape.ArrowCursor)
        seam = "" if over else self.seam_at(spot)
        if seam != self._hovered:
            self.hover(seam)
            self.seam_hovered.emit(seam)

    def _grabs(self, spot: QPointF) -> bool:
        self._held, self._moved, self._pressed = self._handle_at(spot), False, spot
        return self._held is not None

    def _drag(self, spot: QPointF) -> None:
        if not self._moved and (spot - self._pressed).manhattanLength() <= _CLICK:
            return
        rest = self._viewport.skin_at(spot)
        if self._held is not None and rest is not None:
            self._moved = True
            self.moved.emit(self._held, rest)

    def _drop(self, _: QPointF) -> None:
        if self._held is None:
            return
        held, self._held = self._held, None
        if self._moved:
            self.dropped.emit()
            return
        self.handle = held
        self._redraw.start()
        self.handle_chosen.emit()

    def _request_point(self, spot: QPointF) -> None:
        rest = self._viewport.skin_at(spot)
        if rest is not None and self.seam and self.seam_at(spot) == self.seam:
            self.point_requested.emit(rest)

    def _takes(self, request: str) -> bool:
        if request == "back":
            return self.handle is not None
        return request == "leave" and bool(self.seam or self._held is not None)

    def _press(self, request: str) -> None:
        if request == "back" and self.handle is not None:
            self.point_removed.emit()
        if request != "leave":
            return
        if self._held is not None:
            self._held = None
            self.cancelled.emit()
        else:
            self.seam_chosen.emit("")


def vertex_colours(pattern: Pattern, ramp: Sequence[Floats]) -> Colours:
    """Return the colours of the points of all panels, (n, 3) uint8, from those of their triangles, (m, 3)."""
    parts = []
    for flat, colours in zip(pattern.flats, ramp, strict=True):
        count = len(flat.points)
        weight = np.bincount(flat.panel.faces.ravel(), np.repeat(flat.areas, 3), count)
        summed = [
            np.bincount(flat.panel.faces.ravel(), np.repeat(flat.areas * colours[:, k], 3), count)
            for k in range(3)
        ]
        parts.append(np.stack(summed, axis=1) / np.maximum(weight, 1e-12)[:, None])
    return np.asarray(np.round(np.concatenate(parts)), dtype=np.uint8)
