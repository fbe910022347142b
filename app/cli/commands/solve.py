"""Solve a design and write the reshaped body, the control mesh, the iterations and a report."""

from __future__ import annotations

import argparse
from argparse import ArgumentParser, Namespace
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from app.cli.design import stages_of
from app.cli.options import add_folder_output, add_lines, add_scan, add_volume
from app.cli.output import finish, make_folder
from app.cli.solved_design import is_converged
from app.presenters.assessment import assessment_lines
from core.export.solution_report import write_solution
from core.garment.assessment import assess
from core.garment.wires import nearest_wires
from core.landmarks.types import SIDES
from core.landmarks.warnings import collect_warnings
from core.pipeline.solve import Solution, check_held_lines, solve
from core.pipeline.warnings import immovable_lines, shape_warnings

DIVERGED = (
    "The solver diverged: the written shape is not valid. Reduce line_stiffness, or use --volume exact."
)


def add_options(parser: ArgumentParser) -> None:
    """Add the options of ``busk solve``."""
    add_scan(parser)
    add_lines(parser)
    add_volume(parser)
    count = "run exactly N iterations (default: until converged, at most 300, waist and hips 600)"
    parser.add_argument("--iterations", type=_iterations, metavar="N", help=count)
    add_folder_output(parser)


def _iterations(text: str) -> int:
    if not (text.isdecimal() and 1 <= int(text) <= 100_000):
        raise argparse.ArgumentTypeError(f"'{text}' is not a number of iterations from 1 to 100000")
    return int(text)


def run(options: Namespace) -> int:
    """Solve the design and write it: nothing is written if it is refused. Raises UserError."""
    stages = stages_of(options)
    solution, design = solve(stages, options.iterations), stages.design
    check_held_lines(solution)
    out, assessment = make_folder(options.out), assess(solution)
    values = write_solution(solution, out, {"assessment": assessment.as_data()})
    text = [*assessment_lines(assessment, design), *_lines(values), _end(values, solution, out)]
    unclear = collect_warnings(stages.body, stages.landmarks)
    warnings = (*unclear, *immovable_lines(stages), *shape_warnings(solution))
    diverged = [DIVERGED] * (solution.verdict.motion == "diverging")
    return finish("\n".join(text), is_converged(solution), (*warnings, *diverged))


def _lines(values: Mapping[str, Any]) -> Iterator[str]:
    lower = values.get("lower_trunk", {})
    for name, line in (*values["lines"].items(), *lower.get("lines", {}).items()):
        if line["worn"]:
            closed = line["whole_band_rest_mm"] != line["rest_mm"]
            yield (
                f"{name}: set {line['set_mm']:.1f} mm{' front length' if closed else ''} "
                f"({line['set_percent']:.1f} %), reached {line['reached_mm']:.1f} mm"
                + (f"; full length {line['whole_band_reached_mm']:.1f} mm" if closed else "")
            )
    yield from _figure(lower)
    taken = {name: zone["taken_up_inside_ml"] for name, zone in lower.get("zones", {}).items()}
    if inside := [f"{name} {ml:.0f} ml" for name, ml in taken.items() if abs(ml) >= 0.5]:
        yield f"taken up inside: {', '.join(inside)}"
    for cup in values.get("cups", ()):
        more = f", holds {cup['more_ml']:+z.0f} ml" if cup["more_ml"] is not None else ""
        wire = ""
        if values["design"]["cup"]["wire"]:
            sizes = " or ".join(f"{each.kind.lower()} {each.size}" for each in nearest_wires(cup["root_mm"]))
            wire = f", wire {cup['wire_n']:.1f} N (root {cup['root_mm']:.0f} mm: {sizes})"
        yield (
            f"cup {cup['side']}: bears {cup['up_n']:.1f} N, presses {cup['max_kpa']:.1f} kPa at most on "
            f"{100.0 * cup['contact']:.0f} % of its area{wire}{more}"
        )


def _figure(lower: Mapping[str, Any]) -> Iterator[str]:
    """Yield what becomes of waist, hips and seat, from the report of the ``lower`` trunk."""
    for name, girth in lower.get("girths", {}).items():
        before, after = girth["before_mm"], girth["after_mm"]
        told = name.replace("_", " ")
        yield f"girth, {told}: {before:.1f} to {after:.1f} mm ({after - before:+z.1f})"
    if moves := lower.get("moves"):
        for name in ("buttock", "gluteal_fold"):
            left, right = (moves[f"{name}_{side}_up_mm"] for side in SIDES)
            yield f"{name.replace('_', ' ')}: left {left:+z.1f}, right {right:+z.1f} mm up"
        yield f"belly: {moves['belly_back_mm']:+z.1f} mm back"


def _end(values: Mapping[str, Any], solution: Solution, out: Path) -> str:
    design, volume, count = solution.stages.design, values["volume"], solution.last.iteration
    step = "iteration" if design.volume != "exact" else "Newton iteration"
    kept = "body_change" if design.volume == "exact" and design.dense_volume else "error"
    below = ""
    if solution.lower is not None:
        more, error = solution.lower.last.iteration, values["lower_trunk"]["volume"]["error_ml"]
        below = f"; lower trunk after {more}, volume error {error:+z.2f} ml"
    return (
        f"{solution.verdict.words} after {count} {step}{'s' if count != 1 else ''}, volume error "
        f"{volume[f'{kept}_percent']:+z.4f} % ({volume[f'{kept}_ml']:+z.2f} ml){below}; written to {out}"
    )
