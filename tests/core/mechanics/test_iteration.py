"""Turns: hand values on a tent, a plain sweep beside the matrix one, what each volume control promises."""

from dataclasses import replace
from itertools import islice

import numpy as np
import pytest
from models import pairs_of
from shapes import mid_bust, run, tent_model, torso

from app.research.sphere import sphere
from core.geometry.mesh import Mesh
from core.mechanics.constraint_lines import line_on
from core.mechanics.iteration import (
    LineTargets,
    Observables,
    SolverState,
    initial_state,
    iterate,
    record,
    step,
)
from core.mechanics.model import assemble, constrained_model
from core.mechanics.options import DEFAULT_LINE_STIFFNESS
from core.mechanics.potential import Potential
from core.mechanics.tensegrity import tensegrity_model
from core.mechanics.volume import ITERATIVE_CONTROLS, Pressure, volume_measure

TORSO = constrained_model(torso(), worn=["mid-bust"])
SKEW = constrained_model(torso(skew=0.3))


def test_line_stiffness_by_hand():
    model = tent_model(stiffness=16.0)
    # Two equal segments, each 16 times what all cables at the tip make together.
    np.testing.assert_allclose(model.segments.stiffness, 16.0 * model.tensegric.mean_stiffness)
    np.testing.assert_allclose(model.segments.rest_lengths, np.sqrt(41.0))
    assert DEFAULT_LINE_STIFFNESS == 16.0


def test_a_tape_is_the_same_along_a_line():
    np.testing.assert_allclose(
        TORSO.segments.stiffness * TORSO.segments.rest_lengths,
        (TORSO.segments.stiffness * TORSO.segments.rest_lengths)[0],
        rtol=1e-12,
    )


def test_a_tape_of_unequal_segments_by_hand():
    """A segment as long as the mean has the stiffness that was set, in units of the cables' mean."""
    lengths = TORSO.segments.rest_lengths
    assert np.ptp(lengths) > 1.0
    by_hand = 16.0 * TORSO.tensegric.mean_stiffness * lengths.mean() / lengths
    np.testing.assert_allclose(TORSO.segments.stiffness, by_hand, rtol=1e-12)


def test_the_left_triangles_of_a_body_are_those_on_its_left():
    middles = TORSO.tensegric.rest[TORSO.volume.faces].mean(axis=1)[:, 0]
    assert np.abs(middles).min() > 1.0
    np.testing.assert_array_equal(TORSO.volume.zone, np.where(middles > 0.0, 0, 1))


def test_hooke_force_by_hand():
    model = tent_model()
    k, length = model.segments.stiffness[0], np.sqrt(41.0)

    def pull(ratio):
        return -Potential(model, (ratio,)).at(np.zeros((1, 3))).line

    # Both segments are too long by a tenth and pull the tip along them, which is 3 down in sqrt(41).
    np.testing.assert_allclose(pull(0.9), [[0, 0, -2 * k * (0.1 * length) * 3 / length]], atol=1e-12)
    np.testing.assert_allclose(pull(1.1), -pull(0.9), atol=1e-12)


def test_hooke_force_equals_the_tension_of_every_segment():
    rng = np.random.default_rng(2)
    moved = 4.0 * rng.normal(size=(len(SKEW.tensegric.free), 3))
    points, ratios = SKEW.tensegric.expand(moved), (0.9, 0.8, 1.1)
    force = np.zeros_like(points)
    for index, line in enumerate(SKEW.lines):
        for (i, j), k, natural in zip(
            pairs_of(line.across),
            SKEW.segments.stiffness[SKEW.owner == index],
            ratios[index] * line.rest_lengths,
            strict=line.constrains,
        ):
            span = points[i] - points[j]
            tension = k * (np.linalg.norm(span) - natural) * span / np.linalg.norm(span)
            force[i] -= tension
            force[j] += tension
    found = -Potential(SKEW, ratios).at(moved).line
    np.testing.assert_allclose(found, force[SKEW.tensegric.free], atol=1e-10)


def test_first_turn_of_the_tent_by_hand():
    model = tent_model(stiffness=2.0)
    q = model.tensegric.mean_stiffness  # 4 cables; the line adds 2 segments of 2 q each
    state, measured = step(model, LineTargets((0.8,), "none"), initial_state(model))
    down = -2 * (2 * q) * 0.2 * 3.0 / (q + 2 * 2 * q)
    np.testing.assert_allclose(state.moved, [[0, 0, down]], atol=1e-14)
    assert measured.iteration == state.iteration == 1
    assert measured.step == pytest.approx(-down)
    assert measured.error == pytest.approx(down / 3.0)  # the tent is a pyramid: volume goes with height
    assert measured.error_ml == pytest.approx(64 * down / 3.0 / 1000)
    assert measured.lengths == (pytest.approx(2 * np.sqrt(32 + (3 + down) ** 2)),)


def test_pressure_of_the_tent_by_hand():
    model = tent_model(stiffness=2.0)
    q = model.tensegric.mean_stiffness
    assert model.probe == pytest.approx((64 / 3) ** 2 / (5 * q))
    # One unit of pressure fills the whole volume in one turn: for a pyramid exactly so.
    state = SolverState(np.zeros((1, 3)), Pressure(value=0.25))
    _, measured = step(model, LineTargets((1.0,), "conventional"), state)
    assert measured.error == pytest.approx(0.25)


def plain_sweep(model, targets, state):
    """One turn as the paper tells it: point after point to its balance among neighbours as they are now."""
    tensegric = model.tensegric
    old, now = tensegric.expand(state.moved), tensegric.expand(state.moved)
    natural = model.natural_lengths(targets.ratios)
    volume_force = state.pressure.value * model.pressure_unit * model.volume.gradient(old)
    for place, i in enumerate(tensegric.free):
        total = volume_force[place] if targets.control != "none" else np.zeros(3)
        stiffness = 0.0
        for (a, b), q in zip(tensegric.cables, tensegric.density, strict=True):
            if i in (a, b):
                j = b if i == a else a
                total = total + q * (now[j] + tensegric.rest[i] - tensegric.rest[j])
                stiffness += q
        pairs = pairs_of(model.segments.across)
        for (a, b), k, length in zip(pairs, model.segments.stiffness, natural, strict=True):
            if i in (a, b):
                j = b if i == a else a
                way = old[i] - old[j]
                total = total + k * (now[j] + length * way / np.linalg.norm(way))
                stiffness += k
        now[i] = total / stiffness
    return now


@pytest.mark.parametrize("control", ITERATIVE_CONTROLS)
def test_a_turn_is_a_plain_gauss_seidel_sweep(control):
    targets = LineTargets((0.9, 0.85, 1.05), control, 1.2)
    state = initial_state(SKEW)
    for _ in range(4):
        expected = plain_sweep(SKEW, targets, state)
        state, _ = step(SKEW, targets, state)
        np.testing.assert_allclose(SKEW.tensegric.expand(state.moved), expected, atol=1e-10)


def test_probe_is_the_change_of_volume_in_one_turn():
    def answer(pressure):
        state = SolverState(np.zeros((len(SKEW.tensegric.free), 3)), Pressure(value=pressure))
        return step(SKEW, LineTargets((1.0, 1.0, 1.0), "conventional"), state)[1].error / pressure

    wrong = [abs(answer(pressure) - 1.0) for pressure in (1e-2, 1e-3, 1e-4)]
    # Only the volume itself is not linear: ten times less push, ten times less deviation.
    assert wrong[2] < 1e-4
    assert wrong[0] / wrong[1] == pytest.approx(10.0, rel=0.1)


def test_winding_does_not_turn_the_volume_force_round():
    control = torso()
    inside_out = replace(control, mesh=Mesh(control.mesh.vertices, control.mesh.faces[:, ::-1]))
    twin = constrained_model(inside_out, worn=["mid-bust"])
    state, records = run(TORSO, LineTargets(mid_bust(TORSO, 0.9)), 40)
    other, others = run(twin, LineTargets(mid_bust(TORSO, 0.9)), 40)
    np.testing.assert_allclose(other.moved, state.moved, atol=1e-9)
    assert others[-1].error == pytest.approx(records[-1].error, abs=1e-12)


def test_a_shorter_line_reaches_near_its_length_and_a_longer_one_too():
    for ratio in (0.9, 1.1):
        _, records = run(TORSO, LineTargets(mid_bust(TORSO, ratio)), 200)
        reached = records[-1].lengths[1] / TORSO.lines[1].rest_length
        assert min(ratio, 1.0) < reached < max(ratio, 1.0)


def test_a_line_that_is_not_worn_is_measured_but_does_not_pull():
    bare = constrained_model(torso(), worn=[])
    state, records = run(bare, LineTargets((0.6, 0.6, 0.6)), 5)
    assert np.abs(state.moved).max() < 1e-12
    assert records[-1].lengths == pytest.approx([line.rest_length for line in bare.lines])


def test_a_line_on_fixed_points_alone_does_not_pull():
    assert [line.constrains for line in SKEW.lines] == [False, True, True]
    assert set(SKEW.owner.tolist()) == {1, 2}


def test_back_lengths_reach_their_lines():
    model = constrained_model(torso(), back_lengths={"mid-bust": 400.0})
    assert [line.back_length for line in model.lines] == [0.0, 400.0, 0.0]


def test_a_run_is_asked_for_turn_by_turn_and_its_targets_too():
    asked = []

    def targets():
        asked.append(None)
        return LineTargets(mid_bust(TORSO, 0.9))

    turns = list(islice(iterate(TORSO, targets, turns=50), 3))
    assert len(asked) == 3
    assert [measured.iteration for _, measured in turns] == [1, 2, 3]


def test_a_run_that_blows_up_ends():
    _, records = run(TORSO, LineTargets(mid_bust(TORSO, 0.9), "conventional", 9.0), 500)
    assert len(records) < 500
    assert abs(records[-1].error) > 10.0
    assert all(abs(measured.error) <= 10.0 for measured in records[:-1])


def test_the_same_run_twice_is_the_same_to_the_bit():
    one, _ = run(SKEW, LineTargets((1.0, 0.85, 0.9)), 30)
    two, _ = run(constrained_model(torso(skew=0.3)), LineTargets((1.0, 0.85, 0.9)), 30)
    np.testing.assert_array_equal(one.moved, two.moved)


def test_what_is_watched_is_recorded():
    marks = Observables(1.0, 2.0, 3.0, 4.0, 5.0, 6.0)
    assert record(TORSO, initial_state(TORSO), 0.0, lambda points: marks).marks is marks
    assert step(TORSO, LineTargets((1.0,) * 3), initial_state(TORSO))[1].marks is None


def test_a_closed_line_round_a_ball_waists_it_at_constant_volume():
    """Figure 2 of the paper: the sphere-like shape with a horizontal line."""
    ball = sphere(rings=7, spokes=12)
    fixed = np.arange(len(ball.vertices)) >= 84  # the poles
    tensegric = tensegrity_model(ball, fixed)
    line = line_on("equator", [*range(36, 48), 36], ball.vertices, tensegric.free)
    model = assemble(tensegric, (line,), volume_measure(ball, tensegric.free), ("equator",))
    state, records = run(model, LineTargets((0.9,)), 400)
    assert abs(records[-1].error) < 1e-5
    radius = np.linalg.norm(tensegric.expand(state.moved)[:84, :2], axis=1).reshape(7, 12)
    assert radius[3].max() < 96.0
    assert radius[1].min() > 72.0  # 70.7 at rest: what the waist gives away goes there
    np.testing.assert_allclose(radius, radius[::-1], rtol=2e-3)
