"""Whole bands: they close round the body, stay off hollows that a taut band bridges, and tell their parts."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
import pyvista as pv
from scipy.interpolate import CubicSpline
from scipy.spatial import cKDTree

from app.presenters.lines import bands
from app.rendering.actors import RayPicker
from app.rendering.band import OFF_WIDTH, Band, band_width
from app.rendering.band_actors import Bands, RibbonActor
from app.rendering.ribbon_mesh import CASING, Ribbon, RibbonSurface, build_casing, build_ribbon
from core.document.design import Design, ScanSource
from core.garment.curve_smoothing import centre_line
from core.geometry.mesh import Mesh, unit
from core.geometry.plane_sections import arc_length
from core.pipeline.build import Stages, build
from core.pipeline.line_routes import LineRoute
from core.pipeline.solve import solve

RADIUS = 120.0


def tube(radius: Callable[[np.ndarray], np.ndarray]) -> Mesh:
    """A trunk 200 mm high; ``radius`` is given for azimuths from the front, positive the subject's left."""
    turn, z = np.meshgrid(np.arange(240) * np.pi / 120.0, np.arange(0.0, 204.0, 4.0), indexing="ij")
    far = radius((turn + np.pi) % (2.0 * np.pi) - np.pi)
    points = np.stack([far * np.sin(turn), -far * np.cos(turn), z], axis=2).reshape(-1, 3)
    count = z.shape[1]
    a = (np.arange(240)[:, None] * count + np.arange(count - 1)).ravel()
    b = (a + count) % len(points)
    faces = np.concatenate([np.stack([a, b, b + 1], axis=1), np.stack([a, b + 1, a + 1], axis=1)])
    return Mesh(points, faces)


def arc(start: float, end: float, step: float, radius: float = RADIUS) -> np.ndarray:
    turn = np.radians(np.arange(start, end + 0.5 * step, step))
    return np.stack([radius * np.sin(turn), -radius * np.cos(turn), np.full(len(turn), 100.0)], axis=1)


def test_a_band_with_a_back_closes_round_the_body() -> None:
    front, back = arc(-80.0, 80.0, 20.0), arc(80.0, 280.0, 4.0)
    surface = RibbonSurface(tube(lambda turn: np.full_like(turn, RADIUS)))
    ribbon = build_ribbon(LineRoute(front, back), surface, 12.0)
    middle = ribbon.mesh.vertices.reshape(ribbon.rows, 8, 3)[:, 3:5].mean(axis=1)
    steps = np.linalg.norm(np.roll(middle, -1, axis=0) - middle, axis=1)
    assert steps.max() < 5.0  # no gap, not even where the rows begin
    assert np.hypot(middle[:, 0], middle[:, 1]) == pytest.approx(RADIUS + 1.9, abs=0.3)
    assert (np.bincount(ribbon.mesh.edges.ravel(), minlength=8 * ribbon.rows) > 0).all()
    assert len(ribbon.mesh.boundary_loops) == 2  # an upper and a lower rim
    bearing = np.degrees(np.arctan2(middle[:, 0], -middle[:, 1]))
    assert (np.abs(bearing[ribbon.part >= 0]) < 82.0).all()
    assert (np.abs(bearing[ribbon.part < 0]) > 78.0).all()
    inside = np.abs(bearing + 70.0) < 8.0
    assert set(ribbon.part[inside].tolist()) == {0}  # the first segment, from -80 to -60 degrees
    assert len(build_casing(LineRoute(front, back), surface, 12.0).mesh.boundary_loops) == 2


def test_a_line_without_a_back_ends_where_it_ends() -> None:
    surface = RibbonSurface(tube(lambda turn: np.full_like(turn, RADIUS)))
    ribbon = build_ribbon(LineRoute(arc(-40.0, 40.0, 20.0)), surface, 12.0)
    assert len(ribbon.mesh.boundary_loops) == 1
    assert (ribbon.part >= 0).all()
    ends = ribbon.mesh.vertices.reshape(ribbon.rows, 8, 3)[[0, -1]]
    assert (np.hypot(ends[..., 0], ends[..., 1]) < RADIUS).all()  # lowered into the skin: closed


def test_a_ring_closes_by_itself() -> None:
    surface = RibbonSurface(tube(lambda turn: np.full_like(turn, RADIUS)))
    turn = np.radians(np.arange(0.0, 361.0, 30.0))
    ring = np.stack([30.0 * np.sin(turn), np.full(13, -RADIUS), 100.0 + 30.0 * np.cos(turn)], axis=1)
    line = centre_line(ring, surface)
    assert line.closed
    assert np.linalg.norm(line.points[0] - line.points[-1]) < 6.0


def test_a_taut_band_bridges_a_hollow_and_lies_on_the_rest() -> None:
    def cleft(turn: np.ndarray) -> np.ndarray:
        return RADIUS - 25.0 * np.exp(-((turn / 0.12) ** 2))

    surface = RibbonSurface(tube(cleft))
    places = arc(-72.0, 72.0, 24.0)
    line = centre_line(places[np.abs(places[:, 0]) > 1.0], surface)
    middle = np.abs(line.points[:, 0]) < 3.0
    taut = RADIUS * np.cos(np.radians(24.0))  # the chord between the two points beside the cleft
    stands = -(line.points + line.lift[:, None] * line.normals)[middle, 1]
    assert stands == pytest.approx(taut, abs=3.0)
    assert line.lift[np.abs(line.points[:, 0]) > 60.0].max() < 0.5


def breast() -> Mesh:
    """A trunk with a nipple in front."""
    skin = tube(lambda turn: np.full_like(turn, RADIUS))
    out = np.array([0.0, -1.0, 0.0])
    far = np.linalg.norm(skin.vertices - [0.0, -RADIUS, 100.0], axis=1)
    return Mesh(skin.vertices + 6.0 * np.exp(-((far / 5.0) ** 2))[:, None] * out, skin.faces)


def drawn(ribbon: Ribbon) -> pv.PolyData:
    return pv.PolyData.from_regular_faces(ribbon.mesh.vertices, ribbon.mesh.faces)


@pytest.mark.parametrize("x", [0.0, 4.0, 8.0])
def test_a_strap_lies_on_a_wide_band(x: float) -> None:
    plotter, z = pv.Plotter(off_screen=True), np.arange(50.0, 151.0, 20.0)
    shown, out = Bands(plotter), np.array([0.0, -10.0, 0.0])
    wide = Band("wide", arc(-80.0, 80.0, 20.0), "#125A6B", 60.0, arc(80.0, 280.0, 4.0))
    path = np.stack([np.full(len(z), x), np.full(len(z), -np.hypot(RADIUS, x)), z], axis=1)
    shown.show([wide, Band("strap", path, "#E0A030", 12.0)], RibbonSurface(breast()))
    shown.mark("strap", "")
    strap, casing = shown.ribbon("strap"), shown._casings["strap"].ribbon
    below, above = RayPicker(drawn(shown.ribbon("wide"))), RayPicker(drawn(strap))
    for at in strap.top.reshape(-1, 3):
        assert below.hit(at, at + out) is None
    hidden = (np.abs(casing.mesh.vertices[:, 0] - x) < 4.0) & (
        np.abs(casing.mesh.vertices[:, 2] - 100.0) < 45.0
    )
    climbs = [np.linalg.norm(each.rise, axis=1).max() for each in (casing, strap)]
    assert climbs[0] == pytest.approx(climbs[1], rel=0.1), "it climbs as the strap does"
    for at in casing.mesh.vertices[hidden]:
        assert above.hit(at, at + out) is not None, "its casing looks out beside it only"
    plotter.close()


def test_a_line_that_is_off_is_dashed_and_met_between_its_dashes_all_the_same() -> None:
    shown = Bands(pv.Plotter(off_screen=True))
    off = Band("off", arc(-80.0, 80.0, 20.0), "#125A6B", 4.0, off=True)
    shown.show([off], RibbonSurface(breast()))
    drawn_rows = np.unique(shown._ribbons["off"].data.regular_faces // shown.ribbon("off").columns)
    assert 0.6 < len(drawn_rows) / shown.ribbon("off").rows < 0.9
    whole = shown.ribbon("off").mesh
    flat = np.linalg.norm(whole.face_normals, axis=1) > 0.5  # at a round end triangles have no area
    for at, normal in zip(
        whole.vertices[whole.faces[flat]].mean(axis=1), whole.face_normals[flat], strict=True
    ):
        assert shown.hit(at + normal, at - normal) is not None
    shown._plotter.close()


def test_what_can_pull_and_is_off_is_thin_and_dashed_and_nothing_else() -> None:
    stages = build(Design(ScanSource("resources/samples/mannequin.ply")).with_line("mid-bust", 0.95))
    assert {band.name: (band.off, band.width) for band in bands(stages, ())} == {
        "full-bust": (True, OFF_WIDTH),
        "mid-bust": (False, band_width("mid-bust")),
        "under-bust": (False, band_width("under-bust")),
    }


def test_a_band_covers_a_nipple() -> None:
    ribbon = build_ribbon(
        LineRoute(arc(-80.0, 80.0, 20.0), arc(80.0, 280.0, 4.0)), RibbonSurface(breast()), 12.0
    )
    met = RayPicker(drawn(ribbon)).hit(np.array([0.0, -300.0, 100.0]), np.array([0.0, 0.0, 100.0]))
    assert met is not None
    assert met[1] < -RADIUS - 6.0


@pytest.mark.parametrize("name", ["mannequin", "person"])
def test_no_skin_stands_through_a_band_however_wide_it_is(
    name: str, finely_built: Callable[[str], Stages]
) -> None:
    stages, design = finely_built(name), finely_built(name).design
    for line in ("full-bust", "mid-bust"):
        design = design.with_line(line, 0.9)
    solved = solve(build(design, stages))
    rest = stages.body.mesh
    reshaped = rest.vertices.copy()
    reshaped[solved.stages.moving.vertices] = solved.stages.shape(solved.control_points)[0]
    assert np.abs(reshaped - rest.vertices).max() > 5.0
    for band in bands(stages, ()):
        for width in (10.0, 25.0, 40.0, 60.0):
            ribbon = build_ribbon(band.route, RibbonSurface(rest), width)
            for skin in (rest, rest.moved(reshaped)):
                cloth = ribbon.mesh.vertices + ribbon.follow @ (skin.vertices - rest.vertices)
                assert bare(skin, cloth.reshape(ribbon.rows, -1, 3)) == 0.0, (band.name, width)


def bare(skin: Mesh, cloth: np.ndarray) -> float:
    """The share of a band's fields between its rims, whose middle lies in the body: skin stands over them.

    A sight outwards from there leaves the body; one that enters it first sees a breast hang over the band.
    """
    body = pv.PolyData.from_regular_faces(skin.vertices, skin.faces)
    low, high = cloth[:, 1:-2], cloth[:, 2:-1]  # without the rims, which dip under the skin
    further, across = (np.roll(low, -1, axis=0) - low).reshape(-1, 3), (high - low).reshape(-1, 3)
    middles = (0.5 * (low + np.roll(high, -1, axis=0))).reshape(-1, 3)
    out = unit(np.cross(further, across))
    met = [
        body.ray_trace(at, at + 8.0 * way, first_point=True)[1] for at, way in zip(middles, out, strict=True)
    ]
    over = [
        len(face) > 0 and skin.face_normals[face[0]] @ way > 0.0 for face, way in zip(met, out, strict=True)
    ]
    return float(np.mean(over))


@pytest.mark.parametrize(("name", "calm"), [("mannequin", 0.6), ("person", 0.95)])
def test_bands_of_the_template_go_round_a_body(
    name: str, calm: float, finely_built: Callable[[str], Stages]
) -> None:
    stages = finely_built(name)
    surface = RibbonSurface(stages.body.mesh)
    shown = bands(stages, ())
    assert {band.name for band in shown} == {"full-bust", "mid-bust", "under-bust"}
    for band in shown:
        ribbon = build_ribbon(band.route, surface, band.width)
        rows = ribbon.mesh.vertices.reshape(ribbon.rows, 8, 3)
        middle = rows[:, 3:5].mean(axis=1)
        steps = np.linalg.norm(np.roll(middle, -1, axis=0) - middle, axis=1)
        assert steps.max() < 8.0
        whole = next(line.whole_length for line in stages.model.lines if line.name == band.name)
        assert steps.sum() == pytest.approx(whole, rel=0.03)
        width = np.linalg.norm(rows[:, 1] - rows[:, -2], axis=1)
        assert np.median(width) == pytest.approx(band.width, rel=0.05)
        # No edge is wavier than a tape: it turns up and down less than the path, which stays under it.
        turning = bending(np.concatenate([band.path, band.back[1:-1]]), surface)
        assert max(bending(rows[:, 1], surface), bending(rows[:, -2], surface)) < calm * turning
        aside, _ = cKDTree(middle).query(surface.project(band.path)[0])
        assert aside.max() < 0.6 * band.width + 2.0


def bending(curve: np.ndarray, surface: RibbonSurface) -> float:
    """How much a closed curve turns aside on the skin, whatever the skin does [1/mm]: root mean square."""
    around = np.concatenate([curve, curve[:1]])
    s = arc_length(around)
    spline = CubicSpline(s, around, bc_type="periodic")
    at = np.arange(0.0, s[-1], 1.0)
    _, normal = surface.project(spline(at))
    aside = np.cross(normal, unit(spline(at, 1)))
    return float(np.sqrt(np.mean(np.einsum("kx,kx->k", spline(at, 2), aside) ** 2)))


def test_an_open_ribbon_ends_round() -> None:
    surface = RibbonSurface(tube(lambda turn: np.full_like(turn, RADIUS)))
    path = arc(-40.0, 40.0, 20.0)
    for laid, radius in ((build_ribbon, 10.0), (build_casing, 0.5 * (20.0 + CASING))):
        ribbon = laid(LineRoute(path), surface, 20.0)
        rows = ribbon.mesh.vertices.reshape(ribbon.rows, -1, 3)
        along = RADIUS * np.arctan2(rows[..., 0], -rows[..., 1])
        end = along[:, 1:-1].max()
        width = np.linalg.norm(rows[:, 1] - rows[:, -2], axis=1)
        corner = np.interp(end - radius * (1.0 - np.sqrt(0.75)), along[:, 3], width)
        assert corner == pytest.approx(radius, rel=0.15), "half as wide there as in the middle: a half circle"
        assert end == pytest.approx(RADIUS * np.radians(40.0) + radius - 10.0, abs=1.5)


def test_a_ribbon_forgets_nothing_that_moved_once() -> None:
    surface = RibbonSurface(tube(lambda turn: np.full_like(turn, RADIUS)))
    ribbon = build_ribbon(LineRoute(arc(-80.0, 80.0, 20.0), arc(80.0, 280.0, 4.0)), surface, 12.0)
    plotter = pv.Plotter(off_screen=True)
    actor = RibbonActor(plotter, ribbon, "ribbon")
    skin = surface.mesh.vertices
    for there in (skin[:, 0] > 60.0, skin[:, 0] < -60.0, np.zeros(len(skin), dtype=bool)):
        displacement = np.outer(there, [3.0, -8.0, 5.0])
        actor.move(displacement)
        moved = ribbon.mesh.moved(ribbon.mesh.vertices + ribbon.follow @ displacement)
        assert np.abs(actor.data.points - moved.vertices).max() < 1e-4
        assert np.abs(actor.data["Normals"] - moved.vertex_normals).max() < 1e-6
    plotter.close()
