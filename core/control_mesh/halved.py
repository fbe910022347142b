"""A control mesh whose edges are halved, the new points lying on the skin."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from itertools import pairwise

import numpy as np
from scipy import sparse

from core.control_mesh.embedding import EmbeddedCurve, Grid, embed
from core.control_mesh.fit import ControlMesh
from core.geometry.closest_point import nearest_faces
from core.geometry.mesh import Flags, Indices, Mesh, Points

BULGE = 0.15
"""Skin further from the middle of an edge than this part of its length [1] is not what the edge spans."""


def halved(control: ControlMesh, skin: Mesh) -> ControlMesh:
    """Return ``control`` with a point on ``skin`` at the middle of each edge; its own points come first.

    Points of triangles at the border are fixed; other points that were, and middles between two of them, are
    anchored. A middle has row and column of the end farther from 0, and stays where it is if the skin is far
    away, as at a crease. Lines run over the middles too.
    """
    mesh, count = control.mesh, len(control.mesh.vertices)
    ends = mesh.edges
    middles = _on_skin(mesh.vertices[ends], skin)
    number = _numbers(mesh)
    a, b, c = mesh.faces.T
    ab, bc, ca = (np.asarray(number[one, other]).ravel() for one, other in ((a, b), (b, c), (c, a)))
    parts = ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))
    faces = np.concatenate([np.stack(part, axis=1) for part in parts])
    row, column = (np.concatenate([2 * at, at[ends].sum(axis=1)]) for at in (control.row, control.column))
    grid = Grid(row, column, faces)
    paths = {name: _through(path, number) for name, path in control.paths.items()}
    borders = tuple(np.array(_through((*loop, loop[0]), number)[:-1]) for loop in control.borders)
    at_border = np.unique(faces[np.isin(faces, np.concatenate(borders)).any(axis=1)])
    return replace(
        control,
        mesh=Mesh(np.concatenate([mesh.vertices, middles]), faces),
        fixed=np.isin(np.arange(count + len(ends)), at_border),
        anchored=np.concatenate([control.fixed, control.fixed[ends].all(axis=1)]),
        row=_with_outer(control.row, ends),
        column=_with_outer(control.column, ends),
        paths=paths,
        borders=borders,
        embedded={name: _finer(curve, grid) for name, curve in control.embedded.items()},
    )


def _on_skin(ends: Points, skin: Mesh) -> Points:
    """Return the place on ``skin`` nearest to the middle of each edge, (e, 2, 3) to (e, 3) [mm], if near."""
    middles = ends.mean(axis=1)
    _, places = nearest_faces(skin, middles)
    away, length = (np.linalg.norm(each, axis=1) for each in (places - middles, ends[:, 1] - ends[:, 0]))
    return np.where((away <= BULGE * length)[:, None], places, middles)


def off_skin(control: ControlMesh, fine: ControlMesh) -> Flags:
    """Return which points of ``fine``, which halves ``control``, stay in the air over a crease, (n,)."""
    before = control.mesh.vertices
    straight = before[control.mesh.edges].mean(axis=1)
    off = (fine.mesh.vertices[len(before) :] == straight).all(axis=1)
    return np.concatenate([np.zeros(len(before), dtype=bool), off])


def _finer(curve: EmbeddedCurve, grid: Grid) -> EmbeddedCurve:
    """Return a curve on the halved mesh, whose ``grid`` counts rows and columns by halves."""
    finer = embed(grid, [(row, column) for row, column in (2.0 * curve.places).tolist()])
    return replace(finer, places=0.5 * finer.places)


def through_middles(path: tuple[int, ...], mesh: Mesh) -> tuple[int, ...]:
    """Return a path of neighbours in ``mesh`` as it runs over the middles of its edges when it is halved."""
    return _through(path, _numbers(mesh))


@lru_cache(maxsize=2)
def _numbers(mesh: Mesh) -> sparse.csr_array:
    """Return the number of the middle between each pair of neighbours, (n, n)."""
    count, ends = len(mesh.vertices), mesh.edges
    number = sparse.csr_array((np.arange(count, count + len(ends)), tuple(ends.T)), shape=(count, count))
    return sparse.csr_array(number + number.T)


def _through(path: tuple[int, ...], number: sparse.csr_array) -> tuple[int, ...]:
    """Return a path of neighbours with the middles between them."""
    through = [int(path[0])]
    for start, end in pairwise(path):
        through += [int(number[start, end]), int(end)]
    return tuple(through)


def _with_outer(values: Indices, ends: Indices) -> Indices:
    """Return ``values`` (n,) and, for each pair of ``ends``, that of the end farther from 0."""
    both = values[ends]
    outer = np.abs(both).argmax(axis=1)
    return np.concatenate([values, both[np.arange(len(ends)), outer]])
