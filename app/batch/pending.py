"""Bodies that a run has still to compute: all of its scans and variants without those that are stored."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from app.batch.inputs import file_digest, printable_path
from core.files.regular_file import read_regular
from core.scan.readers.registry import LARGEST_FILE

if TYPE_CHECKING:
    from app.batch.store import ResultStore


def pending_bodies(
    scans: Sequence[str],
    store: ResultStore,
    skipped: Callable[[], object],
    *,
    ship: bool = False,
    retry: bool = False,
) -> Iterator[dict[str, Any]]:
    """Yield a request for each scan and variant that ``store`` has no row of, see ``body_process``.

    ``skipped`` is called for each of the others. With ``ship`` a request holds the bytes of the scan. Scans
    are read one by one, as requests are taken; without stored rows they are not read here at all.
    """
    compared, listed = not store.is_empty, {printable_path(scan) for scan in scans}
    for scan in scans:
        shown = printable_path(scan)
        digest = file_digest(Path(scan)) if compared else ""
        missing = []
        for number, design in enumerate(store.designs):
            if compared and store.is_done(shown, digest, design.name, listed.__contains__, retry=retry):
                skipped()
            else:
                missing.append((number, design.name))
        data = _bytes(scan) if ship and missing else None
        for number, name in missing:
            request = {"scan": shown, "file": os.path.abspath(scan), "variant": number, "name": name}
            yield request if data is None else {**request, "data": data}


def _bytes(scan: str) -> bytes | None:
    """Return the bytes of a scan, None if it cannot be read: then the worker finds the reason."""
    try:
        return read_regular(scan, LARGEST_FILE)
    except (OSError, ValueError):
        return None
