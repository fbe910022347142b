"""A body in any unit, on any axes, turned any way, stands up in mm, facing -y; what is no body is refused."""

from dataclasses import replace
from itertools import permutations, product

import numpy as np
import pytest
import trimesh
from coarse_bodies import coarse_arrays
from scipy.spatial.transform import Rotation

from core.errors import ScanError
from core.scan.orientation import pose as upright
from core.scan.orientation.pose import AXES, MILLIMETRES, estimate_pose
from core.scan.orientation.symmetry_planes import mirror_planes, sample_uniformly

CANONICAL = np.eye(4)


@pytest.fixture(scope="module")
def mannequin():
    return coarse_arrays("mannequin")


def torso(bust_at=(-1.0,), height=600.0):
    """Make an open elliptic tube, 300 by 200 mm, narrow above, with two half balls on each side of y."""
    angle, level = np.meshgrid(
        np.linspace(0, 2 * np.pi, 180, endpoint=False), np.arange(0.0, height + 1, 8.0)
    )
    slim = 1.0 - 0.5 * np.clip((level - 450.0) / 150.0, 0.0, 1.0)
    x, y = 150.0 * slim * np.cos(angle), 100.0 * slim * np.sin(angle)
    depth = np.zeros_like(x)
    for side, sign in product((-70.0, 70.0), bust_at):
        reach = 1.0 - ((x - side) ** 2 + (level - 330.0) ** 2) / 70.0**2
        depth += np.where(y * sign > 0, sign * 60.0 * np.sqrt(np.clip(reach, 0.0, None)), 0.0)
    vertices = np.stack([x, y + depth, level], axis=-1).reshape(-1, 3)
    rows, columns = level.shape
    corner = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = corner[:-1], np.roll(corner, -1, 1)[:-1], np.roll(corner, -1, 1)[1:], corner[1:]
    faces = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    return vertices, faces


def axis_orders():
    """Return the 24 turns that take axes to axes."""
    turns = []
    for order, signs in product(permutations(range(3)), product((1.0, -1.0), repeat=3)):
        turn = np.zeros((3, 3))
        turn[range(3), order] = signs
        if np.linalg.det(turn) > 0.0:
            turns.append(turn)
    return turns


def angle_between(pose, file_from_canonical):
    """Return the angle between the turn that was found and the true one [degrees]."""
    turn = pose.file_to_mm[:3, :3] @ file_from_canonical
    turn = turn / np.cbrt(np.linalg.det(turn))
    return float(np.degrees(Rotation.from_matrix(turn).magnitude()))


@pytest.mark.parametrize("start", range(4))
def test_every_axis_order_with_a_yaw_and_another_unit_stands_up(mannequin, start):
    vertices, faces = mannequin
    units = list(MILLIMETRES)
    for k, order in list(enumerate(axis_orders()))[start::4]:
        unit = units[(k // 4) % 4]
        turn = order @ Rotation.from_euler("z", 11.0 + 3.0 * k, degrees=True).as_matrix()
        pose = estimate_pose(vertices @ turn.T / MILLIMETRES[unit], faces)
        assert pose.unit == unit
        assert pose.is_certain
        assert pose.up == max(AXES, key=lambda name: AXES[name] @ turn[:, 2])
        assert angle_between(pose, turn) < 0.1
        assert np.linalg.det(pose.file_to_mm[:3, :3]) == pytest.approx(MILLIMETRES[unit] ** 3)


def test_a_slight_turn_is_snapped_to_the_axes_and_a_larger_one_is_undone(mannequin):
    vertices, faces = mannequin
    for yaw, exact in ((1.2, True), (2.5, False)):
        turn = Rotation.from_euler("z", yaw, degrees=True).as_matrix()
        pose = estimate_pose(vertices @ turn.T, faces)
        assert np.array_equal(pose.file_to_mm, CANONICAL) == exact
        assert angle_between(pose, turn) == pytest.approx(yaw if exact else 0.0, abs=0.1)


def test_exact_axes_give_a_signed_permutation_times_the_unit():
    vertices, faces = torso()
    turn = np.array(
        [[0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]]
    )  # file x is the front, file y is up
    pose = estimate_pose(vertices @ turn.T / 25.4, faces)
    assert (pose.unit, pose.up, pose.front) == ("inch", "+y", "+x")
    expected = np.eye(4)
    expected[:3, :3] = 25.4 * turn.T
    assert np.array_equal(pose.file_to_mm, expected)
    assert np.array_equal(pose.file_to_mm[:3, 3], np.zeros(3))


def test_the_girth_in_the_reason_is_that_of_the_tube():
    vertices, faces = torso()
    girth = float(str(estimate_pose(vertices, faces).reason).split("trunk girth is ")[1].split(" ")[0])
    ellipse = 793.3  # perimeter of an ellipse with half axes 150 and 100, by Ramanujan's formula
    assert ellipse - 8.0 < girth < 1.2 * ellipse  # the bust adds to the tape, corners of the tube are cut


def test_a_bust_on_both_sides_is_not_sure_until_told():
    vertices, faces = torso(bust_at=(-1.0, 1.0))
    pose = estimate_pose(vertices, faces)
    assert not pose.is_certain
    assert pose.margin < 0.6
    assert "are uncertain" in str(pose.reason)
    for front in ("+y", "-y"):
        told = estimate_pose(vertices, faces, up="+z", front=front)
        assert told.is_certain
        assert (told.up, told.front) == ("+z", front)
        assert "set manually" in str(told.reason)


def test_up_and_front_can_be_told_against_the_shape():
    vertices, faces = torso()
    for up, front in (("-z", "-y"), ("+z", "+y"), ("+y", "-x"), ("-x", "+z")):
        turn = estimate_pose(vertices, faces, up=up, front=front, unit="mm").file_to_mm[:3, :3]
        assert turn @ AXES[up] == pytest.approx([0.0, 0.0, 1.0], abs=1e-9)
        assert turn @ AXES[front] @ [0.0, -1.0, 0.0] > 0.7
        assert np.linalg.det(turn) == pytest.approx(1.0)


def test_a_told_front_alone_keeps_the_up_of_the_shape():
    vertices, faces = torso()
    assert estimate_pose(vertices, faces, front="-y").up == "+z"


@pytest.mark.parametrize(
    "shape",
    [
        trimesh.creation.box((300.0, 300.0, 300.0)),
        trimesh.creation.box((340.0, 220.0, 700.0)),
        trimesh.creation.icosphere(subdivisions=4, radius=150.0),
        trimesh.creation.cylinder(140.0, 700.0),
        trimesh.Trimesh([[0, 0, 0], [300, 0, 0], [0, 0, 800]], [[0, 1, 2]]),
        trimesh.Trimesh([[0, 0, 0], [300, 0, 0], [600, 0, 0]], [[0, 1, 2]], process=False),
    ],
    ids=["cube", "brick", "ball", "pillar", "triangle", "line"],
)
def test_what_is_no_body_is_refused(shape):
    with pytest.raises(ScanError, match=r"upper body|No trunk"):
        estimate_pose(np.asarray(shape.vertices), np.asarray(shape.faces))


def test_half_a_body_is_refused(mannequin):
    vertices, faces = mannequin
    with pytest.raises(ScanError, match="upper body"):
        estimate_pose(vertices, faces[(vertices[faces][:, :, 0] > 0.0).all(axis=1)])


def test_a_body_of_no_human_size_is_refused_unless_the_unit_is_told_so():
    vertices, faces = torso()
    vertices = vertices * 0.25
    with pytest.raises(ScanError, match="in any unit"):
        estimate_pose(vertices, faces)
    with pytest.raises(ScanError, match="In mm, the trunk girth would be 198"):
        estimate_pose(vertices, faces, unit="mm")
    assert estimate_pose(vertices, faces, unit="cm").unit == "cm"


@pytest.mark.parametrize(
    ("told", "words"),
    [
        ({"unit": "foot"}, "unit 'foot'"),
        ({"up": "w"}, "axis 'w'"),
        ({"up": "+z", "front": "-z"}, "same axis"),
    ],
)
def test_a_wrong_word_is_refused_with_the_choices(told, words):
    with pytest.raises(ScanError, match=words):
        estimate_pose(*torso(), **told)


def test_the_mirror_plane_of_a_turned_and_shifted_body_is_found_to_a_tenth_of_a_degree():
    vertices, faces = torso()
    turn = Rotation.from_euler("z", 71.0, degrees=True).as_matrix()
    plane = mirror_planes(sample_uniformly(vertices @ turn.T + [40.0, -25.0, 300.0], faces))[0]
    side = turn[:, 0] * np.sign(turn[:, 0] @ plane.side)
    assert np.degrees(np.arccos(min(1.0, plane.side @ side))) < 0.1
    assert plane.offset == pytest.approx(plane.side @ [40.0, -25.0, 300.0], abs=0.5)
    assert plane.residual < 0.1


def test_even_points_do_not_follow_the_triangles():
    coarse = trimesh.creation.box((200.0, 300.0, 400.0))
    fine = coarse.subdivide().subdivide().subdivide()
    one, other = (sample_uniformly(np.asarray(m.vertices), np.asarray(m.faces)) for m in (coarse, fine))
    for cloud, points in ((one, other.points), (other, one.points)):
        gap = np.linalg.norm(cloud.points[cloud.partner(points)] - points, axis=1).max()
        assert gap < 3.0 * cloud.grain  # a wider one would pass for the air between trunk and arm
    on_skin = np.isclose(np.abs(one.points), [100.0, 150.0, 200.0], atol=one.grain).any(axis=1)
    assert on_skin.all()
    assert (one.partner(one.points) == np.arange(len(one.points))).all()
    assert (one.partner(one.points + 1e6) == -1).all()


def test_even_points_do_not_follow_the_order_of_the_triangles(mannequin):
    vertices, faces = mannequin
    halves = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1) @ [len(vertices), 1]
    edges, at = np.unique(halves, return_inverse=True)
    ab, bc, ca = len(vertices) + at.reshape(-1, 3).T
    a, b, c = faces.T
    blocks = ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))  # each in the order of the whole
    middles = 0.5 * (vertices[edges // len(vertices)] + vertices[edges % len(vertices)])
    split = np.concatenate([np.stack(block, axis=1) for block in blocks])
    coarse, fine = (
        sample_uniformly(vertices, faces),
        sample_uniformly(np.concatenate([vertices, middles]), split),
    )
    assert len(fine.points) == pytest.approx(len(coarse.points), rel=0.02)
    gaps = np.linalg.norm(fine.points[fine.partner(coarse.points)] - coarse.points, axis=1)
    assert gaps.max() < 2.0 * fine.grain


def test_a_way_to_stand_that_seems_better_until_it_is_set_upright_gives_way(monkeypatch):
    real = upright.rank_candidates

    def raised(stance, more):
        tilted = 0.8 < stance.up[2] < 0.99 and stance.back[1] > 0.8
        return replace(stance, evidence=stance.evidence + more) if tilted else stance

    monkeypatch.setattr(
        upright, "rank_candidates", lambda *told: [raised(stance, 1.5) for stance in real(*told)]
    )
    monkeypatch.setattr(upright, "refine_candidate", lambda cloud, stance: raised(stance, -3.0))
    assert angle_between(estimate_pose(*torso()), CANONICAL[:3, :3]) < 3.0


def test_the_next_way_to_stand_is_set_upright_too_where_the_best_one_then_looks_worse(monkeypatch):
    real, asked = upright.rank_candidates, []

    def settled(cloud, stance):
        asked.append(stance)
        return replace(stance, evidence=stance.evidence - 6.0)

    def leading(*told):
        return [replace(s, evidence=s.evidence + 3.0 * (s.up[2] > 0.0)) for s in real(*told)]

    monkeypatch.setattr(upright, "rank_candidates", leading)
    monkeypatch.setattr(upright, "refine_candidate", settled)
    with pytest.raises(ScanError):
        estimate_pose(*torso(), front="-y")
    assert len({stance.up[2] > 0.0 for stance in asked}) == 2
