"""External buffers of a glTF file, joined with it to one GLB file."""

from __future__ import annotations

import codecs
import io
import json
import re
import struct
from pathlib import Path
from typing import Any

from core.errors import ScanError
from core.messages import Message
from core.progress import Progress, quiet
from core.scan.readers.raw_scan import AGAIN, companion_file

MOST_NODES, MOST_MARKS = 10_000, 500_000
"""Nodes or buffers of a file, and values that its text may hold."""

_MOST_IMAGES = 100
_STEP = 1 << 20
_OUTSIDE = re.compile(rb'"uri"\s*:\s*"(?!data:)')


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
