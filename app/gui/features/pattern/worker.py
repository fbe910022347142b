"""Pieces of the shown body, made beside the window: the newest shape counts, what has not changed stays."""

from __future__ import annotations

import operator
import threading
from dataclasses import dataclass
from functools import partial

from PySide6.QtCore import QObject, Signal

from app.gui.session.jobs import Job, Jobs
from app.i18n.catalog import tr
from core.document.garment_pattern import GarmentPattern
from core.pattern.cloth_library import cloths_of
from core.pattern.garment import CutGarment, Pattern, cut_garment, worn_skin
from core.pattern.places import BodyPlaces
from core.pattern.recut import recut
from core.pattern.seam_curves import SeamDrawing
from core.pattern.seam_matching import Matched
from core.pipeline.frame import Frame
from core.progress import Progress


@dataclass(frozen=True, eq=False)
class PatternRequest:
    """Pieces wanted of a ``frame`` by a ``plan``; those that are not ``final`` start near the last ones."""

    frame: Frame
    plan: GarmentPattern
    final: bool


@dataclass(frozen=True, eq=False)
class PatternResult:
    """The ``pattern`` of a request, and the ``drawing`` that its seams were drawn with."""

    request: PatternRequest
    pattern: Pattern
    drawing: SeamDrawing


class PatternWorker(QObject):
    """Makes one pattern at a time. ``made`` carries a PatternResult, ``refused`` a request and why not."""

    made = Signal(object)
    refused = Signal(object, object)

    def __init__(self, jobs: Jobs, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._jobs = jobs
        self._job: Job | None = None
        self._at: PatternRequest | None = None
        self._wanted: PatternRequest | None = None
        self._drawing: SeamDrawing | None = None
        self._parts: tuple[object, ...] = ()  # that it draws by
        self._garment: CutGarment | None = None
        self._matched: Matched | None = None
        self._is_recut = False  # of a garment of which only some panels were cut again
        self._turn = threading.Lock()  # a job that was cancelled ends only when its pattern is made

    @property
    def at_work(self) -> bool:
        """Return whether the newest pattern is not made yet."""
        return self._wanted is not None

    def ask(self, request: PatternRequest) -> None:
        """Make this pattern next."""
        self._wanted = request
        if self._at is None:
            self._begin()

    def stop(self) -> None:
        """Drop what is wanted, and what was kept for the next pattern."""
        self._jobs.cancel(self._job)
        self._job = self._at = self._wanted = None
        self._drawing = self._garment = self._matched = None

    def _begin(self) -> None:
        self._at = request = self._wanted
        if request is not None:
            end = partial(self._end, request)
            self._job = self._jobs.run(
                tr("Computing pattern pieces…"), partial(self._make, request), end, end
            )

    def _end(self, request: PatternRequest, outcome: object) -> None:
        self._at = None
        if request is self._wanted:
            self._wanted = None
        if isinstance(outcome, Exception):
            self.refused.emit(request, outcome)
        else:
            self.made.emit(outcome)
        if self._wanted is not None and self._at is None:
            self._begin()

    def _make(self, request: PatternRequest, progress: Progress) -> PatternResult:
        """Make a pattern, in a thread of its own."""
        with self._turn:
            drawing = self._drawing_of(request.frame)
            garment = self._garment_of(drawing, request)
            cloths = cloths_of(request.plan)
            former = None if request.final else self._matched
            pattern = garment.flat(worn_skin(request.frame.stages, request.frame.vertices), cloths, former)
            self._matched = pattern.matched
            return PatternResult(request, pattern, drawing)

    def _drawing_of(self, frame: Frame) -> SeamDrawing:
        """Return what draws on the body at rest of a frame; it is kept while body and marks are the same."""
        stages = frame.stages
        lower = () if stages.lower is None else (stages.lower.landmarks,)
        parts = (stages.body, stages.landmarks, *(each.fitted for each in stages.regions), *lower)
        same = len(parts) == len(self._parts) and all(map(operator.is_, parts, self._parts))
        if self._drawing is None or not same:
            self._drawing, self._parts = SeamDrawing(BodyPlaces.of(stages)), parts
            self._garment = self._matched = None
        return self._drawing

    def _garment_of(self, drawing: SeamDrawing, request: PatternRequest) -> CutGarment:
        """Return the cut garment; one that is not final may be cut again only where its block has changed."""
        plan, known = request.plan, self._garment
        if known is None or known.is_bridged != plan.bridged:
            made = cut_garment(drawing, plan.block, plan.bridged)
        elif known.block == plan.block and not (request.final and self._is_recut):
            return known
        elif request.final:
            made = cut_garment(drawing, plan.block, plan.bridged)
        else:
            made = recut(known, drawing, plan.block)
        self._is_recut = not request.final and known is not None
        self._garment, self._matched = made, None
        return made
