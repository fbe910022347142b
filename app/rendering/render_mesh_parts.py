"""The pieces that a skin is drawn in, as arrays for the graphics, and a rough copy of a large one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
import numpy.typing as npt

from app.rendering.render_mesh import RenderMesh
from core.geometry.mesh import Faces, Flags, Indices

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


_KNOWN: WeakKeyDictionary[RenderMesh, tuple[Indices, MeshParts]] = WeakKeyDictionary()


def mesh_parts(skin: RenderMesh, moving: Indices) -> MeshParts:
    """Return the pieces of a skin of which some vertices of the body move, shape (k,).

    They are kept until others are asked for. Runs in any thread.
    """
    known = _KNOWN.get(skin)
    if known is None or known[0] is not moving:
        known = _KNOWN[skin] = moving, _parted(skin, moving)
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
