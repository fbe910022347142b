"""PLY files, text or binary, with whatever elements and lists."""

from __future__ import annotations

from array import array
from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from core.errors import ScanError
from core.geometry.mesh import Faces, Floats, Indices, rows_of
from core.messages import Message
from core.progress import Progress
from core.scan.readers.colors import full_of, with_colors
from core.scan.readers.ply_header import COLOURS, CORNERS, NEEDED, NORMALS, PLACES, Element, Kind, read_header
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

_MOST_LISTS = 20_000_000
"""Lists that are gone through one by one: two of the largest number of polygons need half as many."""

Values = npt.NDArray[np.generic]


Spots = range | Indices
"""Where something stands, row after row: evenly spaced, or anywhere."""


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
