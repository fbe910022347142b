"""A run in numbers: one CSV row per turn, and a report with the final figures, versions and times."""

from __future__ import annotations

import csv
import json
import os
import platform
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any

from core import __version__
from core.design import to_json
from core.exact import NEWTON_LIMIT, newton
from core.lines import Line
from core.pipeline import Stages, targets_of
from core.project import whole_file
from core.solver import Record, State, at_rest, iterate, record
from core.verdict import Verdict, judge

_LIBRARIES = ("numpy", "scipy", "trimesh")
MOST_TURNS = 300


class Solution:
    """A design solved to the end in one go: its records, last state and verdict.

    ``rest`` is the record before the first turn.
    """

    def __init__(
        self, stages: Stages, rest: Record, records: Sequence[Record], state: State, verdict: Verdict
    ) -> None:
        self.stages = stages
        self.rest = rest
        self.records = tuple(records)
        self.state = state
        self.verdict = verdict

    @property
    def last(self) -> Record:
        """The last record."""
        return self.records[-1] if self.records else self.rest


def run(stages: Stages, turns: int | None = None) -> Solution:
    """Solve the design of ``stages`` from rest.

    Makes exactly ``turns`` turns, or as many as it takes to settle (at most MOST_TURNS) if None; the exact
    control makes Newton steps in their place.
    """
    targets = targets_of(stages.design, stages)
    rest = record(stages.model, at_rest(stages.model), 0.0, stages.watch)
    if targets.control == "exact":
        return _run_exact(stages, rest, turns)
    records: list[Record] = []
    state = at_rest(stages.model)
    steps = iterate(
        stages.model, lambda: targets, turns=MOST_TURNS if turns is None else turns, watch=stages.watch
    )
    for now, measured in steps:
        state = now
        records.append(measured)
        if turns is None and judge(records).state in ("settled", "diverged"):
            break
    return Solution(stages, rest, records, state, judge(records))


def _run_exact(stages: Stages, rest: Record, turns: int | None) -> Solution:
    ratios = targets_of(stages.design, stages).ratios
    records: list[Record] = []
    before = at_rest(stages.model)
    for balance in newton(stages.model, ratios, limit=NEWTON_LIMIT if turns is None else turns):
        if balance.steps:
            step = float(((balance.state.moved - before.moved) ** 2).sum(axis=1).max() ** 0.5)
            records.append(record(stages.model, balance.state, step, stages.watch))
        before = balance.state
    state = "settled" if balance.found else "settling"
    return Solution(
        stages, rest, records, balance.state, Verdict(state, balance.steps, (records or [rest])[-1].error)
    )


def write_turns(path: str | os.PathLike[str], records: Sequence[Record], lines: Sequence[Line]) -> None:
    """Write one CSV row per turn; each heading names its unit."""
    heading = ["turn", "volume_error_percent", "volume_error_ml", "nipple_left_z_mm", "nipple_right_z_mm"]
    heading += ["apex_z_mm", "apex_protrusion_mm", *(f"length_{line.name}_mm" for line in lines), "step_mm"]
    with (
        whole_file(Path(path).absolute()) as partial,
        open(partial, "w", newline="", encoding="utf-8") as file,
    ):
        writer = csv.writer(file)
        writer.writerow(heading)
        for row in records:
            marks = row.marks
            seen = (
                (marks.nipple_left_z, marks.nipple_right_z, marks.apex_z, marks.apex_protrusion)
                if marks
                else ()
            )
            figures = (100.0 * row.error, row.error_ml, *seen, *row.lengths, row.step)
            writer.writerow([row.turn, *(f"{value:.9g}" for value in figures)])


def report(solution: Solution) -> dict[str, Any]:
    """Return the final figures of a solution, with definitions, versions and seconds, ready for JSON."""
    stages, last, verdict = solution.stages, solution.last, solution.verdict
    volume = stages.model.volume.rest_volume
    return {
        "state": verdict.state,
        "turns": last.turn,
        "volume_control": stages.design.volume,
        "volume": {
            "rest_ml": volume / 1000.0,
            "error_percent": 100.0 * last.error,
            "error_ml": last.error_ml,
            "definition": "between the control mesh and the fan from the centre of its border; "
            "error = (volume - rest volume) / rest volume",
        },
        "vibration": {
            "period_turns": verdict.period,
            "amplitude_percent": 100.0 * verdict.amplitude,
            "growth_per_turn": verdict.growth,
        },
        "lines": {
            line.name: _line_report(line, stages, reached)
            for line, reached in zip(stages.model.lines, last.lengths, strict=True)
        },
        "marks": {"rest": _marks(solution.rest), "final": _marks(last)},
        "settings": _settings(stages),
        "notes": notes(stages),
        "seconds": {name: round(seconds, 4) for name, seconds in stages.seconds.items()},
        "versions": {
            "busk": __version__,
            "python": platform.python_version(),
            **{name: version(name) for name in _LIBRARIES},
        },
        "design": json.loads(to_json(stages.design)),
    }


def _settings(stages: Stages) -> dict[str, Any]:
    return {
        "template": stages.design.template,
        "line_height": stages.design.line_height,
        "line_stiffness": stages.design.line_stiffness,
        "line_contact": stages.design.line_contact,
        "weights": stages.design.weights,
        "gain": stages.gain,
        "gain_limit_at_rest": stages.gain_limit,
    }


def notes(stages: Stages) -> list[str]:
    """Return in sentences what a reader of the figures has to know."""
    still = [
        line.name for line in stages.model.lines if line.name in stages.design.worn() and not line.constrains
    ]
    return [
        *(
            f"{name} lies on the rib cage: it is measured, and no length that is set moves it."
            for name in still
        ),
        *stages.control.warnings,
        *stages.body.repairs,
        "Lengths are those of the front part of a line, side to side; the back does not change.",
        "Not modelled: sliding of the garment on the skin, gravity, stiffness of real tape and real tissue.",
    ]


def _line_report(line: Line, stages: Stages, reached: float) -> dict[str, Any]:
    ratio = stages.design.ratio(line.name)
    return {
        "worn": line.name in stages.design.worn(),
        "rest_mm": line.rest_length,
        "set_mm": ratio * line.rest_length,
        "reached_mm": reached,
        "set_percent": 100.0 * ratio,
        "reached_percent": 100.0 * reached / line.rest_length,
        "whole_band_rest_mm": line.whole_length,
        "whole_band_reached_mm": reached + line.back_length,
    }


def _marks(row: Record) -> dict[str, float]:
    marks = row.marks
    if marks is None:
        return {}
    return {
        "nipple_left_z_mm": marks.nipple_left_z,
        "nipple_right_z_mm": marks.nipple_right_z,
        "apex_z_mm": marks.apex_z,
        "apex_protrusion_mm": marks.apex_protrusion,
    }


def write_report(path: str | os.PathLike[str], values: dict[str, Any]) -> None:
    """Write a report as JSON, whole or not at all."""
    with whole_file(Path(path).absolute()) as partial:
        partial.write_text(json.dumps(values, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
