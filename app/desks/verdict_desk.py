"""The desk of the verdict: what the steps at the left say of a run."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from app.presenting.verdict import state_of
from app.showing.verdict_chip import TONES, TROUBLED
from core.live import Frame

if TYPE_CHECKING:
    from app.main_window import MainWindow


class VerdictDesk(QObject):
    """Says how the shown run stands where the strip does not."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window

    def show_frame(self, frame: Frame) -> None:
        """Show how a frame stands."""
        rail, session = self._window.rail, self._window.session
        state = state_of(frame) if session.failure is None else "stale"
        if state in TROUBLED:
            looks = "bad" if TONES[state][0] == "bad" else "look"  # one colour with the word below the body
            rail.set_state("lines", looks, 1)
            rail.set_state("result", looks)
        else:
            for step in ("lines", "result"):
                rail.set_state(step, "done" if state == "settled" else "available")
