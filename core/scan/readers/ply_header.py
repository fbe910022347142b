"""Headers of PLY files: which elements the file holds, and in which kinds of numbers."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from core.errors import ScanError
from core.messages import Message
from core.scan.readers.raw_scan import AGAIN

_TYPES = {
    **dict.fromkeys(("char", "int8"), "i1"),
    **dict.fromkeys(("uchar", "uint8"), "u1"),
    **dict.fromkeys(("short", "int16"), "i2"),
    **dict.fromkeys(("ushort", "uint16"), "u2"),
    **dict.fromkeys(("int", "int32"), "i4"),
    **dict.fromkeys(("uint", "uint32"), "u4"),
    **dict.fromkeys(("float", "float32"), "f4"),
    **dict.fromkeys(("double", "float64"), "f8"),
    **{"float16": "f2", "int64": "i8", "uint64": "u8"},
}
_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_HEAD_BYTES = 1 << 20
_MOST_ELEMENTS, _MOST_PROPERTIES = 1000, 1000

PLACES, NORMALS, CORNERS = ("x", "y", "z"), ("nx", "ny", "nz"), "vert"
COLOURS = ("red", "green", "blue"), ("diffuse_red", "diffuse_green", "diffuse_blue")
NEEDED = {
    "vertex": (*PLACES, *NORMALS, *COLOURS[0], *COLOURS[1]),
    "face": (CORNERS,),
    "tristrips": (CORNERS,),
}
"""Elements that are read, and what the names of their properties begin with."""

Kind = np.dtype[np.generic]


@dataclass(frozen=True)
class Property:
    """One property of the rows of an element; ``count`` is the kind of the length of a list, else None."""

    name: str
    item: Kind
    count: Kind | None

    def is_needed(self, element: str) -> bool:
        """Return whether the property of an element is read."""
        return self.name.startswith(NEEDED.get(element, ()))


@dataclass(frozen=True)
class Element:
    """An element: how many rows it has, and what each of them holds."""

    name: str
    rows: int
    properties: tuple[Property, ...]

    def least(self, text: bool) -> int:
        """Return the least that a row takes [bytes]; a polygon has three corners."""
        size = 0
        for each in self.properties:
            items = 1 if each.count is None else 3 * (self.name == "face" and each.name.startswith("vert"))
            size += 2 * (items + (each.count is not None)) if text else items * each.item.itemsize
            size += each.count.itemsize if each.count is not None and not text else 0
        return size


def read_header(name: str, data: bytes) -> tuple[str, list[Element], int]:
    """Return the order of the bytes, "" for text, what the file holds, and where that begins."""
    newline = b"\r\n" if data[:5] == b"ply\r\n" else data[3:4]
    end = data.find(newline + b"end_header", 0, _HEAD_BYTES)
    if data[:3] != b"ply" or newline not in (b"\n", b"\r", b"\r\n") or end < 0:
        raise ScanError(Message("{file} is not a PLY file, or its header is truncated.", file=name), AGAIN)
    start = data.find(newline, end + 1)
    try:
        order, elements = _elements(data[:end].decode("latin-1").replace("\r", "\n").split("\n"))
    except (IndexError, KeyError, ValueError) as problem:
        raise ScanError(Message("{file} has an invalid header.", file=name), AGAIN) from problem
    return order, elements, start + len(newline) if start >= 0 else len(data)


def _elements(lines: list[str]) -> tuple[str, list[Element]]:
    order, elements = None, list[Element]()
    for line in lines:
        words = line.split()
        if words[:1] == ["format"]:
            order = _ORDERS[words[1]]
        elif words[:1] == ["element"]:
            elements.append(Element(words[1], int(words[2]), ()))
        elif words[:1] == ["property"]:
            kinds = [np.dtype((order or "<") + _TYPES[word]) for word in words[1:-1] if word != "list"]
            is_list = words[1] == "list"
            if len(kinds) != 1 + is_list or (is_list and kinds[0].kind == "f"):
                raise ValueError("a property without a type")
            known = elements[-1].properties
            new = Property(words[-1], kinds[-1], kinds[0] if is_list else None)
            elements[-1] = replace(elements[-1], properties=(*known, new))
            if len(known) == _MOST_PROPERTIES:
                raise ValueError("too many properties")
        if len(elements) > _MOST_ELEMENTS:
            raise ValueError("too many elements")
    if order is None or any(element.rows < 0 for element in elements):
        raise ValueError("no format, or a count below zero")
    return order, elements
