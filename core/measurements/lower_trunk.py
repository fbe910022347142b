"""Girths of the lower trunk before and after: waist, belly, hip, buttock and thighs."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from types import MappingProxyType

from core.deformation.tffd import deform
from core.geometry.mesh import Points
from core.landmarks.lower_trunk.girths import lower_girths
from core.landmarks.lower_trunk.sections import LowerSections
from core.landmarks.lower_trunk.types import LowerLandmarks
from core.landmarks.torso.girths import Girth
from core.landmarks.torso.torso_axis import share_axis
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


@lru_cache(maxsize=2)
def _at_rest(landmarks: LowerLandmarks) -> Mapping[str, Girth]:
    return lower_girths(landmarks.sections, landmarks)
