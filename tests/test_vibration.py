"""What each volume control promises: no drift, no ripple, and vibration exactly where it is computed."""

import numpy as np
import pytest
from shapes import central_difference, errors_of, fitted, mid_bust, run, torso

from core.gain import gain_limit
from core.model import constrained_model
from core.solver import State, Targets, at_rest, turn
from core.volume import Pressure

CONTROLS = ("none", "conventional", "adaptive")
TORSO = constrained_model(torso(), worn=["mid-bust"])
SKEW = constrained_model(torso(skew=0.3))


@pytest.mark.parametrize("control", CONTROLS)
@pytest.mark.parametrize("model", [TORSO, SKEW], ids=["one line", "skew, all lines"])
def test_at_rest_nothing_drifts(control, model):
    state, records = run(model, Targets((1.0,) * 3, control, 1.5), 50)
    assert np.abs(state.moved).max() < 1e-10
    assert max(abs(measured.error) for measured in records) < 1e-12


@pytest.mark.parametrize("ratio", [0.7, 0.8, 0.9, 0.97, 1.03, 1.1])
def test_adaptive_holds_the_volume_within_60_turns_without_ripple(ratio):
    errors = errors_of(TORSO, Targets(mid_bust(TORSO, ratio)), 200)
    assert np.abs(errors[60:]).max() < 1e-3
    assert np.ptp(errors[-40:]) < 1e-5
    assert np.abs(np.diff(errors[-40:])).max() < 1e-6


def test_adaptive_holds_the_volume_on_a_skew_body_with_all_lines():
    errors = errors_of(SKEW, Targets((1.0, 0.85, 0.9)), 200)
    assert np.abs(errors[60:]).max() < 1e-3
    assert np.ptp(errors[-40:]) < 1e-5


def test_adaptive_follows_lengths_that_jump():
    state = at_rest(TORSO)
    for ratio in (0.97, 0.7, 1.05, 0.6):
        state, records = run(TORSO, Targets(mid_bust(TORSO, ratio)), 60, state)
        assert abs(records[-1].error) < 1e-3


def test_conventional_leaves_an_error_that_no_control_exceeds():
    ratios = mid_bust(TORSO, 0.9)
    conventional = errors_of(TORSO, Targets(ratios, "conventional", 1.2), 300)[-1]
    none = errors_of(TORSO, Targets(ratios, "none"), 300)[-1]
    adaptive = errors_of(TORSO, Targets(ratios, "adaptive"), 300)[-1]
    assert none < conventional < -10 * abs(adaptive)


def flips(model, gain, ratio=0.97, turns=400):
    """The flip-flop of the conventional volume error, turn by turn: its second differences."""
    errors = errors_of(model, Targets(mid_bust(model, ratio), "conventional", gain), turns)
    return np.abs(errors[:-2] - 2 * errors[1:-1] + errors[2:])


@pytest.mark.parametrize("model", [TORSO, SKEW], ids=["one line", "skew, all lines"])
def test_conventional_vibrates_above_the_limit_and_not_below(model):
    limit = gain_limit(model)
    assert 1.2 < limit < 2.0
    assert flips(model, 0.95 * limit)[-1] < 1e-6
    assert flips(model, 1.05 * limit)[-1] > 1e-3


def test_the_limit_is_sharp_where_moves_are_small():
    limit = gain_limit(TORSO)
    for factor, grows in ((0.99, False), (1.01, True)):
        swing = flips(TORSO, factor * limit, ratio=0.999, turns=160)
        assert (swing[-1] > swing[-41]) == grows


def test_the_limit_is_where_the_loop_of_one_turn_flips():
    """Turns differentiated numerically: the answer to a push that flips from turn to turn."""
    still = (1.0, 1.0, 1.0)
    shape = (len(TORSO.tensegric.free), 3)

    def after(moved, pressure):
        state = State(moved.reshape(shape), Pressure(value=pressure))
        return turn(TORSO, Targets(still, "conventional"), state)[0].moved.ravel()

    zero = np.zeros(np.prod(shape))
    follow = central_difference(lambda d: after(d, 0.0), zero, 1e-4)
    push = central_difference(lambda p: after(zero, p[0]), np.zeros(1), 1e-6)[:, 0]
    flipping = np.linalg.solve(np.eye(len(zero)) + follow, push)
    per_unit = flipping @ TORSO.volume.gradient(TORSO.tensegric.rest).ravel() / TORSO.volume.rest_volume
    assert gain_limit(TORSO) == pytest.approx(1.0 / per_unit, rel=1e-5)


@pytest.mark.parametrize("ratio", [0.6, 0.8, 0.97, 1.1])
def test_without_control_nothing_vibrates(ratio):
    errors = errors_of(TORSO, Targets(mid_bust(TORSO, ratio), "none"), 200)[20:]
    steps = np.diff(errors)
    assert (steps[1:] * steps[:-1] >= -1e-20).all()


@pytest.mark.parametrize("sample", ["mannequin", "person"])
def test_real_bodies_keep_their_volume_and_their_calm(sample):
    control = fitted(sample)
    model = constrained_model(control, worn=["mid-bust"])
    state, _ = run(model, Targets((1.0,) * 3), 50)
    assert np.abs(state.moved).max() < 1e-10
    for ratio in (0.7, 0.9, 1.1):
        errors = errors_of(model, Targets(mid_bust(model, ratio)), 150)
        assert np.abs(errors[60:]).max() < 1e-3
        assert np.ptp(errors[-40:]) < 1e-5
    limit = gain_limit(model)
    assert flips(model, 0.95 * limit)[-1] < 1e-6
    assert flips(model, 1.05 * limit)[-1] > 1e-3
