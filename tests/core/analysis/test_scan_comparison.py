"""A second scan: gaps along normals, alignment by still skin, comparison, what the two cannot tell."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import ConvexHull
from worn_pair import released_design

from benchmarks.worn_pairs import only, other_mesh, scanned, worn_mesh
from core.analysis.calibration.api import compare, predicted_points
from core.analysis.calibration.registration import align, rotation_about
from core.analysis.calibration.residuals import FittingScan, aligned_fitting_scan, require_not_mirrored
from core.analysis.calibration.robust_least_squares import Prior, cost, normal_equations, robust_deviation
from core.analysis.calibration.surface_distance import ScanSurface, Surface, curvature
from core.deformation.incremental_normals import moving_faces
from core.errors import ScanError
from core.geometry import closest_point
from core.geometry.mesh import Mesh
from core.geometry.mirror_plane import MIRROR
from core.messages import EMPTY
from core.pipeline.build import Stages, build
from core.pipeline.skin import alone
from core.scan.body import Body
from core.scan.orientation.pose import Pose

POSE = Pose("mm", "+z", "-y", np.eye(4), True, EMPTY, 0.0)


@pytest.fixture(scope="module")
def stages() -> Stages:
    """One line on a mannequin of 2,100 corners, as an older version kept it."""
    small = released_design()
    return build(replace(small, volume="exact").with_line("mid-bust", 0.85))


def as_body(mesh: Mesh, pose: Pose = POSE) -> Body:
    return Body(mesh, pose, (), "worn")


def lying(stages: Stages, seed: int = 1, **how: object) -> tuple[FittingScan, np.ndarray]:
    rng, how = np.random.default_rng(seed), {"noise": 0.4, "resampled": False} | how
    mesh, matrix = scanned(worn_mesh(stages, stages.design), stages, rng, **how)
    body = as_body(mesh)
    return aligned_fitting_scan("worn.ply", body, align(stages, body)), matrix


def flat(height: float) -> Mesh:
    """A square of 100 mm in 200 triangles at a height, facing up."""
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(11) * 10.0, np.arange(11) * 10.0))
    corner = np.array([at for at in range(110) if at % 11 < 10])
    halves = [(corner, corner + 1, corner + 12), (corner, corner + 12, corner + 11)]
    faces = np.concatenate([np.stack(half, axis=1) for half in halves])
    return Mesh(np.stack([x, y, np.full(121, height)], axis=1), faces)


def test_a_gap_is_the_way_along_the_normal_and_none_where_there_is_no_skin() -> None:
    skin = ScanSurface(flat(5.0))
    up, slanted = np.array([0.0, 0.0, 1.0]), np.array([0.6, 0.0, 0.8])
    places = np.array([[33.0, 44.0, 0.0], [33.0, 44.0, 9.0], [33.0, 44.0, 0.0], [150.0, 44.0, 0.0]])
    gaps = skin.gaps(places, np.array([up, up, slanted, up]))
    assert gaps[:3] == pytest.approx([-5.0, 4.0, -5.0 / 0.8])
    assert np.isnan(gaps[3])
    assert np.isnan(skin.gaps(places[:1], -up[None])).all(), "the back of a skin is none"


def test_gaps_on_a_rough_skin_have_its_mean() -> None:
    rng = np.random.default_rng(5)
    rough = flat(0.0)
    rough = rough.moved(rough.vertices + rng.normal(size=rough.vertices.shape) * (0.0, 0.0, 1.0))
    x, y = rng.uniform(10.0, 90.0, (2, 4000))
    for height in (-3.0, 0.0, 3.0):
        places = np.stack([x, y, np.full(len(x), height)], axis=1)
        gaps = ScanSurface(rough).gaps(places, np.tile((0.0, 0.0, 1.0), (len(x), 1)))
        # The mean of 121 vertices with a deviation of 1 mm: 0.1 mm; the nearest place would be 0.3 mm off.
        assert np.nanmean(gaps) - height == pytest.approx(-rough.vertices[:, 2].mean(), abs=0.12)


def test_gaps_on_a_round_skin_are_not_cut_short_by_its_triangles() -> None:
    rng = np.random.default_rng(3)
    places, normals, corners = ball(rng, 60.0)
    scan = ball(rng, 59.5)  # the skin moved by half a millimetre, on another mesh, with 1 mm of noise
    mesh = Mesh(scan[0], np.ascontiguousarray(scan[2].T))
    curved = curvature(places, normals, corners)
    assert curved.mean() == pytest.approx(1.0 / 60.0, rel=0.02)
    clean = ScanSurface(mesh)
    assert np.nanmean(clean.gaps(places, normals)) > 0.56, "triangles cut the corners"
    assert np.nanmean(clean.gaps(places, normals, curved)) == pytest.approx(0.5, abs=0.005)
    noisy = ScanSurface(mesh.moved(mesh.vertices + rng.normal(size=mesh.vertices.shape)))
    assert np.nanmean(noisy.gaps(places, normals, curved)) == pytest.approx(0.5, abs=0.04)


def test_every_point_tells_how_far_a_round_skin_stands_before_it(monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(7)
    ground = Surface(*ball(rng, 60.0))
    facing = rng.normal(size=(20_000, 3))
    facing /= np.linalg.norm(facing, axis=1)[:, None]
    clean = ground.project(59.5 * facing, facing)
    assert len(clean.rows) > 0.998 * len(facing)
    assert clean.gaps.mean() == pytest.approx(0.5, abs=0.005), "no corner of a triangle is cut"
    assert clean.gaps.std() < 0.02
    assert np.linalg.norm(clean.interpolate(ground.places), axis=1).mean() == pytest.approx(60.0, abs=0.1)
    assert not len(ground.project(59.5 * facing, -facing).rows), "the back of a skin is none"
    monkeypatch.setattr(closest_point, "_AT_ONCE", 7000)
    assert (ground.project(59.5 * facing, facing).gaps == clean.gaps).all(), "in several goes"
    rough = 59.5 * facing + rng.normal(scale=2.0, size=facing.shape)
    told = ground.project(rough, facing, 2.0).gaps.mean()
    assert told == pytest.approx(0.5, abs=3.0 * 2.0 / np.sqrt(len(facing)))
    # Noise along a round skin lifts points off it, by its square over the radius.
    assert told - ground.project(rough, facing).gaps.mean() == pytest.approx(4.0 / 60.0, rel=0.03)


def test_points_beside_a_skin_have_no_foot_on_it() -> None:
    mesh = flat(0.0)
    ground = Surface(mesh.vertices, np.tile((0.0, 0.0, 1.0), (121, 1)), mesh.faces.T)
    points = np.array([[50.0, 50.0, 3.0], [103.0, 50.0, 3.0], [50.0, 50.0, 45.0], [5.0, 7.0, -2.0]])
    stood = ground.project(points, np.tile((0.0, 0.0, 1.0), (4, 1)))
    assert stood.rows.tolist() == [0, 3]
    assert stood.gaps == pytest.approx([-3.0, 2.0])


def test_a_fine_skin_with_noise_still_looks_outward() -> None:
    rng = np.random.default_rng(9)
    mesh = flat(0.0)
    rough = mesh.moved(mesh.vertices + rng.normal(scale=5.0, size=mesh.vertices.shape))
    assert (rough.vertex_normals[:, 2] < 0.6).any()
    assert (ScanSurface(rough).vertex_directions[:, 2] > 0.6).all()


def ball(rng: np.random.Generator, radius: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Places (2500, 3) [mm] on a ball by chance, their normals, and triangles (3, a), outward."""
    normals = rng.normal(size=(2500, 3))
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    corners = ConvexHull(normals).simplices
    outward = np.linalg.det(normals[corners]) > 0.0
    corners[~outward] = corners[~outward][:, ::-1]
    return radius * normals, normals, corners.T


def test_huber_counts_far_gaps_by_their_distance() -> None:
    gaps = np.array([-1.0, 1.0, -1.0, 1.0, 0.0])
    assert cost(gaps, 1.0) == pytest.approx(4.0)
    assert cost(np.array([30.0, -30.0]), 1.0) == pytest.approx(2.0 * (2.0 * 2.0 * 30.0 - 4.0))
    assert robust_deviation(np.array([-3.0, 3.0, -3.0, 3.0])) == pytest.approx(1.4826 * 3.0)


def test_the_spread_of_an_answer_is_wider_where_neighbours_are_off_together() -> None:
    rng = np.random.default_rng(2)
    slopes, patches = np.ones((400, 1)), np.repeat(np.arange(20), 20)
    alone, together = rng.normal(size=400), np.repeat(rng.normal(size=20), 20)
    sure, unsure = (
        float(np.sqrt(normal_equations(gaps, slopes, 10.0, [patches]).covariance[0, 0]))
        for gaps in (alone, together)
    )
    assert sure == pytest.approx(1.0 / 20.0, rel=0.5)
    assert unsure == pytest.approx(1.0 / np.sqrt(20.0), rel=0.5)


def test_what_is_known_beforehand_counts_as_much_as_it_is_sure() -> None:
    rng = np.random.default_rng(6)
    slopes = np.stack([np.ones(400), np.zeros(400)], axis=1)
    gaps = rng.normal(size=400)
    known = Prior(np.diag([400.0, 4.0]), np.zeros(2))  # 0.05 as 400 gaps of 1 mm tell, and 0.5
    assert normal_equations(gaps + 3.0, slopes, 1e3, known=known).step()[0] == pytest.approx(0.0, abs=1e-4)
    assert normal_equations(gaps + 0.6, slopes, 1.0, known=known).step()[0] == pytest.approx(-0.3, abs=0.05)
    equations = normal_equations(gaps, slopes, 1.0, [np.arange(400) // 20], known)
    assert np.sqrt(equations.covariance[0, 0]) == pytest.approx(0.05 / np.sqrt(2.0), rel=0.2)
    assert np.sqrt(equations.covariance[1, 1]) == pytest.approx(0.5), "what no gap tells stays as unsure"
    assert known.cost(1.0) == 0.0
    assert Prior(known.precision, np.array([0.0, 2.0])).cost(3.0) == pytest.approx(9.0 * 16.0)


def test_a_worn_scan_is_laid_on_the_first_by_still_skin(stages: Stages) -> None:
    worn, matrix = lying(stages)
    laid = worn.alignment
    back = laid.matrix @ matrix
    turn = np.degrees(np.linalg.norm([back[2, 1], back[0, 2], back[1, 0]]))
    middle = np.append(stages.control.mesh.vertices.mean(axis=0), 1.0)
    assert turn < 0.1
    assert np.linalg.norm((back @ middle - middle)[:3]) < 0.15
    assert laid.met > 0.99
    assert 0.2 < laid.rms < 0.5, "0.4 mm at each vertex, less between vertices"
    assert (laid.rotation_deviations < 0.05).all()


def test_predicted_less_real_is_the_noise_where_the_prediction_is_right(stages: Stages) -> None:
    worn, _ = lying(stages, hole=25.0)
    right = compare(stages, predicted_points(stages), worn)
    assert abs(right.total.mean) < 0.15
    assert right.total.rms < 0.5
    assert 0.8 < right.total.seen < 0.99, "there is a hole"
    assert np.isnan(right.values).any()
    thick = compare(stages, predicted_points(stages), worn, thickness=2.0)
    assert thick.total.mean == pytest.approx(right.total.mean + 2.0)
    rest = compare(stages, stages.control.mesh.vertices, worn)
    assert rest.total.rms > 1.5 * right.total.rms
    assert rest.sides["left"].rms == pytest.approx(rest.sides["right"].rms, rel=0.2)


def test_another_person_another_size_and_too_little_are_refused(stages: Stages) -> None:
    mesh = stages.body.mesh
    with pytest.raises(ScanError, match=r"0\.1 times as large.*read in cm.*Set the unit"):
        align(stages, as_body(mesh.moved(0.1 * mesh.vertices), replace(POSE, unit="cm")))
    wider = mesh.moved(mesh.vertices * (1.15, 1.0, 1.0))
    with pytest.raises(ScanError, match=r"does not match the first scan: \d+ % .* 85 % is required"):
        align(stages, as_body(wider))
    front = only(mesh, mesh.vertices[:, 1] < stages.control.mesh.vertices[:, 1].min() + 60.0)
    with pytest.raises(ScanError, match=r"covers \d+ % of the unaffected skin"):
        align(stages, as_body(front))


def test_a_mirror_image_is_refused_where_left_and_right_differ(stages: Stages) -> None:
    mesh, moving = stages.body.mesh, stages.moving.vertices[: stages.moving.count]
    places, left = mesh.vertices.copy(), moving[mesh.vertices[moving, 0] > stages.moving.middle]
    places[left, 1] -= 12.0 * stages.patch.fade[left]  # one breast stands out more
    uneven = mesh.moved(places)
    faces = moving_faces(uneven, stages.binding.moving, stages.moving.middle)
    first = replace(stages, moving=faces, skin=alone(faces, stages.binding))
    flipped = Mesh(places * MIRROR, mesh.faces[:, ::-1])
    for there, fits in ((uneven, True), (flipped, False)):
        body = as_body(there)
        worn = aligned_fitting_scan("worn.ply", body, align(stages, body))
        if fits:
            require_not_mirrored(first, worn)
        else:
            with pytest.raises(ScanError, match="mirror image"):
                require_not_mirrored(first, worn)


def test_arms_held_otherwise_matter_little(stages: Stages) -> None:
    mesh = stages.body.mesh
    x = mesh.vertices[:, 0]
    arm = np.abs(x) > np.abs(stages.control.mesh.vertices[:, 0]).max() + 20.0
    lifted = mesh.vertices + np.where(arm, 30.0, 0.0)[:, None] * (0.0, -1.0, 0.0)
    laid = align(stages, as_body(mesh.moved(lifted)))
    assert laid.matrix == pytest.approx(np.eye(4), abs=0.05)


def test_turned_is_a_rotation_about_its_middle() -> None:
    matrix = rotation_about(np.array([0.0, 0.0, np.pi / 2.0]), np.array([1.0, 0.0, 0.0]))
    assert matrix @ [2.0, 0.0, 3.0, 1.0] == pytest.approx([1.0, 1.0, 3.0, 1.0])


def test_another_mesh_is_the_same_skin() -> None:
    body = flat(0.0)
    other = other_mesh(body)
    assert not np.isin(other.vertices, body.vertices).all()
    places = body.vertices[(np.abs(body.vertices[:, :2] - 50.0) < 40.0).all(axis=1)] + (0.0, 0.0, 1.0)
    assert ScanSurface(other).gaps(places, np.tile((0.0, 0.0, 1.0), (len(places), 1))) == pytest.approx(1.0)
