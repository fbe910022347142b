"""A map lies on every body that is compared, in one range, and the bands on it let it through."""

from __future__ import annotations

import numpy as np
import pytest
from window_tools import Script, run_main, settled, undrawn

from app.gui.main_window import MainWindow
from app.rendering.scene import Scene

pytestmark = pytest.mark.usefixtures("empty_house")


def test_variants_side_by_side_are_all_coloured_in_one_range() -> None:
    def script(window: MainWindow) -> Script:
        undrawn(window)
        yield settled(window)
        window.variants_controller.choose("B")
        yield settled(window)
        window.lines_controller.commit_length("mid-bust", 0.9)
        yield settled(window)
        view, maps = window.view, window.maps_controller
        window.variants_controller.show_side_by_side()
        yield lambda: len(view.beside.bodies) == 2
        clay = [colours(body.viewport.scene) for body in view.beside.bodies]
        maps.choose("displacement")
        for body, before in zip(view.beside.bodies, clay, strict=True):
            assert np.abs(colours(body.viewport.scene) - before).max() > 60
        moved = max(
            np.linalg.norm(body.frame.points - body.frame.stages.moving.rest, axis=1).max()
            for body in view.beside.bodies
        )
        assert 0.5 * moved < maps._range[1] <= 1.2 * moved, "one range, for the one that moved most"
        maps.choose("")
        for body, before in zip(view.beside.bodies, clay, strict=True):
            assert np.array_equal(colours(body.viewport.scene), before)

    run_main([], script)


def test_bands_let_a_map_on_the_skin_through_but_not_that_of_their_own_pull() -> None:
    def script(window: MainWindow) -> Script:
        undrawn(window)
        yield settled(window)
        scene, maps = window.view.viewport.scene, window.maps_controller
        assert opacity(scene) == 1.0
        for name, seen in (("strain", 0.3), ("pull", 1.0), ("displacement", 0.3), ("", 1.0)):
            maps.choose(name)
            assert opacity(scene) == pytest.approx(seen), name

    run_main([], script)


def colours(scene: Scene) -> np.ndarray:
    assert scene.body is not None
    return scene.body.colours.astype(int)


def opacity(scene: Scene) -> float:
    return float(scene.bands._ribbons["full-bust"].actor.prop.opacity)
