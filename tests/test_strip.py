"""What the strip below the view says of a run, taken from a real frame."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from app.presenting.verdict import StripVerdict, strip_verdict
from core.comparison import Comparison
from core.live import make_frame
from core.pipeline import Stages, build, targets_of


def said(stages: Stages, **settings: object) -> StripVerdict:
    """What is said once everything rests, with the mid-bust line at 80 %."""
    design = replace(stages.design.with_line("mid-bust", 0.8), **settings)  # type: ignore[arg-type]
    stages = build(design, stages)
    comparison = Comparison(stages.model, targets_of(design, stages), stages.watch)
    while not comparison.resting:
        comparison.advance()
    return strip_verdict(make_frame(1, stages, comparison, 0.3))


def test_the_exact_answer_takes_newton_steps_and_not_turns(built: Callable[[str], Stages]) -> None:
    exact = said(built("mannequin"), volume="exact")
    assert exact.pace == "0.3 s"
    assert exact.effort.endswith(" Newton steps")
    assert " turns: " in said(built("mannequin"), volume="adaptive").effort


def test_of_one_newton_step_it_says_step(built: Callable[[str], Stages]) -> None:
    stages = build(replace(built("mannequin").design.with_line("mid-bust", 0.8), volume="exact"))
    comparison = Comparison(stages.model, targets_of(stages.design, stages), stages.watch)
    comparison.exact = replace(comparison.exact, steps=1)
    assert strip_verdict(make_frame(1, stages, comparison)).effort == "Worked out in one Newton step"


def test_a_run_that_ran_away_has_no_figures(built: Callable[[str], Stages]) -> None:
    verdict = said(built("mannequin"), line_force="explicit")
    assert verdict.state == "diverging"
    assert verdict.numbers == []
    assert verdict.hint.endswith("as it was before."), "what to do says the doctor, who has tried it"
