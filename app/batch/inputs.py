"""Scans of a run: files, folders with all below them, patterns, and lists as CSV."""

from __future__ import annotations

import csv
import glob
import hashlib
import os
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path

from app.batch.schema import DESIGN, FOLDERS, TABLE
from core.document.storage.project_file import SUFFIX
from core.errors import UserError, reason_of
from core.files.regular_file import open_regular, read_text
from core.messages import Message
from core.scan.readers.registry import FORMATS, LARGEST_FILE

_IN_FOLDERS = {*(f".{kind}" for kind in FORMATS), SUFFIX} - {".gz", ".txt", ".csv"}
"""Endings of scans and projects in folders: texts and tables are scans only where they are named."""

_LARGEST_LIST = 200_000_000  # bytes of a list of scans


def list_scans(names: Sequence[str], out: Path | None = None) -> list[str]:
    """Return the paths of all scans, each once, in the order of ``names`` and of their names in folders.

    A named file and a folder that cannot be read are listed as well: they are refused with a reason when they
    are read. Reshaped bodies in the output of a run are not listed, but where their folder is named; ``out``
    is the output of this one. Raises UserError for a list that cannot be read, and if there is no scan.
    """
    by_place: dict[str, str] = {}
    for path in (path for name in names for path in _scans(name, out and Path(os.path.realpath(out)))):
        by_place.setdefault(os.path.abspath(path), path)
    found = list(by_place.values())
    if not found:
        raise UserError(
            Message("No scans found."), Message("Specify scans, folders with scans, or a list as CSV.")
        )
    return found


def printable_path(path: str) -> str:
    """Return a path, or a text with one, that every table can hold: what is not a letter is escaped."""
    try:
        data = os.fsencode(path)
    except UnicodeEncodeError:  # half a letter, which no path has
        data = path.encode("utf-8", errors="backslashreplace")
    return data.decode("utf-8", errors="backslashreplace")


def file_digest(path: Path) -> str:
    """Return the SHA-256 of a file in hexadecimal, empty if it cannot be read or is larger than any scan."""
    with suppress(OSError, ValueError), open(open_regular(path), "rb") as file:
        if os.fstat(file.fileno()).st_size <= LARGEST_FILE:
            return hashlib.file_digest(file, "sha256").hexdigest()
    return ""


def _scans(name: str, out: Path | None) -> Iterator[str]:
    if os.path.isdir(name):
        yield from _in_folder(name, out)
    elif name.lower().endswith(".csv"):
        yield from _listed(Path(name))
    elif glob.has_magic(name) and not os.path.lexists(name):
        for match in sorted(glob.glob(name, recursive=True)):
            if os.path.isdir(match):
                yield from () if _is_written(match, out) else _in_folder(match, out)
            elif not _is_written(os.path.dirname(match), out):
                yield match
    else:
        yield name


def _in_folder(top: str, out: Path | None) -> Iterator[str]:
    """Yield the scans below a folder; a folder that links lead to again is read once."""
    unreadable: list[str] = []
    seen: set[str] = set()

    def note(problem: OSError) -> None:
        unreadable.append(str(problem.filename))

    for folder, folders, files in os.walk(top, onerror=note, followlinks=True):
        yield from unreadable
        unreadable.clear()
        place = os.path.realpath(folder)
        if place in seen or (folder != top and _is_written(folder, out)):
            folders.clear()
            continue
        seen.add(place)
        folders.sort()
        yield from (os.path.join(folder, file) for file in sorted(files) if _is_scan(file))
    yield from unreadable


def _is_written(folder: str, out: Path | None) -> bool:
    """Return whether a folder is that of the reshaped bodies of a run."""
    place = Path(os.path.realpath(folder))
    if place.name != FOLDERS["body"][0]:
        return False
    return place.parent == out or all((place.parent / name).exists() for name in (DESIGN, TABLE))


def _is_scan(name: str) -> bool:
    return Path(name.lower().removesuffix(".gz")).suffix in _IN_FOLDERS


def _listed(path: Path) -> Iterator[str]:
    """Yield the scans of a list: its column "scan", or the first one; paths are relative to the list."""
    try:
        lines = read_text(path, _LARGEST_LIST, "utf-8-sig").splitlines()
        # Spreadsheets separate with semicolons where numbers have commas.
        parts = [part.strip(' "').lower() for part in lines[0].split(";")] if lines else []
        rows = list(csv.reader(lines, delimiter=";" if len(parts) > 1 and "scan" in parts else ","))
    except (OSError, ValueError, csv.Error) as problem:
        raise UserError(
            Message("The list {file} cannot be read: {why}.", file=str(path), why=reason_of(problem)),
            Message("Save it as CSV in UTF-8, with a column named scan."),
        ) from problem
    heading = [cell.strip().lower() for cell in rows[0]] if rows else []
    column = heading.index("scan") if "scan" in heading else 0
    for row in rows["scan" in heading :]:
        if len(row) > column and row[column].strip():
            yield os.path.join(path.parent, row[column].strip())
