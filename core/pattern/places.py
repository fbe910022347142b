"""Places on a body told by its landmarks: what the seams of a block go through (the words are ours).

| word | place |
|---|---|
| ``apex`` | the bust point |
| ``root 285``, ``root 180*0.5``, ``root 10+12`` | on the root at that clock position, at a share of the way
to it, or so many mm beyond |
| ``ring band 0.5``, ``ring band 0.5+8`` | at that share of the half round at a level, so many mm above |
| ``front bust``, ``front bust+22``, ``back wing-5`` | front or back centre at a level |
| ``point buttock`` | a landmark of that side, or of the middle |
| ``r2c3``, ``below r6.5c9`` | on the control mesh by row and column, that of the bust or of the lower trunk |
| ``... > neckline`` | the nearest place of a seam that is drawn already |

A word may end with ``left`` or ``right`` for a side of its own.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from core.control_mesh.embedding import locate_on_grid
from core.control_mesh.fit import BUST, LOWER, ControlMesh
from core.errors import PatternError
from core.geometry.closest_point import nearest_faces
from core.geometry.mesh import Floats, Mesh, Points
from core.geometry.plane_sections import arc_length, interpolate
from core.landmarks.lower_trunk.types import LowerLandmarks
from core.landmarks.torso.cross_sections import Level, trunk_levels
from core.landmarks.types import SIDES, Landmarks
from core.messages import Length, Message
from core.pattern.breast_map import BreastMap, breast_map
from core.pipeline.build import Stages

_NUMBER = r"(\d+(?:\.\d+)?)"
_OFF = r"([+-]\d+(?:\.\d+)?)?"
ROOT_WORD = re.compile(rf"root {_NUMBER}(?:\*{_NUMBER})?{_OFF}")
RING_WORD = re.compile(rf"ring ([\w ]+?) {_NUMBER}{_OFF}")
CENTRE_WORD = re.compile(rf"(front|back) ([a-z][a-z ]*?){_OFF}")
CELL_WORD = re.compile(rf"(below )?r{_NUMBER}c{_NUMBER}")
MOST_SHARE, MOST_OFF = 5.0, 500.0
"""Places are no further beyond a breast, in distances of its root [1], and no further off [mm]."""

_EDGE = 20.0  # above the edge of a scan its levels are whole [mm]
_BEARING = np.radians(2.0)  # between places of a ring [rad]


@dataclass(frozen=True, eq=False)
class BodyPlaces:
    """The places of one body: its ``skin`` without noise, its landmarks, its control meshes by region.

    Nothing is worked out twice.
    """

    skin: Mesh
    landmarks: Landmarks
    meshes: Mapping[str, ControlMesh]
    lower: LowerLandmarks | None = None

    @classmethod
    def of(cls, stages: Stages) -> BodyPlaces:
        """Return the places of the body at rest of a design."""
        meshes = {region.fitted.region: region.fitted for region in stages.regions}
        lower = None if stages.lower is None else stages.lower.landmarks
        return cls(stages.body.smoothed, stages.landmarks, meshes, lower)

    @cached_property
    def breasts(self) -> Mapping[str, BreastMap]:
        """Return the polar map of each breast. Raises PatternError."""
        return {side: breast_map(self.skin, self.landmarks, side) for side in SIDES}

    @cached_property
    def _rings(self) -> dict[float, Level]:
        return {}

    def height(self, reference: str) -> float:
        """Return the height of one of ``REFERENCES`` [mm]. Raises PatternError where the scan has it not."""
        known = {
            "under": self.landmarks.underbust_level,
            "bust": self.landmarks.bust_level,
            "low": self._low,
        }
        if reference in known:
            return known[reference]
        if self.lower is None or reference not in self.lower.points:
            raise PatternError(
                Message("The scan does not show the level '{level}' of the block.", level=reference),
                Message("Choose a block for the bust, or a scan that extends to mid-thigh."),
            )
        return float(self.lower.points[reference].position[2])

    @cached_property
    def _low(self) -> float:
        """Return the height of the scan's edge, or where its trunk ends above the legs [mm]."""
        low = float(self.skin.vertices[:, 2].min())
        heights = np.arange(low + _EDGE, self.landmarks.underbust_level, _EDGE)
        ends = (z for z in heights if len(trunk_levels(self.skin, [z])[0].segments))
        return next(ends, low + _EDGE) - _EDGE

    def ring(self, z: float, side: str) -> Points:
        """Return the half round at a height from front to back centre on one side, (k, 3) [mm].

        Raises PatternError where there is no skin.
        """
        if z not in self._rings:
            self._rings[z] = trunk_levels(self.skin, [z])[0]
        level = self._rings[z]
        if len(level.segments) == 0:
            raise PatternError(
                Message("The scan has no surface at a level of the block."),
                Message("Choose another block, or a scan of more of the body."),
            )
        points = level.points[:, :2]
        axis = np.array([self.middle, 0.5 * (points[:, 1].min() + points[:, 1].max())])
        return _half_round(points - axis, axis, z, 1.0 if side == "left" else -1.0)

    @cached_property
    def middle(self) -> float:
        """Return the x of the front centre [mm]."""
        names = ("front_centre", "front_centre_underbust")
        found = [self.landmarks.points[name].position[0] for name in names if name in self.landmarks.points]
        busts = [self.landmarks.position(f"bust_point_{side}")[0] for side in SIDES]
        return float(np.mean(found or busts))

    def place(self, word: str, side: str, levels: Mapping[str, float], drawn: Mapping[str, Points]) -> Points:
        """Return the place that a word means on a side, (3,) [mm]. Raises PatternError for one that is none.

        ``levels`` are heights by name [mm], ``drawn`` the curves so far, by name with side.
        """
        text, own, onto = parts_of(word)
        side = own or side
        if not side and (text == "apex" or ROOT_WORD.fullmatch(text) or RING_WORD.fullmatch(text)):
            raise PatternError(
                Message("The place '{word}' requires a side of the body.", word=word),
                Message("Add left or right to it, or draw the seam or panel on each side."),
            )
        place = self._place(text, side, levels)
        if place is None:
            raise PatternError(
                Message("'{word}' is not a place of a seam.", word=word),
                Message(
                    "Correct the block: clock positions are from 0 to 360, shares of a level from 0 to 1, "
                    "those of a breast from 0 to {share}, and distances up to {distance}.",
                    share=f"{MOST_SHARE:g}",
                    distance=Length(MOST_OFF, 0),
                ),
            )
        return _nearest_on(place, onto, side, drawn) if onto else place

    def _place(self, text: str, side: str, levels: Mapping[str, float]) -> Points | None:
        if text == "apex":
            return self.breasts[side].apex
        if text.startswith("point "):
            name = text.removeprefix("point ")
            found = self._landmark(f"{name}_{side}")
            return self._landmark(name) if found is None else found
        if match := CELL_WORD.fullmatch(text):
            region = LOWER if match[1] else BUST
            return self._cell(region, float(match[2]), float(match[3]), -1.0 if side == "right" else 1.0)
        return self._measured(text, side, levels)

    def _measured(self, text: str, side: str, levels: Mapping[str, float]) -> Points | None:
        """Return a place on a root or at a level, None for a word that is neither."""
        if match := ROOT_WORD.fullmatch(text):
            clock, share, off = float(match[1]), float(match[2] or 1.0), float(match[3] or 0.0)
            if clock > 360.0 or share > MOST_SHARE or abs(off) > MOST_OFF:
                return None
            breast = self.breasts[side]
            far = float(breast.root_distance(clock)) * share + off
            return np.asarray(breast.places(np.array([clock]), np.array([far]))[0])
        if match := RING_WORD.fullmatch(text):
            share, off = float(match[2]), float(match[3] or 0.0)
            if share > 1.0 or abs(off) > MOST_OFF:
                return None
            return self.at_share(self.level_height(match[1], levels) + off, share, side)
        if match := CENTRE_WORD.fullmatch(text):
            z = self.level_height(match[2], levels) + float(match[3] or 0.0)
            return self.at_share(z, 0.0 if match[1] == "front" else 1.0, side or "left")
        return None

    def at_share(self, z: float, share: float, side: str) -> Points:
        """Return the place at a share of the half round at a height, 0 the front centre, (3,) [mm]."""
        ring = self.ring(z, side)
        along = arc_length(ring)
        return np.asarray(interpolate(np.array([share * along[-1]]), along, ring)[0])

    def level_height(self, name: str, levels: Mapping[str, float]) -> float:
        """Return the height of a level or of one of ``REFERENCES`` [mm]. Raises PatternError."""
        return levels[name] if name in levels else self.height(name)

    def _cell(self, region: str, row: float, column: float, sign: float) -> Points | None:
        """Return the place of a control mesh at a row and column, None for one beyond its rows."""
        control = self.meshes.get(region)
        if control is None:
            raise PatternError(
                Message("The block needs waist, hips and seat of the body."),
                Message("Choose a scan that extends to mid-thigh, or a block for the bust."),
            )
        if not control.grid.has((row, column)):
            return None
        corners, weights = locate_on_grid(control.grid, np.array([[row, sign * column]]))
        flat = np.einsum("kc,kcx->kx", weights, control.mesh.vertices[corners])
        return np.asarray(nearest_faces(self.skin, flat, self.skin.centroid_tree)[1][0])

    def _landmark(self, name: str) -> Points | None:
        every = {**self.landmarks.points, **(self.lower.points if self.lower is not None else {})}
        return every[name].position if name in every else None


def parts_of(word: str) -> tuple[str, str, str]:
    """Return the parts of a word: the place, the side of its own or "", and the seam that it ends on."""
    text, _, onto = (part.strip() for part in word.partition(">"))
    own = next((side for side in SIDES if text.endswith(f" {side}")), "")
    return text.removesuffix(f" {own}") if own else text, own, onto


def _half_round(points: Floats, axis: Floats, z: float, sign: float) -> Points:
    """Return the outermost of flat ``points`` (k, 2) about an axis on one side, from front to back centre."""
    bearing = np.arctan2(sign * points[:, 0], -points[:, 1])
    reach = np.linalg.norm(points, axis=1)
    count = round(np.pi / _BEARING)
    cell = np.clip(np.round(bearing / np.pi * count), -1, count + 1).astype(np.int64)
    inside = (cell >= 0) & (cell <= count)
    far = np.zeros(count + 1)
    np.maximum.at(far, cell[inside], reach[inside])
    seen = np.flatnonzero(far > 0.0)
    angle = np.arange(count + 1) / count * np.pi
    far = np.interp(angle, angle[seen], far[seen])
    x, y = axis[0] + sign * far * np.sin(angle), axis[1] - far * np.cos(angle)
    return np.stack([x, y, np.full(count + 1, z)], axis=1)


def _nearest_on(place: Points, name: str, side: str, drawn: Mapping[str, Points]) -> Points:
    known = next((drawn[each] for each in (f"{name} {side}", name) if each in drawn), None)
    if known is None:
        raise PatternError(
            Message("The seam '{seam}' is not drawn yet where another one ends on it.", seam=name),
            Message("Correct the order of the seams in the block."),
        )
    return np.asarray(known[int(np.linalg.norm(known - place, axis=1).argmin())])
