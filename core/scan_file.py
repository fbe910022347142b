"""Scan files: the triangles of a PLY, OBJ or STL file as they stand there, or why they cannot be had."""

from __future__ import annotations

import warnings
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from core.errors import ScanError
from core.mesh import Faces, Points
from core.progress import Progress, quiet

FORMATS = ("ply", "obj", "stl")

AGAIN = "Export the scan again, or copy the file again."

_PLY_BYTES = {
    **dict.fromkeys(("char", "uchar", "int8", "uint8"), 1),
    **dict.fromkeys(("short", "ushort", "int16", "uint16", "float16"), 2),
    **dict.fromkeys(("int", "uint", "float", "int32", "uint32", "float32"), 4),
    **dict.fromkeys(("double", "int64", "uint64", "float64"), 8),
}


def scan_bytes(path: Path) -> bytes:
    """Return what a scan file holds. Raises ScanError."""
    try:
        return path.read_bytes()
    except FileNotFoundError:
        raise ScanError(f"There is no file {path}.", "Check the name, or choose another scan.") from None
    except OSError as problem:
        raise ScanError(
            f"{path.name} cannot be read: {problem.strerror}.", "Choose another scan."
        ) from problem


def read_triangles(name: str, data: bytes, progress: Progress = quiet) -> tuple[Points, Faces]:
    """Return the vertices, shape (n, 3) [file units], and triangles, shape (m, 3), of a scan file's bytes.

    The ending of ``name`` tells the format. All objects and groups of the file are put together; larger
    polygons are cut into triangles. Raises ScanError, Cancelled.
    """
    progress("reading", 0.0)
    kind = Path(name).suffix.lower().removeprefix(".")
    if kind not in FORMATS:
        raise ScanError(f"{name} is not a PLY, OBJ or STL file.", "Export the scan in one of these formats.")
    if not data:
        raise ScanError(f"{name} is empty.", AGAIN)
    import trimesh  # noqa: PLC0415 - half a second that only the opening of a file needs

    if kind == "ply":
        _check_ply_counts(data, name)
    elif kind == "stl":
        _check_stl_length(data, name)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            warnings.filterwarnings("error", "string or file could not be read")
            scene = trimesh.load_scene(
                BytesIO(data),
                kind,
                process=False,
                maintain_order=True,
                group_material=False,
                skip_materials=True,
                fix_texture=False,
            )
    except Exception as problem:  # a malformed file makes the reader fail in any way
        raise ScanError(
            f"{name} cannot be read: it is damaged or cut short.",
            "Export the scan again, as triangles only.",
        ) from problem
    return _put_together(list(scene.geometry.values()), name)


def _put_together(parts: list[Any], name: str) -> tuple[Points, Faces]:
    vertices, faces = np.empty((0, 3)), np.empty((0, 3), dtype=np.int64)
    for part in parts:
        corners = np.asarray(part.vertices, dtype=np.float64)
        triangles = np.asarray(getattr(part, "faces", ()), dtype=np.int64).reshape(-1, 3)
        if not np.all((triangles >= 0) & (triangles < len(corners))):
            raise ScanError(f"{name} has triangles with corners that do not exist.", AGAIN)
        if not np.array_equal(
            corners, vertices, equal_nan=True
        ):  # the groups of an OBJ file share all vertices
            triangles = triangles + len(vertices)
            vertices = np.concatenate([vertices, corners])
        faces = np.concatenate([faces, triangles])
    if len(faces) == 0:
        points = f"; it is a cloud of {len(vertices):,} points" if len(vertices) else ""
        raise ScanError(
            f"{name} has no triangles{points}.", "Mesh the points first, in the program of the scanner."
        )
    return vertices, faces


def _check_ply_counts(data: bytes, name: str) -> None:
    """Refuse a PLY file whose header promises more than its bytes can hold, before reserving anything."""
    end = data.find(b"end_header", 0, 1 << 20)
    if not data.startswith(b"ply") or end < 0:
        raise ScanError(f"{name} is not a PLY file, or its header is cut short.", AGAIN)
    lines = [line.split() for line in data[:end].decode("latin-1").splitlines()]
    text = ["format", "ascii"] in [line[:2] for line in lines]
    need, element, count = 0, "", 0
    try:
        if any(int(line[2]) < 0 for line in lines if line[:1] == ["element"]):
            raise ValueError("a count below zero")
        for line in lines:
            if line[:1] == ["element"]:
                element, count = line[1], int(line[2])
            elif line[:1] == ["property"]:
                need += count * _least_bytes(line, text, 3 if element == "face" else 0)
    except (IndexError, KeyError, ValueError) as problem:
        raise ScanError(f"{name} has a header that makes no sense.", AGAIN) from problem
    if need > len(data) - end - len("end_header\n"):
        raise ScanError(f"{name} is cut short: its header promises more than the file holds.", AGAIN)


def _least_bytes(line: list[str], text: bool, list_items: int) -> int:
    """Return the least that one value of a PLY property takes [bytes]; a list has ``list_items`` at least."""
    count_size, item_size = 0, _PLY_BYTES[line[1 if line[1] != "list" else 3]]
    if line[1] == "list":
        count_size = _PLY_BYTES[line[2]]
        items = list_items if "vert" in line[4] else 0
    else:
        items = 1
    return 2 * (items + (count_size > 0)) if text else count_size + items * item_size


def _check_stl_length(data: bytes, name: str) -> None:
    """Refuse an STL file that is neither whole text nor as long as its count of triangles says."""
    if b"facet" in data[:1000].lower():
        whole = b"endsolid" in data[-1000:].lower()
    else:
        whole = len(data) >= 84 and len(data) == 84 + 50 * int.from_bytes(data[80:84], "little")
    if not whole:
        raise ScanError(f"{name} is cut short, or it is not an STL file.", AGAIN)
