"""How the trunk runs up the body: looked at once a mesh, so that any level of it knows arms and holes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.ndimage import median_filter

from core.arms import limbs, necks, shoulder_clip
from core.mesh import Flags, Floats, Indices, Mesh, Points
from core.outline import BEARINGS, BINS, Outlines, outlines, reach, ring
from core.sections import hull_perimeter

GAP = 12.0
"""An open piece of outline nearer than this to the trunk, along x [mm], belongs to it."""

STEP = 5.0
"""Distance of the levels of a guide [mm]."""

BRIDGE = 150.0
"""What is missing on a level is taken from levels not farther away than this [mm]."""

SIDES = (1.0, -1.0)
"""Sign of x of the left and of the right side."""


@dataclass(frozen=True, eq=False)
class Guide:
    """The trunk every 5 mm of height ``z``, shape (k,) [mm], about ``centre``, shape (k, 2) [mm].

    ``reach``, shape (k, BINS) [mm], is how far it reaches all round, bridged where it is not ``skin``;
    ``clip``, shape (k, 2) [mm], how wide it may be left and right; ``necks``, shape (k, 2), where an arm is
    joined by a neck; ``shown``, shape (k,), which levels show a trunk; ``limb_boxes``, shape (l, 2, 2) [mm],
    are the boxes of outlines of arms on levels ``limb_level``.
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

    @property
    def cut(self) -> Flags:
        """Where an arm is cut off, left and right, shape (k, 2)."""
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


@lru_cache(maxsize=4)
def guide_of(mesh: Mesh) -> Guide:
    """Look at the whole height of ``mesh`` [mm]. Source: ours."""
    low, high = mesh.vertices[:, 2].min(), mesh.vertices[:, 2].max()
    cuts = outlines(mesh, np.arange(low + 0.5 * STEP, high, STEP)[:800])
    middle = middle_of(cuts)
    main = main_pieces(cuts, middle)
    centre = _centres(cuts, main, middle)
    main[_legs(cuts, main, centre)] = -1
    limb = limbs(cuts.pieces, main, cuts.z, middle) if len(main) else np.empty(0, dtype=bool)
    kept, joined = kept_pieces(cuts, main, limb)
    keep = kept[cuts.piece]
    joints = np.zeros((len(cuts.z), 2), dtype=bool)
    for k, rows in enumerate(cuts.rows()):
        own = rows[keep[rows]]
        if len(own) and _hollow(cuts.segments[own]):
            left, right = cut_off(cuts, own, centre[k])
            joints[k] = len(left) > 0, len(right) > 0
            keep[left] = keep[right] = False
    far = reach(cuts.segments[keep], cuts.level[keep], centre)
    clip = np.stack([shoulder_clip(_width(cuts, keep, far, centre, s), STEP) for s in SIDES], axis=1)
    keep &= within(cuts, centre, clip)
    cut = joints | np.isfinite(clip)
    far = reach(cuts.segments[keep], cuts.level[keep], centre)
    shown = np.isfinite(far).sum(axis=1) > BINS // 3
    open_ = shown & (cut.any(axis=1) | joined)
    skin = np.isfinite(far)
    skin[~open_] = True
    skin[~shown] = False
    skin[cut.any(axis=1)] = eroded(skin[cut.any(axis=1)])
    boxes = np.stack([cuts.pieces.low[limb], cuts.pieces.high[limb]], axis=1)
    bridged = _bridged(far, skin, shown, cuts.z)
    return Guide(cuts.z, middle, centre, bridged, skin, clip, joints, shown, boxes, cuts.pieces.level[limb])


def middle_of(cuts: Outlines) -> float:
    """Return x of the middle of the body: the median middle of the widest piece of each level [mm]."""
    pieces = cuts.pieces
    if len(pieces.level) == 0:
        return 0.0
    order = np.lexsort((pieces.high[:, 0] - pieces.low[:, 0], pieces.level))
    widest = order[np.append(np.diff(pieces.level[order]) > 0, True)]
    return float(np.median(pieces.centre[widest, 0]))


def main_pieces(cuts: Outlines, middle: float) -> Indices:
    """Return the piece that is the trunk on each level: the largest across the middle; -1 for none."""
    pieces = cuts.pieces
    main = np.full(len(cuts.z), -1)
    over = np.flatnonzero((pieces.low[:, 0] <= middle) & (middle <= pieces.high[:, 0]))
    order = over[np.argsort(pieces.size[over], kind="stable")]
    main[pieces.level[order]] = order
    return main


def kept_pieces(cuts: Outlines, main: Indices, limb: Flags) -> tuple[Flags, Flags]:
    """Tell which pieces are trunk, and on which levels its outline is open."""
    pieces = cuts.pieces
    kept = np.zeros(len(pieces.level), dtype=bool)
    open_ = np.zeros(len(main), dtype=bool)
    for k, rows in enumerate(cuts.piece_rows()):
        if main[k] < 0:
            continue
        kept[main[k]] = True
        inner = ~limb[rows] & pieces.closed[rows]
        low, high = pieces.low[main[k], 0], pieces.high[main[k], 0]
        if not pieces.closed[main[k]]:
            open_[k] = True
            loose = rows[~pieces.closed[rows]]
            more = np.zeros(len(loose), dtype=bool)
            while True:
                centre = pieces.centre[loose, 0]
                near = (pieces.low[loose, 0] <= high + GAP) & (pieces.high[loose, 0] >= low - GAP)
                near |= (low <= centre) & (centre <= high)
                if np.array_equal(near, more):
                    break
                more = near
                low, high = pieces.low[loose[more], 0].min(), pieces.high[loose[more], 0].max()
            kept[loose[more]] = True
        centre = pieces.centre[rows, 0]
        kept[rows[inner & (low <= centre) & (centre <= high)]] = True
    return kept, open_


def cut_off(cuts: Outlines, own: Indices, centre: Points) -> tuple[Indices, Indices]:
    """Return those of the segments ``own`` of one level that belong to a left and to a right arm."""
    order, starts = ring(cuts.segments[own], cuts.ids[own])
    rows, closed = own[order], np.concatenate([starts, starts[:1]])
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))])
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
    """Tell which segments lie no farther out than ``clip``, shape (k, 2) [mm], left and right."""
    x = cuts.segments[:, :, 0].mean(axis=1) - centre[cuts.level, 0]
    return np.asarray((x < clip[cuts.level, 0]) & (-x < clip[cuts.level, 1]))


def bridge(far: Floats, skin: Flags, below: Floats, above: Floats, share: Floats) -> Floats:
    """Fill the gaps of one level, shape (BINS,) [mm], after the shapes of the levels below and above it.

    The shapes are moved so that they meet the ends of each gap; with none known the gap is closed straight.
    """
    shape = np.where(
        np.isnan(above), below, np.where(np.isnan(below), above, below + share * (above - below))
    )
    result = far.copy()
    for run in gaps(skin):
        a, b = (run[0] - 1) % BINS, (run[-1] + 1) % BINS
        t = np.arange(1, len(run) + 1) / (len(run) + 1)
        own = shape[run]
        if np.isnan(own).any() or np.isnan(shape[[a, b]]).any():
            spread = len(run) + 1.0
            turn = spread * t * 2.0 * np.pi / BINS
            whole = spread * 2.0 * np.pi / BINS
            if whole > 2.8:
                continue
            result[run] = (
                far[a] * far[b] * np.sin(whole) / (far[a] * np.sin(turn) + far[b] * np.sin(whole - turn))
            )
            continue
        result[run] = own + (1.0 - t) * (far[a] - shape[a]) + t * (far[b] - shape[b])
    return result


def gaps(skin: Flags) -> list[Indices]:
    """Return the runs of directions without skin, round the circle; none if there is no skin at all."""
    if skin.all() or not skin.any():
        return []
    start = int(np.argmax(skin))
    missing = (np.flatnonzero(~np.roll(skin, -start)) + start) % BINS
    breaks = np.flatnonzero(np.diff((missing - start) % BINS) > 1) + 1
    return list(np.split(missing, breaks))


def _bridged(far: Floats, skin: Flags, shown: Flags, z: Floats) -> Floats:
    result = far.copy()
    levels = np.arange(len(z))
    for k in np.flatnonzero(shown & ~skin.all(axis=1)):
        near = np.abs(z - z[k]) <= BRIDGE
        below, above = np.full(BINS, np.nan), np.full(BINS, np.nan)
        share = np.full(BINS, 0.5)
        for run in gaps(skin[k]):
            wide = np.concatenate([[(run[0] - 1) % BINS], run, [(run[-1] + 1) % BINS]])
            whole = near & shown & (skin[:, wide] & np.isfinite(far[:, wide])).all(axis=1)
            low, high = levels[whole & (levels < k)], levels[whole & (levels > k)]
            if len(low):
                below[wide] = far[low[-1], wide]
            if len(high):
                above[wide] = far[high[0], wide]
            if len(low) and len(high):
                share[wide] = (z[k] - z[low[-1]]) / (z[high[0]] - z[low[-1]])
        shape = bridge(np.where(skin[k], far[k], np.nan), skin[k], below, above, share)
        result[k] = shape
    return result


def eroded(skin: Flags) -> Flags:
    """Return ``skin``, shape (.., BINS), without the ends of its runs, which bend towards what was cut."""
    return np.asarray(skin & np.roll(skin, 1, axis=-1) & np.roll(skin, -1, axis=-1))


def _hollow(segments: Points) -> bool:
    """Tell whether an outline has hollows deep enough for an arm that touches."""
    length = float(np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1).sum())
    return length > 1.012 * hull_perimeter(segments[:, 0])


def _centres(cuts: Outlines, main: Indices, middle: float) -> Points:
    """Return the middle of the trunk on each level, steadied over nine, shape (k, 2) [mm]."""
    shown = np.flatnonzero(main >= 0)
    if len(shown) == 0:
        return np.tile([middle, 0.0], (len(main), 1))
    own = cuts.pieces.centre[main[shown]]
    calm = np.stack([median_filter(own[:, k], 9, mode="nearest") for k in (0, 1)], axis=1)
    rows = np.arange(len(main))
    return np.stack([np.interp(rows, shown, calm[:, k]) for k in (0, 1)], axis=1)


def _legs(cuts: Outlines, main: Indices, centre: Points) -> Flags:
    """Tell which levels, from below, are legs that touch: thin in the middle and thick on both sides."""
    legs = np.zeros(len(main), dtype=bool)
    if len(cuts.piece) == 0:
        return legs
    trunk = np.isin(cuts.piece, main[main >= 0])
    far = reach(cuts.segments[trunk], cuts.level[trunk], centre)
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


def bearing_bin(segments: Points, centre: Points) -> Indices:
    """Return the direction in which each segment lies from its centre, shape (s,)."""
    out = segments[:, :, :2].mean(axis=1) - centre
    bearing = np.arctan2(out[:, 0], -out[:, 1])
    return np.asarray(np.floor((bearing + np.pi) * BINS / (2.0 * np.pi)).astype(np.int64) % BINS)
