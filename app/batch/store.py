"""The output folder of a run: rows as a folder of Parquet parts, as CSV, and a summary."""

from __future__ import annotations

import csv
import io
import json
import os
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from app.batch.batch_design import SCHEMA_VERSION, BatchDesign, content_key
from app.batch.design_file import other_results_error, stored_key, write_designs
from app.batch.index_page import index_page
from app.batch.one_body import Row
from app.batch.parts import part_files, read_part
from app.batch.schema import (
    CRASHED,
    CSV,
    DESIGN,
    PAGE,
    STATES,
    SUMMARY,
    TABLE,
    TEXT,
    TIMEOUT,
    Column,
    columns_of,
)
from core import __version__
from core.document.storage.file_lock import FolderLock
from core.errors import ProjectError, reason_of
from core.export.csv_cells import ENCODING, cell
from core.files.atomic_write import atomic_path, write_text
from core.messages import Message

FLUSH_SECONDS, FLUSH_SHARE, MOST_ROWS = 2.0, 0.01, 5000
"""Rows are written after so many seconds, or after this share of the time that the run has taken, so that a
long run has hundreds of parts and not millions; and never more than so many in one part.
"""

_KEY_COLUMNS = ("scan", "scan_sha256", "variant", "state")


@dataclass(frozen=True)
class _Stored:
    digest: str
    state: str
    part: Path | None


class ResultStore:
    """Holds the rows of one run in ``folder``; the parts of the table are the truth, all else follows.

    Rows that are there already are kept: see ``is_done``. Raises UserError if the folder holds the results of
    other designs, unless they are to be removed (``restart``), or if another run writes to it.
    """

    def __init__(self, folder: Path, designs: Sequence[BatchDesign], *, restart: bool = False) -> None:
        self.folder, self.key = folder, content_key(designs)
        self.columns, self.designs = columns_of(designs), designs
        self._table, self._csv = folder / TABLE, folder / CSV
        self._start = self._flushed = time.monotonic()
        self._lock = _locked(folder)
        try:
            self._prepare(restart)
        except BaseException:
            self._lock.release()
            raise

    def _prepare(self, restart: bool) -> None:
        former = _former_key(self.folder)
        if former is None:
            _check_no_others(self.folder)
        elif restart:
            with _writing(self.folder):
                self._clear()
        elif former != self.key:
            raise other_results_error(self.folder)
        write_designs(self.folder / DESIGN, self.designs)
        with _writing(self._table):
            self._table.mkdir(exist_ok=True)
        self._waiting: list[Row] = []
        self._stored: dict[tuple[str, str], _Stored] = {}
        self._by_content: dict[tuple[str, str], list[str]] = {}
        for part in part_files(self.folder):
            for row in read_part(part, _KEY_COLUMNS).to_pylist():
                self._note(row, part)
        numbers = (part.stem.partition("-")[2] for part in part_files(self.folder))
        self._next = max((int(each) for each in numbers if each.isdecimal()), default=-1) + 1
        self._write_csv(self.table())

    @property
    def is_empty(self) -> bool:
        """Return whether no row is stored: then nothing has to be compared with the scans."""
        return not self._stored

    @property
    def states(self) -> Counter[str]:
        """Return how many rows there are of each state."""
        return Counter(dict.fromkeys(STATES, 0)) + Counter(each.state for each in self._stored.values())

    def is_done(
        self, scan: str, digest: str, variant: str, listed: Callable[[str], bool], *, retry: bool = False
    ) -> bool:
        """Return whether there is a row of this content: of this scan, or of one that is not ``listed`` now.

        With ``retry`` a row that crashed or ran out of time does not count.
        """
        stored = self._stored.get((scan, variant))
        if stored is None or stored.digest != digest:
            moved = self._by_content.get((digest, variant), []) if digest else []
            former = next((each for each in moved if not listed(each)), None)
            if former is None:
                return False
            moved.remove(former)
            stored = self._stored[former, variant]
        return bool(digest) and not (retry and stored.state in (CRASHED, TIMEOUT))

    def add(self, rows: Iterable[Row]) -> None:
        """Add rows; they are written when it is time."""
        self._waiting += rows
        now = time.monotonic()
        due = max(FLUSH_SECONDS, FLUSH_SHARE * (now - self._start))
        if now - self._flushed >= due or len(self._waiting) >= MOST_ROWS:
            self.flush()

    def flush(self) -> None:
        """Write the rows that wait as a part, and append them to the CSV file. Raises UserError."""
        rows, self._waiting, self._flushed = self._waiting, [], time.monotonic()
        if not rows:
            return
        self._drop_former({(row["scan"], row["variant"]) for row in rows})
        part = self._table / f"part-{self._next:06}.parquet"
        self._next += 1
        self._write_part(part, rows)
        for row in rows:
            self._note(row, part)
        with _writing(self._csv), open(self._csv, "a", newline="", encoding="utf-8") as file:
            file.write(self._csv_text(rows))

    def finish(self, order: Sequence[str], seconds: float, *, interrupted: bool) -> dict[str, Any]:
        """Write what waits, the CSV file in the ``order`` of scans, the page, and the summary; return it."""
        self.flush()
        table = self.table()
        self._write_csv(table.take(pa.array(self._sorted(table, order), pa.int64())))
        write_text(self.folder / PAGE, index_page(table, self.designs))
        summary = {
            "states": {state: self.states[state] for state in STATES},
            "rows": len(self._stored),
            "interrupted": interrupted,
            "seconds": round(seconds, 3),
            "design_key": self.key,
            "variants": [each.name for each in self.designs],
            "versions": {"busk": __version__, "schema": SCHEMA_VERSION},
        }
        write_text(self.folder / SUMMARY, json.dumps(summary, indent=1) + "\n")
        return summary

    def close(self) -> None:
        """Release the folder."""
        self._lock.release()

    def table(self) -> pa.Table:
        """Return all rows that are written, in the order in which they were computed."""
        tables = [read_part(part) for part in part_files(self.folder)]
        return pa.concat_tables(tables or [_arrow_schema(self.columns).empty_table()])

    def _note(self, row: Row, part: Path | None) -> None:
        scan, digest, variant = row["scan"], row["scan_sha256"] or "", row["variant"]
        self._stored[scan, variant] = _Stored(digest, row["state"], part)
        self._by_content.setdefault((digest, variant), []).append(scan)

    def _drop_former(self, keys: set[tuple[str, str]]) -> None:
        """Remove former rows of these scans and variants, whose files have changed or are tried again."""
        parts = {self._stored[key].part for key in keys if key in self._stored}
        for part in sorted(each for each in parts if each is not None):
            rows = read_part(part).to_pylist()
            kept = [row for row in rows if (row["scan"], row["variant"]) not in keys]
            if kept:
                self._write_part(part, kept)
            else:
                with _writing(part):
                    part.unlink()

    def _write_part(self, part: Path, rows: Sequence[Row]) -> None:
        arrow = pa.Table.from_pylist(
            [{column.name: row.get(column.name) for column in self.columns} for row in rows],
            schema=_arrow_schema(self.columns),
        )
        with atomic_path(part) as partial:
            pq.write_table(arrow, partial)

    def _csv_text(self, rows: Iterable[Row]) -> str:
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        for row in rows:
            values = (row.get(column.name) for column in self.columns)
            writer.writerow([each if isinstance(each, float) else cell(each) for each in values])
        return text.getvalue()

    def _write_csv(self, table: pa.Table) -> None:
        with (
            atomic_path(self._csv) as partial,
            open(partial, "w", newline="", encoding=ENCODING) as file,
        ):
            csv.writer(file, lineterminator="\n").writerow(cell(each.name) for each in self.columns)
            for batch in table.to_batches(max_chunksize=MOST_ROWS):
                file.write(self._csv_text(batch.to_pylist()))

    def _sorted(self, table: pa.Table, order: Sequence[str]) -> list[int]:
        """Return the places of rows in the ``order`` of scans, other scans last, then of variants."""
        at = {scan: number for number, scan in enumerate(order)}
        names = {each.name: number for number, each in enumerate(self.designs)}
        scans, variants = (table.column(name).to_pylist() for name in ("scan", "variant"))
        keys = [
            (at.get(scan, len(at)), scan, names[name]) for scan, name in zip(scans, variants, strict=True)
        ]
        return sorted(range(len(keys)), key=keys.__getitem__)

    def _clear(self) -> None:
        """Remove the results of a former run, and nothing else that is in the folder.

        Its designs come last: while they are there, the folder is that of a run.
        """
        for part in part_files(self.folder):
            part.unlink()
        for name in (CSV, SUMMARY, PAGE, DESIGN):
            (self.folder / name).unlink(missing_ok=True)


def _locked(folder: Path) -> FolderLock:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as problem:
        raise ProjectError(
            Message(
                "The folder {name} cannot be created: {problem}.",
                name=str(folder),
                problem=reason_of(problem),
            ),
            Message("Choose another folder."),
        ) from problem
    try:
        with _writing(folder):
            return FolderLock(folder)
    except BlockingIOError as problem:
        raise ProjectError(
            Message("Another run is writing to {folder}.", folder=str(folder)),
            Message("Wait until it has ended, or choose another folder."),
        ) from problem


@contextmanager
def _writing(place: Path) -> Iterator[None]:
    """Raise a UserError for a place that cannot be written; the lock of another run is none."""
    try:
        yield
    except BlockingIOError:
        raise
    except OSError as problem:
        raise ProjectError(
            Message("{file} cannot be written: {problem}.", file=str(place), problem=reason_of(problem)),
            Message("Choose another folder or free up disk space."),
        ) from problem


def _check_no_others(folder: Path) -> None:
    """Raise a UserError if a folder that is not that of a run holds files that a run would replace."""
    others = [name for name in (CSV, SUMMARY, DESIGN, PAGE) if os.path.lexists(folder / name)]
    if others:
        raise ProjectError(
            Message(
                "{folder} holds other files named like results: {names}.",
                folder=str(folder),
                names=", ".join(others),
            ),
            Message("Choose another folder."),
        )


def _former_key(folder: Path) -> str | None:
    """Return the key of the designs whose results a folder holds, None without any."""
    key = stored_key(folder)
    return "" if key is None and any(part_files(folder)) else key


def _arrow_schema(columns: Sequence[Column]) -> pa.Schema:
    """Return the columns as a Parquet schema, with units and descriptions."""
    fields = [
        pa.field(
            each.name,
            pa.string() if each.kind == TEXT else pa.float64(),
            metadata={"unit": each.unit, "description": each.about},
        )
        for each in columns
    ]
    return pa.schema(fields, metadata={"busk_schema": str(SCHEMA_VERSION), "busk_version": __version__})
