"""Computes the pattern pieces of the shown body in the background; only the newest request counts."""

from __future__ import annotations

import threading
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from app.gui.session.jobs import Job, Jobs
from app.i18n.catalog import tr
from core.document.garment_pattern import GarmentPattern
from core.pipeline.frame import Frame
from core.progress import Progress

if TYPE_CHECKING:
    from app.presenters.pattern import PieceRow, SeamRow
    from app.presenters.pattern_layout import PieceShape
    from core.pattern.garment import Pattern
    from core.pattern.live_pattern import LivePattern
    from core.pattern.seam_curves import SeamDrawing


@dataclass(frozen=True, eq=False)
class PatternRequest:
    """A pattern of a ``frame`` by a ``plan``; one that is not ``final`` is for the screen only."""

    frame: Frame
    plan: GarmentPattern
    final: bool


@dataclass(frozen=True, eq=False)
class PatternResult:
    """The ``pattern`` of a request, and the ``drawing`` of its seams on the original body.

    ``pieces`` and ``shapes`` are what is shown of its pieces, ``seams`` what is shown of its seams: None for
    a pattern that is not final.
    """

    request: PatternRequest
    pattern: Pattern
    drawing: SeamDrawing
    pieces: tuple[PieceRow, ...]
    shapes: tuple[PieceShape, ...]
    seams: tuple[SeamRow, ...] | None


class PatternWorker(QObject):
    """Computes one pattern at a time.

    ``computed`` carries a PatternResult, ``failed`` a request and its exception, ``stopped`` is emitted when
    the user cancels the job.
    """

    computed = Signal(object)
    failed = Signal(object, object)
    stopped = Signal()

    def __init__(self, jobs: Jobs, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._jobs = jobs
        self._job: Job | None = None
        self._running: PatternRequest | None = None
        self._newest: PatternRequest | None = None
        self._live: LivePattern | None = None
        self._lock = threading.Lock()  # a cancelled job ends only when its pattern is computed

    @property
    def at_work(self) -> bool:
        """Return whether the newest request is still being computed."""
        return self._newest is not None

    def submit(self, request: PatternRequest) -> None:
        """Compute this request next, in place of any other that has not begun."""
        self._newest = request
        if self._running is None:
            self._begin()

    def cancel(self) -> None:
        """Drop all requests."""
        self._jobs.cancel(self._job)
        self._job = self._running = self._newest = None

    def _begin(self) -> None:
        self._running = request = self._newest
        if request is not None:
            end, work = partial(self._end, request), partial(self._compute, request)
            self._job = self._jobs.run(tr("Computing pattern pieces…"), work, end, end, left=self._stop)

    def _stop(self) -> None:
        self._job = self._running = self._newest = None
        self.stopped.emit()

    def _end(self, request: PatternRequest, outcome: object) -> None:
        self._running = None
        if request is self._newest:
            self._newest = None
        if isinstance(outcome, Exception):
            self.failed.emit(request, outcome)
        else:
            self.computed.emit(outcome)
        if self._newest is not None and self._running is None:
            self._begin()

    def _compute(self, request: PatternRequest, progress: Progress) -> PatternResult:
        """Compute a pattern and the values that the window shows of it, in a thread of its own."""
        from app.presenters.pattern import piece_rows, seam_rows  # noqa: PLC0415 (brings shapely along)
        from app.presenters.pattern_layout import piece_shapes  # noqa: PLC0415
        from core.pattern.live_pattern import LivePattern  # noqa: PLC0415

        with self._lock:
            live = self._live = self._live or LivePattern()
            stages, vertices = request.frame.stages, request.frame.vertices
            pattern = live.pattern(stages, vertices, request.plan, final=request.final)
            assert live.drawing is not None
            seams = seam_rows(pattern) if request.final else None
            return PatternResult(
                request,
                pattern,
                live.drawing,
                piece_rows(pattern),
                piece_shapes(pattern, notches=request.final),
                seams,
            )
