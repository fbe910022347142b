"""VTP files: polygonal data of VTK in XML."""

from __future__ import annotations

import base64
import zlib
from dataclasses import dataclass, field
from xml.parsers import expat

import numpy as np
import numpy.typing as npt

from core.errors import ScanError
from core.geometry.mesh import Faces, Indices
from core.messages import Message
from core.progress import Progress, quiet
from core.scan.readers.raw_scan import (
    RawScan,
    all_faces,
    check_packed,
    check_size,
    fans,
    joined,
    strips,
    vectors,
)
from core.scan.readers.text_table import all_numbers, whole

Values = npt.NDArray[np.generic]

_TYPES = {
    f"{kind}{size}": f"{kind[0].lower()}{size // 8}"
    for kind in ("Int", "UInt", "Float")
    for size in (8, 16, 32, 64)
}
_STEP = 1 << 20
_DEEPEST = 20
_MOST_PARTS = 1000
_MOST_ARRAYS, _MOST_BLOCKS = 10_000, 100_000
_LONGEST_TAG = 1 << 24
_PLAIN = Message("Export the scan again from the scanning program, without compression or as PLY.")


@dataclass(eq=False)
class _Array:
    settings: dict[str, str]
    text: list[str] = field(default_factory=list)


@dataclass(eq=False)
class _Piece:
    """One part of the surface: what belongs to its points, and its arrays under section and name."""

    settings: dict[str, str]
    normals: str = ""
    arrays: dict[tuple[str, str], _Array] = field(default_factory=dict)


class _Outline:
    """The elements of the file that matter, as they come by."""

    def __init__(self) -> None:
        self.head: dict[str, str] = {}
        self.pieces: list[_Piece] = []
        self._open: list[str] = []
        self._array: _Array | None = None
        self._arrays = 0

    def start(self, tag: str, settings: dict[str, str]) -> None:
        self._open.append(tag)
        if len(self._open) > _DEEPEST or len(self.pieces) > _MOST_PARTS:
            raise ValueError("too deep")
        self._array = None  # what stands within an array belongs to it, but is no part of its numbers
        if tag == "VTKFile":
            self.head = settings
        elif tag == "Piece":
            self.pieces.append(_Piece(settings))
        elif tag == "PointData" and self.pieces:
            self.pieces[-1].normals = settings.get("Normals", "")
        elif tag == "DataArray" and self.pieces:
            section = self._open[-2]
            name = settings.get("Name", "") if section != "Points" else ""
            self._arrays += 1
            if self._arrays > _MOST_ARRAYS:
                raise ValueError("too many arrays")
            self._array = self.pieces[-1].arrays.setdefault((section, name), _Array(settings))

    def end(self, tag: str) -> None:
        self._open.pop()
        self._array = None

    def letters(self, text: str) -> None:
        if self._array is not None:
            self._array.text.append(text)

    def refuse(self, *_: object) -> None:
        raise ValueError("a document with its own entities")


def read_vtp(name: str, data: bytes, progress: Progress) -> RawScan:
    """Read a VTP file: text, base64 or raw, also compressed by zlib. Raises ScanError, ValueError if damaged.

    Own reader: that of VTK reserves whatever memory a file asks for, reports faults to the console only, and
    core loads no VTK. Source: VTK's XML formats.
    """
    at = data.find(b"<AppendedData")
    end = data.index(b">", at) if at >= 0 else len(data)
    outline = _Outline()
    parser = expat.ParserCreate()
    parser.buffer_text = True
    parser.StartElementHandler, parser.EndElementHandler = outline.start, outline.end
    parser.CharacterDataHandler = outline.letters
    parser.StartDoctypeDeclHandler = parser.EntityDeclHandler = outline.refuse
    stop = at if at >= 0 else end
    for start in range(0, stop, _STEP):
        progress("reading", 0.5 * start / len(data))
        parser.Parse(data[start : min(start + _STEP, stop)], at < 0 and start + _STEP >= end)
        if start - parser.CurrentByteIndex > _LONGEST_TAG:  # each step would look at all of it again
            raise ValueError("a tag without an end")
    if outline.head.get("type") != "PolyData" or not outline.pieces:
        raise ScanError(
            Message("{file} is not a VTP surface file.", file=name),
            Message("Export the surface as VTP or PLY."),
        )
    values = _Values(name, outline.head, data, data.find(b"_", end) + 1, b'"raw"' in data[at:end])
    parts, points, triangles = list[RawScan](), 0, 0
    for piece in outline.pieces:
        parts.append(_scan(name, piece, values, len(data)))
        points, triangles = points + len(parts[-1].vertices), triangles + len(parts[-1].faces)
        check_size(name, points, triangles, len(data))
    return joined(parts)


def _scan(name: str, piece: _Piece, values: _Values, size: int) -> RawScan:
    count, *polygons = (
        int(piece.settings.get(f"NumberOf{what}", "0")) for what in ("Points", "Polys", "Strips")
    )
    check_size(name, count, sum(polygons), size)
    vertices = vectors(values.of(piece.arrays["Points", ""], 3 * count)) if count else np.empty((0, 3))
    faces = list[Faces]()
    for section, cut, wanted in zip(("Polys", "Strips"), (fans, strips), polygons, strict=True):
        if wanted:
            ends = values.whole(piece.arrays[section, "offsets"], wanted)
            check_size(name, 0, int(ends[-1]) - 2 * wanted, size)
            corners = values.whole(piece.arrays[section, "connectivity"], int(ends[-1]))
            faces.append(cut(corners, np.diff(ends, prepend=0)))
    given = piece.arrays.get(("PointData", piece.normals))
    normals = vectors(values.of(given, 3 * count)) if given else None
    return RawScan(vertices, all_faces(faces), normals)


class _Values:
    """The numbers behind the arrays of a file, however they are written."""

    def __init__(self, name: str, head: dict[str, str], data: bytes, start: int, raw: bool) -> None:
        self._order = ">" if head.get("byte_order") == "BigEndian" else "<"
        self._size = np.dtype(self._order + _TYPES[head.get("header_type", "UInt32")])
        self._compressed = "compressor" in head
        self._name, self._data, self._start, self._raw = name, data, start, raw
        if head.get("compressor", "vtkZLibDataCompressor") != "vtkZLibDataCompressor":
            raise ScanError(Message("{file} uses an unsupported compression method.", file=name), _PLAIN)

    def of(self, array: _Array, count: int) -> Values:
        """Return the ``count`` numbers of an array, shape (count,)."""
        values = self._read(array)
        if len(values) != count:
            raise ValueError("an array of the wrong size")
        return values

    def _read(self, array: _Array) -> Values:
        form = array.settings.get("format", "ascii")
        kind = np.dtype(self._order + _TYPES[array.settings["type"]])
        if form == "ascii":
            return all_numbers("".join(array.text).encode(), quiet)
        if form == "binary":
            source = _Source("".join("".join(array.text).split()).encode(), 0, False)
        else:
            source = _Source(self._data, self._start + int(array.settings["offset"]), self._raw)
        return np.frombuffer(self._unpacked(source) if self._compressed else self._plain(source), kind)

    def whole(self, array: _Array, count: int) -> Indices:
        """Return the ``count`` numbers of an array of whole numbers."""
        values = self.of(array, count)
        return values.astype(np.int64) if values.dtype.kind in "iu" else whole(values.astype(np.float64))

    def _plain(self, source: _Source) -> bytes:
        width = self._size.itemsize
        size = int(np.frombuffer(source.peek(width), self._size)[0])
        return source.take(width + size)[width:]

    def _unpacked(self, source: _Source) -> bytes:
        width = self._size.itemsize
        count = int(np.frombuffer(source.peek(width), self._size)[0])
        if count > _MOST_BLOCKS:
            raise ValueError("too many blocks")
        _, size, last, *lengths = np.frombuffer(source.take((3 + count) * width), self._size).tolist()
        sizes = [size] * count
        if count and last:
            sizes[-1] = last
        check_packed(self._name, sum(sizes), sum(lengths))
        packed, parts, at = source.take(sum(lengths)), [], 0
        for size, length in zip(sizes, lengths, strict=True):
            parts.append(zlib.decompressobj().decompress(packed[at : at + length], size + 1))
            at += length
        if [len(part) for part in parts] != sizes:
            raise ValueError("a block of the wrong size")
        return b"".join(parts)


class _Source:
    """Bytes from a place in the file on, raw or in base64, each ``take`` of which was written by itself."""

    def __init__(self, data: bytes, at: int, raw: bool) -> None:
        self._data, self._at, self._raw = data, at, raw

    def take(self, size: int) -> bytes:
        """Return the next bytes. Raises ValueError if there are not as many."""
        taken = self.peek(size)
        self._at += size if self._raw else -(-size // 3) * 4
        return taken

    def peek(self, size: int) -> bytes:
        """Return the next bytes and stay in front of them."""
        if not 0 <= size <= len(self._data):
            raise ValueError("data beyond the end of the file")
        letters = self._data[self._at : self._at + (size if self._raw else -(-size // 3) * 4)]
        taken = letters if self._raw else base64.b64decode(letters, validate=True)[:size]
        if len(taken) != size:
            raise ValueError("data beyond the end of the file")
        return taken
