"""The diagnosis: a notification of what is wrong with a design, and buttons that fix it as one step."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer

from app.gui.session.jobs import Job
from app.gui.widgets.notification_bar import REFUSED, Action
from app.i18n.catalog import joined, tr
from app.presenters import diagnosis as words
from app.presenters.assessment import AssessmentView, assessment_view, tone
from app.presenters.messages import render
from app.presenters.status import display_state, explanation, oscillation_mm
from core.analysis.diagnosis.diagnose import Diagnosis, diagnose
from core.document.design import Design
from core.errors import UserError
from core.garment.assessment import BAD, CAUTION, GOOD, LEVELS, PENDING, Assessment
from core.pipeline.build import build
from core.pipeline.live_solver import Frame
from core.pipeline.solve import NoEquilibriumError
from core.progress import Progress

if TYPE_CHECKING:
    from app.gui.context import AppContext

ABOUT = "doctor"
"""What its notices are about."""

PATIENCE = 1200
"""Milliseconds that a strained design rests before it is looked at: who is still at work hears nothing."""

REASONS = 2
"""Reasons of the verdict that a notice names; the others are in its details."""

_BAD = ("vibrating", "diverging", "folded", "overstrained")
_CALM = ("strained", "settling")
_CURED = ("lines", "traits", "gain", "volume", "line_force", "line_hold")


@dataclass(frozen=True)
class _Trouble:
    """What a notice is about: the complaint, and the two that fight once they are known."""

    complaint: str
    pair: tuple[tuple[str, ...], ...] | None = None

    def is_that(self, other: _Trouble) -> bool:
        """Return whether it is the same, as far as is known."""
        return self.complaint == other.complaint and (
            None in (self.pair, other.pair) or self.pair == other.pair
        )


def _level_of(complaint: str) -> str:
    return CAUTION if complaint == "strained" else BAD


def _severity(level: str) -> int:
    return LEVELS.index(level) if level in LEVELS else 0


class DiagnosisController(QObject):
    """Show at once that a design is no result, and what fixes it as soon as that is known.

    Mere strain is shown once, after a pause in the work. ``assess`` returns the overall verdict of a frame.
    """

    def __init__(self, context: AppContext, assess: Callable[[Frame], AssessmentView]) -> None:
        super().__init__(context.session)
        self._context, self._assess = context, assess
        self._frame: Frame | None = None
        self._about: Design | None = None
        self._quiet: set[Design] = set()
        self._cured: Design | None = None
        self._said: _Trouble | None = None
        self._closed: _Trouble | None = None
        self._job: Job | None = None
        self._asked = False
        context.notifications.closed.connect(self._note_closed)
        self._later = QTimer(self, interval=PATIENCE, singleShot=True)
        self._later.timeout.connect(self._look)
        context.session.failed.connect(self.refuse)
        said = tr("Find conflicting lines and suggest a fix")
        context.actions.add("solve", tr("Diagnose design…"), tip=said, do=self.ask, of_document=True)

    def follow(self, frame: Frame) -> None:
        """Diagnose a design at the end of its run; an edit cancels that."""
        self._frame = frame
        design = frame.stages.design
        if self._asked:
            self._begin_asked()
        if design is self._about:
            return
        self._forget()
        if frame.is_running or design is not self._context.session.design:
            return
        state = display_state(frame)
        if state == "settling" and design is self._cured:
            self._cured = None
            self._context.session.go_on()  # back from a fold it takes more turns: the doctor knows
            return
        self._about = design
        if state not in _BAD:
            self._closed = None
        if state in _BAD:
            self._tell_at_once(frame)
            self._look()
        elif state == "strained" and design not in self._quiet:
            self._later.start()

    def refuse(self, error: Exception) -> None:
        """Diagnose a design whose lengths were refused; the notice is shown already."""
        frame = self._context.session.frame
        if isinstance(error, NoEquilibriumError) and frame is not None:
            self._forget()
            self._about = self._context.session.design  # what stands again: its frames change nothing

            def work(progress: Progress) -> Diagnosis:
                return diagnose(build(error.design, frame.stages), progress)

            self._run(work, partial(self._tell_refused, error))

    def ask(self) -> None:
        """Show the diagnosis of the present design, once it is shown."""
        self._asked = True
        self._begin_asked()

    def _begin_asked(self) -> None:
        """Start with what was asked for, unless the first frame of the design is still to come."""
        frame, session = self._frame, self._context.session
        if frame is None or not (frame is session.frame and (session.is_answered or session.failure)):
            return
        self._asked = False
        self._forget()
        self._closed = None
        self._about = frame.stages.design
        self._run(partial(diagnose, frame.stages), partial(self._answer, frame), waited=True)

    def _forget(self) -> None:
        """Release what was said or looked for of another design."""
        self._later.stop()
        self._context.jobs.cancel(self._job)
        self._job = None
        if self._about is not None:
            self._about = None
            self._withdraw()

    def _look(self) -> None:
        frame = self._frame
        if frame is not None and frame.stages.design is self._about:
            self._run(partial(diagnose, frame.stages), partial(self._found, frame))

    def _run(
        self, work: Callable[[Progress], object], done: Callable[[object], None], *, waited: bool = False
    ) -> None:
        self._job = self._context.jobs.run(tr("Diagnosing…"), work, done, self._miss, waited=waited)

    def _miss(self, error: Exception) -> None:
        self._job = None
        if isinstance(error, UserError):
            self._context.notifications.error(error, ABOUT)
        else:
            logging.error("the doctor failed", exc_info=error)

    def _tell_at_once(self, frame: Frame) -> None:
        hint = tr("The solution is not physically valid. Do not use these values.")
        self._show(BAD, explanation(frame), hint, [], "", _Trouble(display_state(frame)))

    def _found(self, frame: Frame, found: object, *, asked: bool = False) -> None:
        """Tell what was found in place of what was told at once."""
        assert isinstance(found, Diagnosis)
        self._job = None
        if not found.problem:
            return  # from rest it does come to rest: what was told at once still holds for what is seen
        found, swing = found.with_convergence(frame.verdict), oscillation_mm(frame)[1]
        level = max(_level_of(found.problem), self._judged(frame, found).level, key=_severity)
        actions = self._fixes(found)
        self._quiet.add(frame.stages.design)
        worst = found.forces.worst
        trouble = _Trouble(found.problem, (worst.one.lines, worst.other.lines) if worst else ())
        said = words.sentence(found, swing)
        self._show(level, said, words.hint(found), actions, words.details(found), trouble, asked)

    def _answer(self, frame: Frame, found: object) -> None:
        """Tell what was asked for, well or not."""
        assert isinstance(found, Diagnosis)
        if found.problem:
            self._found(frame, found, asked=True)
            return
        self._job = None
        # It may have come to rest since it was asked.
        frame = self._frame or frame
        overall = self._judged(frame, found)
        level, reasons = overall.level, overall.reasons
        if reasons:
            said = joined(message for message, _ in reasons[:REASONS])
            actions = self._fixes(found)
            trouble = _Trouble("checked")
            hint = words.hint(found) if found.findings else joined(reasons[0][1:])
            details = "\n".join((*map(joined, reasons), words.details(found)))
            self._show(level, said, hint, actions, details, trouble, asked=True)
            return
        said = tr("No problems found: the solver converges and skin strain is within limits.")
        self._show(GOOD, said, "", [], words.details(found), None)

    def _judged(self, frame: Frame, found: Diagnosis) -> AssessmentView:
        """Return the overall verdict of a frame; what it waits for the diagnosis knows already."""
        overall = self._assess(frame)
        if overall.level != PENDING:
            return overall
        own = assessment_view(Assessment(found.findings), frame.stages.design)
        return replace(own, reasons=(*own.reasons, *overall.reasons))

    def _tell_refused(self, error: NoEquilibriumError, found: object) -> None:
        """Tell why lengths were refused, and the nearest that are not, in place of the bare refusal."""
        assert isinstance(found, Diagnosis)
        self._job = None
        notifications = self._context.notifications
        said = render(error.message, error.design)
        fights = words.sentence(found, 0.0) if found.problem and found.forces.worst else ""
        notifications.withdraw(REFUSED)
        hint = joined((fights, words.hint(found) if found.best_fix else render(error.hint)))
        notifications.show(
            "bad",
            said,
            hint,
            self._fixes(found),
            lasting=True,
            details=words.details(found),
            topic=REFUSED,
        )

    def _show(
        self,
        level: str,
        sentence: str,
        hint: str,
        actions: list[Action],
        details: str,
        trouble: _Trouble | None,
        asked: bool = False,
    ) -> None:
        """Show a notice in the tone of a verdict's ``level`` in place of the last.

        The same ``trouble`` is not told again once it was closed by hand. Mere strain leaves by itself;
        what was ``asked`` for stays till it is closed.
        """
        if trouble and self._closed and trouble.is_that(self._closed):
            return
        self._withdraw()
        lasting = asked or (trouble is not None and trouble.complaint not in _CALM)
        self._context.notifications.show(tone(level), sentence, hint, actions, lasting, details, ABOUT)
        self._said = trouble if lasting else None

    def _withdraw(self) -> None:
        self._said = None
        self._context.notifications.withdraw(ABOUT)

    def _note_closed(self) -> None:
        """Record what was closed by hand: it is not told again before something else is wrong."""
        if self._said is not None and not self._context.notifications.is_shown(ABOUT):
            self._closed, self._said = self._said, None

    def _fixes(self, found: Diagnosis) -> list[Action]:
        """Return a button for each of the best fixes; the others are in the details."""
        said = ((words.change_text(found, cure.change), cure) for cure in words.shown_fixes(found))
        return [(text, partial(self._apply, text, cure.change.design)) for text, cure in said]

    def _apply(self, said: str, cured: Design) -> None:
        """Make the change as one step, whatever was only called otherwise since."""
        changed = {name: getattr(cured, name) for name in _CURED}
        self._context.session.edit(lambda design: replace(design, **changed), said)
        design = self._context.session.design
        if design is not None:
            self._quiet.add(design)
            self._cured = design
