"""The exact answer: its promises, and three independent ways to the same place."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import brentq, minimize
from shapes import central_difference, fitted, mid_bust, mirrored, tent, torso

from core.mechanics.constraint_lines import line_on
from core.mechanics.exact_solution import newton, solve_exact
from core.mechanics.iteration import LineTargets, iterate
from core.mechanics.model import assemble, constrained_model
from core.mechanics.options import ModelOptions
from core.mechanics.potential import Potential
from core.mechanics.tensegrity import tensegrity_model
from core.mechanics.volume import volume_measure

TORSO = constrained_model(torso(), worn=["mid-bust"])
SKEW = constrained_model(torso(skew=0.3))
RATIOS = (0.7, 0.8, 0.9, 0.97, 1.03, 1.1)
RNG = np.random.default_rng(11)


def assert_exact(model, balance):
    """Balance, volumes and steps as promised, judged from outside the solver."""
    points = model.tensegric.expand(balance.state.moved)
    missing = model.volume.zone_volumes(points) - model.volume.zone_volumes(model.tensegric.rest)
    assert np.abs(missing).max() / model.volume.rest_volume < 1e-9
    assert balance.is_converged
    assert balance.residual < 1e-9
    assert balance.steps <= 12


def stiffness(potential, moved, clip=False):
    """The second derivative of the energy alone, spread out of its band."""
    still = np.zeros(len(potential.wanted))
    lower = potential.hessian(potential.at(moved), still, clip=clip, curved=False)
    return potential.model.layout.band.full(lower)


def energy_of(potential, moved):
    return potential.energy(potential.at(moved))


def test_energy_of_a_stretched_tent_by_hand():
    mesh, fixed = tent(height=3.0)
    tensegric = tensegrity_model(mesh, fixed, ModelOptions(line_stiffness=2.0))
    line = line_on("ridge", (2, 4, 0), mesh.vertices, tensegric.free)
    model = assemble(tensegric, (line,), volume_measure(mesh, tensegric.free), ("ridge",))
    energy = Potential(model, (1.0,))
    lift = np.array([[0.0, 0.0, 4.0]])  # the tip goes up to 7: the cables grow from sqrt(41) to 9
    cables = 0.5 * tensegric.mean_stiffness * 16.0
    lines = 2 * 0.5 * (2.0 * tensegric.mean_stiffness) * (9.0 - np.sqrt(41.0)) ** 2
    assert energy_of(energy, np.zeros((1, 3))) == 0.0
    assert energy_of(energy, lift) == pytest.approx(cables + lines, rel=1e-14)


def test_energy_derivatives_converge_with_second_order():
    energy = Potential(SKEW, (0.9, 0.8, 1.1))
    moved = 3.0 * RNG.normal(size=(len(SKEW.tensegric.free), 3))
    gradient, hessian = energy.at(moved).gradient, stiffness(energy, moved)
    np.testing.assert_allclose(hessian, hessian.T, atol=1e-12)

    def errors(step):
        slope = central_difference(lambda d: energy_of(energy, d), moved, step)
        bend = central_difference(lambda d: energy.at(d).gradient, moved, step)
        return np.abs(slope - gradient).max(), np.abs(bend - hessian).max()

    coarse, fine = errors(2.0), errors(1.0)
    assert coarse[0] / fine[0] == pytest.approx(4.0, rel=0.05)
    assert coarse[1] / fine[1] == pytest.approx(4.0, rel=0.05)
    assert errors(1e-3)[1] < 1e-6 * np.abs(hessian).max()


def test_the_clipped_hessian_is_positive_even_under_compression():
    energy = Potential(TORSO, mid_bust(TORSO, 3.0))
    rest = np.zeros((len(TORSO.tensegric.free), 3))
    assert np.linalg.eigvalsh(stiffness(energy, rest))[0] < 0.0
    assert np.linalg.eigvalsh(stiffness(energy, rest, clip=True))[0] > 0.0


@pytest.mark.parametrize("ratio", RATIOS)
def test_the_answer_is_exact_in_few_steps(ratio):
    assert_exact(TORSO, solve_exact(TORSO, mid_bust(TORSO, ratio)))


@pytest.mark.parametrize("ratios", [(1.0, 0.85, 0.9), (1.0, 0.7, 0.7), (1.0, 1.1, 0.8), (0.5, 0.97, 1.1)])
def test_several_lines_at_once_on_a_skew_body(ratios):
    balance = solve_exact(SKEW, ratios)
    assert_exact(SKEW, balance)
    # One breast does not feed the other: their pressures differ.
    assert balance.pressures[0] != pytest.approx(balance.pressures[1], rel=1e-3)


def test_at_rest_the_answer_is_rest():
    balance = solve_exact(SKEW, (1.0, 1.0, 1.0))
    np.testing.assert_allclose(balance.state.moved, 0.0, atol=1e-12)
    assert balance.is_converged


def test_the_balance_is_force_against_pressure():
    balance = solve_exact(SKEW, (1.0, 0.85, 0.9))
    moved = balance.state.moved
    sides = SKEW.volume.zone_gradients(SKEW.tensegric.expand(moved))
    force = Potential(SKEW, (1.0, 0.85, 0.9)).at(moved).gradient.reshape(-1, 3)
    held = np.tensordot(balance.pressures, sides, axes=1)
    np.testing.assert_allclose(force, held, atol=1e-9 * np.abs(force).max())
    assert (balance.pressures > 0.0).all()


def assert_progress(potential, balances):
    """Each step leaves a quarter of what was amiss or less, or it comes back to the volumes if it had left
    them, or it keeps them and lowers the energy.
    """
    for before, after in pairwise(balances):
        old, new = (potential.at(balance.state.moved) for balance in (before, after))
        was, now = (
            potential.residual_norm(*each) for each in ((old, before.multipliers), (new, after.multipliers))
        )
        quick = now <= 0.25 * was
        was_kept, kept = ((np.abs(at.held) <= 1e3 * potential.tolerance).all() for at in (old, new))
        lower = potential.energy(new) <= (1.0 + 1e-11) * potential.energy(old)
        assert quick or (kept and (lower or not was_kept))


def test_every_step_leaves_a_quarter_or_keeps_the_volumes_and_lowers_the_energy():
    ratios = (1.0, 0.7, 0.8)
    potential, balances = Potential(SKEW, ratios), list(newton(SKEW, ratios))
    assert_progress(potential, balances)
    energies = [energy_of(potential, balance.state.moved) for balance in (balances[0], balances[-1])]
    assert energies[1] < 0.9 * energies[0]


def test_the_last_steps_converge_quadratically():
    potential = Potential(TORSO, mid_bust(TORSO, 0.8))
    amiss = [
        potential.residual_norm(potential.at(balance.state.moved), balance.multipliers)
        for balance in newton(TORSO, mid_bust(TORSO, 0.8))
    ][2:]
    fast = [after / before**2 for before, after in pairwise(amiss[:-1])]
    assert amiss[-1] < 1e-10
    assert max(fast) < 1.0


def settle(model, ratios, turns):
    *_, (state, _) = iterate(model, lambda: LineTargets(ratios), turns=turns)
    return state.moved


@pytest.mark.parametrize("ratio", [0.8, 0.97])
def test_thousands_of_adaptive_turns_arrive_at_the_same_place(ratio):
    ratios = mid_bust(TORSO, ratio)
    exact = solve_exact(TORSO, ratios).state.moved
    np.testing.assert_allclose(settle(TORSO, ratios, 2500), exact, atol=1e-6)


def small_model():
    control = torso(skew=0.3)
    few = (control.row >= 2) & (control.row <= 3) & (np.abs(control.column) <= 3)
    return constrained_model(replace(control, fixed=~few))


def test_a_general_optimiser_finds_the_same_place():
    model, ratios = small_model(), (1.0, 0.85, 0.95)
    energy, volume, tensegric = Potential(model, ratios), model.volume, model.tensegric
    wanted, litre = volume.zone_volumes(tensegric.rest), 1e6
    found = minimize(
        lambda d: energy_of(energy, d.reshape(-1, 3)),
        np.zeros(3 * len(tensegric.free)),
        jac=lambda d: energy.at(d.reshape(-1, 3)).gradient,
        constraints={
            "type": "eq",
            "fun": lambda d: (volume.zone_volumes(tensegric.expand(d.reshape(-1, 3))) - wanted) / litre,
            "jac": lambda d: volume.zone_gradients(tensegric.expand(d.reshape(-1, 3))).reshape(2, -1) / litre,
        },
        method="SLSQP",
        options={"ftol": 1e-15, "maxiter": 1000},
    )
    assert found.success
    exact = solve_exact(model, ratios)
    assert_exact(model, exact)
    np.testing.assert_allclose(found.x.reshape(-1, 3), exact.state.moved, atol=1e-6)


def test_a_tip_that_slides_level_by_hand():
    """The volume of a tent is its height: the tip slides level towards the corner that pulls it."""
    mesh, fixed = tent(height=3.0)
    tensegric = tensegrity_model(mesh, fixed, ModelOptions(line_stiffness=2.0))
    line = line_on("stay", (0, 4), mesh.vertices, tensegric.free)
    model = assemble(tensegric, (line,), volume_measure(mesh, tensegric.free), ("stay",))
    q, k, natural = tensegric.mean_stiffness, model.segments.stiffness[0], 0.7 * np.sqrt(41.0)

    def force(t):
        length = np.sqrt(2.0 * (4.0 - t) ** 2 + 9.0)
        return q * t - k * (length - natural) * (4.0 - t) / length

    slide = brentq(force, 0.0, 4.0, xtol=1e-14)
    assert slide > 0.5
    np.testing.assert_allclose(solve_exact(model, (0.7,)).state.moved, [[slide, slide, 0.0]], atol=1e-9)


def test_the_body_in_the_mirror_moves_as_the_mirror_of_the_body():
    control = torso(skew=0.3)
    twin, was = mirrored(control)
    model, mirror = constrained_model(control), constrained_model(twin)
    ratios = (1.0, 0.8, 0.9)
    balance, image = solve_exact(model, ratios), solve_exact(mirror, ratios)
    shift = model.tensegric.expand(balance.state.moved) - model.tensegric.rest
    image_shift = mirror.tensegric.expand(image.state.moved) - mirror.tensegric.rest
    np.testing.assert_allclose(image_shift, shift[was] * [-1.0, 1.0, 1.0], atol=1e-9)
    np.testing.assert_allclose(image.pressures, balance.pressures[::-1], rtol=1e-9)


def test_a_symmetric_body_moves_symmetrically():
    moved = TORSO.tensegric.expand(solve_exact(TORSO, mid_bust(TORSO, 0.8)).state.moved)
    other_way = moved.reshape(8, 13, 3)[:, ::-1] * [-1.0, 1.0, 1.0]
    np.testing.assert_allclose(other_way.reshape(-1, 3), moved, atol=1e-9)


def test_moving_and_turning_the_body_moves_and_turns_the_answer():
    control = torso(skew=0.3)
    turned = control.mesh.vertices @ np.array([[0.0, 1, 0], [-1, 0, 0], [0, 0, 1]]) + [500.0, -80.0, 1200.0]
    model = constrained_model(control)
    other = constrained_model(replace(control, mesh=control.mesh.moved(turned)))
    ratios = (1.0, 0.8, 0.9)
    here, there = (solve_exact(m, ratios).state.moved for m in (model, other))
    np.testing.assert_allclose(there, here @ np.array([[0.0, 1, 0], [-1, 0, 0], [0, 0, 1]]), atol=1e-8)


def test_a_body_twice_as_large_moves_twice_as_far():
    control = torso(skew=0.3)
    large = constrained_model(replace(control, mesh=control.mesh.moved(2.0 * control.mesh.vertices)))
    ratios = (1.0, 0.8, 0.9)
    np.testing.assert_allclose(
        solve_exact(large, ratios).state.moved,
        2.0 * solve_exact(constrained_model(control), ratios).state.moved,
        atol=1e-8,
    )


def test_a_solve_that_may_not_take_its_steps_says_so():
    balance = solve_exact(TORSO, mid_bust(TORSO, 0.7), limit=2)
    assert not balance.is_converged
    assert balance.steps == 2


def test_a_model_of_one_breast_only():
    control = torso()
    one = constrained_model(replace(control, fixed=control.fixed | (control.column < 1)))
    balance = solve_exact(one, (1.0, 0.8, 0.9))
    assert_exact(one, balance)
    assert balance.pressures[1] == 0.0
    assert balance.pressures[0] > 0.0


@pytest.mark.parametrize("worn", [["mid-bust"], ["mid-bust", "full-bust"]])
def test_stiff_lines_that_push_are_found_too(worn):
    """Lengthened stiff lines buckle: there full Newton steps lead astray."""
    model = constrained_model(torso(skew=0.3), worn=worn, mechanics=ModelOptions(line_stiffness=500.0))
    balances = list(newton(model, (1.0, 1.3, 1.3)))
    assert balances[-1].is_converged
    assert_progress(Potential(model, (1.0, 1.3, 1.3)), balances)


@pytest.mark.parametrize("ratio", [0.5, 0.6, 1.2, 1.3])
def test_even_at_the_ends_of_the_range_an_answer_is_found(ratio):
    balance = solve_exact(SKEW, (1.0, ratio, ratio))
    assert balance.is_converged
    missing = SKEW.volume.volume(SKEW.tensegric.expand(balance.state.moved)) - SKEW.volume.rest_volume
    assert abs(missing) / SKEW.volume.rest_volume < 1e-9


@pytest.mark.parametrize("sample", ["mannequin", "person"])
def test_real_bodies_with_one_line_and_with_all(sample):
    control = fitted(sample)
    for worn in (["mid-bust"], list(control.paths)):
        model = constrained_model(control, worn=worn)
        for ratio in RATIOS:
            ratios = tuple(ratio if line.name in worn else 1.0 for line in model.lines)
            assert_exact(model, solve_exact(model, ratios))
