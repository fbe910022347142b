"""Polar map of a breast: clock position about the bust point and distance along the skin (ours).

Clock positions are counted from above outward on both sides of the body: 0 up, 90 outward, 180 down, 270
inward. Along the skin a place behind the breast, as the fold of an overhang,
has one distance, which its height does not.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from core.errors import PatternError
from core.geometry.closest_point import nearest_faces
from core.geometry.mesh import Floats, Mesh, Points, unit
from core.geometry.plane_sections import arc_length, interpolate
from core.landmarks.types import Landmarks
from core.messages import Message, SideName
from core.pattern.plane_walk import walk_planes

RAYS = 72
"""Ways from the bust point whose places are known; between two of them is interpolated."""

REACH = 240.0
"""How far the ways go along the skin [mm]."""

STEP = 2.0
"""Distance between the places of a way [mm]."""

_TURNS = 8  # of finding clock position and distance of a place; three are the rule

ABOVE = 1.08
"""The root above the bust point, where no landmark is, in parts of the mean of both sides."""


@dataclass(frozen=True, eq=False)
class BreastMap:
    """The ``rays`` (RAYS, k, 3) [mm] of a breast, every ``STEP`` from its bust point, and its root.

    ``root`` (RAYS,) [mm] is how far the root of the breast is on each. ``skin`` is that of the body.
    """

    skin: Mesh
    rays: Points
    root: Floats

    @property
    def apex(self) -> Points:
        """Return the bust point, (3,) [mm]."""
        return np.asarray(self.rays[0, 0])

    def root_distance(self, clock: Floats | float) -> Floats:
        """Return how far the root is at clock positions [degrees], (n,) [mm]."""
        every = np.arange(RAYS) * (360.0 / RAYS)
        return np.asarray(np.interp(clock, every, self.root, period=360.0))

    def clock(self, places: Points) -> Floats:
        """Return the clock positions of ``places`` (n, 3) [mm], (n,) [degrees]."""
        up = np.array([0.0, 0.0, 1.0])
        upward = self.rays[[0, RAYS // 2]].reshape(-1, 3) - self.apex  # in the plane of the axis and up
        outward = np.cross(unit(upward.sum(axis=0) * [1.0, 1.0, 0.0]), up)
        outward *= np.sign(outward @ (self.rays[RAYS // 4, RAYS // 4] - self.apex))
        off = places - self.apex
        clock = np.degrees(np.arctan2(off @ outward, off @ up)) % 360.0
        return np.where(clock < 360.0, clock, 0.0)  # a hair below 0 is rounded to 360

    def places(self, clock: Floats, distance: Floats) -> Points:
        """Return places of the skin at clock positions [degrees] and distances [mm], (n,), as (n, 3) [mm]."""
        turn = np.atleast_1d(clock) % 360.0 * (RAYS / 360.0)
        first = np.floor(turn).astype(np.int64) % RAYS
        share = (turn - np.floor(turn))[:, None]
        at = np.clip(np.atleast_1d(distance) / STEP, 0.0, self.rays.shape[1] - 1.001)
        low = np.floor(at).astype(np.int64)
        part = (at - low)[:, None]
        one, other = (
            (1.0 - part) * self.rays[ray, low] + part * self.rays[ray, low + 1]
            for ray in (first, (first + 1) % RAYS)
        )
        return nearest_faces(self.skin, (1.0 - share) * one + share * other, self.skin.centroid_tree)[1]

    def locate(self, place: Points) -> tuple[float, float]:
        """Return the clock position [degrees] and the distance [mm] of a ``place`` (3,) [mm] of the skin."""
        count = self.rays.shape[1]
        away = np.linalg.norm(self.rays - place, axis=2)
        away[:, 0] = np.where(np.arange(RAYS) == 0, away[:, 0], np.inf)
        ray, at = divmod(int(away.argmin()), count)
        found, step = np.array([float(ray), float(at)]), 1e-3
        for _ in range(_TURNS):
            here, beside, beyond = (self._between(*found, *off) for off in ((0, 0), (step, 0), (0, step)))
            slopes = np.stack([beside - here, beyond - here], axis=1) / step
            move = np.linalg.lstsq(slopes, place - here, rcond=None)[0]
            found += np.clip(move, -1.0, 1.0)
            found[1] = np.clip(found[1], 0.0, count - 1.0)
        return float(found[0] * 360.0 / RAYS % 360.0), float(found[1] * STEP)

    def _between(self, ray: float, at: float, off_ray: float, off_at: float) -> Points:
        """Return the place between rays, not laid on the skin, (3,) [mm]."""
        ray, at = ray + off_ray, np.clip(at + off_at, 0.0, self.rays.shape[1] - 1.001)
        first, low = math.floor(ray), math.floor(at)
        one, other = (self.rays[each % RAYS, low : low + 2] for each in (first, first + 1))
        both = (1.0 - ray + first) * one + (ray - first) * other
        return np.asarray((1.0 - at + low) * both[0] + (at - low) * both[1])


def breast_map(skin: Mesh, landmarks: Landmarks, side: str) -> BreastMap:
    """Return the map of one breast of a body. Raises PatternError where the skin round it is incomplete."""
    apex = landmarks.position(f"bust_point_{side}")
    marks = {name: landmarks.position(f"root_{name}_{side}") for name in ("outer", "inner")}
    outer, inner = marks["outer"], marks["inner"]
    marks["fold"] = landmarks.position(f"fold_{side}")
    apex = nearest_faces(skin, apex[None], skin.centroid_tree)[1][0]
    axis = (apex - 0.5 * (outer + inner)) * [1.0, 1.0, 0.0]
    up, axis = np.array([0.0, 0.0, 1.0]), unit(axis)
    outward = np.cross(axis, up)
    outward *= np.sign(outward @ (outer - inner))
    turn = np.radians(np.arange(RAYS) * 360.0 / RAYS)[:, None]
    ways = np.cos(turn) * up + np.sin(turn) * outward
    walked = walk_planes(skin, apex, ways, unit(np.cross(axis, ways)), REACH)
    if min(arc_length(each)[-1] for each in walked) < STEP:
        raise PatternError(
            Message("The skin around the {side} breast is incomplete.", side=SideName(side)),
            Message("Fill the holes at the Scan step."),
        )
    rays = np.stack([_evenly(each) for each in walked])
    root = _root(rays, apex, (up, outward), marks)
    return BreastMap(skin, rays, root)


def _evenly(walked: Points) -> Points:
    """Return the places of a way every ``STEP``; beyond its end it stays there."""
    at = np.arange(int(REACH / STEP) + 1, dtype=np.float64) * STEP
    return interpolate(at, arc_length(walked), walked)


def _root(rays: Points, apex: Points, plane: tuple[Points, Points], marks: dict[str, Points]) -> Floats:
    """Return how far the root is on each ray, (RAYS,) [mm], a smooth curve through the landmarks."""
    from scipy.interpolate import PchipInterpolator  # noqa: PLC0415 (a fifth of a second that no start needs)

    up, outward = plane
    clocks, far = [], {}
    for name, mark in marks.items():
        clock = float(np.degrees(np.arctan2((mark - apex) @ outward, (mark - apex) @ up)) % 360.0)
        ray = rays[round(clock * RAYS / 360.0) % RAYS]
        far[name] = STEP * float(np.linalg.norm(ray - mark, axis=1).argmin())
        clocks.append((clock, far[name]))
    clocks.append((0.0, ABOVE * 0.5 * (far["outer"] + far["inner"])))
    known = np.array(sorted(clocks))
    around = np.concatenate([known + np.array([turn, 0.0]) for turn in (-360.0, 0.0, 360.0)])
    every = np.arange(RAYS) * (360.0 / RAYS)
    return np.asarray(PchipInterpolator(around[:, 0], around[:, 1])(every))
