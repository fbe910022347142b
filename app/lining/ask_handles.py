"""The handles at the bust points: what is wished for by hand while the result is asked for."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QObject

from app.presenting.bust import bust_move
from app.showing.bust_handle import BustHandle
from core.frame import Frame
from core.mesh import Floats

if TYPE_CHECKING:
    from app.lining.ask_desk import AskDesk
    from app.main_window import MainWindow

SIDES = ("left", "right")
_CLEAR = 12  # between the card and a handle [px]
_ASIDE = 0.25  # of the way of a hand: less to the side of it is not meant [1]
_STILL = 0.05  # no way at all; Shift drags in small steps [mm]
_FARTHEST = 80.0  # a bust point is not dragged further from where it is at rest [mm]


class AskHandles(QObject):
    """One handle a side in the main view; linked they wish for the mean of both, else for each side."""

    def __init__(self, window: MainWindow, desk: AskDesk) -> None:
        super().__init__(desk)
        self._window, self._desk = window, desk
        self.by_side: dict[str, BustHandle] = {}
        self._before: dict[str, float | None] | None = None
        self._height = 0  # of the card, when the picture was moved for it
        self._pulled: dict[str, float] = {}  # how far the hand has gone each way since it closed [mm]

    @property
    def carries(self) -> bool:
        """Whether a hand has hold of one."""
        return self._before is not None

    def let_go(self) -> bool:
        """Bring the wishes back to what they were before a hand took hold; returns whether one had."""
        before, self._before = self._before, None
        if before is None:
            return False
        for handle in self.by_side.values():
            handle.open_hand()
        self._desk.wish_by_hand(before, at_rest=True)
        self._window.job_desk.show()
        return True

    def put_away(self) -> None:
        """Show them no longer."""
        self._before, self._height = None, 0
        for handle in self.by_side.values():
            handle.put_away()

    def follow(self) -> None:
        """Stand where the bust points are wished on the shown body."""
        frame, view = self._window.session.frame, self._window.view
        if frame is None or not self._desk.is_open or not view.after or not self._desk.asks:
            if self.by_side:
                self.put_away()
            return
        if not self.by_side:
            self._make()
        for row, side in enumerate(SIDES):
            foot = frame.stages.watch.bust_points(frame.control_points)[row]
            self.by_side[side].show_at(foot + self._missing(frame, side), foot)

    def clear(self) -> None:
        """Move the picture up if the card has grown over handles: they could not be taken."""
        viewport, card = self._window.view.viewport, self._desk.card
        seen = [handle for handle in self.by_side.values() if handle.isVisible()]
        if not seen or self.carries or card.height() <= self._height:
            return
        self._height = card.height()
        top = self._window.view.floating.seen(card).top()
        low = max(handle.mapTo(self._window.view, handle.rect().bottomLeft()).y() for handle in seen)
        if low > top - _CLEAR:
            viewport.glide_to(viewport.view.pan(0.0, float(top - _CLEAR - low), viewport.height()))

    def _make(self) -> None:
        for side in SIDES:
            handle = BustHandle(self._window.view.viewport, side)
            handle.taken.connect(self._take)
            handle.pulled.connect(partial(self._pull, side))
            handle.dropped.connect(self._drop)
            self.by_side[side] = handle

    def _missing(self, frame: Frame, side: str) -> Floats:
        """Return the way from the bust point of a side to where it is wished, (3,) [mm]."""
        wishes = self._desk.wishes
        up, out = (
            next(
                (
                    value - _now(frame, name)
                    for name in (f"{what} {side}", what)
                    if (value := wishes.get(name)) is not None
                ),
                0.0,
            )
            for what in ("lift", "out")
        )
        return np.array([0.0, -out, up])

    def _take(self) -> None:
        if self._before is None:
            self._before, self._pulled = dict(self._desk.wishes), {"lift": 0.0, "out": 0.0}
            self._window.job_desk.show()

    def _pull(self, side: str, up: float, out: float) -> None:
        """Go on with the wishes by a step of the hand [mm]."""
        frame = self._window.session.frame
        if frame is None or self._before is None:
            return
        wishes, linked = dict(self._desk.wishes), self._desk.card.link.isChecked()
        for what, step in (("lift", up), ("out", out)):
            name = what if linked else f"{what} {side}"
            self._pulled[what] += step
            if wishes.get(name) is not None or self._is_meant(what):
                value = wishes.get(name)
                value = _now(frame, name) + self._pulled[what] if value is None else value + step
                for other in (what, *(f"{what} {each}" for each in SIDES)):
                    if other != name and (linked or other == what):
                        wishes.pop(other, None)
                wishes[name] = float(np.clip(value, -_FARTHEST, _FARTHEST))
        self._desk.wish_by_hand(wishes, at_rest=False)

    def _is_meant(self, what: str) -> bool:
        """Tell whether the hand goes that way on purpose: a way that was free stays so if it does not."""
        way = abs(self._pulled[what])
        return way > _ASIDE * max(map(abs, self._pulled.values())) and way > _STILL

    def _drop(self) -> None:
        if self._before is not None:
            self._before = None
            self._desk.wish_by_hand(dict(self._desk.wishes), at_rest=True)
            self._window.job_desk.show()


def _now(frame: Frame, name: str) -> float:
    """Return what a figure of the bust points is on the shown body [mm]."""
    what, _, side = name.partition(" ")
    move = bust_move(frame)
    step = {"": move.mean, "left": move.left, "right": move.right}[side]
    return step.up if what == "lift" else step.forward
