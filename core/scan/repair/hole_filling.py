"""Mending of a skin in mm: seams between its parts are sewn and small holes closed; large ones stay open."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.spatial import cKDTree

from core.geometry.mesh import Faces, Floats, Indices, Mesh, Points, quadric_terms
from core.geometry.triangulate import triangulate
from core.messages import Length, Message
from core.progress import Progress, quiet
from core.scan.repair.editable_mesh import EditableMesh
from core.scan.repair.holes import border_loops, find_holes, frame_of, hole_sentences, islands
from core.scan.repair.repair import hole_count, vertex_count

CLOSED = 30.0
"""Holes up to this length are closed [mm]."""

MOST_CORNERS = 1000
"""Holes of more corners stay open: so small a one has at most 300 on a fine scan [1]."""

SEAM = 2.0
"""Borders of different parts nearer than this are sewn together [mm]."""

CRACK = 30.0
"""The two sides of one border are sewn to each other only where the way between them is longer [mm]."""


def fill_holes(mesh: Mesh, progress: Progress = quiet) -> tuple[Mesh, tuple[Message, ...]]:
    """Return an upright ``mesh`` [mm] mended, and a sentence a repair and an open hole. Raises Cancelled."""
    mesh, sewn, closed = fill_small_holes(mesh, progress)
    progress("closing holes", 1.0)
    sentences = []
    if sewn:
        sentences.append(
            Message("Joined {count} along seams between parts of the scan.", count=vertex_count(sewn))
        )
    if closed:
        sentences.append(
            Message("Filled {count} up to {size} across.", count=hole_count(closed), size=Length(CLOSED))
        )
    return mesh, (*sentences, *hole_sentences(mesh, find_holes(mesh)))


def fill_small_holes(mesh: Mesh, progress: Progress = quiet) -> tuple[Mesh, int, int]:
    """Return ``mesh`` with seams sewn and small holes closed, and how many vertices and holes that were.

    Old vertices keep their order, those sewn to another are gone; new ones come last. A closed hole follows
    the curvature of the skin round it. Source: ours.
    """
    progress("closing holes", 0.0)
    skin = EditableMesh(mesh.vertices, mesh.faces)
    start, end = skin.sides.ends(skin.sides.border)
    if len(start) == 0:
        return mesh, 0, 0
    twin = _twins(mesh, start, end)
    home = np.minimum(twin, np.arange(len(twin)))
    vertices = 0.5 * (mesh.vertices + mesh.vertices[twin])
    round_hole = ~islands(skin, twin)
    loops = [home[loop] for loop in border_loops(start[round_hole], end[round_hole], twin)]
    small = []
    for done, loop in enumerate(loops):
        progress("closing holes", 0.5 * done / len(loops))
        if _is_small(loop, vertices):
            small.append(loop)
    sewn = int((home != np.arange(len(home))).sum())
    if not sewn and not small:
        return mesh, 0, 0
    faces, added, closed = [home[mesh.faces]], [vertices], 0
    count, tree = len(vertices), cKDTree(vertices)
    edges = edges_at(np.concatenate([*small, start[:0]]), faces[0])
    for done, loop in enumerate(small):
        progress("closing holes", 0.5 + 0.5 * done / len(small))
        patch, new = _filled(vertices[loop], tree, mesh.vertex_normals)
        corners = np.concatenate([loop, count + np.arange(len(new))])[patch]
        inner = set(edge_keys(corners).tolist()) - set(edge_keys(loop[None]).tolist())
        if not inner.isdisjoint(edges):
            continue  # it would join what is joined already
        edges |= inner
        faces.append(corners)
        added.append(new)
        count, closed = count + len(new), closed + 1
    whole = EditableMesh(np.concatenate(added), np.concatenate(faces)).compact()
    return Mesh(whole.vertices, whole.faces), sewn, closed


def _is_small(loop: Indices, vertices: Points) -> bool:
    if not 3 <= len(loop) <= MOST_CORNERS or len(set(loop.tolist())) < len(loop):
        return False
    small = float(np.linalg.norm(np.ptp(vertices[loop], axis=0))) <= CLOSED
    return small or bool(frame_of(vertices[loop])[1][:2].max() <= CLOSED)


def _twins(mesh: Mesh, start: Indices, end: Indices) -> Indices:
    """Return for each vertex the one that it is sewn to, itself if none, shape (n,)."""
    twin = np.arange(len(mesh.vertices))
    place, loop, size = np.full(len(twin), -1), np.full(len(twin), -1), np.zeros(len(twin), dtype=np.int64)
    for number, each in enumerate(border_loops(start, end, twin)):
        place[each], loop[each], size[each] = np.arange(len(each)), number, len(each)
    border = np.flatnonzero(loop >= 0)
    if len(border) < 2:
        return twin
    tree = cKDTree(mesh.vertices[border])
    distance, row = tree.query(mesh.vertices[border], k=min(8, len(border)), distance_upper_bound=SEAM)
    other = border[np.minimum(row, len(border) - 1)]
    steps = np.abs(place[other] - place[border][:, None])
    steps = np.minimum(steps, size[border][:, None] - steps)
    way = steps * float(np.median(np.linalg.norm(mesh.vertices[end] - mesh.vertices[start], axis=1)))
    foreign = (loop[other] != loop[border][:, None]) | (way > CRACK)
    distance = np.where(foreign, distance, np.inf)
    best = np.argmin(distance, axis=1)
    rows = np.arange(len(border))
    wanted = np.where(np.isfinite(distance[rows, best]), other[rows, best], border)
    twin[border] = wanted
    twin = np.where(twin[twin] == np.arange(len(twin)), twin, np.arange(len(twin)))
    return _without_tangles(mesh, twin)


def _without_tangles(mesh: Mesh, twin: Indices) -> Indices:
    """Part again what would leave a face without an area, or an edge with more than two faces."""
    for _ in range(3):
        home = np.minimum(twin, np.arange(len(twin)))
        if (home == np.arange(len(home))).all():
            return twin
        faces = home[mesh.faces]
        sides = EditableMesh(mesh.vertices, faces).sides
        wrong = np.zeros(len(twin), dtype=bool)
        flat = (faces == np.roll(faces, 1, axis=1)).any(axis=1)
        wrong[faces[flat].ravel()] = True
        crowded = sides.start[sides.count > 2]
        for ends in sides.ends(sides.order[crowded]):
            wrong[ends] = True
        if not wrong.any():
            return twin
        twin = np.where(wrong[home], np.arange(len(twin)), twin)
    return np.arange(len(twin))


def edges_at(loop: Indices, faces: Faces) -> set[int]:
    """Return the keys of all edges of the faces that touch ``loop``."""
    touched = np.zeros(int(faces.max(initial=0)) + 1, dtype=bool)
    touched[loop] = True
    return set(edge_keys(faces[touched[faces].any(axis=1)]).tolist())


def edge_keys(polygons: Indices) -> Indices:
    """Return a number for each side of ``polygons``, shape (m, k): equal for equal sides."""
    ends = np.sort(np.stack([polygons, np.roll(polygons, -1, axis=1)]), axis=0)
    return np.asarray((ends[0] << 31 | ends[1]).ravel())


def _filled(border: Points, skin: cKDTree, normals: Points) -> tuple[Faces, Points]:
    """Return triangles over a hole, and the new places in it, shape (k, 3).

    ``border``, shape (b, 3), in the order of the sides of the skin, whose vertices have ``normals``. Corners
    below b are those of the border, others new.
    """
    if len(border) < 5:
        return _fan(border), np.empty((0, 3))
    axes, extent = frame_of(border)
    middle = border.mean(axis=0)
    local = (border - middle) @ axes.T
    faces, inside = triangulate(local[::-1, :2])
    faces = np.where(faces < len(border), len(border) - 1 - faces, faces)
    if len(inside) == 0:
        return faces, np.empty((0, 3))
    near = skin.query_ball_point(middle, CLOSED)
    around = (skin.data[near] - middle) @ axes.T
    around = around[(normals[near] @ axes[2] > 0.3) & (np.abs(around[:, 2]) < extent[0])]
    bend = quadric_height(np.concatenate([around, local]), max(extent[0], 1e-9))
    rest = local[:, 2] - bend(local[:, :2])
    weight = 1.0 / np.maximum(((inside[:, None] - local[None, :, :2]) ** 2).sum(axis=2), 1e-12)
    height = bend(inside) + weight @ rest / weight.sum(axis=1)
    return faces, middle + np.column_stack([inside, height]) @ axes


def _fan(border: Points) -> Faces:
    """Return the triangles over a hole of three or four sides, shape (b - 2, 3): cut where it is shorter."""
    if len(border) == 3:
        return np.array([[2, 1, 0]])
    across = np.linalg.norm(border[[0, 1]] - border[[2, 3]], axis=1)
    return np.array([[2, 1, 0], [3, 2, 0]] if across[0] < across[1] else [[3, 2, 1], [3, 1, 0]])


def quadric_height(places: Points, scale: float) -> Callable[[Floats], Floats]:
    """Fit a quadric height over the plane to ``places``, shape (k, 3); the middle counts most."""

    def terms(flat: Floats) -> Floats:
        return quadric_terms(*(flat[:, :2].T / scale))

    weight = np.exp(-((places[:, :2] / scale) ** 2).sum(axis=1))
    basis = terms(places[:, :2]) * weight[:, None]
    solution = np.linalg.lstsq(basis, places[:, 2] * weight, rcond=1e-6)[0]
    return lambda flat: np.asarray(terms(flat) @ solution)
