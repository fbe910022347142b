"""Damaged scan files of every format: flipped bits, cuts, other numbers, heads of other files."""

from __future__ import annotations

import random
from collections.abc import Iterator
from typing import Any

from damaged_files import damaged_file
from scan_files import CLOUDS, HOUSES

from core.body import body_of
from core.reading.scan_file import read_raw
from fuzzing.simpler import packed, unpacked, without_chunks

WHOLE = 0.2
"""The share of files that are not only read, but cleaned and set upright."""


def make(chance: random.Random) -> Any:
    """Return a damaged file."""
    name, data = damaged_file(chance, HOUSES | CLOUDS)
    told = {"unit": "mm", "up": "+z", "front": "-y"} if chance.random() < 0.5 else {}
    return {"name": name, "data": packed(data), "told": told if chance.random() < WHOLE else None}


def run(recipe: Any) -> str:
    """Read the file."""
    name, data = recipe["name"], unpacked(recipe["data"])
    if recipe["told"] is None:
        read_raw(name, data)
        return "read"
    body_of(name, data, **recipe["told"])
    return "upright"


def simpler(recipe: Any) -> Iterator[Any]:
    """Give smaller files."""
    yield from (recipe | {"data": packed(data)} for data in without_chunks(unpacked(recipe["data"])))
