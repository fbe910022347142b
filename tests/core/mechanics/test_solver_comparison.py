"""Runs side by side: in lockstep, warm after a change, fresh on request, at rest in the end."""

from dataclasses import replace

import numpy as np
import pytest
from shapes import torso

from core.mechanics.convergence import Convergence
from core.mechanics.exact_solution import solve_exact
from core.mechanics.gain_limit import gain_limit
from core.mechanics.iteration import LineTargets, Observables, iterate
from core.mechanics.mesh_quality import original_shape
from core.mechanics.model import constrained_model
from core.mechanics.solver_comparison import MOST_TURNS, SolverComparison, assess_equilibrium

MODEL = constrained_model(torso(), worn=["mid-bust"])
CALM = 0.9 * gain_limit(MODEL)


def targets(ratio, control="adaptive", gain=CALM):
    return LineTargets((1.0, ratio, 1.0), control, gain)


def finish(comparison):
    turns = 0
    while not comparison.is_finished:
        comparison.advance()
        turns += 1
    return turns


def test_both_turn_controls_run_and_none_joins_when_chosen():
    assert set(SolverComparison(MODEL, targets(0.9)).runs) == {"adaptive", "conventional"}
    assert set(SolverComparison(MODEL, targets(0.9, "exact")).runs) == {"adaptive", "conventional"}
    assert set(SolverComparison(MODEL, targets(0.9, "none")).runs) == {"adaptive", "conventional", "none"}


def test_a_run_here_is_the_run_of_the_solver():
    comparison = SolverComparison(MODEL, targets(0.9))
    for _ in range(20):
        comparison.advance()
    for control in ("adaptive", "conventional"):
        asked = targets(0.9, control)
        alone = [measured for _, measured in iterate(MODEL, lambda asked=asked: asked, turns=20)]
        assert comparison.runs[control].records[1:] == alone


def test_runs_go_in_lockstep_from_turn_0_at_rest():
    comparison = SolverComparison(MODEL, targets(0.9, "none"))
    for _ in range(7):
        comparison.advance()
    for run in comparison.runs.values():
        assert [measured.iteration for measured in run.records] == list(range(8))
        assert run.records[0].error == 0.0
        assert run.records[0].lengths[1] == pytest.approx(MODEL.lines[1].rest_length)


def test_everything_rests_in_the_end_near_the_exact_answer():
    comparison = SolverComparison(MODEL, targets(0.97))
    turns = finish(comparison)
    assert turns <= MOST_TURNS
    assert comparison.verdict.motion == "settled"
    np.testing.assert_allclose(
        comparison.runs["adaptive"].state.moved, comparison.exact.state.moved, atol=0.1
    )
    comparison.advance()
    assert all(len(run.records) <= turns + 1 for run in comparison.runs.values())


def test_what_is_shown_is_the_chosen_run_or_the_exact_answer():
    comparison = SolverComparison(MODEL, targets(0.9, "conventional"))
    comparison.advance()
    assert comparison.main is comparison.runs["conventional"]
    assert comparison.shown is comparison.runs["conventional"].state
    comparison.retarget(MODEL, targets(0.9, "exact"))
    assert comparison.main is None
    assert comparison.shown is comparison.exact.state
    assert comparison.verdict.motion == "settled"


def test_new_lengths_go_on_warm_and_lose_no_record():
    comparison = SolverComparison(MODEL, targets(0.9))
    finish(comparison)
    before = {name: (run.state, tuple(run.records)) for name, run in comparison.runs.items()}
    comparison.retarget(MODEL, targets(0.88))
    assert not comparison.is_finished
    comparison.advance()
    for name, run in comparison.runs.items():
        state, records = before[name]
        assert tuple(run.records[:-1]) == records
        assert run.records[-1].iteration == state.iteration + 1
        assert run.records[-1].step < 3.0
    np.testing.assert_allclose(
        comparison.exact.state.moved, solve_exact(MODEL, (1.0, 0.88, 1.0)).state.moved, atol=1e-8
    )


def test_the_exact_answer_does_not_depend_on_the_way_there():
    comparison = SolverComparison(MODEL, targets(0.9))
    for ratio in (0.6, 1.25, 0.88):
        comparison.retarget(MODEL, targets(ratio))
    straight = SolverComparison(MODEL, targets(0.88))
    np.testing.assert_array_equal(comparison.exact.state.moved, straight.exact.state.moved)


def test_the_verdict_counts_only_what_came_after_the_change():
    comparison = SolverComparison(MODEL, targets(0.97))
    finish(comparison)
    assert comparison.verdict.motion == "settled"
    comparison.retarget(MODEL, targets(0.8))
    assert comparison.verdict.motion == "settling"
    finish(comparison)
    assert comparison.verdict.motion == "settled"


def test_fresh_begins_new_records_from_where_the_body_is():
    comparison = SolverComparison(MODEL, targets(0.9))
    finish(comparison)
    here = comparison.runs["adaptive"].state.moved
    comparison.retarget(MODEL, targets(0.85), fresh=True)
    run = comparison.runs["adaptive"]
    assert [measured.iteration for measured in run.records] == [0]
    np.testing.assert_array_equal(run.state.moved, here)
    assert run.records[0].lengths[1] < MODEL.lines[1].rest_length
    finish(comparison)
    assert comparison.verdict.motion == "settled"


def test_other_lines_may_be_worn_while_the_runs_go_on():
    comparison = SolverComparison(MODEL, targets(0.9))
    finish(comparison)
    both = constrained_model(torso(), worn=["mid-bust", "full-bust"])
    asked = LineTargets((1.0, 0.9, 0.95), "adaptive", CALM)
    comparison.retarget(both, asked)
    finish(comparison)
    assert comparison.verdict.motion == "settled"
    np.testing.assert_allclose(comparison.shown.moved, solve_exact(both, asked.ratios).state.moved, atol=0.2)
    bare = constrained_model(torso(), worn=[])
    comparison.retarget(bare, targets(1.0))
    finish(comparison)
    np.testing.assert_allclose(comparison.shown.moved, 0.0, atol=0.1)
    np.testing.assert_allclose(comparison.exact.state.moved, 0.0, atol=1e-9)


def test_a_slider_dragged_while_turns_are_made_ends_where_it_was_left():
    comparison = SolverComparison(MODEL, targets(1.0))
    for ratio in np.linspace(1.0, 0.85, 40):
        comparison.retarget(MODEL, targets(float(ratio)))
        comparison.advance()
    finish(comparison)
    turns = [measured.iteration for measured in comparison.runs["adaptive"].records]
    assert turns == list(range(len(turns)))
    assert comparison.verdict.motion == "settled"
    np.testing.assert_allclose(
        comparison.shown.moved, solve_exact(MODEL, (1.0, 0.85, 1.0)).state.moved, atol=0.1
    )


def test_a_vibrating_run_is_watched_long_enough_and_then_left():
    comparison = SolverComparison(MODEL, targets(0.9, "conventional", 1.05 * gain_limit(MODEL)))
    assert finish(comparison) == MOST_TURNS
    assert comparison.verdict.motion == "vibrating"
    assert comparison.verdict.period == pytest.approx(2.0)


@pytest.mark.parametrize("fresh", [False, True])
def test_a_run_that_diverged_starts_again_at_rest_once_the_gain_is_lowered(fresh):
    comparison = SolverComparison(MODEL, targets(0.9, "conventional", 9.0))
    finish(comparison)
    assert comparison.verdict.motion == "diverging"
    records = len(comparison.runs["conventional"].records)
    comparison.retarget(MODEL, targets(0.9, "conventional"), fresh)
    assert np.abs(comparison.shown.moved).max() == 0.0
    finish(comparison)
    assert comparison.verdict.motion == "settled"
    turns = [measured.iteration for measured in comparison.runs["conventional"].records]
    assert turns == list(range(len(turns)))
    assert fresh or len(turns) > records


def test_one_diverged_run_does_not_disturb_the_others():
    comparison = SolverComparison(MODEL, targets(0.9, "adaptive", 9.0))
    finish(comparison)
    assert comparison.runs["conventional"].verdict.motion == "diverging"
    assert comparison.verdict.motion == "settled"


def test_body_marks_are_recorded_from_the_start():
    marks = Observables(1.0, 2.0, 3.0, 4.0, 5.0, 6.0)
    comparison = SolverComparison(MODEL, targets(0.9), watch=lambda points: marks)
    comparison.advance()
    assert [measured.marks for measured in comparison.runs["adaptive"].records] == [marks, marks]


def test_a_balance_that_was_not_found_is_no_answer():
    balance = solve_exact(MODEL, (1.0, 0.7, 1.0))
    assert assess_equilibrium(MODEL, balance).motion == "settled"
    assert assess_equilibrium(MODEL, replace(balance, residual=1.0)).motion == "settling"


def test_a_slider_that_moved_a_little_is_answered_from_near_and_rests_at_the_answer_from_rest():
    comparison = SolverComparison(MODEL, targets(0.9, "exact"))
    finish(comparison)
    comparison.retarget(MODEL, targets(0.88, "exact"))
    assert comparison.exact.is_converged
    assert comparison.exact.steps < solve_exact(MODEL, targets(0.88).ratios).steps
    assert not comparison.is_finished
    finish(comparison)
    np.testing.assert_array_equal(
        comparison.exact.state.moved, solve_exact(MODEL, targets(0.88).ratios).state.moved
    )


def test_a_slider_that_jumped_is_answered_from_rest():
    comparison = SolverComparison(MODEL, targets(0.97, "exact"))
    comparison.retarget(MODEL, targets(0.8, "exact"))
    np.testing.assert_array_equal(
        comparison.exact.state.moved, solve_exact(MODEL, targets(0.8).ratios).state.moved
    )


def test_a_walk_of_the_slider_ends_where_the_answer_from_rest_is():
    comparison = SolverComparison(MODEL, targets(1.0, "exact"))
    for ratio in (*np.linspace(1.0, 0.7, 31), *np.linspace(0.7, 0.9, 21)):
        comparison.retarget(MODEL, targets(float(ratio), "exact"))
    exact = solve_exact(MODEL, targets(0.9).ratios).state.moved
    np.testing.assert_allclose(comparison.exact.state.moved, exact, atol=1e-8)


def test_another_line_worn_leaves_the_pressure_what_it_was():
    comparison = SolverComparison(MODEL, targets(0.9))
    finish(comparison)
    both = constrained_model(torso(), worn=["mid-bust", "full-bust"])
    before = comparison.runs["adaptive"].state.pressure.value * MODEL.pressure_unit
    comparison.retarget(both, targets(0.9))
    after = comparison.runs["adaptive"].state.pressure.value * both.pressure_unit
    assert both.pressure_unit != pytest.approx(MODEL.pressure_unit, rel=1e-3)
    assert after == pytest.approx(before, rel=1e-12)


def test_accumulating_joins_when_it_is_chosen():
    comparison = SolverComparison(MODEL, targets(0.9, "accumulating"))
    assert set(comparison.runs) == {"adaptive", "conventional", "accumulating"}
    finish(comparison)
    assert comparison.verdict.motion == "settled"
    assert abs(comparison.main.records[-1].error) < 1e-5


@pytest.mark.parametrize("control", ["adaptive", "exact"])
def test_a_shape_that_strains_changes_the_word_and_not_when_a_run_rests(control):
    comparison = SolverComparison(MODEL, targets(0.5, control))
    finish(comparison)
    assert comparison.verdict.motion == "settled"
    assert comparison.verdict.state == "overstrained"
    shape = original_shape(torso().mesh, torso().fixed)
    points = MODEL.tensegric.expand(comparison.shown.moved)
    assert comparison.verdict.condition == shape.quality(points)
    before = comparison.shown.moved
    comparison.retarget(MODEL, targets(0.48, control))
    assert control == "exact" or np.array_equal(comparison.shown.moved, before), "it goes on from there"
    comparison.retarget(MODEL, targets(0.97, control))
    finish(comparison)
    assert comparison.verdict.state == "settled"


def test_of_a_diverging_run_the_last_calm_state_is_shown():
    comparison = SolverComparison(MODEL, targets(0.97))
    finish(comparison)
    comparison.retarget(MODEL, targets(0.97, "conventional", 4.0 * CALM))
    finish(comparison)
    assert comparison.verdict.motion == "diverging"
    shown = MODEL.volume.volume(MODEL.tensegric.expand(comparison.shown.moved))
    assert abs(shown / MODEL.volume.rest_volume - 1.0) < 0.05
    torn = MODEL.volume.volume(MODEL.tensegric.expand(comparison.main.state.moved))
    assert abs(torn / MODEL.volume.rest_volume - 1.0) > 0.5
    comparison.retarget(MODEL, targets(0.97, "conventional"))
    finish(comparison)
    assert comparison.verdict.motion == "settled"


@pytest.mark.parametrize("fresh", [False, True])
def test_what_follows_a_run_that_did_not_converge_begins_at_rest(fresh):
    comparison = SolverComparison(MODEL, targets(0.9))
    run = comparison.runs["adaptive"]
    slow = Convergence("settling", MOST_TURNS, 0.1)
    for changed, at_rest in ((targets(0.9), False), (targets(0.95), True)):
        finish(comparison)
        run.verdict, run.changed_at = slow, run.state.iteration - MOST_TURNS
        comparison.retarget(MODEL, changed, fresh)
        run = comparison.runs["adaptive"]
        assert (np.abs(run.state.moved).max() == 0.0) == at_rest, "with the same lengths it goes on"
    finish(comparison)
    assert comparison.verdict.motion == "settled"
