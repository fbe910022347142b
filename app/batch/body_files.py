"""Files of one body in the output folder: the reshaped body, its picture and its report."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from app.batch.one_body import Row
from app.batch.schema import FOLDERS
from app.rendering.thumbnail import render_thumbnail
from core.document.storage.project_file import safe_name
from core.errors import UserError
from core.export.mesh import write_mesh
from core.files.atomic_write import atomic_path
from core.pipeline.solve import Solution

PICTURE_SIZE = (96, 128)
"""Width and height of a picture [px]."""

_CLAY = (214, 178, 158)
_TURN = np.radians(30.0)
_TURNED = np.array(
    [[np.cos(_TURN), -np.sin(_TURN), 0.0], [np.sin(_TURN), np.cos(_TURN), 0.0], [0.0, 0.0, 1.0]]
)

Writer = Callable[[Solution, Path, str], object]
"""Writes the file of a solution to a path, in a manner of its kind, such as the language of a report."""


@dataclass(frozen=True)
class BodyFiles:
    """Writes the kinds of files that are ``wanted``, each with its manner, below the folder ``out``."""

    out: Path
    wanted: Mapping[str, str]
    writers: Mapping[str, Writer]

    def write(self, solution: Solution, scan: str, variant: str) -> Row:
        """Write the files of a body; one that cannot be written is a sentence in ``doubts``."""
        row: Row = {}
        for kind, manner in self.wanted.items():
            folder, ending = FOLDERS[kind]
            name = f"{folder}/{_stem(scan, variant)}{ending}"
            try:
                (self.out / folder).mkdir(exist_ok=True)
                self.writers[kind](solution, self.out / name, manner)
            except (UserError, OSError) as problem:
                row["doubts"] = f"{row.get('doubts', '')} {problem}".strip()
            else:
                row[f"{kind}_file"] = name
        return row


def write_body(solution: Solution, path: Path, manner: str) -> None:
    """Write the reshaped body. Raises UserError."""
    write_mesh(path, solution.body)


def write_picture(solution: Solution, path: Path, manner: str) -> None:
    """Write a picture of the reshaped body, seen from the front and its left. Raises UserError."""
    picture = render_thumbnail(solution.body, _TURNED, PICTURE_SIZE, _CLAY)
    with atomic_path(path) as partial:
        Image.fromarray(picture).save(partial, "PNG")


WRITERS: Mapping[str, Writer] = {"body": write_body, "picture": write_picture}
"""What writes each kind of file that needs no window."""


def packed_files(row: Row, out: Path) -> Row:
    """Return a row with the bytes of its files below ``out``, by kind: they travel with it."""
    names = {kind: row[f"{kind}_file"] for kind in FOLDERS if row.get(f"{kind}_file")}
    return {**row, "files": {kind: (out / name).read_bytes() for kind, name in names.items()}}


def unpacked_files(row: Row, out: Path) -> Row:
    """Write the files that came with a row below ``out``, and return the row without them."""
    files: Mapping[str, Any] = row.get("files", {})
    for kind, data in files.items():
        target = out / FOLDERS[kind][0] / Path(row[f"{kind}_file"]).name
        target.parent.mkdir(exist_ok=True)
        with atomic_path(target) as partial:
            partial.write_bytes(data)
    return {name: value for name, value in row.items() if name != "files"}


def _stem(scan: str, variant: str) -> str:
    """Return a file name that is valid on every system and differs for each scan and variant."""
    digest = hashlib.sha256(f"{scan}\n{variant}".encode()).hexdigest()[:8]
    return f"{safe_name(Path(scan).stem)[:40].strip()}-{digest}"
