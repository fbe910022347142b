"""Girths of the lower trunk before and after: waist, belly, hip, buttock and thighs."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from types import MappingProxyType

from core.control_mesh.lower_template import BELLY_ROW, FOLD_ROW, SEAT, read_lower_template
from core.deformation.tffd import deform
from core.geometry.mesh import Points
from core.landmarks.lower_trunk.girths import lower_girths
from core.landmarks.lower_trunk.sections import LowerSections
from core.landmarks.lower_trunk.types import LowerLandmarks
from core.landmarks.torso.girths import Girth
from core.landmarks.torso.torso_axis import share_axis
from core.landmarks.types import SIDES
from core.measurements.table import smoothed_moves
from core.pipeline.lower_region import LowerStages

Girths = Mapping[str, tuple[Girth, Girth]]
"""Girths before and after by name, at the same heights."""


def lower_before_after(stages: LowerStages, control_points: Points) -> Girths:
    """Return the girths of the lower trunk at rest, and reshaped by ``control_points`` (n, 3) [mm].

    Those that the scan does not show are left out.
    """
    before, sections = _at_rest(stages.landmarks), stages.landmarks.sections
    moves = deform(stages.binding, control_points) - stages.body.mesh.vertices
    moved = sections.mesh.moved(sections.mesh.vertices + smoothed_moves(stages.body, moves))
    share_axis(moved, sections.mesh)
    reshaped = LowerSections(moved, sections.top, sections.bottom, sections.middle)
    after = lower_girths(reshaped, stages.landmarks)
    return MappingProxyType({name: (before[name], after[name]) for name in before if name in after})


def lower_moves(stages: LowerStages, control_points: Points) -> Mapping[str, float]:
    """Return how far buttock points and gluteal folds rise, and how far the belly goes back [mm], by name.

    ``control_points`` (n, 3) [mm] are those of the reshaped body; the points are those of the control mesh
    that lie there at rest.
    """
    template = read_lower_template()
    moves = control_points - stages.control.mesh.vertices
    found = {"belly_back_mm": float(moves[template.point(BELLY_ROW, 0), 1])}
    for side, column, apex in zip(SIDES, (SEAT, -SEAT), stages.control.apexes, strict=True):
        found[f"buttock_{side}_up_mm"] = float(moves[apex, 2])
        found[f"gluteal_fold_{side}_up_mm"] = float(moves[template.point(FOLD_ROW, column), 2])
    return MappingProxyType(found)


@lru_cache(maxsize=2)
def _at_rest(landmarks: LowerLandmarks) -> Mapping[str, Girth]:
    return lower_girths(landmarks.sections, landmarks)
