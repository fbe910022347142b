"""A scan as its file tells it: points, triangles and perhaps normals, before anything is repaired."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from core.errors import ScanError
from core.mesh import Faces, Indices, Points

MOST_POINTS, MOST_TRIANGLES = 10_000_000, 5_000_000
"""What a scan may hold: with more of it the memory would not last."""

AGAIN = "Export the scan again, or copy the file again."


@dataclass(frozen=True, eq=False)
class RawScan:
    """Vertices, shape (n, 3), and triangles, shape (m, 3), none for a point cloud [file units].

    ``normals``, shape (n, 3) [1], if the file holds one for every vertex.
    """

    vertices: Points
    faces: Faces
    normals: Points | None = None


def check_size(name: str, points: int, triangles: int = 0) -> None:
    """Refuse a scan that holds more than what can be worked on. Raises ScanError.

    Points that are no more than the corners of single triangles are no reason: most of them become one.
    """
    if points > max(MOST_POINTS, 3 * triangles) or triangles > MOST_TRIANGLES:
        raise ScanError(
            f"{name} is too fine: it holds {points:,} points and {triangles:,} triangles.",
            f"Thin the scan to at most {MOST_POINTS:,} points and {MOST_TRIANGLES:,} triangles.",
        )


def too_much(name: str) -> ScanError:
    """Return the refusal of a file with more in it than the finest body has."""
    return ScanError(f"{name} describes more than a scan needs.", "Export the body alone.")


def joined(parts: list[RawScan]) -> RawScan:
    """Return several parts of a file as one scan; it has normals if all parts have."""
    starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
    normals = [part.normals for part in parts if part.normals is not None]
    return RawScan(
        np.concatenate([np.empty((0, 3)), *(part.vertices for part in parts)]),
        np.concatenate(
            [no_faces(), *(part.faces + start for part, start in zip(parts, starts, strict=False))]
        ),
        np.concatenate(normals) if normals and len(normals) == len(parts) else None,
    )


def no_faces() -> Faces:
    """Return no triangles, shape (0, 3)."""
    return np.empty((0, 3), dtype=np.int64)


def fans(corners: Indices, counts: Indices) -> Faces:
    """Cut polygons into triangles round their first corners, shape (m, 3).

    ``corners``, shape (sum of counts,), holds one polygon after the other, of ``counts`` corners each.
    Raises ValueError if they are fewer.
    """
    pieces = _pieces(corners, counts)
    first = np.repeat(np.cumsum(counts) - counts, pieces)
    step = np.arange(len(first)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    return np.stack([corners[first], corners[first + step + 1], corners[first + step + 2]], axis=1)


def strips(corners: Indices, counts: Indices) -> Faces:
    """Cut strips of triangles into single ones, all running the same way round, as ``fans`` does, (m, 3)."""
    pieces = _pieces(corners, counts)
    step = np.arange(pieces.sum()) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    at = np.repeat(np.cumsum(counts) - counts, pieces) + step
    odd = step % 2
    return np.stack([corners[at], corners[at + 1 + odd], corners[at + 2 - odd]], axis=1)


def _pieces(corners: Indices, counts: Indices) -> Indices:
    """Return how many triangles each polygon gives; a file may claim more corners than it holds."""
    if counts.min(initial=0) < 0 or max(counts.max(initial=0), counts.sum()) > len(corners):
        raise ValueError("a polygon beyond the end")
    return np.maximum(counts - 2, 0)


def vectors(values: npt.NDArray[np.generic]) -> Points:
    """Return rows of three from numbers of any kind that a file may hold, shape (n, 3)."""
    return np.asarray(values, dtype=np.float64).reshape(-1, 3)
