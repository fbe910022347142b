"""A run in numbers: one CSV row per turn, and a report with the final figures, versions and times."""

from __future__ import annotations

import csv
import json
import os
import platform
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path
from typing import Any

from core import __version__
from core.control_mesh.quality import FitQuality
from core.document.serialization import to_json
from core.export.mesh import write_control_points, write_mesh
from core.files.atomic_write import atomic_path, write_text
from core.garment.cup_fit import WornCups
from core.measurements.lower_trunk import lower_before_after, lower_moves
from core.mechanics.constraint_lines import Line
from core.mechanics.iteration import Observables, Record
from core.mechanics.mesh_quality import MeshQuality
from core.messages import Message, plain
from core.pipeline.build import Stages
from core.pipeline.lower_region import LowerStages
from core.pipeline.solve import RegionSolution, Solution
from core.pipeline.stages import RegionStages
from core.pipeline.warnings import immovable_lines, shape_warnings, warnings
from core.pipeline.zone_volumes import zone_volumes

_LIBRARIES = ("numpy", "scipy", "trimesh")
_SETTINGS = ("template", "line_height", "weights", "scaled_normals", "dense_volume", "tissue_stiffness")


_NOT_ON_NET = Message(
    "Not modelled: friction between garment and skin, gravity, the measured stiffness of "
    "tissue, and the material of lines without an elastic."
)
_NOT_ON_SOLID = Message(
    "Not modelled: friction between garment and skin, the measured softness of this person, and the "
    "material of lines without an elastic."
)


def write_solution(solution: Solution, folder: Path, more: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """Write body.ply, report.json and for the bust control.ply, control.csv and turns.csv; return the report.

    Files of the lower trunk end in -lower. ``more`` stands in the report beside its own figures. Raises
    UserError if something cannot be written.
    """
    write_mesh(folder / "body.ply", solution.body)
    for region, ending in zip(solution.regions, ("", "-lower"), strict=False):
        control = region.stages.control
        write_mesh(folder / f"control{ending}.ply", control.mesh.moved(region.control_points))
        write_control_points(folder / f"control{ending}.csv", control)
    write_iterations(folder / "turns.csv", solution.records, solution.stages)
    if solution.lower is not None:
        _write_lower_iterations(folder / "turns-lower.csv", solution.lower)
    figures = {**(more or {}), **report(solution)}
    write_text(folder / "report.json", json.dumps(figures, indent=1, ensure_ascii=False) + "\n")
    return figures


def write_iterations(path: str | os.PathLike[str], records: Sequence[Record], stages: Stages) -> None:
    """Write one CSV row per turn; each heading names its unit, heights what they are counted from."""
    heading = ["turn", "volume_error_percent", "volume_error_ml", *_marks(stages.rest_marks)]
    heading += [*(f"length_{line.name}_mm" for line in stages.model.lines), "step_mm"]
    low = _lowest(stages)
    rows = []
    for row in records:
        seen = _marks(row.marks, low).values()
        rows.append((row.iteration, 100.0 * row.error, row.error_ml, *seen, *row.lengths, row.step))
    _write_rows(path, heading, rows)


def _write_lower_iterations(path: Path, solution: RegionSolution) -> None:
    stages, rest_ml = solution.stages, solution.stages.model.volume.rest_volume / 1000.0
    heading = ["turn", "volume_error_ml", *(f"volume_error_{name}_ml" for name in stages.control.zone_names)]
    heading += [*(f"length_{line.name}_mm" for line in stages.model.lines), "step_mm"]
    rows = [
        (row.iteration, row.error_ml, *(rest_ml * each for each in row.zones), *row.lengths, row.step)
        for row in solution.records
    ]
    _write_rows(path, heading, rows)


def _write_rows(
    path: str | os.PathLike[str], heading: Sequence[str], rows: Sequence[tuple[float, ...]]
) -> None:
    with (
        atomic_path(Path(path)) as partial,
        open(partial, "w", newline="", encoding="utf-8") as file,
    ):
        writer = csv.writer(file)
        writer.writerow(heading)
        writer.writerows([row[0], *(f"{value:.9g}" for value in row[1:])] for row in rows)


def report(solution: Solution) -> dict[str, Any]:
    """Return the final figures of a solution, with definitions, versions and seconds, ready for JSON."""
    stages, verdict = solution.stages, solution.verdict
    figures = {
        **_region_report(solution.bust),
        "state": verdict.state,
        "motion": verdict.motion,
        "marks": {
            "rest": _marks(solution.rest.marks, _lowest(stages)),
            "final": _marks(solution.last.marks, _lowest(stages)),
        },
        **_cup_report(solution),
        "settings": _settings(stages),
        "notes": plain([*shape_warnings(solution), *notes(stages)]),
        "seconds": {
            **{name: round(seconds, 4) for name, seconds in stages.seconds.items()},
            "solve": round(solution.seconds, 4),
        },
        "versions": {
            "busk": __version__,
            "python": platform.python_version(),
            **{name: version(name) for name in _LIBRARIES},
        },
        "design": json.loads(to_json(stages.design)),
    }
    if stages.lower is not None and solution.lower is not None:
        figures["lower_trunk"] = _lower_report(stages.lower, solution.lower)
    return figures


def _lower_report(stages: LowerStages, solution: RegionSolution) -> dict[str, Any]:
    """Return the figures of the lower trunk."""
    return {
        **_region_report(solution),
        "zones": _zones_report(solution),
        "girths": {
            name: {"level_mm": before.level_mm, "before_mm": before.tape_mm, "after_mm": after.tape_mm}
            for name, (before, after) in lower_before_after(stages, solution.control_points).items()
        },
        "moves": dict(lower_moves(stages, solution.control_points)),
        "gain": stages.gain,
        "gain_limit_at_rest": stages.gain_limit,
    }


def _region_report(solution: RegionSolution) -> dict[str, Any]:
    """Return the figures that every region has."""
    stages, last, verdict = solution.stages, solution.last, solution.verdict
    return {
        "state": verdict.state,
        "motion": verdict.motion,
        "turns": last.iteration,
        "control_points": len(stages.control.row),
        "volume_control": stages.design.volume,
        "volume": _volume_report(solution),
        "vibration": {
            "period_turns": verdict.period,
            "amplitude_percent": 100.0 * verdict.amplitude,
            "growth_per_turn": verdict.growth,
        },
        "condition": _condition_report(verdict.condition),
        "lines": {
            line.name: _line_report(line, stages, reached)
            for line, reached in zip(stages.model.lines, last.lengths, strict=True)
        },
        "fit": _fit_report(stages.control.quality),
    }


def _zones_report(solution: RegionSolution) -> dict[str, Any]:
    """Return what each zone of a region gained, and what it took up inside [ml]."""
    return {
        zone.name: {
            "kept_percent": 100.0 * zone.kept,
            "change_ml": zone.change_ml,
            "taken_up_inside_ml": zone.taken_up_ml,
            "error_ml": zone.error_ml,
        }
        for zone in zone_volumes(solution.stages, solution.state)
    }


def _cup_report(solution: Solution) -> dict[str, Any]:
    """Return the figures of the cups, if the design has any."""
    if solution.stages.design.cup is None:
        return {}
    return {"cups": WornCups(solution.stages).fit(solution.control_points).as_data()}


def _volume_report(solution: RegionSolution) -> dict[str, Any]:
    rest, last = solution.stages.model.volume.rest_volume / 1000.0, solution.last
    return {
        "rest_ml": rest,
        "error_percent": 100.0 * last.error,
        "error_ml": last.error_ml,
        "body_change_percent": 100.0 * solution.body_change / rest,
        "body_change_ml": solution.body_change,
        "definition": "rest_ml: between the control mesh and the fan from the centre of its border; "
        "error = (volume - rest volume) / rest volume; body_change: what the reshaped scan itself gained, "
        "in percent of the same rest volume",
    }


def _condition_report(condition: MeshQuality | None) -> dict[str, Any]:
    if condition is None:
        return {}
    return {
        "folded": condition.folded,
        "inverted": condition.inverted,
        "overstrained": condition.overstrained,
        "strained": condition.strained,
        "largest_turn_degrees": condition.largest_rotation,
        "shortest_edge_percent": 100.0 * condition.shortest,
        "longest_edge_percent": 100.0 * condition.longest,
        "definition": "of the control mesh: the largest angle between a triangle's normal and its normal at "
        "rest, and edge lengths over rest lengths; folded from 78 degrees on, strained outside 80 to 120 %, "
        "overstrained outside 70 to 130 %",
    }


def _fit_report(quality: FitQuality | None) -> dict[str, Any]:
    if quality is None:
        return {}
    return {
        "deviation_mean_mm": quality.deviation_mean,
        "deviation_95_mm": quality.deviation_95,
        "deviation_max_mm": quality.deviation_max,
        "smallest_angle_degrees": quality.smallest_angle,
        "shortest_edge_mm": quality.shortest_edge,
        "largest_bend_degrees": quality.largest_bend,
        "crossings": quality.crossings,
        "same_way": quality.same_way,
        "bust_off_mm": quality.bust_off,
        "fold_off_mm": quality.fold_off,
        "definition": "deviation: from the skin behind the control mesh to it, by area; largest_bend: of two "
        "triangles off the fold row; crossings: triangles that cut another; same_way: smallest cosine "
        "between a triangle and the skin; *_off: of bust points and fold row from their landmarks",
    }


def _settings(stages: Stages) -> dict[str, Any]:
    return {
        **{key: getattr(stages.design, key) for key in _SETTINGS},
        **asdict(stages.design.model_options),
        "gain": stages.gain,
        "gain_limit_at_rest": stages.gain_limit,
    }


def notes(stages: Stages) -> list[Message]:
    """Return in sentences what a reader of the figures has to know."""
    return [
        *immovable_lines(stages),
        *warnings(stages),
        *stages.body.repairs,
        Message("Lengths are front lengths, from side to side; the back does not change."),
        _NOT_ON_NET if stages.tissue is None else _NOT_ON_SOLID,
    ]


def _line_report(line: Line, stages: RegionStages, reached: float) -> dict[str, Any]:
    ratio = stages.design.ratio(line.name)
    return {
        "worn": line.name in stages.design.active_lines(),
        "rest_mm": line.rest_length,
        "set_mm": ratio * line.rest_length,
        "reached_mm": reached,
        "set_percent": 100.0 * ratio,
        "reached_percent": 100.0 * reached / line.rest_length,
        "whole_band_rest_mm": line.whole_length,
        "whole_band_reached_mm": reached + line.back_length,
    }


def _lowest(stages: Stages) -> float:
    return float(stages.body.mesh.vertices[:, 2].min())


def _marks(marks: Observables | None, low: float = 0.0) -> dict[str, float]:
    """Return what is watched on the body [mm], if it was; heights are over ``low``, the lowest point."""
    if marks is None:
        return {}
    return {
        "bust_point_left_above_lowest_mm": marks.bust_point_left_z - low,
        "bust_point_right_above_lowest_mm": marks.bust_point_right_z - low,
        "apex_above_lowest_mm": marks.apex_z - low,
        "apex_protrusion_mm": marks.apex_protrusion,
    }
