"""Values along bands in 3D: pressure on rows, dashes and height over hollows. No window is opened here."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
import pyvista as pv

from app.gui.features.maps.band_coloring import BandPainter, BandValues, pressures_on, pulls_on
from app.presenters.lines import bands
from app.rendering.appearance import rgb
from app.rendering.scene import Scene
from app.rendering.vertex_colors import Ramp
from core.garment.elastic_library import find_elastic
from core.garment.presets import find_preset, with_preset
from core.garment.pressure import LinePressure, pressures
from core.pipeline.build import Stages, build
from core.pipeline.model_stages import line_targets
from core.pipeline.solve import Solution, solve
from core.pipeline.surface_fields import line_forces
from tests.app.rendering.conftest import MakeScene

RAMP = Ramp(("#EDD8C9", "#8A3408"), 0.0, 5.0, "#EDD8C9")


@pytest.fixture(scope="module")
def solution(built: Callable[[str], Stages]) -> Solution:
    stages = built("mannequin")
    design = replace(with_preset(stages.design, find_preset("Bra")), volume="adaptive")
    design = design.with_line("mid-bust", 0.8).with_elastic("mid-bust", find_elastic("picot 10"))
    return solve(build(design, stages))


@pytest.fixture
def scene(make_scene: MakeScene, solution: Solution) -> Scene:
    scene, stages = make_scene(), solution.stages
    scene.show_body(stages.body.mesh)
    scene.show_bands(bands(stages, ()))
    scene.move_body(stages.moving.vertices, *stages.shape(solution.control_points))
    return scene


@pytest.fixture(scope="module")
def worn(solution: Solution) -> dict[str, LinePressure]:
    return dict(pressures(solution.stages, solution.control_points))


def drawn(scene: Scene, name: str) -> np.ndarray:
    rows = scene.plotter.actors[f"band {name}"].mapper.dataset["Colour"]
    return np.array(rows, dtype=float).reshape(-1, 8, 3)[:, 3]


def test_a_row_of_a_band_has_the_pressure_of_its_place(scene: Scene, worn: dict[str, LinePressure]) -> None:
    shown = pressures_on(scene.bands, worn, stale=False)
    band = worn["mid-bust"]
    # The band is drawn as wide as it is reckoned: each row is a place.
    assert shown.values["mid-bust"] == pytest.approx(band.kpa)
    assert np.isnan(shown.off["mid-bust"]).tolist() == (~band.bridged).tolist()
    strap, at = worn["strap left"], scene.bands.ribbon("strap left").at * (len(worn["strap left"].kpa) - 1)
    assert not strap.closed
    rows = np.abs(at - at.round()) < 1e-9  # but for the round ends
    assert rows.sum() > 0.8 * len(strap.kpa)
    assert shown.values["strap left"][rows] == pytest.approx(strap.kpa[at[rows].round().astype(int)])
    assert shown.values["strap left"][[0, -1]] == pytest.approx(strap.kpa[[0, -1]])
    assert shown.values["strap left"].max() == strap.largest


def test_the_largest_pressure_of_a_line_is_found_on_its_band(built: Callable[[str], Stages]) -> None:
    stages = built("person")
    solved = solve(build(replace(with_preset(stages.design, find_preset("Bra")), volume="adaptive"), stages))
    plotter = pv.Plotter(off_screen=True, window_size=(30, 30), lighting="none")
    scene = Scene(plotter)
    scene.show_body(stages.body.mesh)
    scene.show_bands(bands(solved.stages, ()))
    found = pressures(solved.stages, solved.control_points)
    shown = pressures_on(scene.bands, found, stale=False)
    assert {name: values.max() for name, values in shown.values.items()} == {
        name: band.largest for name, band in found.items()
    }
    plotter.close()


def test_a_band_is_coloured_by_pressure_and_dashed_over_a_hollow(
    scene: Scene, worn: dict[str, LinePressure]
) -> None:
    shown, band = pressures_on(scene.bands, worn, stale=False), worn["mid-bust"]
    own = drawn(scene, "mid-bust")
    BandPainter().paint(scene.bands, shown, RAMP)
    colours = drawn(scene, "mid-bust")
    lies = np.flatnonzero(~band.bridged)
    assert colours[lies] == pytest.approx(RAMP(band.kpa[lies]), abs=1.0)
    over = np.flatnonzero(band.bridged)
    pale, plain = (colours[over[(over // 2) % 2 == half]] for half in (0, 1))
    assert plain == pytest.approx(np.tile(rgb("#EDD8C9"), (len(plain), 1)), abs=15.0)
    assert (pale.min(axis=1) > 230.0).all()
    assert not np.allclose(own, colours)


def test_over_a_hollow_the_band_is_drawn_where_it_is_taut(
    scene: Scene, worn: dict[str, LinePressure]
) -> None:
    band, painter = worn["mid-bust"], BandPainter()
    laid, _ = scene.bands.spine("mid-bust")
    painter.paint(scene.bands, pressures_on(scene.bands, worn, stale=False), RAMP)
    taut, _ = scene.bands.spine("mid-bust")
    far = np.linalg.norm(taut - band.places, axis=1)
    assert far.max() < 4.5, "it lies about 2 mm over the middle of the band"
    deep = band.gap > 8.0
    assert deep.any()
    assert np.linalg.norm(laid - band.places, axis=1)[deep].max() > 6.0
    scene.mark_bands("mid-bust")
    casing, _ = scene.bands._casings["mid-bust"].spine()
    assert np.linalg.norm(casing - taut, axis=1)[deep].max() < 2.0, "its casing goes with it"
    painter.give_back(scene.bands)
    assert scene.bands.spine("mid-bust")[0] == pytest.approx(laid)


def test_colours_of_a_former_shape_are_faint_and_tell_no_figure(
    scene: Scene, worn: dict[str, LinePressure]
) -> None:
    fresh, stale = (pressures_on(scene.bands, worn, stale=old) for old in (False, True))
    blank, row = rgb("#EDD8C9"), worn["mid-bust"].peak
    full, faint = (np.abs(each.colours("mid-bust", RAMP)[row] - blank) for each in (fresh, stale))
    assert faint == pytest.approx(0.42 * full)
    assert fresh.at("mid-bust", row)[0] == pytest.approx(worn["mid-bust"].largest)
    assert np.isnan(stale.at("mid-bust", row)).all()
    assert np.isnan(fresh.at("mid-bust", 100_000)).all()
    assert np.isnan(fresh.at("waist", 0)).all()


def test_the_back_of_a_band_has_pressure_but_no_pull(
    scene: Scene, worn: dict[str, LinePressure], solution: Solution
) -> None:
    stages = solution.stages
    found = line_forces(stages.model, solution.control_points, line_targets(stages.design, stages).ratios)
    pulling: BandValues = pulls_on(scene.bands, found)
    back = scene.bands.ribbon("mid-bust").part < 0
    assert back.any()
    assert np.isnan(pulling.values["mid-bust"]).tolist() == back.tolist()
    assert not np.isnan(pressures_on(scene.bands, worn, stale=False).values["mid-bust"]).any()
