"""Write the report of a design as PDF, JSON and one long table, without a display."""

from __future__ import annotations

import datetime
import logging
import os
from argparse import ArgumentParser, Namespace
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.design import design_of
from app.cli.options import add_lines, add_scan
from app.cli.output import finish
from app.cli.solved_design import SolvedDesign, solve_design
from app.presenters.pattern_files import pattern_or_reason
from app.rendering.display import off_screen
from core.analysis.uncertainty.estimate import estimate_uncertainty
from core.document.design import Design
from core.document.storage.project_file import is_project, open_project
from core.errors import ProjectError, UserError
from core.export.csv_cells import ENCODING
from core.export.report_data import Heading, Report, make_report, with_uncertainty
from core.export.report_data_file import report_csv, report_json
from core.files.atomic_write import write_text
from core.measurements.sizes import sizes
from core.messages import Message
from core.pipeline.solve import Solution
from core.progress import in_one_go

if TYPE_CHECKING:
    from PySide6.QtGui import QImage

_NO_PICTURES = "The pictures of the body could not be rendered: the report contains curves only."


@dataclass(frozen=True)
class ReportOptions:
    """The files to write: ``out`` is the PDF, in a ``language``; ``json`` and ``csv`` may be empty.

    Lengths of the PDF are in ``length_unit``, those of data in mm. ``customer`` and ``allowance`` [mm] are
    None for those of the project; ``system`` of sizes is listed first. ``uncertainty`` adds ±.
    """

    out: str
    json: str = ""
    csv: str = ""
    language: str = "en"
    length_unit: str = "mm"
    customer: str | None = None
    system: str = "jp"
    allowance: float | None = None
    uncertainty: bool = False


def add_options(parser: ArgumentParser) -> None:
    """Add the options of ``busk report``."""
    add_scan(parser)
    add_lines(parser)
    parser.add_argument("--out", required=True, metavar="FILE", help="output report (.pdf)")
    parser.add_argument("--json", default="", metavar="FILE", help="output data (.json)")
    parser.add_argument("--csv", default="", metavar="FILE", help="output table of all values (.csv)")
    parser.add_argument("--language", choices=("en", "ja"), default="en", help="language of the report")
    unit = "unit of lengths in the report, cut lengths to 1/16 in; --json and --csv use mm"
    parser.add_argument("--length-unit", choices=("mm", "cm", "in"), default="mm", help=unit)
    customer = "customer name or number (default: as in the project)"
    parser.add_argument("--customer", metavar="TEXT", help=customer)
    system = "size system listed first: jp, eu, uk, us, fr, it, au"
    parser.add_argument("--system", default="jp", metavar="KEY", help=system)
    allowance = (
        "tape tension allowance, subtracted from the under-bust girth: 0 to 20 mm, an estimate "
        "(default: as in the project)"
    )
    parser.add_argument("--allowance", type=float, metavar="MM", help=allowance)
    uncertainty = "add the uncertainty (±) of values and curves; takes half a minute"
    parser.add_argument("--uncertainty", action="store_true", help=uncertainty)


def run(options: Namespace) -> int:
    """Write the report, and print the verdict and the names of the files."""
    how = ReportOptions(**{name: getattr(options, name) for name in ReportOptions.__dataclass_fields__})
    solved, warnings = write_report(
        options.input, design_of(options), options.line or [], options.elastic or [], how
    )
    files = ", ".join(filter(None, (how.out, how.json, how.csv)))
    return finish("\n".join([*solved.verdict, f"written to {files}"]), solved.converged, warnings)


def write_report(
    source: str, design: Design, lines: Sequence[str], elastics: Sequence[str], how: ReportOptions
) -> tuple[SolvedDesign, list[str]]:
    """Solve a design with ``lines``, NAME=LENGTH, and ``elastics``, LINE=ELASTIC, and write its report.

    Returns the solved design and the warnings. Each file is complete or not written. Raises UserError,
    before anything is solved if a name is not valid.
    """
    _check(how)
    if how.customer is not None:
        design = replace(design, customer=how.customer)
    solved = solve_design(design, lines, elastics, bare=True)
    sheet, faults = write_report_of(solved.solution, _heading(source, design, how), how)
    return solved, [*dict.fromkeys(map(str, (*solved.warnings, *sheet.doubts, *sheet.warnings))), *faults]


def write_report_of(solution: Solution, heading: Heading, how: ReportOptions) -> tuple[Report, list[str]]:
    """Write the report of a solution, and return it with the faults of its PDF. Raises UserError."""
    sheet = make_report(solution, solution.records, heading)
    if how.uncertainty:
        sheet = with_uncertainty(
            sheet, solution.stages, solution.control_points, estimate_uncertainty(solution.stages)
        )
    for name, text, code in ((how.json, report_json, "utf-8"), (how.csv, report_csv, ENCODING)):
        if name:
            write_text(Path(name), text(sheet), code)
    return sheet, _write(solution, sheet, how)


def _check(how: ReportOptions) -> None:
    """Raise UserError if an option is not valid."""
    for name, ending in ((how.out, ".pdf"), (how.json, ".json"), (how.csv, ".csv")):
        if name and Path(name).suffix.lower() != ending:
            raise UserError(
                Message("'{name}' does not have the required ending.", name=name),
                Message("Choose a name ending in {ending}.", ending=ending),
            )
        if name and not Path(name).parent.is_dir():
            raise UserError(
                Message("Folder {parent} does not exist.", parent=Path(name).parent),
                Message("Create the folder, or choose another one."),
            )
    if not how.out:
        raise UserError(
            Message("The output folder has no name."), Message("Specify a file: --out report.pdf.")
        )
    known = sizes(750.0, 900.0, how.allowance or 0.0)
    if how.system not in known:
        raise UserError(
            Message("Unknown size system '{system}'.", system=how.system),
            Message("Choose one of: {choices}.", choices=", ".join(known)),
        )


def _heading(source: str, design: Design, how: ReportOptions) -> Heading:
    document = open_project(source) if is_project(source) else None
    return Heading(
        project=Path(source).stem,
        date=datetime.date.today().isoformat(),
        customer=design.customer,
        variant=document.shown if document is not None and len(document.designs) > 1 else "",
        system=how.system,
        allowance_mm=design.worn_tight_mm if how.allowance is None else how.allowance,
    )


def _write(solution: Solution, sheet: Report, how: ReportOptions) -> list[str]:
    """Write the PDF, and return its faults."""
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")  # a report needs no screen
    off_screen()
    from app.gui.application import application  # noqa: PLC0415 (brings Qt along)
    from app.presenters.lines import line_colours  # noqa: PLC0415
    from app.report.document import ReportDocument  # noqa: PLC0415
    from app.report.pages import pages_of  # noqa: PLC0415
    from app.report.pdf_file import write_pdf  # noqa: PLC0415

    application(unit=how.length_unit)
    names = [line.name for line in solution.stages.drawn_lines]
    pattern = pattern_or_reason(solution.stages, solution.body.vertices)
    handout = ReportDocument(sheet, {}, line_colours(names, solution.stages.design), pattern)
    title = " ".join(filter(None, (sheet.heading.customer, sheet.heading.project)))
    fresh = not Path(how.out).exists()
    if fresh:
        # Faulty graphics may end the program: by then the report without pictures is written. An existing
        # report stays until the new one is complete.
        write_pdf(how.out, pages_of(handout, how.language), title)
    pictures = _pictures(solution)
    try:
        if pictures or not fresh:
            write_pdf(how.out, pages_of(replace(handout, pictures=pictures), how.language), title)
    except ProjectError as problem:
        if not fresh:
            raise
        return [f"The report contains curves without pictures of the body: {problem.message}"]
    return [] if pictures else [_NO_PICTURES]


def _pictures(solution: Solution) -> Mapping[str, QImage]:
    """Return the pictures of a report, or none where they cannot be rendered."""
    try:
        from app.rendering.ambient_occlusion import bake_occlusion  # noqa: PLC0415
        from app.report.images import render_images  # noqa: PLC0415 (brings VTK along)

        return in_one_go(render_images(solution, bake_occlusion(solution.stages.body.mesh)))
    except Exception:
        logging.exception("no pictures for the report")
        return {}
