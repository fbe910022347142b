"""Prepare exports: check names and options, describe the content, write the files."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from app.i18n.catalog import listed, number, tr
from app.i18n.lengths import length, using_unit
from app.presenters.cut_list import as_table
from app.presenters.export import ExportOptions, ExportSource
from app.presenters.measurements import measure_title
from app.presenters.messages import render
from core import __version__
from core.errors import UserError
from core.export.band_geometry import line_curves, strips, worn_regions
from core.export.csv_cells import write_table
from core.export.drawings import CURVE_FORMATS, STRIP_FORMATS, drawing_kind, write_curves, write_strips
from core.export.measurement_files import (
    LENGTHS_ALONE,
    MeasurementTable,
    measurement_file_kind,
    seamly_names,
    write_measurements,
)
from core.export.mesh import kind_of, write_control_points, write_mesh
from core.export.solution_report import write_iterations
from core.export.units_and_axes import FileSpace, space_of
from core.garment.cut_list import cut_list
from core.garment.pressure_list import pressure_list
from core.geometry.mesh import Mesh
from core.messages import Message
from core.progress import Pieces, Progress, part_of

if TYPE_CHECKING:
    from app.rendering.offscreen import OffscreenRenderer
    from app.rendering.turntable import Turntable

USUAL_UNIT = "cm"
"""The default unit of measurements in a file."""

Write = Callable[[Path, Any, Progress], list[Path] | None]


@dataclass(frozen=True, eq=False)
class ExportPreview:
    """A file that can be written: what will be in it, and how, in words.

    ``draw``, if there is any, comes first: it belongs to the window's thread, and what it returns is for
    ``write``, which any thread may call; that returns the files, if they are not just the one it was told.
    Both raise UserError or Cancelled.
    """

    contents: str
    how: str
    write: Write
    draw: Callable[[], Pieces[Any]] | None = None


def prepare_export(
    what: str, path: str | Path, outcome: ExportSource, manner: ExportOptions
) -> ExportPreview:
    """Compute the content of a file of that name. Raises UserError if it cannot be written so.

    ``what`` is a word of ``WAYS``.
    """
    check(what, path, manner)
    return WAYS[what][1](str(path), outcome, manner)


def check(what: str, path: str | Path, manner: ExportOptions) -> None:
    """Raise UserError if no file of that name can be written in that manner, whatever is in it."""
    FileSpace(manner.unit or "mm", manner.axes or "z-up")
    WAYS[what][0](str(path), manner)


def _mesh_kind(path: str, manner: ExportOptions) -> None:
    kind_of(path)


def _control_kind(path: str, manner: ExportOptions) -> None:
    if not path.lower().endswith(".csv"):
        kind_of(path)


def _turntable_kind(path: str, manner: ExportOptions) -> None:
    from app.rendering.turntable import turntable_kind  # noqa: PLC0415 (brings VTK along)

    turntable_kind(path)
    _turntable_of(manner)


def _picture_kind(path: str, manner: ExportOptions) -> None:
    from app.rendering.offscreen import picture_kind  # noqa: PLC0415 (brings VTK along)

    picture_kind(path)


def _table_kind(path: str, manner: ExportOptions) -> None:
    if not path.lower().endswith(".csv"):
        raise UserError(
            Message("Tables are exported as .csv files."), Message("Choose a name that ends in .csv.")
        )


def _in_space(space: FileSpace) -> str:
    axes = {"z-up": tr("z-up"), "y-up": tr("y-up"), "z-up-front-y": tr("z-up-front-y")}[space.axes]
    return tr("in {unit}, {axes}").format(unit=_unit_text(space.unit), axes=axes)


def _unit_text(unit: str) -> str:
    return tr("inches") if unit == "in" else unit


def _body(path: str, outcome: ExportSource, manner: ExportOptions) -> ExportPreview:
    return _mesh(path, outcome.body(manner.before), manner)


def _control(path: str, outcome: ExportSource, manner: ExportOptions) -> ExportPreview:
    points = outcome.points(manner.before)
    control = outcome.stages.control
    if not path.lower().endswith(".csv"):
        return _mesh(path, control.mesh.moved(points), manner)
    told = tr("{count} control points").format(count=number(len(points), 0))
    return ExportPreview(
        told, _in_space(FileSpace()), lambda at, _, hear: write_control_points(at, control, points)
    )


def _mesh(path: str, mesh: Mesh, manner: ExportOptions) -> ExportPreview:
    space = space_of(kind_of(path), manner.unit, manner.axes)
    told = tr("{points} points, {triangles} triangles").format(
        points=number(len(mesh.vertices), 0), triangles=number(len(mesh.faces), 0)
    )
    return ExportPreview(told, _in_space(space), lambda at, _, hear: write_mesh(at, mesh, hear, space))


def _lines(path: str, outcome: ExportSource, manner: ExportOptions) -> ExportPreview:
    worn = worn_regions(outcome.stages, outcome.region_points(manner.before))
    curves = tuple(curve for each in worn for curve in line_curves(*each, *outcome.looks))
    space = space_of(drawing_kind(path, CURVE_FORMATS), manner.unit, manner.axes)
    told = listed(f"{curve.title} {length(curve.length)}" for curve in curves)
    return ExportPreview(told, _in_space(space), lambda at, _, hear: write_curves(at, curves, space))


def _flat(path: str, outcome: ExportSource, manner: ExportOptions) -> ExportPreview:
    worn = worn_regions(outcome.stages, outcome.region_points(before=False))
    drawn = tuple(strip for each in worn for strip in strips(*each, *outcome.looks))
    told = listed(f"{each.title} {length(each.length)}" for each in drawn)
    heading = f"Busk {__version__} · {outcome.whose}"
    return ExportPreview(told, "1:1", lambda at, _, hear: write_strips(at, drawn, heading, _strip_text))


def _strip_text(message: Message) -> str:
    """Return what stands on a strip in the language in use; files keep millimetres."""
    with using_unit("mm"):
        return render(message)


def _cut(path: str, outcome: ExportSource, manner: ExportOptions) -> ExportPreview:
    stages, points = outcome.stages, outcome.control_points
    cuts = cut_list(stages, points)
    table = as_table(stages, cuts, pressure_list(stages, points))
    told = listed(row[0] for row in table[1:]) or tr("No active lines")
    return ExportPreview(told, "", lambda at, _, hear: write_table(at, table))


def _measures(path: str, outcome: ExportSource, manner: ExportOptions) -> ExportPreview:
    when, unit = "before" if manner.before else "after", manner.unit or USUAL_UNIT
    rows = [row for row in outcome.measures if row[when] is not None]
    titles = {row["key"]: measure_title(row) for row in rows}
    values = {row["key"]: (float(row[when]), str(row["unit"])) for row in rows}
    unsure = listed(titles[row["key"]] for row in rows if row["estimate"])
    note = f"Busk {__version__}, {outcome.design.scan.name}, {'original' if manner.before else 'reshaped'}."
    note += f" Estimates: {unsure}." if unsure else ""
    sheet = MeasurementTable(values, unit, titles, note)
    told = (
        tr("{count} measurements of the original body")
        if manner.before
        else tr("{count} measurements of the reshaped body")
    )
    how = tr("in {unit}").format(unit=_unit_text(unit))
    # Files for pattern programs hold lengths alone, each by its name there.
    kind = measurement_file_kind(path, unit)
    count = len(seamly_names(sheet.lengths) if kind in LENGTHS_ALONE else values)
    return ExportPreview(told.format(count=count), how, lambda at, _, hear: write_measurements(at, sheet))


def _turns(path: str, outcome: ExportSource, manner: ExportOptions) -> ExportPreview:
    records = outcome.records
    told = tr("Iterations: {count}").format(count=number(len(records), 0))
    return ExportPreview(told, "", lambda at, _, hear: write_iterations(at, records, outcome.stages))


def _picture(path: str, outcome: ExportSource, manner: ExportOptions) -> ExportPreview:
    def draw() -> Pieces[Any]:
        with _studio(outcome, manner) as studio:
            yield from part_of(studio.set_up(), 0.0, 0.0)
            if isinstance(manner.view, str):
                studio.frame_worn(manner.size, manner.view)
            else:
                studio.scene.set_camera(manner.view)
            studio.scene.before(manner.before)
            studio.scene.set_visible("bands", manner.bands)
            studio.scene.set_visible("floor", not manner.clear)
            return (yield from studio.render(manner.size))

    def write(at: Path, drawn: Any, hear: Progress) -> None:
        from app.rendering.offscreen import write_picture  # noqa: PLC0415 (brings VTK along)

        write_picture(at, drawn, manner.dark, manner.clear, hear)

    _ = outcome.occlusion  # it takes a while, and any thread will do
    told = tr("{width} × {height} pixels")
    return ExportPreview(told.format(width=manner.size[0], height=manner.size[1]), "", write, draw)


def _turntable(path: str, outcome: ExportSource, manner: ExportOptions) -> ExportPreview:
    turntable = _turntable_of(manner)

    def draw() -> Pieces[Any]:
        from app.rendering.turntable import render_turntable  # noqa: PLC0415 (brings VTK along)

        with _studio(outcome, manner) as studio:
            yield from part_of(studio.set_up(), 0.0, 0.0)
            return (yield from render_turntable(studio, turntable))

    def write(at: Path, drawn: Any, hear: Progress) -> list[Path]:
        from app.rendering.turntable import write_turntable  # noqa: PLC0415 (brings VTK along)

        return write_turntable(at, drawn, turntable, hear)

    _ = outcome.occlusion
    told = tr("{count} images in {seconds} s")
    return ExportPreview(told.format(count=manner.frames, seconds=f"{manner.seconds:g}"), "", write, draw)


def _turntable_of(manner: ExportOptions) -> Turntable:
    from app.rendering.turntable import Turntable  # noqa: PLC0415 (brings VTK along)

    labels = tr("before"), tr("after")
    return Turntable(manner.frames, manner.size, manner.seconds, manner.dark, manner.beside, labels)


@contextmanager
def _studio(outcome: ExportSource, manner: ExportOptions) -> Iterator[OffscreenRenderer]:
    from app.presenters.lines import bands  # noqa: PLC0415
    from app.rendering.offscreen import OffscreenRenderer  # noqa: PLC0415 (brings VTK along)

    shown = bands(outcome.stages, outcome.hidden)
    with OffscreenRenderer(
        outcome.stages,
        outcome.region_points(before=False),
        shown,
        outcome.occlusion,
        dark=manner.dark,
        material=outcome.material,
    ) as studio:
        yield studio


WAYS: dict[
    str,
    tuple[
        Callable[[str, ExportOptions], object], Callable[[str, ExportSource, ExportOptions], ExportPreview]
    ],
] = {
    "body": (_mesh_kind, _body),
    "control": (_control_kind, _control),
    "lines": (lambda path, _: drawing_kind(path, CURVE_FORMATS), _lines),
    "flat": (lambda path, _: drawing_kind(path, STRIP_FORMATS), _flat),
    "cut": (_table_kind, _cut),
    "measures": (lambda path, manner: measurement_file_kind(path, manner.unit or USUAL_UNIT), _measures),
    "picture": (_picture_kind, _picture),
    "turntable": (_turntable_kind, _turntable),
    "turns": (_table_kind, _turns),
}
"""What can be exported: how a name is checked, and how the file is made ready."""
