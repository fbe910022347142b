"""Elastics offered for lines: the effect of each is computed in jobs while the chooser is open."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, cast

from PySide6.QtCore import QObject, Signal

from app.gui.features.garment.elastic_chooser import ElasticChooser
from app.gui.session.jobs import Job
from app.i18n.catalog import joined, tr
from app.presenters.elastics import ChoiceView, advice_view, choice_view, mode_text, mode_titles
from app.presenters.lines import row_title
from app.presenters.messages import elastic_title, render
from core.document.design import Design
from core.document.elastic import Elastic
from core.errors import LineError
from core.garment.elastic_library import built_in, user_elastics
from core.garment.elastic_options import KEEP_FIT, ElasticOption, Outcome, elastic_option, outcome_of
from core.pipeline.build import Stages, build
from core.pipeline.live_solver import Frame

if TYPE_CHECKING:
    from app.gui.context import AppContext


Entry = tuple[str, Elastic | None]
"""What an elastic is called in the list, and the elastic; None is no elastic."""


Use = Callable[["ElasticRequest", Outcome, Elastic | None], None]
"""Takes an outcome for the lines that it was asked for."""


def elastic_entries(kept: Iterable[Elastic]) -> tuple[list[Entry], list[LineError]]:
    """Return the elastics, with why some tables of one's own cannot be read.

    ``kept`` are those that the project brings along. An elastic of one's own takes the place of one of the
    library of the same name.
    """
    own, problems = user_elastics()
    known = {each.name: each for each in (*built_in(), *own)}
    brought = [each for each in kept if known.get(each.name) != each]
    here, twice = tr("{name}, in this project"), tr("{name}, from this project")
    return [
        (tr("No elastic"), None),
        *((each.name, each) for each in own),
        *(
            ((twice if each.name in known else here).format(name=elastic_title(each.name)), each)
            for each in brought
        ),
        *((elastic_title(each.name), each) for each in built_in() if known[each.name] == each),
    ], problems


@dataclass
class ElasticRequest:
    """The lines ``names`` of a ``design`` for which an elastic is chosen; computed in other threads."""

    frame: Frame
    design: Design
    names: tuple[str, ...]

    @cached_property
    def stages(self) -> Stages:
        """Return the stages of the design."""
        frame, design = self.frame, self.design
        return frame.stages if frame.stages.design is design else build(design, frame.stages)

    @cached_property
    def lift(self) -> float:
        """Return the lift before an elastic is chosen [mm]. Raises LineError if nothing balances."""
        return outcome_of(self.stages).lift

    def option(self, elastic: Elastic | None, mode: str) -> ElasticOption:
        """Return what an elastic does. Raises LineError if nothing balances before."""
        assert self.lift is not None  # here, and not in the window's thread
        return elastic_option(self.stages, self.names, elastic, mode)

    def is_one(self) -> bool:
        """Return whether it is one line, or a linked pair."""
        return set(self.names) <= set(self.design.linked_lines(self.names[0]))

    def title(self) -> str:
        """Return the name of the line, or that all lines have together."""
        return row_title(self.names[0], self.design) if self.is_one() else tr("All lines")

    def heading(self) -> str:
        """Return the title of the chooser."""
        return (
            tr("Elastic for {line}").format(line=self.title())
            if self.is_one()
            else tr("Elastic for all lines")
        )


@dataclass
class _Offer:
    """What is asked, the elastics to choose from, and what is known of them by mode and place."""

    asked: ElasticRequest
    entries: list[Entry]
    known: dict[str, dict[int, ElasticOption]] = field(default_factory=dict)

    def known_in(self, mode: str) -> dict[int, ElasticOption]:
        return self.known.setdefault(mode, {})

    def missing(self, modes: tuple[str, ...], marked: int) -> tuple[str, int] | None:
        """Return which mode and place is computed next: no elastic, the ``marked`` one, and the others."""
        order = sorted(range(len(self.entries)), key=lambda at: (at != 0, at != marked))
        places = ((mode, at) for mode in modes for at in order)
        return next(((mode, at) for mode, at in places if at not in self.known_in(mode)), None)


class ElasticOffer(QObject):
    """Open the chooser and fill it; ``use`` takes what is chosen in it, ``elastics_requested`` asks for
    more.
    """

    elastics_requested = Signal()

    def __init__(self, context: AppContext, use: Use) -> None:
        super().__init__(context.session)
        self._context, self._use_outcome = context, use
        self.mode = KEEP_FIT
        self.chooser: ElasticChooser | None = None
        self._offer: _Offer | None = None
        self._job: Job | None = None

    def open(self, asked: ElasticRequest, chosen: str | None) -> None:
        """Open the chooser, the elastic called ``chosen`` marked: empty for none, None for several."""
        design = asked.design
        entries, problems = elastic_entries(design.elastics)
        self._offer = _Offer(asked, entries)
        modes = mode_titles() if design.line_hold == "spring" else []
        chooser = self.chooser = ElasticChooser(self._context.window, asked.heading(), modes)
        chooser.mode_requested.connect(self.set_mode)
        chooser.marked.connect(lambda _: self._advise())
        chooser.chosen.connect(self._use)
        chooser.elastics_requested.connect(self._leave_for_library)
        chooser.finished.connect(self._closed)
        chooser.set_problems(joined(render(each.text) for each in problems))
        self.set_mode(self.mode)
        made = {each.name: each for each in design.elastics}
        places = [at for at, (_, each) in enumerate(entries) if each == made.get(chosen or "")]
        chooser.set_current(places[0] if places and chosen is not None else -1)
        chooser.open()
        self._fill()

    def close(self) -> None:
        """Close the chooser: what it was opened for has gone."""
        if self.chooser is not None:
            self.chooser.reject()

    def set_mode(self, mode: str) -> None:
        """Choose what is kept: one of ``core.garment.elastic_options.MODES``."""
        self.mode = mode
        if self.chooser is not None and self._offer is not None:
            self.chooser.set_mode(mode, mode_text(mode, self._offer.asked.design))
            self.chooser.set_rows([self._view(at) for at in range(len(self._offer.entries))])
            self._advise()

    def _view(self, at: int) -> ChoiceView:
        assert self._offer is not None
        known, asked = self._offer.known_in(self.mode), self._offer.asked
        rigid = known[0].outcome if 0 in known else None
        return choice_view(self._offer.entries[at][0], known.get(at), rigid, asked.names, asked.design)

    def _advise(self) -> None:
        offer, chooser = self._offer, self.chooser
        if offer is not None and chooser is not None:
            titles = [title for title, _ in offer.entries]
            known = offer.known_in(self.mode)
            chooser.set_advice(
                advice_view(chooser.current, known, titles, offer.asked.names, offer.asked.design)
            )

    def _fill(self) -> None:
        """Compute what is not known yet, one elastic after the other; those of the mode shown come first."""
        offer, chooser = self._offer, self.chooser
        if offer is None or chooser is None:
            return
        held = offer.asked.design.line_hold == "held"
        missing = offer.missing((self.mode,) if held else _from(self.mode), chooser.current)
        if missing is None:
            return
        (mode, at), asked = missing, offer.asked
        elastic = offer.entries[at][1]
        self._job = self._context.jobs.run(
            tr("Computing elastics…"),
            lambda progress: asked.option(elastic, mode),
            lambda option: self._take(offer, mode, at, cast(ElasticOption, option)),
            self._fail,
        )

    def _take(self, offer: _Offer, mode: str, at: int, option: ElasticOption) -> None:
        """Show an option, unless the chooser is closed or was opened for another design meanwhile."""
        if offer is not self._offer or self.chooser is None:
            return
        if self._context.session.design is not offer.asked.design:
            self.close()
            return
        offer.known_in(mode)[at] = option
        if mode == self.mode:
            self.chooser.set_row(at, self._view(at))
            if len(offer.known_in(mode)) == len(offer.entries) or at in (0, self.chooser.current):
                self._advise()
        self._fill()

    def _fail(self, error: Exception) -> None:
        self.close()
        self._context.notifications.error(error)

    def _use(self, at: int, limited: bool) -> None:
        """Take the option at a place, at its limit if that is wished for."""
        offer = self._offer
        option = offer.known_in(self.mode).get(at) if offer is not None else None
        outcome = None if option is None else option.closest if limited else option.outcome
        if offer is None or option is None or outcome is None:
            return
        self.close()
        self._use_outcome(offer.asked, outcome, option.elastic)

    def _leave_for_library(self) -> None:
        self.close()
        self.elastics_requested.emit()

    def _closed(self) -> None:
        self._context.jobs.cancel(self._job)
        self.chooser = self._offer = self._job = None


def _from(mode: str) -> tuple[str, ...]:
    """Return the modes, this one first."""
    return (mode, *(name for name, _ in mode_titles() if name != mode))
