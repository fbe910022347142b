"""Export the body, its lines, pattern strips, measurements or a turntable for other programs."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from collections.abc import Mapping
from pathlib import Path

from app.cli.design import design_of
from app.cli.options import add_lines, picture_size
from app.cli.output import finish
from app.cli.solved_design import is_converged
from app.presenters.assessment import assessment_lines
from app.presenters.export import ExportOptions, ExportSource, exports
from app.presenters.export_preview import check, prepare_export
from app.presenters.scan import KINDS as SCANS
from core.errors import UserError, reason_of
from core.garment.assessment import assess
from core.garment.line_requests import with_lines_and_elastics
from core.messages import Message
from core.pipeline.build import build
from core.pipeline.solve import solve_valid
from core.pipeline.warnings import shape_warnings
from core.progress import in_one_go, quiet

KINDS = {
    "body": ("body", "output reshaped body ({endings})"),
    "control": ("control-mesh", "output control mesh ({endings})"),
    "lines": ("lines", "output active lines on the body ({endings})"),
    "flat": ("strips", "output active lines as flat pattern strips at full scale ({endings})"),
    "measures": ("measurements", "output measurements ({endings})"),
    "turntable": ("turntable", "output turntable (.gif, .webp, or .png for a series)"),
}
"""Kinds of files in order, each with its option and help; the formats are those of ``exports``."""


def add_options(parser: ArgumentParser) -> None:
    """Add the options of ``busk export``."""
    project = f"a project (.busk), or a scan ({SCANS}) with --line"
    parser.add_argument("input", metavar="PROJECT", help=project)
    formats = {each.what: ", ".join(f".{ending}" for ending in each.formats) for each in exports()}
    for kind, (option, output) in KINDS.items():
        text = output.format(endings=formats[kind])
        parser.add_argument(f"--{option}", dest=kind, default="", metavar="FILE", help=text)
    unit = "mm, cm, m or in (default: m in .glb, cm in measurements, otherwise mm)"
    parser.add_argument("--unit", dest="file_unit", metavar="UNIT", help=unit)
    axes = "z-up (front -y), y-up (front z) or z-up-front-y (front y); default: y-up in .glb, otherwise z-up"
    parser.add_argument("--axes", help=axes)
    original = "export the original body in place of the reshaped one; strips do not change"
    parser.add_argument("--original", dest="before", action="store_true", help=original)
    frames = "number of turntable frames"
    parser.add_argument("--frames", type=int, default=36, metavar="N", help=frames)
    seconds = "duration of one rotation in seconds"
    parser.add_argument("--seconds", type=float, default=6.0, metavar="S", help=seconds)
    size = "size of the turntable in pixels"
    parser.add_argument("--size", type=picture_size, default=(640, 720), metavar="WIDTHxHEIGHT", help=size)
    parser.add_argument("--dark", action="store_true", help="render the turntable in the dark theme")
    both = "show before and after side by side in the turntable"
    parser.add_argument("--side-by-side", dest="beside", action="store_true", help=both)
    add_lines(parser)


def run(options: Namespace) -> int:
    """Solve the design and write the files: each is complete or not written. Raises UserError.

    Names that are not valid are refused before anything is solved.
    """
    named = ("axes", "before", "frames", "seconds", "size", "dark", "beside")
    manner = ExportOptions(options.file_unit, **{name: getattr(options, name) for name in named})
    files = {kind: getattr(options, kind) for kind in KINDS if getattr(options, kind)}
    _check(files, manner)
    stages = with_lines_and_elastics(build(design_of(options)), options.line or [], options.elastic or [])
    solution = solve_valid(stages)
    lower = None if solution.lower is None else solution.lower.control_points
    outcome = ExportSource(solution.stages, solution.control_points, solution.records, lower_points=lower)
    for kind, name in files.items():
        print(_write(kind, name, outcome, manner))
    text = "\n".join(assessment_lines(assess(solution), solution.stages.design))
    return finish(text, is_converged(solution), shape_warnings(solution))


def _check(files: Mapping[str, str], manner: ExportOptions) -> None:
    """Raise UserError if a file cannot be written."""
    if not files:
        raise UserError(
            Message("No output specified."), Message("Specify a file, for example --body anna.glb.")
        )
    names = list(files.values())
    twice = [name for name in names if names.count(name) > 1]
    if twice:
        raise UserError(
            Message("{value} is specified for two outputs.", value=twice[0]),
            Message("Use a different file for each output."),
        )
    for kind, name in files.items():
        check(kind, name, manner)


def _write(kind: str, name: str, outcome: ExportSource, manner: ExportOptions) -> str:
    """Write a file, and return its name with its contents."""
    ready = prepare_export(kind, name, outcome, manner)
    target = Path(name)
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
    except OSError as why:
        raise UserError(
            Message("{file} cannot be written: {problem}.", file=name, problem=reason_of(why)),
            Message("Choose another folder."),
        ) from why
    drawn = in_one_go(ready.draw()) if ready.draw else None
    written = ready.write(target, drawn, quiet) or [target]
    place = name if len(written) == 1 else f"{written[0].name} to {written[-1].name}"
    return f"{place}: {ready.contents}" + (f", {ready.how}" if ready.how else "")
