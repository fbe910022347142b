"""The verdict on runs whose course is made by hand."""

import numpy as np
import pytest
from courses import course, motions, motions_of
from hypothesis import given, settings
from hypothesis import strategies as st
from shapes import fitted, mid_bust

from core.mechanics.convergence import CONVERGED_STEP, MOTIONS, STATES, Convergence, assess_convergence
from core.mechanics.iteration import LineTargets, initial_state, iterate
from core.mechanics.mesh_quality import MeshQuality
from core.mechanics.model import constrained_model

TURNS = np.arange(60)
FLIP = (-1.0) ** TURNS


def test_before_the_first_turn_a_run_is_settling():
    verdict = assess_convergence([])
    assert (verdict.motion, verdict.iterations) == ("settling", 0)


def test_a_smooth_decay_is_settling_and_then_settled():
    errors, steps = -0.02 * 0.9**TURNS, 2.0 * 0.85**TURNS
    states = motions(errors, steps)
    still = int(np.argmax(steps < CONVERGED_STEP))
    assert states[: still + 4] == ["settling"] * (still + 4)
    assert states[still + 4 :] == ["settled"] * (60 - still - 4)


def test_one_large_move_among_the_last_turns_is_not_rest():
    steps = np.zeros(10)
    assert assess_convergence(course(np.zeros(10), steps)).motion == "settled"
    steps[-3] = 0.1
    assert assess_convergence(course(np.zeros(10), steps)).motion == "settling"


def test_four_still_turns_are_too_few():
    assert assess_convergence(course(np.zeros(4), 0.0)).motion == "settling"
    assert assess_convergence(course(np.zeros(5), 0.0)).motion == "settled"


def test_a_steady_flip_flop_vibrates_and_is_measured():
    verdict = assess_convergence(course(-0.01 + 0.004 * FLIP))
    assert verdict.motion == "vibrating"
    assert verdict.period == pytest.approx(2.0)
    assert verdict.amplitude == pytest.approx(0.004)
    assert verdict.growth == pytest.approx(1.0)
    assert verdict.error == pytest.approx(-0.01)
    assert verdict.iterations == 60


@settings(deadline=None)
@given(st.floats(0.995, 1.05), st.floats(5e-4, 5e-3), st.floats(-0.05, 0.05))
def test_growth_and_amplitude_of_a_flip_flop_are_read_off(growth, amplitude, mean):
    verdict = assess_convergence(course(mean + amplitude * growth**TURNS * FLIP))
    assert verdict.motion == "vibrating"
    assert verdict.growth == pytest.approx(growth, abs=1e-6)
    assert verdict.amplitude == pytest.approx(amplitude * growth**52.5, rel=0.02)


@settings(deadline=None)
@given(st.floats(0.5, 0.985), st.floats(1e-3, 0.1))
def test_a_fading_flip_flop_is_settling(growth, amplitude):
    assert assess_convergence(course(amplitude * growth**TURNS * FLIP)).motion == "settling"


def test_a_flip_flop_is_seen_through_a_creeping_volume():
    assert assess_convergence(course(-0.05 * 0.95**TURNS + 0.002 * FLIP)).motion == "vibrating"


def test_a_flip_flop_below_what_anyone_sees_is_not_called_vibration():
    assert assess_convergence(course(5e-5 * FLIP)).motion == "settling"


def test_a_vibration_of_three_turns_is_seen_with_its_period():
    verdict = assess_convergence(course(0.003 * np.cos(2 * np.pi * TURNS / 3)))
    assert verdict.motion == "vibrating"
    assert verdict.period == pytest.approx(3.0, rel=0.1)


def test_nothing_is_called_vibration_before_two_windows_are_seen():
    errors = 0.01 * FLIP
    states = motions(errors)
    assert states.index("vibrating") == 25
    assert set(states[:25]) == {"settling"}
    assert set(states[25:]) == {"vibrating"}


def test_a_drift_that_quickens_is_no_vibration():
    verdict = assess_convergence(course(-4e-4 * np.arange(30) ** 2))
    assert (verdict.motion, verdict.amplitude, verdict.period) == ("settling", 0.0, 0.0)


def test_a_new_vibration_after_a_calm_time_grows():
    errors = np.where(TURNS < 45, 0.0, 0.003 * FLIP)
    verdict = assess_convergence(course(errors))
    assert verdict.motion == "vibrating"
    assert verdict.growth > 1.05


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, 0.51, -0.9, 1e300])
def test_a_run_that_blew_up_diverged(bad):
    errors = np.append(0.001 * FLIP, bad)
    verdict = assess_convergence(course(errors))
    assert verdict.motion == "diverging"
    assert verdict.iterations == 61


def test_a_nan_is_not_forgiven_though_nothing_moves_any_more():
    errors = np.append(np.nan, np.zeros(8))
    assert assess_convergence(course(errors, 0.0)).motion == "diverging"


def test_a_flip_flop_that_blows_up_vibrates_first_and_then_diverges():
    errors = 1e-3 * 1.12**TURNS * FLIP
    states = motions(errors)
    assert states[30] == "vibrating"
    assert states[-1] == "diverging"
    assert "settled" not in states


@settings(deadline=None)
@given(st.lists(st.floats(-0.5, 0.5), max_size=70), st.floats(0, 1))
def test_any_course_gets_a_verdict(errors, step):
    verdict = assess_convergence(course(errors, step))
    assert verdict.motion in MOTIONS
    assert verdict.iterations == len(errors)


@pytest.mark.parametrize("sample", ["mannequin", "person"])
def test_real_runs_get_the_verdict_that_their_course_shows(sample):
    model = constrained_model(fitted(sample), worn=["mid-bust"])
    words = {}
    for control, gain, ratio in (
        ("conventional", 1.4, 0.9),
        ("conventional", 2.0, 0.9),
        ("conventional", 4.0, 0.9),
        ("adaptive", 1.5, 0.6),
        ("none", 0.0, 0.6),
    ):
        targets = LineTargets(mid_bust(model, ratio), control, gain)
        runs = iterate(model, lambda targets=targets: targets, initial_state(model), turns=160)
        words[control, gain] = motions_of([measured for _, measured in runs])
    assert words["conventional", 1.4] == ["settling", "settled"]
    assert words["conventional", 2.0] == ["settling", "vibrating"]
    assert words["conventional", 4.0][-1] == "diverging"
    assert words["adaptive", 1.5] == words["none", 0.0] == ["settling", "settled"]


SOUND, FOLDED = MeshQuality(0.9, 0.9, 1.1), MeshQuality(-0.2, 0.5, 1.6)
STRAINED = MeshQuality(0.9, 0.9, 1.4)


@pytest.mark.parametrize(
    ("motion", "condition", "state"),
    [
        ("settled", None, "settled"),
        ("settled", SOUND, "settled"),
        ("settling", SOUND, "settling"),
        ("settled", STRAINED, "overstrained"),
        ("settling", STRAINED, "overstrained"),
        ("settled", FOLDED, "folded"),
        ("settling", FOLDED, "folded"),
        ("vibrating", FOLDED, "vibrating"),
        ("diverging", FOLDED, "diverging"),
    ],
)
def test_the_worst_is_said_first(motion, condition, state):
    verdict = Convergence(motion, 1, 0.0, condition=condition)
    assert verdict.state == state
    assert state in STATES
    assert verdict.words == (state if state == motion else f"{motion} but {state}")


def test_the_condition_changes_the_word_and_not_the_motion():
    quiet, wild = course(np.zeros(10), 0.0), course(0.01 * FLIP)
    assert [assess_convergence(records, FOLDED).motion for records in ([], quiet, wild)] == [
        "settling",
        "settled",
        "vibrating",
    ]
    assert [assess_convergence(records, FOLDED).state for records in ([], quiet, wild)] == [
        "folded",
        "folded",
        "vibrating",
    ]
