"""Build the sphere of the paper's Fig. 2: a closed control mesh in a round body, with lines round it."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
import trimesh

from core.control_mesh.fit import ControlMesh
from core.deformation.tffd import Binding, bind, deform
from core.geometry.mesh import Mesh, Points, frozen
from core.mechanics.model import ConstrainedModel, constrained_model
from core.mechanics.options import ModelOptions

RINGS, SPOKES = 7, 12
RADIUS = 100.0


@dataclass(frozen=True, eq=False)
class SphereModel:
    """The sphere ready to be solved: what ``Stages`` is for a scan, where it has the same parts."""

    control: ControlMesh
    body: Mesh
    binding: Binding
    model: ConstrainedModel

    def centred(self, moved: Points) -> Points:
        """Return all control points, (n, 3) [mm], for displacements ``moved`` (n, 3), about the old centre.

        Nothing holds a free body in its place, so where it has drifted to means nothing (ours).
        """
        return np.asarray(self.model.tensegric.expand(moved - moved.mean(axis=0)))

    def shape(self, moved: Points) -> Mesh:
        """Return the round body that follows the control points displaced by ``moved``, (n, 3) [mm]."""
        return self.body.moved(deform(self.binding, self.centred(moved)))


def sphere_model(
    worn: Collection[str] = ("horizontal",), mechanics: ModelOptions | None = None
) -> SphereModel:
    """Build the sphere with a ``horizontal`` and a ``vertical`` line; ``worn`` ones act (paper section 3).

    The control mesh has 86 points, all free, and 168 triangles; the body has 20,480. The paper gives neither.
    """
    control = sphere_control()
    ball = trimesh.creation.icosphere(subdivisions=5, radius=RADIUS)
    body = Mesh(ball.vertices, ball.faces)
    binding = bind(body, control.mesh, np.ones(len(body.vertices)))
    return SphereModel(control, body, binding, constrained_model(control, worn=worn, mechanics=mechanics))


def sphere_control() -> ControlMesh:
    """Return the control mesh: no border, nothing fixed, and two closed paths, which end where they begin.

    ``horizontal`` goes once round the equator, ``vertical`` once through both poles. All columns are 0: a
    sphere has no two breasts, and one pressure.
    """
    mesh = sphere()
    spoke = np.tile(np.arange(SPOKES), RINGS)
    ring = np.repeat(np.arange(RINGS), SPOKES)
    north, south = RINGS * SPOKES, RINGS * SPOKES + 1
    equator = np.flatnonzero(ring == RINGS // 2).tolist()
    down, up = (np.flatnonzero(spoke == at).tolist() for at in (0, SPOKES // 2))
    paths = {
        "horizontal": (*equator, equator[0]),
        "vertical": (north, *down, south, *reversed(up), north),
    }
    row = np.concatenate([ring + 1, [0, RINGS + 1]])
    nobody = np.zeros(len(row), dtype=bool)
    return ControlMesh(mesh, nobody, row, np.zeros_like(row), paths, (north, north), (), ())


def sphere(rings: int = RINGS, spokes: int = SPOKES, radius: float = RADIUS) -> Mesh:
    """Return a closed ball of rings and spokes with a point at each pole, wound outward, ``radius`` in mm."""
    polar = np.pi * np.arange(1, rings + 1) / (rings + 1)
    turn = 2.0 * np.pi * np.arange(spokes) / spokes
    ring = np.stack(
        [
            np.outer(np.sin(polar), np.cos(turn)),
            np.outer(np.sin(polar), np.sin(turn)),
            np.outer(np.cos(polar), np.ones(spokes)),
        ],
        axis=-1,
    ).reshape(-1, 3)
    points = radius * np.concatenate([ring, [[0, 0, 1], [0, 0, -1]]])
    top, bottom = len(ring), len(ring) + 1
    faces = []
    for s in range(spokes):
        t = (s + 1) % spokes
        faces += [(s, t, top), (t + (rings - 1) * spokes, s + (rings - 1) * spokes, bottom)]
        for r in range(rings - 1):
            upper, lower = r * spokes, (r + 1) * spokes
            faces += [(lower + s, lower + t, upper + t), (lower + s, upper + t, upper + s)]
    return Mesh(frozen(points), np.array(faces))
