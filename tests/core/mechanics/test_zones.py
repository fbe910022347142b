"""Volumes of several zones: each is kept by a pressure of its own, in iterations as in the exact solution."""

from dataclasses import replace

import numpy as np
import pytest
from shapes import central_difference, mid_bust, run, torso

from core.mechanics.convergence import assess_convergence
from core.mechanics.exact_solution import solve_exact
from core.mechanics.gain_limit import OscillationLimit, gain_limit
from core.mechanics.iteration import LineTargets, initial_state, step
from core.mechanics.model import ConstrainedModel, constrained_model
from core.mechanics.options import ModelOptions
from core.mechanics.potential import Potential
from core.mechanics.sensitivity import Sensitivities
from core.mechanics.volume import Pressure, volume_measure


def zoned(kept: tuple[float, ...] = (1.0,) * 4, **options: object) -> ConstrainedModel:
    """The torso in four zones, above and below the bust points on both sides."""
    control = torso(skew=0.3)
    model = constrained_model(control, worn=["mid-bust"], mechanics=ModelOptions(**options))
    middle = control.mesh.vertices[control.mesh.faces].mean(axis=1)
    zone = 2 * (middle[:, 2] > 0.0) + (middle[:, 0] < 0.0)
    volume = volume_measure(control.mesh, model.tensegric.free, zone, kept, separate=True)
    return replace(model, volume=volume)


FOUR = zoned()
SOFT = zoned((0.5, 1.0, 0.7, 1.0))


def test_zones_have_the_volumes_of_their_triangles_and_add_up():
    points, rng = FOUR.tensegric.rest.copy(), np.random.default_rng(3)
    points[FOUR.tensegric.free] += rng.normal(0.0, 3.0, (len(FOUR.tensegric.free), 3))
    corners = (points - FOUR.volume.centre)[FOUR.volume.faces]
    each = np.linalg.det(corners) / 6.0
    zones = FOUR.volume.zone_volumes(points)
    np.testing.assert_allclose(zones, [each[FOUR.volume.zone == at].sum() for at in range(4)], rtol=1e-12)
    assert FOUR.volume.volume(points) == pytest.approx(zones.sum() + FOUR.volume.still_volume, rel=1e-12)
    slopes = central_difference(
        lambda d: FOUR.volume.zone_volumes(FOUR.tensegric.expand(d.reshape(-1, 3))),
        (points[FOUR.tensegric.free] - FOUR.tensegric.rest[FOUR.tensegric.free]).ravel(),
        1e-3,
    )
    np.testing.assert_allclose(FOUR.volume.zone_gradients(points).reshape(4, -1), slopes, atol=1e-5)


def test_a_pressure_of_one_zone_changes_that_zone_alone():
    for zone in range(4):
        push = np.eye(4)[zone] * 1e-6
        start = replace(initial_state(FOUR), pressure=Pressure(push, np.zeros(4), np.full(4, 0.8)))
        still = (1.0,) * len(FOUR.lines)
        state, _ = step(FOUR, LineTargets(still, "conventional", 1.0), start)
        change = FOUR.volume.zone_volumes(FOUR.tensegric.expand(state.moved)) - FOUR.rest_zones
        np.testing.assert_allclose(change / FOUR.volume.rest_volume, push, atol=1e-11)


@pytest.mark.parametrize("ratio", [0.7, 0.9, 1.05])
def test_the_exact_answer_keeps_each_zone(ratio):
    balance = solve_exact(FOUR, mid_bust(FOUR, ratio))
    assert balance.is_converged
    assert balance.steps <= 8
    change = FOUR.volume.zone_volumes(FOUR.tensegric.expand(balance.state.moved)) - FOUR.rest_zones
    assert np.abs(change).max() < 1e-9 * FOUR.volume.rest_volume


@pytest.mark.parametrize("hold", ["spring", "held"])
def test_what_a_zone_takes_up_inside_is_in_proportion_to_its_pressure(hold):
    model = zoned((0.5, 1.0, 0.7, 1.0), line_hold=hold)
    balance = solve_exact(model, mid_bust(model, 0.9))
    assert balance.is_converged
    lost = model.rest_zones - model.volume.zone_volumes(model.tensegric.expand(balance.state.moved))
    np.testing.assert_allclose(lost, model.give * balance.pressures, atol=1e-9 * model.volume.rest_volume)
    assert (lost[[0, 2]] > 1e-5 * model.volume.rest_volume).all()


def test_a_zone_pressed_by_itself_keeps_its_share():
    """Small displacements of a tissue that lines push without stiffening it."""
    half, push = zoned((0.5, 1.0, 1.0, 1.0), line_stiffness=0.1), []
    for model in (half, replace(half, volume=replace(half.volume, kept=np.array([1e-3, 1.0, 1.0, 1.0])))):
        balance = solve_exact(model, mid_bust(model, 0.99))
        lost = model.rest_zones - model.volume.zone_volumes(model.tensegric.expand(balance.state.moved))
        push.append(lost[0])
    # Neighbours that keep their volume push back, so a little more than half is kept.
    assert push[0] == pytest.approx(0.5 * push[1], rel=0.2)


@pytest.mark.parametrize("model", [FOUR, SOFT], ids=["kept", "partly kept"])
@pytest.mark.parametrize("ratio", [0.8, 0.97])
def test_the_adaptive_control_comes_to_the_exact_answer_without_ripple(model, ratio):
    targets = LineTargets(mid_bust(model, ratio))
    state, records = run(model, targets, 250)
    balance = solve_exact(model, targets.ratios)
    assert np.abs(state.moved - balance.state.moved).max() < 0.02
    last = np.array([record.zones for record in records[-40:]])
    assert np.abs(last).max() < 1e-5
    assert np.ptp(last, axis=0).max() < 1e-5
    assert assess_convergence(records).motion == "settled"


@pytest.mark.parametrize("model", [FOUR, SOFT], ids=["kept", "partly kept"])
def test_the_conventional_control_vibrates_beyond_the_limit_of_all_zones_alone(model):
    limit = gain_limit(model)
    for factor, grows in ((0.98, False), (1.02, True)):
        targets = LineTargets(mid_bust(model, 0.999), "conventional", factor * limit)
        zones = np.array([record.zones for record in run(model, targets, 240)[1]])
        swing = np.abs(np.diff(zones, axis=0)).max(axis=1)
        assert (swing[-1] > swing[-41]) == grows


def test_the_limit_where_it_stands_is_that_at_rest_for_lengths_of_rest():
    still = (1.0,) * len(SOFT.lines)
    potential = Potential(SOFT, still)
    balance = solve_exact(SOFT, still)
    assert OscillationLimit(SOFT).limit(potential, balance) == pytest.approx(gain_limit(SOFT), rel=1e-6)


def test_conventional_iterations_come_to_the_equilibrium_that_is_computed_for_them():
    ratios = mid_bust(SOFT, 0.9)
    near, gain = solve_exact(SOFT, ratios), 0.8 * gain_limit(SOFT)
    found = OscillationLimit(SOFT).equilibrium(Potential(SOFT, ratios), near, gain)
    state, _ = run(SOFT, LineTargets(ratios, "conventional", gain), 400)
    assert found is not None
    assert np.abs(found.state.moved - state.moved).max() < 1e-3  # it is sought no more exactly


@pytest.mark.parametrize("model", [FOUR, SOFT], ids=["kept", "partly kept"])
def test_rates_are_those_of_answers_to_other_lengths(model):
    ratios = mid_bust(model, 0.9)
    line = next(at for at, ratio in enumerate(ratios) if ratio != 1.0)

    def moved(ratio):
        return solve_exact(model, mid_bust(model, ratio)).state.moved.ravel()

    rates = Sensitivities(Potential(model, ratios), solve_exact(model, ratios)).by_ratio(np.array([line]))
    difference = (moved(0.9 + 1e-4) - moved(0.9 - 1e-4)) / 2e-4
    np.testing.assert_allclose(rates.moved[:, 0], difference, atol=1e-6 * np.abs(difference).max())


def test_a_swing_of_zones_against_each_other_is_a_vibration():
    still = (1.0,) * len(FOUR.lines)
    _, records = run(FOUR, LineTargets(still, "adaptive"), 60)
    swings = [
        replace(record, zones=(0.01 * (-1) ** at, -0.01 * (-1) ** at, 0.0, 0.0), step=1.0)
        for at, record in enumerate(records)
    ]
    verdict = assess_convergence(swings)
    assert verdict.motion == "vibrating"
    assert verdict.amplitude == pytest.approx(0.01, rel=0.05)
