"""A scan as its file tells it: points, triangles and perhaps normals, before anything is repaired."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from core.errors import ScanError
from core.geometry.mesh import Faces, Indices, Points, rows_of
from core.messages import Message

MOST_POINTS, MOST_TRIANGLES = 10_000_000, 5_000_000
"""What a scan may hold: with more of it the memory would not last."""

FREE, TIMES = 32 << 20, 8
"""Points and triangles may take so much memory [bytes], and so many times as much as the file."""

PACKED_FREE, PACKED_TIMES = 16 << 20, 50
"""A packed file may unpack to so much [bytes], and so many times its size: scans have a ratio of 3 to 15."""

BLOCK = 1 << 18
"""Triangles and items of lists that are made at a time, so that what is worked out for them stays small."""

AGAIN = Message("Export the scan again, or copy the file again.")


Colours = npt.NDArray[np.uint8]
"""Red, green, blue and 255 at each vertex, or 0 where there is no colour, shape (n, 4)."""


@dataclass(frozen=True, eq=False)
class RawScan:
    """Vertices, shape (n, 3), and triangles, shape (m, 3), none for a point cloud [file units].

    ``normals``, shape (n, 3) [1], if the file holds one for every vertex; ``colours``, shape (n, 4), if it
    holds any. ``notes`` are sentences about what could not be read beside the shape.
    """

    vertices: Points
    faces: Faces
    normals: Points | None = None
    colours: Colours | None = None
    notes: tuple[Message, ...] = ()


def check_size(name: str, points: int, triangles: int = 0, size: int | None = None) -> None:
    """Refuse a scan that holds more than what can be worked on. Raises ScanError.

    Points that are no more than the corners of single triangles are no reason: most of them become one.
    A file of ``size`` bytes must not describe much more than it holds, the same over and over again.
    """
    if points > max(MOST_POINTS, 3 * triangles) or triangles > MOST_TRIANGLES:
        raise ScanError(
            Message(
                "{file} is too large: {points} points and {triangles} triangles.",
                file=name,
                points=f"{points:,}",
                triangles=f"{triangles:,}",
            ),
            Message(
                "Reduce the scan to at most {points} points and {triangles} triangles.",
                points=f"{MOST_POINTS:,}",
                triangles=f"{MOST_TRIANGLES:,}",
            ),
        )
    if size is not None and 24 * (points + triangles) > FREE + TIMES * size:
        raise too_much(name)


def check_packed(name: str, unpacked: int, packed: int) -> None:
    """Refuse ``packed`` bytes that unpack to far more than those of a scan do. Raises ScanError."""
    if unpacked > PACKED_FREE + PACKED_TIMES * packed:
        raise ScanError(
            Message(
                "{file} decompresses to more than {count} times its size, which is implausible for a scan.",
                file=name,
                count=PACKED_TIMES,
            ),
            Message("Save the scan again without compression."),
        )


def too_much(name: str) -> ScanError:
    """Return the refusal of a file with more in it than the finest body has."""
    return ScanError(
        Message("{file} contains too much data that does not belong to a scan.", file=name),
        Message("Export only the body."),
    )


def joined(parts: list[RawScan]) -> RawScan:
    """Return several parts of a file as one scan; it has normals if all parts have, colours if any has."""
    if len(parts) == 1:
        return parts[0]
    starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
    normals = [part.normals for part in parts if part.normals is not None]
    colours = None
    if any(part.colours is not None for part in parts):
        colours = np.zeros((int(starts[-1]), 4), dtype=np.uint8)
        for part, start in zip(parts, starts, strict=False):
            if part.colours is not None:
                colours[start : start + len(part.vertices)] = part.colours
    return RawScan(
        np.concatenate([np.empty((0, 3)), *(part.vertices for part in parts)]),
        np.concatenate(
            [no_faces(), *(part.faces + start for part, start in zip(parts, starts, strict=False))]
        ),
        np.concatenate(normals) if normals and len(normals) == len(parts) else None,
        colours,
        tuple(dict.fromkeys(note for part in parts for note in part.notes)),
    )


def all_faces(parts: list[Faces]) -> Faces:
    """Return the triangles of several parts, shape (m, 3); those of a single one are not copied."""
    parts = [part for part in parts if len(part)]
    return parts[0] if len(parts) == 1 else np.concatenate([no_faces(), *parts])


def no_faces() -> Faces:
    """Return no triangles, shape (0, 3)."""
    return np.empty((0, 3), dtype=np.int64)


def fans(corners: Indices, counts: Indices) -> Faces:
    """Cut polygons into triangles round their first corners, shape (m, 3).

    ``corners``, shape (sum of counts,), holds one polygon after the other, of ``counts`` corners each.
    Raises ValueError if they are fewer.
    """
    return _triangles(corners, counts, lambda first, step: (first, first + step + 1, first + step + 2))


def strips(corners: Indices, counts: Indices) -> Faces:
    """Cut strips of triangles into single ones, all running the same way round, as ``fans`` does, (m, 3)."""

    def places(first: Indices, step: Indices) -> tuple[Indices, ...]:
        at, odd = first + step, step % 2
        return at, at + 1 + odd, at + 2 - odd

    return _triangles(corners, counts, places)


def _triangles(
    corners: Indices, counts: Indices, places: Callable[[Indices, Indices], tuple[Indices, ...]]
) -> Faces:
    """Return the corners at the ``places`` of each triangle, told by its polygon's first and its number."""
    pieces = _pieces(corners, counts)
    first, ends = np.cumsum(counts) - counts, np.cumsum(pieces)
    faces = np.empty((int(pieces.sum()), 3), dtype=np.int64)
    for start in range(0, len(faces), BLOCK):
        stop = min(start + BLOCK, len(faces))
        row = rows_of(ends, start, stop)
        step = np.arange(start, stop) - (ends - pieces)[row]
        faces[start:stop] = np.stack([corners[at] for at in places(first[row], step)], axis=1)
    return faces


def _pieces(corners: Indices, counts: Indices) -> Indices:
    """Return how many triangles each polygon gives; a file may claim more corners than it holds."""
    if counts.min(initial=0) < 0 or max(counts.max(initial=0), counts.sum()) > len(corners):
        raise ValueError("a polygon beyond the end")
    return np.maximum(counts - 2, 0)


def vectors(values: npt.NDArray[np.generic]) -> Points:
    """Return rows of three from numbers of any kind that a file may hold, shape (n, 3)."""
    return np.asarray(values, dtype=np.float64).reshape(-1, 3)


def companion_file(path: Path, name: str) -> Path | None:
    """Return the file in the folder of ``path`` that a plain name means, None if there is none."""
    if not re.fullmatch(r"[^/\\:\0]{1,255}", name):
        return None
    file = (path.parent / name).resolve()
    return file if file.parent == path.parent.resolve() and file.is_file() else None
