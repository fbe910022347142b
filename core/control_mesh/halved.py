"""A control mesh whose edges are halved: the same surface with a point in the middle of each edge."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
from scipy import sparse

from core.control_mesh.embedding import EmbeddedCurve, Grid, embed
from core.control_mesh.fit import ControlMesh
from core.geometry.mesh import Indices, Mesh


def halved(control: ControlMesh) -> ControlMesh:
    """Return ``control`` with a point in the middle of each edge; its own points come first.

    Points of triangles at the border are fixed; other points that were, and middles between two of them, are
    anchored. A middle has row and column of the end farther from 0. Lines run over the middles too, and are
    as long as before.
    """
    mesh, count = control.mesh, len(control.mesh.vertices)
    ends = mesh.edges
    middles = mesh.vertices[ends].mean(axis=1)
    number = _numbers(mesh)
    a, b, c = mesh.faces.T
    ab, bc, ca = (np.asarray(number[one, other]).ravel() for one, other in ((a, b), (b, c), (c, a)))
    parts = ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))
    faces = np.concatenate([np.stack(part, axis=1) for part in parts])
    row, column = (np.concatenate([2 * at, at[ends].sum(axis=1)]) for at in (control.row, control.column))
    grid = Grid(row, column, faces)
    paths = {name: _through(path, number) for name, path in control.paths.items()}
    border = np.array(_through((*control.border, control.border[0]), number)[:-1])
    at_border = np.unique(faces[np.isin(faces, border).any(axis=1)])
    return replace(
        control,
        mesh=Mesh(np.concatenate([mesh.vertices, middles]), faces),
        fixed=np.isin(np.arange(count + len(ends)), at_border),
        anchored=np.concatenate([control.fixed, control.fixed[ends].all(axis=1)]),
        row=_with_outer(control.row, ends),
        column=_with_outer(control.column, ends),
        paths=paths,
        border=border,
        embedded={name: _finer(curve, grid) for name, curve in control.embedded.items()},
    )


def _finer(curve: EmbeddedCurve, grid: Grid) -> EmbeddedCurve:
    """Return a curve on the halved mesh, whose ``grid`` counts rows and columns by halves."""
    finer = embed(grid, [(row, column) for row, column in (2.0 * curve.places).tolist()])
    return replace(finer, places=0.5 * finer.places)


def through_middles(path: tuple[int, ...], mesh: Mesh) -> tuple[int, ...]:
    """Return a path of neighbours in ``mesh`` as it runs over the middles of its edges when it is halved."""
    return _through(path, _numbers(mesh))


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
