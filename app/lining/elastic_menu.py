"""The elastics to choose from, as a menu: those that come with Busk by kind, one's own, the project's."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import partial

from PySide6.QtGui import QAction

from app.dress.menu import Menu
from app.dress.tip import set_tip
from app.wording.lengths import width
from app.wording.words import say, tr
from core.design_elastics import Elastic
from core.elastics import built_in, own_elastics

Choose = Callable[[Elastic | None], None]


def fill_elastics(menu: Menu, chosen: str | None, kept: Iterable[Elastic], choose: Choose) -> None:
    """Fill ``menu`` anew, the one called ``chosen`` ticked; ``kept`` are those that the project brings along.

    An empty name is no elastic, None several: then nothing is ticked.
    ``choose`` hears which one is taken, None for none.
    """
    menu.clear()
    _add(menu, tr("No elastic"), chosen == "", partial(choose, None))
    menu.addSeparator()
    own, problems = own_elastics()
    known = {each.name: each for each in (*built_in(), *own)}
    brought = [each for each in kept if known.get(each.name) != each]
    elsewhere = "" if chosen in {each.name for each in brought} else chosen
    for kind, elastics in _kinds(each for each in built_in() if known[each.name] == each).items():
        widths = menu.add_submenu(kind)
        _tick(widths.menuAction(), elsewhere in {each.name for each in elastics})
        for each in elastics:
            _add(widths, width(each.width_mm), each.name == elsewhere, partial(choose, each))
    _group(menu, tr("Your own elastics"), {each.name: each for each in own}, elsewhere, choose)
    twice = tr("{name}, as in this project")
    titles = {
        twice.format(name=say(each.name)) if each.name in known else each.name: each for each in brought
    }
    _group(menu, tr("In this project"), titles, chosen, choose)
    for problem in problems:
        action = menu.addAction(say(problem.message))
        set_tip(action, say(problem.hint))
        action.setEnabled(False)


def kind_title(elastic: Elastic) -> str:
    """Return what an elastic that comes with Busk is called without its width."""
    return say(elastic.name).removesuffix(width(elastic.width_mm)).strip()


def _kinds(elastics: Iterable[Elastic]) -> dict[str, list[Elastic]]:
    kinds: dict[str, list[Elastic]] = {}
    for each in elastics:
        kinds.setdefault(kind_title(each), []).append(each)
    return kinds


def _group(
    menu: Menu, heading: str, elastics: Mapping[str, Elastic], chosen: str | None, choose: Choose
) -> None:
    """Add elastics by what they are called here, under a heading."""
    if elastics:
        menu.addSection(heading)
    for title, each in elastics.items():
        _add(menu, title, each.name == chosen, partial(choose, each))


def _add(menu: Menu, words: str, ticked: bool, do: Callable[[], None]) -> None:
    _tick(menu.addAction(words, do), ticked)


def _tick(action: QAction, ticked: bool) -> None:
    """Tick what is chosen; empty boxes beside all the others would say that several may be."""
    action.setCheckable(ticked)
    action.setChecked(ticked)
