"""The solver as the window's thread sees it: a clock fetches its answers and hands them out as signals."""

from __future__ import annotations

from PySide6.QtCore import QObject, QTimer, Signal

from core.document.design import Design
from core.pipeline.build import IncompleteBuildError, Stages
from core.pipeline.live_solver import Failure, LiveSolver
from core.progress import Progress

FRAME_INTERVAL = 16
"""Milliseconds between two looks at the solver, which also says itself when there is something to see."""


class SolverBridge(QObject):
    """Holds the LiveSolver. ``answered`` carries a Frame, ``refused`` a Failure; ``working`` the work in hand
    and the share done.
    """

    answered = Signal(object)
    refused = Signal(object)
    working = Signal(str, float)
    _ready = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._work = self._work_told = ("", 1.0)
        # What the hand has done meanwhile goes first.
        self._soon = QTimer(self, interval=0, singleShot=True)
        self._soon.timeout.connect(self._look)
        self._ready.connect(self._soon.start)
        # Paint first: it comes before what is due at once.
        self._shown = QTimer(self, interval=0, singleShot=True)
        self._solver = LiveSolver(self._hear, self._ready.emit, _prepare)
        self._shown.timeout.connect(self._solver.resume)
        self._clock = QTimer(self, interval=FRAME_INTERVAL)
        self._clock.timeout.connect(self._look)
        self._clock.start()

    @property
    def at_work(self) -> bool:
        """Return whether a body is being read or built."""
        return bool(self._work[0])

    def submit(self, design: Design, fresh: bool = False) -> int:
        """Request a design and return the revision of the request; ``fresh`` begins new records."""
        return self._solver.submit(design, fresh)

    def cancel(self) -> None:
        """Drop all that was asked and is not built yet."""
        self._solver.cancel()
        self._work = ("", 1.0)

    def set_pace(self, turns_per_second: float | None) -> None:
        """Make turns no faster than this, or as fast as they go."""
        self._solver.set_pace(turns_per_second)

    def close(self) -> None:
        """Stop the clock and the solver, and wait until it has ended."""
        self._clock.stop()
        self._soon.stop()
        self._shown.stop()
        self._solver.stop()

    def _hear(self, what: str, share: float) -> None:
        # Called in the solver's thread: only the attribute is set, the clock tells the window.
        self._work = what, share

    def _look(self) -> None:
        if self._work != self._work_told:
            self._work_told = self._work
            self.working.emit(*self._work_told)
        answer = self._solver.poll(hold=True)
        if isinstance(answer, Failure):
            self.refused.emit(answer)
        elif answer is not None:
            self._shown.start()
            self.answered.emit(answer)


def _prepare(built: Stages | IncompleteBuildError, progress: Progress) -> None:
    # The first to come imports the 3D libraries: the window needs them too, and may be at it already.
    from app.rendering.prepare import prepare_scene  # noqa: PLC0415

    prepare_scene(built, progress)
