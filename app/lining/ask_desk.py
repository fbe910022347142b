"""Ask for the result: wishes are met by lengths of lines, which are seen before they are taken."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer

from app.dress.spoken import announce
from app.lining.ask_handles import AskHandles
from app.lining.ask_menu import AskMenu
from app.lining.ask_work import Answer, AskWork, Question
from app.panels.ask_card import AskCard, WishView
from app.presenting.asking import (
    answer_words,
    change_words,
    figure_title,
    is_signed,
    kept_words,
    missing_words,
    step_words,
    values_words,
)
from app.wording.words import joined, listed, number, say, tr
from core.aims.figure import Goal
from core.aims.outline import section_of
from core.design import Design
from core.errors import UserError
from core.frame import Frame

if TYPE_CHECKING:
    from app.main_window import MainWindow

PRESSURE = "pressure"
"""The key of the wish that is a limit [kPa]."""

_RESTS = 150  # stillness of a hand after which the best lengths are looked for [ms]
_SLOW = 400  # an answer that takes longer is worth a word [ms]
_SOFTEST, _HARDEST = 0.2, 50.0  # limits that can be set [kPa]


class AskDesk(QObject):
    """Opens the card by ``begin``; what is wished is answered while it is open, and previewed on the body.

    A wish without a value is shown as it is, and not asked for.
    """

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window, self._session = window, window.session
        self.wishes: dict[str, float | None] = {}
        self.curves: dict[str, tuple[Goal, ...]] = {}
        self.limit: float | None = None  # where the red light begins, but for straps
        self.answer: Answer | None = None
        self._apply_due = False
        self.work = AskWork(window.jobs, self)
        self.work.answered.connect(self._take)
        self.work.refused.connect(self._refuse)
        self._rest = QTimer(self, interval=_RESTS, singleShot=True)
        self._rest.timeout.connect(self._ask)
        self._slow = QTimer(self, interval=_SLOW, singleShot=True)
        self._slow.timeout.connect(self._show)
        self.card = AskCard(window.view)
        window.view.place(self.card, "bottom")
        self.handles = AskHandles(window, self)
        self.menu = AskMenu(window, self)
        self._connect()

    def _connect(self) -> None:
        window, card, session = self._window, self.card, self._session
        said = tr("Say where the bust is to be; Busk finds the lengths of the worn lines")
        do = window.actions_
        do.rule("lines")
        do.add("lines", tr("Ask for the result…"), "A", said, do=self.begin, of_document=True)
        window.ask_door.clicked.connect(lambda _: self.begin())
        card.entered.connect(self.wish)
        card.removed.connect(self.drop)
        card.add_asked.connect(self.menu.show)
        card.helped.connect(window.preset_desk.show_menu)
        card.applied.connect(self.apply)
        card.left.connect(self.leave)
        session.design_changed.connect(self._follow_design)
        session.frame_ready.connect(lambda _: self.handles.follow())
        session.opened.connect(lambda _: self.end())
        window.view.compared.connect(self.handles.follow)

    # -- what is asked for

    @property
    def is_open(self) -> bool:
        """Whether something is being asked for."""
        return not self.card.isHidden()

    @property
    def asks(self) -> bool:
        """Whether there are lines that can be asked for anything."""
        frame, design = self._session.frame, self._session.design
        return frame is not None and design is not None and not self._missing(frame, design)

    def begin(self, goals: Sequence[Goal] = ()) -> None:
        """Open the card, with ``goals`` wished for already."""
        if self._session.frame is None or self._session.design is None:
            return
        self._window.line_drawing.leave()
        self._window.line_routing.leave()
        self._window.desk.go_to("lines")
        self.limit, self.answer, self._apply_due = None, None, False
        self.wishes, self.curves = {}, {}
        for goal in goals:
            section = section_of(goal.name)
            if section:
                self.curves[section] = (*self.curves.get(section, ()), goal)
            else:
                self.wishes[goal.name] = goal.value
        if not goals:
            self.wishes = {"lift": None, "out": None}
        self.card.show()
        self._ask()
        self.card.take_focus(next(iter(self.wishes), ""))

    def wish(self, key: str, value: float) -> None:
        """Wish for a figure [mm], or set the limit of pressure [kPa]."""
        if key == PRESSURE:
            self.limit = min(max(value, _SOFTEST), _HARDEST)
            if not self.goals():  # the same with less pressure
                self._hold_first()
        else:
            self.wishes[key] = value
        self._ask()

    def add(self, name: str) -> None:
        """Show a figure as it is, so that it can be wished otherwise."""
        self.wishes.setdefault(name, None)
        self._ask()
        self.card.take_focus(name)

    def wish_curve(self, section: str, goals: tuple[Goal, ...]) -> None:
        """Wish for the profile of a section."""
        self.curves[section] = goals
        self._ask()

    def drop(self, key: str) -> None:
        """Wish for a figure, or a profile, no longer."""
        self.wishes.pop(key, None)
        self.curves.pop(key, None)
        self.limit = None if key == PRESSURE else self.limit
        self._ask()

    def wish_by_hand(self, wishes: dict[str, float | None], *, at_rest: bool) -> None:
        """Take wishes that a hand has dragged to; while it is on its way the answers are quick ones."""
        self.wishes = wishes
        self._rest.start()
        if at_rest:
            self._ask()
        else:
            self._ask(hurried=True)

    def goals(self) -> tuple[Goal, ...]:
        """Return what is asked for."""
        single = [Goal(name, value) for name, value in self.wishes.items() if value is not None]
        return (*single, *(goal for curve in self.curves.values() for goal in curve))

    def _hold_first(self) -> None:
        now = self.answer.now if self.answer is not None else {}
        for name in self.wishes:
            if name in now:
                self.wishes[name] = now[name]
                return

    # -- how it ends

    def apply(self) -> None:
        """Take the lengths that are shown as one undo step, once they are those that were asked for."""
        answer = self.answer
        self._apply_due = self.work.at_work or self._rest.isActive()
        if self._apply_due or answer is None or answer.reply is None:
            return
        design, words = answer.reply.design, step_words(answer.question.goals)
        self.end()
        self._session.edit(lambda _: design, words)

    def leave(self) -> None:
        """Ask no longer; the body is as it was."""
        if self.is_open:
            self.end()
            self._session.cancel_preview()

    def end(self) -> None:
        """Close the card, and let the shown body be what it is."""
        self._rest.stop()
        self._slow.stop()
        self.work.stop()
        self.answer, self._apply_due = None, False
        self.card.hide()
        self.handles.put_away()

    # -- questions and answers

    def _ask(self, *, hurried: bool = False) -> None:
        frame, design = self._session.frame, self._session.design
        if not self.is_open or frame is None or design is None:
            return
        if not hurried:
            self._rest.stop()
        if self._missing(frame, design):
            self.work.stop()
            self.answer = None
            self._session.cancel_preview()
        else:
            goals, figures = self.goals(), tuple(self.wishes)
            self.work.ask(Question(design, frame.stages, goals, figures, self.limit, hurried and bool(goals)))
            self._slow.start()
        self._show()

    def _take(self, answer: Answer) -> None:
        if not self.is_open or answer.question.design is not self._session.design:
            return
        self.answer = answer
        if answer.reply is not None and answer.reply.design != self._session.design:
            self._session.preview(answer.reply.design)
        else:
            self._session.cancel_preview()
        self._show()
        if not self.work.at_work and not answer.question.hurried:
            announce(self.card, self.card.answer.text())
            if self._apply_due:
                self.apply()

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
        said = joined((say(problem.message), say(problem.hint)))
        self.card.show_answer(said, "warn")

    def _follow_design(self, _: Design) -> None:
        if self.is_open:
            self.answer = None
            self._ask()

    # -- what is shown

    def _show(self) -> None:
        frame, design = self._session.frame, self._session.design
        if not self.is_open or frame is None or design is None:
            return
        missing = self._missing(frame, design)
        self.card.show_help(bool(missing))
        if missing:
            self.card.show_wishes([], missing)
            self.card.show_answer()
        else:
            hint = tr("Type what it is to be, or drag the handle at the bust point.")
            self.card.show_wishes(list(self._views(design)), "" if self.goals() else hint)
            self._show_answer(design)
        self.handles.follow()

    def _show_answer(self, design: Design) -> None:
        answer, busy = self.answer, self.work.at_work or self._rest.isActive()
        locked = {traits.name for traits in design.traits if traits.locked}
        note = kept_words(design, locked)
        if busy and not self._slow.isActive() and not self._rest.isActive():
            self.card.show_answer(tr("Working it out…"), note=note, can_apply=True)
        elif answer is None or answer.reply is None or not self.goals():
            self.card.show_answer(note=note, can_apply=busy and bool(self.goals()))
        else:
            reply, goals = answer.reply, answer.question.goals
            tone = "ok" if reply.reachable else "warn"
            changes = listed(change_words(design, reply))
            self.card.show_answer(answer_words(reply, goals), tone, changes, note, can_apply=True)

    def _views(self, design: Design) -> Iterator[WishView]:
        now = self.answer.now if self.answer is not None else {}
        for name, value in self.wishes.items():
            shown = now.get(name, 0.0) if value is None else value
            words, set_ = values_words(now, name), value is not None
            yield WishView(name, figure_title(name), shown, words, signed=is_signed(name), set_=set_)
        for section, goals in self.curves.items():
            words = tr("heights: {count}").format(count=len(goals))
            yield WishView(section, figure_title(goals[0].name), None, words)
        if design.worn_elastics() and design.line_hold == "spring":
            presses = self.answer.presses if self.answer is not None else {}
            most, set_ = max(presses.values(), default=0.0), self.limit is not None
            words = tr("now {value}").format(value=number(most)) if presses else ""
            shown = most if self.limit is None else self.limit
            title = tr("Pressure at most")
            yield WishView(PRESSURE, title, shown, words, "kPa", signed=False, set_=set_, kept=not set_)

    def _missing(self, frame: Frame, design: Design) -> str:
        """Return what has to be done before anything can be asked, if there is something."""
        return missing_words(design, [line.name for line in frame.stages.model.lines if line.constrains])
