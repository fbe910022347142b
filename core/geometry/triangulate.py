"""A polygon in the plane, cut into even triangles."""

from __future__ import annotations

import numpy as np
from scipy.spatial import Delaunay, QhullError, cKDTree

from core.geometry.mesh import Faces, Flags, Floats, Indices

TOOTH = np.radians(75.0)
"""Corners sharper than this are cut off first [rad]."""


def triangulate(outline: Floats, least: float = 0.0) -> tuple[Faces, Floats]:
    """Return triangles over the polygon ``outline``, shape (b, 2), counter-clockwise, and places inside it.

    Corners from b on are those places, shape (k, 2), about as far from each other as the corners of the
    outline, and no nearer than ``least``. Its sides are sides of triangles, whatever it looks like. Source:
    ours; ears after Meisters 1975.
    """
    rest = np.arange(len(outline))
    teeth, rest = clip_ears(outline, rest, TOOTH)
    faces, inside = _even(outline, rest, least)
    if faces is None:
        faces, inside = clip_ears(outline, rest, np.inf)[0], np.empty((0, 2))
    return np.concatenate([teeth, faces]), inside


def _even(outline: Floats, rest: Indices, least: float) -> tuple[Faces | None, Floats]:
    """Strew places evenly over the polygon of the corners ``rest`` and join all by Delaunay triangles.

    No faces are returned where these do not follow the outline.
    """
    none = np.empty((0, 2))
    if len(rest) < 5:
        return None, none
    ring = outline[rest]
    step = max(least, float(np.median(np.linalg.norm(np.roll(ring, -1, axis=0) - ring, axis=1))))
    low, high = ring.min(axis=0), ring.max(axis=0)
    if not step > 0.0 or np.ptp(ring, axis=0).max() > (60.0 if least == 0.0 else 150.0) * step:
        return None, none
    rows = np.arange(low[1], high[1], step * np.sqrt(0.75))
    columns = np.arange(low[0], high[0], step)
    grid = np.stack(np.meshgrid(columns, rows), axis=-1)
    grid[1::2, :, 0] += 0.5 * step
    places = grid.reshape(-1, 2)
    places = places[inside_polygon(ring, places)]
    away = np.asarray(cKDTree(_densely(ring)).query(places)[0])
    places = places[away > 0.6 * step]
    try:
        faces = Delaunay(np.concatenate([ring, places])).simplices.astype(np.int64)
    except QhullError:
        return None, none
    corners = np.concatenate([ring, places])
    faces = faces[inside_polygon(ring, corners[faces].mean(axis=1))]
    a, b, c = (corners[faces[:, k]] for k in range(3))
    turn = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    faces = np.where((turn < 0.0)[:, None], faces[:, ::-1], faces)
    if not _follows(faces, len(ring)):
        return None, none
    return np.concatenate([rest, len(outline) + np.arange(len(places))])[faces], places


def _densely(ring: Floats) -> Floats:
    return np.concatenate([ring + t * (np.roll(ring, -1, axis=0) - ring) for t in (0.0, 1 / 3, 2 / 3)])


def _follows(faces: Faces, count: int) -> bool:
    """Return whether the free sides of ``faces`` are the sides 0-1, 1-2 .. of a ring of ``count`` corners."""
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    keys, back = start << 31 | end, end << 31 | start
    ring = np.arange(count)
    free = np.sort(keys[~np.isin(keys, back)])
    wanted = np.sort(ring << 31 | (ring + 1) % count)
    return len(np.unique(keys)) == len(keys) and np.array_equal(free, wanted)


def inside_polygon(ring: Floats, places: Floats) -> Flags:
    """Return which places lie in the polygon, shape (k,)."""
    a, b = ring, np.roll(ring, -1, axis=0)
    x, y = places[:, :1], places[:, 1:]
    spans = (a[:, 1] > y) != (b[:, 1] > y)
    rise = np.where(b[:, 1] == a[:, 1], 1.0, b[:, 1] - a[:, 1])
    right = x < a[:, 0] + (y - a[:, 1]) / rise * (b[:, 0] - a[:, 0])
    return np.asarray((spans & right).sum(axis=1) % 2 == 1)


def clip_ears(outline: Floats, rest: Indices, sharpest: float) -> tuple[Faces, Indices]:
    """Cut off ears sharper than ``sharpest`` [rad], the sharpest first; return them and what is left."""
    ears: list[tuple[int, int, int]] = []
    while len(rest) > 2 and (len(rest) > 3 or sharpest == np.inf):
        ring = outline[rest]
        to, fro = np.roll(ring, -1, axis=0) - ring, np.roll(ring, 1, axis=0) - ring
        turn = to[:, 0] * fro[:, 1] - to[:, 1] * fro[:, 0]
        angle = np.arctan2(turn, np.einsum("ij,ij->i", to, fro)) % (2.0 * np.pi)
        order = [int(k) for k in np.argsort(angle)[:8] if angle[k] < min(sharpest, np.pi)]
        ear = next((k for k in order if _is_empty(ring, k)), None)
        if ear is None:
            if sharpest < np.inf:
                break
            ear = int(np.argmin(angle))  # crossed outlines have no proper ear: only the sides matter now
        ears.append((int(rest[ear - 1]), int(rest[ear]), int(rest[(ear + 1) % len(rest)])))
        rest = np.delete(rest, ear)
    return np.array(ears, dtype=np.int64).reshape(-1, 3), rest


def _is_empty(ring: Floats, ear: int) -> bool:
    """Return whether no other corner lies in the triangle at corner ``ear``."""
    keep = np.ones(len(ring), dtype=bool)
    corners = [ear - 1, ear, (ear + 1) % len(ring)]
    keep[corners] = False
    return not inside_polygon(ring[corners], ring[keep]).any()
