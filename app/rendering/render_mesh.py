"""The skin as it is drawn: the rims of cut plates are doubled, so that they look crisp."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from weakref import WeakKeyDictionary

import numpy as np
import numpy.typing as npt
from scipy import sparse
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from app.rendering.framing import box_of
from core.geometry.mesh import Flags, Floats, Indices, Mesh
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
        """The unit normals of its vertices, shape (n + d, 3), in the precision of the graphics."""
        return self.mesh.vertex_normals.astype(np.float32)

    @cached_property
    def tree(self) -> cKDTree:
        """The body's own vertices, to find those nearest to a place."""
        return cKDTree(self.mesh.vertices[: int(self.source.max(initial=-1)) + 1])

    @cached_property
    def box(self) -> Floats:
        """The body's least and largest coordinates, shape (3, 2) [mm]."""
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
