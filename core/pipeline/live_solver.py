"""LiveSolver: one thread that turns the newest design into the newest frame, and never loses a record.

Requests collapse to the newest; answers carry the revision that they belong to, so a window can drop stale
ones. If only lengths changed, the runs go on from where they are (warm start).
"""

from __future__ import annotations

import threading
import time
import traceback
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass

from core.blas_threads import one_blas_thread
from core.document.design import Design
from core.errors import UserError, as_exception
from core.geometry import kernels
from core.pipeline.build import IncompleteBuildError, Stages, build
from core.pipeline.frame import Failure, Frame, make_frame
from core.pipeline.region_solvers import RegionSolvers
from core.pipeline.solve import NoEquilibriumError
from core.progress import Cancelled, Progress, quiet

__all__ = ["Failure", "Frame", "LiveSolver"]

_SLICE, _FIRST_SLICE, _LONG_SLICE = 0.012, 0.004, 0.05
"""Seconds of turns between two frames, about one picture of a screen; fewer before new lengths are seen, more
while the last frame has not been fetched.
"""

_HAND_RESTS = 0.2
"""Seconds after the last request for which it waits until the last frame is fetched and shown.

Turns always wait while who shows a frame holds them.
"""

_NEXT_MOVE = 0.016
"""Seconds after a picture for which turns wait while lengths move: the hand is about to ask for others."""

LARGE = 10_000
"""Moving vertices from which on compiled loops gain more in use than the second costs that they load in."""

_NAP = 0.0005
"""A pause per frame in which the window's thread surely gets the interpreter."""


@dataclass(frozen=True)
class _Request:
    revision: int
    design: Design
    fresh: bool


class LiveSolver:
    """Solves the newest design in a thread of its own.

    While lengths move it waits until its last frame is fetched and shown, and only then takes the newest:
    what it made meanwhile would be old, and would take its time from the picture. ``tell`` is called in that
    thread with the work in hand and the share done, or "" when it is done; ``ready`` when there is something
    to fetch. What is built for a body is handed to ``prepare`` there, before its first frame.
    """

    def __init__(
        self,
        tell: Progress = quiet,
        ready: Callable[[], None] = lambda: None,
        prepare: Callable[[Stages | IncompleteBuildError, Progress], object] = lambda built, progress: None,
    ) -> None:
        self._tell, self._ready, self._prepare = tell, ready, prepare
        self._at_work = 0
        self._unwanted = 0
        self._wake = threading.Condition()
        self._request: _Request | None = None
        self._frame: Frame | None = None
        self._asked_at = self._shown_at = 0.0
        self._failure: Failure | None = None
        self._revision = self._asked = self._taken = 0
        self._stopping = False
        self._stages: Stages | None = None
        self._stuck: IncompleteBuildError | None = None
        self._solvers: RegionSolvers | None = None
        self._seconds = 0.0
        self._held = False
        self._pace: float | None = None
        self._turned_at = 0.0
        self._warmer: threading.Thread | None = None
        self._thread = threading.Thread(target=self._work, name="busk-solver", daemon=True)
        self._thread.start()

    def submit(self, design: Design, fresh: bool = False) -> int:
        """Request a design, replacing earlier requests, and return the revision of the request.

        ``fresh`` begins new records.
        """
        with self._wake:
            self._revision += 1
            # A request that nobody has looked at yet must not lose its wish for new records.
            fresh = fresh or (self._request is not None and self._request.fresh)
            self._request = _Request(self._revision, design, fresh)
            self._asked_at = time.perf_counter()
            self._wake.notify()
            return self._revision

    def cancel(self) -> None:
        """Drop all that was asked and is not built yet; the last good frame still stands."""
        with self._wake:
            self._request = self._failure = None
            self._unwanted = self._revision

    def poll(self, hold: bool = False) -> Frame | Failure | None:
        """Return what has not been fetched yet, if anything: a failure first, else the newest frame.

        ``hold``: until ``resume`` no turns are made after a frame, as who shows it would only wait for the
        interpreter lock.
        """
        with self._wake:
            if self._failure is not None:
                failure, self._failure = self._failure, None
                return failure
            frame, self._frame = self._frame, None
            self._held = self._held if frame is None else hold
            self._wake.notify()
            return frame

    def _hear(self, what: str, share: float) -> None:
        if self._stopping or self._at_work <= self._unwanted:
            raise Cancelled
        self._tell(what, share)

    def _hear_last(self, what: str, share: float) -> None:
        self._hear(what, 0.98 + 0.02 * share)

    def resume(self) -> None:
        """Continue: the fetched frame is shown."""
        with self._wake:
            self._held, self._shown_at = False, time.perf_counter()
            self._wake.notify()

    def set_pace(self, turns_per_second: float | None) -> None:
        """Make turns no faster than this, one a frame, so that each can be seen; None: as fast as they go."""
        with self._wake:
            self._pace = turns_per_second
            self._wake.notify()

    def stop(self) -> None:
        """Stop the thread and wait for its end."""
        with self._wake:
            self._stopping = True
            self._wake.notify()
        self._thread.join()
        if self._warmer is not None:
            self._warmer.join()

    def _work(self) -> None:
        with one_blas_thread():
            while not self._stopping:
                try:
                    self._serve()
                except Cancelled:
                    pass
                except UserError as error:
                    # It is kept while it is shown, what its callers held is not.
                    self._fail(Failure(self._asked, error.with_traceback(None)))
                except BaseException as error:
                    # A fault, SystemExit included: no iterations before the next request. Arrays of the
                    # callers are released, as memory may be short.
                    self._solvers = None
                    traceback.clear_frames(error.__traceback__)
                    self._fail(Failure(self._asked, as_exception(error)))
                time.sleep(_NAP)

    def _serve(self) -> None:
        """Wait until there is something to do, then build what was requested, iterate, publish a frame."""
        with self._wake:
            while (patience := self._wait_time()) != 0.0:
                self._wake.wait(patience)
            request, self._request = self._request, None
        if request is not None and not self._stopping:
            self._asked = request.revision
            self._take(request)
            self._refuse_what_has_no_balance()
            # Only now: the frames after a failure are still those of the design before it.
            self._taken = self._asked
        unseen = request is None and self._frame is not None
        advanced = self._advance(_FIRST_SLICE if request else _LONG_SLICE if unseen else _SLICE)
        self._refuse_what_has_no_balance()
        if self._stages is None or self._solvers is None or not (request or advanced):
            return
        self._publish(make_frame(self._taken, self._stages, self._solvers, self._seconds))
        self._warm_up(self._stages)

    def _warm_up(self, stages: Stages) -> None:
        """Load the compiled loops once a body is shown that is large enough to gain from them."""
        if self._warmer is None and len(stages.skin.vertices) >= LARGE:
            warmer = threading.Thread(target=kernels.warm, name="busk-warm", daemon=True)
            with suppress(RuntimeError):  # memory for a thread is missing: the loops stay as they are
                warmer.start()
                self._warmer = warmer

    def _wait_time(self) -> float | None:
        """Return in how many seconds there is something to do; None while nobody asks for anything."""
        now = time.perf_counter()
        rests_at = self._asked_at + _HAND_RESTS
        unseen = self._frame is not None
        if self._stopping:
            return 0.0
        if now < rests_at and (unseen or self._held):
            return rests_at - now
        if self._request is not None:
            return 0.0
        if self._solvers is None or self._solvers.is_finished or (unseen and self._pace is not None):
            return None
        return max(min(self._shown_at + _NEXT_MOVE, rests_at) - now, self._pause, 0.0)

    @property
    def _pause(self) -> float:
        """Seconds until the next turn may be made."""
        pace = self._pace
        return self._turned_at + 1.0 / pace - time.perf_counter() if pace else 0.0

    def _take(self, request: _Request) -> None:
        self._at_work, stuck = request.revision, self._stuck
        # The very source: who opens the file once more may have mended it meanwhile.
        again = stuck is not None and stuck.design.scan is request.design.scan
        try:
            stages = build(request.design, stuck if again else self._stages, self._hear)
            if self._stages is None or stages.body is not self._stages.body:
                self._prepare(stages, self._hear_last)
            self._hear("", 1.0)
        except IncompleteBuildError as how_far:
            self._prepare(how_far, self._hear_last)
            # An edit of the scan that is open goes back to what stands.
            if self._stages is None or how_far.body is not self._stages.body:
                self._stuck = how_far
            raise
        finally:
            self._tell("", 1.0)
        old, self._stages, self._stuck = self._stages, stages, None
        if self._solvers is not None and old is not None and not request.fresh:
            before = old.design
            if before != request.design and before.is_equivalent(request.design):
                return  # what is only called or treated otherwise lets the runs go on, or rest
        start = time.perf_counter()
        if self._solvers is None:
            self._solvers = RegionSolvers(stages)
        else:
            self._solvers.retarget(stages, request.fresh)
        self._seconds = time.perf_counter() - start

    def _advance(self, seconds: float) -> bool:
        """Make turns for so many seconds; returns whether there was time for one."""
        solvers, advanced = self._solvers, False
        if solvers is None:
            return False
        end = time.perf_counter() + seconds
        while not solvers.is_finished and (start := time.perf_counter()) < end:
            if self._held and not (self._stopping or self._request):
                time.sleep(_NAP)
                end = max(end, time.perf_counter() + _NAP)
            elif self._held or self._pause > 0.0 or (advanced and self._pace):
                return advanced
            else:
                self._turned_at = start
                solvers.advance()
                advanced = True
                self._seconds += time.perf_counter() - start
        return advanced

    def _refuse_what_has_no_balance(self) -> None:
        """Rather than a body half way to a balance, or torn apart by held lines, the last frame stays."""
        solvers, stages = self._solvers, self._stages
        if solvers is None or stages is None:
            return
        held = stages.design.line_hold == "held"
        for each in solvers.comparisons:
            lost = (held or each.main is None) and not each.exact.is_converged
            if lost or (held and each.main and not each.main.sane):
                self._solvers = None
                raise NoEquilibriumError(stages.design)

    def _publish(self, frame: Frame) -> None:
        with self._wake:
            self._frame = frame
        self._ready()

    def _fail(self, failure: Failure) -> None:
        with self._wake:
            if failure.revision > self._unwanted:
                self._failure = failure
        self._ready()
