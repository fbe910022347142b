"""The process of a run that computes bodies: ``app.batch.body_process``, with the reports of the commands."""

from __future__ import annotations

import datetime
from pathlib import Path

from app.batch.body_files import WRITERS
from app.batch.body_process import serve
from app.cli.commands.report import ReportOptions, write_report_of
from core.export.report_data import Heading
from core.pipeline.solve import Solution


def write_report_file(solution: Solution, path: Path, language: str) -> None:
    """Write the report of a body, named after its file. Raises UserError."""
    design, how = solution.stages.design, ReportOptions(str(path), language=language)
    heading = Heading(
        project=Path(design.scan.path).stem,
        date=datetime.date.today().isoformat(),
        customer=design.customer,
        variant="",
        system=how.system,
        allowance_mm=design.worn_tight_mm,
    )
    write_report_of(solution, heading, how)


if __name__ == "__main__":
    serve({**WRITERS, "report": write_report_file})
