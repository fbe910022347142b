"""What the command line writes for other programs: bodies, lines, strips, measures and turntables."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from app.cli.options import dressed, made_of
from app.cli.solve_design import run_to_body
from app.presenters.assessment import assessment_lines
from app.presenters.export import Manner, Outcome
from app.presenters.export_preview import check, make_ready
from core.document.design import Design
from core.errors import UserError
from core.garment.assessment import assessed
from core.pipeline.build import build
from core.pipeline.warnings import shape_warnings
from core.progress import in_one_go, quiet

KINDS = ("body", "control", "lines", "flat", "measures", "turntable")
"""What can be written by command, in order."""


@dataclass(frozen=True)
class Exported:
    """What was exported: whether the design settled, and what to say of it."""

    settled: bool
    warnings: list[str]


def run_export(
    design: Design,
    lengths: Sequence[str],
    elastics: Sequence[str],
    files: Mapping[str, str],
    manner: Manner,
    say: Callable[[str], None],
) -> Exported:
    """Solve a design with ``lengths``, NAME=LENGTH, and ``elastics``, LINE=ELASTIC, and write ``files``.

    These are names by kind. Each file is written whole or not at all; ``say`` hears a sentence of each.
    Raises UserError, before anything is solved if a name cannot be.
    """
    wished = {kind: files[kind] for kind in KINDS if files.get(kind)}
    _check(wished, manner)
    stages = build(design)
    design = made_of(dressed(design, stages.model.lines, lengths), elastics)
    solution = run_to_body(build(design, stages))
    outcome = Outcome(solution.stages, solution.control_points, solution.records)
    for kind, name in wished.items():
        say(_write(kind, name, outcome, manner))
    say("\n".join(assessment_lines(assessed(solution), solution.stages.design)))
    settled = solution.verdict.motion == "settled" and solution.verdict.state != "folded"
    return Exported(settled, shape_warnings(solution))


def _check(wished: Mapping[str, str], manner: Manner) -> None:
    """Raise UserError if something is wished that cannot be written."""
    if not wished:
        raise UserError("No output specified.", "Specify a file, for example --body anna.glb.")
    names = list(wished.values())
    twice = [name for name in names if names.count(name) > 1]
    if twice:
        raise UserError(f"{twice[0]} is specified for two outputs.", "Use a different file for each output.")
    for kind, name in wished.items():
        check(kind, name, manner)


def _write(kind: str, name: str, outcome: Outcome, manner: Manner) -> str:
    """Write a file, and return what is said of it."""
    ready = make_ready(kind, name, outcome, manner)
    target = Path(name)
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
    except OSError as why:
        raise UserError(f"{name} cannot be written: {why.strerror}.", "Choose another folder.") from why
    drawn = in_one_go(ready.draw()) if ready.draw else None
    files = ready.write(target, drawn, quiet) or [target]
    place = name if len(files) == 1 else f"{files[0].name} to {files[-1].name}"
    return f"{place}: {ready.contents}" + (f", {ready.how}" if ready.how else "")
