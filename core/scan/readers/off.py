"""OFF files, and plain lists of points."""

from __future__ import annotations

import re

import numpy as np

from core.errors import ScanError
from core.geometry.mesh import Faces
from core.messages import Message
from core.progress import Progress
from core.scan.readers.raw_scan import AGAIN, RawScan, check_size, fans, no_faces
from core.scan.readers.text_table import Table, whole, whole_table

_HEAD = re.compile(rb"\s*(?:#[^\n]*\n\s*)*(ST)?(C)?(N)?(4)?(n)?OFF(?:\s+BINARY)?\s", re.ASCII)
_HEAD_LINES, _LONGEST = 20, 1000


def read_off(name: str, data: bytes, progress: Progress) -> RawScan:
    """Read an OFF file, also one with colours and normals. Raises ScanError, ValueError if it is damaged.

    Own reader, of forty lines: that of trimesh takes three times as long, knows no limits and no progress.
    Source: Geomview's OFF format; three numbers a vertex, in text.
    """
    head = _HEAD.match(data[:10_000])
    if head is None:
        raise ScanError(Message("{file} is not an OFF file.", file=name), AGAIN)
    if head[4] or head[5] or b"BINARY" in head[0]:
        raise ScanError(
            Message("{file} uses an unsupported OFF variant.", file=name),
            Message("Export the scan as standard OFF or as PLY."),
        )
    found = whole_table(name, data[head.end() :], progress)
    if len(found.counts) == 0 or found.counts[0] < 2:
        raise ValueError("no counts")
    points, polygons = (int(count) for count in whole(found.numbers[:2]))
    if min(points, polygons) < 0 or 1 + points + polygons > len(found.counts):
        raise ScanError(
            Message("{file} is truncated: the header declares more data than the file contains.", file=name),
            AGAIN,
        )
    check_size(name, points, polygons, len(data))
    rows = found.rows(1, 1 + points)
    normals = rows.columns(3, 6) if head[3] else None
    faces = _polygons(name, found.rows(1 + points, 1 + points + polygons), len(data))
    return RawScan(rows.columns(0, 3), faces, normals)


def read_points(name: str, data: bytes, progress: Progress) -> RawScan:
    """Read a list of points, one a line: x, y, z first, blanks, commas or semicolons between.

    Lines in front of the points that hold words or a count are left out, and words behind them. A comma may
    be the decimal mark where something else stands between the numbers. Columns 4 to 6 are normals if they
    have length one; all else is left out. Raises ScanError, ValueError if it is damaged. Source: ours.
    """
    start = _first_point(data)
    if start is None:
        raise ScanError(
            Message("{file} is not a scan: the text contains no points.", file=name),
            Message("Choose another scan."),
        )
    data = data[start : _last_point(data)]
    check_size(name, max(data.count(b"\n"), data.count(b"\r")))  # at once: a packed file may hold very many
    between = b" ," if has_decimal_commas(name, data) else b"  "
    rows = whole_table(name, data.translate(bytes.maketrans(b";,", between)), progress)
    points = rows.columns(0, 3)
    check_size(name, len(points))
    if len(points) and rows.counts.min() >= 6:
        normals = rows.columns(3, 6)
        if (np.abs(np.linalg.norm(normals, axis=1) - 1.0) < 0.01).all():
            return RawScan(points, no_faces(), normals)
    return RawScan(points, no_faces())


def has_decimal_commas(name: str, data: bytes) -> bool:
    """Return whether the commas in a list of numbers are decimal marks. Raises ScanError if ambiguous."""
    comma = data.find(b",")
    if comma < 0:
        return False
    line = data[data.rfind(b"\n", 0, comma) + 1 :][:_LONGEST].splitlines()[0]
    words = line.replace(b";", b" ").split()
    apart = len(words) >= 3 and all(re.fullmatch(rb"[^,]+(,[^,]+)?", word) for word in words)
    if b"." not in data:
        lines = [each.split(b",") for each in data[:100_000].splitlines()[:-1] or [data]]
        halves = all(len(each) in (6, 12) and not _signed(each[1::2]) for each in lines)
        if apart or not halves:
            return apart
    elif not apart:
        return False
    raise ScanError(
        Message("In {file}, commas may be separators or decimal marks.", file=name),
        Message("Export the points with semicolons or spaces between the numbers."),
    )


def begins_with_points(data: bytes) -> bool:
    """Return whether the first line that is no comment is a point."""
    lines = data[:10_000].splitlines()[:-1]
    return _is_point(next((line for line in lines if not re.match(rb"\s*(#|$)", line)), b""))


def _signed(words: list[bytes]) -> bool:
    return any(word.strip()[:1] in (b"-", b"+") for word in words)


def _first_point(data: bytes) -> int | None:
    """Return where the first point begins among the first lines, None if none does."""
    start = 0
    for _ in range(_HEAD_LINES):
        line = data[start : start + _LONGEST].partition(b"\n")[0]
        if _is_point(line):
            return start
        start += len(line) + 1
    return None


def _last_point(data: bytes) -> int:
    """Return where the list ends: a few last lines may begin with a word."""
    end = len(data)
    for _ in range(_HEAD_LINES):
        begin = data.rfind(b"\n", max(end - _LONGEST, 0), max(end - 1, 0)) + 1
        line = data[begin:end].split()
        if begin == 0 or (line and not line[0][:1].isalpha()) or (line and _is_number(line[0])):
            break
        end = begin
    return end


def _is_number(word: bytes) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _is_point(line: bytes) -> bool:
    words = line.translate(bytes.maketrans(b",;", b"  ")).split()
    return len(words) >= 3 and all(map(_is_number, words))


def _polygons(name: str, rows: Table, size: int) -> Faces:
    if len(rows.counts) == 0:
        return no_faces()
    sizes = whole(rows.columns(0, 1)[:, 0])
    if (sizes < 0).any() or (sizes >= rows.counts).any():
        raise ValueError("a polygon with too few corners")
    check_size(name, 0, int(np.maximum(sizes - 2, 0).sum()), size)
    at = np.repeat(rows.starts + 1 - np.cumsum(sizes) + sizes, sizes)
    at += np.arange(len(at))
    return fans(whole(rows.numbers[at]), sizes)
