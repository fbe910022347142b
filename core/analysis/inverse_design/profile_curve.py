"""A profile that is drawn: the skin's outline as it stands, pulled by a few handles (ours)."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from core.analysis.inverse_design.profile_csv import overhang_height, profile_goals, profile_maximum
from core.analysis.inverse_design.quantities import Goal, section_at, skin_of
from core.geometry.mesh import Floats, Indices, Points
from core.geometry.plane_sections import arc_length
from core.pipeline.build import Stages

STEP = 5.0
"""Heights at which a drawn profile is asked for [mm]."""

FARTHEST = 60.0
"""How far a handle goes each way from where it was [mm]."""

_FINE = 2.5  # heights at which the outline is read [mm]
_ENOUGH = 8  # rows of a table on which handles are of use
_APART = 20.0  # about as far are handles from each other [mm]
_ALONG = 0.5  # of a step that the handles beside one take along with it [1]


@dataclass(frozen=True, eq=False)
class ProfileCurve:
    """The profile of a section, "left" or "right" or its x [mm], with ``handles`` (h,) on it.

    ``base`` (k, 2) [mm] are heights, upwards, and how far the skin stood out there; ``handles`` are places
    along it and ``steps`` (h, 2) [mm] how far each has gone up and out; those ``manual_handles`` were pulled
    themselves. Both ends stay where the control mesh is fixed; where a breast hangs over, the lower end is a
    handle. One that is ``given`` by a table is asked for as it is; else nothing is as long as no handle was
    pulled.
    """

    section: str
    base: Floats
    handles: Indices
    steps: Floats
    given: bool = False
    manual_handles: frozenset[int] = frozenset()

    @property
    def is_unchanged(self) -> bool:
        """Return whether nothing is asked for: it is the skin as it stood."""
        return not self.given and not self.steps.any()

    @property
    def curve(self) -> Floats:
        """The curve as it is pulled, heights and how far out, (k, 2) [mm]: smooth, nowhere beyond handles."""
        if not len(self.handles):
            return self.base
        along = arc_length(self.base)
        knots = np.unique(np.concatenate([[0, len(along) - 1], self.handles]))
        ways = np.zeros((len(knots), 2))
        ways[np.searchsorted(knots, self.handles)] = self.steps
        return np.asarray(self.base + _between(along[knots], ways, along))

    @property
    def handle_positions(self) -> Floats:
        """Return heights and depths of the handles, (h, 2) [mm]."""
        return self.base[self.handles] + self.steps

    def with_moved_handle(self, handle: int, up: float, out: float) -> ProfileCurve:
        """Return it with one handle pulled further [mm]; those beside it come along if no hand set them."""
        ways, by_hand = np.zeros_like(self.steps), self.manual_handles | {handle}
        ways[handle] = up, out
        for beside in {handle - 1, handle + 1} & (set(range(len(ways))) - by_hand):
            ways[beside] = _ALONG * ways[handle]
        return replace(self, steps=np.clip(self.steps + ways, -FARTHEST, FARTHEST), manual_handles=by_hand)

    def goals(self, stages: Stages) -> tuple[Goal, ...]:
        """Return what is asked for. Raises UserError if it lies nowhere where the body can be reshaped."""
        if not self.steps.any():
            return () if self.is_unchanged else profile_goals(stages, self.section, self.base)
        return profile_goals(stages, self.section, profile_maximum(self.curve, STEP))


def profile_at(stages: Stages, section: str, control_points: Points) -> ProfileCurve:
    """Return the profile of a section as it is at control points, (n, 3) [mm], with handles, none pulled."""
    heights = stages.control.mesh.vertices[~stages.control.fixed, 2]
    grid = np.arange(heights.min(), heights.max(), _FINE)
    base = np.stack([grid, skin_of(stages, section, grid)(control_points)[0]], axis=1)
    base = base[np.isfinite(base[:, 1])]
    hangs = overhang_height(stages, section, base)
    base = base[base[:, 0] > hangs]
    return ProfileCurve(
        section, base, handles := _handles(base, np.isfinite(hangs)), np.zeros((len(handles), 2))
    )


def profile_from_table(stages: Stages, section: str, curve: Floats) -> ProfileCurve:
    """Return the profile of a ``curve`` (k, 2) [mm] of heights and outs, with handles if it is long."""
    heights = stages.control.mesh.vertices[~stages.control.fixed, 2]
    inside = curve[(curve[:, 0] >= heights.min()) & (curve[:, 0] <= heights.max())]
    long = len(inside) >= _ENOUGH
    handles = _handles(inside, False) if long else np.zeros(0, dtype=np.int64)
    return ProfileCurve(section, inside if long else curve, handles, np.zeros((len(handles), 2)), given=True)


def profile_points(stages: Stages, profile: ProfileCurve, control_points: Points) -> Points:
    """Return the skin's outline at the heights of a profile, (k, 3) [mm], at control points (n, 3) [mm].

    It ends where a breast hangs over.
    """
    heights = profile.base[:, 0]
    outs, _ = skin_of(stages, profile.section, heights)(control_points)
    curve = np.stack([heights, outs], axis=1)[np.isfinite(outs)]
    return section_to_space(
        stages, profile.section, curve[curve[:, 0] > overhang_height(stages, profile.section, curve)]
    )


def section_to_space(stages: Stages, section: str, curve: Floats) -> Points:
    """Return heights and how far out, (k, 2) [mm], of a section as places, (k, 3) [mm]."""
    at = np.full(len(curve), section_at(stages, section))
    return np.stack([at, -curve[:, 1], curve[:, 0]], axis=1)


def _handles(base: Floats, hangs: bool) -> Indices:
    """Return where handles stand: at the foremost place, between it and the ends, and at one that hangs."""
    heights = base[:, 0]
    middle = heights[int(base[1:-1, 1].argmax()) + 1]
    above = max(round((heights[-1] - middle) / _APART), 2)  # pieces
    below = max(round((middle - heights[0]) / _APART), 2 - hangs)
    wanted = list(np.linspace(heights[0], middle, below + 1)[1:])
    wanted += list(np.linspace(middle, heights[-1], above + 1)[1:-1])
    if hangs:
        wanted.append(heights[0])
    return np.unique([int(np.abs(heights - height).argmin()) for height in wanted])


def _between(knots: Floats, ways: Floats, along: Floats) -> Floats:
    """Return ``ways`` (k, 2) of knots (k,) at places between them, (n, 2): smooth, level at both ends.

    Piecewise cubic after Fritsch and Butland (1984): a slope that is the harmonic mean of those beside its
    knot never leads beyond what the knots have.
    """
    wide = np.diff(knots)[:, None]
    beside = np.diff(ways, axis=0) / wide
    before, after = beside[:-1], beside[1:]
    same, level = before * after > 0.0, np.zeros((1, 2))
    inner = np.where(same, 2.0 * before * after / np.where(same, before + after, 1.0), 0.0)
    slopes = np.concatenate([level, inner, level])
    piece = np.clip(np.searchsorted(knots, along, side="right") - 1, 0, len(knots) - 2)
    part = (along - knots[piece])[:, None] / wide[piece]
    rest = 1.0 - part
    ends = rest**2 * (1.0 + 2.0 * part) * ways[piece] + part**2 * (1.0 + 2.0 * rest) * ways[piece + 1]
    return np.asarray(ends + part * rest * wide[piece] * (rest * slopes[piece] - part * slopes[piece + 1]))
