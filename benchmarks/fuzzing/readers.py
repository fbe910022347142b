"""Damaged scan files of every format: flipped bits, cuts, other numbers, heads of other files."""

from __future__ import annotations

import random
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from coloured_scans import COLOURED, MTL, picture, textured_obj
from damaged_files import damaged_file
from scan_files import CLOUDS, HOUSES

from core.scan.body import body_of
from core.scan.readers.registry import read_raw, scan_bytes
from fuzzing.simpler import packed, unpacked, without_chunks

TEXTURED = {"house.obj": textured_obj(), "house.mtl": MTL, "skin.png": picture()}
TEXTURES = 0.1
"""The share of files that are read from a folder, with a texture beside them."""

WHOLE = 0.2
"""The share of files that are not only read, but cleaned and set upright."""


def make(chance: random.Random) -> Any:
    """Return a damaged file."""
    if chance.random() < TEXTURES:
        name, data = damaged_file(chance, TEXTURED)
        return {"name": name, "data": packed(data), "told": None}
    name, data = damaged_file(chance, HOUSES | CLOUDS | COLOURED)
    told = {"unit": "mm", "up": "+z", "front": "-y"} if chance.random() < 0.5 else {}
    return {"name": name, "data": packed(data), "told": told if chance.random() < WHOLE else None}


def run(recipe: Any) -> str:
    """Read the file."""
    name, data = recipe["name"], unpacked(recipe["data"])
    if name in TEXTURED:
        return _read_textured(TEXTURED | {name: data})
    if recipe["told"] is None:
        read_raw(name, data)
        return "read"
    body_of(name, data, **recipe["told"])
    return "upright"


def _read_textured(files: dict[str, bytes]) -> str:
    with tempfile.TemporaryDirectory() as folder:
        for name, data in files.items():
            (Path(folder) / name).write_bytes(data)
        path = Path(folder) / "house.obj"
        return "read" if read_raw(path.name, scan_bytes(path)).colours is None else "coloured"


def simpler(recipe: Any) -> Iterator[Any]:
    """Give smaller files."""
    yield from (recipe | {"data": packed(data)} for data in without_chunks(unpacked(recipe["data"])))
