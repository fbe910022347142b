"""Simpler cases: what can be left out of a recipe, so that what is kept of a failure is small."""

from __future__ import annotations

import base64
from collections.abc import Iterator
from typing import Any

MOST_BYTES = 200_000


def without_chunks(data: bytes) -> Iterator[bytes]:
    """Give the data without each of its halves, quarters and so on."""
    size = len(data) // 2
    while size and len(data) <= MOST_BYTES:
        yield from (data[:at] + data[at + size :] for at in range(0, len(data), size))
        size //= 2 if size > len(data) // 64 else size + 1


def without_items(items: list[Any]) -> Iterator[list[Any]]:
    """Give a list without each of its items."""
    yield from (items[:k] + items[k + 1 :] for k in range(len(items)))


def packed(data: bytes) -> str:
    """Return bytes as text."""
    return base64.b64encode(data).decode()


def unpacked(text: str) -> bytes:
    """Return the bytes of ``packed``."""
    return base64.b64decode(text)
