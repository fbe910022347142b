"""Contact pressure of bands: Laplace's law on shapes with formulas, hollows, straps, balance and noise."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from band_courses import NEWTONS, STEP, arc, course, ellipse, flat, parallel, polar, winding
from shapes import SAMPLES

from core.deformation.tffd import deform
from core.document.design import Design, ScanSource
from core.garment.band_path import BandPath, band_path
from core.garment.curve_smoothing import LocalPlanes
from core.garment.presets import find_preset, with_preset
from core.garment.pressure import LinePressure, band_pressure, mmhg, pressures
from core.garment.tension import LineTension, line_tensions
from core.geometry.mesh import Mesh, unit
from core.geometry.plane_sections import arc_length, cut, hull_perimeter, join_segments, resample
from core.pipeline.build import build
from core.pipeline.solve import Solution, solve

WIDTH = 15.0
LOBED = 35.0


def laplace(radius: float, width: float = WIDTH) -> float:
    """T / (w R) [kPa], by hand: N/mm^2 are 1000 kPa."""
    return 1000.0 * NEWTONS / (width * radius)


@cache
def solution() -> Solution:
    design = Design(ScanSource(str(SAMPLES / "mannequin.ply")))
    for name in ("under-bust", "mid-bust"):
        design = design.with_line(name, 0.95)
    traits = replace(design.line_settings("mid-bust"), width=20.0)
    return solve(build(design.with_line_settings(traits)))


@pytest.mark.parametrize("radius", [30.0, 60.0, 120.0, 400.0])
@pytest.mark.parametrize("width", [8.0, 15.0, 40.0])
def test_a_band_round_a_cylinder_presses_with_tension_over_width_and_radius(
    radius: float, width: float
) -> None:
    worn = band_pressure(polar(lambda t: np.full_like(t, radius)), width)
    assert worn.kpa == pytest.approx(laplace(radius, width), rel=0.001)
    assert worn.mean == pytest.approx(laplace(radius, width), rel=0.001)
    assert worn.radius == pytest.approx(radius, rel=0.001)
    assert worn.force == pytest.approx(2.0 * np.pi * NEWTONS, rel=0.001)
    assert worn.notes == ()
    assert worn.bridges == ()


def test_the_example_of_five_newtons_in_a_band_of_fifteen_mm() -> None:
    worn = band_pressure(polar(lambda t: np.full_like(t, 120.0)), 15.0)
    assert worn.mean == pytest.approx(2.78, abs=0.005)
    assert mmhg(worn.mean) == pytest.approx(2.7778 / 0.13332, abs=0.01)
    assert mmhg(0.133322) == pytest.approx(1.0)
    # An other way there: p [mmHg] = 4622 T [kgf] / (girth [cm] width [cm]), as bandages are reckoned.
    assert mmhg(worn.mean) == pytest.approx(4622 * (5.0 / 9.80665) / (2.0 * np.pi * 12.0 * 1.5), rel=0.001)


def test_round_an_ellipse_the_local_radius_is_that_of_the_formula() -> None:
    a, b = 160.0, 110.0
    band = ellipse(a, b)
    worn = band_pressure(band, WIDTH)
    x, y = band.points[:, 0] / a, band.points[:, 1] / b
    radius = (a**2 * y**2 + b**2 * x**2) ** 1.5 / (a * b)
    assert worn.radius == pytest.approx(radius, rel=0.02)
    assert worn.largest == pytest.approx(laplace(b**2 / a), rel=0.02)
    assert abs(worn.places[worn.peak]) == pytest.approx([a, 0.0, 0.0], abs=4.0)


@pytest.mark.parametrize("latitude", [0.0, 0.5, -0.9])
def test_on_a_ball_the_radius_is_that_of_the_ball_wherever_the_band_lies(latitude: float) -> None:
    worn = band_pressure(parallel(100.0, latitude), WIDTH)
    # Meusnier: the circle is smaller, but the skin's normal is inclined against its plane.
    assert worn.kpa == pytest.approx(laplace(100.0), rel=0.01)


def test_over_a_hollow_the_band_goes_straight_and_does_not_press() -> None:
    band = polar(lambda t: 100.0 + LOBED * np.cos(2.0 * t))
    worn = band_pressure(band, WIDTH)
    assert len(worn.bridges) == 2
    over = worn.gap > 0.5
    assert over.any()
    assert (worn.kpa[over] == 0.0).all()
    assert np.isinf(worn.radius[over]).all()
    # y = r sin t is largest where sin^2 t = 135/210; the hollow is deepest at t = 90 degrees.
    highest = (135.0 - 70.0 * 135.0 / 210.0) * np.sqrt(135.0 / 210.0)
    assert worn.places[over, 1] == pytest.approx(highest * np.sign(worn.places[over, 1]), abs=0.1)
    assert [each.height for each in worn.bridges] == pytest.approx([highest - 65.0] * 2, abs=0.1)
    assert tuple(map(str, worn.notes)) == (
        f"Bridges hollows over {worn.bridged_length:.0f} mm, "
        "up to 7 mm off the skin: no contact pressure there.",
    )
    span = np.cos(np.arcsin(np.sqrt(135.0 / 210.0))) * 90.0
    assert worn.bridged_length == pytest.approx(4.0 * span, abs=10.0)
    # What the hollow does not bear, the rest does: all turns together go once round.
    assert worn.force == pytest.approx(2.0 * np.pi * NEWTONS, rel=0.001)


@pytest.mark.parametrize("wave", [0.0, 10.0, 25.0])
def test_a_band_that_also_swings_sideways_comes_down_smoothly_beside_a_hollow(wave: float) -> None:
    band = winding(LOBED, wave)
    worn, smooth = band_pressure(band, WIDTH), band.smoothed(20.0)
    ways = unit(np.roll(smooth.points, -1, axis=0) - smooth.points)
    bend = np.einsum("kx,kx->k", np.roll(ways, 1, axis=0) - ways, smooth.normals)
    assert len(worn.bridges) == 2
    assert (worn.bends <= np.maximum(bend, 0.0) + 1e-9).all()
    # Off the skin or on it, the turns towards it go round as often.
    assert worn.bends.sum() == pytest.approx(bend.sum(), rel=1e-6)


@pytest.mark.parametrize("share", [0.6, 0.7, 0.75])
def test_a_level_band_round_a_body_goes_as_the_hull_of_its_section(share: float) -> None:
    mesh = solution().body
    low, high = mesh.vertices[:, 2].min(), mesh.vertices[:, 2].max()
    outline = max(
        join_segments(cut(mesh, [0.0, 0.0, low + share * (high - low)], [0.0, 0.0, 1.0])),
        key=lambda c: len(c[0]),
    )
    points = resample(outline[0], STEP)[:-1]
    ahead = np.roll(points, -1, axis=0) - np.roll(points, 1, axis=0)
    normals = unit(np.cross(ahead, [0.0, 0.0, 1.0]))
    normals *= np.sign(np.einsum("kx,kx->k", normals, points - points.mean(axis=0)).sum())
    even = np.ones(len(points))
    worn = band_pressure(BandPath(points, normals, NEWTONS * even, even > 0.0, closed=True), WIDTH)
    ring = np.concatenate([worn.places, worn.places[:1]])
    assert arc_length(ring)[-1] == pytest.approx(hull_perimeter(points), rel=0.0005)
    assert worn.force == pytest.approx(2.0 * np.pi * NEWTONS, rel=0.002)
    assert np.linalg.norm(worn.resultant) < 0.002 * worn.force


def test_a_hollow_at_the_seam_of_a_closed_band_is_one_hollow() -> None:
    worn = band_pressure(polar(lambda t: 100.0 - LOBED * np.cos(2.0 * t)), WIDTH)
    assert [each.length for each in worn.bridges] == pytest.approx([104.0] * 2, abs=STEP)


def test_a_hollow_that_hardly_shows_is_not_told_and_counts_as_skin() -> None:
    worn = band_pressure(polar(lambda t: 100.0 + 25.0 * np.cos(2.0 * t)), WIDTH)
    assert 0.0 < worn.gap.max() < 1.5
    assert worn.bridges == ()
    assert worn.mean == pytest.approx(1000.0 * worn.force / (WIDTH * worn.step * len(worn.kpa)))


@pytest.mark.parametrize(
    "band",
    [
        ellipse(160.0, 90.0),
        polar(lambda t: 100.0 + 8.0 * np.cos(t) + 4.0 * np.sin(3.0 * t)),
        polar(lambda t: 100.0 + LOBED * np.cos(2.0 * t) + 5.0 * np.sin(t)),
        parallel(80.0, 0.0),
    ],
)
def test_the_forces_of_a_closed_level_band_are_in_balance(band: BandPath) -> None:
    worn = band_pressure(band, WIDTH)
    area = worn.width * worn.step
    force = -(worn.kpa[:, None] * worn.normals).sum(axis=0) * area / 1000.0
    assert worn.resultant == pytest.approx(force)
    assert np.linalg.norm(worn.resultant) < 0.002 * worn.force
    assert worn.force == pytest.approx(worn.kpa.sum() * area / 1000.0)


def test_a_strap_presses_as_its_ends_pull() -> None:
    worn = band_pressure(arc(60.0, np.pi), WIDTH)
    assert not worn.closed
    assert worn.kpa[6:-6] == pytest.approx(laplace(60.0), rel=0.01)
    assert worn.kpa[1:-1] == pytest.approx(laplace(60.0), rel=0.05)
    # Both ends pull straight down with T; the last half steps lie beyond the outer places.
    assert worn.resultant == pytest.approx([0.0, 0.0, -2.0 * NEWTONS], abs=0.02 * NEWTONS)


def test_a_strap_bridges_the_hollow_above_a_breast() -> None:
    k = 2.0 * np.pi / 200.0

    def wave(t: np.ndarray) -> np.ndarray:
        return np.stack([np.zeros_like(t), -20.0 * np.cos(k * t), -t], axis=1)

    def out(t: np.ndarray) -> np.ndarray:
        return np.stack([np.zeros_like(t), -np.ones_like(t), -20.0 * k * np.sin(k * t)], axis=1)

    band = course(wave, out, 240.0, closed=False)
    worn = band_pressure(band, WIDTH)
    assert len(worn.bridges) == 1
    assert worn.bridges[0].height == pytest.approx(40.0, abs=1.0)
    hollow = (worn.places[:, 2] < -40.0) & (worn.places[:, 2] > -160.0)
    assert worn.places[hollow, 1] == pytest.approx(-20.0, abs=1.0)
    assert (worn.kpa[hollow] == 0.0).all()
    assert worn.places[worn.peak, 2] == pytest.approx(-200.0, abs=15.0)


def test_a_slack_band_does_not_press_and_says_so() -> None:
    band = polar(lambda t: 100.0 + LOBED * np.cos(2.0 * t))
    slack = band_pressure(replace(band, tension=-band.tension), WIDTH)
    assert slack.kpa.max() == slack.force == slack.mean == 0.0
    assert tuple(map(str, slack.notes)) == ("Slack: no contact pressure.",)
    band = ellipse(160.0, 110.0)
    half = band_pressure(replace(band, tension=np.where(band.points[:, 1] < 0.0, NEWTONS, -1.0)), WIDTH)
    assert tuple(map(str, half.notes)) == ("Partly slack: no contact pressure there.",)
    assert (half.kpa[band.points[:, 1] > 1.0] == 0.0).all()


def test_pressure_is_of_the_tension_at_each_place() -> None:
    band = ellipse(160.0, 110.0)
    front = band.points[:, 1] < 0.0
    twice = band_pressure(replace(band, tension=np.where(front, 2.0, 1.0) * NEWTONS), WIDTH)
    assert twice.kpa == pytest.approx(np.where(front, 2.0, 1.0) * band_pressure(band, WIDTH).kpa)


def cylinder(radius: float, noise: float = 0.0) -> Mesh:
    """A scan of a standing cylinder, points about 4 mm apart that do not lie exactly on it."""
    count, rows = round(2.0 * np.pi * radius / 4.0), 31
    turn, level = np.meshgrid(np.arange(count), np.arange(rows))
    angle = (2.0 * np.pi * turn / count).ravel()
    reach = radius + np.random.default_rng(1).normal(0.0, noise, count * rows)
    points = np.stack([reach * np.cos(angle), reach * np.sin(angle), 4.0 * level.ravel() - 60.0], axis=1)
    a = (np.arange(rows - 1)[:, None] * count + np.arange(count)).ravel()
    b = (np.arange(rows - 1)[:, None] * count + (np.arange(count) + 1) % count).ravel()
    lower, upper = np.stack([a, b, b + count], axis=1), np.stack([a, b + count, a + count], axis=1)
    return Mesh(points, np.concatenate([lower, upper]))


def round_cylinder(radius: float, noise: float = 0.0) -> LinePressure:
    mesh, t = cylinder(radius, noise), np.linspace(0.0, 2.0 * np.pi, 25)
    ring = radius * flat(np.cos(t), np.sin(t))
    tension = LineTension(np.full(12, NEWTONS), NEWTONS, estimate=False)
    band = band_path(ring[:13], tension, LocalPlanes(mesh), mesh.vertices, WIDTH, ring[12:])
    return band_pressure(band, WIDTH)


def test_a_band_that_is_laid_on_a_scan_of_a_cylinder_presses_as_on_the_cylinder() -> None:
    worn = round_cylinder(110.0)
    assert worn.closed
    assert worn.mean == pytest.approx(laplace(110.0), rel=0.01)
    assert worn.kpa == pytest.approx(laplace(110.0), rel=0.05)
    assert 0.4 < worn.front.mean() < 0.6


def test_noise_of_a_scan_hardly_changes_the_mean() -> None:
    assert round_cylinder(110.0, noise=0.5).mean == pytest.approx(laplace(110.0), rel=0.02)


@pytest.mark.parametrize("name", ["under-bust", "mid-bust"])
def test_noise_hardly_changes_the_mean_on_a_real_body(name: str) -> None:
    stages, points = solution().stages, solution().control_points
    mesh, moved = stages.body.mesh, deform(stages.binding, points)
    line = next(each for each in stages.model.lines if each.name == name)
    even = LineTension(np.full(len(line.rest_lengths), NEWTONS), NEWTONS, estimate=False)
    path, back = line.places(stages.control.mesh.vertices), stages.backs[name].path

    def worn(noise: np.ndarray) -> LinePressure:
        skin = LocalPlanes(mesh.moved(mesh.vertices + noise))
        return band_pressure(band_path(path, even, skin, moved + noise, WIDTH, back), WIDTH)

    along = np.random.default_rng(7).normal(0.0, 0.5, (len(moved), 1))
    calm, rough = worn(np.zeros((1, 3))), worn(along * mesh.vertex_normals)
    assert not np.array_equal(calm.kpa, rough.kpa)
    assert rough.mean == pytest.approx(calm.mean, rel=0.03)


def test_worn_lines_press_with_their_tensions_on_the_reshaped_body() -> None:
    stages, points = solution().stages, solution().control_points
    told, tensions = pressures(stages, points), line_tensions(stages, points)
    assert (
        list(told) == list(tensions) == ["mid-bust"]
    )  # the under-bust line has no tension without an elastic
    worn, tension = told["mid-bust"], tensions["mid-bust"]
    assert worn.width == 20.0
    assert (~worn.front).any()
    assert worn.tension[~worn.front] == pytest.approx(tension.mean)
    assert set(worn.tension[worn.front].round(9)) <= set(np.maximum(tension.segments, 0.0).round(9))
    assert str(worn.notes[0]) == "The tension is computed from the tissue stiffness alone (estimate)."
    touching = worn.places[worn.gap == 0.0]
    far = np.linalg.norm(solution().body.vertices[:, None] - touching[None, ::9], axis=2).min(axis=0)
    assert far.max() < 6.0
    assert worn.largest > worn.mean > 0.0


def test_a_band_of_no_told_width_is_taken_as_wide_as_it_is_drawn() -> None:
    stages = solution().stages
    plain = replace(
        stages,
        design=stages.design.with_line_settings(replace(stages.design.line_settings("mid-bust"), width=None)),
    )
    worn = pressures(plain, solution().control_points)["mid-bust"]
    assert worn.width == 12.0
    assert "Width not specified: 12 mm assumed." in map(str, worn.notes)


def test_straps_of_a_preset_are_open_and_press_below_the_shoulder() -> None:
    design = with_preset(solution().stages.design, find_preset("Bra"))
    solved = solve(build(design, solution().stages))
    told = pressures(solved.stages, solved.control_points)
    straps = [worn for name, worn in told.items() if "strap" in name]
    assert [worn.closed for worn in straps] == [False, False]
    assert all(worn.front.all() and worn.mean > 0.0 for worn in straps)
    less, more = sorted(worn.mean for worn in straps)
    assert more == pytest.approx(less, rel=0.05)  # the mannequin is even
