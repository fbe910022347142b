"""Chest wall under a skin, and tetrahedra between the two."""

from __future__ import annotations

import numpy as np
import tetgen
from scipy import sparse
from scipy.sparse.linalg import spsolve

from core.geometry.mesh import Flags, Floats, Indices, Mesh, Points
from reference.elements import TetMesh, quadratic_mesh
from reference.skin import closest

DEPTH = 12.0
"""Depth of the chest wall under skin over fixed control points [mm]."""

ROUNDS = 40
"""Rounds in which the film is relaxed."""

SMOOTHINGS = 5
"""Rounds in which each place of the wall moves to the mean of its neighbours."""


def over_fixed(places: Points, control: Mesh, fixed: Flags) -> Flags:
    """Return which of ``places`` (n, 3) have a nearest control triangle with three fixed corners, (n,)."""
    face, _ = closest(control, places)
    return np.asarray(fixed[control.faces[face]].all(axis=1))


def chest_wall(skin: Mesh, held: Flags) -> Points:
    """Return a place on the wall for each vertex of ``skin``, (n, 3) [mm].

    Under the rim and vertices ``held`` it is ``DEPTH`` inward, between them the film of least area; all but
    the rim is then smoothed. Source: Pinkall and Polthier (1993).
    """
    inner = np.ones(len(held), dtype=bool)
    inner[np.concatenate(skin.boundary_loops)] = False
    held = held | ~inner
    mean = _neighbour_mean(skin)
    normals = mean @ (mean @ skin.vertex_normals)
    wall = np.array(skin.vertices)
    wall[held] -= DEPTH * (normals / np.linalg.norm(normals, axis=1)[:, None])[held]
    for _ in range(ROUNDS):
        matrix = _cotangents(skin.moved(wall))
        pull = matrix[~held][:, held] @ wall[held]
        wall[~held] = spsolve(matrix[~held][:, ~held].tocsc(), -pull)
    for _ in range(SMOOTHINGS):
        wall[inner] = (mean @ wall)[inner]
    return wall


def _neighbour_mean(skin: Mesh) -> sparse.csr_array:
    """Return the matrix of means over the neighbours of each vertex, (n, n)."""
    pairs = np.concatenate([skin.edges, skin.edges[:, ::-1]])
    count = len(skin.vertices)
    near = sparse.csr_array((np.ones(len(pairs)), pairs.T), shape=(count, count))
    return sparse.csr_array(sparse.diags_array(1.0 / near.sum(axis=1)) @ near)


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
    sides = [
        np.stack(each, axis=1)
        for each in ((following, loop, loop + count), (following, loop + count, following + count))
    ]
    faces = np.concatenate([skin.faces, skin.faces[:, ::-1] + count, *sides])
    return Mesh(np.concatenate([skin.vertices, wall]), faces)


def tetrahedra(skin: Mesh, wall: Points, largest: float) -> TetMesh:
    """Return quadratic tetrahedra up to ``largest`` [mm^3]; their first nodes are ``skin``, then ``wall``."""
    outside = closed_surface(skin, wall)
    mesher = tetgen.TetGen(np.array(outside.vertices), np.array(outside.faces))
    nodes, tets, *_ = mesher.tetrahedralize(
        nobisect=True,
        nomergefacet=True,
        quality=True,
        minratio=1.6,
        mindihedral=5.0,
        maxvolume=largest,
        quiet=True,
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
