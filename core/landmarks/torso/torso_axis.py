"""Axis of the torso over its height, computed once for a mesh."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from weakref import WeakKeyDictionary

import numpy as np
from scipy.ndimage import median_filter

from core.geometry.level_outlines import BEARINGS, BINS, Outlines, outlines, radii, ring
from core.geometry.mesh import SIGNS, Flags, Floats, Indices, Mesh, Points
from core.geometry.plane_sections import arc_length
from core.landmarks.torso.arm_removal import necks, shoulder_clip
from core.landmarks.torso.contour_classification import (
    kept_pieces,
    limbs,
    main_pieces,
    middle_of,
    split_pieces,
)
from core.landmarks.torso.gap_filling import bearing_bin, bridged_levels, eroded, over_strips

STEP = 5.0
"""Distance of the levels of a guide [mm]."""

MOST = 800
"""So many levels are looked at, enough for a tall body from head to foot."""


@dataclass(frozen=True, eq=False)
class TorsoAxis:
    """The trunk every 5 mm of height ``z``, shape (k,) [mm], about ``centre``, shape (k, 2) [mm].

    ``reach``, shape (k, BINS) [mm], is how far it reaches all round, bridged where it is not ``skin``, even
    all round;
    ``clip``, shape (k, 2) [mm], how wide it may be left and right; ``necks``, shape (k, 2), where an arm is
    joined by a neck; ``shown``, shape (k,), which levels show a trunk; ``limb_boxes``, shape (l, 2, 2) [mm],
    are the boxes of outlines of arms on levels ``limb_level``; ``sides``, shape (k, 2) [mm], are the least
    and the greatest x of closed outlines, NaN far from any; ``keep`` tells the segments of ``cuts`` that are
    trunk.
    """

    z: Floats
    middle: float
    centre: Points
    reach: Floats
    skin: Flags
    clip: Floats
    necks: Flags
    shown: Flags
    limb_boxes: Floats
    limb_level: Indices
    sides: Floats
    cuts: Outlines
    keep: Flags

    @cached_property
    def tape(self) -> Floats:
        """Length of a tape round each level, to some tenths, shape (k,) [mm]; 0 where no trunk is shown."""
        return np.where(self.shown, _tapes(self.reach), 0.0)

    @property
    def cut(self) -> Flags:
        """Return where arms are cut off, left and right, shape (k, 2)."""
        return np.asarray(self.necks | np.isfinite(self.clip))

    def centre_at(self, z: float) -> Points:
        """Return the middle of the trunk at height ``z`` [mm], shape (2,) [mm]."""
        low, high, share = self.between(z)
        return np.asarray(self.centre[low] + share * (self.centre[high] - self.centre[low]))

    def half_width(self, z: float, side: float) -> float:
        """Return how wide the trunk is on ``side`` (+1 left) at height ``z`` [mm]."""
        low, high, share = self.between(z)
        wide = self.reach[[low, high]] * np.maximum(side * np.sin(BEARINGS), 0.0)
        most = np.nanmax(np.nan_to_num(wide), axis=1)
        return float(most[0] + share * (most[1] - most[0]))

    def between(self, z: float) -> tuple[int, int, float]:
        """Return the rows below and above height ``z`` [mm] and the share of the upper one."""
        at = float(np.interp(z, self.z, np.arange(len(self.z))))
        low = int(np.clip(np.floor(at), 0, max(len(self.z) - 2, 0)))
        return low, min(low + 1, len(self.z) - 1), at - low


_GUIDES: WeakKeyDictionary[Mesh, TorsoAxis] = WeakKeyDictionary()
"""The guides of the meshes that are still in use: none keeps its mesh alive."""


def torso_axis(mesh: Mesh) -> TorsoAxis:
    """Compute the axis over the whole height of ``mesh`` [mm]. Source: ours."""
    if mesh not in _GUIDES:
        _GUIDES[mesh] = _looked_at(mesh)
    return _GUIDES[mesh]


def share_axis(mesh: Mesh, rest: Mesh) -> None:
    """Give ``mesh``, which is ``rest`` reshaped at the breasts, its axis: arms and middle stay."""
    _GUIDES[mesh] = torso_axis(rest)


def _looked_at(mesh: Mesh) -> TorsoAxis:
    low, high = mesh.vertices[:, 2].min(), mesh.vertices[:, 2].max()
    count = min(int(np.ceil((high - low) / STEP - 0.5)), MOST) if high > low else 0
    cuts = outlines(mesh, low + STEP * (np.arange(count) + 0.5))
    middle = middle_of(cuts)
    main = main_pieces(cuts, middle)
    centre, sides = _centres(cuts, main, middle)
    main[_legs(cuts, main, centre)] = -1
    main = split_pieces(cuts, main, sides)
    limb = limbs(cuts.pieces, main, cuts.z, middle) if len(main) else np.empty(0, dtype=bool)
    kept, joined = kept_pieces(cuts, main, limb, sides)
    keep = kept[cuts.piece]
    joints = np.zeros((len(cuts.z), 2), dtype=bool)
    hollow = _hollow(cuts, keep, centre)
    for k, rows in enumerate(cuts.rows()):
        own = rows[keep[rows]]
        if hollow[k]:
            left, right = arm_segments(cuts, own, centre[k])
            joints[k] = len(left) > 0, len(right) > 0
            keep[left] = keep[right] = False
    far = radii(cuts.segments[keep], cuts.level[keep], centre)
    clip = np.stack([shoulder_clip(_width(cuts, keep, far, centre, s), STEP) for s in SIGNS], axis=1)
    keep &= within(cuts, centre, clip)
    cut = joints | np.isfinite(clip)
    far = radii(cuts.segments[keep], cuts.level[keep], centre)
    shown = np.isfinite(far).sum(axis=1) > BINS // 3
    open_ = shown & (cut.any(axis=1) | joined)
    skin = np.isfinite(far)
    skin[~open_] = True
    skin[~shown] = False
    skin[cut.any(axis=1)] = eroded(skin[cut.any(axis=1)])
    keep &= skin[cuts.level, bearing_bin(cuts.segments, centre[cuts.level])]
    boxes = np.stack([cuts.pieces.low[limb], cuts.pieces.high[limb]], axis=1)
    whole = bridged_levels(far, skin, np.asarray(cut.any(axis=1)), cuts.z)
    whole, shown = over_strips(whole, shown, cuts.z)
    limb_level = cuts.pieces.level[limb]
    return TorsoAxis(
        cuts.z, middle, centre, whole, skin, clip, joints, shown, boxes, limb_level, sides, cuts, keep
    )


def arm_segments(cuts: Outlines, own: Indices, centre: Points) -> tuple[Indices, Indices]:
    """Return those of the segments ``own`` of one level that belong to a left and to a right arm."""
    order, starts = ring(cuts.segments[own], cuts.ids[own])
    rows, closed = own[order], np.concatenate([starts, starts[:1]])
    along = arc_length(closed)
    half = 0.5 * (along[1:] + along[:-1])
    gone = []
    for found in necks(closed, centre):
        if found is None:
            gone.append(rows[:0])
            continue
        first, last = found
        gone.append(rows[(half > first) & (half < last) if first < last else (half > first) | (half < last)])
    return gone[0], gone[1]


def within(cuts: Outlines, centre: Points, clip: Floats) -> Flags:
    """Return which segments are no farther out than ``clip``, shape (k, 2) [mm], left and right."""
    x = cuts.segments[:, :, 0].mean(axis=1) - centre[cuts.level, 0]
    return np.asarray((x < clip[cuts.level, 0]) & (-x < clip[cuts.level, 1]))


def _hollow(cuts: Outlines, keep: Flags, centre: Points) -> Flags:
    """Return which levels have an outline with hollows deep enough for an arm that touches, shape (k,)."""
    length = np.linalg.norm(cuts.segments[keep, 1] - cuts.segments[keep, 0], axis=1)
    whole = np.bincount(cuts.level[keep], weights=length, minlength=len(centre))
    far = radii(cuts.segments[keep], cuts.level[keep], centre)
    return np.asarray(whole > 1.012 * _tapes(far)) & (whole > 0.0)


def _tapes(far: Floats) -> Floats:
    """Return the length of a tape on each level, shape (k,) [mm]; 0 where there is no trunk.

    The length of a convex outline is the mean of its widths times pi. Source: Cauchy's formula.
    """
    out = np.stack([np.sin(BEARINGS), -np.cos(BEARINGS)])
    spread = out.T @ out
    reached = np.nan_to_num(far)
    support = np.array([(spread * row).max(axis=1).mean() for row in reached])
    return np.asarray(2.0 * np.pi * support)


def _centres(cuts: Outlines, main: Indices, middle: float) -> tuple[Points, Floats]:
    """Return the middle of the trunk on each level, steadied over nine, and where it ends, (k, 2) [mm] each.

    Both are those of closed outlines, where there are any; the ends NaN more than 60 mm from those.
    """
    whole = np.flatnonzero((main >= 0) & cuts.pieces.closed[main]) if len(cuts.piece) else main[:0]
    some = whole if len(whole) > 4 else np.flatnonzero(main >= 0)
    rows = np.arange(len(main))
    if len(some) == 0:
        return np.tile([middle, 0.0], (len(main), 1)), np.full((len(main), 2), np.nan)
    own = cuts.pieces.centre[main[some]]
    calm = [median_filter(own[:, k], 9, mode="nearest") for k in (0, 1)]
    centre = np.stack([np.interp(rows, some, line) for line in calm], axis=1)
    ends = np.stack([cuts.pieces.low[main[some], 0], cuts.pieces.high[main[some], 0]], axis=1)
    sides = np.stack([np.interp(rows, some, line) for line in ends.T], axis=1)
    after = np.searchsorted(some, rows)
    below, above = some[np.maximum(after - 1, 0)], some[np.minimum(after, len(some) - 1)]
    near = np.maximum(np.abs(rows - below), np.abs(rows - above)) * STEP <= 60.0
    sides[~near & ~np.isin(rows, some)] = np.nan
    return centre, sides


def _legs(cuts: Outlines, main: Indices, centre: Points) -> Flags:
    """Return which levels, from below, are legs that touch: thin in the middle and thick on both sides."""
    legs = np.zeros(len(main), dtype=bool)
    if len(cuts.piece) == 0:
        return legs
    trunk = np.isin(cuts.piece, main[main >= 0])
    far = radii(cuts.segments[trunk], cuts.level[trunk], centre)
    front, back = far[:, np.abs(BEARINGS) < 0.1], far[:, np.abs(BEARINGS) > np.pi - 0.1]
    depth = np.ptp(np.stack([cuts.pieces.low[main, 1], cuts.pieces.high[main, 1]]), axis=0)
    thin = np.nan_to_num(front.min(axis=1) + back.min(axis=1), nan=np.inf) < 0.6 * depth
    for k in range(len(main)):
        if main[k] >= 0 and not thin[k]:
            break
        legs[k] = True
    return legs


def _width(cuts: Outlines, keep: Flags, far: Floats, centre: Points, side: float) -> Floats:
    """Return how wide the trunk is on ``side``, shape (k,) [mm]; NaN where its side is not shown."""
    width = np.full(len(centre), -np.inf)
    level = cuts.level[keep]
    np.maximum.at(width, level, (side * (cuts.segments[keep, :, 0] - centre[level, :1])).max(axis=1))
    at = np.abs(np.degrees(side * BEARINGS) - 90.0) < 30.0
    seen = np.isfinite(far[:, at]).mean(axis=1) > 0.6
    return np.where(seen & np.isfinite(width), width, np.nan)
