"""How left and right differ: what is known of a body is read back, and a mirror turns every sign."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from shapes import mirrored as mirrored_control
from whole_trunk import wearing as whole_trunk

from app.presenters.samples import sample_design
from core.analysis.inverse_design.bust_quantities import FURTHER_OUT, HIGHER
from core.analysis.inverse_design.quantities import reading
from core.analysis.symmetry.compare import NO_BREAST, compare_sides, symmetry_rows
from core.deformation.blend_region import blend_weights
from core.deformation.incremental_normals import moving_faces
from core.deformation.tffd import bind
from core.geometry.mesh import Mesh, Points
from core.geometry.mirror_plane import MIRROR
from core.landmarks.bust_point import ACROSS
from core.landmarks.types import Landmarks
from core.measurements.mirrored_surface import MirroredSurface
from core.measurements.table import before_after
from core.pipeline.build import Stages, build
from core.pipeline.observables import BodyObservables
from core.pipeline.solve import solve

BALL_AT = 12.0


def ball(count: int = 120) -> Mesh:
    """A ball of 100 mm round x = 12 mm that is its own mirror image."""
    turn, high = np.meshgrid(
        np.linspace(0.0, 2.0 * np.pi, count, endpoint=False), np.linspace(-1.5, 1.5, 80), indexing="ij"
    )
    places = np.stack([np.cos(high) * np.sin(turn), -np.cos(high) * np.cos(turn), np.sin(high)], axis=-1)
    i, j = np.meshgrid(np.arange(count), np.arange(79), indexing="ij")
    at = [((i + a) % count * 80 + j + b).ravel() for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
    faces = np.concatenate([np.stack(at[:3], axis=1), np.stack([at[0], at[2], at[3]], axis=1)])
    return Mesh(100.0 * places.reshape(-1, 3) + [BALL_AT, 0.0, 0.0], faces)


BALL = ball()
FRONT = BALL.vertices[:, 1] < -20.0


def bulged(out: float, side: float = 1.0) -> tuple[Points, float]:
    """Places of the ball with a bulge on one side, and its volume [ml]."""
    middle = np.array([BALL_AT + side * 60.0, -80.0, 0.0])
    share = np.exp(-(((BALL.vertices - middle) / 25.0) ** 2).sum(axis=1))
    places = BALL.vertices + out * share[:, None] * BALL.vertex_normals
    return places, (BALL.moved(places).enclosed_volume() - BALL.enclosed_volume()) / 1000.0


@pytest.fixture(scope="module")
def mirrored() -> MirroredSurface:
    return MirroredSurface(BALL, ~FRONT, FRONT, 9.0)


def test_an_even_body_has_nothing_between_its_sides(mirrored: MirroredSurface) -> None:
    assert mirrored.middle == pytest.approx(BALL_AT, abs=1e-6)
    gap = mirrored.gap(BALL.vertices)
    assert gap is not None
    assert (gap.mean, gap.largest, gap.absolute_total) == pytest.approx((0.0, 0.0, 0.0), abs=1e-6)
    assert gap.seen == 1.0


@pytest.mark.parametrize("out", [0.5, 3.0, 8.0, -3.0])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_known_bulge_is_read_back_in_ml_and_mm(mirrored: MirroredSurface, out: float, side: float) -> None:
    places, ml = bulged(out, side)
    gap = mirrored.gap(places)
    assert gap is not None
    assert gap.left_more - gap.right_more == pytest.approx(side * ml, rel=0.02)
    assert gap.total == gap.left_more - gap.right_more
    assert gap.absolute_total == pytest.approx(abs(ml), rel=0.03)
    assert gap.largest == pytest.approx(abs(out), rel=0.06)
    # What stands out is the bulge itself, or the other side where there is a dent.
    assert gap.side == ("left" if side * out > 0.0 else "right")
    assert abs(places[gap.vertex, 0] - BALL_AT) == pytest.approx(60.0, abs=8.0)


def test_a_mirror_changes_the_sides_and_nothing_else(mirrored: MirroredSurface) -> None:
    left, right = (mirrored.gap(bulged(4.0, side)[0]) for side in (1.0, -1.0))
    assert left is not None
    assert right is not None
    assert (left.left_more, left.right_more) == pytest.approx((right.right_more, right.left_more), abs=1e-6)
    assert (left.mean, left.largest) == pytest.approx((right.mean, right.largest), abs=1e-6)
    assert (left.side, right.side) == ("left", "right")


def test_skin_without_counterpart_does_not_count(mirrored: MirroredSurface) -> None:
    kept = (BALL.vertices[BALL.faces][..., 0] > BALL_AT - 60.0).all(axis=1)
    used, faces = np.unique(BALL.faces[kept], return_inverse=True)
    cut = Mesh(BALL.vertices[used], faces.reshape(-1, 3))
    gap = MirroredSurface(cut, ~FRONT[used], FRONT[used], BALL_AT).gap(cut.vertices)
    assert gap is not None
    assert 0.4 < gap.seen < 0.95
    assert gap.mean < 0.25  # by the cut the nearest skin across lies beside the place itself
    assert mirrored.gap(np.full_like(BALL.vertices, np.nan)) is None


def in_the_mirror(stages: Stages, control_points: Points) -> tuple[Stages, Points]:
    """The body, its landmarks and its control mesh in a mirror, as if they had been scanned so."""
    mesh, swap = stages.body.mesh, {"left": "right", "right": "left"}
    body = replace(stages.body, mesh=Mesh(mesh.vertices * MIRROR, mesh.faces[:, ::-1]))
    points = {}
    for name, mark in stages.landmarks.points.items():
        stem, _, side = name.rpartition("_")
        there = f"{stem}_{swap[side]}" if side in swap else name
        points[there] = replace(
            mark, name=there, position=mark.position * MIRROR, evidence=mark.evidence * MIRROR
        )
    landmarks = replace(stages.landmarks, points=points)
    control, was = mirrored_control(stages.control)
    patch = blend_weights(body.mesh, control)
    binding = bind(body.mesh, control.mesh, patch.fade, fixed=control.fixed)
    moving = moving_faces(body.mesh, binding.moving, -stages.moving.middle)
    watch = BodyObservables(binding, control, landmarks)
    made = {"control": control, "patch": patch, "binding": binding, "moving": moving, "watch": watch}
    twin = replace(stages, body=body, landmarks=landmarks, **made)
    return twin, control_points[was] * MIRROR


@pytest.fixture(scope="module")
def person() -> Stages:
    return build(replace(sample_design("person"), volume="exact").with_line("mid-bust", 0.9))


def test_figures_are_those_of_marks_measures_and_what_can_be_asked_for(person: Stages) -> None:
    points = solve(person).control_points
    told = compare_sides(person, points)
    marks, rest = person.watch(points), person.rest_marks
    assert told.before.higher == pytest.approx(rest.bust_point_left_z - rest.bust_point_right_z)
    assert told.after.higher == pytest.approx(marks.bust_point_left_z - marks.bust_point_right_z)
    assert told.after.further_out == pytest.approx(marks.bust_point_left_out - marks.bust_point_right_out)
    assert told.after.higher == pytest.approx(reading(person, HIGHER)(points).value)
    assert told.after.further_out == pytest.approx(reading(person, FURTHER_OUT)(points).value)
    left, right = person.body_change(points) / 1000.0
    assert told.before.skin is not None
    assert told.after.skin is not None
    # Where one breast sits 12 mm lower, the volume between the skins is known within 4 ml.
    assert told.after.skin.total - told.before.skin.total == pytest.approx(left - right, abs=4.0)
    table = [each["asymmetry_volume"].value for each in before_after(person, points)]
    assert table == [told.before.skin.total, told.after.skin.total], "one value in table, report and card"
    assert told.before.largest_difference == abs(told.before.higher)
    assert told.notes == ()


def test_a_body_in_the_mirror_has_all_with_the_other_sign(person: Stages) -> None:
    points = solve(person).control_points
    told, twin = compare_sides(person, points), compare_sides(*in_the_mirror(person, points))
    for here, there in ((told.before, twin.before), (told.after, twin.after)):
        assert there.higher == pytest.approx(-here.higher, abs=1e-3)
        assert there.further_out == pytest.approx(-here.further_out, abs=1e-3)
        assert there.further_lateral == pytest.approx(-here.further_lateral, abs=0.01)
        assert here.skin is not None
        assert there.skin is not None
        assert there.skin.mean == pytest.approx(here.skin.mean, rel=1e-3)
        assert there.skin.left_more == pytest.approx(here.skin.right_more, rel=1e-3)
        assert there.skin.right_more == pytest.approx(here.skin.left_more, rel=1e-3)


def test_an_even_sample_is_even_within_a_tenth(built: Callable[[str], Stages]) -> None:
    stages = built("mannequin")
    told = compare_sides(stages, stages.control.mesh.vertices).before
    assert abs(told.higher) < 0.1
    assert abs(told.further_out) < 0.1
    assert abs(told.further_lateral) < 0.1
    assert told.skin is not None
    assert told.skin.mean < 0.1
    assert told.skin.absolute_total < 1.0


def test_what_is_not_known_is_said(built: Callable[[str], Stages]) -> None:
    stages = built("person")
    marks = stages.landmarks
    across = replace(marks.points["bust_point_left"], rule=ACROSS)
    one = Landmarks(
        {**marks.points, "bust_point_left": across}, marks.bust_level, marks.underbust_level, marks.warnings
    )
    told = compare_sides(replace(stages, landmarks=one), stages.control.mesh.vertices)
    assert told.notes == (NO_BREAST,)


def test_a_sling_on_one_side_lifts_the_seat_of_that_side() -> None:
    stages = whole_trunk({"sling-left": 0.95, "buttock-lift-left": 0.96})
    told = compare_sides(stages, *solve(stages).region_points)
    assert told.before.seat is not None
    assert told.after.seat is not None
    assert abs(told.before.seat.fold_higher) < 0.5
    assert told.after.seat.fold_higher > 2.0
    assert told.after.seat.higher > 0.5
    rows = {row.key: row for row in symmetry_rows(told.before, told.after)}
    assert rows["seat_fold_higher"].after == told.after.seat.fold_higher
    assert told.after.higher == told.before.higher, "the bust stays"
