"""Swings of every period: seen, measured, and told from what only creeps, jumps, hums or fades."""

import numpy as np
import pytest
from courses import course, motions
from hypothesis import given, settings
from hypothesis import strategies as st

from core.mechanics.convergence import assess_convergence

LONG = np.arange(160)


def wave(period, growth=1.0, phase=0.0):
    """A swing whose crests are 1 high in the last turn."""
    return growth ** (LONG - LONG[-1]) * np.cos(2.0 * np.pi * LONG / period + phase)


@settings(deadline=None)
@given(
    st.floats(2.7, 40.0),
    st.floats(0.996, 1.015),
    st.floats(5e-4, 5e-3),
    st.floats(0.0, 6.3),
    st.floats(-2e-5, 2e-5),
)
def test_a_swing_of_any_period_is_measured_on_top_of_a_drift(period, growth, amplitude, phase, drift):
    swing = amplitude * wave(period, growth, phase)
    verdict = assess_convergence(course(-0.02 + drift * LONG + swing))
    assert verdict.motion == "vibrating"
    assert verdict.period == pytest.approx(period, rel=0.06)
    assert verdict.growth == pytest.approx(growth, abs=0.005)


@settings(deadline=None)
@given(st.just(2.0) | st.floats(3.5, 40.0), st.floats(2e-4, 0.1), st.floats(0.0, 0.1), st.floats(-0.1, 0.1))
def test_the_amplitude_of_a_steady_swing_is_half_of_it(period, amplitude, phase, mean):
    verdict = assess_convergence(course(mean + amplitude * wave(period, phase=phase)))
    assert verdict.amplitude == pytest.approx(amplitude, rel=0.06)
    assert verdict.error == pytest.approx(mean, abs=0.2 * amplitude)


@settings(deadline=None)
@given(st.just(2.0) | st.floats(3.2, 40.0), st.floats(0.8, 0.98), st.floats(1e-3, 0.1), st.floats(0.0, 6.3))
def test_a_ringing_that_fades_is_settling_at_every_turn(period, growth, amplitude, phase):
    errors = amplitude * growth**LONG * np.cos(2.0 * np.pi * LONG / period + phase)
    assert set(motions(errors)) == {"settling"}


@pytest.mark.parametrize("period", [2, 2.4, 3, 5, 8, 12, 18, 25, 32, 40])
def test_a_swing_is_seen_after_three_periods_at_the_latest(period):
    words = motions(0.003 * wave(period))
    seen = words.index("vibrating")
    assert seen < max(26, 3 * period + 4)
    assert set(words[seen:]) == {"vibrating"}


@pytest.mark.parametrize("period", [3, 10, 30])
def test_a_slow_swing_is_seen_through_a_creeping_volume(period):
    assert assess_convergence(course(0.002 * wave(period) - 0.02 * 0.95**LONG)).motion == "vibrating"


@pytest.mark.parametrize("period", [9, 20, 36])
def test_the_larger_of_two_swings_is_told(period):
    verdict = assess_convergence(course(0.004 * wave(period) + 3e-4 * wave(2)))
    assert verdict.period == pytest.approx(period, rel=0.05)
    assert verdict.amplitude == pytest.approx(0.004, rel=0.05)


@pytest.mark.parametrize(("delay", "gain"), [(2, 0.63), (5, 0.29), (8, 0.185), (8, 0.2)])
def test_a_loop_that_hears_its_volume_late_swings_as_its_characteristic_equation_says(delay, gain):
    errors = [0.001] * (delay + 1)
    while len(errors) < 160:
        errors.append(errors[-1] - gain * errors[-1 - delay])
    root = max(np.roots([1.0, -1.0, *[0.0] * (delay - 1), gain]), key=abs)
    verdict = assess_convergence(course(errors))
    assert verdict.motion == "vibrating"
    assert verdict.growth == pytest.approx(abs(root), abs=0.003)
    assert verdict.period == pytest.approx(2.0 * np.pi / abs(np.angle(root)), rel=0.03)


@pytest.mark.parametrize("width", [0.3, 1.0, 4.0, 12.0])
@pytest.mark.parametrize("middle", [20, 70, 120])
def test_a_single_pulse_is_no_vibration_at_any_turn(middle, width):
    assert set(motions(0.01 * np.exp(-(((LONG - middle) / width) ** 2)))) == {"settling"}


@pytest.mark.parametrize(
    "errors",
    [
        -0.03 * 0.97**LONG,
        -0.03 * 0.6**LONG + 0.01 * 0.9**LONG + 0.02 * 0.99**LONG,
        np.where(LONG < 80, 0.0, 0.01),
        -0.01 + 1e-7 * np.random.default_rng(5).normal(size=len(LONG)),
        0.02 * 0.98**LONG + 1e-7 * (-1.0) ** LONG,
    ],
    ids=["creep", "three creeps", "jump", "noise", "creep with round-off"],
)
def test_what_only_creeps_jumps_or_hums_is_settling_at_every_turn(errors):
    assert set(motions(errors)) == {"settling"}


def test_a_shape_that_swings_at_constant_volume_vibrates():
    lengths = np.stack([300.0 + 0.4 * wave(12), 0.0 * LONG + 400.0], axis=1)
    verdict = assess_convergence(course(1e-7 * wave(12), 0.2, lengths))
    assert (verdict.motion, verdict.period) == ("vibrating", pytest.approx(12.0))
    assert (verdict.amplitude, verdict.growth) == (0.0, pytest.approx(1.0))
    fading = 0.97**LONG
    lengths = np.stack([300.0 + 0.4 * fading * wave(12), 0.0 * LONG + 400.0], axis=1)
    assert assess_convergence(course(1e-7 * wave(12), 0.5 * fading, lengths)).motion == "settling"
