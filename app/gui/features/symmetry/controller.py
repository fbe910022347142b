"""Left and right: how they differ, and the targets that make them even."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, cast

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QWidget

from app.gui.features.symmetry.card import SymmetryCard
from app.gui.session.frame_cache import FrameCache
from app.gui.session.jobs import Job
from app.i18n.catalog import listed, tr
from app.presenters.status import invalid_reason
from app.presenters.symmetry import map_note, not_balanced_reason, split_titles, symmetry_view
from core.analysis.symmetry.compare import BeforeAfter, compare_sides
from core.analysis.symmetry.split_sides import split_sides
from core.control_mesh.template import read_template
from core.document.design import Design
from core.measurements.uncertain_value import OutputUncertainties
from core.pipeline.build import Stages
from core.pipeline.live_solver import Frame
from core.progress import Progress

if TYPE_CHECKING:
    from app.gui.context import AppContext
    from core.analysis.symmetry.balance import BalanceResult

SIDES = "sides"
"""The map Left and right."""


class SymmetryController(QObject):
    """Compare left and right of frames, and show that in a card of the panel ``host`` and under the map.

    ``uncertainty_of`` returns the uncertainties of a frame once they are known. ``changed`` is emitted when
    another comparison is known, ``map_requested`` with the name of a map or none, and ``targets_proposed``
    with goals, what to make of the design first, how that is called and a limit of pressure.
    """

    changed = Signal()
    map_requested = Signal(str)
    targets_proposed = Signal(object, object, str, object)

    def __init__(
        self,
        context: AppContext,
        host: QWidget,
        uncertainty_of: Callable[[Frame], OutputUncertainties | None],
    ) -> None:
        super().__init__(context.session)
        self._context, self._session = context, context.session
        self._host, self._uncertainty_of = host, uncertainty_of
        self.card = SymmetryCard()
        self._shown: tuple[Frame, BeforeAfter] | None = None
        self._balancing: tuple[Job, Design] | None = None
        title = tr("Comparing left and right…")
        self._cache = FrameCache(
            context.session,
            context.jobs,
            title,
            lambda frame, _: compare_sides(frame.stages, *frame.region_points),
            failed=context.notifications.error,
            stopped=lambda: context.notifications.stopped(title),
        )
        self._cache.changed.connect(self.changed)
        self.changed.connect(self.follow)
        self.card.shown.connect(lambda on: self.map_requested.emit(SIDES if on else ""))
        self.card.requested.connect(self.balance)

    def of(self, frame: Frame) -> BeforeAfter | None:
        """Return how left and right of a frame differ; if that is not known yet it is computed."""
        return self._cache.request(frame)

    def note(self, frame: Frame, after: bool) -> str:
        """Return the note of the map's legend on a frame in ml, once it is known."""
        return map_note(self.of(frame), after and not invalid_reason(frame))

    def open(self) -> None:
        """Show the card, and compare again what was stopped."""
        self._cache.retry()
        self.follow()

    def follow(self) -> None:
        """Update the card, if visible; values of a previous shape are faint."""
        frame, design = self._session.frame, self._session.design
        if self._balancing is not None and self._balancing[1] is not design:
            self._context.jobs.cancel(self._balancing[0])  # it would balance another design
            self._balancing = None
        if frame is None or not self._host.isVisible():
            return
        known = self.of(frame)
        if known is not None:
            self._shown = frame, known
        elif self._shown is not None and self._shown[0].stages.body is not frame.stages.body:
            self._shown = None
        if self._shown is None:
            self.card.show_summary(None, faint=False)
            return
        of, compared = self._shown
        summary = symmetry_view(compared, of.stages, invalid_reason(of), self._uncertainty_of(of))
        self.card.show_summary(summary, faint=of is not frame)

    def show_map(self, name: str) -> None:
        """Show by the card whether its map lies on the body."""
        self.card.show_map(name == SIDES)

    # -- balancing

    @property
    def is_balancing(self) -> bool:
        """Return whether the targets are being computed; a second press asks for nothing more."""
        return self._balancing is not None and self._balancing[0].wanted

    def balance(self) -> None:
        """Compute what makes the shown design even; then it is proposed as targets."""
        frame = self._session.frame
        if frame is None or not self._session.is_converged or self.is_balancing:
            return
        job = self._context.jobs.run(
            tr("Balancing sides…"),
            lambda progress: _balance(frame.stages, progress),
            lambda made: self._propose(frame.stages.design, cast("BalanceResult", made)),
            self._fail,
            waited=True,
        )
        self._balancing = job, frame.stages.design

    def _fail(self, error: Exception) -> None:
        self._balancing = None
        self._context.notifications.error(error)

    def _propose(self, design: Design, made: BalanceResult) -> None:
        """Propose targets; what has to be split for them is split when they are applied, not before."""
        self._balancing = None
        if design is not self._session.design:
            return  # the targets would be those of another one
        if not made.is_worthwhile:
            self._context.notifications.info(*not_balanced_reason(made.gain, made.loss))
            return
        # What was found keeps elastics to a limit, and no estimates.
        limit = None if design.active_elastics() else math.inf
        if not made.split:
            self.targets_proposed.emit(made.goals, None, "", limit)
            return
        template = read_template(design.template)
        titles = listed(split_titles(design, made.split))
        text = tr("Left and right unlinked: {lines}").format(lines=titles)
        self.targets_proposed.emit(
            made.goals, lambda before: split_sides(before, template, made.split), text, limit
        )


def _balance(stages: Stages, progress: Progress) -> BalanceResult:
    """Return what makes a design even; the search is imported when it is asked for, not at the start."""
    from core.analysis.symmetry.balance import balance_sides  # noqa: PLC0415

    return balance_sides(stages, progress=progress)
