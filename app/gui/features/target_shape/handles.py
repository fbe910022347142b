"""The handles on the body: what is wished for by hand while the result is asked for."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QObject, Signal

from app.gui.features.target_shape.profile_card import ProfileHandles
from app.gui.viewport.target_handle import TargetHandle
from app.i18n.catalog import tr
from app.presenters.bust_shift import bust_shift
from core.analysis.inverse_design.profile_curve import ProfileCurve
from core.geometry.mesh import Floats
from core.pipeline.frame import Frame

if TYPE_CHECKING:
    from app.gui.context import AppContext
    from app.gui.features.target_shape.controller import TargetShapeController

SIDES = ("left", "right")
KINDS = {"bust": ("lift", "out"), "apex": ("apex lift", "apex out")}
"""What the handles wish for, up and out, by what they are dragged at."""

_ASIDE = 0.25  # of the way of a hand: less to the side of it is not meant [1]
_STILL = 0.05  # no way at all; Shift drags in small steps [mm]
_NAMES = {"left": lambda: tr("Left handle"), "right": lambda: tr("Right handle")}
_FARTHEST = 80.0  # a bust point is not dragged further from where it is at rest [mm]


class TargetHandles(QObject):
    """One handle a side in the main view; linked they wish for the mean of both, else for each side.

    ``kind`` is what they are dragged at: "bust" points, "apex", the foremost places, or "profile": then there
    are those of the drawn profiles instead.
    """

    carrying_changed = Signal()

    def __init__(self, context: AppContext, controller: TargetShapeController) -> None:
        super().__init__(controller)
        self._context, self._controller = context, controller
        self.kind = "bust"
        self.by_side: dict[str, TargetHandle] = {}
        self.profile = ProfileHandles(context.view.viewport, self)
        self._before: tuple[dict[str, float | None], dict[str, ProfileCurve]] | None = None
        self._pulled: dict[str, float] = {}  # how far the hand has gone each way since it closed [mm]
        self.profile.taken.connect(self._take_profile)
        self.profile.dragged.connect(self._draw)
        self.profile.dropped.connect(self._drop)

    @property
    def carries(self) -> bool:
        """Return whether a hand has hold of one."""
        return self._before is not None

    def let_go(self) -> bool:
        """Restore the targets before the drag; returns whether there was one."""
        before, self._before = self._before, None
        if before is None:
            return False
        self._open_hands()
        figures, drawn = before
        for section, profile in drawn.items():
            self._controller.drawing.draw(section, profile)
        self._controller.wish_by_hand(figures, at_rest=True)
        self.carrying_changed.emit()
        return True

    def put_away(self) -> None:
        """Show them no longer."""
        self._before = None
        for handle in self.by_side.values():
            handle.put_away()
        self.profile.put_away()

    def follow(self) -> None:
        """Place the handles at the target bust points of the shown body."""
        frame, view = self._context.session.frame, self._context.view
        if (
            frame is None
            or not self._controller.is_open
            or not view.after
            or not self._controller.ground.asks
            or not (design := self._controller.ground.design)
            or not design.lines
        ):
            self.put_away()
            return
        if self.kind == "profile":
            for handle in self.by_side.values():
                handle.put_away()
            if not self.carries:
                self._controller.drawing.follow(frame)
            self.profile.follow(frame, self._controller.drawn)
            return
        self.profile.put_away()
        if not self.by_side:
            self._make()
        watch = frame.stages.watch
        feet = (watch.apex_places if self.kind == "apex" else watch.bust_points)(frame.control_points)
        for side, foot in zip(SIDES, feet, strict=True):
            self.by_side[side].show_at(foot + self._missing(frame, side), foot)

    def _make(self) -> None:
        for side in SIDES:
            handle = TargetHandle(self._context.view.viewport, side, _NAMES[side]())
            handle.taken.connect(self._take)
            handle.dragged.connect(partial(self._pull, side))
            handle.dropped.connect(self._drop)
            self.by_side[side] = handle

    def _missing(self, frame: Frame, side: str) -> Floats:
        """Return the way from the bust point of a side to where it is wished, (3,) [mm]."""
        wishes = self._controller.wishes
        up, out = (
            next(
                (
                    value - _now(frame, name)
                    for name in (f"{what} {side}", what)
                    if (value := wishes.get(name)) is not None
                ),
                0.0,
            )
            for what in KINDS[self.kind]
        )
        return np.array([0.0, -out, up])

    def _take(self) -> None:
        if self._before is None:
            self._before = dict(self._controller.wishes), dict(self._controller.drawn)
            self._pulled = dict.fromkeys(KINDS.get(self.kind, ()), 0.0)
            self.carrying_changed.emit()

    def _take_profile(self, section: str) -> None:
        """Take the curve of a section; from elsewhere than its side a hand cannot tell out from across."""
        drawing = self._controller.drawing
        if drawing.is_from_side(section):
            self._take()
        else:
            self._open_hands()
            drawing.look_at(self._controller.drawn[section])

    def _open_hands(self) -> None:
        for handle in (*self.by_side.values(), *self.profile.all()):
            handle.open_hand()

    def _draw(self, section: str, handle: int, up: float, out: float) -> None:
        """Continue with the curve of a section by a step of the hand at one of its handles [mm]."""
        if self._before is not None:
            self._controller.drawing.draw(
                section, self._controller.drawn[section].with_moved_handle(handle, up, out)
            )
            self._controller.wish_by_hand(dict(self._controller.wishes), at_rest=False)

    def _pull(self, side: str, up: float, out: float) -> None:
        """Continue with the wishes by a step of the hand [mm]."""
        frame = self._context.session.frame
        if frame is None or self._before is None:
            return
        wishes, linked = dict(self._controller.wishes), self._controller.card.link.isChecked()
        for what, step in zip(KINDS[self.kind], (up, out), strict=True):
            name = what if linked else f"{what} {side}"
            self._pulled[what] += step
            if wishes.get(name) is not None or self._is_meant(what):
                value = wishes.get(name)
                value = _now(frame, name) + self._pulled[what] if value is None else value + step
                for other in (what, *(f"{what} {each}" for each in SIDES)):
                    if other != name and (linked or other == what):
                        wishes.pop(other, None)
                wishes[name] = float(np.clip(value, -_FARTHEST, _FARTHEST))
        self._controller.wish_by_hand(wishes, at_rest=False)

    def _is_meant(self, what: str) -> bool:
        """Return whether the hand goes that way on purpose: a way that was free stays so if it does not."""
        way = abs(self._pulled[what])
        return way > _ASIDE * max(map(abs, self._pulled.values())) and way > _STILL

    def _drop(self) -> None:
        if self._before is not None:
            self._before = None
            self._controller.wish_by_hand(dict(self._controller.wishes), at_rest=True)
            self.carrying_changed.emit()


def _now(frame: Frame, name: str) -> float:
    """Return what a figure of the bust points or the foremost places is on the shown body [mm]."""
    upward, side = "lift" in name, next((each for each in SIDES if name.endswith(each)), "")
    if name.startswith("apex "):
        places = (frame.control_points, frame.stages.control.mesh.vertices)
        after, before = (frame.stages.watch.apexes(points) for points in places)
        steps = (after - before)[:, 1] if upward else (before - after)[:, 0]
        return float(steps[SIDES.index(side)] if side else steps.mean())
    move = bust_shift(frame)
    step = {"": move.mean, "left": move.left, "right": move.right}[side]
    return step.up if upward else step.forward
