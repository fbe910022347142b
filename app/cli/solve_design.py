"""A design with its lines as the command line asks for them, solved: what is cut, and what presses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, reduce

from app.cli.elastic_list import effect_of, with_next_step
from app.cli.options import dressed, made_of
from app.presenters.assessment import assessment_lines
from core.document.design import Design
from core.document.elastic import ElasticError
from core.errors import LineError
from core.garment.assessment import Assessment, assessed
from core.garment.elastic_options import KEEP_CUT, KEEP_FIT
from core.garment.match_shape import as_worn
from core.garment.tension import ran_away
from core.pipeline.build import Stages, build
from core.pipeline.exact import NoBalanceError
from core.pipeline.solve import Solution, run
from core.pipeline.warnings import shape_warnings


@dataclass(frozen=True)
class Worn:
    """A solved design, whether the body came to rest, and what to look at.

    ``effect`` is the lift with requested elastics against bands that do not stretch, in a sentence if known.
    """

    solution: Solution
    settled: bool
    warnings: list[str]
    effect: tuple[str, ...] = ()

    @cached_property
    def assessment(self) -> Assessment:
        """The overall verdict."""
        return assessed(self.solution)

    @property
    def verdict(self) -> list[str]:
        """The overall verdict with its reasons, as lines of text."""
        return assessment_lines(self.assessment, self.solution.stages.design)


def run_to_body(stages: Stages) -> Solution:
    """Solve the design of ``stages``. Raises LineError if the turns ran away: what they leave is no body."""
    solution = run(stages)
    if solution.verdict.motion == "diverging":
        raise NoBalanceError(stages.design) if stages.design.line_hold == "held" else ran_away()
    return solution


def run_worn(
    design: Design, lines: Sequence[str], elastics: Sequence[str], *, same: bool = False, bare: bool = False
) -> Worn:
    """Solve a design with lines and elastics as requested. Raises UserError, for one without lines unless
    it may be ``bare``.

    If ``same`` lines made of elastics reach what they reach without them.
    """
    stages = build(design)
    design = dressed(design, stages.model.lines, lines)
    requested = made_of(design, elastics)
    if not design.lines and not bare:
        raise LineError("No line is worn.", "Set one: --line mid-bust=75% --elastic 'mid-bust=plush 12'.")
    named = [name for name in requested.worn_elastics() if same or elastics]
    plain = build(reduce(lambda each, name: each.with_elastic(name, None), named, design), stages)
    try:
        if same:
            points = run_to_body(plain).control_points
            requested = as_worn(plain, points, requested.worn_elastics())
        solution = run_to_body(build(requested, stages))
    except ElasticError as problem:
        raise with_next_step(problem, plain, requested, KEEP_FIT if same else KEEP_CUT) from problem
    effect = effect_of(solution.stages, plain) if named else ()
    motion = solution.verdict.motion
    settled = motion == "settled" and solution.verdict.state != "folded"
    warnings = shape_warnings(solution)
    if motion != "settled":
        warnings.append("The solver has not converged: these values may still change.")
    return Worn(solution, settled, warnings, effect)
