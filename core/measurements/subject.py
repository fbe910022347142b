"""Measured body: skin with landmarks, trunk levels and both breasts, original or reshaped."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from types import MappingProxyType

import numpy as np

from core.geometry.mesh import Indices, Mesh, Points
from core.landmarks.bust_point import ACROSS
from core.landmarks.lower_breast import HIDDEN, UNSEEN
from core.landmarks.torso.cross_sections import Level, trunk_levels
from core.landmarks.torso.girths import trunk_sections
from core.landmarks.torso.torso_axis import share_axis
from core.landmarks.types import CERTAIN, SIDES, Landmark, Landmarks
from core.measurements.breast_root import Root, chart_of, root_of, side_of
from core.measurements.breast_volume import Breast, breast_of
from core.measurements.tracked_points import TrackedPoints, moved_landmarks, track_points

UNSURE_TOP = 15.0
"""The top of a root may lie so much lower or higher than it is taken [mm]."""


@dataclass(frozen=True, eq=False)
class Subject:
    """What measures are taken from. A side whose root does not show has no entry in what is kept by side.

    ``spreads`` [mm^3] are how much the volumes of the breasts change with the top of the root, ``gains``
    [mm^3] what the skin of the two sides has gained since rest. ``down`` [mm] is how far under the breasts
    the under-bust is measured, where that is not to be found.
    """

    mesh: Mesh
    landmarks: Landmarks
    roots: Mapping[str, Root]
    breasts: Mapping[str, Breast]
    spreads: Mapping[str, float]
    gains: tuple[float, float] = (0.0, 0.0)
    down: float | None = None

    @cached_property
    def levels(self) -> Mapping[str, Level]:
        """Return the levels of the trunk at which girths are measured, by name."""
        return MappingProxyType(trunk_sections(self.mesh, self.landmarks, self.down))

    def fold_seen(self, side: str) -> bool:
        """Return whether the fold on a side was detected or placed, not only estimated."""
        fold = self.mark(f"fold_{side}")
        return fold is not None and fold.rule not in (*HIDDEN, UNSEEN)

    def fold_sure(self, side: str) -> bool:
        """Return whether the fold on a side needs no review."""
        fold = self.mark(f"fold_{side}")
        return fold is not None and fold.confidence >= CERTAIN

    def mark(self, name: str) -> Landmark | None:
        """Return a landmark, or None if the scan does not show it."""
        return self.landmarks.points.get(name)

    def volume(self, side: str) -> float:
        """Return the volume of the breast of a side [mm^3]; what it gained since rest is with it."""
        gain = self.gains[SIDES.index(side)]
        return self.breasts[side].volume + gain

    def moved(self, vertices: Points, gains: tuple[float, float]) -> Subject:
        """Return the subject reshaped, its vertices at ``vertices``, shape (n, 3) [mm].

        Landmarks and roots ride on the skin, which has gained ``gains`` [mm^3] left and right: what is pushed
        over the root is still of the breast, so both belong to it.
        """
        places = self._riders.moved(vertices - self.mesh.vertices)
        marks, *loops = np.split(places, self._parts)
        roots = {
            side: replace(root, loop=loop)
            for (side, root), loop in zip(self.roots.items(), loops, strict=True)
        }
        after, mesh = moved_landmarks(self.landmarks, marks), self.mesh.moved(vertices)
        share_axis(mesh, self.mesh)
        return replace(self, mesh=mesh, landmarks=after, roots=roots, gains=gains)

    @cached_property
    def _riders(self) -> TrackedPoints:
        """Return all that rides on the skin: the landmarks, then the roots."""
        marks = [mark.position for mark in self.landmarks.points.values()]
        return track_points(self.mesh, np.concatenate([marks, *(root.loop for root in self.roots.values())]))

    @property
    def _parts(self) -> Indices:
        """Return where each root begins among the riders."""
        counts = [len(self.landmarks.points), *(len(root.loop) for root in self.roots.values())]
        return np.cumsum(counts)[:-1]


def shows_breast(landmarks: Landmarks, side: str) -> bool:
    """Return whether a breast protrudes on a side: else its bust point is mirrored."""
    bust = landmarks.points.get(f"bust_point_{side}")
    return bust is not None and bust.rule != ACROSS


def subject_of(mesh: Mesh, landmarks: Landmarks) -> Subject:
    """Return a skin [mm] and its landmarks ready to be measured."""
    roots: dict[str, Root] = {}
    breasts: dict[str, Breast] = {}
    spreads: dict[str, float] = {}
    points = trunk_levels(mesh, [landmarks.bust_level])[0].points
    if len(points):
        depth = float(points[:, 1].min()), float(points[:, 1].max())
        for name in SIDES:
            if not shows_breast(landmarks, name):
                continue
            side = side_of(mesh, landmarks, name, chart_of(landmarks, name, depth))
            root = root_of(side) if side else None
            if side is None or root is None:
                continue
            roots[name] = root
            breast = breast_of(side, root)
            lower = root_of(side, -UNSURE_TOP)
            less = breast_of(side, lower) if lower else None
            if breast and less:
                breasts[name] = breast
                spreads[name] = abs(breast.volume - less.volume)
    return Subject(mesh, landmarks, roots, breasts, spreads)
