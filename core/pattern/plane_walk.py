"""Ways over a skin in planes, from one place on it: all of them at once, a triangle a step (ours)."""

from __future__ import annotations

import numpy as np

from core.geometry.closest_point import barycentric, nearest_faces
from core.geometry.mesh import Flags, Indices, Mesh, Points

_INSIDE = 1e-3
"""A way begins so far from the edges of its triangle [1]: each then leaves it by one."""

_MOST_STEPS = 3000


def walk_planes(mesh: Mesh, start: Points, ways: Points, normals: Points, length: float) -> list[Points]:
    """Walk from ``start`` (3,) [mm] along the skin as the planes with ``normals`` (r, 3) through it cut it.

    Each begins in its direction of ``ways`` (r, 3) and ends after ``length`` [mm], at a border or where it
    began. Returns the places of each, (k, 3) [mm], ``start`` first.
    """
    face, foot = nearest_faces(mesh, start[None], mesh.centroid_tree)
    first = int(face[0])
    corners = mesh.vertices[mesh.faces[face]]
    shares = np.maximum(barycentric(corners, foot), _INSIDE)[0]
    origin = shares / shares.sum() @ corners[0]
    here, entered = np.full(len(ways), first), np.full(len(ways), -1)
    gone, last = np.zeros(len(ways)), np.repeat(origin[None], len(ways), axis=0)
    going = np.arange(len(ways))
    found = [(going, np.repeat(start[None], len(ways), axis=0))]
    for _ in range(_MOST_STEPS):
        if not len(going):
            break
        crossed, places, key = _sides(mesh, here[going], origin, normals[going])
        forward = np.einsum("ijk,ik->ij", places - origin, ways[going])
        value = np.where(crossed & (key != entered[going][:, None]), forward, -np.inf)
        row, out = np.arange(len(going)), value.argmax(axis=1)
        seen = np.isfinite(value[row, out])
        row, out, going = row[seen], out[seen], going[seen]
        place = places[row, out]
        found.append((going, place))
        gone[going] += np.linalg.norm(place - last[going], axis=1)
        last[going], entered[going] = place, key[row, out]
        beyond = mesh.face_neighbours[here[going], out]
        here[going] = beyond
        going = going[(beyond >= 0) & (beyond != first) & (gone[going] < length)]
    number, whole = (np.concatenate(column) for column in zip(*found, strict=True))
    ends = np.cumsum(np.bincount(number))[:-1]
    return np.split(whole[np.argsort(number, kind="stable")], ends)


def _sides(mesh: Mesh, faces: Indices, origin: Points, normals: Points) -> tuple[Flags, Points, Indices]:
    """Return which sides of ``faces`` (r,) planes through ``origin`` cross, where, and a number of each."""
    corners = mesh.faces[faces]
    after = np.roll(corners, -1, axis=1)
    low, high = np.minimum(corners, after), np.maximum(corners, after)
    ends = mesh.vertices[low] - origin, mesh.vertices[high] - origin
    at_low, at_high = (np.einsum("ijk,ik->ij", end, normals) for end in ends)
    crossed = (at_low >= 0.0) != (at_high >= 0.0)
    share = at_low / np.where(crossed, at_low - at_high, 1.0)
    places = origin + ends[0] + share[..., None] * (ends[1] - ends[0])
    return crossed, places, low * len(mesh.vertices) + high
