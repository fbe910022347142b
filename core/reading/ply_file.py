"""PLY files, text or binary, with whatever elements and lists."""

from __future__ import annotations

from array import array
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
import numpy.typing as npt

from core.errors import ScanError
from core.mesh import Floats, Indices
from core.progress import Progress
from core.reading.raw_scan import AGAIN, RawScan, check_size, fans, no_faces, strips
from core.reading.text_table import whole, whole_table

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
_MOST_PROPERTIES = 1000

Kind = np.dtype[np.generic]
Values = npt.NDArray[np.generic]


@dataclass(frozen=True)
class _Property:
    name: str
    item: Kind
    count: Kind | None  # of a list


@dataclass(frozen=True)
class _Element:
    name: str
    rows: int
    properties: tuple[_Property, ...]

    def least(self, text: bool) -> int:
        """Return the least that a row takes [bytes]; a polygon has three corners."""
        size = 0
        for each in self.properties:
            items = 1 if each.count is None else 3 * (self.name == "face" and each.name.startswith("vert"))
            size += 2 * (items + (each.count is not None)) if text else items * each.item.itemsize
            size += each.count.itemsize if each.count is not None and not text else 0
        return size


class _Content:
    """What stands after the header: bytes, or the numbers of a text, in which each takes one place."""

    def __init__(self, values: Values, order: str) -> None:
        self.values, self.text = values, not order
        self._raw = memoryview(values)  # type: ignore[arg-type]
        self._order: Literal["big", "little"] = "big" if order == ">" else "little"

    def size(self, kind: Kind | None) -> int:
        return 0 if kind is None else 1 if self.text else kind.itemsize

    def at(self, places: Indices, items: int, kind: Kind) -> Values:
        """Return ``items`` values in a row from each place, shape (places, items)."""
        taken: Values = self.values[places[:, None] + np.arange(items * self.size(kind))]
        return taken if self.text or items == 0 else taken.view(kind)

    def count_at(self, place: int, kind: Kind) -> int:
        """Return how many items the list has whose count stands there."""
        if place >= len(self.values):
            raise ValueError("a row beyond the end")
        if self.text:
            count = int(self._raw[place])
        else:
            count = int.from_bytes(
                self._raw[place : place + kind.itemsize], self._order, signed=kind.kind == "i"
            )
        if count < 0:
            raise ValueError("a list of less than nothing")
        return count


def read_ply(name: str, data: bytes, progress: Progress) -> RawScan:
    """Read a PLY file. Raises ScanError, ValueError if it is damaged.

    Polygons of any number of corners and strips of triangles become triangles; colours and all else that is
    no position, corner or normal is passed over. Source: Turk 1994, the PLY polygon file format.
    """
    order, elements, start = _header(name, data)
    least = sum(each.rows * each.least(not order) for each in elements)
    if least > len(data) - start + (not order):  # the last number of a text needs no blank behind it
        raise ScanError(f"{name} is cut short: its header promises more than the file holds.", AGAIN)
    for each in elements:
        check_size(name, *((each.rows, 0) if each.name == "vertex" else (0, each.rows)))
    values = (
        np.frombuffer(data, np.uint8)[start:] if order else whole_table(name, data[start:], progress).numbers
    )
    content = _Content(values, order)
    found: dict[str, _Table] = {}
    place = 0
    for element in elements:
        places, place = _places(element, content, place, progress)
        found.setdefault(element.name, _Table(element, content, places))
    if place > len(values):
        raise ValueError("a row beyond the end")
    return _scan(found)


def _header(name: str, data: bytes) -> tuple[str, list[_Element], int]:
    """Return the order of the bytes, "" for text, what the file holds, and where that begins."""
    newline = b"\r\n" if data[:5] == b"ply\r\n" else data[3:4]
    end = data.find(newline + b"end_header", 0, _HEAD_BYTES)
    if data[:3] != b"ply" or newline not in (b"\n", b"\r", b"\r\n") or end < 0:
        raise ScanError(f"{name} is not a PLY file, or its header is cut short.", AGAIN)
    start = data.find(newline, end + 1)
    try:
        order, elements = _elements(data[:end].decode("latin-1").replace("\r", "\n").split("\n"))
    except (IndexError, KeyError, ValueError) as problem:
        raise ScanError(f"{name} has a header that makes no sense.", AGAIN) from problem
    return order, elements, start + len(newline) if start >= 0 else len(data)


def _elements(lines: list[str]) -> tuple[str, list[_Element]]:
    order, elements = None, list[_Element]()
    for line in lines:
        words = line.split()
        if words[:1] == ["format"]:
            order = _ORDERS[words[1]]
        elif words[:1] == ["element"]:
            elements.append(_Element(words[1], int(words[2]), ()))
        elif words[:1] == ["property"]:
            kinds = [np.dtype((order or "<") + _TYPES[word]) for word in words[1:-1] if word != "list"]
            is_list = words[1] == "list"
            if len(kinds) != 1 + is_list or (is_list and kinds[0].kind == "f"):
                raise ValueError("a property of no kind")
            known = elements[-1].properties
            new = _Property(words[-1], kinds[-1], kinds[0] if is_list else None)
            elements[-1] = replace(elements[-1], properties=(*known, new))
    if order is None or any(e.rows < 0 or len(e.properties) > _MOST_PROPERTIES for e in elements):
        raise ValueError("no format, or a count below zero")
    return order, elements


def _places(
    element: _Element, content: _Content, place: int, progress: Progress
) -> tuple[list[Indices], int]:
    """Return where the values of each property (of a list: its count) begin, and where the rows end."""
    if element.rows == 0 or not element.properties:
        return [np.empty(0, dtype=np.int64) for _ in element.properties], place
    offsets, size = list[int](), 0
    for each in element.properties:
        offsets.append(size)
        items = 1 if each.count is None else content.count_at(place + size, each.count)
        size += content.size(each.count) + items * content.size(each.item)
    end = place + size * element.rows
    if end <= len(content.values):
        first = place + size * np.arange(element.rows)
        places = [first + offset for offset in offsets]
        lists = [(at, each.count) for at, each in zip(places, element.properties, strict=True) if each.count]
        if all(np.ptp(content.at(at, 1, count)) == 0 for at, count in lists):
            return places, end
    if all(each.count is None for each in element.properties):
        raise ValueError("rows beyond the end")
    return _walk(element, content, place, progress)


def _walk(element: _Element, content: _Content, place: int, progress: Progress) -> tuple[list[Indices], int]:
    """Go through rows of different lengths one by one; see ``_places``."""
    gap, lists = 0, list[tuple[int, Kind, int]]()
    spots = list[tuple[int, int]]()  # of each property: after which list, and how far
    for each in element.properties:
        spots.append((len(lists), gap))
        if each.count is None:
            gap += content.size(each.item)
        else:
            lists.append((gap, each.count, content.size(each.item)))
            gap = 0
    begins = [array("q") for _ in range(len(lists) + 1)]
    for row in range(element.rows):
        for begin, (before, kind, item) in zip(begins, lists, strict=False):
            begin.append(place)
            place += before
            place += content.size(kind) + item * content.count_at(place, kind)
        begins[-1].append(place)
        place += gap
        if row % 50_000 == 0:
            progress("reading", place / len(content.values))
    begin_of = [np.frombuffer(begin, dtype=np.int64) for begin in begins]
    return [begin_of[segment] + offset for segment, offset in spots], place


@dataclass(frozen=True, eq=False)
class _Table:
    """The rows of one element, and where in them the values of each property begin."""

    element: _Element
    content: _Content
    places: list[Indices]

    def columns(self, *names: str) -> Floats | None:
        """Return some properties that are no lists, shape (rows, names); None if one of them is not there."""
        properties = zip(self.element.properties, self.places, strict=True)
        known = {each.name: (at, 1, each.item) for each, at in properties if each.count is None}
        if not known.keys() >= set(names):
            return None
        return np.stack([self.content.at(*known[name])[:, 0].astype(np.float64) for name in names], axis=1)

    def corners(self) -> tuple[Indices, Indices]:
        """Return the list of vertices, row after row, and how many each row has."""
        for each, at in zip(self.element.properties, self.places, strict=True):
            if each.count is not None and each.name.startswith("vert"):
                counts = _whole(self.content.at(at, 1, each.count)[:, 0])
                return self._items(at + self.content.size(each.count), counts, each.item), counts
        return np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64)

    def _items(self, starts: Indices, counts: Indices, kind: Kind) -> Indices:
        ends = np.cumsum(counts)
        items = np.empty(int(counts.sum()), dtype=np.int64)
        for count in np.unique(counts).tolist():
            same = counts == count
            into = (ends[same] - count)[:, None] + np.arange(count)
            items[into] = _whole(self.content.at(starts[same], count, kind))
        return items


def _whole(values: Values) -> Indices:
    return values.astype(np.int64) if values.dtype.kind in "iu" else whole(values.astype(np.float64))


def _scan(found: dict[str, _Table]) -> RawScan:
    vertices = found["vertex"].columns("x", "y", "z")
    if vertices is None:
        raise ValueError("vertices without positions")
    faces = [no_faces()]
    if "face" in found:
        faces.append(fans(*found["face"].corners()))
    if "tristrips" in found:  # a corner below zero begins a new strip
        corners, counts = found["tristrips"].corners()
        strip = np.cumsum(corners < 0) + np.repeat(np.arange(len(counts)), counts)
        real = corners >= 0
        faces.append(strips(corners[real], np.bincount(strip[real])))
    return RawScan(vertices, np.concatenate(faces), found["vertex"].columns("nx", "ny", "nz"))
