"""glTF files, as text or as GLB: the triangles of all meshes where their nodes put them."""

from __future__ import annotations

import base64
import codecs
import io
import json
import re
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from core.errors import ScanError
from core.mesh import Faces, Floats, Indices
from core.progress import Progress, quiet
from core.reading.raw_scan import (
    AGAIN,
    RawScan,
    check_size,
    fans,
    joined,
    no_faces,
    strips,
    too_much,
    vectors,
)

_KINDS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
_TRIANGLES, _STRIP, _FAN = 4, 5, 6
_MOST_NODES, _DEEPEST = 10_000, 100
_MOST_MARKS = 500_000
_STEP = 1 << 20
_WHOLE = "Put that file beside it, or export all as one GLB file."
_OUTSIDE = re.compile(rb'"uri"\s*:\s*"(?!data:)')

Json = Any
Matrix = Floats


def read_gltf(name: str, data: bytes, progress: Progress) -> RawScan:
    """Read a glTF or GLB file. Raises ScanError, ValueError and the like if it is damaged.

    Nothing but the file itself is read: buffers in other files are put in before, by ``with_buffers``.
    Source: Khronos, glTF 2.0 specification.
    """
    document, binary = _glb(name, data) if data[:4] == b"glTF" else (data, memoryview(b""))
    if _marks(document) > _MOST_MARKS:
        raise too_much(name)
    reader = _Reader(name, json.loads(document), binary)
    parts, points, triangles = list[RawScan](), 0, 0
    for primitive, matrix in reader.placed():
        progress("reading", len(parts) / (len(parts) + 1))
        parts.append(reader.part(primitive, matrix))
        points, triangles = points + len(parts[-1].vertices), triangles + len(parts[-1].faces)
        check_size(name, points, triangles, len(data))
        if len(parts) > _MOST_NODES:
            raise too_much(name)
    return joined(parts)


def with_buffers(path: Path, data: bytes, most: int, progress: Progress = quiet) -> bytes:
    """Return a glTF file as text with what it keeps in files beside it, joined as GLB of ``most`` bytes.

    Of each file no more is read than the text says it uses. Names that lead out of the folder, and files
    that are not there or too large, stay as they are. Raises OSError, ScanError, Cancelled.
    """
    if not data[:1000].lstrip(codecs.BOM_UTF8 + b" \t\r\n").startswith(b"{") or not _OUTSIDE.search(data):
        return data
    if _marks(data) > _MOST_MARKS:
        return data
    try:
        document, most = json.loads(data), most - len(data)
        kept, joins, where, total = [{"byteLength": 0}], list[tuple[Path, int]](), dict[int, Any](), 0
        for k, buffer in enumerate(document["buffers"][:_MOST_NODES]):
            beside, size = _beside(path, buffer.get("uri")), int(buffer["byteLength"])
            if beside is None or not 0 <= size <= most - total:
                where[k] = len(kept), 0
                kept.append(buffer)
                continue
            where[k] = 0, total
            joins.append((beside, size))
            total += size + -size % 4
        kept[0]["byteLength"] = total
        for view in document["bufferViews"]:
            view["buffer"], start = where[view["buffer"]]
            view["byteOffset"] = view.get("byteOffset", 0) + start
        text = json.dumps({**document, "buffers": kept}).encode()
    except (ValueError, KeyError, TypeError, AttributeError, ArithmeticError, RecursionError):
        return data  # the reader tells what is wrong with it
    return _joined_glb(text, joins, total, progress) if joins else data


def _joined_glb(text: bytes, files: list[tuple[Path, int]], total: int, progress: Progress) -> bytes:
    """Return a GLB file of a description and the first bytes of ``files``, which it holds only once."""
    text += b" " * (-len(text) % 4)
    out = io.BytesIO()
    out.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + total))
    out.write(struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", total, b"BIN\0"))
    for file, size in files:
        left = size
        with file.open("rb") as content:
            while left and (piece := content.read(min(left, _STEP))):
                progress("reading", out.tell() / (28 + len(text) + total))
                left -= out.write(piece)
        if left:
            raise _cut_short(file.name)
        out.write(b"\0" * (-size % 4))
    return out.getvalue()


def _beside(path: Path, uri: Any) -> Path | None:
    """Return the file in the folder of ``path`` that a plain name means, None if there is none."""
    spelled = uri.encode() if isinstance(uri, str) else b""
    name = re.sub(rb"%([\da-fA-F]{2})", lambda code: bytes.fromhex(code[1].decode()), spelled).decode()
    if not re.fullmatch(r"[^/\\:\0]{1,255}", name):
        return None
    file = (path.parent / name).resolve()
    return file if file.parent == path.parent.resolve() and file.is_file() else None


def _marks(document: bytes) -> int:
    """Return how many values a text of JSON may hold, roughly."""
    return sum(document.count(mark) for mark in (b"[", b"{", b","))


def _cut_short(name: str) -> ScanError:
    return ScanError(f"{name} is cut short: its header promises more than the file holds.", AGAIN)


def _packed(name: str) -> ScanError:
    return ScanError(
        f"{name} is compressed in a way that Busk does not read.", "Export it without mesh compression."
    )


def _glb(name: str, data: bytes) -> tuple[bytes, memoryview]:
    """Return the two chunks of a GLB file: the description, and what it describes."""
    if int.from_bytes(data[4:8], "little") != 2:
        raise ScanError(f"{name} is a glTF file of an old kind.", "Export it as glTF 2.0.")
    whole, chunks, at = memoryview(data), dict[bytes, memoryview](), 12
    while at + 8 <= len(data):
        size = int.from_bytes(data[at : at + 4], "little")
        if at + 8 + size > len(data):
            raise _cut_short(name)
        chunks.setdefault(data[at + 4 : at + 8], whole[at + 8 : at + 8 + size])
        at += 8 + size
    return bytes(chunks[b"JSON"]), chunks.get(b"BIN\0", memoryview(b""))


class _Reader:
    """What a file describes, taken apart on demand."""

    def __init__(self, name: str, document: Json, binary: memoryview) -> None:
        self.name, self.json = name, document
        if document["asset"]["version"].split(".")[0] != "2":
            raise ScanError(f"{name} is a glTF file of an old kind.", "Export it as glTF 2.0.")
        needed = document.get("extensionsRequired", [])
        if any("draco" in each or "meshopt" in each for each in needed):
            raise _packed(name)
        self._buffers = [self._buffer(each, binary) for each in document.get("buffers", [])[:_MOST_NODES]]

    def _buffer(self, buffer: Json, binary: memoryview) -> bytes | memoryview:
        uri = buffer.get("uri")
        if uri is None:
            return binary
        head, comma, _ = uri[:200].partition(",")
        if not uri.startswith("data:") or not head.endswith(";base64") or not comma:
            raise ScanError(f"{self.name} keeps its triangles in another file.", _WHOLE)
        return base64.b64decode(uri[len(head) + 1 :], validate=True)

    def placed(self) -> Iterator[tuple[Json, Matrix]]:
        """Give each part of the scene's meshes, and the matrix that puts it there, shape (4, 4)."""
        nodes = self.json.get("nodes", [])
        scenes = self.json.get("scenes", [])
        if scenes:
            roots = scenes[self.json.get("scene", 0)].get("nodes", [])
        else:
            children = {child for node in nodes for child in node.get("children", [])}
            roots = [k for k in range(len(nodes)) if k not in children]
        waiting, visited = [(root, np.eye(4), 0) for root in roots], 0
        while waiting:
            k, above, depth = waiting.pop()
            visited += 1
            if visited > _MOST_NODES or depth > _DEEPEST:
                raise too_much(self.name)
            matrix = above @ _matrix(nodes[k])
            if "mesh" in nodes[k]:
                for primitive in self.json["meshes"][nodes[k]["mesh"]]["primitives"]:
                    yield primitive, matrix
            waiting += [(child, matrix, depth + 1) for child in nodes[k].get("children", [])]

    def part(self, primitive: Json, matrix: Matrix) -> RawScan:
        """Return one part of a mesh in the frame of the scene."""
        if any("draco" in each for each in primitive.get("extensions", {})):
            raise _packed(self.name)
        named = primitive["attributes"]
        vertices = vectors(self._values(named["POSITION"]))
        turn = matrix[:3, :3]
        faces = self._faces(primitive, len(vertices))
        if np.linalg.det(turn) < 0.0:
            faces = faces[:, ::-1]
        normals = None
        if "NORMAL" in named:
            normals = vectors(self._values(named["NORMAL"])) @ np.linalg.pinv(turn)
        return RawScan(vertices @ turn.T + matrix[:3, 3], faces, normals)

    def _faces(self, primitive: Json, count: int) -> Faces:
        mode = primitive.get("mode", _TRIANGLES)
        if mode not in (_TRIANGLES, _STRIP, _FAN):
            return no_faces()
        corners: Indices = np.arange(count)
        if "indices" in primitive:
            corners = self._values(primitive["indices"]).ravel().astype(np.int64)
        if mode == _TRIANGLES:
            return corners.reshape(-1, 3)
        return (strips if mode == _STRIP else fans)(corners, np.array([len(corners)]))

    def _values(self, index: int) -> npt.NDArray[np.generic]:
        """Return the rows of an accessor, shape (count, width)."""
        accessor = self.json["accessors"][index]
        kind, width = np.dtype(_KINDS[accessor["componentType"]]), _WIDTHS[accessor["type"]]
        if "sparse" in accessor or "bufferView" not in accessor:
            raise ScanError(f"{self.name} is written in a way that Busk does not read.", "Export it as PLY.")
        view = self.json["bufferViews"][accessor["bufferView"]]
        buffer = self._buffers[view["buffer"]]
        start, row = view.get("byteOffset", 0) + accessor.get("byteOffset", 0), kind.itemsize * width
        stride, count = view.get("byteStride", row), accessor["count"]
        if (
            min(start, count) < 0
            or stride < row
            or start + max(count - 1, 0) * stride + row * (count > 0) > len(buffer)
        ):
            raise _cut_short(self.name)
        check_size(self.name, count // (1 if width == 3 else 3))
        values = np.ndarray((count, width), kind, buffer, start, (stride, kind.itemsize)).copy()
        if accessor.get("normalized") and kind.kind in "iu":
            return values.astype(np.float64) / np.iinfo(kind).max
        return values


def _matrix(node: Json) -> Matrix:
    """Return how a node is placed under the one above it, shape (4, 4)."""
    if "matrix" in node:
        return np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T
    x, y, z, w = (float(part) for part in node.get("rotation", (0, 0, 0, 1)))
    turn = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    matrix = np.eye(4)
    matrix[:3, :3] = np.array(turn) * np.array(node.get("scale", (1, 1, 1)), dtype=np.float64)
    matrix[:3, 3] = np.array(node.get("translation", (0, 0, 0)), dtype=np.float64)
    return matrix
