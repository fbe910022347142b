"""Columns of the table of results: name, type, unit and description; a row is one body and variant."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from app.batch.batch_design import BatchDesign
from core.document.design import Design
from core.landmarks.types import SIDES
from core.measurements.definitions import DEFINITIONS
from core.measurements.sizes import built_in

TABLE, CSV, PAGE = "results.parquet", "results.csv", "index.html"
SUMMARY, DESIGN = "summary.json", "design.json"
"""Files in the folder of a run."""

FOLDERS = {"body": ("bodies", ".ply"), "picture": ("pictures", ".png"), "report": ("reports", ".pdf")}
"""Folder and ending of each kind of file; the column ``KIND_file`` of a row has the name."""

TEXT, NUMBER = "text", "number"
DONE, REFUSED, CRASHED, TIMEOUT = STATES = ("done", "refused", "crashed", "timeout")
"""What became of a body: only one that is done has results."""

SUFFIXES = {"mm": "_mm", "ml": "_ml", "cm2": "_cm2", "": ""}
"""Endings of the names of columns by the unit of a measurement."""

AFTER_ONLY = ("apex_lift",)
"""Measurements that an original body does not have."""


@dataclass(frozen=True)
class Column:
    """A column: ``kind`` is TEXT or NUMBER, ``unit`` that of its values, empty for texts and ratios."""

    name: str
    kind: str
    unit: str
    about: str


def _texts(*pairs: tuple[str, str]) -> tuple[Column, ...]:
    return tuple(Column(name, TEXT, "", about) for name, about in pairs)


def _numbers(unit: str, *pairs: tuple[str, str]) -> tuple[Column, ...]:
    return tuple(Column(name, NUMBER, unit, about) for name, about in pairs)


HEAD = (
    *_texts(
        ("scan", "File of the scan, as it was listed"),
        ("scan_sha256", "SHA-256 of the file; empty if it cannot be read"),
        ("variant", "Name of the design"),
        ("state", "done, refused, crashed or timeout"),
        ("message", "Why there is no result, or the worst finding of the verdict"),
        ("verdict", "Overall verdict: good, caution or bad"),
        ("doubts", "Warnings about scan, landmarks, lines, shape and pattern"),
        ("solver_state", "State of the solver, as in report.json of busk solve"),
    ),
    *_numbers(
        "mm",
        ("lift_left_mm", "Upward movement of the left bust point"),
        ("lift_right_mm", "Upward movement of the right bust point"),
        ("forward_left_mm", "Forward movement of the left bust point"),
        ("forward_right_mm", "Forward movement of the right bust point"),
    ),
    *_numbers("%", ("volume_error_percent", "Volume error of the bust, as in report.json of busk solve")),
    *_numbers("ml", ("lower_volume_error_ml", "Volume error of waist and hips")),
    *_numbers("mm", ("target_miss_mm", "Largest deviation from a target; empty without targets")),
)
"""Columns that every table begins with."""

TAIL = (
    *_texts(
        ("picture_file", "File of the picture in the output folder"),
        ("body_file", "File of the reshaped body in the output folder, if requested"),
        ("report_file", "File of the report in the output folder, if requested"),
    ),
    *_numbers("s", ("seconds", "Computing time")),
    *_numbers("MB", ("memory_mb", "Memory in use after the computation")),
    *_texts(("busk_version", "Version of Busk that computed the row")),
)
"""Columns that every table ends with."""

VARYING = ("seconds", "memory_mb")
"""Columns that differ from run to run; all others depend on scan and design alone."""

LINE_COLUMNS = (
    ("set_{name}_percent", "%", "Set length of the line, of the original length"),
    ("reached_{name}_mm", "mm", "Reached front length of the line"),
    ("cut_length_{name}_mm", "mm", "Cut length; empty without an elastic"),
    ("elongation_{name}_percent", "%", "Elongation of the elastic"),
    ("tension_{name}_n", "N", "Tension of the line"),
    ("pressure_mean_{name}_kpa", "kPa", "Mean contact pressure"),
    ("pressure_max_{name}_kpa", "kPa", "Maximum contact pressure"),
)
"""Name, unit and description of the columns of each active line."""

PRESSURE_COLUMNS = LINE_COLUMNS[-2:]
"""Those of cups too."""


def columns_of(designs: Sequence[BatchDesign]) -> tuple[Column, ...]:
    """Return the columns of a run: fixed by its designs, the same for every body."""
    columns = [*HEAD, *_measures(designs), *_sizes()]
    for each in designs:
        columns += [*_lines(each), *_cups(each.design), *_pattern(each.design)]
    unique = {column.name: column for column in (*columns, *TAIL)}
    return tuple(unique.values())


def measure_column(key: str, unit: str, *, after: bool) -> str:
    """Return the name of the column of a measurement, on the original or on the reshaped body."""
    stem = key.replace("own:", "own_").replace("_girth", "")
    return f"{stem}{'_after' if after else ''}{SUFFIXES[unit]}"


def measure_keys() -> dict[str, tuple[str, bool]]:
    """Return the measurements by the names of their columns, and whether they are of the reshaped body."""
    return {
        measure_column(key, definition.unit, after=after): (key, after)
        for definition in DEFINITIONS.values()
        for key in definition.keys
        for after in (False, True)
    }


def _measures(designs: Sequence[BatchDesign]) -> Iterator[Column]:
    lower = any(each.design.lower is not None for each in designs)
    for definition in DEFINITIONS.values():
        if lower or not definition.lower:
            for key in definition.keys:
                title = str(definition.title) + next(
                    (f", {side}" for side in SIDES if key.endswith(side)), ""
                )
                yield from _pair(key, definition.unit, title)
    for own in {own.name: own for each in designs for own in each.design.own_measures}.values():
        yield from _pair(f"own:{own.name}", "mm", own.name)


def _pair(key: str, unit: str, title: str) -> Iterator[Column]:
    for after, of in ((False, "original body"), (True, "reshaped body")):
        if after or key not in AFTER_ONLY:
            yield Column(measure_column(key, unit, after=after), NUMBER, unit, f"{title}, {of}")


def _sizes() -> Iterator[Column]:
    for table in built_in():
        for part in ("band", "cup"):
            yield Column(
                f"{part}_{table.key}", TEXT, "", f"Size of the original body, {part}: {table.title.en}"
            )


def _lines(design: BatchDesign) -> Iterator[Column]:
    yield from _filled(LINE_COLUMNS, design.active_lines)


def _cups(design: Design) -> Iterator[Column]:
    yield from _filled(PRESSURE_COLUMNS, [f"cup {side}" for side in SIDES] if design.cup else [])


def _filled(columns: Iterable[tuple[str, str, str]], names: Iterable[str]) -> Iterator[Column]:
    columns = tuple(columns)
    for name in names:
        for column, unit, about in columns:
            yield Column(column.format(name=name), NUMBER, unit, f"{about}, {name}")


def _pattern(design: Design) -> Iterator[Column]:
    block = design.pattern.block if design.pattern is not None else None
    for panel in block.panels if block is not None else ():
        for side in SIDES if panel.each else ("",):
            name = f"{panel.name} {side}".rstrip()
            yield Column(f"area_{name}_cm2", NUMBER, "cm2", f"Area of the pattern piece, {name}")
            yield Column(f"strain_{name}_percent", NUMBER, "%", f"Strain of the pattern piece, {name}")
    for seam in block.seams if block is not None else ():
        for name, _ in seam.named() if not seam.edge else ():
            yield Column(f"seam_{name}_mm", NUMBER, "mm", f"Length of the seam, {name}; empty for an edge")
