"""The skin as it is drawn: the rims of cut plates are doubled, so that they look crisp."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
import numpy.typing as npt
from scipy import sparse
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from app.rendering.camera import box_of
from core.geometry.mesh import Faces, Flags, Floats, Indices, Mesh
from core.progress import Progress, quiet

PREPARING = "preparing the view"
"""What is said to be at work."""

PLATE_AREA = 1500.0
"""Smallest flat area that counts as a cut plate and not as skin [mm^2]."""


@dataclass(frozen=True, eq=False)
class RenderMesh:
    """A mesh whose vertices at the rims of plates are doubled, so that the rim looks crisp.

    ``mesh`` has the body's own n vertices first and the doubles after them; ``source`` is the body vertex of
    each, shape (n + d,); ``plate`` marks the vertices of plates, shape (n + d,).
    """

    mesh: Mesh
    source: Indices
    plate: Flags

    @cached_property
    def normals(self) -> npt.NDArray[np.float32]:
        """Return the unit normals of its vertices, shape (n + d, 3), in the precision of the graphics."""
        return self.mesh.vertex_normals.astype(np.float32)

    @cached_property
    def tree(self) -> cKDTree:
        """Return the body's own vertices, to find those nearest to a place."""
        return cKDTree(self.mesh.vertices[: int(self.source.max(initial=-1)) + 1])

    @cached_property
    def box(self) -> Floats:
        """Return the body's least and largest coordinates, shape (3, 2) [mm]."""
        return box_of(self.mesh.vertices)


def split_plates(mesh: Mesh, progress: Progress = quiet) -> RenderMesh:
    """Return ``mesh`` with the rims of its cut plates doubled. Raises Cancelled."""
    plate_face = plate_faces(mesh, progress)
    count = len(mesh.vertices)
    on_plate, on_skin = np.zeros(count, dtype=bool), np.zeros(count, dtype=bool)
    on_plate[mesh.faces[plate_face]] = True
    on_skin[mesh.faces[~plate_face]] = True
    rim = np.flatnonzero(on_plate & on_skin)
    double = np.arange(count)
    double[rim] = count + np.arange(len(rim))
    faces = np.where(plate_face[:, None], double[mesh.faces], mesh.faces)
    source = np.concatenate([np.arange(count), rim])
    plate = np.concatenate([on_plate & ~on_skin, np.ones(len(rim), dtype=bool)])
    return RenderMesh(Mesh(mesh.vertices[source], faces), source, plate)


def plate_faces(mesh: Mesh, progress: Progress = quiet) -> Flags:
    """Return which faces belong to a flat area larger than ``PLATE_AREA``, shape (m,). Raises Cancelled."""
    count = len(mesh.faces)
    half = np.sort(mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    key = half[:, 0] * len(mesh.vertices) + half[:, 1]
    progress(PREPARING, 0.01)
    order = np.argsort(key, kind="stable")
    progress(PREPARING, 0.04)
    twin = np.flatnonzero(np.diff(key[order]) == 0)
    a, b = order[twin] // 3, order[twin + 1] // 3
    flat = np.einsum("ij,ij->i", mesh.face_normals[a], mesh.face_normals[b]) > np.cos(np.radians(1.0))
    progress(PREPARING, 0.07)
    links = sparse.coo_array((np.ones(int(flat.sum())), (a[flat], b[flat])), shape=(count, count))
    areas_number, label = connected_components(links, directed=False)
    facing = np.stack([np.bincount(label, column, areas_number) for column in mesh.area_vectors.T], axis=1)
    area = np.bincount(label, mesh.face_areas, areas_number)
    # A gently curved stretch of skin also links up, but its normals do not add up to its area.
    straight = np.linalg.norm(facing, axis=1) > 0.9999 * area
    return np.asarray(((area > PLATE_AREA) & straight)[label])


_KNOWN: WeakKeyDictionary[Mesh, RenderMesh] = WeakKeyDictionary()


def render_mesh(mesh: Mesh, progress: Progress = quiet) -> RenderMesh:
    """Return the skin of ``mesh``, worked out once, with all that takes long to work out before it is drawn.

    Runs in any thread: of a large scan it takes seconds, and the window's thread has none. Raises Cancelled.
    """
    progress(PREPARING, 0.0)
    skin = _KNOWN.get(mesh)
    if skin is None:
        skin = _KNOWN[mesh] = split_plates(mesh, progress)
    progress(PREPARING, 0.1)
    normals = mesh.vertex_normals
    if len(skin.source) == len(normals):  # nothing is doubled: they are the same, which takes seconds to find
        vars(skin.mesh)["vertex_normals"] = normals
    # They are kept where they belong once they were asked for.
    kept: tuple[tuple[object, str], ...] = (skin, "normals"), (mesh, "boundary_loops")
    kept += (skin, "tree"), (skin, "box")
    for done, (owner, what) in enumerate(kept, 1):
        progress(PREPARING, 0.1 + 0.9 * done / (len(kept) + 1))
        getattr(owner, what)
    return skin


Singles = npt.NDArray[np.float32]

NONE: Indices = np.empty(0, dtype=np.int64)
"""No vertices."""

LARGE = 250_000
"""A piece of more faces that stands still has a rough copy."""

CELL = 2.5
"""Edge of the cells in which the vertices of a rough copy are averaged [mm]."""


@dataclass(frozen=True, eq=False)
class MeshPart:
    """Some faces of a skin, with only their own vertices: ``rows`` of the skin, shape (r,).

    ``places`` [mm] and unit ``normals``, both (r, 3), are those at rest; ``faces`` (m, 3) count the rows.
    ``held`` (n,) are all vertices of the skin that it stands for.
    """

    rows: Indices
    places: Singles
    normals: Singles
    faces: Faces
    held: Flags


class MeshParts(NamedTuple):
    """A skin in the faces that stand still and those of which a vertex moves, None where there are none.

    ``rough`` stands for the still ones if they are many: far fewer faces, which end where those do.
    """

    static: MeshPart | None
    moving: MeshPart | None
    rough: MeshPart | None


_KNOWN_PIECES: WeakKeyDictionary[RenderMesh, tuple[Indices, MeshParts]] = WeakKeyDictionary()


def mesh_parts(skin: RenderMesh, moving: Indices) -> MeshParts:
    """Return the pieces of a skin of which some vertices of the body move, shape (k,).

    They are kept until others are asked for. Runs in any thread.
    """
    known = _KNOWN_PIECES.get(skin)
    if known is None or known[0] is not moving:
        known = _KNOWN_PIECES[skin] = moving, _parted(skin, moving)
    return known[1]


def _parted(skin: RenderMesh, moving: Indices) -> MeshParts:
    moves = np.zeros(int(skin.source.max(initial=-1)) + 1, dtype=bool)
    moves[moving] = True
    move = np.asarray(moves[skin.source][skin.mesh.faces].any(axis=1))
    still, drawn = _piece_of(skin, ~move), _piece_of(skin, move)
    rough = None
    if still is not None and len(still.faces) > LARGE:
        rim = np.zeros(len(still.rows), dtype=bool) if drawn is None else drawn.held[still.rows]
        rough = _roughened(still, skin.plate[still.rows], rim)
    return MeshParts(still, drawn, rough)


def _piece_of(skin: RenderMesh, chosen: Flags) -> MeshPart | None:
    if not chosen.any():
        return None
    corners = skin.mesh.faces[chosen]
    held = np.zeros(len(skin.mesh.vertices), dtype=bool)
    held[corners] = True
    rows = np.flatnonzero(held)
    places = skin.mesh.vertices[rows].astype(np.float32)
    return MeshPart(rows, places, skin.normals[rows], (np.cumsum(held) - 1)[corners], held)


def _roughened(piece: MeshPart, plate: Flags, rim: Flags) -> MeshPart:
    """Return a piece with the mean of vertices that share a cell and a side; those of the ``rim`` stay."""
    x, y, z = ((piece.places - piece.places.min(axis=0)) / CELL).astype(np.int64).T
    side = 2 * np.argmax(np.abs(piece.normals), axis=1)
    side += np.take_along_axis(piece.normals, side[:, None] // 2, axis=1)[:, 0] > 0.0
    key = ((x << 16 | y) << 16 | z) << 4 | 2 * side + plate
    key[rim] = -1 - np.arange(np.count_nonzero(rim))
    _, one, member = np.unique(key, return_index=True, return_inverse=True)
    count = np.bincount(member)
    places, normals = (
        np.stack([np.bincount(member, axis) / count for axis in of.T], axis=1).astype(np.float32)
        for of in (piece.places, piece.normals)
    )
    faces = member[piece.faces]
    faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
    return MeshPart(piece.rows[one], places, normals, faces, piece.held)
