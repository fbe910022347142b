"""The doctor: forces that add up, what is named as fighting, and changes that end it, run by another path."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache, partial
from typing import Any

import numpy as np
import pytest

from app.presenters.samples import sample_design
from core.analysis.diagnosis.candidate_changes import (
    GAIN_STEP,
    LENGTH_STEP,
    Change,
    lower_gains,
    option_changes,
)
from core.analysis.diagnosis.diagnose import Diagnosis, diagnose
from core.analysis.diagnosis.opposing_constraints import analyse
from core.analysis.diagnosis.search import Search
from core.analysis.diagnosis.stability import forecast
from core.analysis.diagnosis.trial_run import continue_run, run_trial
from core.control_mesh.template import read_template
from core.document.design import Design
from core.document.line_notation import ready_made_lines
from core.document.lines import LineSettings
from core.mechanics.solver_comparison import SolverComparison
from core.pipeline.build import Stages, build
from core.pipeline.converged import converged_frame
from core.pipeline.model_stages import line_targets
from core.pipeline.solve import solve
from core.progress import Cancelled, quiet


@cache
def body() -> Stages:
    return build(replace(sample_design("mannequin"), lines=()))


def made(lines: dict[str, float], **settings: Any) -> Stages:
    design = replace(body().design, **settings)
    for name, ratio in lines.items():
        design = design.with_line(name, ratio)
    return build(design, body())


def treated(lines: dict[str, float], **settings: Any) -> Diagnosis:
    return diagnose(made(lines, **settings))


def told_from_rest(design: Design) -> str:
    return converged_frame(design, body()).verdict.display_state


def told_going_on(before: Stages, design: Design) -> str:
    """How it ends where a run that stands is given the changed design, as the solver of the window does."""
    comparison = SolverComparison(before.model, line_targets(before.design, before), before.watch)
    while not comparison.is_finished:
        comparison.advance()
    after = build(design, before)
    comparison.retarget(after.model, line_targets(design, after), fresh=True)
    while not comparison.is_finished:
        comparison.advance()
    return comparison.verdict.display_state


def cured(found: Diagnosis) -> Design:
    assert found.best_fix is not None
    return found.best_fix.change.design


@pytest.mark.parametrize(
    ("hold", "volume"),
    [("spring", "exact"), ("spring", "conventional"), ("spring", "none"), ("held", "adaptive")],
)
def test_where_a_run_rests_all_forces_add_up_to_nothing(hold: str, volume: str) -> None:
    stages = made({"mid-bust": 0.93, "full-bust": 0.95}, line_hold=hold, volume=volume)
    fight = analyse(stages)
    solved = solve(stages, None if volume == "exact" else 1500)
    newtons = fight.skin / np.linalg.norm(stages.model.tensegric.gradient(solved.state.moved), axis=1).sum()
    skin = -newtons * stages.model.tensegric.gradient(solved.state.moved)
    total = skin + sum(pull.force for pull in fight.forces)
    assert np.abs(total).max() < 1e-7 * np.abs(skin).max()
    volumes = [()] if volume != "none" else []
    assert [pull.lines for pull in fight.forces] == [("mid-bust",), ("full-bust",), *volumes]


def test_the_volume_is_told_by_sides_that_add_up_and_not_where_it_does_nothing() -> None:
    volume = analyse(made({"mid-bust": 0.93})).forces[-1]
    assert volume.sides is not None
    assert sum(volume.sides) == pytest.approx(volume.newtons)
    assert analyse(made({})).forces == ()


def test_newtons_are_those_of_the_tissue_and_angles_do_not_hang_on_it() -> None:
    soft, firm = (
        analyse(made({"mid-bust": 0.9}, tissue_stiffness=stiffness)) for stiffness in (300.0, 600.0)
    )
    for one, other in zip(soft.forces, firm.forces, strict=True):
        assert other.newtons == pytest.approx(2.0 * one.newtons)
        assert other.to_volume == pytest.approx(one.to_volume)
    assert soft.forces[1].to_volume < 5.0, "one pressure each side presses along the gradient"
    assert soft.forces[0].to_volume > 100.0, "a line that is shorter takes volume away"


def test_a_short_line_fights_the_volume_and_a_long_one_the_short_one() -> None:
    alone = analyse(made({"mid-bust": 0.8})).worst
    assert alone is not None
    assert (alone.one.lines, alone.other.lines) == (("mid-bust",), ())
    both = analyse(made({"mid-bust": 0.8, "full-bust": 1.2})).worst
    assert both is not None
    assert {both.one.lines, both.other.lines} == {("mid-bust",), ("full-bust",)}


def test_where_two_pairs_fight_alike_none_is_named() -> None:
    fight = analyse(made({"mid-bust": 0.9}))
    twice = replace(fight, oppositions=(fight.oppositions[0], fight.oppositions[0]))
    assert fight.worst is not None
    assert twice.worst is None
    assert analyse(made({})).worst is None


@pytest.mark.parametrize(
    "settings",
    [{"volume": "adaptive"}, {"volume": "conventional", "gain": 1.2}, {"volume": "none"}],
    ids=lambda settings: settings["volume"],
)
def test_an_outlook_knows_where_turns_come_to_rest(settings: dict[str, Any]) -> None:
    stages = made({"mid-bust": 0.9}, **settings)
    seen = forecast(stages)
    assert seen is not None
    assert np.abs(seen.balance.state.moved - solve(stages).state.moved).max() < 0.1
    assert seen.is_stable


def test_an_outlook_tells_when_a_swing_grows() -> None:
    below, above = (made({"mid-bust": 0.9}, volume="conventional", gain=gain) for gain in (1.5, 1.65))
    low, high = forecast(below), forecast(above)
    assert low is not None and high is not None  # noqa: PT018
    assert low.growth < 1.0 < high.growth
    assert solve(above).verdict.motion == "vibrating"


def test_of_a_calm_design_nothing_is_wrong() -> None:
    found = treated({"mid-bust": 0.97})
    assert (found.problem, found.verdict.display_state) == ("", "settled")


def test_too_high_a_gain_is_lowered_no_more_than_needed() -> None:
    found = treated({"mid-bust": 0.95}, volume="conventional", gain=1.7)
    assert found.problem == "vibrating"
    assert found.verdict.period == pytest.approx(2.0, abs=0.1)
    (cure,) = (each for each in found.fixes if each.change.kind == "gain")
    gain = cure.change.design.gain
    assert gain is not None and found.gain_limit is not None  # noqa: PT018
    assert found.gain_limit - 6 * GAIN_STEP < gain < found.gain_limit < 1.7
    assert found.onset is not None and found.onset > 1.0  # noqa: PT018
    assert told_from_rest(cure.change.design) == "settled"
    assert told_going_on(found.stages, cure.change.design) == "settled"


@pytest.mark.parametrize("volume", ["adaptive", "exact"])
def test_strain_is_ended_by_the_shortest_way(volume: str) -> None:
    found = treated({"mid-bust": 0.9}, volume=volume)
    assert found.problem == "strained"
    least = min(found.fixes, key=lambda cure: cure.change.size).change
    ratio = least.design.ratio("mid-bust")
    assert ratio > 0.9
    assert found.longer_mm(least) > 0.0
    assert told_from_rest(least.design) == "settled"
    assert told_from_rest(least.design.with_line("mid-bust", ratio - 2 * LENGTH_STEP)) == "strained"


def test_what_nobody_can_hold_is_set_to_what_can_be_held() -> None:
    found = treated({"mid-bust": 0.5}, volume="exact", line_hold="held")
    assert (found.problem, found.forces.share < 1.0) == ("unreachable", True)
    assert cured(found).line_hold == "held"
    assert told_from_rest(cured(found)) in ("settled", "strained")


def test_a_late_force_is_let_act_in_step() -> None:
    found = treated({"mid-bust": 0.95}, line_force="explicit")
    assert found.problem == "diverging"
    assert cured(found) == replace(found.stages.design, line_force="implicit")
    assert told_from_rest(cured(found)) == "settled"


def test_another_control_goes_on_from_where_its_own_run_stands() -> None:
    sick = made({"mid-bust": 0.6}, volume="conventional")
    changed = made({"mid-bust": 0.85}, volume="adaptive")
    warm = continue_run(run_trial(sick), changed)
    assert warm is not None
    assert warm.verdict.display_state == told_going_on(sick, changed.design) == "overstrained"


def test_locked_lines_stay_and_are_named() -> None:
    locked = (LineSettings("mid-bust", locked=True),)
    found = diagnose(build(replace(made({"mid-bust": 0.85}).design, traits=locked), body()))
    assert (found.problem, found.best_fix, found.locked) == ("overstrained", None, ("mid-bust",))
    swings = replace(found.stages.design, volume="conventional", gain=1.7).with_line_settings(
        LineSettings("mid-bust")
    )
    swings = swings.with_line("mid-bust", 0.95).with_line_settings(locked[0])
    assert all(each.change.design.lines == swings.lines for each in diagnose(build(swings, body())).fixes)


def test_linked_lines_go_together() -> None:
    pair = ready_made_lines(read_template("168"))["straps"]
    design = replace(body().design, own_lines=pair)
    for line in pair:
        design = design.with_line(line.name, 0.8)
    found = diagnose(build(design, body()))
    assert found.problem in ("strained", "overstrained", "folded")
    after = cured(found)
    assert after.ratio("strap left") == after.ratio("strap right") > 0.8
    assert [pull.lines for pull in found.forces.forces] == [("strap left", "strap right"), ()]


def test_who_comes_back_from_a_fold_slowly_is_watched_once_more() -> None:
    found = treated({"mid-bust": 0.6, "full-bust": 0.6})
    assert found.problem == "folded"
    assert ("strained", "together") in {(each.remaining_problem, each.change.kind) for each in found.fixes}


def test_the_nearest_is_told_with_what_is_left_of_it() -> None:
    search = Search(run_trial(made({"mid-bust": 0.6}, volume="conventional")), quiet)
    tried = search.run_change(Change("length", made({"mid-bust": 0.85}, volume="adaptive").design))
    assert (tried.ends, tried.remaining_problem) == (False, "overstrained")


def test_lower_gains_are_tried_before_the_control_is_taken_away() -> None:
    stages = made({"mid-bust": 0.9}, volume="conventional", gain=2.5)
    limit = 0.88 * stages.gain_limit
    low = math.floor(0.96 * limit / GAIN_STEP) * GAIN_STEP
    gains = [change.design.gain for change in lower_gains(stages.design, stages, 1.59)]
    assert gains == [1.52, pytest.approx(low)]
    assert [change.design.gain for change in lower_gains(stages.design, stages, None)] == [pytest.approx(low)]
    low_gain = made({"mid-bust": 0.9}, volume="conventional", gain=1.0)
    assert list(lower_gains(low_gain.design, low_gain, 1.59)) == []
    assert [change.setting for change in option_changes(stages.design, "vibrating")] == [
        ("volume", "adaptive"),
        ("volume", "exact"),
    ]


def test_a_choice_that_its_lengths_do_not_need_is_left_out() -> None:
    sick = made({"mid-bust": 0.7}, volume="conventional", gain=1.2)
    search = Search(run_trial(sick), quiet)
    both = replace(sick.design, volume="adaptive").with_line("mid-bust", 0.95)
    cure = search.simplify(
        search.run_change(Change("length", both, 25.0, ("mid-bust",), ("volume", "adaptive")))
    )
    assert (cure.ends, cure.change.setting, cure.change.design.volume) == (True, ("", None), "conventional")


@pytest.mark.parametrize("going_on", [False, True])
def test_a_run_that_nobody_waits_for_stops_in_the_middle(going_on: bool) -> None:
    sick, turns = made({"mid-bust": 0.6}), []

    def hear(what: str, share: float) -> None:
        turns.append(share)
        if len(turns) == 3:
            raise Cancelled

    work = partial(continue_run, run_trial(sick)) if going_on else run_trial
    with pytest.raises(Cancelled):
        work(made({"mid-bust": 0.9}), hear)
    assert len(turns) == 3


def test_work_is_let_go_of_at_once() -> None:
    heard = []

    def hear(what: str, share: float) -> None:
        heard.append(what)
        if len(heard) == 5:
            raise Cancelled

    with pytest.raises(Cancelled):
        diagnose(made({"mid-bust": 0.9}), hear)
    assert len(heard) == 5
