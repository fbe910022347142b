"""Repair of scanned triangles: what scanners and exporters leave behind is taken away, and counted."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from core.mesh import Faces, Flags, Floats, Indices, Points, area_vectors

Step = Callable[[Points, Faces], tuple[Points, Faces, int]]

FARTHEST = 1e9
"""A coordinate beyond this [file units] is a mistake: squares and cubes of it would not stay finite."""

SAME_PLACE = 2e-6
"""Vertices nearer than this share of the body's diagonal [1] are one."""

SPECK = 0.005
"""A loose piece with less than this share of the largest piece's area [1] is a speck."""


def repair(vertices: Points, faces: Faces) -> tuple[Points, Faces, tuple[str, ...]]:
    """Return clean vertices, shape (n, 3), outward wound faces, shape (m, 3), and one sentence a repair.

    What is sound keeps its order; sound triangles come back as they are. Any unit. Source: ours.
    """
    steps: tuple[tuple[Step, str, str], ...] = (
        (_drop_positionless, "Dropped {} without a position.", "vertex"),
        (_drop_unused, "Dropped {} outside any face.", "vertex"),
        (_merge_equal, "Merged {} with others at the same place.", "vertex"),
        (_drop_empty_faces, "Dropped {} without an area or listed before.", "face"),
        (_drop_fins, "Dropped {} standing off the skin like a fin.", "face"),
        (_drop_specks, "Dropped {} beside the body.", "speck"),
        (_wind_outward, "Turned {} to look outward.", "face"),
    )
    sentences = []
    for step, words, noun in steps:
        vertices, faces, count = step(vertices, faces)
        if count:
            plural = {"vertex": "vertices"}.get(noun, noun + "s")
            sentences.append(words.format(f"{count:,} {noun if count == 1 else plural}"))
    return vertices, faces, tuple(sentences)


def _drop_positionless(vertices: Points, faces: Faces) -> tuple[Points, Faces, int]:
    good = np.all(np.abs(vertices) < FARTHEST, axis=1)  # False for NaN too
    count = int((~good).sum())
    return (
        (*_compact(vertices, faces[good[faces].all(axis=1)], good), count) if count else (vertices, faces, 0)
    )


def _drop_unused(vertices: Points, faces: Faces) -> tuple[Points, Faces, int]:
    used = np.zeros(len(vertices), dtype=bool)
    used[faces] = True
    return (*_compact(vertices, faces, used), int((~used).sum()))


def _merge_equal(vertices: Points, faces: Faces) -> tuple[Points, Faces, int]:
    if len(vertices) == 0:
        return vertices, faces, 0
    low, high = np.percentile(vertices, (1, 99), axis=0)
    grain = SAME_PLACE * float(np.linalg.norm(high - low))
    first = _first_equal(np.round(vertices / grain) if grain > 0.0 else vertices)
    keep = first == np.arange(len(vertices))
    return (*_compact(vertices, first[faces], keep), int((~keep).sum()))


def _drop_empty_faces(vertices: Points, faces: Faces) -> tuple[Points, Faces, int]:
    corners = np.sort(faces, axis=1)
    keep = (corners[:, 0] < corners[:, 1]) & (corners[:, 1] < corners[:, 2])
    keep &= _first_equal(corners) == np.arange(len(faces))
    return _keep_faces(vertices, faces, keep)


def _drop_fins(vertices: Points, faces: Faces) -> tuple[Points, Faces, int]:
    """Drop the faces that hang with one side on an inner edge of the skin, the other two sides free."""
    _, edge, count = np.unique(_edge_keys(faces, len(vertices)), return_inverse=True, return_counts=True)
    sharing = count[edge].reshape(3, -1)
    return _keep_faces(vertices, faces, ~(((sharing == 1).sum(axis=0) == 2) & (sharing.max(axis=0) > 2)))


def _drop_specks(vertices: Points, faces: Faces) -> tuple[Points, Faces, int]:
    corner = np.repeat(faces[:, 0], 2)
    piece_count, piece = _pieces(corner, faces[:, 1:].ravel(), len(vertices))
    piece = piece[faces[:, 0]]
    area = np.bincount(piece, np.linalg.norm(area_vectors(vertices, faces), axis=1), piece_count)
    small = area < SPECK * area.max(initial=0.0)
    kept, faces, _ = _keep_faces(vertices, faces, ~small[piece])
    return kept, faces, int(small.sum())


def _wind_outward(vertices: Points, faces: Faces) -> tuple[Points, Faces, int]:
    """Make neighbours run the same way round, then each piece look away from the middle of the body.

    Two sheets of the skin are laid over each other, one with every face as it is, one with every face turned,
    and joined where neighbours agree: each connected sheet is then one consistent winding of a piece.
    """
    if len(faces) == 0:
        return vertices, faces, 0
    first, second, clash = _neighbours(faces, len(vertices))
    m = len(faces)
    start = np.concatenate([first, first + m])
    end = np.concatenate([second + m * clash, second + m * ~clash])
    _, sheet = _pieces(start, end, 2 * m)
    piece = np.minimum(sheet[:m], sheet[m:])
    turned = sheet[m:] == piece
    turned &= sheet[:m] != piece  # a piece with one side only has no winding: leave it
    areas = area_vectors(vertices, faces)
    weight = np.linalg.norm(areas, axis=1)
    centres = vertices[faces].mean(axis=1)
    outward = np.einsum("ij,ij->i", areas, centres - np.average(centres, axis=0, weights=weight))
    volume = np.bincount(piece, np.where(turned, -outward, outward))
    turned ^= (volume < 0.0)[piece]
    if turned.any():
        faces = np.where(turned[:, None], faces[:, ::-1], faces)
    return vertices, faces, int(turned.sum())


def _neighbours(faces: Faces, vertex_count: int) -> tuple[Indices, Indices, Flags]:
    """Return the faces on both sides of each edge that has two, and whether they run against each other."""
    keys = _edge_keys(faces, vertex_count)
    order = np.argsort(keys, kind="stable")
    starts = np.flatnonzero(np.diff(keys[order], prepend=-1, append=-1))
    pair = order[starts[:-1][np.diff(starts) == 2][:, None] + [0, 1]]
    rising = (faces < np.roll(faces, -1, axis=1)).T.ravel()
    face = pair % len(faces)
    return face[:, 0], face[:, 1], rising[pair[:, 0]] == rising[pair[:, 1]]


def _edge_keys(faces: Faces, vertex_count: int) -> Indices:
    """Return one number an edge, the same from both sides, shape (3 m,): first all first sides, and so on."""
    ends = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)]), axis=0)
    return np.asarray((ends[0] * vertex_count + ends[1]).T.ravel())


def _pieces(start: Indices, end: Indices, count: int) -> tuple[int, Indices]:
    links = sparse.coo_array((np.ones(len(start), dtype=np.int8), (start, end)), shape=(count, count))
    pieces, label = connected_components(links, directed=False)
    return int(pieces), np.asarray(label, dtype=np.int64)


def _first_equal(rows: Floats | Indices) -> Indices:
    """Return for each row the index of the first row equal to it, shape (n,)."""
    order = np.lexsort(rows.T)
    new = np.ones(len(rows), dtype=bool)
    new[1:] = (rows[order[1:]] != rows[order[:-1]]).any(axis=1)
    first = np.empty(len(rows), dtype=np.int64)
    first[order] = order[new][np.cumsum(new) - 1]
    return first


def _keep_faces(vertices: Points, faces: Faces, keep: Flags) -> tuple[Points, Faces, int]:
    count = int((~keep).sum())
    if count == 0:
        return vertices, faces, 0
    vertices, faces, _ = _drop_unused(vertices, faces[keep])
    return vertices, faces, count


def _compact(vertices: Points, faces: Faces, keep: Flags) -> tuple[Points, Faces]:
    if keep.all():
        return vertices, faces
    return vertices[keep], (np.cumsum(keep) - 1)[faces]
