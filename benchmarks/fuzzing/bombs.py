"""Scans that once took gigabytes or hung, and projects that lie about their size: made by a few lines."""

from __future__ import annotations

import struct
import tempfile
import zipfile
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from core.document.storage.project_file import open_project, read_scan_file
from core.landmarks.detect import find_landmarks
from core.scan.body import body_of

SIZE = 60_000_000
"""So much [bytes] the packed ones unpack to."""

TOLD = {"unit": "mm", "up": "+z", "front": "-y"}
_FOUR = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"


def _ply(head: str, first: bytes, rest: int) -> bytes:
    """Return a packed PLY file with ``rest`` zeros at its end."""
    packer = zlib.compressobj(1, wbits=31)
    begin = f"ply\nformat binary_little_endian 1.0\n{head}end_header\n".encode() + first
    blocks = [packer.compress(bytes(1 << 20)) for _ in range(rest >> 20)]
    return packer.compress(begin) + b"".join(blocks) + packer.compress(bytes(rest & 0xFFFFF)) + packer.flush()


def _many_properties() -> bytes:
    names = "".join(f"property char {name}\n" for name in ("x", "y", "z", *(f"p{k}" for k in range(55))))
    return _ply(f"element vertex {SIZE // 58}\n{names}", b"", SIZE)


def _one_face() -> bytes:
    face = "element face 1\nproperty list int int vertex_indices\n"
    return _ply(_FOUR + face, bytes(48) + struct.pack("<i", SIZE // 4), SIZE)


def _many_elements(count: int, item: bytes) -> Callable[[], bytes]:
    def make() -> bytes:
        rows = SIZE // count // 2
        heads = "".join(f"element e{k} {rows}\nproperty list uchar uchar l\n" for k in range(count))
        return _ply(_FOUR + heads, bytes(48) + item, SIZE)

    return make


def _packed_points() -> bytes:
    points = '<Points><DataArray type="Int8" NumberOfComponents="3" format="appended" offset="0"/></Points>'
    piece = f'<PolyData><Piece NumberOfPoints="1" NumberOfPolys="0">{points}</Piece></PolyData>'
    head = f'<VTKFile type="PolyData" compressor="vtkZLibDataCompressor">{piece}'
    block = zlib.compress(bytes(SIZE))
    sizes = struct.pack("<4I", 1, SIZE, 0, len(block))
    return head.encode() + b'<AppendedData encoding="raw">_' + sizes + block + b"</AppendedData></VTKFile>"


def _one_place() -> bytes:
    corners = "v 0 0 0\n" * 2054
    faces = "".join(f"f {k % 2050 + 1} {k % 2049 + 2} {k % 2048 + 3}\n" for k in range(4000))
    return (corners + faces).encode()


SCANS: dict[str, Callable[[], bytes]] = {
    "properties.ply.gz": _many_properties,
    "face.ply.gz": _one_face,
    "elements.ply.gz": _many_elements(8, b""),
    "lists.ply.gz": _many_elements(3, b"\1\0"),
    "array.vtp": _packed_points,
    "place.obj": _one_place,
}

PROJECTS = ("stored", "deflated", "bzip2", "lzma")


def run(recipe: Any) -> str:
    """Read the scan or the project of that name."""
    if recipe in PROJECTS:
        return _lying_project(PROJECTS.index(recipe))
    body = body_of(recipe, SCANS[recipe](), **TOLD)
    find_landmarks(body)
    return "landmarks"


def _lying_project(kind: int) -> str:
    """Open a project whose design unpacks to far more than its table of contents says."""
    method = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA)[kind]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "lie.busk"
        with zipfile.ZipFile(path, "w", method) as archive, archive.open("design.json", "w") as member:
            for _ in range(SIZE >> 20 if kind else 2):
                member.write(b" " * (1 << 20))
        data, real = path.read_bytes(), (SIZE >> 20 if kind else 2) << 20
        path.write_bytes(data.replace(struct.pack("<I", real), struct.pack("<I", 500)))
        read_scan_file(open_project(path).design.scan)
    return "opened"


def simpler(recipe: Any) -> Iterator[Any]:
    """Give nothing: these are small already."""
    return iter(())
