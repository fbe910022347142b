"""The verdict on runs whose course is made by hand."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.solver import Record
from core.verdict import SETTLED_STEP, judge


def course(errors, steps=1.0):
    steps = np.broadcast_to(steps, len(errors))
    return [
        Record(turn, float(error), 2600.0 * float(error), float(step), ())
        for turn, (error, step) in enumerate(zip(errors, steps, strict=True), start=1)
    ]


TURNS = np.arange(60)
FLIP = (-1.0) ** TURNS


def test_before_the_first_turn_a_run_is_settling():
    verdict = judge([])
    assert (verdict.state, verdict.turns) == ("settling", 0)


def test_a_smooth_decay_is_settling_and_then_settled():
    errors, steps = -0.02 * 0.9**TURNS, 2.0 * 0.85**TURNS
    states = [judge(course(errors[:n], steps[:n])).state for n in range(1, 61)]
    still = int(np.argmax(steps < SETTLED_STEP))
    assert states[: still + 4] == ["settling"] * (still + 4)
    assert states[still + 4 :] == ["settled"] * (60 - still - 4)


def test_one_large_move_among_the_last_turns_is_not_rest():
    steps = np.zeros(10)
    assert judge(course(np.zeros(10), steps)).state == "settled"
    steps[-3] = 0.1
    assert judge(course(np.zeros(10), steps)).state == "settling"


def test_four_still_turns_are_too_few():
    assert judge(course(np.zeros(4), 0.0)).state == "settling"
    assert judge(course(np.zeros(5), 0.0)).state == "settled"


def test_a_steady_flip_flop_vibrates_and_is_measured():
    verdict = judge(course(-0.01 + 0.004 * FLIP))
    assert verdict.state == "vibrating"
    assert verdict.period == pytest.approx(2.0)
    assert verdict.amplitude == pytest.approx(0.004)
    assert verdict.growth == pytest.approx(1.0)
    assert verdict.error == pytest.approx(-0.01)
    assert verdict.turns == 60


@settings(deadline=None)
@given(st.floats(0.995, 1.05), st.floats(5e-4, 5e-3), st.floats(-0.05, 0.05))
def test_growth_and_amplitude_of_a_flip_flop_are_read_off(growth, amplitude, mean):
    verdict = judge(course(mean + amplitude * growth**TURNS * FLIP))
    assert verdict.state == "vibrating"
    assert verdict.growth == pytest.approx(growth, abs=1e-6)
    assert verdict.amplitude == pytest.approx(amplitude * growth**52.5, rel=0.02)


@settings(deadline=None)
@given(st.floats(0.5, 0.985), st.floats(1e-3, 0.1))
def test_a_fading_flip_flop_is_settling(growth, amplitude):
    assert judge(course(amplitude * growth**TURNS * FLIP)).state == "settling"


def test_a_flip_flop_is_seen_through_a_creeping_volume():
    assert judge(course(-0.05 * 0.95**TURNS + 0.002 * FLIP)).state == "vibrating"


def test_a_flip_flop_below_what_anyone_sees_is_not_called_vibration():
    assert judge(course(5e-5 * FLIP)).state == "settling"


def test_a_vibration_of_three_turns_is_seen_with_its_period():
    verdict = judge(course(0.003 * np.cos(2 * np.pi * TURNS / 3)))
    assert verdict.state == "vibrating"
    assert verdict.period == pytest.approx(3.0, rel=0.1)


def test_nothing_is_called_vibration_before_two_windows_are_seen():
    errors = 0.01 * FLIP
    states = [judge(course(errors[:n])).state for n in range(1, 61)]
    assert states.index("vibrating") == 25
    assert set(states[:25]) == {"settling"}
    assert set(states[25:]) == {"vibrating"}


def test_a_drift_that_quickens_is_no_vibration():
    verdict = judge(course(-4e-4 * np.arange(30) ** 2))
    assert (verdict.state, verdict.amplitude, verdict.period) == ("settling", 0.0, 0.0)


def test_a_new_vibration_after_a_calm_time_grows():
    errors = np.where(TURNS < 45, 0.0, 0.003 * FLIP)
    verdict = judge(course(errors))
    assert verdict.state == "vibrating"
    assert verdict.growth > 1.05


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, 0.51, -0.9, 1e300])
def test_a_run_that_blew_up_diverged(bad):
    errors = np.append(0.001 * FLIP, bad)
    verdict = judge(course(errors))
    assert verdict.state == "diverging"
    assert verdict.turns == 61


def test_a_nan_is_not_forgiven_though_nothing_moves_any_more():
    errors = np.append(np.nan, np.zeros(8))
    assert judge(course(errors, 0.0)).state == "diverging"


def test_a_flip_flop_that_blows_up_vibrates_first_and_then_diverges():
    errors = 1e-3 * 1.12**TURNS * FLIP
    states = [judge(course(errors[:n])).state for n in range(1, 61)]
    assert states[30] == "vibrating"
    assert states[-1] == "diverging"
    assert "settled" not in states


@settings(deadline=None)
@given(st.lists(st.floats(-0.5, 0.5), max_size=70), st.floats(0, 1))
def test_any_course_gets_a_verdict(errors, step):
    verdict = judge(course(errors, step))
    assert verdict.state in ("settled", "settling", "vibrating", "diverging")
    assert verdict.turns == len(errors)
