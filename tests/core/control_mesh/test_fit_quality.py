"""Triangles that cross, figures of a fit, holes that are bridged and triangles that are eased: by hand."""

import numpy as np
import pytest
from fit_bodies import RADIUS, analytic_body, body_of

from core.control_mesh.missing_points import interpolate_missing
from core.control_mesh.quality import FitQuality, deviations, measure_fit
from core.control_mesh.relaxation import relax
from core.control_mesh.skin_projection import SurfaceProjector
from core.control_mesh.validation import corner_angles, crossing_faces, find_mesh_faults
from core.geometry.mesh import Mesh

FLAT = [(0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (0.0, 4.0, 0.0)]


def pair(second, shared=0):
    """The flat triangle and another one, whose first ``shared`` corners are those of the first."""
    faces = [(0, 1, 2), tuple(k if k < shared else 3 + k for k in range(3))]
    return Mesh(np.array([*FLAT, *second]), np.array(faces))


@pytest.mark.parametrize(
    ("second", "shared", "crossed"),
    [
        ([(1, 1, -1), (1, 1, 1), (9, 9, 1)], 0, True),  # an edge goes through
        ([(1, 2, -6), (1, -8, 3), (1, 12, 3)], 0, True),  # edges of the first go through
        ([(1, 1, 1), (1, 2, 1), (2, 1, 3)], 0, False),  # above
        ([(3, 3, -1), (3, 3, 1), (9, 9, 1)], 0, False),  # beside
        ([(1, 1, 0), (1, 2, 1), (2, 1, 1)], 0, False),  # it touches with a corner
        ([(5, 0, 0), (5, 4, 0), (9, 1, 0)], 0, False),  # in the same plane
        ([(0, 0, 0), (2, 1, -1), (1, 2, 1)], 1, True),  # folded through the other from a common corner
        ([(0, 0, 0), (2, 1, 1), (1, 2, 1)], 1, False),
        ([(0, 0, 0), (4, 0, 0), (1, 1, 1)], 2, False),  # hinged on a common edge
    ],
)
def test_crossing_triangles(second, shared, crossed):
    for turn in (np.eye(3), np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]):
        mesh = pair(second, shared)
        mesh = mesh.moved(mesh.vertices @ turn.T + np.array([300.0, -200.0, 900.0]))
        assert crossing_faces(mesh).tolist() == [crossed, crossed]


def cylinder_patch(radius, step):
    """A patch of a cylinder round the z axis, in front, with columns every ``step`` degrees, rows 30 mm."""
    azimuth, z = np.radians(np.arange(-60.0, 60.1, step)), np.arange(200.0, 441.0, 30.0)
    points = np.stack(
        [
            radius * np.sin(azimuth) + 0.0 * z[:, None],
            -radius * np.cos(azimuth) + 0.0 * z[:, None],
            z[:, None] + 0.0 * azimuth,
        ],
        axis=-1,
    )
    number = np.arange(points[..., 0].size).reshape(points.shape[:2])
    a, b, c, d = (
        number[p, q].ravel() for p in (slice(-1), slice(1, None)) for q in (slice(-1), slice(1, None))
    )
    faces = np.concatenate([np.column_stack([a, b, d]), np.column_stack([a, d, c])])
    return points, faces


def test_deviation_of_a_patch_of_flat_strips_on_a_cylinder():
    # Between columns 20 degrees apart the skin stands out by r (1 - cos 10 deg); its mean over the strip is
    # r (sin a / a - cos a), a being 10 degrees, where distances are across the flat.
    points, faces = cylinder_patch(RADIUS, 20.0)
    mesh = Mesh(points.reshape(-1, 3), faces)
    away, area = deviations(mesh, SurfaceProjector(analytic_body(bump=0.0)))
    half = np.radians(10.0)
    assert away.max() == pytest.approx(RADIUS * (1.0 - np.cos(half)), abs=0.02)
    expected = RADIUS * (np.sin(half) / half - np.cos(half))
    assert np.average(away, weights=area) == pytest.approx(expected, rel=0.02)
    # Half a strip beside the border and the back of the cylinder do not count.
    assert area.sum() < 1.1 * mesh.face_areas.sum()


def test_figures_of_a_patch_that_lies_off_the_skin():
    points, faces = cylinder_patch(RADIUS + 3.0, 4.0)
    mesh = Mesh(points.reshape(-1, 3), faces)
    fold = np.zeros(len(mesh.vertices), dtype=bool)
    quality = measure_fit(mesh, SurfaceProjector(analytic_body(bump=0.0)), fold, 0.5, 7.0)
    assert quality.deviation_mean == pytest.approx(3.0, abs=0.06)
    assert quality.deviation_95 == pytest.approx(3.0, abs=0.1)
    width = 2.0 * (RADIUS + 3.0) * np.sin(np.radians(2.0))
    assert quality.shortest_edge == pytest.approx(width)
    assert quality.smallest_angle == pytest.approx(np.degrees(np.arctan(width / 30.0)))
    assert quality.largest_bend == pytest.approx(4.0)
    assert quality.same_way > 0.99
    assert (quality.crossings, quality.bust_off, quality.fold_off) == (0, 0.5, 7.0)


def test_poor_figures_are_told():
    good = FitQuality(1.0, 3.0, 8.0, 16.0, 14.0, 60.0, 0, 0.8, 0.1, 4.0)
    assert good.warnings == ()
    poor = FitQuality(4.6, 3.0, 18.0, 9.2, 14.0, 60.0, 0, 0.1, 0.1, 4.0)
    coarse, pointed, bridged = poor.warnings
    assert "4.6 mm" in str(coarse)
    assert "18 mm" in str(coarse)
    assert "9 degrees" in str(pointed)
    assert "fold" in str(bridged)


def test_mesh_turned_inside_out_is_folded():
    points, faces = cylinder_patch(RADIUS, 10.0)
    skin = SurfaceProjector(analytic_body(bump=0.0))
    none = np.zeros(points[..., 0].size, dtype=bool)
    assert not find_mesh_faults(Mesh(points.reshape(-1, 3), faces), skin, none).any.any()
    assert find_mesh_faults(Mesh(points.reshape(-1, 3), faces[:, ::-1]), skin, none).folded.all()


def test_holes_of_one_side_take_the_shape_of_the_other():
    points, _ = cylinder_patch(RADIUS, 20.0)
    points[..., 1] -= 20.0 * np.exp(-(((points[..., 2] - 320.0) / 60.0) ** 2))
    points[:, 4:, 2] += 4.0  # one side higher than the other
    points[..., 0] += 7.0
    holed = points.copy()
    holed[2:6, 4:] = np.nan
    filled = interpolate_missing(holed, 7.0)
    np.testing.assert_allclose(filled, points, atol=3.0)
    known = ~np.isnan(holed)
    np.testing.assert_array_equal(filled[known], holed[known])


def test_holes_of_both_sides_go_on_as_the_skin_bends():
    points, _ = cylinder_patch(RADIUS, 20.0)
    holed = points.copy()
    holed[3:5, 2:5] = np.nan
    holed[0, :] = np.nan
    np.testing.assert_allclose(interpolate_missing(holed, 0.0), points, atol=2.0)


def test_easing_widens_pointed_triangles_on_the_skin_and_leaves_good_ones_alone():
    skin = SurfaceProjector(analytic_body(bump=0.0))
    points, faces = cylinder_patch(RADIUS, 15.0)
    free = np.ones(points.shape[:2], dtype=bool)
    free[[0, -1]] = free[:, [0, -1]] = False
    assert relax(points, faces, skin, free, free) is points
    squeezed = points.copy()
    squeezed[3, 2:6, 2] -= 24.0
    better = relax(squeezed, faces, skin, free & False, free)
    angles = [corner_angles(Mesh(each.reshape(-1, 3), faces)).min() for each in (squeezed, better)]
    assert angles[0] < 12.0
    assert angles[1] > 15.0
    np.testing.assert_allclose(np.hypot(better[..., 0], better[..., 1]), RADIUS, atol=0.1)
    # Points may slide along their columns alone here, and the border stays.
    np.testing.assert_allclose(better[..., 0], points[..., 0], atol=0.2)
    np.testing.assert_array_equal(better[~free], squeezed[~free])


def test_body_without_skin_in_front_gives_no_figure():
    points, faces = cylinder_patch(RADIUS, 20.0)
    behind = body_of(analytic_body(bump=0.0)).mesh
    behind = Mesh(behind.vertices, behind.faces[behind.vertices[behind.faces][:, :, 1].min(axis=1) > 20.0])
    quality = measure_fit(
        Mesh(points.reshape(-1, 3), faces), SurfaceProjector(behind), np.zeros(63, dtype=bool), 0.0, 0.0
    )
    assert np.isnan(quality.deviation_mean)
    assert quality.deviation_max == 0.0
