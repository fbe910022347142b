"""The file of the designs of a run, ``design.json`` beside its results: written, read and compared."""

from __future__ import annotations

import json
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from app.batch.batch_design import SCHEMA_VERSION, BatchDesign, content_key, design_of_data
from app.batch.schema import DESIGN
from core import __version__
from core.errors import ProjectError, UserError, reason_of
from core.files.atomic_write import write_text
from core.files.regular_file import read_text
from core.messages import Message

_LARGEST = 50_000_000  # bytes of a file of designs


def write_designs(path: Path, designs: Sequence[BatchDesign], *, private: bool = False) -> None:
    """Write the designs of a run with all versions that its results depend on. Raises UserError."""
    values = {
        "key": content_key(designs),
        "busk_version": __version__,
        "schema_version": SCHEMA_VERSION,
        "designs": [each.as_data() for each in designs],
    }
    write_text(path, json.dumps(values, indent=1) + "\n", private=private)


def is_design_file(path: str) -> bool:
    """Return whether a path is that of a file of designs, as ``write_designs`` writes it."""
    with suppress(OSError, ValueError):
        return path.lower().endswith(".json") and isinstance(_values(Path(path)).get("designs"), list)
    return False


def read_designs(path: Path) -> list[BatchDesign]:
    """Return the designs of a run. Raises UserError."""
    try:
        return [design_of_data(each) for each in _values(path)["designs"]]
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as problem:
        raise ProjectError(
            Message("The designs in {file} cannot be read: {why}.", file=str(path), why=reason_of(problem)),
            Message("Choose the folder of a batch run."),
        ) from problem


def stored_key(folder: Path) -> str | None:
    """Return the key of the designs of the run in a folder, None if there is no such file."""
    with suppress(OSError, ValueError, KeyError, TypeError):
        return str(_values(folder / DESIGN)["key"])
    return None


def other_results_error(folder: Path) -> UserError:
    """Return the error of a folder that holds the results of another design, or of another version."""
    with suppress(OSError, ValueError, KeyError):
        values = _values(folder / DESIGN)
        if (values["busk_version"], values["schema_version"]) != (__version__, SCHEMA_VERSION):
            return other_version_error(folder)
    return UserError(
        Message("{folder} holds the results of another design.", folder=str(folder)),
        Message("Choose another folder, or remove these results with --restart."),
    )


def other_version_error(folder: Path) -> UserError:
    """Return the error of a folder that holds the results of another version of Busk."""
    return UserError(
        Message("{folder} holds results of another version of Busk.", folder=str(folder)),
        Message("Compute them again with busk batch --restart."),
    )


def damaged_error(folder: Path, problem: str | Message) -> UserError:
    """Return the error of a folder whose results cannot be read."""
    return UserError(
        Message("The results in {folder} are damaged: {problem}.", folder=str(folder), problem=problem),
        Message("Compute them again with busk batch --restart."),
    )


def _values(path: Path) -> dict[str, Any]:
    values = json.loads(read_text(path, _LARGEST))
    if not isinstance(values, dict):
        raise ValueError("not a file of designs")
    return values
