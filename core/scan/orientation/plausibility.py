"""Plausibility of an upper body, and the errors without it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from core.errors import ScanError
from core.messages import Message
from core.scan.orientation.cut_planes import TOUCH, CutPlane, find_cut_planes
from core.scan.orientation.pose_candidates import PoseCandidate
from core.scan.orientation.symmetry_planes import Cloud

LEAST = 2.0
"""A body has more that speaks for it [1], 3.7 and up; most solids, limbs and furniture have 1.2 at most.

A few come near or over it, a head 2.0, a cone 2.1, a belly 3.0: for want of a bust these are refused later.
"""

UNLIKE = 0.38
"""Left and right of a body mirror each other better than this [1]; those of a half body do not."""

STOUTNESS = (0.85, 2.4)
"""Width of a trunk over its depth [1]."""

HALF = 0.3
"""A flat opening larger than this share of the skin [1], upright, is where a half is missing."""

SHORT, FAINT = 300.0, 12.0
"""A scan lower than this [mm of a typical trunk] must show a fold deeper than this [mm]."""

FACING = 0.6
"""At a rim the skin runs up to the plane of the opening [cosine]; what only touches a plane faces it."""

WHOLE = Message("Open a scan of a complete upper body, or set its up and front axes.")


def require_plausible(cloud: Cloud, readings: Sequence[PoseCandidate]) -> None:
    """Raise ScanError, with the likeliest reason, if the best of ``readings``, the first, is no upper body.

    A half of a body fits none of them: its opening stands upright in one of them at least. Source: ours.
    """
    best = readings[0]
    trunk = best.seen.trunk
    if _halved(cloud, readings):
        raise ScanError(Message("The scan contains only half of an upper body."), WHOLE)
    if best.residual > UNLIKE:
        raise ScanError(
            Message("Left and right differ too much for an upper body: one half may be missing."),
            WHOLE,
        )
    if trunk.stoutness > STOUTNESS[1] and best.evidence > 0.0:
        raise ScanError(
            Message("The scan is too flat for an upper body: the front or the back of the trunk is missing."),
            WHOLE,
        )
    if trunk.height[-1] < SHORT and (best.evidence < LEAST or best.seen.fold.strength < FAINT):
        raise ScanError(
            Message(
                "The scan is too short for an upper body: no bust detected on the scanned part of the trunk."
            ),
            WHOLE,
        )
    if best.evidence < LEAST or not STOUTNESS[0] < trunk.stoutness < STOUTNESS[1]:
        raise ScanError(
            Message(
                "The scan does not resemble an upper body: no bust detected on the front of a "
                "symmetric trunk."
            ),
            Message("Remove everything except the body, or set the up and front axes."),
        )


def _halved(cloud: Cloud, readings: Sequence[PoseCandidate]) -> bool:
    """Return whether the skin is open along an upright plane, and not like a tube, at both ends."""
    ends = [end for end in find_cut_planes(cloud.points, cloud.grain) if not end.filled]
    area = HALF * len(cloud.points) * cloud.grain**2
    return any(
        end.area > area
        and any(abs(end.normal @ reading.up) < np.cos(np.radians(45.0)) for reading in readings)
        and _is_rim(cloud, end)
        and not any(other.normal @ end.normal < -0.7 and other.area > 0.4 * end.area for other in ends)
        for end in ends
    )


def _is_rim(cloud: Cloud, end: CutPlane) -> bool:
    touching = np.abs(cloud.points @ end.normal - end.offset) < TOUCH * cloud.grain
    return bool(np.median(np.abs(cloud.normals[touching] @ end.normal)) < FACING)
