"""Compare a design with a fitting scan, and fit the stiffness of tissue and lines to it."""

from __future__ import annotations

import json
from argparse import ArgumentParser, Namespace
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from app.cli.design import check_project_name, save_design, stages_of
from app.cli.options import add_forms, add_lines, add_project_output
from app.cli.output import finish, table_lines
from app.presenters.scan_comparison import (
    aligned_text,
    determination_text,
    fixed_parameters_text,
    improvement_text,
    parameter_rows,
    residual_rows,
    summary_text,
)
from core import __version__
from core.analysis.calibration.api import (
    THICKEST,
    CalibrationResult,
    FittingScan,
    Residuals,
    calibrate,
    read_fitting_scan,
    require_active_line,
)
from core.document.design import ScanSource
from core.errors import UserError
from core.messages import Message
from core.pipeline.build import Stages
from core.scan.orientation.unit_detection import MILLIMETRES


@dataclass(frozen=True, eq=False)
class Calibrated:
    """The result for a fitting scan; ``out`` is the project it was saved to, or empty."""

    stages: Stages
    worn: FittingScan
    found: CalibrationResult
    out: str


def add_options(parser: ArgumentParser) -> None:
    """Add the options of ``busk calibrate``."""
    parser.add_argument("input", metavar="PROJECT", help="a project (.busk), or a scan with --line")
    fitting = "a scan of the same person wearing the garment (fitting scan)"
    parser.add_argument("worn", metavar="FITTING_SCAN", help=fitting)
    add_lines(parser)
    unit = "unit of the fitting scan (default: detected)"
    parser.add_argument("--unit", dest="worn_unit", type=str.lower, choices=tuple(MILLIMETRES), help=unit)
    for key in ("up", "front"):
        axis = f"{key} axis of the fitting scan (default: detected)"
        parser.add_argument(f"--{key}", dest=f"worn_{key}", metavar="AXIS", help=axis)
    thickness = "fabric thickness, subtracted from the fitting scan: 0 to 20 mm (default: 0)"
    parser.add_argument("--thickness", type=float, default=0.0, metavar="MM", help=thickness)
    lengths = "also fit the line lengths, if lines may have been cut to other lengths than designed"
    parser.add_argument("--lengths", action="store_true", help=lengths)
    one = "fit one common stiffness for all lines without their own stiffness or elastic"
    parser.add_argument("--one-roll", action="store_true", help=one)
    add_project_output(parser)
    add_forms(parser)


def run(options: Namespace) -> int:
    """Print the residuals and the fitted parameters, and save the calibrated design. Raises UserError."""
    check_project_name(options.out)
    if not 0.0 <= options.thickness <= THICKEST:
        raise UserError(
            Message(
                "The fabric thickness {thickness} mm is out of range.", thickness=f"{options.thickness:g}"
            ),
            Message("Enter a thickness from 0 to {THICKEST} mm.", THICKEST=f"{THICKEST:g}"),
        )
    stages = stages_of(options)
    require_active_line(stages)  # before half a minute is spent on reading
    axes = {"unit": options.worn_unit, "up": options.worn_up, "front": options.worn_front}
    worn = read_fitting_scan(stages, ScanSource(options.worn, **axes))
    how = {"lengths": options.lengths, "one_roll": options.one_roll}
    found = calibrate(stages, worn, thickness=options.thickness, **how)
    save_design(options.input, options.out, found.design if found.is_improved else stages.design, stages)
    done = Calibrated(stages, worn, found, options.out)
    text = json.dumps(calibration_data(done), indent=1) if options.json else "\n".join(_text(done))
    return finish(text, found.is_improved)


def _text(done: Calibrated) -> Iterator[str]:
    found, design = done.found, done.stages.design
    yield from (aligned_text(done.worn), "")
    for when, difference in (("before", found.before), ("after", found.after)):
        rows = [(row.title, row.mean, row.rms, row.most) for row in residual_rows(difference)]
        yield from table_lines([(f"residual {when} [mm]", "mean", "RMS", "95 %"), *rows])
        yield from (summary_text(difference), "")
    numbers = [
        (each.title, each.before, each.after, each.plus_minus) for each in parameter_rows(found, design)
    ]
    yield from table_lines([("parameter", "before", "after", "±"), *numbers])
    words = (
        determination_text(found, design),
        fixed_parameters_text(found, design),
        improvement_text(found, design),
    )
    yield from filter(None, words)
    yield "± covers 95 % of the scan noise; differences in posture or breathing are not included."
    yield "The values apply to this person and this garment."
    if done.out:
        yield f"written to {done.out}{'' if found.is_improved else ', unchanged'}"


def calibration_data(done: Calibrated) -> dict[str, Any]:
    """Return a calibration as plain values, ready for JSON."""
    found, laid = done.found, done.worn.alignment
    return {
        "worn": done.worn.name,
        "alignment": {
            "matrix": laid.matrix.tolist(),
            "rms_mm": laid.rms,
            "at_95_percent_mm": laid.most,
            "met": laid.met,
            "shown": laid.seen,
            "unsure_degrees": laid.rotation_deviations.tolist(),
            "unsure_mm": laid.translation_deviations.tolist(),
        },
        "before": _difference(found.before),
        "after": _difference(found.after),
        "numbers": [
            {
                "name": number.name,
                "before": number.before,
                "after": number.after,
                "plus_minus": number.plus_minus,
                "kept": number.kept,
                "told": number.is_well_determined,
                "cannot_be_told_from": found.confounded.get(number.name) or None,
            }
            for number in found.calibration.numbers
        ],
        "points": found.met,
        "singular_values": list(found.singular),
        "thickness_mm": found.calibration.thickness,
        "helped": found.is_improved,
        "at_end": list(found.at_end),
        "explains_little": found.has_large_residual,
        "weak": found.is_poorly_determined,
        "written_to": done.out or None,
        "versions": {"busk": __version__},
    }


def _difference(difference: Residuals) -> dict[str, Any]:
    every = {"all": difference.total, **difference.sides}
    values: dict[str, Any] = {
        name: {
            "mean_mm": _plain_number(each.mean),
            "rms_mm": _plain_number(each.rms),
            "at_95_percent_mm": _plain_number(each.most),
            "shown": each.seen,
        }
        for name, each in every.items()
    }
    values["bust_points_mm"] = {side: way.tolist() for side, way in difference.bust_points.items()}
    values["bust_points_plus_minus_mm"] = dict(difference.bust_unsure)
    return values


def _plain_number(value: float) -> float | None:
    return value if np.isfinite(value) else None
