"""glTF files, text or binary: the triangles of all meshes, placed by their nodes."""

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
from core.geometry.mesh import Faces, Floats, Indices
from core.messages import Message
from core.progress import Progress, quiet
from core.scan.readers.colors import UNREADABLE, full_of, sampled, texture, with_colors
from core.scan.readers.raw_scan import (
    AGAIN,
    FREE,
    TIMES,
    Colours,
    RawScan,
    check_size,
    companion_file,
    fans,
    joined,
    no_faces,
    strips,
    too_much,
    vectors,
)

MOST_NODES, MOST_MARKS = 10_000, 500_000
"""Nodes or buffers of a file, and values that its text may hold."""

_MOST_IMAGES = 100
_STEP = 1 << 20
_OUTSIDE = re.compile(rb'"uri"\s*:\s*"(?!data:)')


_KINDS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}

_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}

_TRIANGLES, _STRIP, _FAN = 4, 5, 6

_DEEPEST = 100

_WHOLE = Message("Place that file in the same folder, or export everything as one GLB file.")

Json = Any

Matrix = Floats


def with_buffers(path: Path, data: bytes, most: int, progress: Progress = quiet) -> bytes:
    """Return a glTF file as text with what it keeps in files beside it, joined as GLB of ``most`` bytes.

    Of each file no more is read than the text says it uses. Names that lead out of the folder, and files
    that are not there or too large, stay as they are; so do images beyond a hundred.
    Raises OSError, ScanError, Cancelled.
    """
    if not data[:1000].lstrip(codecs.BOM_UTF8 + b" \t\r\n").startswith(b"{") or not _OUTSIDE.search(data):
        return data
    if marks(data) > MOST_MARKS:
        return data
    try:
        document = json.loads(data)
        kept, joins, where = [{"byteLength": 0}], _Joins(most - len(data)), dict[int, tuple[int, int]]()
        for k, buffer in enumerate(document["buffers"][:MOST_NODES]):
            file, size = _file_of(path, buffer.get("uri")), int(buffer["byteLength"])
            start = joins.place(file, size) if file is not None else None
            if start is None:
                where[k] = len(kept), 0
                kept.append(buffer)
            else:
                where[k] = 0, start
        images = _joined_images(path, document, joins)
        kept[0]["byteLength"] = joins.total
        for view in document["bufferViews"]:
            view["buffer"], start = where[view["buffer"]]
            view["byteOffset"] = view.get("byteOffset", 0) + start
        if images:
            document["bufferViews"] += images
        text = json.dumps({**document, "buffers": kept}).encode()
    except (OSError, ValueError, KeyError, TypeError, AttributeError, ArithmeticError, RecursionError):
        return data  # the reader tells what is wrong with it
    return _joined_glb(text, joins, progress) if joins.starts else data


class _Joins:
    """The first bytes of files that are joined, each only once, and where they start, in ``most`` bytes."""

    def __init__(self, most: int) -> None:
        self.most, self.total = most, 0
        self.starts: dict[tuple[Path, int], int] = {}

    def place(self, file: Path, size: int) -> int | None:
        """Return where the first ``size`` bytes of a file start, None if there is no room for them."""
        if (file, size) not in self.starts:
            if not 0 <= size <= self.most - self.total:
                return None
            self.starts[file, size] = self.total
            self.total += size + -size % 4
        return self.starts[file, size]


def _joined_glb(text: bytes, files: _Joins, progress: Progress) -> bytes:
    """Return a GLB file of a description and of ``files``."""
    total = files.total
    text += b" " * (-len(text) % 4)
    out = io.BytesIO()
    out.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + total))
    out.write(struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", total, b"BIN\0"))
    for file, size in files.starts:
        left = size
        with file.open("rb") as content:
            while left and (piece := content.read(min(left, _STEP))):
                progress("reading", out.tell() / (28 + len(text) + total))
                left -= out.write(piece)
        if left:
            raise cut_short(file.name)
        out.write(b"\0" * (-size % 4))
    return out.getvalue()


def _joined_images(path: Path, document: Any, joins: _Joins) -> list[Any]:
    """Join the images beside a file; return the views of them that the file then needs."""
    views = list[Any]()
    for image in document.get("images", [])[:_MOST_IMAGES]:
        file = _file_of(path, image.get("uri"))
        size = file.stat().st_size if file is not None else 0
        start = joins.place(file, size) if file is not None and size else None
        if start is not None:
            del image["uri"]
            image["bufferView"] = len(document["bufferViews"]) + len(views)
            views.append({"buffer": 0, "byteOffset": start, "byteLength": size})
    return views


def _file_of(path: Path, uri: Any) -> Path | None:
    """Return the file in the folder of ``path`` that an address means, None if there is none."""
    spelled = uri.encode() if isinstance(uri, str) else b""
    return companion_file(
        path, re.sub(rb"%([\da-fA-F]{2})", lambda code: bytes.fromhex(code[1].decode()), spelled).decode()
    )


def marks(document: bytes) -> int:
    """Return how many values a text of JSON may hold, roughly."""
    return sum(document.count(mark) for mark in (b"[", b"{", b","))


def cut_short(name: str) -> ScanError:
    """Return the refusal of a file that holds less than its header tells."""
    return ScanError(
        Message("{file} is truncated: the header declares more data than the file contains.", file=name),
        AGAIN,
    )


def read_gltf(name: str, data: bytes, progress: Progress) -> RawScan:
    """Read a glTF or GLB file. Raises ScanError, ValueError and the like if it is damaged.

    Nothing but the file itself is read: buffers in other files are put in before, by ``with_buffers``.
    Source: Khronos, glTF 2.0 specification.
    """
    document, binary = _glb(name, data) if data[:4] == b"glTF" else (data, memoryview(b""))
    if marks(document) > MOST_MARKS:
        raise too_much(name)
    reader = _Reader(name, json.loads(document), binary, len(data))
    parts, points, triangles = list[RawScan](), 0, 0
    for primitive, matrix in reader.placed():
        progress("reading", len(parts) / (len(parts) + 1))
        parts.append(reader.part(primitive, matrix))
        points, triangles = points + len(parts[-1].vertices), triangles + len(parts[-1].faces)
        check_size(name, points, triangles, len(data))
        if len(parts) > MOST_NODES:
            raise too_much(name)
    return joined(parts)


def _packed(name: str) -> ScanError:
    return ScanError(
        Message("{file} uses an unsupported compression method.", file=name),
        Message("Export the scan without mesh compression."),
    )


def _glb(name: str, data: bytes) -> tuple[bytes, memoryview]:
    """Return the two chunks of a GLB file: the description, and what it describes."""
    if int.from_bytes(data[4:8], "little") != 2:
        raise ScanError(
            Message("{file} uses an outdated glTF version.", file=name),
            Message("Export the scan as glTF 2.0."),
        )
    whole, chunks, at = memoryview(data), dict[bytes, memoryview](), 12
    while at + 8 <= len(data):
        size = int.from_bytes(data[at : at + 4], "little")
        if at + 8 + size > len(data):
            raise cut_short(name)
        chunks.setdefault(data[at + 4 : at + 8], whole[at + 8 : at + 8 + size])
        at += 8 + size
    return bytes(chunks[b"JSON"]), chunks.get(b"BIN\0", memoryview(b""))


class _Reader:
    """What a file of ``size`` bytes describes, taken apart on demand."""

    def __init__(self, name: str, document: Json, binary: memoryview, size: int) -> None:
        self.name, self.json = name, document
        if document["asset"]["version"].split(".")[0] != "2":
            raise ScanError(
                Message("{file} uses an outdated glTF version.", file=name),
                Message("Export the scan as glTF 2.0."),
            )
        needed = document.get("extensionsRequired", [])
        if any("draco" in each or "meshopt" in each for each in needed):
            raise _packed(name)
        self._pixels: dict[int, Colours | None] = {}
        self._size = size
        self._buffers = [self._buffer(each, binary) for each in document.get("buffers", [])[:MOST_NODES]]

    def _buffer(self, buffer: Json, binary: memoryview) -> bytes | memoryview:
        uri = buffer.get("uri")
        if uri is None:
            return binary
        head, comma, _ = uri[:200].partition(",")
        if not uri.startswith("data:") or not head.endswith(";base64") or not comma:
            raise ScanError(Message("{file} stores its triangles in another file.", file=self.name), _WHOLE)
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
            if visited > MOST_NODES or depth > _DEEPEST:
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
        colours, notes = None, tuple[Message, ...]()
        try:
            colours = self._colours(primitive, len(vertices))
        except Exception:  # malformed in any way, they leave the shape as it is
            colours, notes = None, (UNREADABLE,)
        return RawScan(vertices @ turn.T + matrix[:3, 3], faces, normals, colours, notes)

    def _colours(self, primitive: Json, count: int) -> Colours | None:
        """Return the colours of the vertices of a part, else those of its texture there, None without any."""
        named = primitive["attributes"]
        if "COLOR_0" in named:
            values = self._values(named["COLOR_0"], count)
            return with_colors(values[:, :3].astype(np.float64), full_of(values.dtype) or 1.0)
        if "material" not in primitive:
            return None
        surface = self.json["materials"][primitive["material"]].get("pbrMetallicRoughness", {})
        used = surface.get("baseColorTexture")
        if used is None:
            return None
        places = self._values(named[f"TEXCOORD_{used.get('texCoord', 0)}"], count)
        return sampled(self._image(self.json["textures"][used["index"]]["source"]), places.astype(np.float64))

    def _image(self, index: int) -> Colours:
        """Return the pixels of an image, tried once. Raises ValueError."""
        if index not in self._pixels:
            self._pixels[index] = None
            image = self.json["images"][index]
            if "bufferView" in image:
                view = self.json["bufferViews"][image["bufferView"]]
                start = view.get("byteOffset", 0)
                data = bytes(self._buffers[view["buffer"]][start : start + view["byteLength"]])
            else:
                data = bytes(self._buffer(image, memoryview(b"")))
            held = sum(pixels.nbytes for pixels in self._pixels.values() if pixels is not None)
            self._pixels[index] = texture(data, FREE + TIMES * self._size - held)
        pixels = self._pixels[index]
        if pixels is None:
            raise ValueError("an image that cannot be read")
        return pixels

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

    def _values(self, index: int, needed: int | None = None) -> npt.NDArray[np.generic]:
        """Return the rows of an accessor, shape (count, width). Raises ValueError if there are others."""
        accessor = self.json["accessors"][index]
        if needed not in (None, accessor["count"]):
            raise ValueError("values for other vertices")
        kind, width = np.dtype(_KINDS[accessor["componentType"]]), _WIDTHS[accessor["type"]]
        if "sparse" in accessor or "bufferView" not in accessor:
            raise ScanError(
                Message("{file} uses an unsupported encoding.", file=self.name),
                Message("Export the scan as PLY."),
            )
        view = self.json["bufferViews"][accessor["bufferView"]]
        buffer = self._buffers[view["buffer"]]
        start, row = view.get("byteOffset", 0) + accessor.get("byteOffset", 0), kind.itemsize * width
        stride, count = view.get("byteStride", row), accessor["count"]
        if (
            min(start, count) < 0
            or stride < row
            or start + max(count - 1, 0) * stride + row * (count > 0) > len(buffer)
        ):
            raise cut_short(self.name)
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
