"""A profile that is drawn: the skin as it is, pulled by handles, smooth in between."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.presenters.samples import sample_design
from core.analysis.inverse_design.profile_curve import (
    FARTHEST,
    ProfileCurve,
    profile_at,
    profile_from_table,
    profile_points,
)
from core.analysis.inverse_design.profile_quantities import profile_name
from core.analysis.inverse_design.quantities import reading
from core.garment.presets import built_in, with_preset
from core.pipeline.build import Stages, build
from core.pipeline.solve import exact_solution


def body(name: str) -> Stages:
    return build(replace(sample_design(name), volume="exact").with_line("mid-bust", 0.97))


@pytest.fixture(scope="module")
def stages() -> Stages:
    return body("mannequin")


@pytest.fixture(scope="module")
def profile(stages: Stages) -> ProfileCurve:
    return profile_at(stages, "left", stages.control.mesh.vertices)


def test_it_begins_with_the_skin_and_asks_for_nothing(stages: Stages, profile: ProfileCurve) -> None:
    points = stages.control.mesh.vertices
    for height, out in profile.base[::8].tolist():
        assert out == pytest.approx(reading(stages, profile_name("left", height))(points).value, abs=1e-3)
    assert profile.curve == pytest.approx(profile.base)
    assert profile.goals(stages) == ()
    assert 3 <= len(profile.handles) <= 6
    foremost = profile.base[:, 1].argmax()
    assert foremost in profile.handles
    places = profile_points(stages, profile, points)
    assert places[:, 2] == pytest.approx(profile.base[:, 0])
    assert -places[:, 1] == pytest.approx(profile.base[:, 1])
    assert np.ptp(places[:, 0]) == 0.0


def test_a_pulled_handle_takes_the_curve_along_softly(stages: Stages, profile: ProfileCurve) -> None:
    pulled = profile.with_moved_handle(1, 4.0, -3.0)
    before, here, after = profile.handles[:3]
    assert pulled.handle_positions[1] == pytest.approx(profile.base[here] + [4.0, -3.0])
    assert pulled.curve[here] == pytest.approx(pulled.handle_positions[1])
    moved = pulled.curve - profile.base
    assert moved[[before, after]] == pytest.approx(np.full((2, 2), [2.0, -1.5])), "those beside it follow"
    assert np.abs(moved[profile.handles[3] :]).max() == 0.0, "no further"
    assert moved.min(axis=0) == pytest.approx([0.0, -3.0]), "nowhere beyond the handles"
    assert moved.max(axis=0) == pytest.approx([4.0, 0.0])
    steps = np.diff(moved[:, 0])
    assert np.abs(np.diff(steps)).max() < 0.5 * np.abs(steps).max(), "no kink, at the ends neither"
    assert np.abs(steps[[0, -1]]).max() < 0.5 * np.abs(steps).max()
    # What is asked for is that curve, every 5 mm.
    goals = pulled.goals(stages)
    heights, outs = np.array([(float(goal.name.split()[2]), goal.value) for goal in goals]).T
    assert np.diff(heights) == pytest.approx(5.0)
    assert outs == pytest.approx(np.interp(heights, *pulled.curve.T), abs=1e-6)


def test_a_handle_that_a_hand_has_set_stays(profile: ProfileCurve) -> None:
    pulled = profile.with_moved_handle(1, 0.0, 4.0).with_moved_handle(2, 0.0, 6.0)
    assert pulled.steps[:, 1] == pytest.approx([2.0, 4.0, 8.0, 3.0])
    again = pulled.with_moved_handle(1, 0.0, -4.0)
    assert again.steps[:3, 1] == pytest.approx([0.0, 0.0, 8.0])


def test_a_handle_goes_only_so_far_and_the_ends_stay(profile: ProfileCurve) -> None:
    far = profile
    for _ in range(3):
        far = far.with_moved_handle(0, 0.0, 40.0)
    assert far.steps[0].tolist() == [0.0, FARTHEST]
    assert far.curve[[0, -1]] == pytest.approx(profile.base[[0, -1]])
    assert profile.steps.max() == 0.0, "the one before is as it was"


def test_where_a_breast_hangs_over_the_lower_end_is_a_handle() -> None:
    stages = body("person")
    profile = profile_at(stages, "left", stages.control.mesh.vertices)
    assert profile.handles[0] == 0
    assert profile.base[0, 0] > stages.control.mesh.vertices[~stages.control.fixed, 2].min() + 2.0
    assert profile.with_moved_handle(0, 0.0, 5.0).curve[0, 1] == pytest.approx(profile.base[0, 1] + 5.0)
    # Lifted it hangs over further up: its outline ends there, and does not jump to the chest.
    lifted = with_preset(stages.design, next(each for each in built_in() if each.title == "Bra"))
    for name in ("strap left", "strap right"):
        lifted = lifted.with_line(name, 0.86)
    places = profile_points(stages, profile, exact_solution(build(lifted, stages)).place.points)
    assert len(places) > 0.5 * len(profile.base)
    assert np.abs(np.diff(places[:, 1])).max() < 3.0 * np.diff(places[:, 2]).max()


def test_a_table_is_asked_for_as_it_is_and_can_be_dragged_on(stages: Stages, profile: ProfileCurve) -> None:
    table = profile.base[::2] + np.array([0.0, 1.0])
    given = profile_from_table(stages, "left", table)
    goals = given.goals(stages)
    assert [goal.value for goal in goals] == pytest.approx(table[:, 1].tolist())
    pulled = given.with_moved_handle(1, 0.0, 4.0)
    assert max(goal.value for goal in pulled.goals(stages)) > max(goal.value for goal in goals) + 3.0
    assert len(profile_from_table(stages, "left", table[:3]).handles) == 0
