"""Values of converged frames: computed in background jobs, once each, and kept."""

from __future__ import annotations

from collections.abc import Callable, MutableMapping
from typing import Generic, TypeVar, cast
from weakref import WeakKeyDictionary

from PySide6.QtCore import QObject, QTimer, Signal

from app.gui.session.jobs import Job, Jobs
from app.gui.session.session import Session
from core.document.design import Design
from core.pipeline.live_solver import Frame
from core.progress import Progress

T = TypeVar("T")

KEPT = 12
"""Designs whose values are kept, so that undone steps and other variants show theirs at once."""


def _ignore() -> None:
    """Do nothing about work that the user stopped."""


class FrameCache(QObject, Generic[T]):
    """Compute ``compute(frame, progress)`` of frames that have converged, and keep the values.

    A value belongs to its frame, and goes with it. With ``by_design`` it belongs to the design, whatever
    frame shows that: the last ``KEPT`` designs keep theirs, and an edit cancels the job of the former one.
    The job begins ``pause`` ms after the last request. What has failed or was stopped by the user is given
    up: ``failed`` and ``stopped`` are told, and it is not computed again before ``retry``.
    ``changed`` is emitted when a value has come, or will not.
    """

    changed = Signal()

    def __init__(
        self,
        session: Session,
        jobs: Jobs,
        title: str,
        compute: Callable[[Frame, Progress], T],
        *,
        failed: Callable[[Exception], object],
        stopped: Callable[[], object] = _ignore,
        by_design: bool = False,
        pause: int = 0,
    ) -> None:
        super().__init__(session)
        self._session, self._jobs = session, jobs
        self._title, self._compute = title, compute
        self._failed, self._stopped = failed, stopped
        self._by_design = by_design
        self._values: MutableMapping[Frame | Design, T] = {} if by_design else WeakKeyDictionary()
        self._given_up: MutableMapping[Frame | Design, Exception | None] = (
            {} if by_design else WeakKeyDictionary()
        )
        self._running: dict[Frame | Design, Job] = {}
        self._waiting: Frame | None = None
        self._clock = QTimer(self, interval=pause, singleShot=True)
        self._clock.timeout.connect(self._begin_waiting)
        if by_design:
            session.design_changed.connect(self._cancel_others)

    # -- what is known

    def get(self, frame: Frame) -> T | None:
        """Return the value of a frame, or None as long as it is not known."""
        return self._values.get(self._key(frame))

    def is_running(self, frame: Frame) -> bool:
        """Return whether the value of a frame is being computed."""
        return self._key(frame) in self._running

    def is_given_up(self, frame: Frame) -> bool:
        """Return whether the value of a frame has failed, or was stopped."""
        return self._key(frame) in self._given_up

    def failure(self, frame: Frame) -> Exception | None:
        """Return why the value of a frame has failed; None if it has not, or was stopped."""
        return self._given_up.get(self._key(frame))

    # -- what is asked

    def request(self, frame: Frame) -> T | None:
        """Return the value of a frame; if it is not known it is computed, unless the body still moves."""
        known = self.get(frame)
        if known is None and self._may_begin(frame):
            if self._clock.interval():
                self._waiting = frame
                self._clock.start()
            else:
                self._begin(frame)
        return known

    def hold(self) -> None:
        """Start with nothing requested."""
        self._waiting = None
        self._clock.stop()

    def retry(self) -> None:
        """Forget what the user stopped: it is computed when it is requested again."""
        stopped = [key for key, error in self._given_up.items() if error is None]
        for key in stopped:
            del self._given_up[key]
        if stopped:
            self.changed.emit()

    def clear(self) -> None:
        """Forget all, and cancel what is being computed."""
        self.hold()
        for job in self._running.values():
            self._jobs.cancel(job)
        for each in (self._running, self._values, self._given_up):
            each.clear()

    # -- inside

    def _key(self, frame: Frame) -> Frame | Design:
        return frame.stages.design if self._by_design else frame

    def _may_begin(self, frame: Frame) -> bool:
        key = self._key(frame)
        moves = frame is self._session.frame and not self._session.is_at_rest
        return not (frame.is_running or moves or key in self._running or key in self._given_up)

    def _begin_waiting(self) -> None:
        frame, self._waiting = self._waiting, None
        if frame is not None and frame is self._session.frame and self._may_begin(frame):
            self._begin(frame)

    def _begin(self, frame: Frame) -> None:
        key = self._key(frame)
        self._running[key] = self._jobs.run(
            self._title,
            lambda progress: self._compute(frame, progress),
            lambda value: self._take(key, cast(T, value)),
            lambda error: self._give_up(key, error),
            left=lambda: self._give_up(key, None),
        )

    def _take(self, key: Frame | Design, value: T) -> None:
        self._running.pop(key, None)
        self._values[key] = value
        while self._by_design and len(self._values) > KEPT:
            del self._values[next(iter(self._values))]
        self.changed.emit()

    def _give_up(self, key: Frame | Design, error: Exception | None) -> None:
        self._running.pop(key, None)
        self._given_up[key] = error
        if error is None:
            self._stopped()
        else:
            self._failed(error)
        self.changed.emit()

    def _cancel_others(self, design: Design) -> None:
        self.hold()
        for key in [key for key in self._running if key is not design]:
            self._jobs.cancel(self._running.pop(key))
