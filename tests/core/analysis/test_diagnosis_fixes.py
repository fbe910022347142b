"""What a cure rests on: places that runs come to, runs that are given up, and what each part of it ends."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from app.presenters.diagnosis import change_text, details, hint, shown_fixes
from app.presenters.samples import sample_design
from core.analysis.diagnosis.candidate_changes import line_paths
from core.analysis.diagnosis.diagnose import Diagnosis, diagnose
from core.analysis.diagnosis.stability import forecast, forecast_about
from core.analysis.diagnosis.trial_run import continue_run, run_trial
from core.control_mesh.template import read_template
from core.document.line_notation import ready_made_lines
from core.mechanics.solver_comparison import SolverComparison
from core.pipeline.active_lines import free_lines
from core.pipeline.build import Stages, build
from core.pipeline.converged import converged_frame
from core.pipeline.model_stages import line_targets


@cache
def body(sample: str) -> Stages:
    return build(replace(sample_design(sample), lines=()))


def made(sample: str, lines: dict[str, float], **settings: Any) -> Stages:
    design = replace(body(sample).design, **settings)
    if "strap left" in lines:
        design = replace(design, own_lines=ready_made_lines(read_template(design.template))["straps"])
    for name, ratio in lines.items():
        design = design.with_line(name, ratio)
    return build(design, body(sample))


def built_as(stages: Stages, volume: str) -> Stages:
    return build(replace(stages.design, volume=volume), stages)


@cache
def twice_sick() -> Diagnosis:
    """It swings because of the gain, and folds because of the lengths."""
    return diagnose(made("mannequin", {"mid-bust": 0.62, "full-bust": 0.7}, volume="conventional", gain=1.9))


def test_what_slides_is_looked_at_where_its_run_stands() -> None:
    stages = made(
        "person",
        {"mid-bust": 0.734, "strap left": 1.082, "strap right": 1.082},
        line_contact="sliding",
        volume="conventional",
        gain=1.88,
    )
    found = diagnose(stages)
    assert found.problem == "vibrating"
    assert found.best_fix is not None
    design = found.best_fix.change.design
    assert converged_frame(design, stages).verdict.display_state in ("settled", "strained")
    assert found.best_fix.change.kind == "length"
    less = build(design.with_line("mid-bust", design.ratio("mid-bust") - 0.03), stages)
    assert run_trial(less).problem == run_trial(built_as(less, "exact")).problem == "folded"


def test_turns_that_stand_somewhere_are_found_to_rest_there() -> None:
    stages = made("mannequin", {"mid-bust": 0.9}, volume="conventional", gain=1.2)
    ran = run_trial(stages).run
    seen, from_rest = forecast_about(stages, ran.middle), forecast(stages)
    assert seen is not None and from_rest is not None  # noqa: PT018
    assert np.abs(seen.balance.state.moved - from_rest.balance.state.moved).max() < 1e-6
    assert forecast_about(stages, np.full_like(ran.middle, np.nan)) is None


@pytest.mark.parametrize(("gain", "motion"), [(1.7, "vibrating"), (1.5, "settled")])
def test_a_trial_is_given_up_once_it_is_plain_that_it_swings(gain: float, motion: str) -> None:
    stages = made("mannequin", {"mid-bust": 0.95}, volume="conventional", gain=gain)
    whole, trial = run_trial(stages), run_trial(stages, trial=True)
    assert whole.problem == trial.problem
    assert (whole.verdict.motion, trial.verdict.motion) == (motion, motion)
    if motion == "vibrating":
        assert trial.verdict.iterations < whole.verdict.iterations / 2
    else:
        assert trial.verdict.iterations == whole.verdict.iterations


def test_held_lines_go_on_with_the_tensions_that_they_have() -> None:
    """As the window does: with none they would pull anew, and come to rest another way."""
    stages = made("mannequin", {"mid-bust": 0.9}, line_hold="held", volume="adaptive")
    after = build(stages.design.with_line("mid-bust", 0.93), stages)
    comparison = SolverComparison(stages.model, line_targets(stages.design, stages))
    for lengths in (None, after):
        if lengths is not None:
            comparison.retarget(after.model, line_targets(after.design, after), fresh=True)
        while not comparison.is_finished:
            comparison.advance()
    ran = continue_run(run_trial(stages), after)
    assert ran is not None and comparison.main is not None  # noqa: PT018
    assert ran.verdict.iterations == comparison.main.verdict.iterations
    assert np.abs(ran.state.moved - comparison.main.state.moved).max() < 1e-9


def test_of_a_double_change_it_is_known_what_each_part_ends() -> None:
    found = twice_sick()
    assert found.best_fix is not None
    assert found.best_fix.change.setting[0] == "gain"
    assert found.stages.design.volume == found.best_fix.change.design.volume == "conventional"
    assert (found.best_fix.option_result, found.best_fix.lengths_result) == ("vibrating", "folded")
    assert "The gain resolved the oscillation; the length resolved the fold" in details(found)
    alike = replace(found, fixes=(replace(found.best_fix, lengths_result="vibrating"),))
    assert "One change alone is not enough: status “Oscillating”" in details(alike)


def test_all_lines_together_are_told_with_how_far_they_go() -> None:
    found = twice_sick()
    assert found.best_fix is not None
    before, lines = found.stages.design, ("mid-bust", "full-bust")
    after = before.with_line("mid-bust", 0.72).with_line("full-bust", 0.75)
    change = replace(found.best_fix.change, kind="together", design=after, lines=lines, setting=("", None))
    most = 0.1 * found.line("mid-bust").rest_length
    assert found.moves_mm(change) == pytest.approx(most)
    assert change_text(found, change) == f"All lines up to {most:.0f} mm closer to 100 %"


def test_forces_are_told_as_sums_over_points() -> None:
    assert "Sum of the forces at all points" in details(twice_sick())


def test_a_line_at_its_rest_length_has_one_way_and_that_leads_away_from_it() -> None:
    stages = made("mannequin", {"mid-bust": 0.95, "full-bust": 1.0})
    ways = list(line_paths(stages.design, free_lines(stages)))
    of_full = [way for way in ways if way.at(1).lines == ("full-bust",)]
    assert [round(way.at(1).design.ratio("full-bust"), 6) for way in of_full] == [1.001]
    assert all(way.most > 0 for way in ways)


def test_fixes_that_leave_nothing_have_no_remaining_problem() -> None:
    found = diagnose(made("mannequin", {"mid-bust": 0.97}, volume="conventional", gain=1.9))
    clean = replace(found, fixes=tuple(replace(each, remains=()) for each in found.fixes))
    assert hint(replace(clean, fixes=clean.fixes[:1])) == "Verified fix:"
    assert len(shown_fixes(clean)) == 2
    assert hint(clean) == "Verified fixes:"


def test_a_fix_is_named_with_how_much_it_leaves() -> None:
    found = diagnose(made("mannequin", {"mid-bust": 0.848}))
    good, bad = found.fixes[:2]
    assert (good.level, bad.level) == ("good", "bad")
    (pressed,) = (each.value for each in bad.remains if each.topic == "pressure")
    left = f"contact pressure {pressed:.1f} kPa (limit 4.0 kPa), skin strain \N{MINUS SIGN}"
    assert hint(found).startswith(f"Fixes. Remaining with the first: no problems; with the second: {left}")
    assert hint(replace(found, fixes=(bad,))).startswith(f"Partial fix. Remaining: {left}")
    assert hint(replace(found, fixes=(bad, bad))).startswith("Partial fixes. ")
