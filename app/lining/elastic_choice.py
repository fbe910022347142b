"""The desk of elastics: what lines are made of is chosen, and the body stays as it is meanwhile."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Set
from functools import partial, reduce
from typing import TYPE_CHECKING, cast

from PySide6.QtCore import QObject
from PySide6.QtGui import QActionGroup
from PySide6.QtWidgets import QMenu, QWidget

from app.asking.jobs import Job
from app.dress.parts import pull_down
from app.lining.elastic_menu import fill_elastics
from app.presenting.lines import row_title
from app.wording.words import number, say, tr
from core.design import Design
from core.design_elastics import Elastic
from core.live import Frame
from core.pipeline import Stages, build
from core.sewing.as_worn import made_as_worn

if TYPE_CHECKING:
    from app.main_window import MainWindow

FIRST_STRETCH = 0.2
"""How far a band on points that do not move is stretched at first [1]: a start to go on from, no advice."""

Elastics = dict[str, Elastic | None]
"""What lines are to be made of, by name; None is nothing in particular."""

Dress = Callable[[Design], Design]


class ElasticChoice(QObject):
    """Makes lines of elastics, as one undo step.

    The length of a line is then that of its elastic unstretched. So that the body stays as it is, that length
    is looked for with which the same is reached, in a job; or it is kept, if that is wished for.
    """

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window, self._session = window, window.session
        self.reach = True
        self._job: Job | None = None
        self._menu = QMenu(window)
        self._menu.setToolTipsVisible(True)
        window.garment.elastic_asked.connect(self.show_menu)
        window.lines.elastic_asked.connect(self.show_menu)
        window.garment.all_asked.connect(self.show_menu_of_all)
        window.garment.stretched.connect(self.stretch)

    def show_menu(self, name: str, under: QWidget) -> None:
        """Offer elastics for a line and its linked partner."""
        design = self._session.design
        if design is not None:
            self._offer(design.linked(name), design.traits_of(name).elastic, under)

    def show_menu_of_all(self, under: QWidget) -> None:
        """Offer elastics for all worn lines."""
        design = self._session.design
        if design is not None:
            self._offer(tuple(sorted(design.worn())), "", under)

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
            self._job = self._window.jobs.run(
                tr("Finding how long to cut it"),
                lambda progress: made_as_worn(_stages(frame, design), worn),
                lambda made: self._take(names, elastic, dress, design, cast(Design, made)),
                self._window.desk.show_failure,
                waited=True,
            )
        else:
            self._commit(names, elastic, dress, "")

    def stretch(self, name: str, share: float) -> None:
        """Stretch the elastic of a line on points that do not move by ``share`` [1]."""
        design = self._session.design
        if design is None:
            return
        words = tr("{line} stretched by {percent} %")
        said = words.format(line=row_title(name, design), percent=number(100.0 * share))
        self._session.edit(lambda before: before.with_linked(name, 1.0 / (1.0 + share)), said)

    def _offer(self, names: tuple[str, ...], chosen: str, under: QWidget) -> None:
        """Open the menu under a button."""
        design = self._session.design
        assert design is not None
        fill_elastics(self._menu, chosen, design.elastics, partial(self.choose, names))
        self._menu.addSeparator()
        group = QActionGroup(self._menu)
        for reach, words, tip in (
            (True, tr("It reaches the same: the body hardly moves"), ""),
            (False, tr("It is as long unstretched: the body changes"), ""),
        ):
            action = group.addAction(words)
            action.setToolTip(tip)
            action.setCheckable(True)
            action.setChecked(reach == self.reach)
            action.triggered.connect(lambda _=False, reach=reach: setattr(self, "reach", reach))
            self._menu.addAction(action)
        self._menu.addSeparator()
        self._menu.addAction(tr("Elastics…"), self._window.garment.library_asked.emit)
        pull_down(self._menu, under)

    def _take(
        self, names: tuple[str, ...], elastic: Elastic | None, dress: Dress, asked: Design, made: Design
    ) -> None:
        """Take the lengths that were found, or look again if something was edited meanwhile."""
        if self._session.design is not asked:
            self.choose(names, elastic)
            return
        ratios = {name: _shared_ratio(made, asked.linked(name)) for name in names if name in made.worn()}
        found = [name for name, ratio in ratios.items() if ratio != asked.ratio(name)]

        def remade(before: Design) -> Design:
            # Through the door that a locked line keeps shut.
            return reduce(lambda d, name: d.with_line(name, ratios[name]), found, dress(before))

        cut = tr("Cut to reach the same length; the skin beside it may shift by 1 to 2 mm.")
        bare = tr("Set to reach the same length; the skin beside it may shift by 1 to 2 mm.")
        self._commit(names, elastic, remade, cut if elastic else bare)

    def _commit(self, names: tuple[str, ...], elastic: Elastic | None, edit: Dress, said: str) -> None:
        before = self._session.design
        assert before is not None
        line = row_title(names[0], before) if set(names) <= set(before.linked(names[0])) else tr("All lines")
        words = tr("{line} made of {elastic}") if elastic else tr("{line} without an elastic")
        text = words.format(line=line, elastic=say(elastic.name) if elastic else "")
        self._session.edit(edit, text)
        if self._session.design is not before and said:
            self._window.notices.show_notice("ok", tr("{text}.").format(text=text), said)


def _stages(frame: Frame, design: Design) -> Stages:
    return frame.stages if frame.stages.design is design else build(design, frame.stages)


def _shared_ratio(made: Design, pair: tuple[str, ...]) -> float:
    """Return the mean of both sides: set apart by a hair, a linked pair would be none any more."""
    return sum(made.ratio(name) for name in pair) / len(pair)


def _put_on(design: Design, names: Iterable[str], still: Set[str]) -> Design:
    """Return the design in which bands on points that do not move are worn while they are of an elastic."""
    for name in [each for each in names if each in still]:
        made = bool(design.traits_of(name).elastic)
        if made != (name in design.worn()):
            design = design.with_line(name, 1.0 / (1.0 + FIRST_STRETCH) if made else None)
    return design
