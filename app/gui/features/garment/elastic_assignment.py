"""Elastics of lines: lines are made of one, as one undo step, with the lift before and after."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from PySide6.QtCore import QObject

from app.gui.features.garment.elastic_offer import ElasticOffer, ElasticRequest
from app.gui.features.garment.panel import GarmentPanel
from app.gui.session.jobs import Job
from app.i18n.catalog import number, tr
from app.presenters.bust_shift import up_text
from app.presenters.elastics import title_of
from app.presenters.lines import row_title
from core.document.design import Design
from core.document.elastic import Elastic
from core.garment.elastic_options import KEEP_FIT, ElasticOption, Outcome

if TYPE_CHECKING:
    from app.gui.context import AppContext

LIFT_TOLD = 0.2
"""From so much on it is told that the bust points stand lower or higher than before [mm]."""


class ElasticAssignmentController(QObject):
    """Make lines of elastics, as one undo step.

    The length of a line is then that of its elastic unstretched; see ``elastic_options`` for what
    is kept. What was asked for goes with the design it was asked of: another document, variant or an undo
    lets go of it.
    """

    def __init__(self, context: AppContext, panel: GarmentPanel) -> None:
        super().__init__(context.session)
        self._context, self._session = context, context.session
        self.offer = ElasticOffer(context, self._use)
        self.offer.elastics_requested.connect(panel.elastics_requested)
        self._job: Job | None = None
        self._asked: Design | None = None
        self._variant, self._index = "", 0
        panel.elastic_requested.connect(self.show)
        panel.all_requested.connect(self.show_all)
        panel.stretched.connect(self.stretch)
        self._session.opened.connect(lambda *_: self._let_go())
        self._session.undo_stack.indexChanged.connect(self._follow)

    def show(self, name: str) -> None:
        """Show elastics for a line and its linked partner."""
        design = self._session.design
        if design is not None:
            self._open(design.linked_lines(name), design.line_settings(name).elastic)

    def show_all(self) -> None:
        """Show elastics for all lines of the cut list: active ones, and bands on fixed points."""
        frame, design = self._session.frame, self._session.design
        if frame is not None and design is not None:
            still = {line.name for line in frame.stages.model.lines if not line.constrains}
            names = tuple(sorted(design.active_lines() | still))
            made = {design.line_settings(name).elastic for name in names}
            self._open(names, made.pop() if len(made) == 1 else None)

    def choose(self, names: tuple[str, ...], elastic: Elastic | None) -> None:
        """Make lines of an elastic, or of nothing in particular, as soon as its effect is computed."""
        frame, design = self._session.frame, self._session.design
        if frame is None or design is None:
            return
        self._context.jobs.cancel(self._job)
        self._asked, self._variant = design, self._shown_variant()
        asked, mode = ElasticRequest(frame, design, names), self.offer.mode
        self._job = self._context.jobs.run(
            tr("Computing cut length…"),
            lambda progress: asked.option(elastic, mode),
            lambda option: self._take(asked, elastic, cast(ElasticOption, option)),
            self._context.notifications.error,
            waited=True,
        )

    def stretch(self, name: str, share: float) -> None:
        """Stretch the elastic of a line on points that do not move by ``share`` [1]."""
        design = self._session.design
        if design is None:
            return
        words = tr("{line}: elongation {percent} %")
        sentence = words.format(line=row_title(name, design), percent=number(100.0 * share))
        self._session.edit(lambda before: before.with_linked(name, 1.0 / (1.0 + share)), sentence)

    def _open(self, names: tuple[str, ...], chosen: str | None) -> None:
        frame, design = self._session.frame, self._session.design
        if frame is not None and design is not None:
            self.offer.open(ElasticRequest(frame, design, names), chosen)

    def _shown_variant(self) -> str:
        return self._session.document.shown if self._session.document is not None else ""

    def _let_go(self) -> None:
        self._context.jobs.cancel(self._job)
        self.offer.close()

    def _follow(self, index: int) -> None:
        """Release what is looked for once another variant is shown, or what it was asked of is undone."""
        undone = index < self._index and self._session.design is not self._asked
        self._index = index
        if undone or self._shown_variant() != self._variant:
            self._context.jobs.cancel(self._job)

    def _take(self, asked: ElasticRequest, elastic: Elastic | None, option: ElasticOption) -> None:
        if option.outcome is not None or self._session.design is not asked.design:
            self._use(asked, option.outcome, elastic)
        elif option.problem is not None:
            self._context.notifications.error(option.problem)

    def _use(self, asked: ElasticRequest, outcome: Outcome | None, elastic: Elastic | None) -> None:
        """Make the lines of an elastic, and show what became of the lift where the fit is kept.

        What was computed of a design that was edited meanwhile is computed again.
        """
        now = self._session.design
        if now is None:
            return
        if now is not asked.design or outcome is None:
            gone = {each.name for each in asked.design.own_lines} - {each.name for each in now.own_lines}
            names = tuple(name for name in asked.names if name not in gone)
            if names:
                self.choose(names, elastic)
            return
        if _is_made(asked, outcome, elastic):
            return
        words = tr("{line}: {elastic}") if elastic else tr("{line}: no elastic")
        text = words.format(line=asked.title(), elastic=title_of(elastic))
        self._session.edit(lambda _: outcome.design, text)
        if self._session.design is outcome.design and self._reshapes(asked):
            tone = "ok" if abs(outcome.lift - asked.lift) < LIFT_TOLD else "warn"
            words = _told(asked.lift, outcome.lift, bool(elastic))
            self._context.notifications.show(tone, tr("{text}.").format(text=text), words)

    def _reshapes(self, asked: ElasticRequest) -> bool:
        """Return whether an elastic changes how the lines act, with the fit kept."""
        if self.offer.mode != KEEP_FIT or asked.design.line_hold == "held":
            return False
        moving = {line.name for line in asked.frame.stages.model.lines if line.constrains}
        return bool(moving & asked.design.active_lines() & set(asked.names))


def _is_made(asked: ElasticRequest, outcome: Outcome, elastic: Elastic | None) -> bool:
    """Return whether the lines are made of the elastic already, so that a search would only add noise."""
    made = {each.name: each for each in asked.design.elastics}
    alike = all(made.get(asked.design.line_settings(name).elastic) == elastic for name in asked.names)
    return alike and outcome.design.active_lines() == asked.design.active_lines()


def _told(before: float, after: float, cut: bool) -> str:
    """Return in a sentence what stayed and what did not."""
    if abs(after - before) < LIFT_TOLD:
        same = tr("Cut length adjusted; length on body and lift unchanged.")
        return same if cut else tr("Set length adjusted; length on body and lift unchanged.")
    words = tr("Bust point height changed from {before} to {after}; adjust the length if needed.")
    return words.format(before=up_text(before), after=up_text(after))
