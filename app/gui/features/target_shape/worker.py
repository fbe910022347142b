"""Questions about the result are answered beside the window: the newest counts, stale ones are let go."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from app.gui.session.jobs import Job, Jobs
from app.i18n.catalog import tr
from core.analysis.inverse_design.quantity import Goal
from core.document.design import Design
from core.pipeline.build import Stages, build
from core.progress import Progress

if TYPE_CHECKING:
    from core.analysis.inverse_design.conflicts import Conflict
    from core.analysis.inverse_design.line_selection import LineSelection
    from core.analysis.inverse_design.solve import InverseResult


_LONGEST = 0.999  # ratio: in the window a line at 100 % would be off, and the body another one


@dataclass(frozen=True, eq=False)
class TargetQuery:
    """What is asked of ``design``, which is built from ``stages``: ``goals``, within a limit [kPa].

    ``figures`` are those of which it is told what they are now. One in a hurry is answered near the last.
    ``optional`` lines are off and may be switched on.
    """

    design: Design
    stages: Stages
    goals: tuple[Goal, ...]
    figures: tuple[str, ...]
    most_kpa: float
    hurried: bool = False
    optional: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class TargetAnswer:
    """What is ``now`` [mm], what ``presses`` [kPa], by name, and the ``reply``, if anything was wished.

    ``then`` [mm] is what figures are in the reply, ``conflicts`` those of targets that are not all met,
    ``unlimited`` the reply without a limit of pressure, where that keeps targets from being met.
    """

    question: TargetQuery
    now: Mapping[str, float]
    presses: Mapping[str, float]
    reply: InverseResult | None
    then: Mapping[str, float] = field(default_factory=dict)
    conflicts: tuple[Conflict, ...] = ()
    unlimited: InverseResult | None = None


@dataclass(eq=False)
class _Known:
    """What is kept from question to question about one design."""

    design: Design
    most_kpa: float
    optional: tuple[str, ...]
    asking: LineSelection

    def is_of(self, question: TargetQuery) -> bool:
        """Return whether a question is about the same design, limit and lines."""
        same = self.most_kpa == question.most_kpa and self.optional == question.optional
        return self.design is question.design and same

    now: dict[str, float] = field(default_factory=dict)
    presses: dict[str, float] = field(default_factory=dict)


class TargetWorker(QObject):
    """Answers one question at a time. ``answered`` carries an Answer, ``refused`` why there is none.

    ``nearer`` carries a question and the nearest design so far, while it is looked for elsewhere.
    """

    answered = Signal(object)
    refused = Signal(object)
    nearer = Signal(object, object)

    def __init__(self, jobs: Jobs, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._jobs = jobs
        self._job: Job | None = None
        self._at: TargetQuery | None = None
        self._wanted: TargetQuery | None = None
        self._known: _Known | None = None
        self._turn = threading.Lock()  # one that was let go of ends at its next answer

    @property
    def at_work(self) -> bool:
        """Return whether the newest question is not answered yet."""
        return self._wanted is not None

    def is_at(self, question: TargetQuery) -> bool:
        """Return whether a request is the newest, and being solved."""
        return self._at is question and self._wanted is question

    def ask(self, question: TargetQuery) -> None:
        """Solve this request from now on; a hurried one is not cancelled, as it ends soon."""
        self._wanted = question
        if self._at is not None and not self._at.hurried:
            self._jobs.cancel(self._job)
            self._at = None
        if self._at is None:
            self._begin()

    def stop(self) -> None:
        """Stop solving and drop all results."""
        self._jobs.cancel(self._job)
        self._job = self._at = self._wanted = self._known = None

    def _begin(self) -> None:
        self._at = question = self._wanted
        if question is not None:
            work, done = partial(self._answer, question), partial(self._end, question)
            self._job = self._jobs.run(tr("Computing target shape…"), work, done, done)

    def _end(self, question: TargetQuery, outcome: object) -> None:
        self._at = None
        newest = question is self._wanted
        if newest:
            self._wanted = None
        else:
            self._begin()
        if isinstance(outcome, Exception):
            if newest:
                self.refused.emit(outcome)
        elif newest or question.hurried:
            self.answered.emit(outcome)

    def _answer(self, question: TargetQuery, progress: Progress) -> TargetAnswer:
        """Answer, in a thread of its own."""
        with self._turn:
            known = self._known
            if known is None or not known.is_of(question):
                known = self._known = self._open(question, progress)
            # What is asked for is known as it was too, once there is time.
            asked = () if question.hurried else (goal.name for goal in question.goals)
            missing = [name for name in dict.fromkeys((*question.figures, *asked)) if name not in known.now]
            if missing or not known.now:
                now, known.presses = known.asking.current_values(missing)
                known.now |= now
            known.asking.nearer = partial(self.nearer.emit, question)
            answer = known.asking.solve_quickly if question.hurried else known.asking.solve
            reply = answer(question.goals, progress) if question.goals else None
            then = known.asking.values_at(question.figures, reply.points) if reply is not None else {}
            conflicts: tuple[Conflict, ...] = ()
            unlimited = None
            if reply is not None and not question.hurried:
                self.nearer.emit(question, reply.design)  # seen at once; the conflicts take as long again
                conflicts = known.asking.conflicts(reply, question.goals, progress)
                unlimited = known.asking.unlimited(reply, question.goals, progress)
            return TargetAnswer(
                question, dict(known.now), dict(known.presses), reply, then, conflicts, unlimited
            )

    def _open(self, question: TargetQuery, progress: Progress) -> _Known:
        from core.analysis.inverse_design.line_selection import LineSelection  # noqa: PLC0415
        from core.analysis.inverse_design.search import Bounds  # noqa: PLC0415 (brings a search along that no start needs)

        stages = build(question.design, question.stages, progress)
        bounds = Bounds({}, longest=_LONGEST)
        asking = LineSelection(stages, question.optional, bounds, question.most_kpa)
        return _Known(question.design, question.most_kpa, question.optional, asking)
