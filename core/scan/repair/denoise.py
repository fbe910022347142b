"""The skin without the noise of the scanner: what all measuring is done on."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
from scipy import sparse

from core.geometry.mesh import Indices, Mesh
from core.progress import Progress, quiet
from core.scan.repair.editable_mesh import EditableMesh, first_equal, grouped
from core.scan.repair.repair import remove_fins

GIANT = 250_000
"""A skin of more triangles is thinned before it is measured."""

CELL = 3.5
"""Edge of the cells in which the vertices of a giant skin are averaged [mm]."""

OTHER_SHEET = 0.25
"""Share of the vertices in a cell [1] that look against the others if two sheets of the skin pass it."""

WHITE = 1.36
"""Height that independent noise of 1 mm gives a vertex over the fourth-order surface round it [mm]."""

SHAPE = 0.0009
"""What the shape of a body itself gives on edges of 1 mm; it grows with their square [1/mm]."""

NOISELESS = 0.35
"""Less noise than this is left as it is [mm]."""

CALMING = "calming the skin"
"""What is said to be at work."""

EDGE = 4.5
"""Edge for which the rounds of smoothing are given [mm]."""


def _go_on() -> None:
    """Nobody asks for an end."""


def denoise(mesh: Mesh, progress: Progress = quiet) -> Mesh:
    """Return ``mesh`` without the noise of the scanner; one without noise and of usual size stays as it is.

    A giant skin is thinned, noise is smoothed without shrinking: the more noise the more, and over the same
    distance [mm] on coarse and fine skins. Raises Cancelled. Source: ours; smoothing after Taubin 1995.
    """
    if len(mesh.faces) > GIANT:
        # noise as large as the triangles would fold the thinned skin
        smooth = _smoothed(mesh, 0.05 * _edge(mesh), 10, progress)
        mesh = decimate(smooth, CELL, partial(progress, CALMING, 0.6))
    return _smoothed(mesh, NOISELESS, 40, progress, 0.8)


def _smoothed(mesh: Mesh, noiseless: float, most: int, progress: Progress, begun: float = 0.0) -> Mesh:
    """Return ``mesh`` smoothed if it has more than ``noiseless`` noise [mm], in ``most`` rounds at most.

    ``begun`` is the share of the work that was done before.
    """
    mean, vertices = _mean_of_neighbours(mesh, partial(progress, CALMING, begun)), mesh.vertices
    noise = _noise(mesh, mean, partial(progress, CALMING, begun + 0.05))
    if noise < noiseless:
        return mesh
    rounds = int(np.clip(8.0 * noise * (EDGE / _edge(mesh)) ** 2, 1, most))
    for number in range(rounds):
        progress(CALMING, begun + 0.1 + 0.1 * number / rounds)
        for share in (0.5, -0.53):
            vertices = vertices + share * (mean @ vertices - vertices)
    return mesh.moved(vertices)


def estimate_noise(mesh: Mesh) -> float:
    """Return the noise of a skin [mm], the standard deviation of its vertices along each axis.

    It is what a fourth-order smooth surface cannot explain, less what the shape of a body leaves there on
    triangles of this size. Source: ours.
    """
    return _noise(mesh, _mean_of_neighbours(mesh))


def _noise(mesh: Mesh, mean: sparse.csr_array, ask: Callable[[], None] = _go_on) -> float:
    ask()
    if len(mesh.faces) == 0:
        return 0.0
    bend = mean @ mesh.vertices - mesh.vertices
    ask()
    normals = mesh.vertex_normals
    ask()
    height = np.einsum("ij,ij->i", mean @ bend - bend, normals)
    raw = 1.48 * float(np.median(np.abs(height))) / WHITE
    return float(np.sqrt(max(raw**2 - (SHAPE * _edge(mesh) ** 2) ** 2, 0.0)))


def decimate(mesh: Mesh, cell: float, ask: Callable[[], None] = _go_on) -> Mesh:
    """Return ``mesh`` with the vertices in each cell of edge ``cell`` [mm] averaged to one.

    Vertices that look different ways stay apart, so that sheets lying on each other do not grow together.
    ``ask`` is called between its steps, and may raise Cancelled. Source: after Rossignac and Borrel 1993.
    """
    ask()
    place = np.floor((mesh.vertices - mesh.vertices.min(axis=0)) / cell).astype(np.int64)
    key = (place[:, 0] << 20 | place[:, 1]) << 20 | place[:, 2]
    member, count = _numbered(key)
    ask()
    normals = mesh.vertex_normals
    ask()
    one = np.empty(len(count), dtype=np.int64)
    one[member] = np.arange(len(member))  # any vertex of the cell
    against = np.einsum("ij,ij->i", normals, normals[one[member]]) < 0.0
    share = np.bincount(member, against) / count
    sheets = (share >= OTHER_SHEET) & (share <= 1.0 - OTHER_SHEET)
    member, count = _numbered(2 * member + (against & sheets[member]))
    ask()
    vertices = np.stack([np.bincount(member, mesh.vertices[:, k]) for k in range(3)], axis=1) / count[:, None]
    faces = member[mesh.faces]
    faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
    skin = remove_fins(EditableMesh(vertices, faces[_first_listed(faces, len(vertices))]).compact())[0]
    return Mesh(skin.vertices, skin.faces)


def _numbered(keys: Indices) -> tuple[Indices, Indices]:
    """Return a number for each key, equal for equal ones, and how many have each number."""
    order, start = grouped(keys)
    count = np.diff(start, append=len(keys))
    number = np.empty(len(keys), dtype=np.int64)
    number[order] = np.repeat(np.arange(len(start)), count)
    return number, count


def _first_listed(faces: Indices, count: int) -> Indices:
    """Return the rows of the faces that are not listed before, in any order of corners, ascending."""
    low, middle, high = np.sort(faces, axis=1).T
    pair = first_equal(low * count + middle)
    first = first_equal(pair * count + high)
    return np.flatnonzero(first == np.arange(len(faces)))


def _edge(mesh: Mesh) -> float:
    sides = mesh.vertices[mesh.faces[:, 1]] - mesh.vertices[mesh.faces[:, 0]]
    if len(sides) == 0:
        return EDGE
    return max(float(np.median(np.sqrt(np.einsum("ij,ij->i", sides, sides)))), 1e-9)


def _mean_of_neighbours(mesh: Mesh, ask: Callable[[], None] = _go_on) -> sparse.csr_array:
    """Return the matrix that averages the neighbours of each vertex, shape (n, n).

    ``ask`` is called between its steps, and may raise Cancelled.
    """
    ask()
    corner, count = mesh.faces, len(mesh.vertices)
    pairs = (corner.ravel(), corner[:, [1, 2, 0]].ravel())
    around = sparse.csr_array((np.ones(corner.size), pairs), shape=(count, count))
    ask()
    around = around + around.T
    ask()
    return sparse.csr_array(sparse.diags_array(1.0 / np.maximum(around.sum(axis=0), 1.0)) @ around)
