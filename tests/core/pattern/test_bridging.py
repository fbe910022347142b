"""A taut cloth: over a groove it is straight, on round skin it stays, and it never enters the skin."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
import pytest
from curved_patches import EVEN, loop
from curved_patches import sheet as bent
from scipy.spatial import Delaunay

from core.geometry.mesh import Faces, Mesh, Points
from core.landmarks.types import SIDES
from core.pattern.block_library import find_block
from core.pattern.bridging import bridged, bridged_cut
from core.pattern.flattening import flatten
from core.pattern.garment import cut_garment
from core.pattern.panel import Bridge, Panel, PanelSeed, cut_panels
from core.pattern.places import BodyPlaces
from core.pattern.seam_curves import SeamDrawing
from core.pattern.surface_cut import cut_surface
from core.pattern.surface_trace import SurfaceCurve
from core.pipeline.build import Stages


def sheet(half_x: float, half_z: float, step: float = 4.0) -> tuple[Points, Faces]:
    """A flat sheet of even triangles, facing forward (-y)."""
    columns, rows = np.arange(-half_x, half_x + 0.1, step), np.arange(-half_z, half_z + 0.1, step * 0.866)
    x, z = (at.astype(np.float64) for at in np.meshgrid(columns, rows))
    x[1::2] += np.where(np.abs(x[1::2]) < half_x - 0.1, 0.5 * step, 0.0)
    flat = np.stack([x.ravel(), z.ravel()], axis=1)
    faces = Delaunay(flat).simplices.astype(np.int64)
    points = np.stack([flat[:, 0], np.zeros(len(flat)), flat[:, 1]], axis=1)
    return points, forward(points, faces)


def forward(points: Points, faces: Faces) -> Faces:
    """The faces wound so that they face forward."""
    back = Mesh(points, faces).face_normals[:, 1] > 0.0
    return np.where(back[:, None], faces[:, ::-1], faces)


def test_over_a_groove_it_is_straight_from_edge_to_edge() -> None:
    points, faces = sheet(60.0, 40.0)
    points[:, 1] = np.maximum(20.0 - np.abs(points[:, 0]), 0.0)  # a groove 20 mm deep and 40 wide
    cloth = bridged(points, faces, np.tile([0.0, -1.0, 0.0], (len(points), 1)))
    np.testing.assert_allclose(cloth[:, 1], 0.0, atol=0.3)
    np.testing.assert_array_equal(cloth[:, [0, 2]], points[:, [0, 2]])


def test_round_skin_stays_as_it_is() -> None:
    points, faces = sheet(48.0, 48.0)
    points[:, 1] = -np.sqrt(90.0**2 - points[:, 0] ** 2 - points[:, 2] ** 2)
    cloth = bridged(points, faces, Mesh(points, faces).vertex_normals)
    np.testing.assert_allclose(cloth, points, atol=0.2)


def test_between_two_breasts_it_leaves_the_skin_and_nowhere_enters_it() -> None:
    points, faces = sheet(120.0, 60.0, 5.0)
    humps = [np.exp(-((points[:, 0] - at) ** 2 + points[:, 2] ** 2) / 40.0**2) for at in (-70.0, 70.0)]
    points[:, 1] = -50.0 * (humps[0] + humps[1])
    normals = Mesh(points, faces).vertex_normals
    cloth = bridged(points, faces, normals)
    out = np.einsum("nx,nx->n", cloth - points, normals)
    assert out.min() > -1e-9
    middle = (np.abs(points[:, 0]) < 3.0) & (np.abs(points[:, 2]) < 3.0)
    assert out[middle].min() > 20.0, "the hollow is more than 45 mm deep"
    tops = points[:, 1] < -48.0
    assert out[tops].max() < 0.2
    kept = bridged(points, faces, normals, np.abs(points[:, 0]) > 1000.0)
    np.testing.assert_array_equal(kept, points)


HALF, DEPTH = 21.0, 21.0  # of a groove whose walls lean by 45 degrees [mm]


def groove(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, ...]:
    return u, np.maximum(DEPTH - np.abs(u) * DEPTH / HALF, 0.0), v


def groove_panel(bridge: Bridge | None, *curves: SurfaceCurve) -> tuple[Mesh, Panel]:
    skin = bent(groove, 162.0, 120.0)
    edge = loop("edge", groove, [(-50.0, -40.0), (50.0, -40.0), (50.0, 40.0), (-50.0, 40.0)])
    cut = cut_surface(skin, (*edge, *curves))
    return skin, cut_panels(cut, (PanelSeed("front", np.array([40.0, 0.0, 0.0])),), 5.0, bridge=bridge)[0]


def bottom(name: str) -> SurfaceCurve:
    """A line along the bottom of the groove, which cuts no panel in two."""
    z = np.linspace(-40.0, 40.0, 60)
    return SurfaceCurve(name, np.stack([np.zeros(60), np.full(60, DEPTH), z], axis=1), slit=True)


def test_a_piece_over_a_groove_is_as_wide_as_the_way_across_it() -> None:
    walls = 2.0 * np.hypot(HALF, DEPTH)
    skin, lying = groove_panel(None)
    assert lying.covers == pytest.approx(80.0 * (100.0 - 2.0 * HALF + walls), rel=0.01)
    _, taut = groove_panel(bridged_cut)
    assert taut.covers == pytest.approx(80.0 * 100.0, rel=0.01)
    flat = flatten(taut, taut.places(skin.vertices), EVEN)
    np.testing.assert_allclose(np.ptp(flat.points, axis=0), [100.0, 80.0], atol=0.5)
    assert np.abs(flat.largest).max() < 0.01


def test_bridged_cloth_rides_on_the_skin() -> None:
    skin, taut = groove_panel(bridged_cut)
    np.testing.assert_allclose(taut.mix.sum(axis=1), 1.0, atol=1e-9)
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    places = taut.places(skin.vertices)
    np.testing.assert_allclose(taut.places(skin.vertices @ turn.T + 7.0), places @ turn.T + 7.0, atol=1e-6)
    deeper = skin.vertices * [1.0, 1.5, 1.0]
    np.testing.assert_allclose(taut.places(deeper)[:, 1], 0.0, atol=1.0)


def test_cloth_stays_in_a_groove_along_a_wire() -> None:
    wired = partial(bridged_cut, wires=[4])
    skin, held = groove_panel(wired, bottom("wire"))
    deepest = held.places(skin.vertices)[:, 1].max()
    assert deepest == pytest.approx(DEPTH, abs=0.1)
    _, free = groove_panel(bridged_cut, bottom("seam"))
    assert free.places(skin.vertices)[:, 1].max() < 1.0


def test_the_front_of_a_bodysuit_spans_the_cleavage(coarsely_built: Callable[[str], Stages]) -> None:
    stages = coarsely_built("mannequin")
    drawing = SeamDrawing(BodyPlaces.of(stages))
    block = find_block("bodysuit-princess")
    skin = stages.body.smoothed
    fronts = [cut_garment(drawing, block, bridge).panels[0] for bridge in (False, True)]
    ends = [drawing.places.breasts[side].apex for side in SIDES]
    widths = []
    for front in fronts:
        places = front.places(skin.vertices)
        flat = flatten(front, places, EVEN).worn
        one, two = (int(np.linalg.norm(places - end, axis=1).argmin()) for end in ends)
        widths.append(float(np.linalg.norm(flat[one] - flat[two])))
    straight = float(np.linalg.norm(ends[0] - ends[1]))
    assert widths[0] > straight + 8.0, "the skin goes down between the breasts"
    assert straight - 1.0 < widths[1] < straight + 0.3 * (widths[0] - straight)
