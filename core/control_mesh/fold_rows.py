"""The folds under the breasts, column by column, on the profiles of the body."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from core.control_mesh.fitting_frame import FittingFrame
from core.control_mesh.radial_profiles import Profile, find_fold, profile
from core.geometry.mesh import Points
from core.landmarks.types import Landmarks

SHALLOW = 2.0
"""A hollow less deep than this is no fold [mm]."""

SURE = 0.3
"""The deeper a hollow, the higher over its landmark it may be taken for the fold [1]."""

ALIKE = 3.0
"""The body counts as symmetric where landmarks of both sides mirror each other as well as this [mm]."""


@dataclass(frozen=True, eq=False)
class Crease:
    """The fold in one column: ``arc`` [mm] down ``profile`` from the bust row, ``depth`` [mm] deep."""

    profile: Profile
    arc: float
    depth: float


def find_creases(
    ground: FittingFrame, outline: Points, landmarks: Landmarks
) -> tuple[dict[int, Crease], list[int], list[int]]:
    """Return the folds by column number, found on the profiles of the body, and the columns that lack one.

    A column lacks its fold if the bust point has none below it; in the others the breast may pass into the
    trunk without a fold. The third are the columns whose profile a hole of the scan ends. On a symmetric body
    the folds of mirrored columns are made alike. Source: ours.
    """
    start = outline[ground.template.row_of("bust point")]
    creases: dict[int, Crease] = {}
    lacking, holed = [], []
    for place, number in enumerate(ground.column.tolist()):
        column = ground.template.columns[abs(number)]
        if column.fold == "none" or np.isnan(start[place]).any():
            continue
        bottom = ground.below[place] - 2.0 * ground.torso.scale
        down = profile(ground.front, ground.axis, start[place], bottom)
        crease = None if down is None else _crease(ground, place, down)
        if crease is not None:
            creases[number] = crease
        elif down is None:
            holed.append(number)
        elif abs(number) == ground.template.bust_column:
            lacking.append(number)
    if _symmetric(ground.axis, landmarks):
        pairs = [number for number in creases if -number in creases]
        mean = {number: 0.5 * (creases[number].arc + creases[-number].arc) for number in pairs}
        creases |= {number: replace(creases[number], arc=arc) for number, arc in mean.items()}
    return creases, lacking, holed


def _crease(ground: FittingFrame, place: int, down: Profile) -> Crease | None:
    """Return the fold on the profile of a column, None if no hollow lies where a fold may be."""
    column = ground.template.columns[abs(ground.column[place])]
    fold = find_fold(down, column.fold == "crease")
    torso, azimuth, bust = ground.torso, ground.azimuth[[place]], ground.bust[place]
    usual, lowest = torso.height("fold", azimuth)[0], torso.height("lowest", azimuth)[0]
    highest = usual + 0.35 * max(bust - usual, 0.0)
    if fold is None or fold.depth < SHALLOW or fold.z < min(usual, lowest) - 25.0 * torso.scale - 5.0:
        return None
    # a shallow hollow above the fold is another one, a deep one is the fold of a hanging breast
    if fold.z > highest + max(6.0 * torso.scale, SURE * fold.depth):
        return None
    arc = fold.arc if fold.z <= highest else down.next_below(fold.arc, highest)
    return Crease(down, max(arc, column.room * (bust - ground.below[place])), fold.depth)


def _symmetric(axis: Points, landmarks: Landmarks) -> bool:
    """Return whether the bust points and folds of both sides mirror each other about the axis."""
    for what in ("bust_point", "fold"):
        left = landmarks.position(f"{what}_left") - axis
        right = (landmarks.position(f"{what}_right") - axis) * (-1.0, 1.0, 1.0)
        if np.linalg.norm(left - right) > ALIKE:
            return False
    return True
