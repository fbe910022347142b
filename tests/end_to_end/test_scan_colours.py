"""The colours of a scan in the window: shown where landmarks are placed, on the reshaped body on demand."""

from pathlib import Path

import numpy as np
import pytest
from coloured_scans import RED, painted_sample
from window_tools import Script, run_undrawn, settled

from app.gui.main_window import MainWindow

pytestmark = pytest.mark.usefixtures("empty_house")


def reddish(window: MainWindow) -> float:
    """The share of the vertices of the body's left side that are drawn red."""
    body = window.view.viewport.scene.body
    assert body is not None
    drawn = body.colours[body.rest.vertices[:, 0] > 5.0].astype(int)
    away = np.abs(drawn / drawn.max(axis=1, keepdims=True) - np.array(RED) / max(RED))
    return float((away < 0.05).all(axis=1).mean())


def test_the_colours_of_a_scan_are_shown_where_landmarks_are_placed(tmp_path: Path) -> None:
    (tmp_path / "painted.ply").write_bytes(painted_sample())

    def script(window: MainWindow) -> Script:
        yield settled(window)
        action = window.view.tools.actions_by_name["colours"]
        assert action.isEnabled()
        window.navigation.show_step("landmarks")
        assert action.isChecked()
        assert reddish(window) > 0.95
        window.navigation.show_step("lines")
        assert not action.isChecked()
        assert reddish(window) < 0.05
        window.lines_controller.commit_length("mid-bust", 0.95)
        yield settled(window)
        action.trigger()
        assert reddish(window) > 0.95  # they follow the skin
        window.maps_controller.choose("displacement")
        yield lambda: reddish(window) < 0.5
        window.view.compare_by("side")
        beside = window.view.beside.bodies[1].viewport.scene
        assert beside.is_visible("colours")
        assert "with colours" in window.scan._triangles.text()

    run_undrawn([str(tmp_path / "painted.ply")], script)


def test_without_colours_there_is_nothing_to_show() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.navigation.show_step("landmarks")
        assert not window.view.tools.actions_by_name["colours"].isEnabled()
        assert reddish(window) < 0.05

    run_undrawn([], script)
