"""A solid condensed to control points: stiffness and weight there, nothing else being loaded (ours)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.spatial import cKDTree

from core.control_mesh.fit import ControlMesh
from core.geometry.closest_point import barycentric, nearest_faces
from core.geometry.mesh import Floats, Mesh, Points, frozen
from core.progress import Progress, quiet
from core.tissue.skin_patch import skin_patch
from core.tissue.solid import TissueSolid, means_of, tissue_solid
from core.tissue.wall_film import DEPTH

DISC = 7.5
"""A control point moves as the skin within this distance does on the mean [mm]."""

GIVE = 0.03
"""Each point gives way by itself so much more, over the usual give of a point [1].

Discs that overlap, as in a crease, would else be as good as rigidly joined.
"""


@dataclass(frozen=True, eq=False)
class TissueResponse:
    """What tissue of a shear modulus of 1 kPa answers at the free control points.

    ``stiffness`` (3 f, 3 f) [N/mm] goes with the modulus; ``weight`` (3 f, 3) [N/g] does not. ``rise`` [mm]
    is how far the bust points rise when all weight is taken; ``depth`` (n,) [mm] that of the tissue at each
    control point, beyond that under skin that does not move.
    """

    stiffness: Floats
    weight: Floats
    rise: float
    depth: Floats

    def shear_modulus(self, sag: float) -> float:
        """Return the modulus [kPa] of a person whose bust points rise by ``sag`` [mm] without weight."""
        return self.rise / sag


def condense(
    body: Mesh, coarse: ControlMesh, fine: ControlMesh, progress: Progress = quiet
) -> TissueResponse:
    """Return what the tissue between ``body`` and chest wall answers at the free points of ``fine``.

    ``coarse`` is the control mesh that ``fine`` halves. Raises ValueError where the chest wall crosses the
    skin, Cancelled.
    """
    solid = tissue_solid(skin_patch(body, coarse.mesh, coarse.fixed), 1.0, progress=progress)
    rows = disc_rows(solid, body, fine.mesh.vertices[~fine.fixed])
    compliance = solid.compliance(rows)
    response = np.stack([solid.weight_response(axis) for axis in np.eye(3)], axis=2)
    moved = means_of(rows, response)
    give = GIVE * np.median(compliance.diagonal())
    stiffness = np.linalg.inv(compliance + give * np.eye(len(compliance)))
    stiffness = 0.5 * (stiffness + stiffness.T)
    place = np.cumsum(~fine.fixed) - 1
    rise = float(np.mean([moved[3 * place[point] + 2, 2] for point in fine.bust_points]))
    depth = frozen(tissue_depth(solid, fine.mesh.vertices))
    return TissueResponse(frozen(stiffness), frozen(stiffness @ moved), rise, depth)


def tissue_depth(solid: TissueSolid, places: Points) -> Floats:
    """Return how much deeper than at the rim the tissue is at places (k, 3) of the skin, (k,) [mm]."""
    skin = solid.cells.skin
    deep = np.linalg.norm(skin.vertices - solid.cells.corners[: len(skin.vertices)], axis=1) - DEPTH
    face, foot = nearest_faces(skin, places)
    share = np.clip(barycentric(skin.vertices[skin.faces[face]], foot), 0.0, 1.0)
    return np.asarray(np.maximum((share * deep[skin.faces[face]]).sum(axis=1), 0.0))


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
