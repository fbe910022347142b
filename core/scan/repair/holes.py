"""Holes of a scan: which are closed, and with what surface."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu
from scipy.spatial import cKDTree

from core.geometry.mesh import Faces, Flags, Floats, Indices, Mesh, Points, edges, quadric_terms, unit
from core.geometry.triangulate import triangulate
from core.messages import Length, Message, context_message
from core.progress import Progress, quiet
from core.scan.repair.editable_mesh import EditableMesh
from core.scan.repair.repair import hole_count, vertex_count

TUBE = 0.5
"""The skin round a hole looks its way; at the end of a neck or an arm it looks across it by more [cosine]."""

FILLED = 0.4
"""An opening fills this share of its two largest extents [1], an ellipse 0.8; a torn ring encloses little."""

MOST = 1000
"""So many holes are described, those of the longest borders; a torn skin has tens of thousands."""

NAMED = 5
"""So many holes are named one by one."""

AROUND = (
    context_message("on the body", "front"),
    context_message("on the body", "front left"),
    context_message("on the body", "left side"),
    context_message("on the body", "back left"),
    context_message("on the body", "back"),
    context_message("on the body", "back right"),
    context_message("on the body", "right side"),
    context_message("on the body", "front right"),
)


CLOSED = 30.0
"""Holes up to this length are closed [mm]."""

MOST_CORNERS = 1000
"""Holes of more corners stay open: so small a one has at most 300 on a fine scan [1]."""

SEAM = 2.0
"""Borders of different parts nearer than this are sewn together [mm]."""

CRACK = 30.0
"""The two sides of one border are sewn to each other only where the way between them is longer [mm]."""

MOST_STEPS = 100.0
"""A patch has at most so many vertices from side to side [1]."""

RIM_WIDTH = 30.0
"""The skin within half a hole's length and this beyond its border tells how a patch bends [mm]."""

MOST_AROUND = 20_000
"""So many vertices round a hole are used for that."""

FEW = 8
"""A border of so few corners needs no vertex inside it [1]."""

RINGS = 2
"""So many rings of triangles round a hole give a patch its slope and curvature at the border."""


@dataclass(frozen=True, eq=False)
class Hole:
    """A place without skin: its ``border`` (b,), vertices in order, round ``centre``, shape (3,) [mm].

    ``length`` and ``width`` are its extents [mm], ``normal`` (3,) looks outward. An ``opening`` is no fault:
    there a neck, an arm or the hips were cut.
    """

    border: Indices
    centre: Points
    normal: Floats
    length: float
    width: float
    opening: bool

    def place(self, mesh: Mesh) -> Message:
        """Return where on the upright body it is, in words."""
        low, high = np.percentile(mesh.vertices, (1, 99), axis=0)
        x, y, _ = self.centre - 0.5 * (low + high)
        share = (self.centre[2] - low[2]) / (high[2] - low[2])
        eighth = round(float(np.arctan2(x / (high[0] - low[0]), -y / (high[1] - low[1]))) / (np.pi / 4)) % 8
        if share < 1 / 3:
            return Message("lower {side}", side=AROUND[eighth])
        if share > 2 / 3:
            return Message("upper {side}", side=AROUND[eighth])
        return Message("middle {side}", side=AROUND[eighth])


def find_holes(mesh: Mesh) -> tuple[Hole, ...]:
    """Return all holes of a repaired skin [mm], longest first. Source: ours."""
    skin = EditableMesh(mesh.vertices, mesh.faces)
    border = skin.sides.border[~islands(skin, np.arange(len(mesh.vertices)))]
    start, end = skin.sides.ends(border)
    loops = border_loops(start, end, np.arange(len(mesh.vertices)))
    face = np.full(len(mesh.vertices), -1)
    face[start] = border % max(len(mesh.faces), 1)
    side = np.zeros(len(mesh.vertices))
    side[start] = np.linalg.norm(mesh.vertices[end] - mesh.vertices[start], axis=1)
    loops = sorted(loops, key=lambda loop: -float(side[loop].sum()))[:MOST]
    found = [_hole(mesh, loop, face[loop]) for loop in loops]
    return tuple(sorted(found, key=lambda hole: -hole.length))


def islands(skin: EditableMesh, twin: Indices) -> Flags:
    """Return which sides of the border, shape (b,), belong to loose single triangles, not to a hole.

    ``twin`` (n,) tells which vertex each is sewn to, itself if none.
    """
    face = skin.sides.border % max(len(skin.faces), 1)
    loose = np.bincount(face, minlength=len(skin.faces)) == 3
    loose &= (twin[skin.faces] == skin.faces).all(axis=1)
    return np.asarray(loose[face])


def border_loops(start: Indices, end: Indices, twin: Indices) -> list[Indices]:
    """Chain border sides from ``start`` to ``end``, each of shape (b,), to loops of their starts.

    ``twin`` (n,) tells which vertex a loop goes on from where it comes to one: itself, or another one at its
    place. Loops that do not close are left out.
    """
    after = np.full(len(twin), -1)
    after[start] = end
    following = dict(zip(start.tolist(), twin[after[start]].tolist(), strict=True))
    loops = []
    while following:
        first, at = following.popitem()
        loop = [first]
        while at != first and at in following:
            loop.append(at)
            at = following.pop(at)
        if at == first:
            loops.append(np.array(loop, dtype=np.int64))
    return loops


def frame_of(places: Points) -> tuple[Floats, Floats]:
    """Return the axes of a loop, shape (3, 3): along it, across, outward; and its extents along these, (3,).

    ``places``, shape (k, 3), in the order of the border sides of the skin.
    """
    around = places - places.mean(axis=0)
    normal = _area_vector(places)
    if not normal.any():
        normal = _axes(around)[2]
    normal = unit(normal)
    flat = around - np.outer(around @ normal, normal)
    along = _axes(flat)[0]
    axes = np.stack([along, np.cross(normal, along), normal])
    return axes, np.asarray(np.ptp(around @ axes.T, axis=0))


def _axes(places: Points) -> Floats:
    """Return the axes of places round the origin, the longest extent first, as rows, shape (3, 3)."""
    return np.asarray(np.linalg.svd(places, full_matrices=len(places) < 3)[2])


def _area_vector(places: Points) -> Floats:
    """Return the vector area of what a loop encloses, outward, shape (3,)."""
    around = places - places.mean(axis=0)  # a border runs against its hole
    return np.asarray(-0.5 * np.cross(around, np.roll(around, -1, axis=0)).sum(axis=0))


def _hole(mesh: Mesh, loop: Indices, faces: Indices) -> Hole:
    places = mesh.vertices[loop]
    axes, extent = frame_of(places)
    areas = mesh.area_vectors[faces]
    looks = float((areas @ axes[2]).sum() / max(np.linalg.norm(areas, axis=1).sum(), 1e-300))
    width, length = sorted(extent[:2].tolist())
    filled = np.linalg.norm(_area_vector(places)) > FILLED * np.prod(np.sort(extent)[1:])
    return Hole(loop, places.mean(axis=0), axes[2], length, width, bool(abs(looks) < TUBE and filled))


def hole_sentences(mesh: Mesh, holes: tuple[Hole, ...]) -> tuple[Message, ...]:
    """Return what the user should know of the ``holes`` of an upright skin, one sentence each."""
    open_ones = [hole for hole in holes if not hole.opening]
    named = [hole_sentence(mesh, hole) for hole in open_ones[:NAMED]]
    more = len(open_ones) - NAMED
    return tuple(named) + ((Message("Further unfilled holes: {count}.", count=more),) if more > 0 else ())


def hole_sentence(mesh: Mesh, hole: Hole) -> Message:
    """Return the size of a hole of an upright skin, and where it is."""
    return Message(
        "Unfilled hole of {long} × {wide} cm: {place}.",
        long=f"{hole.length / 10.0:.0f}",
        wide=f"{hole.width / 10.0:.0f}",
        place=hole.place(mesh),
    )


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


def fill_large_holes(mesh: Mesh, holes: Sequence[Hole]) -> tuple[Mesh, Indices, int]:
    """Return a mesh [mm] with ``holes`` filled, its new vertices, shape (k,), and how many stay open.

    Old vertices keep their numbers. A hole stays open if its border touches itself. Source: ours; the patch
    minimises the squared Laplacian, as Botsch and Kobbelt 2004.
    """
    faces, places, count = [mesh.faces], [mesh.vertices], len(mesh.vertices)
    borders = np.concatenate([*(hole.border for hole in holes), np.empty(0, dtype=np.int64)])
    edges, still_open = edges_at(borders, mesh.faces), 0
    for hole in holes:
        if len(hole.border) < 3 or len(set(hole.border.tolist())) < len(hole.border):
            still_open += 1
            continue
        for laid_out in (False, True):
            patch, new = _patch(mesh, hole.border, laid_out)
            corners = np.concatenate([hole.border, count + np.arange(len(new))])[patch]
            inner = set(edge_keys(corners).tolist()) - set(edge_keys(hole.border[None]).tolist())
            if inner.isdisjoint(edges):
                break
        else:  # a patch would join what is joined already
            still_open += 1
            continue
        edges |= inner
        faces.append(corners)
        places.append(new)
        count += len(new)
    new_ones = np.arange(len(mesh.vertices), count)
    return Mesh(np.concatenate(places), np.concatenate(faces)), new_ones, still_open


def _patch(mesh: Mesh, border: Indices, laid_out: bool) -> tuple[Faces, Points]:
    """Return triangles over a hole and the places in it, shape (k, 3); corners below b are of the border.

    ``laid_out`` round a circle, a border may have any shape; as seen from outside it must not cross itself.
    """
    axes, extent = frame_of(mesh.vertices[border])
    middle, length = mesh.vertices[border].mean(axis=0), float(extent[:2].max())
    rim = _rim(mesh, border)
    known = (mesh.vertices[rim.vertices] - middle) @ axes.T
    patch, inside = _triangles(known[: len(border), :2], length)
    if laid_out or (len(inside) == 0 and len(border) > FEW):
        patch, inside = _triangles(_circle(known[: len(border)]), 0.0)
        local = _settled(rim, patch, np.full((len(inside), 3), np.nan), known, known)
        local = _settled(rim, patch, local, known, known)
        return patch, middle + local @ axes
    bend = quadric_height(_around(mesh, middle, axes, length), max(length, 1e-9))
    start = np.column_stack([inside, bend(inside)])
    off = known[:, 2:] - bend(known[:, :2])[:, None]
    start[:, 2:] += _settled(rim, patch, start, known, off)
    return patch, middle + start @ axes


@dataclass(frozen=True, eq=False)
class _Rim:
    """The skin round a hole: ``vertices``, shape (r,), the ``border`` ones first, and faces of them."""

    vertices: Indices
    faces: Faces
    border: int


def _rim(mesh: Mesh, border: Indices) -> _Rim:
    touched = np.zeros(len(mesh.vertices), dtype=bool)
    touched[border] = True
    for _ in range(RINGS):
        faces = mesh.faces[touched[mesh.faces].any(axis=1)]
        touched[faces] = True
    touched[border] = False
    vertices = np.concatenate([border, np.flatnonzero(touched)])
    number = np.zeros(len(mesh.vertices), dtype=np.int64)
    number[vertices] = np.arange(len(vertices))
    return _Rim(vertices, number[faces], len(border))


def _triangles(outline: Floats, length: float) -> tuple[Faces, Floats]:
    """Triangulate a border, shape (b, 2), that runs against its hole, and strew places in it."""
    faces, inside = triangulate(outline[::-1], length / MOST_STEPS)
    return np.where(faces < len(outline), len(outline) - 1 - faces, faces), inside


def _circle(places: Points) -> Floats:
    """Lay the border of a hole out round a circle of its length, shape (b, 2), against its hole."""
    side = np.linalg.norm(np.roll(places, -1, axis=0) - places, axis=1)
    angle = -2.0 * np.pi * (np.cumsum(side) - side) / side.sum()
    return np.asarray(side.sum() / (2.0 * np.pi) * np.stack([np.cos(angle), np.sin(angle)], axis=1))


def _around(mesh: Mesh, middle: Points, axes: Floats, length: float) -> Points:
    """Return the skin round a hole that looks the same way, in the frame of the hole, shape (k, 3)."""
    local = (mesh.vertices - middle) @ axes.T
    near = (np.linalg.norm(local, axis=1) < 0.75 * length + RIM_WIDTH) & (mesh.vertex_normals @ axes[2] > 0.3)
    near = np.flatnonzero(near & (np.abs(local[:, 2]) < length))
    return np.asarray(local[near[:: max(1, len(near) // MOST_AROUND)]])


def _settled(rim: _Rim, patch: Faces, start: Points, known: Points, values: Floats) -> Floats:
    """Return the values inside a patch, shape (k, d), that continue those of its rim, shape (r, d), smoothly.

    ``start``, shape (k, 3), are rough places inside, NaN where there are none yet; ``known``, shape (r, 3),
    those of the rim.
    """
    b, k = rim.border, len(start)
    if k == 0:
        return np.empty((0, values.shape[1]))
    places = np.concatenate([known[:b], start, known[b:]])
    faces = np.concatenate([patch, np.where(rim.faces < b, rim.faces, rim.faces + k)])
    ends = edges(faces)
    side = np.linalg.norm(places[ends[:, 0]] - places[ends[:, 1]], axis=1)
    pull = (
        1.0 / np.maximum(side, 1e-3 * np.nanmedian(side)) if np.isfinite(side).all() else np.ones(len(side))
    )
    n = len(places)
    joined = sparse.coo_array((pull, (ends[:, 0], ends[:, 1])), shape=(n, n)).tocsr()
    joined = joined + joined.T
    many = np.maximum(np.bincount(ends.ravel(), minlength=n), 1)
    laplacian = sparse.diags_array(1.0 / many) @ (sparse.diags_array(joined.sum(axis=1)) - joined)
    rows = laplacian.tocsr()[: b + k].tocsc()
    free, outer = rows[:, b : b + k], sparse.hstack([rows[:, :b], rows[:, b + k :]])
    return np.asarray(splu((free.T @ free).tocsc()).solve(-(free.T @ (outer @ values))), dtype=np.float64)
