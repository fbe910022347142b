"""The menu of the view: short, with maps and tabs by name; no tool is lit that does nothing."""

from __future__ import annotations

import pytest
from window_tools import Script, run_main, settled, undrawn

from app.gui.main_window import MainWindow

pytestmark = pytest.mark.usefixtures("empty_house")


def test_the_menu_of_the_view_is_short_and_maps_and_tabs_are_asked_for_by_name() -> None:
    def script(window: MainWindow) -> Script:
        undrawn(window)
        yield settled(window)
        held = [each for each in window.actions_.menus["view"].actions() if not each.isSeparator()]
        assert len(held) <= 13
        asked = {action.text(): action for _, action in window.actions_.all()}
        asked["Strain"].trigger()
        assert window.maps_controller.name == "strain"
        window.maps_controller.choose("displacement")
        assert asked["Displacement"].isChecked()
        asked["No map"].trigger()
        assert window.maps_controller.name == ""
        asked["History"].trigger()
        assert window.history.isVisible()
        ghost = window.view.compare.actions_by_name["ghost"]
        assert ghost.isEnabled()
        window.view.compare_by("before")
        assert not ghost.isEnabled(), "a fringe behind the body at rest cannot be seen"

    run_main([], script)
