"""Notifications: what happened, what went wrong and what was written, until it no longer holds."""

from __future__ import annotations

import logging
import traceback
from collections.abc import Collection, Sequence
from functools import partial
from pathlib import Path

from PySide6.QtCore import QObject, Signal

from app.gui.session.app_folders import show_folder, shown_folder
from app.gui.session.session import Session
from app.gui.widgets.notification_bar import FAULT, REFUSED, Action, NotificationBar
from app.i18n.catalog import tr
from app.presenters.messages import Text, render
from app.presenters.status import error_text, solver_error_text
from core.document.design import Design
from core.errors import UserError
from core.pipeline.live_solver import Frame


class Notifications(QObject):
    """Show notifications in a bar, and withdraw those of an edit or a fault that is over.

    A notification may have a ``topic``, by which it is withdrawn.
    """

    closed = Signal()

    def __init__(self, session: Session, bar: NotificationBar) -> None:
        super().__init__(session)
        self._session, self._bar = session, bar
        self._refused_by: Design | None = None
        self._step, self._faulty = 0, False
        bar.closed.connect(self.closed)
        session.opened.connect(bar.clear)
        session.failed.connect(self.error)
        session.undo_stack.indexChanged.connect(self._follow_step)

    # -- what happened

    def show(
        self,
        tone: str,
        sentence: Text,
        hint: Text = "",
        actions: Sequence[Action] = (),
        lasting: bool = False,
        details: str = "",
        topic: str = "",
    ) -> None:
        """Show a notification in the tone ok, info, warn or bad; ``details`` unfold."""
        self._bar.show_notice(tone, sentence, hint, actions, lasting, details, topic)

    def done(self, sentence: Text, hint: Text = "") -> None:
        """Confirm what was done."""
        self.show("ok", sentence, hint)

    def info(
        self, sentence: Text, hint: Text = "", actions: Sequence[Action] = (), *, lasting: bool = False
    ) -> None:
        """Show an information."""
        self.show("info", sentence, hint, actions, lasting)

    def warn(
        self, sentence: Text, hint: Text = "", actions: Sequence[Action] = (), *, topic: str = ""
    ) -> None:
        """Warn until the notification is closed or its topic withdrawn."""
        self.show("warn", sentence, hint, actions, lasting=True, topic=topic)

    def error(self, error: Exception, topic: str = "") -> None:
        """Show an error; what is on the screen stays.

        One of a file that could not be written has a ``topic``, until ``file_written`` of the same.
        """
        self._refused_by = self._session.design
        if isinstance(error, UserError):
            # Only the last refusal counts.
            topic = topic or REFUSED
            self.withdraw(topic)
            message = render(error.message, self._session.design)
            self.show("bad", message, error.hint, lasting=True, topic=topic)
            return
        logging.error("unexpected fault", exc_info=error)
        trace = "".join(traceback.format_exception(error))
        failure = self._session.failure
        self._faulty = failure is not None and failure.error is error
        if self._faulty:
            text, topic = solver_error_text(error), FAULT
        else:
            text, topic = error_text(error), topic or REFUSED
        again = [(tr("Try again"), self._session.go_on)] if self._faulty else []
        self.show("bad", *text, again, lasting=True, details=trace, topic=topic)

    def stopped(self, work: str) -> None:
        """Show that background work was stopped, and when it restarts."""
        sentence = tr("Stopped: {work}").format(work=work)
        self.info(sentence, tr("The computation will restart when you open this panel."))

    def file_written(self, topic: str, sentence: str, path: str) -> None:
        """Confirm that a file was written, and offer its folder."""
        self.withdraw(topic)
        folder = Path(path).absolute().parent
        show = tr("Show folder"), partial(show_folder, folder, self.info)
        self.show("ok", sentence, shown_folder(folder), [show])

    # -- what is over

    def withdraw(self, topic: str) -> None:
        """Remove the notifications of a topic."""
        self._bar.withdraw(topic)

    def keep_only(self, topic: str, sentences: Collection[Text]) -> None:
        """Remove the notifications of a topic whose sentence no longer holds."""
        self._bar.keep_only(topic, sentences)

    def is_shown(self, topic: str) -> bool:
        """Return whether a notification of a topic is shown or waits."""
        return self._bar.says(topic)

    def show_frame(self, frame: Frame) -> None:
        """Withdraw refusals of a former design and faults of the solver that a frame has ended."""
        design = frame.stages.design
        if self._refused_by not in (None, design) and design is self._session.design:
            self._forget_refusals()
        if self._faulty and self._session.failure is None:
            self._faulty = False
            self.withdraw(FAULT)

    def _follow_step(self, index: int) -> None:
        """Withdraw refusals of what is undone; those of another edit go with its first frame."""
        former, self._step = self._step, index
        # A refused edit is undone to the design that was there when it was reported: its notification stays.
        if index < former and self._session.design is not self._refused_by:
            self._forget_refusals()

    def _forget_refusals(self) -> None:
        self._refused_by = None
        self.withdraw(REFUSED)
