"""Unit, up and front of a scan file."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.errors import ScanError
from core.geometry.mesh import Faces, Floats, Points, frozen, unit
from core.geometry.plane_sections import hull_perimeter
from core.messages import Message, join
from core.progress import Progress, quiet
from core.scan.orientation.axis_override import AXES, AxisOverride, nearest_axis, parse_axes
from core.scan.orientation.plausibility import LEAST, require_plausible
from core.scan.orientation.pose_candidates import PoseCandidate, rank_candidates, refine_candidate
from core.scan.orientation.symmetry_planes import Cloud, MirrorPlane, mirror_planes, sample_uniformly
from core.scan.orientation.unit_detection import MILLIMETRES, estimate_unit

SNAP = 1.5
"""A side axis nearer than this to an axis of the file [degrees] is taken for it: then no digit changes."""

SURE_MARGIN, SURE_SCORE = 0.6, 2.0

MOST_PLANES = 0.2
"""A mirror plane that is worse than the best by more than this [1] is no other way to understand a body."""

READINGS = 4
"""Ways to understand a file that are looked at closely."""

RIVAL = 2.0
"""Ways to stand that score less than the best by this [1] stay rough: they cannot win."""

NOTHING_ELSE = Message("The scan must contain an upper body and no other large objects.")

DIFFERENT = 30.0
"""Ways to stand whose up and front lie nearer than this [degrees] are one."""


@dataclass(frozen=True, eq=False)
class Pose:
    """How a file was understood.

    ``file_to_mm`` takes file coordinates to the canonical frame, shape (4, 4): a turn times a scale, never
    a mirror, without a shift. ``up`` and ``front`` name the nearest axes of the file; ``tilt`` is the angle
    between up and its axis [degrees]. ``margin`` is the lead of this reading over the best other one [1]; if
    small, ``is_certain`` is False and the user should be asked. ``others`` are the ``file_to_mm`` of the
    next best readings, at most three. What lies under the level ``stand`` [mm] is a pole or a base, no body.
    """

    unit: str
    up: str
    front: str
    file_to_mm: Floats
    is_certain: bool
    reason: Message
    margin: float
    tilt: float = 0.0
    others: tuple[Floats, ...] = ()
    stand: float = -np.inf

    def __post_init__(self) -> None:
        object.__setattr__(self, "file_to_mm", frozen(self.file_to_mm))
        object.__setattr__(self, "others", tuple(frozen(other) for other in self.others))


__all__ = ["AXES", "MILLIMETRES", "Pose", "estimate_pose"]

STANDING = "finding up and front"
"""What is said to be at work."""


def estimate_pose(
    vertices: Points,
    faces: Faces,
    *,
    unit: str | None = None,
    up: str | None = None,
    front: str | None = None,
    progress: Progress = quiet,
) -> Pose:
    """Find how the body stands in its file, from its shape alone.

    ``vertices``, shape (n, 3) [file units], and ``faces``, shape (m, 3), without specks. ``unit``, ``up`` and
    ``front`` overrule the shape: they are "+x" .. "-z", the nearest axis, or numbers "x,y,z", exactly so.
    Raises ScanError if this is no upper body, Cancelled. Source: ours.
    """
    unit = unit and unit.strip().lower()
    if unit is not None and unit not in MILLIMETRES:
        raise ScanError(
            Message("Unknown unit {unit}.", unit=f"{unit!r}"),
            Message("Choose one of {choices}.", choices=", ".join(MILLIMETRES)),
        )
    if len(faces) == 0:
        raise ScanError(Message("No trunk detected in this scan."), NOTHING_ELSE)
    told_up, told_front = parse_axes(up, front)
    told = told_up is not None and told_front is not None
    cloud = sample_uniformly(vertices, faces)
    progress(STANDING, 0.3)
    readings = _readings(cloud, told_up, told_front)
    progress(STANDING, 0.9)
    if told_up and told_front and readings[0].evidence < LEAST:  # against the shape: then to the letter
        readings = _readings(cloud, AxisOverride(told_up.direction, exact=True), told_front)
    if not told:
        require_plausible(cloud, readings)
    return _pose(cloud, readings, unit, told)


def _pose(cloud: Cloud, readings: list[PoseCandidate], unit: str | None, told: bool) -> Pose:
    best = readings[0]
    size = estimate_unit(_girth(cloud, best), unit)
    margin = best.score - max((other.score for other in readings[1:]), default=-np.inf)
    clear = best.evidence >= LEAST if told else margin >= SURE_MARGIN and best.score >= SURE_SCORE
    turns = [_turn(reading) for reading in readings]
    axes = nearest_axis(turns[0][2]), nearest_axis(-turns[0][1])
    tilt = float(np.degrees(np.arccos(min(1.0, float(np.abs(turns[0][2]).max())))))
    reason = join((size.reason, _reason(best, axes, told, clear)))
    if tilt > 0.0:
        lean = Message(
            "The body was tilted by {tilt} degrees from {up} in its file and was set upright.",
            tilt=f"{tilt:.0f}",
            up=axes[0],
        )
        reason = join((reason, lean))
    matrices = [_scaled(turn, MILLIMETRES[size.unit]) for turn in turns]
    stand = MILLIMETRES[size.unit] * best.seen.trunk.stand
    sure = clear and size.is_certain
    return Pose(size.unit, *axes, matrices[0], sure, reason, margin, tilt, tuple(matrices[1:]), stand)


def _readings(cloud: Cloud, up: AxisOverride | None, front: AxisOverride | None) -> list[PoseCandidate]:
    """Return ways to stand that fit what was told, each other than the ones before it, best first."""
    exact = up if up and up.exact else front if front and front.exact else None
    told = exact or up
    slant = 0.0 if exact else 0.75  # the sine of what an up within 45 degrees of its axis may be off it
    planes = mirror_planes(cloud, told.direction if told else None, slant)
    planes = [plane for plane in planes if plane.residual < planes[0].residual + MOST_PLANES]
    if (
        up
        and front
        and (
            (up.exact and front.exact)
            or not any(rank_candidates(cloud, plane, up, front) for plane in planes)
        )
    ):
        planes = [_told_plane(cloud, up, front)]
    found = [stance for plane in planes for stance in rank_candidates(cloud, plane, up, front)]
    if not found:
        raise ScanError(Message("No trunk detected in this scan."), NOTHING_ELSE)
    chosen: list[PoseCandidate] = []
    for stance in sorted(found, key=lambda stance: -stance.score):
        if len(chosen) < READINGS and all(stance.differs(other, DIFFERENT) for other in chosen):
            chosen.append(stance)
    if exact is None:
        ends, best = [], chosen[0].score
        for stance in chosen:
            ends.append(_settled(cloud, stance, found) if stance.score > best - RIVAL else stance)
            best = min(best, max(end.score for end in ends))  # the best may look worse once it is settled
        chosen = [stance for stance in ends if _allowed(stance, up, front)] or chosen
    chosen.sort(key=lambda stance: -stance.score)
    return [s for k, s in enumerate(chosen) if all(s.differs(other, DIFFERENT) for other in chosen[:k])]


def _settled(cloud: Cloud, stance: PoseCandidate, found: list[PoseCandidate]) -> PoseCandidate:
    """Return ``stance`` settled, or what is ``found`` upright near to it if that settles better.

    A chin over a chest that leans far forward looks like a bust until the trunk is set upright.
    """
    rivals = [other for other in found if other.upright and other.score > stance.score - RIVAL]
    near = [other for other in rivals if not (stance.upright or stance.differs(other, DIFFERENT))]
    return max((refine_candidate(cloud, one) for one in [stance, *near]), key=lambda one: one.score)


def _allowed(stance: PoseCandidate, up: AxisOverride | None, front: AxisOverride | None) -> bool:
    return (up is None or up.allows(stance.up)) and (front is None or front.allows(-stance.back))


def _told_plane(cloud: Cloud, up: AxisOverride, front: AxisOverride) -> MirrorPlane:
    side = unit(np.cross(up.direction, front.direction))
    return MirrorPlane(side, float(np.percentile(cloud.points @ side, (2, 98)).mean()), 1.0)


def _girth(cloud: Cloud, stance: PoseCandidate) -> float:
    """Return the girth of the trunk by a tape [file units]: as for the silhouette, but exact."""
    trunk = stance.seen.trunk
    own = cloud.points[trunk.own] @ np.stack([stance.left, stance.back, stance.up], axis=1)
    girths = []
    for z in trunk.z[trunk.proper]:
        level = own[np.abs(own[:, 2] - z) < cloud.grain]
        girths.append(hull_perimeter(level))
    return float(np.percentile(girths, 60)) if girths else 0.0


def _turn(stance: PoseCandidate) -> Floats:
    """Return left, back and up as rows, shape (3, 3), on the axes of the file if they are near."""
    left, back = stance.left, stance.back
    if np.abs(stance.up).max() == 1.0 and np.abs(left).max() > np.cos(np.radians(SNAP)):
        left, back = AXES[nearest_axis(left)], AXES[nearest_axis(back)]
    return np.stack([left, back, stance.up])


def _scaled(turn: Floats, factor: float) -> Floats:
    matrix = np.eye(4)
    matrix[:3, :3] = factor * turn
    return matrix


def _reason(best: PoseCandidate, axes: tuple[str, str], told: bool, sure: bool) -> Message:
    up, front = axes
    if told:
        words = Message("Up {up} and front {front} were set manually.", up=up, front=front)
        return words if sure else join((words, Message("This contradicts the detected shape. Please check.")))
    if not sure:
        return Message("Up {up} and front {front} are uncertain. Check the orientation.", up=up, front=front)
    first, second, third = sorted(best.cue_scores, key=lambda words: -best.cue_scores[words])[:3]
    return Message(
        "Up {up} and front {front} were detected from {first}, {second} and {third}.",
        up=up,
        front=front,
        first=first,
        second=second,
        third=third,
    )
