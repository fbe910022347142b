"""The elastics to choose from: those that come with Busk, and a designer's own as measured tables."""

from __future__ import annotations

import json
from contextlib import suppress
from functools import cache
from importlib import resources
from itertools import chain, count
from pathlib import Path
from typing import Any

import platformdirs

from core.document.elastic import Elastic
from core.document.storage.project_file import safe_name
from core.errors import LineError, UserError, reason_of
from core.files.atomic_write import private_folder, write_text
from core.files.table_text import best_names, read_table_text
from core.garment.elastic_csv import ALLOWANCE, TEMPLATE, csv_of, elastic_from_csv, has_allowance
from core.messages import ElasticName, Message

__all__ = [
    "ALLOWANCE",
    "Elastic",
    "built_in",
    "find_elastic",
    "library",
    "read_elastic",
    "remove_elastic",
    "save_elastic",
    "specified_allowance",
    "user_elastics",
    "user_folder",
    "write_elastic",
    "write_template",
]

FORMAT = 1
"""The format of the files in ``resources/elastics``."""


@cache
def built_in() -> tuple[Elastic, ...]:
    """Return the elastics that come with Busk, every kind in each of its widths."""
    folder = resources.files("resources") / "elastics"
    files = sorted((each for each in folder.iterdir() if each.name.endswith(".json")), key=lambda f: f.name)
    return tuple(elastic for each in files for elastic in kind_of(json.loads(each.read_text("utf-8"))))


def kind_of(values: dict[str, Any]) -> tuple[Elastic, ...]:
    """Return the elastics of one kind: one curve [N/cm of width] in several widths."""
    assert values["format"] == FORMAT
    return tuple(
        Elastic(
            f"{values['kind']} {width:g} mm",
            float(width),
            tuple(
                (e, round(newtons * width / 10.0, 6))
                for e, newtons in values["elongation_and_newtons_per_cm"]
            ),
            values["allowance_mm"],
            values["source"],
            values["estimate"],
        )
        for width in values["widths_mm"]
    )


def user_folder() -> Path:
    """Return where a designer's own elastics lie, as tables."""
    return Path(platformdirs.user_data_path("Busk", appauthor=False)) / "elastics"


def user_elastics() -> tuple[list[Elastic], list[LineError]]:
    """Return the designer's own elastics, and why some tables cannot be read."""
    elastics, problems = [], []
    for path in _own_tables():
        try:
            elastics.append(read_elastic(path))
        except LineError as problem:
            problems.append(problem)
    return elastics, problems


def library() -> dict[str, Elastic]:
    """Return all elastics by name; one of the designer's own takes the place of one of the same name."""
    own, _ = user_elastics()
    return {elastic.name: elastic for elastic in (*built_in(), *own)}


def find_elastic(text: str) -> Elastic:
    """Find the elastic of this name, or the only one with all these words in its name.

    Raises LineError if there is none, or more than one.
    """
    elastics = library()
    found = best_names(text, elastics)
    if len(found) > 1:
        raise LineError(
            Message("Several elastics match '{text}'.", text=text),
            Message("Choose one of: {choices}.", choices="; ".join(found)),
        )
    if not found:
        raise LineError(
            Message("No elastic matches '{text}'.", text=text),
            Message("Choose one of: {choices}.", choices=tuple(map(ElasticName, elastics))),
        )
    return elastics[found[0]]


def read_elastic(path: Path, width_mm: float | None = None) -> Elastic:
    """Read a table of one's own; its name is the file's unless it tells one. Raises LineError."""
    return elastic_from_csv(read_table_text(path, LineError), path.stem, width_mm)


def specified_allowance(path: Path) -> bool:
    """Return whether a table tells the allowance, or ``ALLOWANCE`` is taken. Raises LineError."""
    return has_allowance(read_table_text(path, LineError))


def write_elastic(path: Path, elastic: Elastic) -> None:
    """Write an elastic as a table, whole or not at all. Raises ProjectError."""
    write_text(path, csv_of(elastic), "utf-8-sig")


def write_template(path: Path) -> None:
    """Write a table to be filled in with what is measured, whole or not at all. Raises ProjectError."""
    write_text(path, TEMPLATE, "utf-8-sig")


def remove_elastic(name: str) -> None:
    """Remove one of the designer's own elastics, with its table. Raises UserError."""
    for path in _own_tables():
        if _holds(path, name):
            try:
                path.unlink()
            except OSError as problem:
                raise UserError(
                    Message(
                        "The table {name} cannot be removed: {why}.", name=path.name, why=reason_of(problem)
                    ),
                    Message("Delete the file from its folder manually."),
                ) from problem


def save_elastic(elastic: Elastic) -> Path:
    """Keep an elastic in the designer's own folder, over one of the same name and no other.

    Raises ProjectError.
    """
    folder = user_folder()
    try:
        private_folder(folder)
    except OSError as problem:
        raise UserError(
            Message("The folder {folder} cannot be created.", folder=str(folder)),
            Message("Free up disk space, or create the folder manually."),
        ) from problem
    held = [path for path in _own_tables() if _holds(path, elastic.name)]
    # Of several the library has the last; names that differ may be one name for files.
    path = held[-1] if held else _free(folder, safe_name(elastic.name))
    write_elastic(path, elastic)
    return path


def _own_tables() -> list[Path]:
    return sorted(user_folder().glob("*.csv"))


def _holds(path: Path, name: str) -> bool:
    with suppress(LineError):
        return read_elastic(path).name == name
    return False


def _free(folder: Path, stem: str) -> Path:
    """Return a place for a table where no file lies."""
    names = chain([stem], (f"{stem} {number}" for number in count(2)))
    return next(path for path in (folder / f"{name}.csv" for name in names) if not path.exists())
