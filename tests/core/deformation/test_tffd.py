"""t-FFD: what it must reproduce exactly, by hand and by invariance, for both kinds of weights."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from core.deformation.tffd import bind, deform, deform_moving, movable_border_triangles
from core.geometry import kernels
from core.geometry.mesh import Mesh

BOTH = pytest.mark.parametrize("weights", ["paper", "smooth"])


def hill(nx: int, ny: int, size: float = 100.0) -> Mesh:
    """A gentle hill over a square, nx by ny points, as control mesh or as body."""
    x, y = np.meshgrid(np.linspace(-size, size, nx), np.linspace(-size, size, ny))
    z = 40.0 * np.exp(-(x**2 + (y - 20.0) ** 2) / 60.0**2)
    ids = np.arange(nx * ny).reshape(ny, nx)
    a, b, c, d = ids[:-1, :-1], ids[:-1, 1:], ids[1:, 1:], ids[1:, :-1]
    faces = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
    return Mesh(np.stack([x, y, z], axis=-1).reshape(-1, 3), faces)


def points_only(points: list[list[float]]) -> Mesh:
    return Mesh(np.array(points), np.empty((0, 3), dtype=np.int64))


TRIANGLE = Mesh(np.array([[0.0, 0, 0], [4, 0, 0], [0, 4, 0]]), np.array([[0, 1, 2]]))
CONTROL = hill(7, 6)
BODY = hill(41, 37)
FULL = np.ones(len(BODY.vertices))
RING = (np.abs(CONTROL.vertices[:, :2]) > 99.0).any(axis=1)


@pytest.fixture
def form(request, monkeypatch):
    """Compute in one form of the loops: as defined, or compiled where numba is installed."""
    monkeypatch.setattr(kernels, "_forms", kernels._Forms())
    if request.param == "compiled":
        pytest.importorskip("numba")
        assert kernels.warm(), kernels.state()


FORMS = pytest.mark.parametrize("form", ["defined", "compiled"], indirect=True)


def shaken(control: Mesh, size: float = 5.0) -> np.ndarray:
    return control.vertices + np.random.default_rng(3).normal(scale=size, size=control.vertices.shape)


@BOTH
def test_a_point_above_one_triangle_follows_its_frame(weights):
    binding = bind(points_only([[1.0, 2.0, 3.0]]), TRIANGLE, np.ones(1), weights)
    # (1, 2, 3) is v0 + 1/4 e1 + 1/2 e2 + 3 n. The triangle is stretched, sheared and stood up: n becomes +x.
    moved = np.array([[10.0, 0, 0], [10, 8, 0], [10, 2, 6]])
    assert deform(binding, moved) == pytest.approx(np.array([[13.0, 3.0, 3.0]]), abs=1e-12)


def test_scaled_normals_lift_with_the_root_of_the_area():
    binding = bind(points_only([[1.0, 2.0, 3.0]]), TRIANGLE, np.ones(1), scaled_normals=True)
    moved = TRIANGLE.vertices * [9.0, 4.0, 1.0]
    assert deform(binding, moved) == pytest.approx(np.array([[9.0, 8.0, 18.0]]), abs=1e-12)


def test_the_hat_of_the_paper_by_hand():
    side = 2.0 * np.sqrt(3.0)
    low = np.array([[0.0, 2.0, 0], [-side / 2, -1.0, 0], [side / 2, -1.0, 0]])
    far = low + np.array([6.0, 0.0, 0.0])
    control = Mesh(np.concatenate([low, far]), np.array([[0, 1, 2], [3, 4, 5]]))
    body = points_only([[2.0, 0.0, 0.0], [-4.0, 0.0, 0.0], [-5.0, 0.0, 0.0]])
    lifted = control.vertices.copy()
    lifted[:3, 2] += 1.0
    # The mean radius of both is 2, so the hats end at 5: 1 - 2/5 against 1 - 4/5, alone, and out of reach.
    binding = bind(body, control, np.ones(3), "paper")
    assert deform(binding, lifted)[:, 2] == pytest.approx([0.6 / 0.8, 1.0, 0.0], abs=1e-12)
    assert sorted(binding.moving.tolist()) == [0, 1]


def test_the_smooth_weights_by_hand():
    strip = np.array([[0.0, 0, 0], [20, 0, 0], [0, 20, 0], [30, 0, 0], [50, 0, 0], [30, 20, 0]])
    control = Mesh(strip, np.array([[0, 1, 2], [3, 4, 5]]))
    lifted = strip.copy()
    lifted[:3, 2] += 1.0
    # Areas 200, so sigma is 0.6 sqrt(200); the point is 4 before the second and 6 beside the first triangle.
    binding = bind(points_only([[26.0, 0.0, 0.0]]), control, np.ones(1), "smooth")
    first, second = np.exp(-(36.0 - 16.0) / (2.0 * 0.36 * 200.0)) - 1e-3, 1.0 - 1e-3
    assert deform(binding, lifted)[0, 2] == pytest.approx(first / (first + second), abs=1e-12)


@pytest.mark.parametrize("rows", [0, 1, len(CONTROL.vertices) - 1, len(CONTROL.vertices) + 1])
def test_control_points_of_another_mesh_are_refused(rows):
    binding = bind(BODY, CONTROL, FULL)
    with pytest.raises(ValueError, match=rf"shape \({rows}, 3\)"):
        deform(binding, np.resize(CONTROL.vertices, (rows, 3)))


@BOTH
@FORMS
@pytest.mark.parametrize("scaled", [False, True])
@pytest.mark.parametrize("single", [False, True])
def test_rest_is_kept_bit_for_bit(weights, form, scaled, single):
    fade = np.random.default_rng(1).random(len(BODY.vertices))
    for fixed in (None, RING):
        binding = bind(BODY, CONTROL, fade, weights, scaled_normals=scaled, fixed=fixed, single=single)
        assert np.array_equal(deform(binding, CONTROL.vertices.copy()), BODY.vertices)


@BOTH
@FORMS
@pytest.mark.parametrize("scaled", [False, True])
@pytest.mark.parametrize(("single", "error"), [(False, 1e-9), (True, 1e-3)])
def test_a_rigid_motion_is_followed(weights, form, scaled, single, error):
    """In single precision to a millionth of the way, here up to 900 mm."""
    turn = Rotation.from_rotvec([0.4, -1.1, 0.7]).as_matrix().T
    shift = np.array([120.0, -35.0, 800.0])
    binding = bind(BODY, CONTROL, FULL, weights, scaled_normals=scaled, single=single)
    moved = deform(binding, CONTROL.vertices @ turn + shift)
    assert np.abs(moved - (BODY.vertices @ turn + shift)).max() < error


@BOTH
@FORMS
def test_single_precision_is_exact_to_a_ten_thousandth(weights, form):
    """For motions as large as a garment makes them."""
    double, single = (bind(BODY, CONTROL, FULL, weights, fixed=RING, single=s) for s in (False, True))
    moved = np.where(RING[:, None], CONTROL.vertices, shaken(CONTROL, 20.0))
    assert single.operator.weights.nbytes < 0.51 * double.operator.weights.nbytes
    assert np.abs(deform(single, moved) - deform(double, moved)).max() < 1e-4


@BOTH
def test_what_cannot_change_is_left_out_and_changes_nothing(weights):
    moved = np.where(RING[:, None], CONTROL.vertices, shaken(CONTROL))
    whole, part = bind(BODY, CONTROL, FULL, weights), bind(BODY, CONTROL, FULL, weights, fixed=RING)
    assert np.abs(deform(part, moved) - deform(whole, moved)).max() < 1e-11
    points, triangles = part.changes.points, part.changes.triangles
    assert np.array_equal(points, np.flatnonzero(~RING))
    assert np.array_equal(triangles, np.flatnonzero(~RING[CONTROL.faces].all(axis=1)))
    assert part.operator.columns.max() < len(points) + len(triangles)
    assert part.operator.weights.size < whole.operator.weights.size


@BOTH
def test_a_few_rows_as_a_matrix_and_all_of_them_before_others(weights):
    binding = bind(BODY, CONTROL, FULL, weights, fixed=RING)
    moved, rows = shaken(CONTROL), np.array([700, 3, 41, 3])
    ours = binding.rest_moving[rows] + binding.operator.of_rows(rows) @ binding.changes.of(moved)
    assert np.abs(ours - deform_moving(binding, moved)[rows]).max() < 1e-11
    longer = np.concatenate([binding.rest_moving, BODY.vertices[:5]])
    places = binding.operator.apply(binding.changes.of(moved), longer)
    assert np.array_equal(places[:-5], deform_moving(binding, moved))
    assert np.array_equal(places[-5:], BODY.vertices[:5])


@BOTH
@FORMS
def test_a_similarity_is_followed_with_scaled_normals_only(weights, form):
    scaled = deform(bind(BODY, CONTROL, FULL, weights, scaled_normals=True), 1.3 * CONTROL.vertices)
    assert np.abs(scaled - 1.3 * BODY.vertices).max() < 1e-9
    plain = deform(bind(BODY, CONTROL, FULL, weights), 1.3 * CONTROL.vertices)
    assert np.abs(plain - 1.3 * BODY.vertices).max() > 0.1


@BOTH
def test_a_flat_control_mesh_carries_any_shear_of_its_plane(weights):
    flat = CONTROL.moved(CONTROL.vertices * [1.0, 1.0, 0.0])
    shear = np.array([[1.2, 0.3, 0.0], [-0.1, 0.9, 0.0], [0.0, 0.0, 1.0]])
    moved = deform(bind(BODY, flat, FULL, weights), flat.vertices @ shear.T)
    assert np.abs(moved - BODY.vertices @ shear.T).max() < 1e-9


@BOTH
def test_motions_add_up_where_no_normal_turns(weights):
    flat = CONTROL.moved(CONTROL.vertices * [1.0, 1.0, 0.0])
    binding = bind(BODY, flat, FULL, weights)
    random = np.random.default_rng(5)
    one, two = (random.normal(size=flat.vertices.shape) * [2.0, 2.0, 0.0] for _ in range(2))
    together = deform(binding, flat.vertices + one - 3.0 * two) - BODY.vertices
    apart = (
        deform(binding, flat.vertices + one) - BODY.vertices,
        deform(binding, flat.vertices + two) - BODY.vertices,
    )
    assert np.abs(together - (apart[0] - 3.0 * apart[1])).max() < 1e-11
    assert np.abs(together).max() > 1.0


@BOTH
def test_fade_scales_the_motion_and_stills_the_rest(weights):
    fade = np.clip(BODY.vertices[:, 0] / 50.0, 0.0, 1.0)
    full = deform(bind(BODY, CONTROL, FULL, weights), shaken(CONTROL)) - BODY.vertices
    binding = bind(BODY, CONTROL, fade, weights)
    part = deform(binding, shaken(CONTROL))
    assert np.abs(part - BODY.vertices - fade[:, None] * full).max() < 1e-11
    assert np.array_equal(part[fade == 0.0], BODY.vertices[fade == 0.0])
    assert np.array_equal(np.sort(binding.moving), np.flatnonzero(fade))


@BOTH
def test_the_moving_rows_are_the_rows_of_the_whole(weights):
    fade = (BODY.vertices[:, 1] > 10.0).astype(float)
    binding = bind(BODY, CONTROL, fade, weights)
    moved = shaken(CONTROL)
    assert np.array_equal(deform_moving(binding, moved), deform(binding, moved)[binding.moving])


@BOTH
def test_the_mirrored_body_moves_mirrored(weights):
    mirror = np.array([-1.0, 1.0, 1.0])
    body = Mesh(BODY.vertices * mirror, BODY.faces[:, ::-1])
    control = Mesh(CONTROL.vertices * mirror, CONTROL.faces[:, ::-1])
    ours = deform(bind(BODY, CONTROL, FULL, weights), shaken(CONTROL))
    theirs = deform(bind(body, control, FULL, weights), shaken(CONTROL) * mirror)
    assert np.abs(theirs - ours * mirror).max() < 1e-9


@BOTH
def test_order_of_control_triangles_does_not_matter(weights):
    order = np.random.default_rng(8).permutation(len(CONTROL.faces))
    other = Mesh(CONTROL.vertices, np.roll(CONTROL.faces[order], 1, axis=1))
    ours = deform(bind(BODY, CONTROL, FULL, weights), shaken(CONTROL))
    assert np.abs(deform(bind(BODY, other, FULL, weights), shaken(CONTROL)) - ours).max() < 1e-9


@BOTH
def test_a_degenerate_triangle_has_no_say(weights):
    sliver = np.concatenate([CONTROL.faces, [[0, 1, 2]], [[3, 3, 9]]])
    assert Mesh(CONTROL.vertices, sliver).face_areas[-1] == 0.0
    line = CONTROL.vertices.copy()
    line[:3] = [[-100.0, -100.0, 0.0], [-80.0, -100.0, 0.0], [-60.0, -100.0, 0.0]]
    clean, spoilt = Mesh(line, CONTROL.faces), Mesh(line, sliver)
    ours = deform(bind(BODY, clean, FULL, weights), shaken(clean))
    assert np.abs(deform(bind(BODY, spoilt, FULL, weights), shaken(clean)) - ours).max() < 1e-9


@BOTH
def test_no_usable_triangle_and_no_fade_move_nothing(weights):
    needle = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0]]), np.array([[0, 1, 2]]))
    for binding in (bind(BODY, needle, FULL, weights), bind(BODY, CONTROL, 0.0 * FULL, weights)):
        assert len(binding.moving) == 0
        assert np.array_equal(deform(binding, binding.changes.control.vertices + 5.0), BODY.vertices)


def test_the_smooth_weights_end_without_a_step():
    line = np.stack([np.linspace(-100.0, 100.0, 20001), np.full(20001, 3.0), np.full(20001, 30.0)], axis=1)
    body = Mesh(line, np.empty((0, 3), dtype=np.int64))
    motion = deform(bind(body, CONTROL, np.ones(20001), "smooth"), shaken(CONTROL)) - line
    # A step shows twice in the second differences; dropping weights of 1e-3 unlowered would make 0.014 mm.
    assert np.abs(np.diff(motion, 2, axis=0)).max() < 1e-3


def test_the_outermost_ring_must_not_move():
    grid = np.abs(CONTROL.vertices[:, :2])
    two_rings = (grid[:, 0] > 66.0) | (grid[:, 1] > 59.0)
    assert len(movable_border_triangles(CONTROL, two_rings)) == 0
    # The triangles of the outer cells (6 x 5 of them, 4 x 3 within), but for those fixed at the corners.
    outer = np.array([RING[face].any() for face in CONTROL.faces])
    assert np.array_equal(
        movable_border_triangles(CONTROL, RING), np.flatnonzero(outer & ~RING[CONTROL.faces].all(axis=1))
    )
    assert movable_border_triangles(CONTROL, two_rings & (np.arange(42) != 8)).tolist() != []
    closed = Mesh(np.eye(4, 3), np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]))
    assert len(movable_border_triangles(closed, np.zeros(4, dtype=bool))) == 0
