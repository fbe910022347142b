"""The template of the lower trunk on a body: its rows, its triangles, its distance to the skin, refusals."""

from __future__ import annotations

from dataclasses import replace
from types import MappingProxyType

import numpy as np
import pytest
from whole_trunk import trunk_stages

from core.control_mesh.fit import ControlMesh
from core.control_mesh.hull_arc import half_outline
from core.control_mesh.lower_fit import fit_lower_mesh
from core.control_mesh.lower_places import LowerPlaces
from core.control_mesh.lower_template import BELLY_ROW, FOLD_ROW, HIP_ROW, read_lower_template
from core.control_mesh.validation import agreement, corner_angles
from core.errors import FitError
from core.landmarks.lower_trunk.types import LowerLandmarks
from core.pipeline.lower_region import LowerStages

TEMPLATE = read_lower_template()


@pytest.fixture(scope="module")
def lower() -> LowerStages:
    stages = trunk_stages().lower
    assert stages is not None
    return stages


@pytest.fixture(scope="module")
def alone(lower: LowerStages) -> ControlMesh:
    level = trunk_stages().landmarks.underbust_level
    return fit_lower_mesh(TEMPLATE, lower.body, lower.landmarks, underbust=level)


def moved(landmarks: LowerLandmarks, name: str, by: float) -> LowerLandmarks:
    """Return landmarks with one moved upwards [mm]."""
    mark = landmarks.points[name]
    points = {**landmarks.points, name: replace(mark, position=mark.position + np.array([0.0, 0.0, by]))}
    levels = {**landmarks.levels, name: landmarks.levels[name] + by}
    return replace(landmarks, points=MappingProxyType(points), levels=MappingProxyType(levels))


def test_triangles_lie_on_the_skin_and_none_is_pointed_or_turned(alone: ControlMesh) -> None:
    quality = alone.quality
    assert quality is not None
    assert corner_angles(alone.mesh).min() > 6.0
    assert quality.deviation_mean < 2.7
    assert quality.crossings == 0
    assert agreement(alone.mesh, trunk_stages().body.smoothed).min() > 0.3


def test_rows_follow_the_landmarks(lower: LowerStages, alone: ControlMesh) -> None:
    z, levels = alone.mesh.vertices[:, 2], lower.landmarks.levels
    trunk = np.arange(TEMPLATE.crotch)
    for row, name in ((3, "waist"), (HIP_ROW, "buttock")):
        own = z[trunk[TEMPLATE.row[trunk] == row]]
        assert (
            np.abs(own - levels[name]).max() < 1.5
        )  # easing slides along the row and comes back to the skin
    for side, sign in (("left", 1), ("right", -1)):
        at = TEMPLATE.point(HIP_ROW, 9 * sign)
        np.testing.assert_allclose(
            alone.mesh.vertices[at], lower.landmarks.position(f"buttock_{side}"), atol=1e-9
        )
        assert z[TEMPLATE.point(FOLD_ROW, 9 * sign)] == pytest.approx(levels[f"gluteal_fold_{side}"], abs=1.5)


def test_the_two_sides_of_an_even_body_are_even(alone: ControlMesh) -> None:
    points = alone.mesh.vertices
    other = points[TEMPLATE.mirror] * [-1.0, 1.0, 1.0]
    assert np.median(np.linalg.norm(points - other, axis=1)) < 1.2


def test_upper_rows_join_the_bust_in_front(lower: LowerStages) -> None:
    bust, points = trunk_stages().fitted, lower.control.mesh.vertices
    for row, of_bust in ((0, 1), (1, 0)):
        for column in range(-6, 7):
            there = (bust.row == of_bust) & (bust.column == column)
            np.testing.assert_array_equal(points[TEMPLATE.point(row, column)], bust.mesh.vertices[there][0])


def test_the_belly_row_goes_where_it_is_told(lower: LowerStages, alone: ControlMesh) -> None:
    level = trunk_stages().landmarks.underbust_level
    low = fit_lower_mesh(TEMPLATE, lower.body, lower.landmarks, underbust=level, belly_height=0.55)
    at = TEMPLATE.point(BELLY_ROW, 0)
    way = lower.landmarks.levels["waist"] - lower.landmarks.levels["buttock"]
    assert (alone.mesh.vertices - low.mesh.vertices)[at, 2] == pytest.approx(0.10 * way, abs=1.0)


@pytest.mark.parametrize(("name", "by"), [("waist", 12.0), ("waist", -12.0), ("gluteal_fold_left", -10.0)])
def test_landmarks_that_are_a_little_off_fold_nothing(lower: LowerStages, name: str, by: float) -> None:
    marks = moved(lower.landmarks, name, by)
    level = trunk_stages().landmarks.underbust_level
    control = fit_lower_mesh(TEMPLATE, lower.body, marks, underbust=level)
    assert corner_angles(control.mesh).min() > 3.6


def test_a_fold_over_the_waist_is_refused(lower: LowerStages) -> None:
    marks = moved(lower.landmarks, "gluteal_fold_left", 330.0)
    with pytest.raises(FitError, match="Folded triangles in the control mesh of the lower trunk"):
        fit_lower_mesh(TEMPLATE, lower.body, marks, underbust=trunk_stages().landmarks.underbust_level)


def test_legs_stay_on_their_sides(lower: LowerStages) -> None:
    places = LowerPlaces(TEMPLATE, lower.landmarks, trunk_stages().landmarks.underbust_level, 0.45)
    left, right = (leg[:, 0] - lower.landmarks.position("crotch")[0] for leg in places.legs())
    assert left.min() > 0.0 > right.max()
    assert {len(left), len(right)} == {26}


def test_an_outline_of_both_thighs_is_parted_at_the_middle() -> None:
    both = np.array([[-3.0, 0.0, 5.0], [4.0, 0.0, 5.0], [4.0, 2.0, 5.0], [-3.0, 2.0, 5.0]])
    left, right = (half_outline(both, 1.0, sign) for sign in (1.0, -1.0))
    assert left is not None
    assert right is not None
    assert left.tolist() == [[1.0, 0.0, 5.0], [4.0, 0.0, 5.0], [4.0, 2.0, 5.0], [1.0, 2.0, 5.0]]
    assert (right[:, 0].min(), right[:, 0].max(), len(right)) == (-3.0, 1.0, 4)
    assert half_outline(both, 9.0, 1.0) is None
