"""The rows of a run, read from its CSV file: without the packages that computing them needs."""

from __future__ import annotations

import csv
import os
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path

from app.batch.batch_design import BatchDesign
from app.batch.design_file import read_designs
from app.batch.one_body import Row
from app.batch.schema import CSV, DESIGN, FOLDERS, TEXT, columns_of
from core.errors import ProjectError, reason_of
from core.export.csv_cells import is_formula
from core.messages import Message
from core.progress import Progress, quiet


def has_results(folder: Path) -> bool:
    """Return whether a folder is the output of a run."""
    return (folder / DESIGN).is_file() and (folder / CSV).is_file()


def read_results(folder: Path, progress: Progress = quiet) -> tuple[list[BatchDesign], list[Row]]:
    """Return designs and rows of the run in a folder, also of one that goes on. Raises UserError.

    Of several rows of one scan and variant, which a run that was stopped can leave, the last one counts.
    """
    designs = read_designs(folder / DESIGN)
    try:
        with open(folder / CSV, newline="", encoding="utf-8-sig") as file:
            rows = {(row["scan"], row["variant"]): row for row in _rows(file, designs, progress)}
    except (OSError, ValueError, KeyError, csv.Error) as problem:
        raise ProjectError(
            Message(
                "The results in {folder} cannot be read: {why}.", folder=str(folder), why=reason_of(problem)
            ),
            Message("Choose the folder of a batch run."),
        ) from problem
    return designs, list(rows.values())


def scan_file(folder: Path, scan: str) -> Path | None:
    """Return the file of a listed scan, None if it is not there.

    A relative name was relative to the folder in which the command was given: those above the results are
    tried, from the nearest.
    """
    places = (Path(os.path.join(above, scan)) for above in (folder, *folder.absolute().parents, Path.cwd()))
    with suppress(OSError, ValueError):
        return next((place for place in places if place.is_file()), None)
    return None


def written_file(folder: Path, kind: str, name: str) -> Path | None:
    """Return the file of a row, of a ``kind`` of ``FOLDERS``; None if there is none, or none of a run.

    Results may come from others: what is opened is in the folder of its kind, and has its ending.
    """
    inside, ending = FOLDERS[kind]
    file = Path(name).name
    return folder / inside / file if name == f"{inside}/{file}" and file.endswith(ending) else None


def _rows(lines: Iterator[str], designs: Sequence[BatchDesign], progress: Progress) -> Iterator[Row]:
    texts = {column.name for column in columns_of(designs) if column.kind == TEXT}
    reader = csv.reader(lines)
    heading = next(reader, [])
    for number, cells in enumerate(reader):
        if number % 1000 == 0:
            progress("", 0.0)
        if len(cells) == len(heading):  # else it is being written at this moment
            yield {
                name: _text(cell) if name in texts else _number(cell)
                for name, cell in zip(heading, cells, strict=True)
            }


def _text(cell: str) -> str:
    """Return a text without the apostrophe that keeps spreadsheets from computing it."""
    return cell[1:] if cell[:1] == "'" and is_formula(cell[1:]) else cell


def _number(cell: str) -> float | None:
    return float(cell) if cell else None
