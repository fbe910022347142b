"""Inner and outer ends of each breast root."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import gaussian_filter1d

from core.geometry.level_outlines import radii
from core.geometry.mesh import SIGNS, Flags, Floats, Mesh, Points
from core.geometry.plane_sections import curvature
from core.landmarks.torso.cross_sections import trunk_levels
from core.landmarks.types import SIDES, Landmark, Landmarks
from core.messages import Message

FINE = 720
"""Directions in which the outline of a breast is read, half a degree apart."""

HEIGHTS = np.array([-12.0, -6.0, 0.0, 6.0])
"""The roots are read on outlines so far above the bust point [mm], together."""

USUAL = np.radians(80.0), np.radians(28.0)
"""Where nothing shows, the outer root lies so far round the trunk, or so far beyond the bust point [rad]."""

HOLLOW = 0.002
"""A root is hollower than this [1/mm]."""

INNER = Message("Deepest point of the contour at bust point height, between the bust point and the centre.")
NO_INNER = Message("Midway between the centre and the bust point: no concavity between the breasts.")
OUTER = Message("Deepest point of the contour at bust point height, lateral to the bust point (estimate).")
NO_OUTER = Message("Typical outer end of the breast root: no concavity between breast and side.")


def breast_root_landmarks(mesh: Mesh, found: Landmarks) -> list[Landmark]:
    """Return inner and outer end of both breast roots, those that the outlines show. Source: ours."""
    busts = [found.position(f"bust_point_{side}") for side in SIDES]
    marks = []
    for side, bust, other, sign in zip(SIDES, busts, busts[::-1], SIGNS, strict=True):
        marks += _side(mesh, bust, 0.5 * float(bust[0] + other[0]), side, sign)
    return marks


def _side(mesh: Mesh, bust: Points, middle: float, side: str, sign: float) -> list[Landmark]:
    levels = trunk_levels(mesh, bust[2] + HEIGHTS)
    own = levels[2]
    if min(len(level.segments) for level in levels) < 40:
        return []
    points = own.points
    centre = np.array([middle, 0.5 * float(points[:, 1].min() + points[:, 1].max())])
    azimuth = float(np.arctan2(sign * (bust[0] - middle), centre[1] - bust[1]))
    at = np.radians(np.arange(0.0, 130.0, 0.5) + 0.25)
    lines = [_line(level.points.reshape(-1, 2, 3), centre, sign, len(at)) for level in levels]
    skin = _line(own.segments, centre, sign, len(at))
    bend = np.mean([_hollow(line, at) for line in lines], axis=0)
    reached = np.linalg.norm(bust[:2] - centre)
    gap_in, gap_out = 10.0 / reached, 12.0 / reached
    inner = (at > 0.08 * azimuth) & (at < azimuth - gap_in)
    outer = (at > azimuth + gap_out) & (at < np.radians(118.0))
    half, usual = 0.5 * azimuth, max(USUAL[0], azimuth + USUAL[1])
    ends = (
        _end(bend, inner & np.isfinite(skin), int(np.argmin(np.abs(at - half)))),
        _end(bend, outer & np.isfinite(skin), int(np.argmin(np.abs(at - usual)))),
    )
    x, y = centre[0] + sign * skin * np.sin(at), centre[1] - skin * np.cos(at)
    line = np.stack([x, y, np.full(len(at), own.z)], axis=1)
    curve = line[ends[0][0] : ends[1][0] + 1]
    curve = curve[np.isfinite(curve[:, 0])]
    # Never sure, the outer end the less: our judgement, as no known answer tells where a root ends.
    return [
        Landmark(f"root_{name}_{side}", line[end], low + more * sure, rules[sure == 0.0], curve)
        for name, (end, sure), low, more, rules in (
            ("inner", ends[0], 0.25, 0.5, (INNER, NO_INNER)),
            ("outer", ends[1], 0.15, 0.3, (OUTER, NO_OUTER)),
        )
        if np.isfinite(skin[end])
    ]


def _line(segments: Points, centre: Points, sign: float, count: int) -> Floats:
    """Return how far an outline reaches, shape (count,) [mm], from the front towards one side."""
    far = radii(segments, np.zeros(len(segments), dtype=np.int64), centre[None], FINE)[0]
    half = far[FINE // 2 :] if sign > 0.0 else far[FINE // 2 - 1 :: -1]
    return np.asarray(half[:count])


def _hollow(far: Floats, at: Floats) -> Floats:
    """Return how hollow the outline is in each direction, shape (c,) [1/mm], smoothed by 7 mm."""
    known = np.isfinite(far)
    if known.sum() < 0.7 * len(far):
        return np.zeros(len(far))
    radius = np.interp(at, at[known], far[known])
    x, y = radius * np.sin(at), -radius * np.cos(at)
    s = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    even = np.linspace(0.0, s[-1], max(int(s[-1]), 20))
    x, y = (gaussian_filter1d(np.interp(even, s, a), 7.0, mode="nearest") for a in (x, y))
    return np.asarray(np.interp(s, even, curvature(y, x)))


def _end(bend: Floats, allowed: Flags, usual: int) -> tuple[int, float]:
    """Return where the outline is most hollow and how sure that is (0..1); ``usual`` and 0 if it is not."""
    value = np.where(allowed & np.isfinite(bend), bend, -np.inf)
    best = int(np.argmax(value))
    if not value[best] > HOLLOW:
        return usual, 0.0
    rest = np.where(np.abs(np.arange(len(bend)) - best) > 24, value, -np.inf)
    lead = value[best] - max(float(rest.max(initial=-np.inf)), 0.0)
    return best, float(min(value[best] / 0.02, 1.0) * np.clip(lead / 0.006, 0.2, 1.0))
