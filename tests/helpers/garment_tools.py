"""How tests choose elastics in the garment's tab, and read what the core says of it."""

from __future__ import annotations

from collections.abc import Callable

from window_tools import Script

from app.gui.features.garment.elastic_chooser import ElasticChooser
from app.gui.main_window import MainWindow
from core.garment.cut_list import CutRow, cut_list


def cut_rows(window: MainWindow) -> dict[str, CutRow]:
    frame = window.session.frame
    assert frame is not None
    return {row.line: row for row in cut_list(frame.stages, frame.control_points).rows}


def choose(window: MainWindow, line: str, elastic: str) -> Script:
    """Choose an elastic in the chooser of a row."""
    window.garment.rows[line].elastic.click()
    yield from pick(window, elastic)


def pick(window: MainWindow, elastic: str) -> Script:
    """Choose in the chooser that is open, once the effect is computed."""
    chooser = chooser_of(window)
    chooser.set_current([view.title for view in chooser.views()].index(elastic))
    yield chooser.use.isEnabled
    chooser.use.click()


def mark(window: MainWindow, elastic: str) -> Script:
    """Mark an elastic in the chooser that is open, and wait until all are computed."""
    chooser = chooser_of(window)
    chooser.set_current([view.title for view in chooser.views()].index(elastic))
    yield lambda: not window.jobs.at_work()


def chooser_of(window: MainWindow) -> ElasticChooser:
    """Return the chooser that is open."""
    chooser = window.elastic_assignment_controller.offer.chooser
    assert chooser is not None
    return chooser


def at_rest(window: MainWindow) -> Callable[[], bool]:
    """Nothing is solved, nothing is looked for."""
    return lambda: window.is_settled() and not window.jobs.at_work()


def made_of(window: MainWindow, *lines: str) -> Callable[[], bool]:
    """These lines, and no others, are made of elastics, and all of it is solved."""
    rests = at_rest(window)

    def made() -> bool:
        design = window.session.design
        return rests() and design is not None and set(design.active_elastics()) == set(lines)

    return made
