"""OBJ files: the polygons of all objects and groups together."""

from __future__ import annotations

import re

import numpy as np

from core.geometry.mesh import Faces, Indices
from core.progress import Progress
from core.scan.readers.colors import UNREADABLE, with_colors
from core.scan.readers.raw_scan import Colours, RawScan, check_size, fans
from core.scan.readers.text_table import Growing, Lines, Table, blocks, lines_of, table, whole

MRGB = b"#MRGB"
"""A comment with the colours of vertices in order, of each eight hexadecimal digits: mask and RGB."""

_PAINT = re.compile(rb"(?<!\S)" + MRGB + rb"\b[ \t]*((?:[\da-fA-F]{2})*)")


def read_obj(name: str, data: bytes, progress: Progress) -> RawScan:
    """Read an OBJ file. Raises ScanError, ValueError if it is damaged.

    Corners may count from the first vertex (1, 2, ...) or back from the latest one (-1, -2, ...). Normals
    count only if there are as many as vertices: of a point cloud. Colours are those behind the coordinates of
    a vertex, or in comments as ZBrush writes them. Source: Wavefront's OBJ format.
    """
    check_size(name, max(data.count(b"\nv "), data.count(b"\nvn ")), data.count(b"\nf "))  # at once
    if b"\\\n" in data or b"\\\r\n" in data:
        data = re.sub(rb"\\\r?\n", b" ", data)
    vertices, normals, faces = Growing("d"), Growing("d"), Growing("q")
    behind, painted, points = Growing("d"), Growing("B"), 0
    for block in blocks(name, data, progress):
        for digits in _PAINT.findall(block) if MRGB in block else ():
            painted.add(np.frombuffer(bytes.fromhex(digits.decode()), dtype=np.uint8))
        lines = lines_of(block)
        at = lines.marked(b"v")
        rows = table(lines.picked(at, 1))
        vertices.add(rows.columns(0, 3))
        _add_colours(behind, points, rows)
        normals.add(table(lines.picked(lines.marked(b"vn"), 2)).columns(0, 3))
        faces.add(_polygons(name, lines, points + np.cumsum(at)))
        points += int(at.sum())
        check_size(name, max(points, len(normals) // 3), len(faces) // 3, len(data))
    directions = normals.array().reshape(-1, 3)
    colours = _colours(points, behind, painted)
    lost = colours is None and MRGB in data and _PAINT.search(data) is not None
    return RawScan(
        vertices.array().reshape(-1, 3),
        faces.array().reshape(-1, 3),
        directions if len(directions) == points else None,
        colours,
        (UNREADABLE,) if lost else (),
    )


def _add_colours(behind: Growing, points: int, rows: Table) -> None:
    """Append the numbers behind the coordinates of vertices after ``points`` others, NaN for none."""
    has = rows.counts >= 6
    if not has.any():
        return
    values = np.full((len(has), 3), np.nan)
    values[has] = rows.numbers[rows.starts[has, None] + np.arange(3, 6)]
    behind.add(np.full(3 * points - len(behind), np.nan))
    behind.add(values)


def _colours(points: int, behind: Growing, painted: Growing) -> Colours | None:
    """Return the colours of all vertices, shape (points, 4), None without any."""
    if points and len(painted) == 4 * points:
        paint = painted.array().reshape(-1, 4)
        colours = np.ascontiguousarray(np.roll(paint, -1, axis=1))
        colours[:, 3] = np.where(colours[:, 3] > 0, 255, 0)
        return colours
    if not len(behind):
        return None
    behind.add(np.full(3 * points - len(behind), np.nan))
    return with_colors(behind.array().reshape(-1, 3))


def _polygons(name: str, lines: Lines, known: Indices) -> Faces:
    """Return the triangles of one block; ``known`` tells how many vertices stand above each of its lines."""
    chosen = lines.marked(b"f")
    text = lines.picked(chosen, 1)
    if b"/" in text:
        text = re.sub(rb"/[^\s]*", b"", text)
    found = table(text)
    corners = whole(found.numbers)
    check_size(name, 0, int(np.maximum(found.counts - 2, 0).sum()))
    if (corners == 0).any():
        raise ValueError("a corner without a number")
    last = np.repeat(known[chosen], found.counts)
    return fans(np.where(corners > 0, corners - 1, corners + last), found.counts)
