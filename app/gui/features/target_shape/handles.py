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
from app.presenters.landmarks import kind_of, landmark_title
from core.analysis.inverse_design.lower_quantities import followed_marks
from core.analysis.inverse_design.profile_curve import ProfileCurve
from core.analysis.inverse_design.quantities import LOWER_TARGETS, reading
from core.document.design import Design
from core.geometry.mesh import Floats
from core.landmarks.types import LOWER_NAMES, SIDES
from core.pipeline.frame import Frame

if TYPE_CHECKING:
    from app.gui.context import AppContext
    from app.gui.features.target_shape.controller import TargetShapeController

KINDS = {"bust": ("lift", "out"), "apex": ("apex lift", "apex out")}
"""What the handles of the bust wish for, up and out, by what they are dragged at."""

_LOWER = {
    "belly": ("", "belly out"),
    "buttock": ("buttock lift", "buttock out"),
    "gluteal_fold": ("fold lift", ""),
}
"""The same by landmark of the lower trunk; where a name is missing the handle does not go that way."""

_LOWER_MARKS = tuple(name for name in LOWER_NAMES if kind_of(name) in _LOWER)
_BEHIND = ("buttock", "gluteal_fold")

_ASIDE = 0.25  # of the way of a hand: less to the side of it is not meant [1]
_STILL = 0.05  # no way at all; Shift drags in small steps [mm]
_NAMES = {"bust_left": lambda: tr("Left handle"), "bust_right": lambda: tr("Right handle")}
_FARTHEST = 80.0  # a place is not dragged further from where it is at rest [mm]


class TargetHandles(QObject):
    """One handle a side in the main view; linked they wish for the mean of both, else for each side.

    ``kind`` is what those of the bust are dragged at: "bust" points, "apex", the foremost places, or
    "profile": then there are those of the drawn profiles instead. Those of belly and seat are there whenever
    a line of the lower trunk is worn. ``by_name`` are keyed by landmark, those of the bust by "bust_left" and
    "bust_right".
    """

    carrying_changed = Signal()

    def __init__(self, context: AppContext, controller: TargetShapeController) -> None:
        super().__init__(controller)
        self._context, self._controller = context, controller
        self.kind = "bust"
        self.by_name: dict[str, TargetHandle] = {}
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
        for handle in self.by_name.values():
            handle.put_away()
        self.profile.put_away()

    def follow(self) -> None:
        """Place the handles at the targets on the shown body."""
        frame, view, ground = self._context.session.frame, self._context.view, self._controller.ground
        if (
            frame is None
            or not self._controller.is_open
            or not view.after
            or not ground.asks
            or ground.design is None
        ):
            self.put_away()
            return
        if self.kind == "profile":
            if not self.carries:
                self._controller.drawing.follow(frame)
            self.profile.follow(frame, self._controller.drawn)
        else:
            self.profile.put_away()
        feet = {} if self.kind == "profile" else self._feet(frame, ground.design)
        for name in self.by_name.keys() - feet.keys():
            self.by_name[name].put_away()
        for name, foot in feet.items():
            handle = self.by_name.get(name) or self._make(name)
            handle.show_at(foot + self._missing(frame, name), foot)

    def _feet(self, frame: Frame, design: Design) -> dict[str, Floats]:
        """Return where what is dragged is on the shown body, (3,) [mm] each, by name of its handle."""
        feet: dict[str, Floats] = {}
        bust, *below = design.regions
        if bust.lines:
            watch = frame.stages.watch
            places = watch.apex_places if self.kind == "apex" else watch.bust_points
            names = (f"bust_{side}" for side in SIDES)
            feet |= zip(names, places(frame.control_points), strict=True)
        if frame.lower is not None and frame.stages.lower is not None and any(each.lines for each in below):
            few = followed_marks(frame.stages.lower, _LOWER_MARKS)
            feet |= zip(_LOWER_MARKS, few.places(frame.lower.control_points), strict=True)
        return feet

    def _ways(self, name: str) -> tuple[str, str]:
        """Return the targets that a handle sets, up and out, without side."""
        return _LOWER.get(kind_of(name)) or KINDS[self.kind]

    def _make(self, name: str) -> TargetHandle:
        up, out = self._ways(name)
        title = _NAMES[name]() if name in _NAMES else tr("Handle: {place}").format(place=landmark_title(name))
        behind = kind_of(name) in _BEHIND
        ways = bool(up), bool(out)
        handle = TargetHandle(self._context.view.viewport, _side(name), title, behind=behind, ways=ways)
        handle.taken.connect(partial(self._take, name))
        handle.dragged.connect(partial(self._pull, name))
        handle.dropped.connect(self._drop)
        self.by_name[name] = handle
        return handle

    def _missing(self, frame: Frame, name: str) -> Floats:
        """Return the way from where a handle's place is to where it is wished, (3,) [mm]."""
        wishes = self._controller.wishes
        up, out = (
            next(
                (
                    value - _now(frame, each)
                    for each in (f"{what} {_side(name)}", what)
                    if (value := wishes.get(each)) is not None
                ),
                0.0,
            )
            for what in self._ways(name)
        )
        return np.array([0.0, out if kind_of(name) in _BEHIND else -out, up])

    def _take(self, name: str) -> None:
        """Take hold of a handle; where its only way points at the eye it is looked at from the side first."""
        if not self.by_name[name].can_be_dragged:
            self._open_hands()
            side = _side(name) or self._controller.drawing.side
            self._controller.back.look(self._context.view.viewport.view.named(side))
        else:
            self._hold(self._ways(name))

    def _hold(self, ways: tuple[str, ...]) -> None:
        if self._before is None:
            self._before = dict(self._controller.wishes), dict(self._controller.drawn)
            self._pulled = dict.fromkeys(ways, 0.0)
            self.carrying_changed.emit()

    def _take_profile(self, section: str) -> None:
        """Take the curve of a section; from elsewhere than its side a hand cannot tell out from across."""
        drawing = self._controller.drawing
        if drawing.is_from_side(section):
            self._hold(())
        else:
            self._open_hands()
            drawing.look_at(self._controller.drawn[section])

    def _open_hands(self) -> None:
        for handle in (*self.by_name.values(), *self.profile.all()):
            handle.open_hand()

    def _draw(self, section: str, handle: int, up: float, out: float) -> None:
        """Continue with the curve of a section by a step of the hand at one of its handles [mm]."""
        if self._before is not None:
            self._controller.drawing.draw(
                section, self._controller.drawn[section].with_moved_handle(handle, up, out)
            )
            self._controller.wish_by_hand(dict(self._controller.wishes), at_rest=False)

    def _pull(self, handle: str, up: float, out: float) -> None:
        """Continue with the wishes by a step of the hand [mm]."""
        frame = self._context.session.frame
        if frame is None or self._before is None:
            return
        wishes, side = dict(self._controller.wishes), _side(handle)
        linked = not side or self._controller.card.link.isChecked()
        for what, step in zip(self._ways(handle), (up, out), strict=True):
            if not what:
                continue
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
    """Return what a figure that handles set is on the shown body [mm]."""
    if name in LOWER_TARGETS:
        return reading(frame.stages, name)(frame.all_points).value
    upward, side = "lift" in name, next((each for each in SIDES if name.endswith(each)), "")
    if name.startswith("apex "):
        places = (frame.control_points, frame.stages.control.mesh.vertices)
        after, before = (frame.stages.watch.apexes(points) for points in places)
        steps = (after - before)[:, 1] if upward else (before - after)[:, 0]
        return float(steps[SIDES.index(side)] if side else steps.mean())
    move = bust_shift(frame)
    step = {"": move.mean, "left": move.left, "right": move.right}[side]
    return step.up if upward else step.forward


def _side(handle: str) -> str:
    """Return the side of a handle by its name; nothing for one in the middle."""
    return next((side for side in SIDES if handle.endswith(f"_{side}")), "")
