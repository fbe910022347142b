"""A solid condensed to control points: stiffness and weight there, and the skin between them (ours).

Displacements are those that forces at the points cause, and those of weight. Within them the energy is that
of the solid, whose tangent has the stresses of its weight on the scan.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import LinearOperator, eigsh
from scipy.spatial import cKDTree

from core.control_mesh.fit import ControlMesh
from core.geometry.closest_point import barycentric, nearest_faces
from core.geometry.mesh import Flags, Floats, Indices, Mesh, Points, frozen
from core.progress import Progress, quiet
from core.tissue.skin_patch import skin_patch
from core.tissue.solid import TissueSolid, tissue_solid
from core.tissue.wall_film import DEPTH

DISC = 7.5
"""A control point moves as the skin within this distance does on the mean [mm]."""

GIVE = 0.03
"""Each point gives way by itself so much more, over the usual give of a point [1].

Discs that overlap, as in a crease, would else be as good as rigidly joined.
"""

SIZES = (17.0, 19.0, 22.0, 26.0)
"""Distances between the points of the skin that are tried in turn [mm]."""

LEAST_STIFFNESS = 0.4
"""Stresses of weight leave at least this part of the stiffness without them [1], however soft the tissue."""

_ON_RIM = 1e-3
"""A place where the share of what can move is no more than this [1] lies on the border of the skin."""

_FADE = 0.5
"""From this share on [1] the body follows the skin fully."""

_COLUMNS = 64
"""So many columns of a product are made at a time: all at once take more memory than all else."""


@dataclass(frozen=True, eq=False)
class TissueResponse:
    """What tissue of a shear modulus of 1 kPa answers at the free control points.

    ``stiffness`` (3 f, 3 f) [N/mm] goes with the modulus; ``prestress`` (3 f, 3 f) [N/mm], what the stresses
    of weight add, and ``weight`` (3 f, 3) [N/g] do not. ``softest`` [kPa] is the modulus below which
    ``prestress`` goes with it as well. ``rise`` [mm] is how far the bust points rise when all weight is
    taken, but for ``prestress``. The vertices ``nodes`` (s,) of ``skin`` move by ``carried`` (3 s, 3 f) [1]
    times the displacements of the points; its others do not move. ``depth`` (n,) [mm] is that of
    the tissue at each control point, beyond that under skin that does not move.
    """

    stiffness: Floats
    prestress: Floats
    weight: Floats
    softest: float
    rise: float
    skin: Mesh
    nodes: Indices
    carried: Floats
    depth: Floats

    def shear_modulus(self, sag: float) -> float:
        """Return the modulus [kPa] of a person whose bust points rise by ``sag`` [mm] without weight."""
        return self.rise / sag

    def stiffness_at(self, modulus: float) -> tuple[Floats, Floats]:
        """Return the stiffness for a modulus [kPa] and its derivative by the modulus' logarithm [N/mm]."""
        kept = min(modulus / self.softest, 1.0)
        whole = modulus * self.stiffness + kept * self.prestress
        return whole, whole if kept < 1.0 else modulus * self.stiffness

    @property
    def still(self) -> Flags:
        """Return which vertices of ``skin`` do not move."""
        return np.isin(np.arange(len(self.skin.vertices)), self.nodes, invert=True)

    def fade(self, places: Points) -> Floats:
        """Return how far ``places`` (k, 3) [mm] follow the skin: 0 at its border and beyond .. 1 inside."""
        corners, share = corner_shares(self.skin, places)
        inside = (share * ~self.still[corners]).sum(axis=1)
        return np.asarray(np.where(inside > _ON_RIM, np.minimum(inside / _FADE, 1.0), 0.0))

    def moved_at(self, places: Points) -> Floats:
        """Return how ``places`` (k, 3) [mm] of the skin move with the points, (3 k, 3 f) [1]."""
        corners, share = corner_shares(self.skin, places)
        rows = np.repeat(np.arange(len(places)), 3)
        at_vertices = sparse.csr_array(
            (share.ravel(), (rows, corners.ravel())), shape=(len(places), len(self.skin.vertices))
        )
        return np.asarray(_over_axes(at_vertices[:, self.nodes]) @ self.carried)


def condense(
    body: Mesh, coarse: ControlMesh, fine: ControlMesh, progress: Progress = quiet
) -> TissueResponse:
    """Return what the tissue between ``body`` and chest wall answers at the free points of ``fine``.

    ``coarse`` is the control mesh that ``fine`` halves. Raises ValueError where the chest wall crosses the
    skin, Cancelled.
    """
    solid = _solid(body, coarse, progress)
    modes = _modes(solid, _over_axes(disc_rows(solid, body, fine.mesh.vertices[~fine.fixed]))[:, solid.free])
    stresses = solid.prestress(-modes.by_weight[:, 2], -modes.pressure[:, 2])
    prestress = np.concatenate([modes.shapes.T @ (stresses @ some) for some in _parts(modes.shapes)], axis=1)
    prestress = 0.5 * (prestress + prestress.T)
    place = np.cumsum(~fine.fixed) - 1
    rise = float(np.mean([modes.at_points[3 * place[point] + 2, 2] for point in fine.bust_points]))
    skin = solid.cells.finer_skin()
    inner = np.setdiff1d(np.arange(len(skin.vertices)), np.concatenate(skin.boundary_loops))
    means = _over_axes(disc_rows(solid, body, skin.vertices[inner]))[:, solid.free]
    return TissueResponse(
        frozen(modes.stiffness),
        frozen(prestress),
        frozen(modes.stiffness @ modes.at_points),
        _softest(modes.stiffness, prestress),
        rise,
        skin,
        inner,
        frozen(means @ modes.shapes),
        frozen(tissue_depth(solid, fine.mesh.vertices)),
    )


def with_moved_points(tissue: TissueResponse, former: ControlMesh, fine: ControlMesh) -> TissueResponse:
    """Return the response of the same tissue at the points of ``fine``, which lie near those of ``former``.

    Both are meshes of one template on one body. The solid is not condensed anew: within the displacements
    that forces at the former points cause, those of the new ones are as many and tell them apart.
    """
    free, places = ~fine.fixed, fine.mesh.vertices
    if np.array_equal(places, former.mesh.vertices):
        return tissue
    turned = np.eye(3 * int(free.sum()))
    turned += tissue.moved_at(places[free]) - tissue.moved_at(former.mesh.vertices[free])
    back = np.asarray(np.linalg.inv(turned), dtype=np.float64)
    by_weight = turned @ np.linalg.solve(tissue.stiffness, tissue.weight[:, 2])
    corners, share = corner_shares(former.mesh, places)
    return replace(
        tissue,
        stiffness=frozen(_congruent(tissue.stiffness, back)),
        prestress=frozen(_congruent(tissue.prestress, back)),
        weight=frozen(back.T @ tissue.weight),
        rise=float(np.mean(by_weight[3 * (np.cumsum(free) - 1)[list(fine.bust_points)] + 2])),
        carried=frozen(tissue.carried @ back),
        depth=frozen((share * tissue.depth[corners]).sum(axis=1)),
    )


def corner_shares(mesh: Mesh, places: Points) -> tuple[Indices, Floats]:
    """Return the corners of the face nearest to each of ``places`` (k, 3) [mm] and their shares, (k, 3)."""
    face, foot = nearest_faces(mesh, places)
    corners = mesh.faces[face]
    return corners, np.clip(barycentric(mesh.vertices[corners], foot), 0.0, 1.0)


def _congruent(matrix: Floats, by: Floats) -> Floats:
    product = by.T @ matrix @ by
    return np.asarray(0.5 * (product + product.T))


def tissue_depth(solid: TissueSolid, places: Points) -> Floats:
    """Return how much deeper than at the rim the tissue is at places (k, 3) of the skin, (k,) [mm]."""
    skin = solid.cells.skin
    deep = np.linalg.norm(skin.vertices - solid.cells.corners[: len(skin.vertices)], axis=1) - DEPTH
    corners, share = corner_shares(skin, places)
    return np.asarray(np.maximum((share * deep[corners]).sum(axis=1), 0.0))


def _solid(body: Mesh, coarse: ControlMesh, progress: Progress) -> TissueSolid:
    """Return the solid of 1 kPa, its points further apart where the skin folds between them otherwise."""
    for size in SIZES[:-1]:
        with suppress(ValueError):
            return tissue_solid(skin_patch(body, coarse.mesh, coarse.fixed, size), 1.0, progress=progress)
    return tissue_solid(skin_patch(body, coarse.mesh, coarse.fixed, SIZES[-1]), 1.0, progress=progress)


@dataclass(frozen=True, eq=False)
class _Modes:
    """How the free coordinates (m,) of a solid move with the points: ``shapes`` (m, 3 f) [1].

    ``stiffness`` (3 f, 3 f) [N/mm] is theirs; ``by_weight`` (m, 3) and ``at_points`` (3 f, 3) [mm/g] are how
    coordinates and points move under 1 g along each axis, ``pressure`` (c, 3) [MPa] what it does beside.
    """

    shapes: Floats
    stiffness: Floats
    by_weight: Floats
    at_points: Floats
    pressure: Floats


def _modes(solid: TissueSolid, rows: sparse.csr_array) -> _Modes:
    """Return the modes of points that are means ``rows`` (3 f, m) of the coordinates."""
    shapes, _ = solid.solved(rows.toarray().T)
    compliance = rows @ shapes
    give = GIVE * np.median(compliance.diagonal())
    stiffness = np.linalg.inv(0.5 * (compliance + compliance.T) + give * np.eye(len(compliance)))
    shapes = shapes @ stiffness
    loads = solid.weight_loads()
    by_weight, pressure = solid.solved(loads)
    at_points = rows @ by_weight
    # What forces at the points cannot do of weight's displacements follows the points' share of those.
    held = stiffness @ at_points
    follow = np.linalg.solve(at_points.T @ held, held.T)
    shapes += (by_weight - shapes @ at_points) @ follow
    stiffness += follow.T @ (by_weight.T @ loads - at_points.T @ held) @ follow
    return _Modes(shapes, 0.5 * (stiffness + stiffness.T), by_weight, at_points, pressure)


def _parts(matrix: Floats) -> list[Floats]:
    return np.array_split(matrix, max(matrix.shape[1] // _COLUMNS, 1), axis=1)


def _over_axes(rows: sparse.csr_array) -> sparse.csr_array:
    return sparse.csr_array(sparse.kron(rows, sparse.eye_array(3)))


def _softest(stiffness: Floats, prestress: Floats) -> float:
    """Return the modulus [kPa] at which ``LEAST_STIFFNESS`` is left of the stiffness in some direction."""
    lower = np.linalg.cholesky(stiffness)
    inner = np.linalg.solve(lower, np.linalg.solve(lower, prestress).T)
    operator = LinearOperator(inner.shape, matvec=lambda x: inner @ x, dtype=np.float64)
    start = np.ones(len(inner))
    least = float(eigsh(operator, 1, which="SA", tol=1e-3, return_eigenvectors=False, v0=start)[0])
    return max(-least, 1e-6) / (1.0 - LEAST_STIFFNESS)


def disc_rows(solid: TissueSolid, body: Mesh, points: Points) -> sparse.csr_array:
    """Return the share of each node in the mean over a disc round each of ``points``, (k, nodes) [1]."""
    tree = cKDTree(body.vertices)
    near = [tree.query_ball_point(here, DISC) for here in points]
    samples = np.concatenate(
        [np.vstack([body.vertices[at], here]) for at, here in zip(near, points, strict=True)]
    )
    owner = np.repeat(np.arange(len(points)), [len(at) + 1 for at in near])
    share = 1.0 / np.bincount(owner)[owner]
    mean = sparse.csr_array((share, (owner, np.arange(len(owner)))), shape=(len(points), len(owner)))
    return sparse.csr_array(mean @ solid.cells.skin_rows(samples))
