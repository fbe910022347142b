"""One body of a run: the whole path from its scan to a row of results, as the single commands compute it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from app.batch.batch_design import BatchDesign, with_elastics
from app.batch.inputs import printable_path
from app.batch.schema import DONE, REFUSED, measure_column
from app.presenters.pattern import piece_rows, seam_rows
from core.analysis.inverse_design.line_selection import LineSelection
from core.analysis.inverse_design.target_requests import absolute, changes_of, goals_of
from core.document.design import Design
from core.errors import PatternError, UserError
from core.export.report_data import lift_of
from core.garment.assessment import assess_with
from core.garment.cut_list import CutList, cut_list_of
from core.garment.line_requests import with_lines_and_elastics
from core.garment.pressure_list import PressureList, pressure_list_of
from core.landmarks.warnings import collect_warnings
from core.measurements.sizes import GIRTHS_OF_SIZES, built_in, size
from core.measurements.table import Measures, before_after, measures
from core.messages import Message
from core.pattern.garment import pattern_of
from core.pipeline.build import Stages, build
from core.pipeline.solve import Solution, solve_valid
from core.pipeline.warnings import immovable_lines, shape_warnings

Row = dict[str, Any]
"""Values by the names of columns; those left out are unknown."""


@dataclass(frozen=True)
class BodyResult:
    """The ``row`` of a body, its ``stages``, with which another variant of it is computed faster, and its
    ``solution``, None for a body that is refused.
    """

    row: Row
    stages: Stages | None
    solution: Solution | None


def compute_row(design: BatchDesign, scan: Path, previous: Stages | None = None) -> BodyResult:
    """Compute the row of a scan; a body that is refused has the reason as its message.

    ``previous`` are stages of the same scan; results do not depend on them.
    """
    stages, solution = None, None
    row: Row = {"state": DONE}
    try:
        stages = build(design.on_scan(scan), previous)
        placed, miss = _with_lengths(stages, design)
        solution = solve_valid(placed)
        row |= {"target_miss_mm": miss, **_values(solution)}
    except UserError as problem:
        row |= {"state": REFUSED, "message": str(problem)}
        if stages is not None and solution is None:
            row |= _original(stages)
        solution = None
    return BodyResult(row, stages, solution)


def design_on_body(design: BatchDesign, scan: Path) -> Design:
    """Return the design that a row is computed with, its lengths and targets on this body.

    Raises UserError.
    """
    placed = design.on_scan(scan)
    if design.lines or design.elastics or design.targets:
        placed = _with_lengths(build(placed), design)[0].design
    return placed


def _with_lengths(stages: Stages, design: BatchDesign) -> tuple[Stages, float | None]:
    """Return the stages with the lines, elastics and targets of the design, and the largest deviation [mm].

    It is None without targets. Raises UserError.
    """
    lengths = with_lines_and_elastics(stages, design.lines, [])
    placed = build(with_elastics(lengths.design, design.elastics), lengths) if design.elastics else lengths
    if not design.targets:
        return placed, None
    changes = changes_of(design.targets)
    goals = tuple(
        absolute(placed, goal) if goal.name in changes else goal for goal in goals_of(design.targets)
    )
    reply = LineSelection(placed).solve(goals)
    return build(reply.design, placed), float(reply.miss)


def _values(solution: Solution) -> Row:
    stages, design = solution.stages, solution.stages.design
    before, after = before_after(stages, *solution.region_points)
    cuts, pressed = cut_list_of(solution), pressure_list_of(solution)
    verdict = assess_with(solution, cuts, pressed)
    lift = lift_of(stages.rest_marks, stages.watch(solution.control_points))
    doubts = [*_doubts(stages), *shape_warnings(solution)]
    row: Row = {
        "verdict": verdict.level,
        "message": str(verdict.findings[0].message) if verdict.findings else "",
        "solver_state": solution.verdict.state,
        "lift_left_mm": lift.left_up,
        "lift_right_mm": lift.right_up,
        "forward_left_mm": lift.left_forward,
        "forward_right_mm": lift.right_forward,
        "volume_error_percent": 100.0 * solution.last.error,
        "lower_volume_error_ml": solution.lower.last.error_ml if solution.lower is not None else None,
        **_measures(before, after=False),
        **_measures(after, after=True),
        **_sizes(before, design.worn_tight_mm),
        **dict(_lines(stages, cuts, pressed)),
    }
    if design.pattern is not None:
        pieces, problem = _pattern(solution)
        row |= pieces
        doubts += [problem] if problem else []
    return row | {"doubts": _text(doubts)}


def _original(stages: Stages) -> Row:
    """Return what is known of a body without a solution."""
    found = measures(stages.body.smoothed, stages.landmarks, stages.design.own_measures)
    sizes = _sizes(found, stages.design.worn_tight_mm)
    return {**_measures(found, after=False), **sizes, "doubts": _text(_doubts(stages))}


def _doubts(stages: Stages) -> list[Message]:
    return [*collect_warnings(stages.body, stages.landmarks), *immovable_lines(stages)]


def _text(sentences: list[Message]) -> str:
    return " ".join(dict.fromkeys(map(str, sentences)))


def _measures(found: Measures, *, after: bool) -> Row:
    return {measure_column(key, each.unit, after=after): each.value for key, each in found.items()}


def _sizes(found: Measures, allowance_mm: float) -> Row:
    """Return band and cup in each built-in table, empty for girths that are unknown or not plausible."""
    underbust, bust = (found[key].value for key in GIRTHS_OF_SIZES)
    if underbust is None or bust is None:
        return {}
    row: Row = {}
    for table in built_in():
        try:
            answer = size(table, underbust, bust, allowance_mm)
        except UserError:
            return {}
        row |= {f"band_{table.key}": answer.band, f"cup_{table.key}": answer.cup}
    return row


def _lines(stages: Stages, cuts: CutList, pressed: PressureList) -> Iterator[tuple[str, float | None]]:
    for cut in cuts.rows:
        stretched = None if cut.elongation is None else 100.0 * cut.elongation
        yield f"set_{cut.line}_percent", 100.0 * stages.design.ratio(cut.line)
        yield f"reached_{cut.line}_mm", cut.reached_front_mm
        yield f"cut_length_{cut.line}_mm", cut.cut_mm
        yield f"elongation_{cut.line}_percent", stretched
        yield f"tension_{cut.line}_n", cut.tension_n
    for row in pressed.rows:
        yield f"pressure_mean_{row.line}_kpa", row.mean_kpa
        yield f"pressure_max_{row.line}_kpa", row.max_kpa


def _pattern(solution: Solution) -> tuple[Row, Message | None]:
    """Return areas, strains and seams of the pieces, or why there are none."""
    plan = solution.stages.design.pattern
    assert plan is not None
    try:
        pattern = pattern_of(solution.stages, solution.body.vertices, plan)
    except PatternError as problem:
        return {}, problem.text
    row: Row = {}
    for piece in piece_rows(pattern):
        row[f"area_{piece.name}_cm2"] = piece.area_cm2
        row[f"strain_{piece.name}_percent"] = piece.strain_percent
    for seam in seam_rows(pattern):  # a seam that crosses another one is several stretches
        key = f"seam_{seam.name}_mm"
        row[key] = row.get(key, 0.0) + 0.5 * sum(seam.lengths_mm)
    return row, None


def plain_row(row: Mapping[str, Any]) -> Row:
    """Return a row with numbers of Python alone, ready for JSON without loss; not finite ones are unknown.

    In texts, bytes of a path that are not letters are escaped.
    """
    return {name: _plain(value) for name, value in row.items()}


def _plain(value: Any) -> Any:
    if value is None or isinstance(value, str):
        return value and printable_path(value)
    number = float(value)
    return number if math.isfinite(number) else None
