"""The garment in the window: elastics are chosen, the body stays, and the lengths to cut are the core's."""

from __future__ import annotations

import pytest
from PySide6.QtWidgets import QMenu
from window_tools import Script, run_main, settled, undrawn

from app.main_window import MainWindow
from app.wording.words import number
from core.cutting import CutRow, cut_list

pytestmark = pytest.mark.usefixtures("empty_house")

SAME = 0.2
"""By how much a reached length may differ once an elastic is chosen, as the window states [mm]."""


def cut_rows(window: MainWindow) -> dict[str, CutRow]:
    frame = window.session.frame
    assert frame is not None
    return {row.line: row for row in cut_list(frame.stages, frame.control_points).rows}


def choose(window: MainWindow, line: str, kind: str, width: str = "") -> None:
    """Choose an elastic by the menu of a row."""
    window.garment.rows[line].elastic.click()
    menu = next(each for each in window.findChildren(QMenu) if each.isVisible())
    item = next(each for each in menu.actions() if each.text() == kind)
    if width:
        item = next(each for each in item.menu().actions() if each.text() == width)
    item.trigger()
    menu.close()


def at_rest(window: MainWindow):
    """Nothing is solved, nothing is looked for."""
    return lambda: window.is_settled() and not window.jobs.at_work()


def test_an_elastic_is_chosen_and_the_length_to_cut_is_that_of_the_core() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        undrawn(window)
        window.lines_desk.commit_length("full-bust", 0.985)
        window.inspector.open("garment")
        yield at_rest(window)
        garment, before = window.garment, cut_rows(window)
        assert garment.rows["mid-bust"].cut.text() == "–"
        assert garment.rows["mid-bust"].tension.text() == number(before["mid-bust"].tension_n, 1)
        steps = window.session.undo_stack.count()
        for line, kind, width in (
            ("mid-bust", "Strap", "15 mm"),
            ("full-bust", "Bra band, plush back", "12 mm"),
            ("under-bust", "Bra band, plush back", "18 mm"),
        ):
            choose(window, line, kind, width)
            yield lambda line=line: line in window.session.design.worn_elastics()
            yield at_rest(window)
        after = cut_rows(window)
        assert window.session.undo_stack.count() == steps + 3
        assert window.session.undo_stack.undoText() == "Under-bust made of Bra band, plush back 18 mm"
        for line in ("mid-bust", "full-bust"):
            assert after[line].reached_front_mm == pytest.approx(before[line].reached_front_mm, abs=SAME)
        for line, row in after.items():
            shown = garment.rows[line]
            assert shown.cut.text() == number(row.cut_mm, 0)
            assert shown.tension.text() == number(row.tension_n, 1)
            assert row.elastic in shown.elastic.accessibleName()
        assert garment.rows["mid-bust"].stretch.text() == f"+{100 * after['mid-bust'].elongation:.0f} %"
        window.session.undo_stack.setIndex(steps)
        yield at_rest(window)
        assert not window.session.design.elastics
        assert garment.rows["mid-bust"].cut.text() == "–"

    run_main([], script)
