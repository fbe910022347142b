"""Compare the model with stored displacements of an independent finite-element model."""

from __future__ import annotations

import json
from argparse import ArgumentParser, Namespace
from collections.abc import Iterator, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

from app.cli.design import settings_of
from app.cli.options import add_forms, add_model_settings
from app.cli.output import finish, table_lines
from core import __version__
from core.analysis.model_check.compare import (
    DISC_MM,
    RISE_LIMIT,
    RISE_LIMIT_MM,
    CaseComparison,
    Rise,
    check_model,
)
from core.analysis.model_check.reference_case import case_file, included_cases, read_case
from core.document.design import Design, ScanSource
from core.document.lower_trunk import LOWER_SETTINGS
from core.errors import UserError
from core.messages import Message, plain

STORED = ("template", "line_height")
"""Settings that a case determines by its control mesh."""

_HEADING = (
    *("case", "kind", "error mm", "reference mm", "error %", "limit %"),
    *("rise L / reference mm", "rise R / reference mm", "max mm", "at x, y, z", "result"),
)


def add_options(parser: ArgumentParser) -> None:
    """Add the options of ``busk check-model``."""
    case = "a reference case: a name or a file (.npz); may be repeated (default: all that come with Busk)"
    parser.add_argument("--case", action="append", metavar="NAME_OR_FILE", help=case)
    bodies = "folder of the bodies that are neither beside their case nor a sample"
    parser.add_argument("--bodies", metavar="FOLDER", help=bodies)
    add_model_settings(parser)
    add_forms(parser)


def run(options: Namespace) -> int:
    """Print the comparison; the exit code is 3 if a limit is exceeded. Raises UserError."""
    design = _design_of(options.settings or [])
    files = [case_file(name) for name in options.case or included_cases()]
    if not files:
        raise UserError(
            Message("No reference cases are installed."),
            Message("Specify a file: --case case.npz --bodies FOLDER."),
        )
    cases = [read_case(file) for file in files]
    found = list(check_model(cases, design, Path(options.bodies) if options.bodies else None))
    text = json.dumps(_data(found, design), indent=1) if options.json else "\n".join(_text(found, design))
    return finish(text, all(each.passed for each in found))


def _design_of(pairs: Sequence[str]) -> Design:
    settings = settings_of(pairs)
    for key in STORED:
        if key in settings:
            raise UserError(
                Message("The setting {key} cannot be changed: each case contains its control mesh.", key=key),
                Message("Remove {key} from the settings.", key=key),
            )
    for key in LOWER_SETTINGS:
        if key in settings:
            raise UserError(
                Message("The setting {key} cannot be changed: the cases contain the bust alone.", key=key),
                Message("Remove {key} from the settings.", key=key),
            )
    return replace(Design(ScanSource(""), tissue="solid"), **settings)


def _text(found: Sequence[CaseComparison], design: Design) -> Iterator[str]:
    heading, *rows = table_lines([_HEADING, *map(_cells, found)])
    yield heading
    for row, each in zip(rows, found, strict=True):
        yield row
        yield from (f"  {note}" for note in each.notes)
    passed = sum(each.passed for each in found)
    yield from ("", f"{passed} of {len(found)} cases within the limits.", "")
    yield "Error: rms of the difference of all nodes, in % of the rms of the reference."
    yield (
        f"Rise: mean of the nodes within {DISC_MM:g} mm of a bust point, L: left, R: right; "
        f"limit {RISE_LIMIT_MM:g} mm or {100 * RISE_LIMIT:g} %."
    )
    if design.tissue == "solid":
        yield "Tissue and lines: shear modulus, gravity and newtons of the reference."
    else:
        yield (
            f"Lines: stiffness {design.line_stiffness:g} times that of the skin at a point, not the newtons "
            "of the reference."
        )


def _cells(each: CaseComparison) -> tuple[str, ...]:
    rises = (f"{rise.model:+z.2f} / {rise.reference:+z.2f}" for rise in (each.left, each.right))
    return (
        each.case,
        each.kind,
        f"{each.rms_mm:.2f}",
        f"{each.reference_rms_mm:.2f}",
        f"{100 * each.ratio:.1f}",
        f"{100 * each.limit:.0f}",
        *rises,
        f"{each.largest_mm:.1f}",
        ", ".join(f"{value:.0f}" for value in each.largest_at),
        "passed" if each.passed else "failed",
    )


def _data(found: Sequence[CaseComparison], design: Design) -> dict[str, Any]:
    return {
        "cases": [_case_data(each) for each in found],
        "line_stiffness": design.line_stiffness,
        "definition": (
            "rms_mm: rms of the difference over all compared nodes; ratio: rms_mm / reference_rms_mm; "
            f"bust_up_mm: mean rise of the nodes within {DISC_MM:g} mm of a bust point, mean of both sides"
        ),
        "versions": {"busk": __version__},
    }


def _case_data(each: CaseComparison) -> dict[str, Any]:
    return {
        "case": each.case,
        "kind": each.kind,
        "rms_mm": each.rms_mm,
        "reference_rms_mm": each.reference_rms_mm,
        "ratio": each.ratio,
        "limit": each.limit,
        "bust_up_mm": (each.left.model + each.right.model) / 2.0,
        "reference_bust_up_mm": (each.left.reference + each.right.reference) / 2.0,
        **{side: _rise_data(rise) for side, rise in (("left", each.left), ("right", each.right))},
        "largest_mm": each.largest_mm,
        "largest_at_mm": list(each.largest_at),
        "compared_nodes": each.compared,
        "left_out_nodes": each.left_out,
        "notes": plain(each.notes),
        "passed": each.passed,
    }


def _rise_data(rise: Rise) -> dict[str, Any]:
    return {**{f"{key}_up_mm": mm for key, mm in asdict(rise).items()}, "passed": rise.passed}
