"""The desk of elastics: what lines are made of is chosen, and the body stays as it is meanwhile."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Set
from dataclasses import dataclass
from functools import partial, reduce
from typing import TYPE_CHECKING, cast

from PySide6.QtCore import QObject
from PySide6.QtGui import QActionGroup
from PySide6.QtWidgets import QWidget

from app.asking.jobs import Job
from app.dress.menu import Menu, pull_down
from app.lining.elastic_menu import fill_elastics
from app.presenting.bust import move_between, up_words
from app.presenting.lines import row_title
from app.wording.words import number, say, tr
from core.design import Design
from core.design_elastics import Elastic
from core.live import Frame
from core.pipeline import Stages, build
from core.sewing.as_worn import made_as_worn, reached_points

if TYPE_CHECKING:
    from app.main_window import MainWindow

FIRST_STRETCH = 0.2
"""How far a band on points that do not move is stretched at first [1]: a start to go on from, no advice."""

LIFT_TOLD = 0.2
"""From so much on it is told that the bust points stand lower or higher than before [mm]."""

Elastics = dict[str, Elastic | None]
"""What lines are to be made of, by name; None is nothing in particular."""

Dress = Callable[[Design], Design]


class ElasticChoice(QObject):
    """Makes lines of elastics, as one undo step.

    The length of a line is then that of its elastic unstretched. So that the body stays as it is, that length
    is looked for with which the same is reached, in a job; or it is kept, if that is wished for. What was
    asked for goes with the design it was asked of: another document, variant or an undo lets go of it.
    """

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window, self._session = window, window.session
        self.reach = True
        self._job: Job | None = None
        self._asked: Design | None = None
        self._variant, self._index = "", 0
        self._menu = Menu(window)
        window.garment.elastic_asked.connect(self.show_menu)
        window.lines.elastic_asked.connect(self.show_menu)
        window.garment.all_asked.connect(self.show_menu_of_all)
        window.garment.stretched.connect(self.stretch)
        self._session.opened.connect(lambda *_: window.jobs.cancel(self._job))
        self._session.undo_stack.indexChanged.connect(self._follow)

    def show_menu(self, name: str, under: QWidget) -> None:
        """Offer elastics for a line and its linked partner."""
        design = self._session.design
        if design is not None:
            self._offer(design.linked(name), design.traits_of(name).elastic, under)

    def show_menu_of_all(self, under: QWidget) -> None:
        """Offer elastics for all lines of the cut list: those worn, and bands on points that do not move."""
        frame, design = self._session.frame, self._session.design
        if frame is not None and design is not None:
            still = {line.name for line in frame.stages.model.lines if not line.constrains}
            names = tuple(sorted(design.worn() | still))
            made = {design.traits_of(name).elastic for name in names}
            self._offer(names, made.pop() if len(made) == 1 else None, under)

    def choose(self, names: tuple[str, ...], elastic: Elastic | None) -> None:
        """Make lines of an elastic, or of nothing in particular."""
        frame, design = self._session.frame, self._session.design
        if frame is None or design is None:
            return
        made = {each.name: each for each in design.elastics}
        still = {line.name for line in frame.stages.model.lines if not line.constrains}
        alike = all(made.get(design.traits_of(name).elastic) == elastic for name in names)
        if alike and (elastic is None or still.intersection(names) <= design.worn()):
            return
        worn: Elastics = {name: elastic for name in names if name in design.worn() - still}

        def dress(before: Design) -> Design:
            made = reduce(lambda d, name: d.with_elastic(name, elastic), names, before)
            return _put_on(made, names, still)

        if self.reach and worn and design.line_hold == "spring":
            self._window.jobs.cancel(self._job)
            self._asked, self._variant = design, self._shown_variant()
            self._job = self._window.jobs.run(
                tr("Finding how long to cut it"),
                lambda progress: _made(_stages(frame, design), worn),
                lambda made: self._take(names, elastic, dress, cast(_Made, made)),
                self._window.desk.show_failure,
                waited=True,
            )
        else:
            self._commit(names, elastic, dress)

    def stretch(self, name: str, share: float) -> None:
        """Stretch the elastic of a line on points that do not move by ``share`` [1]."""
        design = self._session.design
        if design is None:
            return
        words = tr("{line} stretched by {percent} %")
        said = words.format(line=row_title(name, design), percent=number(100.0 * share))
        self._session.edit(lambda before: before.with_linked(name, 1.0 / (1.0 + share)), said)

    def _offer(self, names: tuple[str, ...], chosen: str | None, under: QWidget) -> None:
        """Open the menu under a button."""
        design = self._session.design
        assert design is not None
        fill_elastics(self._menu, chosen, design.elastics, partial(self.choose, names))
        self._menu.addSeparator()
        group = QActionGroup(self._menu)
        for reach, words in (
            (True, tr("It reaches the same length: lift may change a little")),
            (False, tr("It is as long unstretched: the body changes")),
        ):
            action = group.addAction(words)
            action.setCheckable(True)
            action.setChecked(reach == self.reach)
            action.triggered.connect(lambda _=False, reach=reach: setattr(self, "reach", reach))
            self._menu.addAction(action)
        self._menu.addSeparator()
        self._menu.addAction(tr("Elastics…"), self._window.garment.elastics_asked.emit)
        pull_down(self._menu, under)

    def _shown_variant(self) -> str:
        return self._session.document.shown if self._session.document is not None else ""

    def _follow(self, index: int) -> None:
        """Let go of what is looked for once another variant is shown, or what it was asked of is undone."""
        undone = index < self._index and self._session.design is not self._asked
        self._index = index
        if undone or self._shown_variant() != self._variant:
            self._window.jobs.cancel(self._job)

    def _take(self, names: tuple[str, ...], elastic: Elastic | None, dress: Dress, made: _Made) -> None:
        """Take the lengths that were found, or look again if something was edited meanwhile."""
        asked, now = self._asked, self._session.design
        assert asked is not None
        assert now is not None
        if now is not asked:
            gone = {each.name for each in asked.own_lines} - {each.name for each in now.own_lines}
            self.choose(tuple(name for name in names if name not in gone), elastic)
            return
        ratios = {name: made.design.ratio(name) for name in names if name in made.design.worn()}
        found = [name for name, ratio in ratios.items() if ratio != asked.ratio(name)]

        def remade(before: Design) -> Design:
            # Through the door that a locked line keeps shut.
            return reduce(lambda d, name: d.with_line(name, ratios[name]), found, dress(before))

        self._commit(names, elastic, remade, made)

    def _commit(
        self, names: tuple[str, ...], elastic: Elastic | None, edit: Dress, made: _Made | None = None
    ) -> None:
        before = self._session.design
        assert before is not None
        line = row_title(names[0], before) if set(names) <= set(before.linked(names[0])) else tr("All lines")
        words = tr("{line} made of {elastic}") if elastic else tr("{line} without an elastic")
        text = words.format(line=line, elastic=say(elastic.name) if elastic else "")
        self._session.edit(edit, text)
        if self._session.design is not before and made is not None:
            tone = "warn" if made.lifts_otherwise else "ok"
            self._window.notices.show_notice(tone, tr("{text}.").format(text=text), made.told(bool(elastic)))


@dataclass(frozen=True)
class _Made:
    """A ``design`` whose lines reach what they reached, and the lift ``before`` and ``after`` [mm]."""

    design: Design
    before: float
    after: float

    @property
    def lifts_otherwise(self) -> bool:
        """Whether the lift is so far another one that it must be told."""
        return abs(self.after - self.before) >= LIFT_TOLD

    def told(self, cut: bool) -> str:
        """Return in a sentence what stayed and what did not."""
        if not self.lifts_otherwise:
            same = tr("Cut to reach the same length; the lift stays.")
            return same if cut else tr("Set to reach the same length; the lift stays.")
        words = tr("It reaches the same length, but bust points {before} are now {after}: set it to taste.")
        return words.format(before=up_words(self.before), after=up_words(self.after))


def _made(stages: Stages, elastics: Elastics) -> _Made:
    design = made_as_worn(stages, elastics)
    return _Made(design, _lift(stages), _lift(build(design, stages)))


def _lift(stages: Stages) -> float:
    """Return how far the bust points stand above where they are at rest, in the exact answer [mm]."""
    return move_between(stages.rest_marks, stages.watch(reached_points(stages))).mean.up


def _stages(frame: Frame, design: Design) -> Stages:
    return frame.stages if frame.stages.design is design else build(design, frame.stages)


def _put_on(design: Design, names: Iterable[str], still: Set[str]) -> Design:
    """Return the design in which bands on points that do not move are worn while they are of an elastic."""
    for name in [each for each in names if each in still]:
        made = bool(design.traits_of(name).elastic)
        if made != (name in design.worn()):
            design = design.with_line(name, 1.0 / (1.0 + FIRST_STRETCH) if made else None)
    return design
