"""Says whether two folders of ``busk solve`` hold the same answer: every figure of report, mesh and turns."""

from __future__ import annotations

import csv
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

CLOSE = 1e-9
"""How far two figures may be apart, of 1 or of the larger one."""

# These tell of the run, not of the answer.
OF_THE_RUN = {"seconds", "milliseconds", "scan", "path"}


def figures(value: Any, name: str = "") -> Iterator[tuple[str, Any]]:
    """Give every figure and word of a JSON value with its place in it."""
    if isinstance(value, dict):
        for key, inner in value.items():
            if key not in OF_THE_RUN:
                yield from figures(inner, f"{name}.{key}")
    elif isinstance(value, list):
        for index, inner in enumerate(value):
            yield from figures(inner, f"{name}[{index}]")
    else:
        yield name, value


def answer(folder: Path) -> dict[str, Any]:
    """Return all figures and words of a folder by their places."""
    told = dict(figures(json.loads((folder / "report.json").read_text("utf-8"))))
    for table in ("turns.csv", "control.csv"):
        with (folder / table).open(encoding="utf-8", newline="") as file:
            for index, row in enumerate(csv.DictReader(file)):
                told |= {f"{table}[{index}].{key}": _number(text) for key, text in row.items()}
    return told


def _number(text: str | None) -> float | str | None:
    try:
        return float(text or "")
    except ValueError:
        return text


def is_same(one: Any, other: Any) -> bool:
    """Tell whether two figures agree within ``CLOSE``, or two words are one."""
    if isinstance(one, (int, float)) and isinstance(other, (int, float)):
        return one == other or abs(one - other) <= CLOSE * max(1.0, abs(one), abs(other))
    return bool(one == other)


def main() -> None:
    """Compare two folders; the exit code is 1 if they differ."""
    one, other = (answer(Path(name)) for name in sys.argv[1:3])
    apart = [key for key in sorted(one.keys() | other.keys()) if not is_same(one.get(key), other.get(key))]
    for key in apart[:10]:
        print(f"{key}: {one.get(key)} and {other.get(key)}")
    print(f"{len(one)} figures, {len(apart)} of them apart")
    sys.exit(bool(apart))


if __name__ == "__main__":
    main()
