"""Chest wall under a skin, and tetrahedra between the two."""

from __future__ import annotations

import numpy as np
import tetgen
from reference.elements import TetMesh, quadratic_mesh
from reference.skin import closest
from scipy import sparse
from scipy.sparse.linalg import spsolve

from core.geometry.mesh import Flags, Floats, Indices, Mesh, Points

DEPTH = 12.0
"""Depth of the chest wall under skin over fixed control points [mm]."""

ROUNDS = 40
"""So often the film is relaxed."""


def over_fixed(skin: Mesh, control: Mesh, fixed: Flags) -> Flags:
    """Return which vertices of ``skin`` have a nearest control triangle with three fixed corners, (n,)."""
    face, _ = closest(control, skin.vertices)
    return np.asarray(fixed[control.faces[face]].all(axis=1))


def chest_wall(skin: Mesh, held: Flags) -> Points:
    """Return a place on the wall for each vertex of ``skin``, (n, 3) [mm].

    Under the rim and vertices ``held`` it is ``DEPTH`` inward along the normals, evened over neighbours;
    between them is the film of least area. Source: Pinkall and Polthier (1993).
    """
    rim = np.concatenate(skin.boundary_loops)
    held = held.copy()
    held[rim] = True
    wall = np.array(skin.vertices)
    wall[held] -= DEPTH * _even_normals(skin, 2)[held]
    for _ in range(ROUNDS):
        matrix = _cotangents(skin.moved(wall))
        pull = matrix[~held][:, held] @ wall[held]
        wall[~held] = spsolve(matrix[~held][:, ~held].tocsc(), -pull)
    return wall


def _even_normals(skin: Mesh, rounds: int) -> Points:
    """Return vertex normals, each the mean over neighbours taken ``rounds`` times, (n, 3) [1]."""
    ends, count = skin.edges, len(skin.vertices)
    pairs = np.concatenate([ends, ends[:, ::-1], np.repeat(np.arange(count)[:, None], 2, axis=1)])
    mean = sparse.csr_array((np.ones(len(pairs)), pairs.T), shape=(count, count))
    normals = skin.vertex_normals
    for _ in range(rounds):
        normals = mean @ normals
        normals /= np.linalg.norm(normals, axis=1)[:, None]
    return np.asarray(normals)


def _cotangents(mesh: Mesh) -> sparse.csr_array:
    """Return the Laplacian with half the cotangents of opposite angles, at least 0.01, (n, n)."""
    count = len(mesh.vertices)
    total = sparse.csr_array((count, count))
    for turn in range(3):
        tip, one, other = np.roll(mesh.faces, turn, axis=1).T
        u, v = mesh.vertices[one] - mesh.vertices[tip], mesh.vertices[other] - mesh.vertices[tip]
        area = np.maximum(np.linalg.norm(np.cross(u, v), axis=1), 1e-9)
        weight: Floats = np.clip(0.5 * (u * v).sum(axis=1) / area, 0.01, 50.0)
        total = total + sparse.coo_array((-weight, (one, other)), shape=(count, count))
    total = total + total.T
    return sparse.csr_array(total - sparse.diags_array(np.asarray(total.sum(axis=1)).ravel()))


def closed_surface(skin: Mesh, wall: Points) -> Mesh:
    """Return the surface of the tissue: vertices of ``skin``, then those of ``wall``, wound outward."""
    count = len(skin.vertices)
    loop = skin.boundary_loops[0]
    following = np.roll(loop, -1)
    sides = [np.stack(each, axis=1) for each in ((following, loop, loop + count), (following, loop + count, following + count))]
    faces = np.concatenate([skin.faces, skin.faces[:, ::-1] + count, *sides])
    return Mesh(np.concatenate([skin.vertices, wall]), faces)


def tetrahedra(skin: Mesh, wall: Points, largest: float) -> TetMesh:
    """Return quadratic tetrahedra of at most ``largest`` [mm^3]; the first nodes are ``skin``, then ``wall``."""
    outside = closed_surface(skin, wall)
    mesher = tetgen.TetGen(np.array(outside.vertices), np.array(outside.faces))
    nodes, tets, *_ = mesher.tetrahedralize(
        nobisect=True, nomergefacet=True, quality=True, minratio=1.6, mindihedral=5.0, maxvolume=largest, quiet=True
    )
    return quadratic_mesh(np.asarray(nodes), np.asarray(tets).astype(np.int64))


def still_nodes(mesh: TetMesh, skin: Mesh) -> Flags:
    """Return the nodes on wall and rim, (n,): corners of both, and middles of edges on their surface."""
    count = len(skin.vertices)
    outside = closed_surface(skin, mesh.nodes[count : 2 * count])
    faces: Indices = mesh.quadratic_faces(outside.faces[len(skin.faces) :])
    still = np.zeros(len(mesh.nodes), dtype=bool)
    still[faces] = True
    return still
