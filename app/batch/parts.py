"""The Parquet parts of a table of results, read."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

from app.batch.design_file import damaged_error
from app.batch.schema import TABLE


def part_files(folder: Path) -> list[Path]:
    """Return the parts of the run in a ``folder``, in the order in which they were written."""
    return sorted((folder / TABLE).glob("part-*.parquet"))


def read_part(part: Path, columns: Sequence[str] | None = None) -> pa.Table:
    """Return a part, or some of its columns. Raises UserError if it is damaged."""
    try:
        return pq.ParquetFile(part).read(columns and list(columns))
    except (OSError, ValueError, pa.ArrowException) as problem:
        raise damaged_error(part.parent.parent, " ".join(str(problem).split()).rstrip(".")) from problem
