"""Work that takes time: named, with its progress, and cancelled."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import TYPE_CHECKING, Protocol

from PySide6.QtCore import QObject, SignalInstance

from app.gui.status_bar import StatusBar
from app.gui.widgets.notification_bar import NotificationBar
from app.presenters.scan import work_steps, work_text

if TYPE_CHECKING:
    from app.gui.context import AppContext
    from app.gui.session.jobs import Job

AGE = 0.3
"""Seconds that a job nobody waits for takes before it is worth a word."""


class Carrier(Protocol):
    """A controller whose things are dragged over the body; ``carrying_changed`` as drags begin and end."""

    @property
    def carrying_changed(self) -> SignalInstance:
        """Return the signal of its drags."""
        ...

    @property
    def carries(self) -> bool:
        """Return whether something is in the hand."""
        ...

    def let_go(self) -> bool:
        """Cancel the drag; returns whether there was one."""
        ...


class ProgressController(QObject):
    """Show what the solver's thread reads and builds, else the first of the jobs.

    While one of ``carriers`` carries something, nothing is waited for, and notifications are hidden.
    """

    def __init__(self, context: AppContext, bar: NotificationBar, status: StatusBar) -> None:
        super().__init__(context.session)
        self._context, self._session = context, context.session
        self._bar, self._status = bar, status
        self._built = ("", 1.0)
        self.carriers: list[Carrier] = []
        context.session.working.connect(self.show_work)
        context.jobs.changed.connect(self.show)
        context.view.busy.cancelled.connect(self.cancel)
        context.actions.cancel.triggered.connect(self.cancel)
        status.job_cancelled.connect(self.cancel)

    def add_carriers(self, *carriers: Carrier) -> None:
        """Add what may carry something."""
        self.carriers += carriers
        for carrier in carriers:
            carrier.carrying_changed.connect(self.show)

    def show_work(self, what: str, share: float) -> None:
        """Name what is read or built, and how much of it is done; an empty name ends it."""
        words = work_text(what)
        if words or not what:
            self._built = words, share
            self.show()

    def show(self) -> None:
        """Show the work that the user waits for, with a card, else a job beside it in the status bar."""
        # While a hand carries something the model follows all the time: that is no work to wait for.
        carried = any(each.carries for each in self.carriers)
        words, share = ("", 1.0) if carried else self._built
        job = None if words else self._shown_job()
        waited = bool(words) or (job is not None and job.waited)
        steps: Sequence[str] = work_steps() if words else ()
        shown: float | None = share
        if job is not None:
            words, shown = job.words, job.share
        self._bar.set_aside(carried)
        self._status.set_job(words, shown)
        at_once = bool(steps and self._session.opening)
        self._context.view.busy.show_work(words if waited else "", shown, steps, at_once)
        self._context.actions.cancel.setEnabled(waited or carried)

    def cancel(self) -> None:
        """Release what a hand carries, else of the work that is shown; all is as it was before."""
        if any(each.let_go() for each in self.carriers):
            return
        if self._built[0]:
            self._session.cancel()
            self.show_work("", 1.0)
        else:
            self._context.jobs.leave(self._shown_job())

    def _shown_job(self) -> Job | None:
        now = time.monotonic()
        jobs = self._context.jobs.at_work()
        return next((job for job in jobs if job.waited or now - job.began > AGE), None)
