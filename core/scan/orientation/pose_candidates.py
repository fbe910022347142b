"""Stances of a body: the ways it might stand, each with how well it looks like an upper body that does."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from core.geometry.mesh import Floats, unit
from core.messages import Message
from core.scan.orientation.axis_override import AXES, AxisOverride, nearest_axis
from core.scan.orientation.cut_planes import find_cut_planes
from core.scan.orientation.orientation_cues import TorsoFeatures, extract_features, score
from core.scan.orientation.silhouette import silhouette
from core.scan.orientation.symmetry_planes import Cloud, MirrorPlane

TURN = 15.0
"""Step between the directions in a mirror plane that are tried as up [degrees]."""

FILE_AXIS = 0.5
"""What a file adds to a stance that is upright in it [1]: most scanners know what is up."""

CUT = 0.5
"""What a plane cut below adds to a stance that is square to it [1]: cuts are made level."""

LEVEL = 3.0
"""A cut that is level in the file to this angle [degrees] was level when it was made."""

LEAN, LEAN_ASIDE = 10.0, 4.0
"""A body leans against the axis of its file by this at most [degrees]; further, it was tilted."""

TRUE_ASIDE, TRUE_LEAN = 1.0, 17.0
"""A file axis this near to the mirror plane [degrees] is not there by chance: then it may lean so far."""


@dataclass(frozen=True, eq=False)
class PoseCandidate:
    """One way to stand: unit vectors ``left``, ``back``, ``up`` in the file, shape (3,).

    ``evidence`` is what speaks for an upper body that stands so [1], ``cue_scores`` what each cue adds to it;
    ``residual`` and ``offset`` are those of the mirror plane. ``cut``: it ends in a plane cut below.
    """

    left: Floats
    back: Floats
    up: Floats
    offset: float
    residual: float
    seen: TorsoFeatures
    evidence: float
    cue_scores: dict[Message, float]
    cut: bool = False

    @property
    def upright(self) -> bool:
        """Return whether the body is along an axis of the file, except for a slight lean."""
        return bool(np.abs(self.up).max() > np.cos(np.radians(LEAN)))

    @property
    def score(self) -> float:
        """Return how likely this is how the body stands [1]."""
        return self.evidence + FILE_AXIS * float(self.upright) + CUT * float(self.cut) - 6.0 * self.residual

    def differs(self, other: PoseCandidate, degrees: float = 40.0) -> bool:
        """Return whether up or front have another direction."""
        return bool(min(self.up @ other.up, self.back @ other.back) < np.cos(np.radians(degrees)))


def rank_candidates(
    cloud: Cloud, plane: MirrorPlane, up: AxisOverride | None = None, front: AxisOverride | None = None
) -> list[PoseCandidate]:
    """Return the ways to stand with a mirror plane: every 15 degrees round, facing to or fro.

    One of them is along the axis of the file nearest to the plane. ``up`` and ``front`` leave out ways; the
    plane must hold one that is exact. Source: ours.
    """
    exact = up if up and up.exact else front if front and front.exact else None
    turns = np.radians(np.arange(0.0, 180.0, 90.0 if exact else TURN))
    axis = exact.direction if exact else np.eye(3)[np.argmin(np.abs(plane.side))]
    start = unit(axis - (axis @ plane.side) * plane.side)
    across = np.cross(start, plane.side)
    found = []
    for angle in turns:
        direction = np.cos(angle) * start + np.sin(angle) * across
        ways = tuple(way for way in (1, -1) if up is None or up.allows(way * direction))
        found += _ways_to_stand(cloud, plane, direction, ways) if ways else []
    return [stance for stance in found if front is None or front.allows(-stance.back)]


def _ways_to_stand(
    cloud: Cloud, plane: MirrorPlane, up: Floats, ways: tuple[int, ...]
) -> list[PoseCandidate]:
    back = np.cross(up, plane.side)
    trunk = silhouette(
        cloud.points @ np.stack([plane.side, back, up], axis=1) - [plane.offset, 0.0, 0.0], cloud.grain
    )
    if trunk is None:
        return []
    found = []
    for way in ways:
        for sign in (1, -1):
            seen = extract_features(trunk.turned(way, sign))
            evidence, text = score(seen)
            directions = (way * sign * plane.side, sign * back, way * up)
            found.append(
                PoseCandidate(*directions, way * sign * plane.offset, plane.residual, seen, evidence, text)
            )
    return found


def refine_candidate(cloud: Cloud, stance: PoseCandidate) -> PoseCandidate:
    """Return ``stance`` with its up set by a plane cut below, by the trunk and by the axis of the file."""
    cut = _cut_below(cloud, stance)
    up = _true_up(cloud, stance, cut)
    side = unit(stance.left - (stance.left @ up) * up)
    middle = cloud.points.mean(axis=0)
    offset = stance.offset + float(middle @ (side - stance.left))
    again = _ways_to_stand(cloud, MirrorPlane(side, offset, stance.residual), up, (1,))
    found = max(again, key=lambda other: other.back @ stance.back, default=stance)
    return replace(found, cut=cut is not None)


def _cut_below(cloud: Cloud, stance: PoseCandidate) -> Floats | None:
    """Return the up that a plane cut through the trunk tells, if it ends in one below."""
    own = cloud.points[stance.seen.trunk.own]
    least = 0.3 * stance.seen.trunk.main_girth**2 / (4.0 * np.pi)
    cuts = [end for end in find_cut_planes(own, cloud.grain, -stance.up) if end.area > least]
    return -cuts[0].normal if cuts else None


def _true_up(cloud: Cloud, stance: PoseCandidate, cut: Floats | None) -> Floats:
    axis = AXES[nearest_axis(stance.up)]
    aside = np.degrees(np.arcsin(min(1.0, abs(float(axis @ stance.left)))))
    if cut is not None and _angle(cut, axis) < LEVEL:
        return axis
    trunk = _along_trunk(cloud, stance)
    if cut is not None:
        leaning = _angle(cut, axis) < TRUE_LEAN and aside < TRUE_ASIDE
        if leaning and _angle(trunk, axis) < _angle(trunk, cut):
            return axis  # the trunk says so too: the cut was not made level
        return cut if _angle(cut, stance.left) > 80.0 else _in_plane(cut, stance.left)
    leans = LEAN if aside > TRUE_ASIDE else TRUE_LEAN
    return axis if _angle(trunk, axis) < leans and aside < LEAN_ASIDE else trunk


def _along_trunk(cloud: Cloud, stance: PoseCandidate) -> Floats:
    """Return the up along which the middle of the trunk runs, in its mirror plane."""
    for _ in range(3):
        lean = np.arctan(stance.seen.lean)
        up = np.cos(lean) * stance.up + np.sin(lean) * stance.back
        plane = MirrorPlane(stance.left, stance.offset, stance.residual)
        again = _ways_to_stand(cloud, plane, up, (1,))
        stance = max(again, key=lambda other: other.back @ stance.back, default=stance)
    return stance.up


def _in_plane(direction: Floats, normal: Floats) -> Floats:
    return np.asarray(unit(direction - (direction @ normal) * normal))


def _angle(a: Floats, b: Floats) -> float:
    return float(np.degrees(np.arccos(np.clip(abs(a @ b), 0.0, 1.0))))
