"""Underwires that are sold: their lengths by size, and those that are as long as a root."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources

FORMAT = 1
"""The format of ``resources/wires.json``."""


@dataclass(frozen=True)
class WireType:
    """A shape of underwires by ``name``, with ``lengths_mm`` by size and the ``source`` of these."""

    name: str
    source: str
    lengths_mm: Mapping[str, float]


@dataclass(frozen=True)
class Wire:
    """A wire of a ``kind`` and ``size``, ``length_mm`` long [mm]."""

    kind: str
    size: str
    length_mm: float


@cache
def wire_types() -> tuple[WireType, ...]:
    """Return the shapes of wires whose lengths are known."""
    values = json.loads((resources.files("resources") / "wires.json").read_text(encoding="utf-8"))
    assert values["format"] == FORMAT
    return tuple(
        WireType(each["name"], each["source"], {size: float(mm) for size, mm in each["lengths_mm"].items()})
        for each in values["types"]
    )


def nearest_wires(root_mm: float) -> tuple[Wire, ...]:
    """Return of each shape the wire whose length is nearest to that of a root [mm]."""
    found = []
    for each in wire_types():
        size, length = min(each.lengths_mm.items(), key=lambda item: abs(item[1] - root_mm))
        found.append(Wire(each.name, size, length))
    return tuple(found)
