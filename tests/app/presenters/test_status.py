"""What the strip below the view says of a run, taken from a real frame."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest
from whole_trunk import wearing

from app.presenters.assessment import assessment_view
from app.presenters.status import ConvergenceView, convergence_view, explanation
from core.garment.assessment import assess_with
from core.garment.cut_list import cut_list
from core.garment.pressure_list import pressure_list
from core.measurements.figure import figure_girths
from core.measurements.table import before_after
from core.pipeline.build import Stages, build
from core.pipeline.live_solver import Frame, make_frame
from core.pipeline.region_solvers import RegionSolvers
from core.pipeline.warnings import controlled_volume


def verdict_of(frame: Frame) -> ConvergenceView:
    pressed = pressure_list(frame.stages, frame.control_points) if frame.verdict.is_valid else None
    overall = assess_with(frame, cut_list(frame.stages, frame.control_points), pressed)
    return convergence_view(frame, assessment_view(overall, frame.stages.design))


def said(stages: Stages, **settings: object) -> ConvergenceView:
    """What is said once everything rests, with the mid-bust line at 80 %."""
    design = replace(stages.design.with_line("mid-bust", 0.8), **settings)  # type: ignore[arg-type]
    stages = build(design, stages)
    solvers = RegionSolvers(stages)
    while not solvers.is_finished:
        solvers.advance()
    return verdict_of(make_frame(1, stages, solvers, 0.3))


def test_the_exact_answer_takes_newton_steps_and_not_turns(built: Callable[[str], Stages]) -> None:
    exact = said(built("mannequin"), volume="exact")
    assert exact.pace.endswith(" · 0.3 s")
    assert exact.effort.endswith(" Newton iterations")
    assert " iterations" in said(built("mannequin"), volume="adaptive").effort


def test_of_one_newton_step_it_says_step(built: Callable[[str], Stages]) -> None:
    stages = build(replace(built("mannequin").design.with_line("mid-bust", 0.8), volume="exact"))
    solvers = RegionSolvers(stages)
    solvers.bust.exact = replace(solvers.bust.exact, steps=1)
    assert verdict_of(make_frame(1, stages, solvers)).effort == "Solved in one Newton iteration"


def test_a_run_that_ran_away_has_no_figures(built: Callable[[str], Stages]) -> None:
    verdict = said(built("mannequin"), line_force="explicit")
    assert verdict.state == "diverging"
    assert verdict.numbers == []
    assert verdict.level == "bad"
    assert verdict.hint


def test_what_a_designer_asks_first_stands_first(built: Callable[[str], Stages]) -> None:
    stages = build(built("mannequin").design.with_line("mid-bust", 0.97), built("mannequin"))
    solvers = RegionSolvers(stages)
    while not solvers.is_finished:
        solvers.advance()
    frame = make_frame(1, stages, solvers, 0.3)
    pressed = pressure_list(stages, frame.control_points)
    overall = assessment_view(assess_with(frame, cut_list(stages, frame.control_points), pressed))
    girths = figure_girths(frame)
    before, after = girths["bust"]
    measured = [each["bust_girth"].value for each in before_after(stages, frame.control_points)]
    assert measured == [before, after], "one girth, wherever it is shown"
    shown = convergence_view(frame, overall, girths, pressed).numbers
    assert [name for name, _ in shown] == [
        "Bust point",
        "Bust girth",
        "Max. pressure",
        "Volume error",
    ]
    assert shown[1][1] == f"{before:.1f} → {after:.1f} mm"
    assert 700.0 < before < 1100.0
    assert before != after
    assert shown[2][1] == f"{max(row.max_kpa for row in pressed.rows if row.max_kpa):.1f} kPa"
    assert [name for name, _ in convergence_view(frame, overall).numbers][-1] == "Volume error"


def test_an_oscillation_of_waist_and_hips_is_told_as_theirs() -> None:
    stages = wearing({"waist": 0.97})
    calm = make_frame(1, stages, RegionSolvers(stages))
    rest = replace(calm.verdict, motion="settled")
    frame = replace(
        calm, verdict=replace(rest, motion="vibrating", error=0.02, amplitude=0.01), bust_verdict=rest
    )
    verdict = verdict_of(frame)
    assert verdict.state == "vibrating"
    assert "waist and hips" in verdict.hint
    assert "waist and hips" in explanation(frame)
    assert [name for name, _ in verdict.numbers] == ["Waist and hips", "Amplitude"]
    assert controlled_volume(frame) == pytest.approx((0.0, 0.0), abs=1e-9), "the bust keeps its volume"
