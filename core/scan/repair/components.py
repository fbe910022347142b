"""The pieces of a scan: which are body, and which are floor, stand or speck."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from core.geometry.mesh import Floats, Indices, Points, sample_surface, unit
from core.scan.repair.editable_mesh import EditableMesh

SPECK = 0.005
"""A loose piece with less than this share of the largest piece's area [1] is a speck."""

SHREDS = 0.1
"""Specks that make up more than this share of a skin [1] are none: it is in shreds."""

LOOSE = 0.03
"""So is one with less than this share that is farther off than ``BESIDE``."""

BESIDE = 0.15
"""How far a part of the body may lie from the rest, in parts of the body's size [1]."""

LOOKED_AT = 40
"""Only the largest pieces are looked at closely."""

SAMPLES = 3000
"""Places at which the shape of a piece is looked at."""

NEAREST = 12
"""The normal of a place is that of the plane through so many."""

FLAT = 0.01
"""Half the thickness of a plate, in parts of the square root of the area of its piece [1]."""

UPRIGHT = 0.2
"""A normal is square to an axis if the cosine between them is smaller."""

PLATES, BUILT = 0.15, 0.85
"""Share of a piece [1] that is two plates, and that these and what stands upright on them make up."""

ROUND = 0.06
"""The radius of a pole does not change by more [1]."""

SEAM, SEWN = 0.05, 0.3
"""A border runs along another if it lies nearer, in parts of the square root of the area of its piece [1];
a patch of a skin does so along that share of its border [1]."""


def size_of(skin: EditableMesh) -> float:
    """Return the root mean square distance of a skin from its middle: some 220 for a torso in mm."""
    total = float(skin.areas.sum())
    if total == 0.0:
        return 0.0
    from_middle = skin.centres - skin.areas @ skin.centres / total
    return float(np.sqrt(skin.areas @ np.einsum("ij,ij->i", from_middle, from_middle) / total))


def remove_scan_stand(skin: EditableMesh) -> tuple[EditableMesh, int]:
    """Drop loose pieces that are flat, or everywhere along or square to one axis: floors, boxes, poles.

    If nothing else would be left, all stays.
    """
    areas = skin.piece_areas if len(skin.faces) else np.zeros(0)
    built = np.zeros(len(areas), dtype=bool)
    large = largest(areas, SPECK)
    if len(large) < 2:
        return skin, 0
    for number in large:
        faces = np.flatnonzero(skin.piece == number)
        built[number] = _is_built(skin, faces) and not _is_patch(skin, int(number), large)
    if built[large].all():
        return skin, 0
    return skin.without_pieces(built), int(built.sum())


def remove_small_components(skin: EditableMesh) -> tuple[EditableMesh, int]:
    """Drop pieces that are tiny, and small ones that lie apart."""
    if len(skin.faces) == 0 or len(skin.piece_areas) < 2:
        return skin, 0
    share = skin.piece_areas / skin.piece_areas.max()
    small = share < SPECK
    if share[small].sum() > SHREDS * share.sum():
        return skin, 0  # they are what the skin is made of
    doubtful = np.flatnonzero((share < LOOSE) & ~small)
    if len(doubtful):
        body = cKDTree(sample_component(skin, np.flatnonzero((share >= LOOSE)[skin.piece]), 10 * SAMPLES))
        apart = BESIDE * size_of(skin.without_pieces(share < LOOSE))
        for number in doubtful:
            places = sample_component(skin, np.flatnonzero(skin.piece == number), 200)
            small[number] = np.min(body.query(places)[0]) > apart
    return skin.without_pieces(small), int(small.sum())


def largest(areas: Floats, share: float = 0.0) -> Indices:
    """Return the largest of pieces of ``areas``, shape (k,), above a ``share`` of the first."""
    order = np.argsort(-areas, kind="stable")[:LOOKED_AT]
    return np.asarray(order[areas[order] > share * areas.max(initial=0.0)])


def sample_component(skin: EditableMesh, faces: Indices, count: int = SAMPLES) -> Points:
    """Return places strewn evenly over triangles, shape (count, 3)."""
    return sample_surface(skin.vertices, skin.faces[faces], skin.areas[faces], count)[0]


def _is_built(skin: EditableMesh, faces: Indices) -> bool:
    """Return whether a piece is a plate, a body between two plates along one axis, or a pole."""
    places = sample_component(skin, faces)
    _, near = cKDTree(places).query(places, k=NEAREST)
    around = places[near] - places[near].mean(axis=1, keepdims=True)
    spread, directions = np.linalg.eigh(np.einsum("ski,skj->sij", around, around))
    normals = directions[:, :, 0]
    flattest = np.argsort(spread[:, 0] / np.maximum(spread[:, 1], 1e-300))[: len(places) // 2]
    few = normals[flattest[:: len(flattest) // 12]]
    crossed = np.cross(few[:, None], few[None])[np.triu_indices(len(few), 1)]
    crossed = unit(crossed[np.linalg.norm(crossed, axis=1) > UPRIGHT])  # those of one plate cross in none
    thick = FLAT * float(np.sqrt(skin.areas[faces].sum()))
    main = np.linalg.eigh(normals.T @ normals)[1].T
    for axis in np.concatenate([main, few, crossed]):
        plates = _in_two_plates(places @ axis, thick) / len(places)
        sides = np.abs(normals @ axis) < UPRIGHT
        if plates > BUILT or (plates > PLATES and plates + sides.mean() > BUILT):
            return True
        if sides.mean() > BUILT and _is_round(places[sides], axis):
            return True
    return False


def _is_patch(skin: EditableMesh, number: int, large: Indices) -> bool:
    """Return whether the border of a piece runs along the borders of others, as patches of one skin do."""
    side = skin.sides.border
    piece, start = skin.piece[side % len(skin.faces)], skin.vertices[skin.sides.ends(side)[0]]
    own, others = start[piece == number], start[np.isin(piece, large[large != number])]
    if len(own) == 0 or len(others) == 0:
        return False
    near = SEAM * float(np.sqrt(skin.areas[skin.piece == number].sum()))
    return bool(np.mean(cKDTree(others).query(own, distance_upper_bound=near)[0] < np.inf) > SEWN)


def _in_two_plates(heights: Floats, thick: float) -> int:
    """Return how many ``heights``, shape (k,), lie in the two fullest ranges of +-``thick``."""
    heights, found = np.sort(heights), 0
    for _ in range(2):
        if len(heights) == 0:
            break
        ends = np.searchsorted(heights, heights + 2.0 * thick, side="right")
        inside = ends - np.arange(len(heights))
        best = int(np.argmax(inside))
        found += int(inside[best])
        heights = np.delete(heights, slice(best, ends[best]))
    return found


def _is_round(places: Points, axis: Points) -> bool:
    """Return whether ``places``, shape (k, 3), lie at one distance from a line along ``axis``."""
    across = np.linalg.svd(axis[None])[2][1:]
    flat = places @ across.T
    x, y = (flat - flat.mean(axis=0)).T
    circle = np.linalg.lstsq(np.stack([x, y, np.ones_like(x)], axis=1), x * x + y * y, rcond=None)[0]
    radius = np.hypot(x - 0.5 * circle[0], y - 0.5 * circle[1])
    return bool((np.abs(radius / np.median(radius) - 1.0) < ROUND).mean() > BUILT)
