"""Repair of scanned triangles: what scanners and exporters leave behind is taken away, and counted."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from core.geometry.mesh import MAX_COORDINATE, Faces, Flags, Indices, Points
from core.messages import Message, plural_message
from core.progress import Progress, quiet
from core.scan.repair.components import remove_scan_stand, remove_small_components, size_of
from core.scan.repair.editable_mesh import EditableMesh, components, first_equal
from core.scan.repair.inner_surfaces import BURIED, is_enclosed, remove_inner, remove_occluded

Step = Callable[[EditableMesh], tuple[EditableMesh, int]]

FAR_OFF = 50.0
"""A vertex farther from the middle than so many times the median vertex [1] is a mistake."""

SAME_PLACE = 2e-6
"""Vertices nearer than this share of the body's diagonal [1] are one."""

LARGE = 0.25
"""A patch of at least this share of the area of the largest [1] is never taken for a fin."""

MANY = 8
"""Two closed sheets that touch in a vertex give it at least so many triangles, but for rare cases."""

DENT = 0.1
"""A piece is hollow if it faces its own middle by more than this [1]."""

SPIKE, SHARP = 0.1, 1.2
"""The shortest edge at a spike, in parts of the body's size [1]; the sum of the angles at its tip [rad]."""


def repair(
    vertices: Points, faces: Faces, progress: Progress = quiet
) -> tuple[Points, Faces, tuple[Message, ...]]:
    """Return clean vertices, shape (n, 3), outward wound faces, shape (m, 3), and one sentence a repair.

    What is sound keeps its order; sound triangles come back as they are. Any unit. Raises Cancelled.
    Source: ours.
    """
    steps: tuple[tuple[Step, Message, Callable[[int], Message]], ...] = (
        (_drop_positionless, Message("Removed {count} without a position."), vertex_count),
        (_drop_unused, Message("Removed {count} not belonging to any face."), vertex_count),
        (_drop_far, Message("Removed {count} far from all others."), vertex_count),
        (_merge_equal, Message("Merged {count} with others at the same position."), vertex_count),
        (_drop_empty_faces, Message("Removed {count} with zero area or listed twice."), face_count),
        (remove_fins, Message("Removed {count} from fin-shaped parts."), face_count),
        (_part_sheets, Message("Separated two touching layers of the surface at {count}."), vertex_count),
        (remove_scan_stand, Message("Removed {count} shaped like a floor, a wall or a stand."), piece_count),
        (remove_small_components, Message("Removed {count} separate from the body."), speck_count),
        (_drop_spikes, Message("Removed {count} from spike-shaped parts."), vertex_count),
        (_wind_outward, Message("Reversed {count} to face outward."), face_count),
        (remove_inner, Message("Removed {count} inside the body or duplicating its surface."), piece_count),
        (remove_occluded, Message("Removed {count} from parts that extend into the body."), face_count),
    )
    skin, sentences = EditableMesh(vertices, faces), []
    for done, (step, sentence, counted) in enumerate(steps):
        progress("repairing", done / len(steps))
        before = skin
        skin, count = step(before)
        if count:
            sentences.append(sentence.fill(count=counted(count)))
        if count and step in (remove_inner, remove_occluded) and is_enclosed(before, skin):
            sentences.append(BURIED)
    return skin.vertices, skin.faces, tuple(sentences)


def vertex_count(count: int) -> Message:
    """Return a number of vertices."""
    return plural_message("{count} vertex", "{count} vertices", count)


def face_count(count: int) -> Message:
    """Return a number of faces."""
    return plural_message("{count} face", "{count} faces", count)


def piece_count(count: int) -> Message:
    """Return a number of pieces."""
    return plural_message("{count} piece", "{count} pieces", count)


def speck_count(count: int) -> Message:
    """Return a number of specks."""
    return plural_message("{count} small component", "{count} small components", count)


def hole_count(count: int) -> Message:
    """Return a number of holes."""
    return plural_message("{count} hole", "{count} holes", count)


def _drop_positionless(skin: EditableMesh) -> tuple[EditableMesh, int]:
    good = np.all(np.abs(skin.vertices) < MAX_COORDINATE, axis=1)  # False for NaN too
    return skin.with_vertices(good), int((~good).sum())


def _drop_unused(skin: EditableMesh) -> tuple[EditableMesh, int]:
    used = skin.compact()
    return used, len(skin.vertices) - len(used.vertices)


def _drop_far(skin: EditableMesh) -> tuple[EditableMesh, int]:
    if len(skin.vertices) == 0:
        return skin, 0
    some = skin.vertices[:: len(skin.vertices) // 100_000 + 1]
    middle = np.median(some, axis=0)
    usual = float(np.median(np.linalg.norm(some - middle, axis=1)))
    near = np.abs(skin.vertices - middle).max(axis=1) <= FAR_OFF * usual
    if near.all() or not near.any():
        return skin, 0
    return skin.with_vertices(near).compact(), int((~near).sum())


def _merge_equal(skin: EditableMesh) -> tuple[EditableMesh, int]:
    if len(skin.vertices) == 0:
        return skin, 0
    low, high = np.percentile(skin.vertices[:: len(skin.vertices) // 100_000 + 1], (1, 99), axis=0)
    lowest = skin.vertices.min(axis=0)
    extent = float(np.ptp(skin.vertices, axis=0).max())
    # three places of 20 bits make one number to sort by
    grain = max(SAME_PLACE * float(np.linalg.norm(high - low)), extent / (2**20 - 1), 1e-300)
    cell = np.rint((skin.vertices - lowest) / grain).astype(np.int64)
    first = first_equal((cell[:, 0] << 40) | (cell[:, 1] << 20) | cell[:, 2])
    keep = first == np.arange(len(first))
    if keep.all():
        return skin, 0
    return EditableMesh(skin.vertices[keep], (np.cumsum(keep) - 1)[first[skin.faces]]), int((~keep).sum())


def _drop_empty_faces(skin: EditableMesh) -> tuple[EditableMesh, int]:
    low, middle, high = np.sort(skin.faces, axis=1).T
    keep = (low < middle) & (middle < high)
    # faces with the same two lower corners are few: their upper corners are compared among these alone
    pair = first_equal(low * len(skin.vertices) + middle)
    twin = np.bincount(pair, minlength=len(pair))[pair] > 1
    where = np.flatnonzero(twin)
    ranked = where[np.lexsort((where, high[where], pair[where]))]
    same = (pair[ranked[1:]] == pair[ranked[:-1]]) & (high[ranked[1:]] == high[ranked[:-1]])
    keep[ranked[1:][same]] = False
    if not skin.areas.any():  # all on a line
        keep[:] = False
    return skin.with_faces(keep), int((~keep).sum())


def remove_fins(skin: EditableMesh) -> tuple[EditableMesh, int]:
    """Remove the smallest patches where more than two faces share an edge, until two are left.

    A patch is what hangs together over edges of two faces. Those with a free side go first.
    """
    sides = skin.sides
    if sides.count.max(initial=0) <= 2:
        return skin, 0
    first, second, _ = sides.neighbours
    patch = components(first, second, len(skin.faces))
    area = np.bincount(patch, skin.areas)
    free = np.zeros(len(area), dtype=bool)
    free[patch[sides.border % len(skin.faces)]] = True
    bad = np.flatnonzero(sides.count > 2)
    edge = np.repeat(bad, sides.count[bad])
    rows = np.concatenate([np.arange(sides.start[i], sides.start[i] + sides.count[i]) for i in bad])
    hung = patch[sides.order[rows] % len(skin.faces)]
    order = np.argsort(hung, kind="stable")
    starts = np.searchsorted(hung[order], np.arange(len(area) + 1))
    left, dropped = sides.count.copy(), np.zeros(len(area), dtype=bool)
    candidates = np.unique(hung[area[hung] < LARGE * area.max()])
    for number in candidates[np.lexsort((area[candidates], ~free[candidates]))]:
        edges = edge[order[starts[number] : starts[number + 1]]]
        if (left[edges] > 2).any():
            np.subtract.at(left, edges, 1)
            dropped[number] = True
    keep = ~dropped[patch]
    return skin.with_faces(keep), int((~keep).sum())


def _part_sheets(skin: EditableMesh) -> tuple[EditableMesh, int]:
    """Give each sheet its own vertex where sheets touch in nothing but a vertex."""
    n, sides = len(skin.vertices), skin.sides
    start, end = sides.ends(sides.border)
    low, high = np.full(n, len(skin.faces)), np.full(n, -1)
    for k in range(3) if skin.piece.any() else ():
        np.minimum.at(low, skin.faces[:, k], skin.piece)
        np.maximum.at(high, skin.faces[:, k], skin.piece)
    several = np.bincount(np.concatenate([start, end]), minlength=n) > 2
    several |= (low < high) | (np.bincount(skin.faces.ravel(), minlength=n) >= MANY)
    near = skin.faces[several[skin.faces].any(axis=1)]
    if len(near) == 0:
        return skin, 0
    fan = _fans(EditableMesh(skin.vertices, near))
    # the first fan of a vertex keeps it, each other gets a copy
    corner = near.ravel()
    order = np.argsort(fan, kind="stable")
    fan_vertex = corner[order][np.unique(fan[order], return_index=True)[1]]
    first = np.full(n, len(fan_vertex))
    np.minimum.at(first, fan_vertex, np.arange(len(fan_vertex)))
    extra = (first[fan_vertex] != np.arange(len(fan_vertex))) & several[fan_vertex]
    if not extra.any():
        return skin, 0
    number = np.where(extra, n + np.cumsum(extra) - 1, fan_vertex)
    faces = skin.faces.copy()
    faces[several[skin.faces].any(axis=1)] = number[fan].reshape(-1, 3)
    vertices = np.concatenate([skin.vertices, skin.vertices[fan_vertex[extra]]])
    return EditableMesh(vertices, faces), len(np.unique(fan_vertex[extra]))


def _fans(skin: EditableMesh) -> Indices:
    """Return the fan of each corner, shape (3 m,): corners at a vertex that meet over edges are one fan."""
    sides, m = skin.sides, len(skin.faces)
    later = np.ones(3 * m, dtype=bool)
    later[sides.start] = False
    rows = np.flatnonzero(later)
    one, other = sides.order[rows - 1], sides.order[rows]
    a, b = (3 * (side % m) + side // m for side in (one, other))
    a_end, b_end = (3 * (side % m) + (side // m + 1) % 3 for side in (one, other))
    same = sides.ends(one)[0] == sides.ends(other)[0]
    starts, ends = np.where(same, b, b_end), np.where(same, b_end, b)
    return components(np.concatenate([a, a_end]), np.concatenate([starts, ends]), 3 * m)


def _drop_spikes(skin: EditableMesh) -> tuple[EditableMesh, int]:
    """Drop inner vertices that stand far off between faces that are all narrow there."""
    if len(skin.faces) == 0:
        return skin, 0
    n, least = len(skin.vertices), np.full(len(skin.vertices), np.inf)
    a, b, c = (skin.vertices[skin.faces[:, k]] for k in range(3))
    long = SPIKE * size_of(skin)
    length = np.stack([np.einsum("ij,ij->i", d, d) for d in (b - a, c - b, a - c)], axis=1)
    far = np.minimum(length, np.roll(length, 1, axis=1)) > long * long
    if not far.any():
        return skin, 0
    rows = np.flatnonzero(far.any(axis=1))
    for k in range(3):
        np.minimum.at(least, skin.faces[:, k], far[:, k].astype(float))
    angle = np.zeros(n)
    corners = skin.vertices[skin.faces[rows]]
    for k in range(3):
        to, fro = corners[:, (k + 1) % 3] - corners[:, k], corners[:, (k + 2) % 3] - corners[:, k]
        cosine = np.einsum("ij,ij->i", to, fro) / np.maximum(
            np.sqrt(np.einsum("ij,ij->i", to, to) * np.einsum("ij,ij->i", fro, fro)), 1e-300
        )
        angle += np.bincount(skin.faces[rows, k], np.arccos(np.clip(cosine, -1.0, 1.0)), n)
    start, end = skin.sides.ends(skin.sides.border)
    spike = (least == 1.0) & (angle < SHARP)
    spike[start] = spike[end] = False
    return skin.with_vertices(~spike).compact(), int(spike.sum())


def _wind_outward(skin: EditableMesh) -> tuple[EditableMesh, int]:
    """Make neighbours run the same way round, then each piece look outward.

    Two sheets of the skin are laid over each other, one with every face as it is, one with every face turned,
    and joined where neighbours agree: each connected sheet is then one consistent winding of a piece.
    """
    m = len(skin.faces)
    if m == 0:
        return skin, 0
    first, second, clash = skin.sides.neighbours
    turned = np.zeros(m, dtype=bool)
    if clash.any():
        start = np.concatenate([first, first + m])
        end = np.concatenate([second + m * clash, second + m * ~clash])
        sheet = components(start, end, 2 * m)
        turned = sheet[m:] < sheet[:m]  # a piece with one side only has no winding: it stays
    turned ^= _inward(skin, turned)[skin.piece]
    if not turned.any():
        return skin, 0
    return EditableMesh(skin.vertices, np.where(turned[:, None], skin.faces[:, ::-1], skin.faces)), int(
        turned.sum()
    )


def _inward(skin: EditableMesh, turned: Flags) -> Flags:
    """Return which pieces look inward with their faces ``turned``, shape (k,).

    A closed piece has its volume for it, an open one its place round the middle of the body. If its own
    bulge says the opposite, as inside an arm, it keeps to the winding that the file has elsewhere.
    """
    piece, weight = skin.piece, np.maximum(skin.areas, 1e-300)
    vectors = np.where(turned[:, None], -skin.area_vectors, skin.area_vectors)
    total = np.bincount(piece, weight)
    own = np.stack([np.bincount(piece, weight * skin.centres[:, k]) for k in range(3)], axis=1)
    from_own = skin.centres - (own / total[:, None])[piece]
    from_body = skin.centres - own.sum(axis=0) / total.sum()
    around, bulge = (
        np.bincount(piece, np.einsum("ij,ij->i", vectors, way))
        / np.maximum(np.bincount(piece, weight * np.linalg.norm(way, axis=1)), 1e-300)
        for way in (from_body, from_own)
    )
    as_given = np.sign(np.bincount(piece, np.where(turned, -weight, weight)))
    is_open = np.zeros(len(total), dtype=bool)
    is_open[piece[skin.sides.border % len(piece)]] = True
    around = np.where(is_open, around, bulge)
    doubtful = is_open & (bulge * np.sign(around) < -DENT) & (total < total.max())
    file = 1.0 if (total * around * as_given)[~doubtful].sum() >= 0.0 else -1.0
    return np.asarray(np.where(doubtful, as_given * file < 0.0, around < 0.0))
