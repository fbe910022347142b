"""PLY files, text or binary, with any elements and lists."""

from __future__ import annotations

from array import array
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
import numpy.typing as npt

from core.errors import ScanError
from core.geometry.mesh import Faces, Floats, Indices, rows_of
from core.messages import Message
from core.progress import Progress
from core.scan.readers.colors import full_of, with_colors
from core.scan.readers.raw_scan import (
    AGAIN,
    BLOCK,
    Colours,
    RawScan,
    all_faces,
    check_size,
    fans,
    strips,
    too_much,
)
from core.scan.readers.text_table import whole, whole_table

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


_MOST_LISTS = 20_000_000
"""Lists that are gone through one by one: two of the largest number of polygons need half as many."""

Values = npt.NDArray[np.generic]

Spots = range | Indices
"""Where something stands, row after row: evenly spaced, or anywhere."""


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


class _Content:
    """What stands after the header: bytes, or the numbers of a text, in which each takes one place."""

    def __init__(self, values: Values, order: str) -> None:
        self.values, self.text = values, not order
        self._raw = memoryview(values)  # type: ignore[arg-type]
        self._order: Literal["big", "little"] = "big" if order == ">" else "little"

    def size(self, kind: Kind | None) -> int:
        return 0 if kind is None else 1 if self.text else kind.itemsize

    def column(self, spots: Spots, kind: Kind) -> Values:
        """Return the value at each spot, shape (spots,)."""
        if isinstance(spots, range):
            return self._rows(spots, 1, kind)[:, 0]
        ends = np.arange(1, len(spots) + 1)
        return self._picked(spots, ends - 1, ends, kind)

    def lists(self, spots: Spots, counts: Indices, kind: Kind) -> Values:
        """Return ``counts`` values in a row from each spot, one list after the other."""
        if isinstance(spots, range) and np.ptp(counts) == 0:
            return self._rows(spots, int(counts[0]), kind).ravel()
        ends = np.cumsum(counts)
        return self._picked(np.asarray(spots), ends - counts, ends, kind)

    def _rows(self, spots: range, items: int, kind: Kind) -> Values:
        """Return values that are evenly spaced as they stand in memory, shape (spots, items)."""
        kind = self.values.dtype if self.text else kind
        unit = kind.itemsize if self.text else 1
        strides = (spots.step * unit, kind.itemsize)
        return np.ndarray((len(spots), items), kind, self._raw, spots.start * unit, strides)

    def _picked(self, spots: Indices, begins: Indices, ends: Indices, kind: Kind) -> Values:
        """Return items ``begins`` to ``ends`` of a long list, each run of them from a spot on."""
        size, total = self.size(kind), int(ends[-1]) if len(ends) else 0
        picked = np.empty(total, self.values.dtype if self.text else kind)
        for start in range(0, total, BLOCK):
            stop = min(start + BLOCK, total)
            row = rows_of(ends, start, stop)
            places = spots[row] + size * (np.arange(start, stop) - begins[row])
            taken = self.values[places[:, None] + np.arange(size)]
            picked[start:stop] = (taken if self.text else taken.view(kind))[:, 0]
        return picked

    def count_at(self, place: int, kind: Kind) -> int:
        """Return how many items the list has whose count stands there."""
        if place + self.size(kind) > len(self.values):
            raise ValueError("a row beyond the end")
        if self.text:
            count = int(self._raw[place])
        elif kind.itemsize == 1:
            count = self._raw[place]
            count -= 256 * (count > 127 and kind.kind == "i")
        else:
            count = int.from_bytes(
                self._raw[place : place + kind.itemsize], self._order, signed=kind.kind == "i"
            )
        if count < 0:
            raise ValueError("a list of negative length")
        return count


def read_ply(name: str, data: bytes, progress: Progress) -> RawScan:
    """Read a PLY file. Raises ScanError, ValueError if it is damaged.

    Polygons of any number of corners and strips of triangles become triangles; all that is no position,
    corner, normal or colour of a vertex is passed over. Source: Turk 1994, the PLY polygon file format.
    """
    order, elements, start = read_header(name, data)
    least = sum(each.rows * each.least(not order) for each in elements)
    if least > len(data) - start + (not order):  # the last number of a text needs no blank behind it
        raise ScanError(
            Message("{file} is truncated: the header declares more data than the file contains.", file=name),
            AGAIN,
        )
    for each in elements:
        check_size(name, *((each.rows, 0) if each.name == "vertex" else (0, each.rows)))
    values = (
        np.frombuffer(data, np.uint8)[start:] if order else whole_table(name, data[start:], progress).numbers
    )
    content = _Content(values, order)
    found: dict[str, _Table] = {}
    place = 0
    while elements and elements[-1].name not in NEEDED:
        elements.pop()  # what stands behind all that is needed
    for element in elements:
        spots, place = _spots(name, element, content, place, progress)
        if element.name in NEEDED:
            found.setdefault(element.name, _Table(name, len(data), element, content, spots))
    if place > len(values):
        raise ValueError("a row beyond the end")
    return _scan(name, found, len(data))


def _spots(
    name: str, element: Element, content: _Content, place: int, progress: Progress
) -> tuple[list[Spots], int]:
    """Return where the values of each property (of a list: its count) begin, and where the rows end.

    Properties that are not needed may have none.
    """
    if element.rows == 0 or not element.properties:
        return [range(0) for _ in element.properties], place
    offsets, size = list[int](), 0
    for each in element.properties:
        offsets.append(place + size)
        items = 1 if each.count is None else content.count_at(place + size, each.count)
        size += content.size(each.count) + items * content.size(each.item)
    end = place + size * element.rows
    if end <= len(content.values):
        spots = [range(offset, offset + size * element.rows, size) for offset in offsets]
        lists = [(at, each.count) for at, each in zip(spots, element.properties, strict=True) if each.count]
        if all(np.ptp(content.column(at, count)) == 0 for at, count in lists):
            return list(spots), end
    count = sum(each.count is not None for each in element.properties)
    if count == 0:
        raise ValueError("rows beyond the end")
    if count * element.rows > _MOST_LISTS:
        raise too_much(name)
    return _walk(element, content, place, progress)


def _walk(element: Element, content: _Content, place: int, progress: Progress) -> tuple[list[Spots], int]:
    """Go through rows of different lengths one by one; see ``_spots``."""
    gap, lists = 0, list[tuple[int, Kind, int]]()
    spots = list[tuple[int, int]]()  # of each property: after which list, and how far
    for each in element.properties:
        spots.append((len(lists), gap))
        if each.count is None:
            gap += content.size(each.item)
        else:
            lists.append((gap, each.count, content.size(each.item)))
            gap = 0
    needed = [each.is_needed(element.name) for each in element.properties]
    kept = {after for (after, _), is_needed in zip(spots, needed, strict=True) if is_needed}
    begins = {after: array("q") for after in kept}
    steps = [
        (begins[k].append if k in kept else _forget, before, kind, content.size(kind), item)
        for k, (before, kind, item) in enumerate(lists)
    ]
    last, count_at = begins[len(lists)].append if len(lists) in kept else _forget, content.count_at
    for row in range(element.rows):
        for begin, before, kind, width, item in steps:
            begin(place)
            place += before
            place += width + item * count_at(place, kind)
        last(place)
        place += gap
        if row % 50_000 == 0:
            progress("reading", min(place / len(content.values), 1.0))
    begin_of = {after: np.frombuffer(begin, dtype=np.int64) for after, begin in begins.items()}
    return [begin_of[after] + offset if after in kept else range(0) for after, offset in spots], place


def _forget(place: int) -> None:
    """Do without the places of rows that nobody reads."""


@dataclass(frozen=True, eq=False)
class _Table:
    """The rows of one element, and where in them the values of each property begin.

    ``name`` and ``size`` [bytes] are those of the file.
    """

    name: str
    size: int
    element: Element
    content: _Content
    spots: list[Spots]

    def columns(self, names: tuple[str, ...]) -> Floats | None:
        """Return some properties that are no lists, shape (rows, names); None if one of them is not there."""
        properties = zip(self.element.properties, self.spots, strict=True)
        known = {each.name: (at, each.item) for each, at in properties if each.count is None}
        if not known.keys() >= set(names):
            return None
        columns = np.empty((self.element.rows, len(names)))
        for k, name in enumerate(names):
            columns[:, k] = self.content.column(*known[name]) if self.element.rows else 0.0
        return columns

    def colours(self) -> Colours | None:
        """Return the colours of the rows, None without any."""
        kinds = {each.name: each.item for each in self.element.properties}
        for names in COLOURS:
            values = self.columns(names)
            if values is not None:
                return with_colors(values, full_of(kinds[names[0]]))
        return None

    def corners(self) -> tuple[Indices, Indices]:
        """Return the list of vertices, row after row, and how many each row has."""
        for each, at in zip(self.element.properties, self.spots, strict=True):
            if each.count is not None and each.name.startswith(CORNERS) and self.element.rows:
                counts = _whole(self.content.column(at, each.count))
                check_size(self.name, 0, int(counts.sum()) - 2 * len(counts), self.size)
                skip = self.content.size(each.count)
                first = (
                    range(at.start + skip, at.stop + skip, at.step) if isinstance(at, range) else at + skip
                )
                return _whole(self.content.lists(first, counts, each.item)), counts
        return np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64)


def _whole(values: Values) -> Indices:
    return values.astype(np.int64) if values.dtype.kind in "iu" else whole(values.astype(np.float64))


def _scan(name: str, found: dict[str, _Table], size: int) -> RawScan:
    check_size(name, found["vertex"].element.rows, 0, size)
    vertices = found["vertex"].columns(PLACES)
    if vertices is None:
        raise ValueError("vertices without positions")
    faces = list[Faces]()
    if "face" in found:
        faces.append(fans(*found["face"].corners()))
    if "tristrips" in found:  # a corner below zero begins a new strip
        corners, counts = found["tristrips"].corners()
        strip = np.cumsum(corners < 0) + np.repeat(np.arange(len(counts)), counts)
        real = corners >= 0
        faces.append(strips(corners[real], np.bincount(strip[real])))
    rows = found["vertex"]
    return RawScan(vertices, all_faces(faces), rows.columns(NORMALS), rows.colours())
