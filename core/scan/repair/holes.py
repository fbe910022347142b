"""The holes of a skin: where they are, how large, and which of them are the ends of a cut body."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.geometry.mesh import Flags, Floats, Indices, Mesh, Points, unit
from core.messages import Message, context_message
from core.scan.repair.editable_mesh import EditableMesh

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
    return tuple(named) + ((Message("{count} more holes are unfilled.", count=more),) if more > 0 else ())


def hole_sentence(mesh: Mesh, hole: Hole) -> Message:
    """Return the size of a hole of an upright skin, and where it is."""
    return Message(
        "Unfilled hole of {long} × {wide} cm: {place}.",
        long=f"{hole.length / 10.0:.0f}",
        wide=f"{hole.width / 10.0:.0f}",
        place=hole.place(mesh),
    )
