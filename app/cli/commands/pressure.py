"""What worn lines press with, as the command line prints and writes it."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, fields

from app.cli.output import csv_text, told
from app.cli.solve_design import Worn, run_worn
from app.presenters.pressure import total_words
from core import __version__
from core.document.design import Design
from core.garment.pressure import LEFT_OUT
from core.garment.pressure_limits import AMBER, GREEN, RED, comfort
from core.garment.pressure_list import PressList, PressRow, press_list

COLUMNS = tuple(field.name for field in fields(PressRow))


@dataclass(frozen=True)
class Press:
    """What lines press with, and the solved design that it is of."""

    listed: PressList
    worn: Worn


def run_press(design: Design, lines: Sequence[str], elastics: Sequence[str]) -> Press:
    """Solve a design with lines and elastics as requested, and list what presses. Raises UserError."""
    worn = run_worn(design, lines, elastics)
    listed = press_list(worn.solution.stages, worn.solution.control_points)
    return Press(listed, worn)


def press_text(found: Press, kind: str, out: str | None) -> str:
    """Return what to print, or write it to a file ``out``; see ``told``. Raises UserError."""
    return told(_FORMS, found, kind, out)


def _plain(found: Press) -> str:
    heading = (
        f"{'':18}{'mean kPa':>9}{'mmHg':>6}{'max kPa':>9}{'mmHg':>6}  "
        f"{'rating':6}{'force N':>8}{'bridged mm':>11}  location of maximum"
    )
    rows = [line for row in found.listed.rows for line in _lines(row)]
    left_out = [f"  {sentence}" for sentence in LEFT_OUT]
    return "\n".join(
        [
            *found.worn.verdict,
            *found.worn.effect,
            "",
            heading,
            *rows,
            "",
            f"{total_words(found.listed)}.",
            *_limits(),
            "",
            "Not included in the values:",
            *left_out,
        ]
    )


def _lines(row: PressRow) -> list[str]:
    figures = (
        *((row.mean_kpa, 9, 2), (row.mean_mmhg, 6, 1), (row.max_kpa, 9, 2), (row.max_mmhg, 6, 1)),
        *((row.force_n, 8, 1), (row.bridged_mm, 11, 0)),
    )
    told = [_figure(*each) for each in figures]
    told.insert(4, f"  {row.light or '-':6}")
    where = f"{row.where}, {row.height_mm:.0f} mm above the lowest point" if row.where else ""
    return [f"{row.title[:17]:18}{''.join(told)}  {where}".rstrip(), *(f"  {note}" for note in row.notes)]


def _limits() -> list[str]:
    limits = comfort()
    amber, red = f"{limits.amber_kpa:g}", f"{limits.red_kpa:g}"
    begins = {GREEN: f"below {amber}", AMBER: f"from {amber}", RED: f"from {red}"}
    lights = [f"  {name}, {begins[name]} kPa: {words.en}" for name, words in limits.lights.items()]
    beyond = [f"  from {kpa:g} kPa: {words.en}" for kpa, words in limits.beyond]
    doubts = [f"  {words.en}" for words in limits.doubts]
    sources = [f"  {each.name}: {each.words.en}" for each in limits.sources]
    heading = "The rating uses the maximum contact pressure:"
    return ["", heading, *lights, *beyond, *doubts, "  Between these values:", *sources]


def _figure(value: float | None, wide: int, digits: int) -> str:
    return "-".rjust(wide) if value is None else f"{value:{wide}.{digits}f}"


def _as_json(found: Press) -> str:
    whole = {**found.listed.as_data(), "assessment": found.worn.assessment.as_data()}
    whole |= {"warnings": found.worn.warnings, "versions": {"busk": __version__}}
    return json.dumps(whole, indent=1, ensure_ascii=False)


def _as_csv(found: Press) -> str:
    return csv_text(COLUMNS, found.listed.rows)


_FORMS = {"": _plain, "json": _as_json, "csv": _as_csv}
