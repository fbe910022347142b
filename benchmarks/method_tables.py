"""Measure the tables of RESULTS.md on the method, on the two samples, and put them there.

Run: python benchmarks/method_tables.py; it takes a minute or two. The sentences beside the tables quote some
of their figures: read them again after a run.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from pages import put, table
from threadpoolctl import threadpool_limits

sys.path.insert(0, str(Path(__file__).parents[1]))

from app.presenters.samples import SAMPLES, sample_design
from core.analysis.length_limits.limits import Length, all_limits
from core.control_mesh.template import read_template
from core.document.design import Design
from core.document.line_notation import ready_made_lines
from core.document.lines import ActiveLine
from core.mechanics.exact_solution import solve_exact
from core.mechanics.iteration import Observables
from core.pipeline.build import Stages, build
from core.pipeline.solve import Solution, solve

BELOW = 0.001
"""A volume error that counts as none in the table of the controls [1]."""

MODELS: dict[str, dict[str, Any]] = {
    "default": {},
    "prestressed": {"member_law": "prestressed"},
    "co-rotated": {"member_law": "co-rotated"},
    "sliding": {"line_contact": "sliding"},
    "held": {"line_hold": "held"},
}
CONTACTS = ("glued", "sliding")


def lifts(marks: Observables, rest: Observables) -> list[float]:
    """How far bust points and foremost places rose, and the latter came forward [mm]."""
    nipples = (
        marks.bust_point_left_z + marks.bust_point_right_z - rest.bust_point_left_z - rest.bust_point_right_z
    )
    return [nipples / 2, marks.apex_z - rest.apex_z, marks.apex_protrusion - rest.apex_protrusion]


def signed(values: list[float]) -> list[str]:
    return [f"{value:+.1f}".replace("+0.0", "0.0").replace("-0.0", "0.0") for value in values]


def exactly(stages: Stages) -> tuple[Observables, float, int]:
    """The exact answer: what is watched, the mid-bust line's reached over rest length, Newton steps."""
    worn = {line.name: line.ratio for line in stages.design.lines}
    model = stages.model
    balance = solve_exact(model, tuple(worn.get(line.name, 1.0) for line in model.lines))
    points = model.tensegric.expand(balance.state.moved)
    number = [line.name for line in model.lines].index("mid-bust")
    reached = model.line_lengths(points)[number] / model.lines[number].rest_length
    return stages.watch(points), float(reached), balance.steps


def choices(body: str, stage: Callable[[Design], Stages]) -> Iterator[list[str]]:
    name = body
    for contact in CONTACTS:
        for firm, word in ((0.0, "free"), (0.1, "firm")):
            stages = stage(replace(sample_design(body), line_contact=contact, firm_chest=firm))
            marks, reached, _ = exactly(stages)
            yield [
                name,
                f"{contact}, {word}",
                f"{100 * reached:.1f} %",
                *signed(lifts(marks, stages.rest_marks)),
            ]
            name = ""


def controls(body: str, stage: Callable[[Design], Stages]) -> Iterator[list[str]]:
    for ratio in (0.97, 0.90, 0.80, 0.60):
        design = replace(sample_design(body), lines=(ActiveLine("mid-bust", ratio),))
        runs = {
            control: solve(stage(replace(design, volume=control)), 200)
            for control in ("none", "conventional", "adaptive", "accumulating")
        }
        _, reached, steps = exactly(runs["adaptive"].stages)
        adaptive, none = runs["adaptive"], runs["none"]
        turns = f"{_calm_from(adaptive)}, {_calm_from(runs['accumulating'])}"
        errors = f"{100 * none.last.error:+.2f} %", _told(runs["conventional"])
        yield [
            f"{body} {100 * ratio:.0f} %",
            f"{reached:.3f}"[1:],
            *errors,
            f"{100 * adaptive.last.error:.4f} %".replace("-0.0000", "0.0000"),
            turns,
            str(steps),
            adaptive.verdict.state,
        ]


def _calm_from(solution: Solution) -> int:
    """The turn from which on the volume error stays below BELOW."""
    off = np.flatnonzero(np.abs([each.error for each in solution.records]) > BELOW)
    return int(off[-1]) + 2 if len(off) else 1


def _told(solution: Solution) -> str:
    verdict = solution.verdict
    if verdict.motion == "vibrating":
        return f"**vibrates, {200 * verdict.amplitude:.1f} % swing**"
    return f"{100 * solution.last.error:+.2f} %, {verdict.motion}"


def limits(body: str, stage: Callable[[Design], Stages]) -> Iterator[list[str]]:
    for name, model in MODELS.items():
        told = []
        for line in all_limits(stage(replace(sample_design(body), lines=(), **model))):
            if line.line.name in ("mid-bust", "full-bust"):
                told += [
                    _length(line.onsets[sign], line.line.rest_length)
                    for sign in ("strained", "overstrained", "folded")
                ]
        yield [f"{body}, {name}" if name == "default" else name, *told]


def _length(begin: Length | None, rest: float) -> str:
    return "never" if begin is None else f"{100 * begin.ratio:.1f} ({100 * begin.reached / rest:.1f})"


def pairs(stages: dict[str, Callable[[Design], Stages]]) -> Iterator[list[str]]:
    kinds = ready_made_lines(read_template("168"))
    for contact in CONTACTS:
        for kind in ("mid-bust", "straps", "slings", "obliques", "rings"):
            told, own = [], kinds.get(kind, ())
            worn = tuple(ActiveLine(line.name, 0.95) for line in own) or (ActiveLine(kind, 0.95),)
            for body, stage in stages.items():
                design = replace(sample_design(body), line_contact=contact, own_lines=own, lines=worn)
                solution = solve(stage(design))
                assert solution.verdict.motion == "settled", (kind, contact, body)
                told += signed(lifts(solution.last.marks, solution.stages.rest_marks))
            yield [kind.replace("obliques", "oblique lines"), contact, *told]


def main() -> None:
    stages: dict[str, Callable[[Design], Stages]] = {body: _kept() for body in SAMPLES}

    def rows(of: Callable[..., Iterator[list[str]]]) -> list[list[str]]:
        return [row for body, stage in stages.items() for row in of(body, stage)]

    up = ["bust point up", "foremost place up", "forward"]
    put("choices", table(["body", "contact, chest", "reached", *up], rows(choices)))
    heads = ["body, set length", "L", "none", "conventional", "adaptive"]
    heads += ["below 0.1 % from turn: adaptive, accumulating", "exact: steps", "verdict"]
    put("controls", table(heads, rows(controls)))
    heads = ["strained", "overstrained", "folded"]
    heads = ["body, model", "mid-bust: strained", *heads[1:], "full-bust: strained", *heads[1:]]
    put("shortest", table(heads, rows(limits)))
    heads = ["line", "contact", "mannequin: bust point up", "apex up", "forward"]
    heads += ["person: bust point up", "apex up", "forward"]
    put("lifts", table(heads, pairs(stages)))
    for body, stage in stages.items():
        for template in ("168", "120"):
            built = stage(replace(sample_design(body), template=template))
            volume = built.model.volume.rest_volume / 1000.0
            print(f"{body}, {template}: {volume:,.0f} ml, limit of the gain {built.gain_limit:.2f}")
        sliding = replace(sample_design(body), line_contact="sliding")
        *_, reached, _ = exactly(stage(replace(sliding, lines=(ActiveLine("mid-bust", 0.8),))))
        print(f"{body}, sliding, set to 80 %: reaches {100 * reached:.1f} %")
        held = stage(replace(sliding, lines=(), line_hold="held"))
        last = {limit.line.name: limit.last for limit in all_limits(held)}
        print(f"{body}, held and sliding: last balances {last}")


def _kept() -> Callable[[Design], Stages]:
    """A ``build`` that reuses what the one before has made."""
    last: list[Stages | None] = [None]

    def stage(design: Design) -> Stages:
        last[0] = build(design, last[0])
        return last[0]

    return stage


if __name__ == "__main__":
    with threadpool_limits(1):
        main()
