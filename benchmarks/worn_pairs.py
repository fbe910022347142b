"""A scan without and one with the garment, made: the second is what a design with other numbers predicts.

What a scanner does to it: another place and another turn, another mesh, noise, a hole, arms cut off.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from core.analysis.calibration.fit import solve_from
from core.analysis.calibration.registration import rotation_about
from core.deformation.blend_region import blend_weights
from core.deformation.tffd import bind, deform
from core.document.design import Design
from core.export.mesh import write_mesh
from core.geometry.mesh import Mesh
from core.pipeline.build import Stages, build

_CELL = 1.07  # of the spacing: a cube's edge at which a skin has one vertex to each square of it
LEAN = 4.0  # degrees about x and y; a turn about z is undone when a scan is set upright, but not all of it


def worn_mesh(stages: Stages, truth: Design, finer: int = 0, skin: Mesh | None = None) -> Mesh:
    """Return the body as ``truth`` predicts it, its triangles split in four ``finer`` times before that.

    If there is a ``skin`` [mm] it is that which follows, else that of the body that was scanned first.
    """
    there = build(truth, stages)
    mesh, binding = skin or there.body.mesh, there.binding
    for _ in range(finer):
        mesh = split(mesh)
    if finer or skin:
        fade = blend_weights(mesh, there.control).fade
        how = {"scaled_normals": truth.scaled_normals, "fixed": there.control.fixed}
        binding = bind(mesh, there.control.mesh, fade, truth.weights, **how)
    return mesh.moved(deform(binding, solve_from(there).place.points))


def scanned(
    mesh: Mesh,
    stages: Stages,
    rng: np.random.Generator,
    *,
    noise: float = 1.0,
    resampled: bool = True,
    spacing: float = 0.0,
    hole: float = 20.0,
    arms: bool = False,
) -> tuple[Mesh, np.ndarray]:
    """Return a body as a scanner would give it, and the matrix (4, 4) that took it there.

    ``noise`` [mm] is the standard deviation at each vertex along each axis, ``hole`` [mm] the radius of a
    hole in the front, 0 for none; with ``arms`` they stay. ``resampled`` it has other vertices, one to a
    square of ``spacing`` [mm], or if that is 0 about as many as before.
    """
    if not arms:
        low, high = stages.control.mesh.vertices[:, 0].min(), stages.control.mesh.vertices[:, 0].max()
        x = mesh.vertices[:, 0]
        mesh = only(mesh, (x > low - 40.0) & (x < high + 40.0))
    if resampled:
        mesh = met(mesh, _CELL * spacing) if spacing else other_mesh(mesh)
    if hole:
        front = stages.moving.rest[: stages.moving.count]
        middle = front[rng.integers(len(front))]
        mesh = only(mesh, np.linalg.norm(mesh.vertices - middle, axis=1) > hole)
    angles = np.radians(rng.uniform([-LEAN, -LEAN, -8.0], [LEAN, LEAN, 8.0]))
    matrix = rotation_about(angles, mesh.vertices.mean(axis=0))
    matrix[:3, 3] += rng.uniform(-150.0, 150.0, 3)
    vertices = mesh.vertices @ matrix[:3, :3].T + matrix[:3, 3]
    return mesh.moved(vertices + noise * rng.normal(size=vertices.shape)), matrix


def bent(mesh: Mesh, rng: np.random.Generator, height: float) -> Mesh:
    """Return a body bent as breath would bend it: waves of 150 to 300 mm, ``height`` [mm] (rms)."""
    return mesh.moved(mesh.vertices + (height * _swell(mesh.vertices, rng))[:, None] * mesh.vertex_normals)


def _swell(places: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    ways = rng.normal(size=(40, 3))
    ways *= 2.0 * np.pi / (rng.uniform(150.0, 300.0, 40) * np.linalg.norm(ways, axis=1))[:, None]
    phases = rng.uniform(0.0, 2.0 * np.pi, 40)
    return np.asarray(np.sqrt(2.0 / 40.0) * np.cos(places @ ways.T + phases).sum(axis=1))


def rough(mesh: Mesh, rng: np.random.Generator, spacing: float, noise: float = 1.0) -> Mesh:
    """Return a body as a scanner would give it without turning or cutting it; see ``scanned``."""
    if spacing:
        mesh = met(split(split(mesh)), _CELL * spacing)
    return mesh.moved(mesh.vertices + noise * rng.normal(size=mesh.vertices.shape))


def only(mesh: Mesh, kept: np.ndarray) -> Mesh:
    """Return what is left of a mesh with the vertices ``kept`` (n,)."""
    faces = mesh.faces[kept[mesh.faces].all(axis=1)]
    used, place = np.unique(faces, return_inverse=True)
    return Mesh(mesh.vertices[used], place.reshape(-1, 3))


def other_mesh(mesh: Mesh) -> Mesh:
    """Return the same skin with about as many other vertices: those that lie in the middle of its edges."""
    edges = mesh.vertices[mesh.edges]
    size = 0.95 * float(np.median(np.linalg.norm(edges[:, 0] - edges[:, 1], axis=1)))
    return met(split(mesh), size, old=len(mesh.vertices))


def split(mesh: Mesh) -> Mesh:
    """Return a mesh with each triangle in four, the new vertices behind the old ones.

    A scanner's places lie on the skin, not in its chords: the middle of an edge is lifted by what the
    normals of its ends turn, as a parabola would be.
    """
    edges = mesh.edges
    first, last = mesh.vertices[edges[:, 0]], mesh.vertices[edges[:, 1]]
    ends = mesh.vertex_normals[edges]
    lift = np.einsum("ij,ij->i", last - first, ends[:, 1] - ends[:, 0]) / 8.0
    way = ends.sum(axis=1)
    middle = 0.5 * (first + last) + lift[:, None] * way / np.linalg.norm(way, axis=1)[:, None]
    count = len(mesh.vertices)
    keys = edges[:, 0] * count + edges[:, 1]  # in order, as edges are
    corners = mesh.faces
    between = [
        count + np.searchsorted(keys, np.sort(corners[:, pair], axis=1) @ np.array([count, 1]))
        for pair in ([0, 1], [1, 2], [2, 0])
    ]
    (a, b, c), (ab, bc, ca) = corners.T, between
    quarters = (a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)
    faces = np.concatenate([np.stack(each, axis=1) for each in quarters])
    return Mesh(np.concatenate([mesh.vertices, middle]), faces)


def met(mesh: Mesh, size: float, old: int = 0) -> Mesh:
    """Return a mesh with one vertex kept of what lies together in a cube of a ``size`` [mm].

    It is that nearest to their middle, the first ``old`` ones only where there is no other.
    """
    points = mesh.vertices
    _, place = np.unique(np.floor(points / size).astype(int), axis=0, return_inverse=True)
    place = place.ravel()
    many = np.bincount(place)
    middle = np.stack([np.bincount(place, points[:, axis]) / many for axis in range(3)], axis=1)
    away = np.linalg.norm(points - middle[place], axis=1)
    chosen = np.lexsort((away, np.arange(len(points)) < old, place))[np.cumsum(many) - many]
    faces = place[mesh.faces]
    faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
    _, once = np.unique(np.sort(faces, axis=1), axis=0, return_index=True)
    return Mesh(points[chosen], faces[np.sort(once)])


def written(mesh: Mesh, path: Path) -> str:
    """Write a scan and return its path as text."""
    write_mesh(path, mesh)
    return str(path)
