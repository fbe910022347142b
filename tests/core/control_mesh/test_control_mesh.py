"""The control mesh on bodies: by hand on an analytic one, by identities, and on the samples."""

import numpy as np
import pytest
import trimesh
from fit_bodies import (
    AZIMUTH,
    BUST,
    FOLD,
    RADIUS,
    SAMPLES,
    analytic_body,
    analytic_landmarks,
    body_of,
    hanging,
    landmarks_at,
    sample_of,
    skin,
)
from scipy.spatial import cKDTree

from core.control_mesh.fit import fit_control_mesh
from core.control_mesh.template import TEMPLATES, read_template
from core.control_mesh.validation import agreement, bends, corner_angles
from core.geometry.mesh import Mesh

MIRROR = np.array([-1.0, 1.0, 1.0])


@pytest.fixture(scope="module", params=SAMPLES)
def sample(request):
    """The name of a sample body, the body and its true landmarks."""
    return request.param, *sample_of(request.param)


@pytest.fixture(scope="module", params=TEMPLATES)
def template(request):
    return read_template(request.param)


@pytest.fixture(scope="module")
def fit(sample, template):
    return fit_control_mesh(template, sample[1], landmarks_at(sample[2]))


def distance_to(mesh, points):
    """The distance of each point from the nearest triangle among those around it [mm]."""
    corners = mesh.vertices[mesh.faces]
    near = cKDTree(corners.mean(axis=1)).query(points, 40)[1]
    place = trimesh.triangles.closest_point(corners[near.ravel()], np.repeat(points, near.shape[1], axis=0))
    away = np.linalg.norm(place - np.repeat(points, near.shape[1], axis=0), axis=1)
    return away.reshape(near.shape).min(axis=1)


def test_rows_and_columns_of_the_analytic_body(template):
    control = fit_control_mesh(template, body_of(analytic_body()), analytic_landmarks())
    points = control.mesh.vertices
    azimuth, z = np.arctan2(points[:, 0], -points[:, 1]), points[:, 2]
    inner = {"168": [0, 0.45, 0.74, 1], "120": [0, 0.5, 1]}[template.name]
    root = np.radians(80.0)
    columns = [*(AZIMUTH * np.array(inner)), 0.5 * (AZIMUTH + root), root, root + np.radians(17.0)]
    expected = np.sign(control.column) * np.array(columns)[np.abs(control.column)]
    upright = control.row <= 3
    np.testing.assert_allclose(azimuth[upright], expected[upright], atol=2e-3)
    np.testing.assert_allclose(z[control.row == 0], FOLD - 38.0 * RADIUS / 130.0, atol=0.02)
    np.testing.assert_allclose(z[control.row == 3], BUST, atol=1e-6)
    breast = (np.abs(control.column) >= 1) & (np.abs(control.column) < template.half - 1)
    folds = (control.row == 1) & breast & (np.abs(np.abs(expected) - AZIMUTH) < 0.3)
    np.testing.assert_allclose(z[folds], FOLD, atol=4.0)
    np.testing.assert_allclose(np.hypot(points[:, 0], points[:, 1]), skin(azimuth, z), atol=1.5)


def test_rows_follow_a_breast_that_hangs_below_its_fold(template):
    body, landmarks = hanging(sag=1.0)
    control = fit_control_mesh(template, body, landmarks)
    points = control.mesh.vertices
    for point, side, sign in zip(control.bust_points, ("left", "right"), (1, -1), strict=True):
        fold = points[template.point(1, sign * template.bust_column)]
        line = points[template.point(2, sign * template.bust_column)]
        assert points[point][2] < landmarks.position(f"fold_{side}")[2]
        # The mesh resolves the crease to 3 mm, the profile to 2 mm.
        assert np.hypot(np.hypot(*fold[:2]) - RADIUS, fold[2] - FOLD) < 5.0
        assert line[2] < fold[2] - 10.0
    assert agreement(control.mesh, body.mesh).min() > 0.3


def test_control_mesh_is_sound(fit, sample):
    _, body, _ = sample
    control = fit
    assert corner_angles(control.mesh).min() > 8.0
    ends = control.mesh.vertices[control.mesh.edges]
    assert np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).min() > 10.0
    assert agreement(control.mesh, body.mesh).min() > 0.3
    edge, _, bend = bends(control.mesh)
    assert (control.row[edge[bend > 90.0]] == 1).any(axis=1).all()
    assert distance_to(body.mesh, control.mesh.vertices).max() < 1e-6
    assert control.warnings == ()


def test_control_mesh_keeps_the_places_of_the_template(fit, template):
    assert np.array_equal(fit.mesh.faces, template.faces)
    assert np.array_equal(fit.fixed, template.fixed)
    assert fit.paths == template.paths
    outermost = np.isin(fit.mesh.faces, fit.border_points).any(axis=1)
    assert fit.fixed[fit.mesh.faces[outermost]].all()
    for path in fit.paths.values():
        at = fit.mesh.vertices[list(path)] - (0.0, fit.mesh.vertices[fit.border_points, 1].max(), 0.0)
        assert (np.diff(np.arctan2(at[:, 0], -at[:, 1])) > 0.0).all()


def test_bust_points_and_folds_lie_at_the_landmarks(fit, sample, template):
    _, _, places = sample
    for point, side, sign in zip(fit.bust_points, ("left", "right"), (1, -1), strict=True):
        bust, fold = places[f"bust_point_{side}"], places[f"fold_{side}"]
        assert np.linalg.norm(fit.mesh.vertices[point] - bust) < 1.0
        assert fit.column[point] == sign * template.bust_column
        below = fit.mesh.vertices[template.point(1, sign * template.bust_column)]
        assert abs(below[2] - fold[2]) < 12.0
        assert below[1] > bust[1] + 25.0


def test_line_row_moves_with_the_line_height_and_nothing_else_does(sample, template):
    name, body, places = sample
    fits = [fit_control_mesh(template, body, landmarks_at(places), part) for part in (0.25, 0.5, 0.75)]
    points = np.array([control.mesh.vertices for control in fits])
    others = template.row != 2
    np.testing.assert_array_equal(points[0, others], points[1, others])
    np.testing.assert_array_equal(points[2, others], points[1, others])
    bust = [template.point(2, sign * template.bust_column) for sign in (1, -1)]
    start = points[0, list(fits[0].bust_points)]
    away = np.linalg.norm(points[:, bust] - start, axis=2)
    assert (np.diff(away, axis=0) < -8.0).all(), name


def test_fit_of_the_mirrored_body_is_the_mirrored_fit(fit, sample, template):
    _, body, places = sample
    other = {"left": "right", "right": "left"}
    swapped = {}
    for mark, place in places.items():
        what, side = mark.rsplit("_", 1)
        swapped[f"{what}_{other[side]}"] = place * MIRROR
    mesh = Mesh(body.mesh.vertices * MIRROR, body.mesh.faces[:, ::-1])
    mirrored = fit_control_mesh(template, body_of(mesh), landmarks_at(swapped))
    back = mirrored.mesh.vertices.reshape(len(template.rows), -1, 3)[:, ::-1] * MIRROR
    np.testing.assert_allclose(back.reshape(-1, 3), fit.mesh.vertices, atol=1e-6)


def test_fit_of_the_symmetric_mannequin_is_symmetric(template):
    body, places = sample_of("mannequin")
    points = fit_control_mesh(template, body, landmarks_at(places)).mesh.vertices
    points = points.reshape(len(template.rows), -1, 3)
    away = np.linalg.norm(points - points[:, ::-1] * MIRROR, axis=2)
    assert away.max() < 0.25
    assert away.mean() < 0.03


def test_fit_moves_with_the_body(fit, sample, template):
    _, body, places = sample
    shift = np.array([35.0, -420.0, 77.0])
    moved = fit_control_mesh(
        template,
        body_of(body.mesh.moved(body.mesh.vertices + shift)),
        landmarks_at({name: place + shift for name, place in places.items()}),
    )
    np.testing.assert_allclose(moved.mesh.vertices - shift, fit.mesh.vertices, atol=1e-6)


@pytest.mark.parametrize("seed", range(6))
def test_landmarks_wrong_by_8_mm_still_give_a_sound_mesh(sample, template, seed):
    _, body, places = sample
    random = np.random.default_rng(seed)
    moved = {}
    for side in ("left", "right"):
        dx, dz, dfold = random.uniform(-8.0, 8.0, 3)
        moved[f"bust_point_{side}"] = places[f"bust_point_{side}"] + (dx, 0.0, dz)
        for name in ("fold", "lowest"):
            moved[f"{name}_{side}"] = places[f"{name}_{side}"] + (0.0, 0.0, dfold)
    control = fit_control_mesh(template, body, landmarks_at(moved))
    assert corner_angles(control.mesh).min() > 8.0
    assert agreement(control.mesh, body.mesh).min() > 0.3
