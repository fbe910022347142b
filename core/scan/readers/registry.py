"""Scan files: what a file of any known format holds, or in one sentence why it cannot be had."""

from __future__ import annotations

import codecs
import os
import re
import zlib
from collections.abc import Callable
from pathlib import Path

import numpy as np

from core.errors import ScanError
from core.files.regular_file import open_regular
from core.geometry.mesh import Faces, Points
from core.messages import Message
from core.progress import Cancelled, Progress, quiet
from core.scan.readers.gltf import read_gltf, with_buffers
from core.scan.readers.obj import read_obj, with_texture
from core.scan.readers.off import begins_with_points, read_off, read_points
from core.scan.readers.ply import read_ply
from core.scan.readers.raw_scan import AGAIN, RawScan, check_packed, check_size
from core.scan.readers.stl import is_binary_stl, read_stl
from core.scan.readers.vtp import read_vtp

Reader = Callable[[str, bytes, Progress], RawScan]

_READERS: dict[str, Reader] = {
    "ply": read_ply,
    "obj": read_obj,
    "stl": read_stl,
    "off": read_off,
    "glb": read_gltf,
    "gltf": read_gltf,
    "vtp": read_vtp,
    **dict.fromkeys(("xyz", "pts", "txt", "csv"), read_points),
}
FORMATS = (*_READERS, "gz")
"""Endings of the files that can be read; gz stands behind one of the others."""

_SIGNS = {
    "ply": re.compile(rb"ply\r?[\n\r]"),
    "glb": re.compile(rb"glTF"),
    "vtp": re.compile(rb"(<\?xml[^>]*>\s*)?(<!--(?:(?!-->).)*-->\s*)*<VTKFile", re.DOTALL),
    "off": re.compile(rb"(ST)?C?N?OFF\s"),
    "gltf": re.compile(rb"\s*\{"),
    "stl": re.compile(rb"\s*solid\b[^\n\r]*[\n\r]+\s*facet\s", re.IGNORECASE),
    "obj": re.compile(rb"(?:[^\n\r]*[\n\r])*?[ \t]*v[ \t]+[-+.\d][^\n\r]*[\n\r]"),
}
"""How files of some formats begin, whatever they are called."""

LARGEST_FILE = 600_000_000
"""More than this [bytes] no scan needs, packed or not: as text, 2 million triangles of an STL file fit."""

MOST_MEMBERS = 10_000
"""A packed file may be packed in so many pieces; programs that pack in blocks need one for each 64 kB."""

_THINNER = Message(
    "Reduce the resolution of the scan until the file is smaller than {size} MB.",
    size=LARGEST_FILE // 1_000_000,
)
_STEP = 1 << 20


def scan_bytes(path: Path, progress: Progress = quiet) -> bytes:
    """Return what a scan file holds and keeps in files beside it. Raises ScanError, Cancelled."""
    try:
        with open(open_regular(path), "rb") as file:
            size = os.fstat(file.fileno()).st_size
            if size > LARGEST_FILE:
                raise ScanError(Message("{file} is too large.", file=path.name), _THINNER)
            data = file.read(size)
        if path.suffix.lower() == ".obj":
            return with_texture(path, data, LARGEST_FILE, progress)
        return with_buffers(path, data, LARGEST_FILE, progress)
    except FileNotFoundError:
        raise ScanError(
            Message("{file} does not exist.", file=str(path)),
            Message("Check the name, or choose another scan."),
        ) from None
    except (OSError, ValueError) as problem:
        reason = getattr(problem, "strerror", None) or Message("the file name is not valid")
        raise ScanError(
            Message("{file} cannot be read: {problem}.", file=path.name or str(path), problem=reason),
            Message("Choose another scan."),
        ) from problem


def read_triangles(name: str, data: bytes, progress: Progress = quiet) -> tuple[Points, Faces]:
    """Return the vertices, shape (n, 3), and triangles, shape (m, 3), of ``read_raw`` alone."""
    scan = read_raw(name, data, progress)
    return scan.vertices, scan.faces


def read_raw(name: str, data: bytes, progress: Progress = quiet) -> RawScan:
    """Return what the bytes of a scan file hold; a cloud of points has no triangles.

    The content tells the format, or the ending of ``name`` where it does not. All objects and groups of the
    file are put together; larger polygons are cut into triangles. Raises ScanError, Cancelled.
    """
    progress("reading", 0.0)
    if not data:
        raise ScanError(Message("{file} is empty.", file=name), AGAIN)
    try:
        if data[:2] == b"\x1f\x8b":
            data = _unpacked(name, data, progress)
        data = data.removeprefix(codecs.BOM_UTF8)
        with np.errstate(all="ignore"):
            scan = _reader(name, data)(name, data, progress)
        check_size(name, len(scan.vertices), len(scan.faces))
        if scan.faces.size and not (scan.faces.min() >= 0 and scan.faces.max() < len(scan.vertices)):
            raise ScanError(
                Message("{file} contains triangles with vertices that do not exist.", file=name), AGAIN
            )
    except (ScanError, Cancelled):
        raise
    except MemoryError:
        raise no_memory(name) from None
    except Exception as problem:  # a malformed file makes a reader fail in any way
        raise ScanError(
            Message("{file} cannot be read: the file is damaged or truncated.", file=name), AGAIN
        ) from problem
    progress("reading", 1.0)
    return scan


def no_memory(name: str) -> ScanError:
    """Return the refusal of a scan that needs more memory than there is."""
    return ScanError(
        Message("Not enough memory to open {file}.", file=name),
        Message("Close other programs, or reduce the number of points of the scan before opening it."),
    )


def _reader(name: str, data: bytes) -> Reader:
    """Return the reader that the content asks for, or else the ending of the name."""
    ending = Path(name.lower().removesuffix(".gz")).suffix.removeprefix(".")
    told = next((kind for kind, sign in _SIGNS.items() if sign.match(data[:10_000])), None)
    if is_binary_stl(data):
        told = "stl"
    elif told is None and ending != "off" and begins_with_points(data):  # OFF files may begin with counts
        told = "xyz"
    if told is None and ending not in _READERS:
        raise ScanError(
            Message("{file} is not a supported scan file.", file=name),
            Message("Export the scan as PLY, OBJ, STL, OFF, glTF, VTP or XYZ."),
        )
    return _READERS[told or ending]


def _unpacked(name: str, data: bytes, progress: Progress) -> bytes:
    """Unpack gzip, all its members, but never more than what a scan needs."""
    parts, held, at, waiting = list[bytes](), 0, 0, b""
    for _ in range(MOST_MEMBERS):
        unpacker = zlib.decompressobj(wbits=31)
        while not unpacker.eof:
            progress("reading", at / len(data))
            if not waiting:
                waiting, at = data[at : at + _STEP], at + _STEP
            if not waiting:
                raise ValueError("a truncated compressed file")
            parts.append(unpacker.decompress(waiting, 16 * _STEP))
            waiting = unpacker.unconsumed_tail
            held += len(parts[-1])
            check_packed(name, held, len(data))
            if held > LARGEST_FILE:
                raise ScanError(Message("{file} is too large after decompression.", file=name), _THINNER)
        waiting = unpacker.unused_data or data[at : at + _STEP]
        at += 0 if unpacker.unused_data else _STEP
        if not waiting.strip(b"\0"):  # some programs fill up with zeros
            break
    else:
        raise ValueError("too many compressed parts")
    if not held:
        raise ScanError(Message("{file} is empty.", file=name), AGAIN)
    return b"".join(parts)
