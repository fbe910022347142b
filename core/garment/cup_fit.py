"""What cups do to the body: volume, forces and contact pressure; and where their cloth lies."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from core.geometry.mesh import Floats, Points
from core.mechanics.condensed_tissue import CondensedTissue
from core.mechanics.cup_parts import Underwire
from core.messages import Message
from core.pipeline.build import Stages
from core.pipeline.surface_fields import between_control_points

SMALL_ML = 20.0
"""A cup that holds so much less than the breast presses hard all over, or lets it spill [ml]."""

_STANDS_OUT = 40.0
"""No skin stands further out from the control mesh than this [mm]."""

_STANDS_OFF = 1.0
"""So far is cloth drawn outside the skin that it covers [mm]."""


@dataclass(frozen=True)
class CupSide:
    """What the cup of one ``side`` does.

    ``more_ml`` [ml] is how much more a moulded cup holds than the breast that it covers, None of a sewn one;
    ``up_n``, ``back_n`` and ``inward_n`` [N] are the force on the breast, ``wire_n`` that of the wire's
    points taken together and ``root_mm`` [mm] the length of the root that it follows. ``max_kpa`` and
    ``mean_kpa`` are of the skin that is pressed, ``force_n`` [N] is all of that, whichever way, ``contact``
    the share of the cup's area that presses, ``place`` [mm] where.
    """

    side: str
    more_ml: float | None
    up_n: float
    back_n: float
    inward_n: float
    wire_n: float
    root_mm: float
    force_n: float
    max_kpa: float
    mean_kpa: float
    contact: float
    place: tuple[float, ...]


@dataclass(frozen=True, eq=False)
class CupFit:
    """Both cups: the sides, left first, and the contact ``kpa`` (n,) [kPa] at each control point."""

    sides: tuple[CupSide, ...]
    kpa: Floats

    @property
    def up_n(self) -> float:
        """Return what straps and band have to carry for the cups [N]."""
        return sum(side.up_n for side in self.sides)

    @property
    def highest(self) -> CupSide:
        """Return the side with the largest pressure."""
        return max(self.sides, key=lambda side: side.max_kpa)

    @property
    def warnings(self) -> tuple[Message, ...]:
        """Return what is wrong with the cups."""
        small = min((side.more_ml for side in self.sides if side.more_ml is not None), default=0.0)
        if small > -SMALL_ML:
            return ()
        return (
            Message(
                "The cup holds {volume} ml less than the breast: it presses all over, or the breast spills.",
                volume=f"{-small:.0f}",
            ),
        )

    def as_data(self) -> list[dict[str, Any]]:
        """Return the sides ready for JSON."""
        return [dict(vars(side)) for side in self.sides]


class WornCups:
    """The cups of a design on its body, ready to be asked. ``stages`` must have cups."""

    def __init__(self, stages: Stages) -> None:
        assert stages.design.cup is not None
        self.stages = stages
        self.layout = stages.cup_layout(stages.design.cup)

    @cached_property
    def _areas(self) -> Floats:
        """Return the area of the control mesh that each control point stands for, (n,) [mm^2]."""
        mesh = self.stages.control.mesh
        shares = np.repeat(mesh.face_areas / 3.0, 3)
        return np.asarray(np.bincount(mesh.faces.ravel(), shares, len(mesh.vertices)), dtype=np.float64)

    def fit(self, control_points: Points) -> CupFit:
        """Return what the cups do at ``control_points``, shape (n, 3) [mm]."""
        model = self.stages.model
        solid = model.tensegric
        assert isinstance(solid, CondensedTissue)
        moved = (control_points - solid.rest)[solid.free]
        normals = self.stages.control.mesh.moved(control_points).vertex_normals
        kpa = np.zeros(len(control_points))
        more = self._more_volume()
        sides, half = [], len(solid.cups) // 2  # the parts of the left cup come first
        for number, side in enumerate(("left", "right")):
            points = self.layout.points(1 - 2 * number)
            own = solid.cups[number * half : (number + 1) * half]
            force = np.zeros_like(control_points)
            for part in own:
                if not isinstance(part, Underwire):
                    force[solid.free] -= part.gradient(moved)
            kpa += 1000.0 * np.maximum(-np.einsum("ij,ij->i", force, normals), 0.0) / self._areas
            wire = [part.forces(moved) for part in own if isinstance(part, Underwire)]
            wire_n = float(sum(np.linalg.norm(each, axis=1).sum() for each in wire))
            sides.append(self._side(side, more[number], force, wire_n, kpa, points, control_points))
        return CupFit(tuple(sides), kpa)

    def _side(
        self,
        side: str,
        more: float | None,
        force: Points,
        wire: float,
        kpa: Floats,
        points: np.ndarray,
        places: Points,
    ) -> CupSide:
        total, area = force.sum(axis=0), self._areas[points]
        pressed = kpa[points] > 0.0
        most = points[int(kpa[points].argmax())]
        whole = float(kpa[points] @ area) / 1000.0
        inward = -total[0] if side == "left" else total[0]
        return CupSide(
            side=side,
            more_ml=more,
            up_n=float(total[2]),
            back_n=float(total[1]),
            inward_n=float(inward),
            wire_n=wire,
            root_mm=self.layout.root_length(1 if side == "left" else -1),
            force_n=whole,
            max_kpa=float(kpa[most]),
            mean_kpa=1000.0 * whole / max(float(area[pressed].sum()), 1e-9),
            contact=float(area[pressed].sum() / area.sum()),
            place=tuple(map(float, places[most])) if pressed.any() else (),
        )

    def _more_volume(self) -> tuple[float | None, float | None]:
        if self.layout.cup.kind == "sewn":
            return None, None
        model = self.stages.model
        left, right = (model.volume.zone_volumes(self.layout.target) - model.rest_zones) / 1000.0
        return float(left), float(right)

    @cached_property
    def share(self) -> Floats:
        """Return how far each vertex of the body is covered, shape (n,) [1]: from 0.5 on cloth lies on it."""
        body, patch = self.stages.body.mesh, self.stages.patch
        covered = np.maximum(self.layout.inside(1), self.layout.inside(-1))
        mesh, share = self.stages.control.mesh, np.zeros(len(body.vertices))
        near = mesh.vertices[mesh.edges[(covered[mesh.edges] > 0.0).any(axis=1)].ravel()]
        low, high = near.min(axis=0) - _STANDS_OUT, near.max(axis=0) + _STANDS_OUT
        within = (body.vertices >= low) & (body.vertices <= high)
        rows = np.flatnonzero((patch.fade > 0.0) & within.all(axis=1))
        share[rows] = between_control_points(mesh, body.vertices[rows], np.ones(len(rows))) @ covered
        return share

    def cloth(self, places: Points, normals: Points) -> tuple[Points, Points]:
        """Return where cloth lies [mm], and its normals [1], at the moving vertices of the body, (r, 3) each.

        Those of the body are given, as in ``Stages.shape``: a moulded cup keeps its own shape.
        """
        if self.layout.cup.kind == "moulded":
            places, normals = self._moulded
        return places + _STANDS_OFF * normals, normals

    @cached_property
    def _moulded(self) -> tuple[Points, Points]:
        return self.stages.shape(self.layout.target)
