"""The trunk of an upright body: its horizontal sections without the arms, and what a tape reads there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt
from scipy.ndimage import label, median_filter

from core.errors import LandmarkError
from core.geometry.level_outlines import (
    BINS,
    MOST_SEGMENTS,
    Outlines,
    not_a_surface_error,
    outlines,
    points_at,
    radii,
)
from core.geometry.mesh import SIGNS, Flags, Floats, Indices, Mesh, Points
from core.geometry.plane_sections import hull_corners, hull_perimeter
from core.landmarks.torso.arm_removal import SLACK
from core.landmarks.torso.contour_classification import kept_pieces, main_pieces, pieces_beside, split_pieces
from core.landmarks.torso.gap_filling import bearing_bin, bridge, eroded, gaps
from core.landmarks.torso.torso_axis import STEP, TorsoAxis, arm_segments, torso_axis
from core.messages import Length, Message

NECK = 0.5
"""A level narrower than this part of the trunk is a neck: what is above it is none of the trunk [1]."""

STABLE_DOWN = 5.0 * np.arange(9)
"""How far under the breasts a stable under-bust level is sought, and four steps further [mm]."""


@dataclass(frozen=True, eq=False)
class Level:
    """The outline of the trunk at height ``z`` [mm]: ``segments`` of skin, shape (s, 2, 3) [mm], in no order.

    ``bridges``, shape (b, 2, 3) [mm], close it where arms were cut off or the scan has a hole.
    """

    z: float
    segments: Points
    bridges: Points = field(default_factory=lambda: np.empty((0, 2, 3)))

    @property
    def points(self) -> Points:
        """Return end points of the segments and bridges, shape (2 (s + b), 3) [mm]."""
        return np.concatenate([self.segments, self.bridges]).reshape(-1, 3)

    @property
    def tape(self) -> float:
        """Return the length of a tape round the outline, bridging the hollows [mm]."""
        return hull_perimeter(self.points)

    @property
    def bridged_mm(self) -> float:
        """Return the length of the outline that is no skin [mm]: under it, the girth is an estimate."""
        return _length(self.bridges)

    @property
    def longest_straight(self) -> float:
        """Length of the longest hollow that a tape on the skin bridges, or of the longest flat [mm]."""
        skin = self.segments.reshape(-1, 3)[:, :2]
        ring = skin[hull_corners(skin)]
        return float(np.linalg.norm(ring - np.roll(ring, 1, axis=0), axis=1).max(initial=0.0))

    @property
    def skin(self) -> float:
        """Return the length of the outline itself [mm]."""
        return _length(self.segments) + self.bridged_mm


def _length(segments: Points) -> float:
    return float(np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1).sum())


def trunk_levels(mesh: Mesh, heights: npt.ArrayLike, *, arms: bool = False) -> list[Level]:
    """Cut ``mesh`` at ascending ``heights``, shape (k,) [mm], and take the arms out; a level may be empty.

    Arms beside or in front of the trunk are left out, and those that touch it are cut off unless ``arms``
    asks for them. What is missing then, or in holes of the scan, is bridged after the levels near by.
    Source: ours.
    """
    z = np.atleast_1d(np.asarray(heights, dtype=np.float64))
    cuts, guide = outlines(mesh, z), torso_axis(mesh)
    if len(guide.z) == 0:
        return [Level(float(height), np.empty((0, 2, 3))) for height in z]
    near = np.array([guide.between(float(height))[:2] for height in z])
    main = np.where(guide.shown[near].any(axis=1), main_pieces(cuts, guide.middle), -1)
    main = split_pieces(cuts, main, guide.sides[near[:, 0]])
    kept, loose = kept_pieces(cuts, main, _limbs(cuts, main, guide, near), guide.sides[near[:, 0]])
    inside = (guide.z[0] <= z) & (z <= guide.z[-1]) & guide.shown[near].all(axis=1)
    levels = []
    for k, rows in enumerate(cuts.rows()):
        own = rows[kept[cuts.piece[rows]]]
        cut = not arms and len(own) > 0 and bool(guide.cut[near[k]].any())
        if cut:
            own = _armless(cuts, guide, own, near[k])
        if cut or loose[k] or (inside[k] and not len(own)):
            levels.append(_closed(cuts.segments[own], guide, float(z[k]), cut))
        else:
            levels.append(Level(float(z[k]), cuts.segments[own]))
    return levels


def _limbs(cuts: Outlines, main: Indices, guide: TorsoAxis, near: Indices) -> Flags:
    """Tell which closed pieces are arms: beside the trunk, or where an arm is on the levels of the guide."""
    pieces = cuts.pieces
    body = main[pieces.level]
    other = pieces.closed & (body >= 0) & (body != np.arange(len(body)))
    limb = other & pieces_beside(pieces, body, guide.middle)
    for piece in np.flatnonzero(other & ~limb):
        boxes = guide.limb_boxes[np.isin(guide.limb_level, near[pieces.level[piece]])]
        centre = pieces.centre[piece]
        limb[piece] = ((boxes[:, 0] <= centre) & (centre <= boxes[:, 1])).all(axis=1).any()
    return np.asarray(limb)


def _armless(cuts: Outlines, guide: TorsoAxis, own: Indices, near: Indices) -> Indices:
    """Return those of the segments ``own`` of one level that are left when the arms are cut off."""
    z = float(cuts.z[cuts.level[own[0]]])
    centre = guide.centre_at(z)
    joints = [bool(guide.necks[near, s].any()) for s in (0, 1)]
    if any(joints):
        for joint, arm in zip(joints, arm_segments(cuts, own, centre), strict=True):
            own = own[~np.isin(own, arm)] if joint else own
    for s, side in enumerate(SIGNS):
        if guide.cut[near, s].any():
            out = side * (cuts.segments[own, :, 0].mean(axis=1) - centre[0])
            own = own[out < guide.half_width(z, side) + SLACK]
    return own


def _closed(segments: Points, guide: TorsoAxis, z: float, cut: bool) -> Level:
    """Return a level whose gaps are bridged after the guide; the ends of a cut are taken off."""
    centre = guide.centre_at(z)
    far = radii(segments, np.zeros(len(segments), dtype=np.int64), centre[None])[0]
    skin = np.isfinite(far)
    if skin.sum() <= BINS // 3:  # the guide shows no such level either
        segments, skin[:] = segments[:0], False
    if cut:
        skin = eroded(skin)
        segments = segments[skin[bearing_bin(segments, centre)]]
    low, high, share = guide.between(z)
    below, above = guide.reach[[low, high]]
    shape = np.where(np.isnan(above), below, below + share * (above - below))
    shape = np.where(np.isnan(below), above, shape)
    whole = bridge(far, skin, shape, cut) if skin.any() else shape
    return Level(z, segments, _bridges(whole, skin, centre, z))


def _bridges(far: Floats, skin: Flags, centre: Points, z: float) -> Points:
    """Return the segments over the gaps between ``skin``, (b, 2, 3) [mm]; all round if there is none."""
    bridges = [np.empty((0, 2, 3))]
    for run in gaps(skin) if skin.any() else [np.arange(1, BINS)]:
        line = np.concatenate([[(run[0] - 1) % BINS], run, [(run[-1] + 1) % BINS]])
        line = line[np.isfinite(far[line])]
        points = points_at(far[line], line, centre, z)
        bridges.append(np.stack([points[:-1], points[1:]], axis=1))
    return np.concatenate(bridges)


def stable_level(mesh: Mesh, underbust_level: float) -> Level:
    """Return the first outline from ``underbust_level`` [mm] down that no longer nicks the breasts."""
    return first_stable(trunk_levels(mesh, underbust_level - STABLE_DOWN[::-1])[::-1])


def first_stable(levels: Sequence[Level]) -> Level:
    """Return the first of ``levels``, ``STABLE_DOWN`` under the breasts, that no longer nicks them.

    In steps of 5 mm: the first whose tape falls to the next by no more than the taper of the ribs + 4 mm, not
    more than 35 mm down; else the one with the smallest fall. Source: ours.
    """
    tape = np.array([level.tape for level in levels])
    fall = tape[:-1] - tape[1:]
    taper = (tape[4] - tape[8]) / 4.0
    calm = np.flatnonzero(fall <= taper + 4.0)
    return levels[int(calm[0]) if len(calm) else int(np.argmin(fall))]


@dataclass(frozen=True, eq=False)
class TorsoSections:
    """The trunk level by level, from below: arrays of shape (k,) [mm].

    ``samples`` are points spread evenly over all outlines, shape (n, 3) [mm], ``row`` the level of each.
    """

    z: Floats
    step: float
    middle: float
    half_width: Floats
    front: Floats
    back: Floats
    tape: Floats
    samples: Points
    row: Indices

    def trunk(self) -> tuple[float, Flags]:
        """Return the half width of the trunk [mm] and which levels show it free of arms, head and legs."""
        full = self.tape > 0.0
        if not full.any():
            raise LandmarkError(
                Message("The scan has no body in its centre."),
                Message("Open a scan of a complete upper body."),
            )
        w = self.half_width
        alone = full & (w < 1.25 * np.median(w[full & (w >= np.median(w[full]))]))
        width, girth = np.percentile(w[alone], 70), np.percentile(self.tape[alone], 70)
        usable = full & (w > 0.7 * width) & (w < 1.3 * width) & (self.tape > 0.7 * girth)
        usable &= (self.z < self.z[full].max() - 60.0) & (self.z > self.z[full].min() + 30.0)
        runs, _ = label(~(full & (w < NECK * width)))
        if usable.any():  # a head with its hair is as wide as a trunk
            usable &= runs == np.bincount(runs[usable]).argmax()
        if not 400.0 < girth < 2000.0:
            raise LandmarkError(
                Message(
                    "The trunk girth is {girth}, which is implausible for an adult.", girth=Length(girth)
                ),
                Message("Set the unit of the scan."),
            )
        return float(width), usable

    def back_width(self) -> Floats:
        """Return the half width of the back half of the levels, steadied over five, shape (k,) [mm]."""
        behind = self.samples[:, 1] > (0.5 * (self.front + self.back))[self.row]
        width = np.zeros(len(self.z))
        np.maximum.at(width, self.row[behind], np.abs(self.samples[behind, 0] - self.middle))
        return np.asarray(np.maximum(median_filter(width, 5), 1.0))


def _refuse_height(height: float) -> None:
    if not 100.0 < height < 2500.0:
        raise LandmarkError(
            Message(
                "The scan is {height} high, which is implausible for an upper body.", height=Length(height)
            ),
            Message("Set the unit of the scan."),
        )


def scan_torso(mesh: Mesh) -> TorsoSections:
    """Measure the trunk of the whole ``mesh`` every 5 mm.

    Raises LandmarkError if it has not the height of a body, or no skin.
    """
    _refuse_height(float(np.ptp(mesh.vertices[:, 2])))
    guide = torso_axis(mesh)
    segments, row = guide.cuts.segments[guide.keep], guide.cuts.level[guide.keep]
    seen, bridges = np.bincount(row, minlength=len(guide.z)) > 0, {}
    for k in np.flatnonzero(guide.shown | seen):
        bridges[k] = _bridges(guide.reach[k], guide.skin[k], guide.centre[k], float(guide.z[k]))
        if not guide.skin[k].any():
            segments = np.concatenate([segments, bridges[k]])
            row = np.append(row, np.full(len(bridges[k]), k))
    order = np.argsort(row, kind="stable")
    segments, row = segments[order], row[order]
    length = np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1)
    times = np.maximum(1, np.ceil(length / 4.0).astype(np.int64))
    if times.sum() > MOST_SEGMENTS:
        raise not_a_surface_error()
    t = (np.arange(times.sum()) - np.repeat(np.cumsum(times) - times, times) + 0.5) / np.repeat(times, times)
    a, b = (np.repeat(segments[:, k], times, axis=0) for k in (0, 1))
    samples = a + (b - a) * t[:, None]
    # (the levels without trunk keep zeros)
    lo, hi = np.zeros((len(guide.z), 3)), np.zeros((len(guide.z), 3))
    start = np.searchsorted(row, np.arange(len(guide.z) + 1))
    for k in np.flatnonzero(np.diff(start)):
        points = np.concatenate([segments[start[k] : start[k + 1]], bridges[k]]).reshape(-1, 3)
        lo[k], hi[k] = points.min(axis=0), points.max(axis=0)
    full = hi[:, 0] > lo[:, 0]
    middle = float(np.median(0.5 * (lo + hi)[full, 0])) if full.any() else 0.0
    half_width = 0.5 * (hi - lo)[:, 0]
    tape, row = np.where(full, guide.tape, 0.0), np.repeat(row, times)
    return TorsoSections(guide.z, STEP, middle, half_width, lo[:, 1], hi[:, 1], tape, samples, row)
