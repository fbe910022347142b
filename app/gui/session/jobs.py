"""Jobs: named work, in threads or in small pieces, that tells how far it is and is let go of at once."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable
from typing import Any

from PySide6.QtCore import QObject, QTimer, Signal

from core.errors import as_exception
from core.progress import Cancelled, Pieces, Progress

LOOKS = 100
"""Milliseconds between two looks at how far the jobs are."""


def _log(error: Exception) -> None:
    logging.error("a job failed", exc_info=error)


def _forget() -> None:
    """Nobody has to hear that a job was left."""


class Job:
    """One piece of work: its ``words`` for the user, the ``share`` done (0..1, None while nobody knows).

    ``waited`` tells that the user waits for it; ``wanted`` that nobody has cancelled it.
    """

    def __init__(
        self,
        words: str,
        waited: bool,
        done: Callable[[object], None],
        failed: Callable[[Exception], None],
        left: Callable[[], None],
    ) -> None:
        self.words, self.waited = words, waited
        self.done, self.failed, self.left = done, failed, left
        self.share: float | None = None
        self.wanted = True
        self.began = time.monotonic()

    def hear(self, what: str, share: float) -> None:
        """Report the progress of the work, in its thread; raises Cancelled once it is cancelled."""
        if not self.wanted:
            raise Cancelled
        self.share = share


class Jobs(QObject):
    """Runs plain functions in threads; what follows happens in the window's thread, and so do pieces of work.

    ``changed`` says that jobs came, went or got further.
    """

    changed = Signal()
    _ended = Signal(object, object, object)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._threads: dict[Job, threading.Thread] = {}
        self._open = True
        self._clock = QTimer(self, interval=LOOKS)
        self._clock.timeout.connect(self.changed)
        self._ended.connect(self._end)
        self._pieces: dict[Job, Pieces[Any]] = {}
        self._between = QTimer(self, interval=0)
        self._between.timeout.connect(self._go_on)

    def run(
        self,
        words: str,
        work: Callable[[Progress], object],
        done: Callable[[object], None],
        failed: Callable[[Exception], None] = _log,
        *,
        waited: bool = False,
        left: Callable[[], None] = _forget,
    ) -> Job:
        """Start ``work``; then ``done`` takes its result, or ``failed`` what it raised: by default the log.

        Neither is called once the job is cancelled. ``waited``: the user asked for it and waits. ``left``
        hears that the user has let go of it, see ``leave``.
        """
        job = Job(words, waited, done, failed, left)
        job.wanted = self._open  # a thread that nobody waits for would tell its end to what is no more
        if not job.wanted:
            return job
        thread = threading.Thread(target=self._work, args=(job, work), name="busk-job", daemon=True)
        try:
            thread.start()
        except RuntimeError as error:  # memory for a thread is missing
            failed(error)
            return job
        self._threads[job] = thread
        self._clock.start()
        self.changed.emit()
        return job

    def run_pieces(
        self,
        words: str,
        pieces: Pieces[Any],
        done: Callable[[Any], None],
        failed: Callable[[Exception], None] = _log,
        *,
        waited: bool = False,
        left: Callable[[], None] = _forget,
    ) -> Job:
        """Start work of the window's thread: a small piece of it whenever events are done.

        Several such jobs take turns. All else is as in ``run``. What it holds is given back as soon as it
        ends or is cancelled.
        """
        job = Job(words, waited, done, failed, left)
        job.wanted = self._open
        if not job.wanted:
            pieces.close()
            return job
        self._pieces[job] = pieces
        self._between.start()
        self._clock.start()
        self.changed.emit()
        return job

    def at_work(self) -> list[Job]:
        """Return the jobs that are wanted, those first that the user waits for."""
        jobs = (job for job in (*self._threads, *self._pieces) if job.wanted)
        return sorted(jobs, key=lambda job: not job.waited)

    def cancel(self, job: Job | None) -> None:
        """Release a job at once; its thread ends when it next tells how far it is."""
        if job is not None:
            job.wanted = False
            if job in self._pieces:
                self._pieces.pop(job).close()
            self.changed.emit()

    def leave(self, job: Job | None) -> None:
        """Release a job because the user says so, and tell who began it."""
        if job is not None:
            self.cancel(job)
            job.left()

    def close(self) -> None:
        """Release all jobs, and wait until their threads have ended; none begins after that."""
        self._open = False
        self._clock.stop()
        self._between.stop()
        for pieces in self._pieces.values():
            pieces.close()
        self._pieces.clear()
        for job in self._threads:
            job.wanted = False
        for thread in self._threads.values():
            thread.join()

    def _work(self, job: Job, work: Callable[[Progress], object]) -> None:
        result, fault = None, None
        try:
            result = work(job.hear)
        except Cancelled:
            job.wanted = False
        except BaseException as error:  # of a thread that ends in silence nobody would know
            fault = as_exception(error)
        self._ended.emit(job, result, fault)

    def _end(self, job: Job, result: object, fault: Exception | None) -> None:
        del self._threads[job]
        self._answer(job, result, fault)

    def _go_on(self) -> None:
        """Do the next piece of the job that has waited longest."""
        job, pieces = next(iter(self._pieces.items()), (None, None))
        if job is None or pieces is None:
            self._between.stop()
            return
        result, fault = None, None
        try:
            job.share = next(pieces)
            self._pieces[job] = self._pieces.pop(job)  # the others come first now
            return
        except StopIteration as ended:
            result = ended.value
        except Exception as error:
            fault = error
        del self._pieces[job]
        self._answer(job, result, fault)

    def _answer(self, job: Job, result: object, fault: Exception | None) -> None:
        if not (self._threads or self._pieces):
            self._clock.stop()
        try:
            if job.wanted and fault is None:
                job.done(result)
            elif job.wanted and fault is not None:
                job.failed(fault)
        finally:
            self.changed.emit()
