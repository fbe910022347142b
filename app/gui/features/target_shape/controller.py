"""Ask for the result: wishes are met by lengths of lines, which are seen before they are taken."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer, Signal
from PySide6.QtGui import QUndoGroup
from PySide6.QtWidgets import QStackedWidget

from app.gui.context import RESHAPED
from app.gui.features.target_shape.card import TargetCard
from app.gui.features.target_shape.handles import TargetHandles
from app.gui.features.target_shape.linearization import TargetDesign
from app.gui.features.target_shape.menu import TargetMenu
from app.gui.features.target_shape.presenter import meets_targets, show_result, target_views
from app.gui.features.target_shape.profile_tool import ProfileTool
from app.gui.features.target_shape.surroundings import TargetOptions
from app.gui.features.target_shape.targets import PRESSURE, Targets, TargetUndo, default_quantities
from app.gui.features.target_shape.view_state import ViewState
from app.gui.features.target_shape.worker import TargetAnswer, TargetQuery, TargetWorker
from app.gui.widgets.basic import announce
from app.i18n.catalog import tr
from app.presenters.messages import render
from app.presenters.target_shape import inactive_text, step_text
from core.analysis.inverse_design.profile_quantities import is_signed
from core.analysis.inverse_design.quantities import reading
from core.analysis.inverse_design.quantity import Goal
from core.document.design import Design
from core.errors import UserError

if TYPE_CHECKING:
    from app.gui.context import AppContext
    from core.analysis.inverse_design.profile_curve import ProfileCurve

_RESTS = 150  # stillness of a hand after which the best lengths are looked for [ms]
_SLOW = 400  # an answer that takes longer is worth a word [ms]


class TargetShapeController(QObject):
    """Opens the card by ``begin``; what is wished is answered while it is open, and previewed on the body.

    A wish without a value is shown as it is, and not asked for.
    """

    closed = Signal()
    presets_requested = Signal()

    def __init__(self, context: AppContext, pages: QStackedWidget, undo_group: QUndoGroup) -> None:
        super().__init__(context.session)
        self._pages = pages
        self._context, self._session = context, context.session
        self.all_wishes = Targets()
        self._answer: TargetAnswer | None = None
        self._apply_due = False
        self.ground = TargetDesign(context.session)
        self.work = TargetWorker(context.jobs, self)
        self.work.answered.connect(self._take)
        self.work.refused.connect(self._refuse)
        self.work.nearer.connect(self._show_nearer)
        self._rest = QTimer(self, interval=_RESTS, singleShot=True)
        self._rest.timeout.connect(self.ask)
        self._slow = QTimer(self, interval=_SLOW, singleShot=True)
        self._slow.timeout.connect(self._show)
        self.card = TargetCard()
        pages.addWidget(self.card)
        self.handles = TargetHandles(context, self)
        self.drawing, self.around = ProfileTool(context, self), TargetOptions(context, self)
        self.menu, self.back = TargetMenu(context, self), ViewState(context, self)
        self.steps = TargetUndo(context.session, undo_group, self)
        self._connect()

    def _connect(self) -> None:
        context, card, session = self._context, self.card, self._session
        text = tr("Set target positions; Busk computes the lengths of the active lines")
        do = context.actions
        do.rule("lines")
        do.add("lines", tr("Target shape…"), "A", text, do=self.begin, of_document=True)
        card.entered.connect(self.wish)
        card.removed.connect(self.drop)
        card.add_requested.connect(self.menu.show)
        card.hand_chosen.connect(self.drawing.choose)
        card.applied.connect(self.apply)
        card.closed.connect(self.leave)
        session.design_changed.connect(self._follow_design)
        session.frame_ready.connect(lambda _: self.handles.follow())
        session.opened.connect(lambda _: self._forget())
        context.navigation.step_shown.connect(self._follow_step)
        context.view.compared.connect(self.handles.follow)

    # -- what is asked for

    @property
    def answer(self) -> TargetAnswer | None:
        """Return the answer that is shown, if there is one."""
        return self._answer

    @answer.setter
    def answer(self, answer: TargetAnswer | None) -> None:
        self._answer = answer
        self._session.trial = None if answer is None or answer.reply is None else answer.reply.design

    @property
    def is_open(self) -> bool:
        """Return whether something is being asked for."""
        return self._pages.currentWidget() is self.card

    def begin(
        self,
        goals: Sequence[Goal] = (),
        prepare: Callable[[Design], Design] | None = None,
        text: str = "",
        limit: float | None = None,
    ) -> None:
        """Open the card, with ``goals`` wished for already.

        They are asked of what ``prepare`` makes of the design, which ``said`` tells; that is taken with them.
        ``limit`` is that of pressure [kPa], see ``Targets``; one that was switched off before stays off.
        """
        if self._session.frame is None or self._session.design is None:
            return
        if self.is_open:
            self.leave()
        self._context.navigation.start_tool()
        self._context.navigation.show_step("lines")
        limit = math.inf if math.isinf(self.all_wishes.most_kpa) else limit
        self.ground.begin(prepare, text)
        wishes = Targets.of(goals, default_quantities(self.ground.design or self._session.design))
        self.all_wishes, self.answer, self._apply_due = replace(wishes, limit=limit), None, False
        self.back.remember()
        self._pages.setCurrentWidget(self.card)
        self.drawing.choose("bust")
        self.steps.forget()
        self.card.take_focus(next(iter(self.wishes), ""))

    def wish(self, key: str, value: float) -> None:
        """Set the target of a quantity [mm], or the limit of pressure [kPa].

        A girth below nothing is how much shorter it is to be than on the original body.
        """
        frame = self._session.frame
        if value < 0.0 and frame is not None and key != PRESSURE and not is_signed(key):
            value += reading(frame.stages, key)(frame.stages.rest_points).value
        self.all_wishes.set(key, value)
        self.steps.note()
        self.ask()

    def add(self, name: str) -> None:
        """Show a figure as it is, so that it can be wished otherwise."""
        self.wishes.setdefault(name, None)
        self.ask()
        self.card.take_focus(name)

    def drop(self, key: str) -> None:
        """Remove the target of a quantity or a profile."""
        self.all_wishes.drop(key)
        if self.handles.kind == "profile" and not self.drawn:
            self.drawing.choose("bust")
        else:
            self.ask()
        self.steps.note()

    def wish_by_hand(self, wishes: dict[str, float | None], *, at_rest: bool) -> None:
        """Take wishes that a hand has dragged to; while it is on its way the answers are quick ones."""
        self.all_wishes.figures = wishes
        self._rest.start()
        self.ask(hurried=not at_rest)
        if at_rest:
            self.steps.note()

    @property
    def drawn(self) -> dict[str, ProfileCurve]:
        """Return the profiles that are drawn, by section."""
        return self.all_wishes.drawn

    @property
    def wishes(self) -> dict[str, float | None]:
        """Return the figures on the card; those without a value are not asked for."""
        return self.all_wishes.figures

    def goals(self) -> tuple[Goal, ...]:
        """Return what is asked for."""
        return self.all_wishes.goals(self.answer.now if self.answer is not None else {})

    @property
    def is_tried_on(self) -> bool:
        """Return whether what is seen is the answer, solved to the end, and not taken."""
        frame, answer = self._session.frame, self.answer
        if frame is None or answer is None or answer.reply is None or not self.is_open:
            return False
        return frame.stages.design is answer.reply.design and not frame.is_running

    # -- how it ends

    def apply(self) -> None:
        """Take the lengths that are shown as one undo step, once they are those that were asked for."""
        answer = self.answer
        self._apply_due = self.work.at_work or self._rest.isActive()
        if self._apply_due or answer is None or answer.reply is None:
            return
        design, words = answer.reply.design, step_text(self.all_wishes.asked, self.all_wishes.set_limit)
        if self.ground.said:
            words = " · ".join((self.ground.said, words))
        self.end()
        self._session.edit(lambda _: design, words)

    def leave(self) -> bool:
        """Close the card; the body is as it was. Returns whether it was open."""
        was_open = self.is_open
        if was_open:
            self.end()
            self._session.cancel_preview()
        return was_open

    def _follow_step(self, step: str) -> None:
        """Close the card at steps of the original body: its handles are of the reshaped one."""
        if step not in RESHAPED:
            self.leave()

    def end(self) -> None:
        """Close the card, and let the shown body be what it is."""
        self.card.drop_typed()
        self._rest.stop()
        self._slow.stop()
        self.work.stop()
        self.answer, self._apply_due = None, False
        self.ground.leave()
        if self.is_open:
            self.back.go()
        self._pages.setCurrentIndex(0)
        self.handles.put_away()
        self.steps.forget()
        self.closed.emit()  # shown lengths may be those that were tried on

    def _forget(self) -> None:
        """Let another body begin with the usual limit."""
        self.end()
        self.all_wishes = Targets()

    # -- questions and answers

    def ask(self, *, hurried: bool = False) -> None:
        """Solve the current targets; ``hurried`` during a drag."""
        frame, design = self._session.frame, self.ground.design
        if not self.is_open or frame is None or design is None:
            return
        if not hurried:
            self._rest.stop()
        if self.ground.missing:
            self.work.stop()
            self.answer = None
            self._session.cancel_preview()
        else:
            goals, told, limit = self.goals(), self.all_wishes.told, self.all_wishes.most_kpa
            optional = self.ground.inactive if self.all_wishes.optional else ()
            hurried = hurried and bool(goals)
            self.work.ask(TargetQuery(design, frame.stages, goals, told, limit, hurried, optional))
            self._slow.start()
        self._show()

    def _take(self, answer: TargetAnswer) -> None:
        if not self.is_open or answer.question.design is not self.ground.design:
            return
        self.answer = answer
        if not answer.question.goals and self.goals():  # only now it is known what is to stay
            self.ask()
            return
        if answer.reply is not None and answer.reply.design != self._session.design:
            self._session.preview(answer.reply.design)
        else:
            self._session.cancel_preview()
        self._show()
        if not self.work.at_work and not answer.question.hurried:
            announce(self.card, self.card.answer.text())
            due, self._apply_due = self._apply_due, False
            if due and meets_targets(self.all_wishes, answer):  # what is only near was not seen yet
                self.apply()

    def _show_nearer(self, question: TargetQuery, design: Design) -> None:
        """Show the nearest so far on the body, while it is looked for elsewhere."""
        if self.is_open and question.design is self.ground.design and self.work.is_at(question):
            self._session.preview(design)

    def _refuse(self, problem: Exception) -> None:
        self._apply_due = False
        if not self.is_open:
            return
        if not isinstance(problem, UserError):
            self.leave()
            self._session.failed.emit(problem)
            return
        self.answer = None
        self._session.cancel_preview()
        self._show()
        text = render(problem.text)
        self.card.show_answer(text, "warn")

    def _follow_design(self, _: Design) -> None:
        if self.is_open:
            self.answer = None
            self.steps.forget()
            self.ground.follow()
            self.ask()

    # -- what is shown

    def _show(self) -> None:
        frame, design = self._session.frame, self.ground.design
        if not self.is_open or frame is None or design is None:
            return
        missing = self.ground.missing
        self.card.show_help(
            bool(missing), locked=not design.all_active_lines().isdisjoint(self.ground.moving)
        )
        if missing:
            self.card.show_wishes([], missing)
            self.card.show_answer()
        else:
            self.card.show_hands(bool(design.lines))
            self.card.show_optional(inactive_text(design, self.ground.inactive), self.all_wishes.optional)
            hint = self.drawing.hint()
            self.card.show_wishes(list(target_views(self.all_wishes, self.answer)), hint)
            text = self.ground.said
            show_result(self.card, design, self.all_wishes, self.answer, apart=text, busy=self._busy())
        self.handles.follow()

    def _busy(self) -> str:
        """Return how long an answer is being waited for: nothing, "soon" or "slow"."""
        if not (self.work.at_work or self._rest.isActive()):
            return ""
        return "soon" if self._slow.isActive() or self._rest.isActive() else "slow"
