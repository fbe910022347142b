"""How a scan file is to be understood: its unit, which way is up, which way the body faces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.errors import ScanError
from core.mesh import Faces, Floats, Points, frozen
from core.stance import Stance, stances
from core.symmetry import Cloud, MirrorPlane, even_cloud, mirror_planes

MILLIMETRES = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "inch": 25.4}

AXES = {
    sign + name: direction * np.eye(3)[k]
    for k, name in enumerate("xyz")
    for sign, direction in (("+", 1.0), ("-", -1.0))
}

GIRTHS = (595.0, 1500.0)
"""Trunk girths of bodies [mm]. No two units put the same file inside."""

TOLD_GIRTHS = (300.0, 2500.0)
"""Trunk girths [mm] that are believed if the unit is told."""

SNAP = 1.5
"""A side axis nearer than this to an axis of the file [degrees] is taken for it: then no digit changes."""

NEAR = 0.69
"""Cosine of the angle, a little over 45 degrees, within which a direction has the name of an axis."""

SURE_MARGIN, SURE_SCORE = 0.6, 1.5


@dataclass(frozen=True, eq=False)
class Pose:
    """How a file was understood.

    ``file_to_mm`` takes file coordinates to the canonical frame, shape (4, 4): a turn times a scale, never
    a mirror, without a shift. ``up`` and ``front`` name the nearest axes of the file. ``margin`` is the lead
    of this reading over the best other one [1]; if small, ``sure`` is False and the user should be asked.
    """

    unit: str
    up: str
    front: str
    file_to_mm: Floats
    sure: bool
    reason: str
    margin: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "file_to_mm", frozen(self.file_to_mm))


def find_pose(
    vertices: Points,
    faces: Faces,
    *,
    unit: str | None = None,
    up: str | None = None,
    front: str | None = None,
) -> Pose:
    """Find how the body stands in its file, from its shape alone.

    ``vertices``, shape (n, 3) [file units], and ``faces``, shape (m, 3), without specks. ``unit``, ``up`` and
    ``front`` overrule the shape. Raises ScanError if this is no upper body. Source: ours.
    """
    _check_told(unit, up, front)
    told = up is not None and front is not None
    best, margin = _best_stance(even_cloud(vertices, faces), up, front)
    if not told and not best.is_body:
        raise ScanError(
            "This does not look like an upper body: no bust was found in front of an even trunk.",
            "Cut away all but the body, or say which way is up and which way is front.",
        )
    unit, reason = _find_unit(best.trunk.main_girth, unit)
    sure = told or (margin >= SURE_MARGIN and best.score >= SURE_SCORE)
    left, back, upward = _snapped(best)
    up, front = _nearest_axis(upward), _nearest_axis(-back)
    if told:
        reason += f" That {up} is up and {front} is front was told."
    elif sure:
        reason += f" Mirror plane, bust and outline say that {up} is up and {front} is front."
    else:
        reason += f" It is not certain that {up} is up and {front} is front: please look."
    file_to_mm = np.eye(4)
    file_to_mm[:3, :3] = MILLIMETRES[unit] * np.stack([left, back, upward])
    return Pose(unit, up, front, file_to_mm, sure, reason, margin)


def _check_told(unit: str | None, up: str | None, front: str | None) -> None:
    if unit is not None and unit not in MILLIMETRES:
        raise ScanError(f"The unit {unit!r} is not known.", f"Choose one of {', '.join(MILLIMETRES)}.")
    for axis in (up, front):
        if axis is not None and axis not in AXES:
            raise ScanError(f"The axis {axis!r} is not known.", f"Choose one of {', '.join(AXES)}.")
    if up is not None and front is not None and up[1] == front[1]:
        raise ScanError(f"Up {up} and front {front} lie along the same axis.", "Choose two different axes.")


def _best_stance(cloud: Cloud, up: str | None, front: str | None) -> tuple[Stance, float]:
    """Return the stance with the best score that fits what was told, and its lead over the others."""
    axes = range(3) if up is None else ["xyz".index(up[1])]
    planes = [plane for axis in axes for plane in mirror_planes(cloud, axis)]
    found = _fitting(cloud, planes, up, front)
    if not found and up is not None and front is not None:
        side = np.cross(AXES[up], AXES[front])
        middle = float(np.percentile(cloud.points @ side, (2, 98)).mean())
        found = _fitting(cloud, [MirrorPlane(axes[0], side, middle, 1.0)], up, front)
    if not found:
        raise ScanError(
            "No trunk can be made out in this scan.", "It should hold an upper body, standing along an axis."
        )
    best = max(found, key=lambda stance: stance.score)
    rivals = [
        stance.score
        for stance in found
        if min(stance.up @ best.up, stance.back @ best.back) < np.cos(np.radians(20.0))
    ]
    return best, best.score - max(rivals, default=-np.inf)


def _fitting(cloud: Cloud, planes: list[MirrorPlane], up: str | None, front: str | None) -> list[Stance]:
    return [
        stance
        for plane in planes
        for stance in stances(cloud, plane)
        if (up is None or stance.up @ AXES[up] > NEAR)
        and (front is None or -stance.back @ AXES[front] > NEAR)
    ]


def _find_unit(girth: float, told: str | None) -> tuple[str, str]:
    """Return the unit in which a trunk girth [file units] is that of a body, and the reason in words."""
    low, high = GIRTHS if told is None else TOLD_GIRTHS
    for unit in MILLIMETRES if told is None else (told,):
        mm = girth * MILLIMETRES[unit]
        if low < mm < high:
            why = "so the unit is" if told is None else "and the unit was told to be"
            return unit, f"The trunk measures {girth:.4g} round, {why} {unit} ({mm:.0f} mm)."
    said = "in no unit" if told is None else f"not in {told}"
    raise ScanError(
        f"The trunk measures {girth:.4g} round: {said} is that the size of a body.",
        "Check the unit, and that the scan holds an upper body.",
    )


def _snapped(stance: Stance) -> tuple[Floats, Floats, Floats]:
    left, back = stance.left, stance.back
    if np.abs(left).max() > np.cos(np.radians(SNAP)):
        left, back = AXES[_nearest_axis(left)], AXES[_nearest_axis(back)]
    return left, back, stance.up


def _nearest_axis(direction: Floats) -> str:
    return max(AXES, key=lambda name: float(AXES[name] @ direction))
