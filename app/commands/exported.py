"""What the command line writes for other programs: bodies, lines, strips, measures and turntables."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from app.commands.settings import dressed, made_of
from core import __version__
from core.design import Design
from core.errors import UserError
from core.export import kind_of, write_mesh
from core.measures import before_after, measure_rows
from core.mesh import Mesh, Points
from core.pipeline import build
from core.report import shape_warnings
from core.solution import Solution, run
from core.space import Space, space_of
from core.tffd import deform
from core.writing_out.drawing import CURVE_FORMATS, STRIP_FORMATS, drawing_kind, write_curves, write_strips
from core.writing_out.measures_file import MeasuresSheet, measures_kind, write_measures
from core.writing_out.worn import strips, worn_curves

if TYPE_CHECKING:
    from app.printing.turntable import Turntable

USUAL_UNIT = "cm"
"""The unit of measures in a file, if none is told."""


@dataclass(frozen=True)
class Wishes:
    """What is to be written: file names, empty where nothing is wished, and how.

    ``file_unit`` and ``axes`` are None where the usual ones will do; ``before`` takes the body at rest in
    place of the reshaped one, but for strips; ``frames``, ``size``, ``seconds``, ``dark`` and ``beside`` are
    those of a turntable.
    """

    body: str = ""
    control: str = ""
    lines: str = ""
    flat: str = ""
    measures: str = ""
    turntable: str = ""
    file_unit: str | None = None
    axes: str | None = None
    before: bool = False
    frames: int = 36
    size: tuple[int, int] = (640, 720)
    seconds: float = 6.0
    dark: bool = False
    beside: bool = False

    @property
    def files(self) -> list[str]:
        """The names that were given, in order."""
        files = (self.body, self.control, self.lines, self.flat, self.measures, self.turntable)
        return [name for name in files if name]


@dataclass(frozen=True)
class Exported:
    """What was exported: whether the design settled, and what to say of it."""

    settled: bool
    warnings: list[str]


def run_export(
    design: Design,
    lengths: Sequence[str],
    elastics: Sequence[str],
    wishes: Wishes,
    say: Callable[[str], None],
) -> Exported:
    """Solve a design with ``lengths``, NAME=LENGTH, and ``elastics``, LINE=ELASTIC, and write what is wished.

    Each file is written whole or not at all; ``say`` hears a sentence of each. Raises UserError, before
    anything is solved if a name cannot be.
    """
    _check(wishes)
    stages = build(design)
    design = made_of(dressed(design, stages.model.lines, lengths), elastics)
    solution = run(build(design, stages))
    points = solution.stages.control.mesh.vertices if wishes.before else solution.control_points
    for write, name in _jobs(solution, points, wishes):
        if name:
            Path(name).absolute().parent.mkdir(parents=True, exist_ok=True)
            say(write(name))
    settled = solution.verdict.motion == "settled" and solution.verdict.state != "folded"
    return Exported(settled, shape_warnings(solution))


def _check(wishes: Wishes) -> None:
    """Raise UserError if something is wished that cannot be written."""
    if not wishes.files:
        raise UserError("Nothing is to be written.", "Name a file, for example --body anna.glb.")
    twice = {name for name in wishes.files if wishes.files.count(name) > 1}
    if twice:
        raise UserError(f"{twice.pop()} is to hold two things.", "Give each file a name of its own.")
    Space(wishes.file_unit or "mm", wishes.axes or "z-up")
    for name in filter(None, (wishes.body, wishes.control)):
        kind_of(name)
    for name, formats in ((wishes.lines, CURVE_FORMATS), (wishes.flat, STRIP_FORMATS)):
        if name:
            drawing_kind(name, formats)
    if wishes.measures:
        measures_kind(wishes.measures, wishes.file_unit or USUAL_UNIT)
    if wishes.turntable:
        _turntable_of(wishes)


def _jobs(solution: Solution, points: Points, wishes: Wishes) -> Iterator[tuple[Callable[[str], str], str]]:
    """Yield what can be written, and the names under which it is wished."""
    stages = solution.stages
    body = Mesh(deform(stages.binding, points), stages.body.mesh.faces)
    control = stages.control.mesh.moved(points)
    yield lambda name: _mesh(name, body, wishes), wishes.body
    yield lambda name: _mesh(name, control, wishes), wishes.control
    yield lambda name: _lines(name, solution, points, wishes), wishes.lines
    yield lambda name: _flat(name, solution), wishes.flat
    yield lambda name: _measures(name, solution, wishes), wishes.measures
    yield lambda name: _turntable(name, solution, points, wishes), wishes.turntable


def _mesh(name: str, mesh: Mesh, wishes: Wishes) -> str:
    space = space_of(kind_of(name), wishes.file_unit, wishes.axes)
    write_mesh(name, mesh, space=space)
    return f"{name}: {len(mesh.vertices)} points, {len(mesh.faces)} triangles, in {space.unit}, {space.axes}"


def _looks(design: Design, names: list[str]) -> tuple[dict[str, str], dict[str, float]]:
    """Return titles and widths [mm] of lines as the window shows them."""
    from app.presenting.lines import band_width, line_title  # noqa: PLC0415 (brings Qt along)

    titles = {name: line_title(name, design) for name in names}
    return titles, {name: band_width(name, design) for name in names}


def _lines(name: str, solution: Solution, points: Points, wishes: Wishes) -> str:
    stages = solution.stages
    curves = worn_curves(stages, points, *_looks(stages.design, [line.name for line in stages.model.lines]))
    space = space_of(drawing_kind(name, CURVE_FORMATS), wishes.file_unit, wishes.axes)
    write_curves(name, curves, space)
    return f"{name}: {', '.join(curve.title for curve in curves)}, in {space.unit}, {space.axes}"


def _flat(name: str, solution: Solution) -> str:
    stages = solution.stages
    looks = _looks(stages.design, [line.name for line in stages.model.lines])
    drawn = strips(stages, solution.control_points, *looks)
    write_strips(name, drawn, f"Busk {__version__}, {stages.design.scan.name}")
    return f"{name}: {', '.join(f'{each.title} {each.length:.1f} mm' for each in drawn)}, 1:1"


def _measures(name: str, solution: Solution, wishes: Wishes) -> str:
    stages = solution.stages
    rows = measure_rows(*before_after(stages, solution.control_points))
    when = "before" if wishes.before else "after"
    rows = [row for row in rows if row[when] is not None]
    titles = {row["key"]: f"{row['title']}, {row['side']}" if row["side"] else row["title"] for row in rows}
    values = {row["key"]: (float(row[when]), str(row["unit"])) for row in rows}
    unsure = "; ".join(titles[row["key"]] for row in rows if row["estimate"])
    note = f"Busk {__version__}, {stages.design.scan.name}, {'at rest' if wishes.before else 'reshaped'}."
    note += f" Estimates: {unsure}." if unsure else ""
    unit = wishes.file_unit or USUAL_UNIT
    write_measures(name, MeasuresSheet(values, unit, titles, note))
    return f"{name}: {len(values)} measures {'at rest' if wishes.before else 'as reshaped'}, in {unit}"


def _turntable(name: str, solution: Solution, points: Points, wishes: Wishes) -> str:
    from app.presenting.frame import bands  # noqa: PLC0415 (brings Qt along)
    from app.printing.turntable import write_turntable  # noqa: PLC0415 (brings VTK along)

    stages, turntable = solution.stages, _turntable_of(wishes)
    files = write_turntable(name, stages, points, bands(stages, ()), turntable)
    place = name if len(files) == 1 else f"{files[0].name} to {files[-1].name}"
    return f"{place}: {turntable.frames} pictures in {turntable.seconds:g} s"


def _turntable_of(wishes: Wishes) -> Turntable:
    from app.printing.turntable import Turntable, turntable_kind  # noqa: PLC0415

    turntable_kind(wishes.turntable)
    return Turntable(wishes.frames, wishes.size, wishes.seconds, wishes.dark, wishes.beside)
