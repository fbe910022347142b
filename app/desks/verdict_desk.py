"""The desk of the verdict: what the steps say of a run, and a notice with a way out where it never rests."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from app.presenting.verdict import state_of, swing_sentence
from app.wording.words import tr
from core.live import Frame

if TYPE_CHECKING:
    from app.main_window import MainWindow

_SWING = "swing"
_LOOK = ("strained", "overstrained", "folded", "vibrating", "diverging")


class VerdictDesk(QObject):
    """Says how the shown run stands where the strip does not; a swing is told once its run is over."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._told = ""

    def show_frame(self, frame: Frame) -> None:
        """Show how a frame stands."""
        state, rail = state_of(frame), self._window.rail
        if state in _LOOK:
            rail.set_state("lines", "look", 1)
            rail.set_state("result", "look")
        else:
            for step in ("lines", "result"):
                rail.set_state(step, "done" if state == "settled" else "available")
        self._tell(frame)

    def _tell(self, frame: Frame) -> None:
        """Offer the way out of a swing, and take that back as soon as it is over."""
        said = "" if frame.at_work else swing_sentence(frame)
        if said == self._told:
            return
        self._window.notices.withdraw(_SWING)
        self._told = said
        if not said:
            return
        control, title = ("adaptive", tr("Use Adaptive"))
        if frame.stages.design.volume == control:
            control, title = ("exact", tr("Use Exact"))
        hint = tr("No garment does that: what is seen here is no result.")
        choose = (title, lambda: self._window.session.choose_control(control))
        self._window.notices.show_notice("warn", said, hint, [choose], lasting=True, about=_SWING)
