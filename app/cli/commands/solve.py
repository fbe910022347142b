"""What ``busk solve`` does: a design is solved with no window, and what came out is written and told."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from app.cli.options import dressed, made_of
from app.presenters.assessment import assessment_lines
from core.document.design import Design
from core.export.solution_report import write_solution
from core.garment.assessment import assessed
from core.landmarks.warnings import doubts
from core.pipeline.build import build
from core.pipeline.exact import NoBalanceError
from core.pipeline.solve import Solution, run
from core.pipeline.warnings import shape_warnings, still_lines

RAN_AWAY = (
    "The solver diverged: the written shape is not valid. Reduce line_stiffness, or use --volume exact."
)


@dataclass(frozen=True)
class Solved:
    """What came of it: the lines to print, whether it settled, and what to look at."""

    lines: list[str]
    settled: bool
    warnings: list[str]


def run_solve(
    design: Design,
    lengths: Sequence[str],
    elastics: Sequence[str],
    turns: int | None,
    place: Callable[[], Path],
) -> Solved:
    """Solve a design with ``lengths``, NAME=LENGTH, and ``elastics``, LINE=ELASTIC, and write it.

    ``place`` makes the folder: of what is refused nothing stays behind. Raises UserError.
    """
    stages = build(design)
    design = made_of(dressed(design, stages.model.lines, lengths), elastics)
    solution = run(build(design, stages), turns)
    verdict = solution.verdict
    lost = ("diverging", "settling") if design.volume == "exact" else ("diverging",)
    if design.line_hold == "held" and verdict.motion in lost:
        raise NoBalanceError(design)
    out = place()
    assessment = assessed(solution)
    figures = write_solution(solution, out, {"assessment": assessment.as_data()})
    ran_away = [RAN_AWAY] * (verdict.motion == "diverging")
    unclear = doubts(stages.body, stages.landmarks)
    warnings = [*unclear, *still_lines(solution.stages), *shape_warnings(solution), *ran_away]
    told = [*assessment_lines(assessment, design), *_lines(figures), _end(figures, solution, out)]
    return Solved(told, verdict.motion == "settled" and verdict.state != "folded", warnings)


def _lines(figures: Mapping[str, Any]) -> Iterator[str]:
    for name, line in figures["lines"].items():
        if line["worn"]:
            own = line["whole_band_rest_mm"] == line["rest_mm"]
            yield (
                f"{name}: set {line['set_mm']:.1f} mm{'' if own else ' of the front part'} "
                f"({line['set_percent']:.1f} %), reached {line['reached_mm']:.1f} mm"
                + ("" if own else f"; full length {line['whole_band_reached_mm']:.1f} mm")
            )


def _end(figures: Mapping[str, Any], solution: Solution, out: Path) -> str:
    design, volume, count = solution.stages.design, figures["volume"], solution.last.turn
    step = "turn" if design.volume != "exact" else "Newton step"
    kept = "body_change" if design.volume == "exact" and design.dense_volume else "error"
    return (
        f"{solution.verdict.words} after {count} {step}{'s' if count != 1 else ''}, volume error "
        f"{volume[f'{kept}_percent']:+z.4f} % ({volume[f'{kept}_ml']:+z.2f} ml); written to {out}"
    )
