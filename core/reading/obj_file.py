"""OBJ files: the polygons of all objects and groups together."""

from __future__ import annotations

import re

import numpy as np

from core.mesh import Faces, Indices
from core.progress import Progress
from core.reading.raw_scan import RawScan, check_size, fans
from core.reading.text_table import Growing, Lines, blocks, lines_of, table, whole


def read_obj(name: str, data: bytes, progress: Progress) -> RawScan:
    """Read an OBJ file. Raises ScanError, ValueError if it is damaged.

    Corners may count from the first vertex (1, 2, ...) or back from the latest one (-1, -2, ...). Normals
    count only if there are as many as vertices: of a point cloud. Source: Wavefront's OBJ format.
    """
    check_size(name, max(data.count(b"\nv "), data.count(b"\nvn ")), data.count(b"\nf "))  # at once
    if b"\\\n" in data or b"\\\r\n" in data:
        data = re.sub(rb"\\\r?\n", b" ", data)
    vertices, normals, faces = Growing("d"), Growing("d"), Growing("q")
    points = 0
    for block in blocks(name, data, progress):
        lines = lines_of(block)
        at = lines.marked(b"v")
        vertices.add(table(lines.picked(at, 1)).columns(0, 3))
        normals.add(table(lines.picked(lines.marked(b"vn"), 2)).columns(0, 3))
        faces.add(_polygons(name, lines, points + np.cumsum(at)))
        points += int(at.sum())
        check_size(name, max(points, len(normals) // 3), len(faces) // 3, len(data))
    directions = normals.array().reshape(-1, 3)
    return RawScan(
        vertices.array().reshape(-1, 3),
        faces.array().reshape(-1, 3),
        directions if len(directions) == points else None,
    )


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
