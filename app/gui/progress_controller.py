"""What the window does about work that takes its time: it names it, shows how far it is, lets go of it."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import TYPE_CHECKING, Protocol

from PySide6.QtCore import QObject

from app.presenters.scan import work_steps, work_words

if TYPE_CHECKING:
    from app.gui.main_window import MainWindow
    from app.gui.session.jobs import Job

AGE = 0.3
"""Seconds that a job nobody waits for takes before it is worth a word."""


class Carrier(Protocol):
    """A desk whose things a hand carries over the body."""

    @property
    def carries(self) -> bool:
        """Whether something is in the hand."""
        ...

    def let_go(self) -> bool:
        """Bring it back to where it was; returns whether there was anything."""
        ...


class JobDesk(QObject):
    """Shows the work in hand: what the solver's thread reads and builds, else the first of the jobs."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._session = window.session
        self._built = ("", 1.0)

    def show_work(self, what: str, share: float) -> None:
        """Name what is read or built, and how much of it is done; an empty name ends it."""
        words = work_words(what)
        if words or not what:
            self._built = words, share
            self.show()

    def show(self) -> None:
        """Show the work that the user waits for, with a card, else a job beside it in the status bar."""
        window = self._window
        # While a hand carries something the model follows all the time: that is no work to wait for.
        carried = any(desk.carries for desk in self._carriers())
        words, share = ("", 1.0) if carried else self._built
        job = None if words else self._shown_job()
        waited = bool(words) or (job is not None and job.waited)
        steps: Sequence[str] = work_steps() if words else ()
        shown: float | None = share
        if job is not None:
            words, shown = job.words, job.share
        window.notices.set_aside(carried)
        window.status.set_job(words, shown)
        at_once = bool(steps and self._session.opening)
        window.view.busy.show_work(words if waited else "", shown, steps, at_once)
        window.actions_.cancel.setEnabled(waited or carried)

    def cancel(self) -> None:
        """Let go of what a hand carries, else of the work that is shown; all is as it was before."""
        if any(desk.let_go() for desk in self._carriers()):
            return
        if self._built[0]:
            self._session.cancel()
            self.show_work("", 1.0)
        else:
            self._window.jobs.leave(self._shown_job())

    def _carriers(self) -> tuple[Carrier, ...]:
        window = self._window
        return window.landmark_desk, window.band_pull, window.section_desk, window.ask_desk.handles

    def _shown_job(self) -> Job | None:
        now = time.monotonic()
        jobs = self._window.jobs.at_work()
        return next((job for job in jobs if job.waited or now - job.began > AGE), None)
