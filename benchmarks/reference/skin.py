"""Skin of the reference: the scan within the outline of a control mesh, remeshed, and discs on it."""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
import pyvista as pv
from pyvista import PyVistaDeprecationWarning
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from core.geometry.mesh import Faces, Flags, Floats, Indices, Mesh, Points
from reference.elements import quadratic

CORNER_EDGES = np.array([(0, 1), (1, 2), (2, 0)])
"""Edges of a triangle in the order of its quadratic nodes."""

ON_OUTLINE = 1e-3
"""A place nearer to the outline than this [mm] is on it."""


def surface(mesh: Mesh) -> pv.PolyData:
    """Return ``mesh`` in the form of pyvista."""
    return pv.PolyData.from_regular_faces(mesh.vertices, mesh.faces)


def closest(mesh: Mesh, places: Points) -> tuple[Indices, Points]:
    """Return the nearest triangle of ``mesh`` and the place on it for each of ``places`` (k, 3) [mm]."""
    face, foot = surface(mesh).find_closest_cell(places, return_closest_point=True)
    return np.atleast_1d(face), np.atleast_2d(foot).astype(np.float64)


def barycentric(corners: Points, places: Points) -> Floats:
    """Return the barycentric coordinates (k, 3) of places (k, 3) in triangles (k, 3, 3)."""
    a, b, way = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0], places - corners[:, 0]
    normal = np.cross(a, b)
    area = (normal**2).sum(axis=1)
    second = (np.cross(way, b) * normal).sum(axis=1) / area
    third = (np.cross(a, way) * normal).sum(axis=1) / area
    return np.stack([1.0 - second - third, second, third], axis=1)


def from_segments(places: Points, one: Points, other: Points) -> Floats:
    """Return the distances of places (k, 3) from segments (s, 3) to (s, 3), shape (k, s) [mm]."""
    along = other - one
    share = np.einsum("ksj,sj->ks", places[:, None] - one, along) / (along**2).sum(axis=1)
    foot = one + np.clip(share, 0.0, 1.0)[..., None] * along
    return np.asarray(np.linalg.norm(places[:, None] - foot, axis=2))


def within_outline(body: Mesh, control: Mesh) -> Mesh:
    """Return the largest piece of ``body`` whose nearest places on ``control`` are not on its outline."""
    _, foot = closest(control, body.vertices)
    loops = [control.vertices[loop] for loop in control.boundary_loops]
    ends = [np.concatenate(each) for each in (loops, [np.roll(loop, -1, axis=0) for loop in loops])]
    inside = from_segments(foot, *ends).min(axis=1) > ON_OUTLINE
    return largest_piece(body.vertices, body.faces[inside[body.faces].all(axis=1)])


def largest_piece(vertices: Points, faces: Faces) -> Mesh:
    """Return the largest connected piece of ``faces``, without the vertices that it does not use."""
    if not len(faces):
        raise ValueError("no skin lies within the outline of the control mesh")
    sides = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]]])
    graph = sparse.coo_array((np.ones(len(sides)), sides.T), shape=(len(vertices), len(vertices)))
    label = connected_components(graph, directed=False)[1][faces[:, 0]]
    used, renumbered = np.unique(faces[label == np.bincount(label).argmax()], return_inverse=True)
    return Mesh(vertices[used], renumbered.reshape(-1, 3))


def remeshed(patch: Mesh, count: int) -> Mesh:
    """Return ``patch`` with about ``count`` points on it, evenly spread.

    The border is half the distance of two points within that of ``patch``.
    Source: Valette and Chassery (2004).
    """
    import pyacvd  # noqa: PLC0415 (a dependency of making cases alone, not of checking their parts)

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PyVistaDeprecationWarning)  # pyacvd 0.4 with pyvista 0.49
        clustering = pyacvd.Clustering(surface(patch))
        clustering.subdivide(3)
        clustering.cluster(count)
        drawn = clustering.create_mesh()
    coarse = largest_piece(np.asarray(drawn.points, dtype=np.float64), drawn.regular_faces.astype(np.int64))
    _, places = closest(patch, coarse.vertices)
    return coarse.moved(places)


@dataclass(frozen=True, eq=False)
class QuadraticSkin:
    """Triangles of the skin with their quadratic nodes: ``faces`` (m, 6) of ``count`` nodes of a solid."""

    corners: Mesh
    faces: Indices
    count: int

    def weights(self, places: Points) -> sparse.csr_array:
        """Return the shares of the nodes in the skin nearest to ``places`` (k, 3) [mm], shape (k, count)."""
        face, foot = closest(self.corners, places)
        shares = barycentric(self.corners.vertices[self.corners.faces[face]], foot)
        values = quadratic(shares, CORNER_EDGES)
        rows = np.repeat(np.arange(len(places)), 6)
        return sparse.csr_array(
            (values.ravel(), (rows, self.faces[face].ravel())), shape=(len(places), self.count)
        )

    def discs(self, centres: Points, diameter: float, held: Flags) -> sparse.csr_array:
        """Return the means over discs on the skin as ``weights`` does; rows of ``held`` points are empty."""
        face, _ = closest(self.corners, centres)
        normal = self.corners.face_normals[face]
        number = np.arange(_SAMPLES)
        away = 0.5 * diameter * np.sqrt((number + 0.5) / _SAMPLES)
        turn = number * np.pi * (3.0 - np.sqrt(5.0))
        one = np.cross(normal, np.eye(3)[np.abs(normal).argmin(axis=1)])
        one /= np.linalg.norm(one, axis=1)[:, None]
        other = np.cross(normal, one)
        flat = one[:, None] * np.cos(turn)[:, None] + other[:, None] * np.sin(turn)[:, None]
        places = (centres[:, None] + away[:, None] * flat).reshape(-1, 3)
        rows = np.repeat(np.arange(len(centres)), _SAMPLES)
        share = np.where(held[rows], 0.0, 1.0 / _SAMPLES)
        mean = sparse.csr_array((share, (rows, np.arange(len(rows)))), shape=(len(centres), len(rows)))
        return sparse.csr_array(mean @ self.weights(places))


_SAMPLES = 100
"""Places that a disc is sampled at, spread evenly in a sunflower's pattern."""
