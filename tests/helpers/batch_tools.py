"""Runs of ``busk batch`` in a process of their own, and what they leave."""

from __future__ import annotations

import csv
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq

from app.batch.schema import VARYING

ROOT = Path(__file__).parents[2]
_MAIN = "import sys; from app.cli.main import main; sys.exit(main(sys.argv[1:]))"


def start_batch(*words: str | Path) -> subprocess.Popen[bytes]:
    """Start a run; its output is not read."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    return subprocess.Popen(
        [sys.executable, "-c", _MAIN, "batch", *map(str, words)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env=environment,
        start_new_session=True,  # a group of its own, as a terminal gives it
    )


def run_batch(*words: str | Path) -> tuple[int, str, str]:
    """Return exit code, output and errors of a run."""
    process = start_batch(*words)
    out, err = process.communicate(timeout=300)
    return process.returncode, out.decode(), err.decode()


def parquet_rows(out: Path) -> list[dict[str, Any]]:
    """Return the rows of the table, part by part."""
    parts = sorted((out / "results.parquet").glob("part-*.parquet"))
    return [row for part in parts for row in pq.read_table(part).to_pylist()]


def csv_rows(out: Path) -> list[dict[str, str]]:
    """Return the rows of the table as CSV."""
    with open(out / "results.csv", newline="", encoding="utf-8-sig") as file:
        return list(csv.DictReader(file))


def lasting(row: dict[str, Any]) -> dict[str, Any]:
    """Return a row without the values that differ from run to run."""
    return {name: value for name, value in row.items() if name not in VARYING}


def summary(out: Path) -> dict[str, Any]:
    """Return the summary of a run."""
    values: dict[str, Any] = json.loads((out / "summary.json").read_text("utf-8"))
    return values
