"""The desk of left and right: how they differ, worked out where it is seen, and what makes them even."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, cast
from weakref import WeakKeyDictionary, WeakSet

from PySide6.QtCore import QObject, Signal

from app.gui.features.measurements.panel import ResultPanel
from app.gui.features.symmetry.card import EvenCard
from app.gui.session.jobs import Job
from app.i18n.catalog import listed, tr
from app.presenters.status import doubt_of
from app.presenters.symmetry import even_summary, left_as_it_is, map_note, parted_titles
from core.analysis.symmetry.compare import BeforeAfter, evenness
from core.analysis.symmetry.split_sides import parted
from core.control_mesh.template import read_template
from core.document.design import Design
from core.measurements.uncertain_value import Spread
from core.pipeline.build import Stages
from core.pipeline.live_solver import Frame
from core.progress import Progress

if TYPE_CHECKING:
    from app.gui.main_window import MainWindow
    from core.analysis.symmetry.balance import Evened

SIDES = "sides"
"""The map Left and right."""


class EvenDesk(QObject):
    """Keeps how left and right of frames differ, and shows it beside the measures and under the map.

    ``found`` says that there is more of it.
    """

    found = Signal()

    def __init__(self, window: MainWindow, panel: ResultPanel) -> None:
        super().__init__(window)
        self._window, self._panel = window, panel
        self.card = EvenCard()
        panel.cards.addWidget(self.card)
        self._shown: tuple[Frame, BeforeAfter] | None = None
        self._known: WeakKeyDictionary[Frame, BeforeAfter] = WeakKeyDictionary()
        self._asked: WeakSet[Frame] = WeakSet()
        self._making: tuple[Job, Design] | None = None
        self.found.connect(self.follow)
        panel.opened.connect(self.follow)
        window.spread_desk.found.connect(self.follow)
        self.card.shown.connect(self._show_map)
        self.card.asked.connect(self._ask)

    def of(self, frame: Frame) -> BeforeAfter | None:
        """Return how left and right of a frame differ; if that is not known yet it is worked out beside.

        While the body moves it is not: the next frame would be another one.
        """
        moves = frame is self._window.session.frame and not self._window.session.is_at_rest
        if frame not in self._asked and not frame.at_work and not moves:
            self._asked.add(frame)
            self._window.jobs.run(
                tr("Comparing left and right"),
                lambda progress: evenness(frame.stages, frame.control_points),
                lambda found: self._take(frame, found),
                self._window.notifications.error,
                left=lambda: self._asked.discard(frame),
            )
        return self._known.get(frame)

    def note(self, frame: Frame, after: bool) -> str:
        """Return what the legend of the map says of a frame in ml, once it is known."""
        told = self.of(frame)
        return map_note(told, after and not doubt_of(frame))

    def follow(self) -> None:
        """Bring the card up to date, if it is seen; what is of a former shape is faint."""
        frame, design = self._window.session.frame, self._window.session.design
        if self._making is not None and self._making[1] is not design:
            self._window.jobs.cancel(self._making[0])  # it would make another design even
            self._making = None
        if frame is None or not self._panel.isVisible():
            return
        known = self.of(frame)
        if known is not None:
            self._shown = frame, known
        elif self._shown is not None and self._shown[0].stages.body is not frame.stages.body:
            self._shown = None
        if self._shown is None:
            self.card.show_summary(None, faint=False)
            return
        of, told = self._shown
        summary = even_summary(told, of.stages, doubt_of(of), self._sure(of))
        self.card.show_summary(summary, faint=of is not frame)
        self.follow_map()

    def _sure(self, frame: Frame) -> Spread | None:
        """Return how far figures may be off, once that is known."""
        return self._window.spread_desk.of(frame)

    def follow_map(self) -> None:
        """Tell by the card whether the map lies on the body."""
        self.card.show_map(self._window.map_desk.name == SIDES)

    def _take(self, frame: Frame, found: object) -> None:
        self._known[frame] = cast(BeforeAfter, found)
        self.found.emit()

    def _show_map(self, on: bool) -> None:
        self._window.map_desk.choose(SIDES if on else "")

    def _ask(self) -> None:
        """Look for what makes the shown design even, beside; then it is asked for in the card of wishes."""
        frame = self._window.session.frame
        if frame is None or not self._window.session.is_converged or self._makes_even:
            return
        job = self._window.jobs.run(
            tr("Making left and right even"),
            lambda progress: _made_even(frame.stages, progress),
            lambda made: self._begin(frame.stages.design, cast("Evened", made)),
            self._fail,
            waited=True,
        )
        self._making = job, frame.stages.design

    @property
    def _makes_even(self) -> bool:
        """Whether it is looked for already; a second press asks for nothing more."""
        return self._making is not None and self._making[0].wanted

    def _fail(self, error: Exception) -> None:
        self._making = None
        self._window.notifications.error(error)

    def _begin(self, design: Design, made: Evened) -> None:
        """Fill the wishes in; what has to be parted for them is parted when they are taken, not before."""
        self._making = None
        if design is not self._window.session.design:
            return  # the wishes would be those of another one
        if not made.worth:
            self._window.notifications.info(*left_as_it_is(made.gained, made.lost))
            return
        # What was found keeps elastics to a limit, and no estimates.
        limit = None if design.worn_elastics() else math.inf
        if not made.parted:
            self._window.ask_desk.begin(made.goals, limit=limit)
            return
        template = read_template(design.template)
        titles = listed(parted_titles(design, made.parted))
        said = tr("Left and right apart: {lines}").format(lines=titles)
        self._window.ask_desk.begin(made.goals, lambda before: parted(before, template), said, limit)


def _made_even(stages: Stages, progress: Progress) -> Evened:
    """Return what makes a design even; the search is loaded when it is asked for, not at the start."""
    from core.analysis.symmetry.balance import make_even  # noqa: PLC0415

    return make_even(stages, progress=progress)
