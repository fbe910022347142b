"""Solve a design with the lines and elastics of the options: result, warnings, assessment."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, reduce

from app.presenters.assessment import assessment_lines
from app.presenters.elastics import effect_text, next_step
from core.document.design import Design
from core.document.elastic import ElasticError
from core.errors import LineError
from core.garment.assessment import Assessment, assess
from core.garment.elastic_library import library
from core.garment.elastic_options import KEEP_CUT, KEEP_FIT, elastic_option, outcome_of
from core.garment.line_requests import apply_elastics, apply_lines
from core.garment.match_shape import match_lengths
from core.messages import Message, join
from core.pipeline.build import Stages, build
from core.pipeline.solve import Solution, solve_valid
from core.pipeline.warnings import shape_warnings


@dataclass(frozen=True)
class SolvedDesign:
    """A solved design with its warnings.

    ``effect`` is the lift with the requested elastics compared with rigid bands, a sentence, if known.
    """

    solution: Solution
    warnings: list[Message]
    effect: tuple[str, ...] = ()

    @property
    def converged(self) -> bool:
        """Return whether the solver has converged to a shape that is not folded."""
        return is_converged(self.solution)

    @cached_property
    def assessment(self) -> Assessment:
        """Return the overall verdict."""
        return assess(self.solution)

    @property
    def verdict(self) -> list[str]:
        """Return the overall verdict with its reasons, as lines of text."""
        return assessment_lines(self.assessment, self.solution.stages.design)


def is_converged(solution: Solution) -> bool:
    """Return whether the solver has converged to a shape that is not folded."""
    return solution.verdict.motion == "settled" and solution.verdict.state != "folded"


def solve_design(
    design: Design,
    lines: Sequence[str],
    elastics: Sequence[str],
    *,
    keep_fit: bool = False,
    bare: bool = False,
) -> SolvedDesign:
    """Solve a design with ``lines``, NAME=LENGTH, and ``elastics``, LINE=ELASTIC.

    With ``keep_fit`` lines with an elastic reach the lengths that they reach without it. Raises UserError,
    also for a design without active lines and cups unless it may be ``bare``.
    """
    stages = build(design)
    design = apply_lines(design, stages.lines, lines)
    requested = apply_elastics(design, elastics)
    worn = any(region.lines for region in design.regions)
    if not worn and design.cup is None and not bare:
        raise LineError(
            Message("No active lines."),
            Message("Set one: --line mid-bust=75% --elastic 'mid-bust=plush 12'."),
        )
    regions = requested.regions if keep_fit or elastics else ()
    named = [name for region in regions for name in region.active_elastics()]
    rigid = build(reduce(lambda each, name: each.with_elastic(name, None), named, design), stages)
    try:
        if keep_fit:
            requested = match_lengths(rigid, solve_valid(rigid).control_points, requested.active_elastics())
        solution = solve_valid(build(requested, stages))
    except ElasticError as problem:
        raise _with_next_step(problem, rigid, requested, KEEP_FIT if keep_fit else KEEP_CUT) from problem
    warnings = shape_warnings(solution)
    if solution.verdict.motion != "settled":
        warnings.append(Message("The solver has not converged: these values may still change."))
    return SolvedDesign(solution, warnings, _effect_of(solution.stages, rigid) if named else ())


def _effect_of(stages: Stages, rigid: Stages) -> tuple[str, ...]:
    """Return the lift of a design compared with rigid bands, if lines lift and both have an equilibrium."""
    if not stages.design.lines:
        return ()
    try:
        return (effect_text(outcome_of(stages), outcome_of(rigid)),)
    except LineError:
        return ()


def _with_next_step(problem: ElasticError, rigid: Stages, requested: Design, mode: str) -> LineError:
    """Return the problem of an elastic with the nearest one that works for its line."""
    wanted = requested.active_elastics()[problem.line]
    names = rigid.design.linked_lines(problem.line)
    try:
        options = [elastic_option(rigid, names, each, mode) for each in (wanted, *library().values())]
    except LineError:
        return problem  # there is no equilibrium without elastics either
    return LineError(
        problem.message, join((problem.hint, Message("{text}", text=next_step(options[0], options, names))))
    )
