"""What ``busk calibrate`` does: a design is compared with a scan of the garment as worn, and fitted."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from app.cli.options import dressed, made_of
from core import __version__
from core.analysis.calibration.api import (
    THICKEST,
    CalibrationResult,
    Difference,
    Figures,
    Worn,
    calibrate,
    read_worn,
    refuse_bare,
)
from core.document.calibration_record import WELL, FoundNumber
from core.document.design import Design, ScanSource
from core.document.document import Document
from core.document.storage.backups import backed_up
from core.document.storage.project_file import SUFFIX, is_project, open_project, save_project
from core.errors import UserError
from core.pipeline.build import Stages, build

WAYS = ("to the left", "to the back", "up")
"""Where x, y and z point, as designers say it."""


@dataclass(frozen=True)
class WornScan:
    """What is told of the second scan; ``thickness`` [mm] is that of the cloth, ``out`` a project or empty.

    ``lengths`` tells that lines may have been cut to other lengths than designed, ``one_roll`` that they are
    of one roll.
    """

    source: ScanSource
    thickness: float = 0.0
    lengths: bool = False
    one_roll: bool = False
    out: str = ""


@dataclass(frozen=True, eq=False)
class Calibrated:
    """What was found with a ``worn`` scan; ``out`` is where it was saved."""

    stages: Stages
    worn: Worn
    found: CalibrationResult
    out: str


def run_calibrate(
    source: str, design: Design, lengths: Sequence[str], elastics: Sequence[str], told: WornScan
) -> Calibrated:
    """Calibrate a design with ``lengths``, NAME=LENGTH, and ``elastics``, LINE=ELASTIC, on a worn scan.

    ``source`` is the file that it came from. Raises UserError.
    """
    if told.out and not is_project(told.out):
        raise UserError(
            f"{told.out} is not a project file name.", f"Specify a project file: --out design{SUFFIX}."
        )
    if not 0.0 <= told.thickness <= THICKEST:
        raise UserError(
            f"The fabric thickness {told.thickness:g} mm is out of range.",
            f"Enter a thickness from 0 to {THICKEST:g} mm.",
        )
    stages = build(design)
    stages = build(made_of(dressed(design, stages.model.lines, lengths), elastics), stages)
    refuse_bare(stages)  # before half a minute is spent on reading
    worn = read_worn(stages, told.source)
    thickness, lengths_too = told.thickness, told.lengths
    found = calibrate(stages, worn, thickness=thickness, lengths=lengths_too, one_roll=told.one_roll)
    if told.out:
        taken = found.design if found.helped else stages.design  # as in the window
        document = open_project(source) if is_project(source) else Document.of(taken)
        with backed_up(Path(told.out)):
            save_project(told.out, document.with_design(taken), stages.scan, None)
    return Calibrated(stages, worn, found, told.out)


def calibrated_text(done: Calibrated, as_json: bool) -> str:
    """Return what is to be printed: sentences for people, or the same figures as JSON."""
    return json.dumps(_figures(done), indent=1) if as_json else "\n".join(_plain(done))


def _plain(done: Calibrated) -> Iterator[str]:
    found, laid, design = done.found, done.worn.alignment, done.stages.design
    turn, shift = 2.0 * float(laid.turns.max()), 2.0 * float(laid.shifts.max())
    yield (
        f"{done.worn.name} was registered to the first scan: {100.0 * laid.met:.0f} % of the "
        f"unaffected skin within 5 mm, {laid.rms:.2f} mm RMS, {laid.most:.2f} mm at 95 %; "
        f"uncertainty ±{turn:.2f} degrees and ±{shift:.2f} mm."
    )
    yield ""
    yield f"{'residual [mm]':28}{'mean':>8}{'rms':>8}{'95 %':>8}{'shown':>8}"
    for when, difference in (("before", found.before), ("after", found.after)):
        yield _row(when, difference.all_of_it)
        for side, figures in difference.sides.items():
            yield _row(f"  {side}", figures)
    yield ""
    yield from _bust_points(done)
    yield f"{'number':28}{'before':>10}{'after':>10}{'±':>9}"
    for number in found.calibration.numbers:
        if not number.kept:
            yield (
                f"{spoken(number.name, design):28}{_value(number, number.before):>10}"
                f"{_value(number, number.after):>10}{_value(number, number.plus_minus):>9}"
                f"{'' if number.told else '   told weakly'}"
            )
    yield from _plain_outcome(done)


def _plain_outcome(done: Calibrated) -> Iterator[str]:
    """Yield what the numbers are worth, and what became of them."""
    found, design = done.found, done.stages.design
    yield told(found)
    for number in found.calibration.numbers:
        if number.kept:
            yield stays(number, found.confused.get(number.name, ""), design)
    yield "± covers 95 % of the scan noise; differences in posture or breathing are not included."
    yield "The values apply to this person and this garment."
    for name in found.at_end:
        yield (
            f"{spoken(name, design)} reached the limit. Check that this is the fitting scan and that "
            "the lines match the garment."
        )
    if not found.helped and not found.at_end:
        yield (
            "Calibration did not improve the prediction: no parameter changed by more than its ±, or "
            "the residual did not decrease."
        )
    if found.helped and found.explains_little:
        yield "Most of the residual remains: posture, breathing or fabric may have affected these values."
    if found.helped and found.weak:
        yield "No parameter is well determined. Treat the values as indicative."
    if done.out:
        yield f"written to {done.out}{'' if found.helped else ', as it was'}"


def told(found: CalibrationResult) -> str:
    """Return how many of the numbers that were found are told well."""
    sought = [number for number in found.calibration.numbers if not number.kept]
    well = sum(number.told for number in sought)
    more = "; a finer scan improves this" if well < len(sought) else ""
    return (
        f"{well} of {len(sought)} parameters determined within {100.0 * WELL:.0f} %, from "
        f"{found.met:,} points on the reshaped skin{more}."
    )


def _row(name: str, figures: Figures) -> str:
    parts = "".join(f"{value:8.2f}" for value in (figures.mean, figures.rms, figures.most))
    return f"{name:28}{parts}{100.0 * figures.seen:6.0f} %"


def _bust_points(done: Calibrated) -> Iterator[str]:
    told = done.found.before.bust_points, done.found.after.bust_points
    for side, before in told[0].items():
        sure = 100.0 * done.worn.sure[side]
        yield (
            f"bust point, {side} ({sure:.0f} % confidence on the fitting scan): residual, "
            f"±{done.found.before.bust_unsure[side]:.1f} mm along the skin"
        )
        for when, way in (("before", before), ("after", told[1][side])):
            parts = ", ".join(f"{value:+.1f} mm {where}" for value, where in zip(way, WAYS, strict=True))
            yield f"  {when:8}{parts}"
    if not told[0]:
        yield "No bust point detected reliably on the fitting scan: not compared."
    yield ""


def spoken(name: str, design: Design) -> str:
    """Return what a number is called in plain words; one that linked lines share is of both."""
    line = name.partition(" of ")[2]
    if line and len(design.linked(line)) > 1:
        return name.rpartition(" ")[0] + ", both"
    return {"tissue_stiffness": "tissue [N/m]"}.get(name, name.replace("_", " "))


def _value(number: FoundNumber, value: float) -> str:
    if number.name.startswith("length of"):
        return f"{100.0 * value:.2f} %"
    return f"{value:.0f}" if number.name == "tissue_stiffness" else f"{value:.3g}"


def stays(number: FoundNumber, other: str, design: Design) -> str:
    """Return why a number stays as it is."""
    why = (
        f"these scans do not separate it from {spoken(other, design)}"
        if other
        else "these scans do not determine it"
    )
    return f"{spoken(number.name, design)} remains {_value(number, number.before)}: {why}."


def _figures(done: Calibrated) -> dict[str, Any]:
    found, laid = done.found, done.worn.alignment
    return {
        "worn": done.worn.name,
        "alignment": {
            "matrix": laid.matrix.tolist(),
            "rms_mm": laid.rms,
            "at_95_percent_mm": laid.most,
            "met": laid.met,
            "shown": laid.seen,
            "unsure_degrees": laid.turns.tolist(),
            "unsure_mm": laid.shifts.tolist(),
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
                "told": number.told,
                "cannot_be_told_from": found.confused.get(number.name) or None,
            }
            for number in found.calibration.numbers
        ],
        "points": found.met,
        "singular_values": list(found.singular),
        "thickness_mm": found.calibration.thickness,
        "helped": found.helped,
        "at_end": list(found.at_end),
        "explains_little": found.explains_little,
        "weak": found.weak,
        "written_to": done.out or None,
        "versions": {"busk": __version__},
    }


def _difference(difference: Difference) -> dict[str, Any]:
    every = {"all": difference.all_of_it, **difference.sides}
    told: dict[str, Any] = {
        name: {
            "mean_mm": _plain_number(each.mean),
            "rms_mm": _plain_number(each.rms),
            "at_95_percent_mm": _plain_number(each.most),
            "shown": each.seen,
        }
        for name, each in every.items()
    }
    told["bust_points_mm"] = {side: way.tolist() for side, way in difference.bust_points.items()}
    told["bust_points_plus_minus_mm"] = dict(difference.bust_unsure)
    return told


def _plain_number(value: float) -> float | None:
    return value if np.isfinite(value) else None
