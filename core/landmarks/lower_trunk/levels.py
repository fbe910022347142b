"""Levels of the lower trunk read from its tapes and its profile: hip, waist and belly."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d

from core.geometry.mesh import Floats
from core.landmarks.lower_trunk.sections import STEP, LowerSections, crossings

SMOOTHING = 8.0
"""Tapes and profiles are smoothed over so much height [mm]; ours."""

HIP_UP_TO = 0.62
"""The largest tape of the hips lies below this part of the way from crotch to under-bust [1]; ours."""

WAIST_OVER_HIP = 60.0
"""The waist lies at least so far over the hip level [mm]; ours."""

WAIST_DEPTH = 6.0
"""A waist is sure where the tape grows by so much to both sides of it [mm]; ours."""

UNDER_BREASTS = 80.0
"""A least tape nearer than this to the under-bust level is the edge of the breasts [mm]; ours, by size."""

REFERENCE_HALF_WIDTH = 130.0
"""Half the width below the bust of a body of the reference size [mm]; ours."""

PUBIS = 35.0
"""So far over the crotch the front midline leaves the pubis [mm]; ours."""


@dataclass(frozen=True)
class Level:
    """A height [mm] with how sure it is [1], and whether it shows what it is called by."""

    z: float
    confidence: float
    found: bool = True


class Profile:
    """Tapes [mm] and the front midline of the trunk, level by level from the crotch to the under-bust.

    ``scale`` [1] is the size of the body against one of the reference size.
    """

    def __init__(self, sections: LowerSections, crotch: float) -> None:
        self.crotch, self.top, self.sections = crotch, sections.top, sections
        self.z = np.arange(crotch + 0.5 * STEP, sections.top, STEP)
        found = sections.many(self.z)
        self.tape = gaussian_filter1d(np.array([each.tape for each in found]), SMOOTHING / STEP)
        front = [each.trunk for each in found]
        fronts = [np.nan if each is None else _front(each, sections.middle) for each in front]
        self.front = _smooth(np.array(fronts))
        near = sections.at(sections.top - REACH_DOWN).trunk
        width = 2.0 * REFERENCE_HALF_WIDTH if near is None else float(np.ptp(near[:, 0]))
        self.scale = 0.5 * width / REFERENCE_HALF_WIDTH

    def hip(self) -> Level:
        """Return the level of the largest tape."""
        within = self.z < self.crotch + HIP_UP_TO * (self.top - self.crotch)
        at = int(np.argmax(np.where(within, self.tape, -np.inf)))
        inner = 0 < at < int(within.sum()) - 1
        return Level(_vertex(self.z, self.tape, at), 0.9 if inner else 0.45)

    def waist(self, hip: float) -> Level:
        """Return the natural waist: the least tape over the hips, where it is one."""
        within = self.z > hip + WAIST_OVER_HIP
        at = int(np.argmin(np.where(within, self.tape, np.inf)))
        z = _vertex(self.z, self.tape, at)
        below, above = self.tape[within & (self.z < z)], self.tape[self.z > z]
        depth = min(below.max(initial=0.0), above.max(initial=0.0)) - self.tape[at]
        lowest = self.top - UNDER_BREASTS * self.scale
        if depth > WAIST_DEPTH and z < lowest:
            return Level(z, 0.9)
        return Level(min(z, lowest), 0.3, found=False)

    def belly(self, waist: float) -> Level:
        """Return the hump of the front midline, else the place farthest before a chord along it."""
        z, front = self.z, self.front
        within = (z > self.crotch + PUBIS) & (z < waist)
        rows = np.flatnonzero(within)
        if len(rows) < 3:
            return Level(0.5 * (self.crotch + waist), 0.1, found=False)
        humps = rows[1:-1][(front[rows[1:-1]] > front[rows[:-2]]) & (front[rows[1:-1]] >= front[rows[2:]])]
        if len(humps):
            at = int(humps[np.argmax(front[humps])])
            return Level(_vertex(z, front, at), 0.9)
        chord = np.interp(z[rows], z[rows[[0, -1]]], front[rows[[0, -1]]])
        at = int(rows[np.argmax(front[rows] - chord)])
        return Level(float(z[at]), 0.45, found=False)


REACH_DOWN = 20.0
"""The width of a body is taken so far below the under-bust [mm]; ours."""


def _front(outline: Floats, middle: float) -> float:
    """Return how far an outline stands forward at the middle [mm]."""
    y = crossings(outline, middle)
    return -float(y[0]) if len(y) else np.nan


def _smooth(values: Floats) -> Floats:
    known = np.isfinite(values)
    if not known.any():
        return np.zeros_like(values)
    whole = np.interp(np.arange(len(values)), np.flatnonzero(known), values[known])
    return np.asarray(gaussian_filter1d(whole, SMOOTHING / STEP))


def _vertex(z: Floats, values: Floats, at: int) -> float:
    """Return where the parabola through the values round an extremum has its vertex."""
    if not 0 < at < len(z) - 1:
        return float(z[at])
    a, b, c = values[at - 1 : at + 2]
    bend = a - 2.0 * b + c
    return float(z[at] + (0.5 * (a - c) / bend if bend else 0.0) * (z[1] - z[0]))
