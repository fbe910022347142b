"""STL files: triangles, each with corners of its own."""

from __future__ import annotations

import numpy as np

from core.errors import ScanError
from core.geometry.mesh import Points
from core.messages import Message
from core.progress import Progress
from core.scan.readers.raw_scan import AGAIN, RawScan, check_size
from core.scan.readers.text_table import Growing, blocks, lines_of, table

_ROW = np.dtype([("normal", "<f4", 3), ("corners", "<f4", 9), ("colour", "<u2")])
_HEAD = 84


def read_stl(name: str, data: bytes, progress: Progress) -> RawScan:
    """Read an STL file, text or binary. Raises ScanError, ValueError if it is damaged.

    What the file begins with does not count: some programs begin binary files with ``solid`` too.
    Source: 3D Systems' StereoLithography format.
    """
    count = int.from_bytes(data[80:84], "little")
    if not is_binary_stl(data) and b"facet" in data[:1000].lower():
        corners = _text_corners(name, data, progress)
    elif len(data) >= _HEAD + _ROW.itemsize * count and len(data) >= _HEAD:
        check_size(name, 3 * count, count)
        corners = np.frombuffer(data, _ROW, count, _HEAD)["corners"].reshape(-1, 3).astype(np.float64)
    else:
        raise ScanError(Message("{file} is truncated, or it is not an STL file.", file=name), AGAIN)
    return RawScan(corners, np.arange(len(corners)).reshape(-1, 3))


def is_binary_stl(data: bytes) -> bool:
    """Return whether the length of the file matches the count of its triangles."""
    return len(data) > _HEAD and len(data) == _HEAD + _ROW.itemsize * int.from_bytes(data[80:84], "little")


def _text_corners(name: str, data: bytes, progress: Progress) -> Points:
    if b"endsolid" not in data[-1000:].lower():
        raise ScanError(Message("{file} is truncated, or it is not an STL file.", file=name), AGAIN)
    found = Growing("d")
    for block in blocks(name, data, progress):
        lines = lines_of(block)
        found.add(table(lines.picked(lines.marked(b"vertex"), 6)).columns(0, 3))
        check_size(name, len(found) // 3, -(-len(found) // 9))
    return found.array().reshape(-1, 3)
