"""OFF files, and plain lists of points."""

from __future__ import annotations

import re

import numpy as np

from core.errors import ScanError
from core.mesh import Faces
from core.progress import Progress
from core.reading.raw_scan import AGAIN, RawScan, check_size, fans, no_faces
from core.reading.text_table import Table, whole, whole_table

_HEAD = re.compile(rb"\s*(?:#[^\n]*\n\s*)*(ST)?(C)?(N)?(4)?(n)?OFF(?:\s+BINARY)?\s", re.ASCII)
_HEAD_LINES = 20


def read_off(name: str, data: bytes, progress: Progress) -> RawScan:
    """Read an OFF file, also one with colours and normals. Raises ScanError, ValueError if it is damaged.

    Source: Geomview's OFF format; three numbers a vertex, in text.
    """
    head = _HEAD.match(data[:10_000])
    if head is None:
        raise ScanError(f"{name} is not an OFF file.", AGAIN)
    if head[4] or head[5] or b"BINARY" in head[0]:
        raise ScanError(f"{name} is an OFF file of a rare kind.", "Export it as plain OFF or as PLY.")
    found = whole_table(name, data[head.end() :], progress)
    if len(found.counts) == 0 or found.counts[0] < 2:
        raise ValueError("no counts")
    points, polygons = (int(count) for count in whole(found.numbers[:2]))
    if min(points, polygons) < 0 or 1 + points + polygons > len(found.counts):
        raise ScanError(f"{name} is cut short: its header promises more than the file holds.", AGAIN)
    check_size(name, points, polygons)
    rows = found.rows(1, 1 + points)
    normals = rows.columns(3, 6) if head[3] else None
    faces = _polygons(name, found.rows(1 + points, 1 + points + polygons))
    return RawScan(rows.columns(0, 3), faces, normals)


def read_points(name: str, data: bytes, progress: Progress) -> RawScan:
    """Read a list of points, one a line: x, y, z first, blanks, commas or semicolons between.

    Lines in front of the points that hold words or a count are left out. Columns 4 to 6 are normals if they
    have length one; all else is left out. Raises ScanError, ValueError if it is damaged. Source: ours.
    """
    text = data.translate(bytes.maketrans(b",;", b"  "))
    start = 0
    for _ in range(_HEAD_LINES):
        line = text[start : start + 1000].partition(b"\n")[0]
        if _is_point(line):
            break
        start += len(line) + 1
    else:
        raise ValueError("no points")
    rows = whole_table(name, text[start:], progress)
    points = rows.columns(0, 3)
    check_size(name, len(points))
    if len(points) and rows.counts.min() >= 6:
        normals = rows.columns(3, 6)
        if (np.abs(np.linalg.norm(normals, axis=1) - 1.0) < 0.01).all():
            return RawScan(points, no_faces(), normals)
    return RawScan(points, no_faces())


def _is_point(line: bytes) -> bool:
    try:
        return len([float(word) for word in line.split()]) >= 3
    except ValueError:
        return False


def _polygons(name: str, rows: Table) -> Faces:
    if len(rows.counts) == 0:
        return no_faces()
    sizes = whole(rows.columns(0, 1)[:, 0])
    if (sizes < 0).any() or (sizes >= rows.counts).any():
        raise ValueError("a polygon with too few corners")
    check_size(name, 0, int(sizes.sum()) - 2 * len(sizes))
    before = np.repeat(np.cumsum(sizes) - sizes, sizes)
    at = np.repeat(rows.starts + 1, sizes) + np.arange(sizes.sum()) - before
    return fans(whole(rows.numbers[at]), sizes)
