"""The sheet to work from as the command line writes it: PDF, JSON and one long table, with no display."""

from __future__ import annotations

import datetime
import logging
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.solve_design import run_worn
from app.rendering.display import off_screen
from core.analysis.uncertainty.estimate import spread_of
from core.document.design import Design
from core.document.storage.project_file import is_project, open_project
from core.errors import ProjectError, UserError
from core.export.csv_cells import ENCODING
from core.export.report_data import Heading, Sheet, sheet_of, with_spread
from core.export.report_data_file import sheet_csv, sheet_json
from core.files.atomic_write import write_text
from core.measurements.sizes import sizes
from core.pipeline.solve import Solution
from core.progress import in_one_go

if TYPE_CHECKING:
    from PySide6.QtGui import QImage

_NO_PICTURES = "The pictures of the body could not be rendered: the report contains curves only."


@dataclass(frozen=True)
class SheetWishes:
    """Where to write: ``out`` the PDF, in a ``language``, ``json`` and ``csv`` if they are named.

    Lengths of the PDF are in ``length_unit``, those of data in mm.
    ``customer`` and ``allowance`` [mm] are None where those of the project hold; ``system`` of sizes comes
    first. ``spread`` puts ± beside figures, which takes a while.
    """

    out: str
    json: str = ""
    csv: str = ""
    language: str = "en"
    length_unit: str = "mm"
    customer: str | None = None
    system: str = "jp"
    allowance: float | None = None
    spread: bool = False


@dataclass(frozen=True)
class Reported:
    """What came of it: whether the design settled, the files, what to say, and the overall verdict."""

    settled: bool
    files: list[str]
    warnings: list[str]
    verdict: list[str]


def run_report(
    source: str, design: Design, lengths: Sequence[str], elastics: Sequence[str], wishes: SheetWishes
) -> Reported:
    """Solve a design with ``lengths``, NAME=LENGTH, and ``elastics``, LINE=ELASTIC, and write its sheet.

    Each file is whole or not there. Raises UserError, before anything is solved if a name cannot be.
    """
    _check(wishes)
    if wishes.customer is not None:
        design = replace(design, customer=wishes.customer)
    worn = run_worn(design, lengths, elastics, bare=True)
    solution = worn.solution
    sheet = sheet_of(solution, solution.records, _heading(source, design, wishes))
    if wishes.spread:
        sheet = with_spread(sheet, solution.stages, solution.control_points, spread_of(solution.stages))
    for name, text, code in ((wishes.json, sheet_json, "utf-8"), (wishes.csv, sheet_csv, ENCODING)):
        if name:
            write_text(Path(name), text(sheet), code)
    said = _write(solution, sheet, wishes)
    files = [name for name in (wishes.out, wishes.json, wishes.csv) if name]
    warnings = [*dict.fromkeys((*worn.warnings, *sheet.doubts, *sheet.warnings)), *said]
    return Reported(worn.settled, files, warnings, worn.verdict)


def _check(wishes: SheetWishes) -> None:
    """Raise UserError if something is wished that cannot be."""
    for name, ending in ((wishes.out, ".pdf"), (wishes.json, ".json"), (wishes.csv, ".csv")):
        if name and Path(name).suffix.lower() != ending:
            raise UserError(
                f"'{name}' does not have the required ending.", f"Choose a name ending in {ending}."
            )
        if name and not Path(name).parent.is_dir():
            raise UserError(f"Folder {Path(name).parent} does not exist.", "Make it, or choose another one.")
    if not wishes.out:
        raise UserError("The output folder has no name.", "Specify a file: --out report.pdf.")
    known = sizes(750.0, 900.0, wishes.allowance or 0.0)
    if wishes.system not in known:
        raise UserError(f"Unknown size system '{wishes.system}'.", f"Choose one of: {', '.join(known)}.")


def _heading(source: str, design: Design, wishes: SheetWishes) -> Heading:
    document = open_project(source) if is_project(source) else None
    return Heading(
        project=Path(source).stem,
        date=datetime.date.today().isoformat(),
        customer=design.customer,
        variant=document.shown if document is not None and len(document.designs) > 1 else "",
        system=wishes.system,
        allowance_mm=design.worn_tight_mm if wishes.allowance is None else wishes.allowance,
    )


def _write(solution: Solution, sheet: Sheet, wishes: SheetWishes) -> list[str]:
    """Write the PDF, and return what is to be said of it."""
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")  # a sheet needs no screen, even if there is one
    off_screen()
    from app.gui.application import application  # noqa: PLC0415 (brings Qt along)
    from app.presenters.lines import line_colours  # noqa: PLC0415
    from app.report.document import Handout  # noqa: PLC0415
    from app.report.pages import pages_of  # noqa: PLC0415
    from app.report.pdf import write_pdf  # noqa: PLC0415

    application(unit=wishes.length_unit)
    names = [line.name for line in solution.stages.model.lines]
    handout = Handout(sheet, {}, line_colours(names, solution.stages.design))
    title = " ".join(filter(None, (sheet.heading.customer, sheet.heading.project)))
    fresh = not Path(wishes.out).exists()
    if fresh:
        # Graphics that do not work may end the program: the sheet without pictures is there by then. A sheet
        # that was there before stays until the new one is whole.
        write_pdf(wishes.out, pages_of(handout, wishes.language), title)
    pictures = _pictures(solution)
    try:
        if pictures or not fresh:
            write_pdf(wishes.out, pages_of(replace(handout, pictures=pictures), wishes.language), title)
    except ProjectError as problem:
        if not fresh:
            raise
        return [f"The report contains curves without pictures of the body: {problem.message}"]
    return [] if pictures else [_NO_PICTURES]


def _pictures(solution: Solution) -> Mapping[str, QImage]:
    """Return the pictures of a sheet, or none where they cannot be drawn."""
    try:
        from app.rendering.ambient_occlusion import bake_occlusion  # noqa: PLC0415
        from app.report.images import shots  # noqa: PLC0415 (brings VTK along)

        return in_one_go(shots(solution, bake_occlusion(solution.stages.body.mesh)))
    except Exception:
        logging.exception("no pictures for the report")
        return {}
