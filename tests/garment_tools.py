"""How tests choose elastics in the garment's tab, and read what the core says of it."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtWidgets import QMenu

from app.main_window import MainWindow
from core.cutting import CutRow, cut_list


def cut_rows(window: MainWindow) -> dict[str, CutRow]:
    frame = window.session.frame
    assert frame is not None
    return {row.line: row for row in cut_list(frame.stages, frame.control_points).rows}


def choose(window: MainWindow, line: str, kind: str, width: str = "") -> None:
    """Choose an elastic by the menu of a row."""
    window.garment.rows[line].elastic.click()
    pick(window, kind, width)


def pick(window: MainWindow, kind: str, width: str = "") -> None:
    """Choose in the menu that is open."""
    menu = open_menu(window)
    within: object = menu
    for words in (kind, width) if width else (kind,):
        assert isinstance(within, QMenu)
        item = next(each for each in within.actions() if each.text() == words)
        within = item.menu()
    item.trigger()
    menu.close()


def open_menu(window: MainWindow) -> QMenu:
    """Return the menu that is open."""
    return next(each for each in window.findChildren(QMenu) if each.isVisible())


def at_rest(window: MainWindow) -> Callable[[], bool]:
    """Nothing is solved, nothing is looked for."""
    return lambda: window.is_settled() and not window.jobs.at_work()


def made_of(window: MainWindow, *lines: str) -> Callable[[], bool]:
    """These lines, and no others, are made of elastics, and all of it is solved."""
    rests = at_rest(window)

    def made() -> bool:
        design = window.session.design
        return rests() and design is not None and set(design.worn_elastics()) == set(lines)

    return made
