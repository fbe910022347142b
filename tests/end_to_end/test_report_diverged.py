"""Runs that leave no body to sew for, through the real main(): what the sheet and the pressures say then."""

from __future__ import annotations

from pathlib import Path

import pytest
from window_tools import Script, run_bodiless, settled

from app.gui.main_window import MainWindow
from core.garment.elastic_library import find_elastic

pytestmark = pytest.mark.usefixtures("empty_house")


def test_of_a_run_that_ran_away_there_is_no_sheet_and_no_light(mannequin: Path) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.session.edit(
            lambda design: design.with_line("mid-bust", 0.7).with_elastic(
                "mid-bust", find_elastic("plush 12")
            ),
            "worn",
        )
        window.navigation.show_panel("garment")
        window.pressure_controller.follow()
        card = window.pressure_controller.card
        yield lambda: settled(window)() and window.pressure_controller.shown is not None
        assert window.pressure_controller.shown.rows[0].light
        window.session.change({"volume": "conventional", "gain": 10.0}, "too much")
        yield lambda: window.session.frame.verdict.motion == "diverging" and settled(window)()
        yield lambda: not window.jobs.at_work()
        assert card.says.text() == "Diverged: do not use these values for production."
        assert window.pressure_controller.shown is None, "nor does it leave with the cut list"
        desk = window.report_controller
        desk.open()
        yield lambda: "The solver diverged" in desk.page.state.text()
        assert desk.handout is None
        assert not any(press.isEnabled() for press in desk.page.does.values())
        window.actions_.undo.trigger()
        yield desk.page.does["pdf"].isEnabled
        assert desk.page.state.text() == ""

    assert run_bodiless([str(mannequin)], script) == 0
