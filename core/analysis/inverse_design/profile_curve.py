"""Drawn target profile: the outline of the skin moved by a few handles, and its table as CSV (ours)."""

from __future__ import annotations

import csv
import errno
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from core.analysis.inverse_design.profile_quantities import profile_name, section_at, skin_of
from core.analysis.inverse_design.quantity import Goal
from core.errors import UserError
from core.files.regular_file import read_text
from core.geometry.mesh import Floats, Indices, Points
from core.geometry.plane_sections import arc_length
from core.messages import LengthRange, Message
from core.pipeline.build import Stages

STEP = 5.0
"""Heights at which a drawn profile is asked for [mm]."""

FARTHEST = 60.0
"""How far a handle goes each way from where it was [mm]."""

_FINE = 2.5  # heights at which the outline is read [mm]
_ENOUGH = 8  # rows of a table on which handles are of use
_APART = 20.0  # about as far are handles from each other [mm]
_ALONG = 0.5  # of a step that the handles beside one take along with it [1]


_MOST = 60
"""Heights of a profile that are asked for; of more every so manieth is."""

_STEEP = 3.0  # a skin that comes out so much faster than it rises hangs over [1]

_STEP = 5.0  # of the heights at which an exported section is read [mm]

_HEIGHT, _OUT = ("height_mm", "height"), ("out_mm", "out")

_BYTES = 5_000_000


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
    heights = stages.control.mesh.vertices[~stages.control.held, 2]
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
    heights = stages.control.mesh.vertices[~stages.control.held, 2]
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


def read_profile(path: str) -> Floats:
    """Return heights and how far the skin is to stand out there, (k, 2) [mm], highest last, from a table.

    It has the columns height_mm and out_mm, or is a section that Busk exported: then it is its foremost
    outline, after reshaping if that is in it. Raises UserError.
    """
    try:
        text = read_text(Path(path), _BYTES, "utf-8-sig")
    except (OSError, UnicodeDecodeError) as why:
        if isinstance(why, OSError) and why.errno == errno.EFBIG:
            raise UserError(
                Message("{path} is too large for a profile.", path=path),
                Message("A few dozen rows are sufficient."),
            ) from why
        raise UserError(
            Message("{path} cannot be read as a table.", path=path), Message("Use a CSV file in UTF-8.")
        ) from why
    first = text.partition("\n")[0]
    sign = next((each for each in (";", "\t") if each in first), ",")
    try:
        table = list(csv.reader(text.splitlines(), delimiter=sign))
    except csv.Error as why:  # a cell without an end
        raise UserError(
            Message("{path} cannot be read as a table.", path=path), Message("Use a CSV file in UTF-8.")
        ) from why
    rows = [[cell.strip() for cell in row] for row in table if row]
    head = [cell.lower() for cell in rows[0]] if rows else []
    if {"y_mm", "z_mm"} <= set(head):
        return _outline(path, head, rows[1:])
    columns = [next((head.index(name) for name in names if name in head), -1) for names in (_HEIGHT, _OUT)]
    if min(columns) < 0:
        raise UserError(
            Message("{path} has no columns height_mm and out_mm.", path=path),
            Message(
                "Use these headings for two columns: the height on the body and the target forward "
                "position of the skin at that height."
            ),
        )
    found = np.array([[_number(path, row, column) for column in columns] for row in rows[1:]])
    return _in_order(path, found)


def profile_goals(stages: Stages, section: str, curve: Floats) -> tuple[Goal, ...]:
    """Return the goals of a ``curve`` (k, 2) [mm] of a section, where the control mesh can move at all.

    The ``section`` is "left" or "right" or its x [mm]. Raises UserError if the curve lies elsewhere.
    """
    heights = stages.control.mesh.vertices[~stages.control.held, 2]
    low, high = float(heights.min()), float(heights.max())
    inside = curve[(curve[:, 0] >= low) & (curve[:, 0] <= high)]
    inside = inside[inside[:, 0] > overhang_height(stages, section, inside)]
    if not len(inside):
        raise UserError(
            Message(
                "All heights of the profile are outside the reshaped region, {range}.",
                range=LengthRange(low, high),
            ),
            Message("Use heights on the body as shown in Busk, in millimetres."),
        )
    chosen = inside[:: -(-len(inside) // _MOST)]
    return tuple(Goal(profile_name(section, height), out) for height, out in chosen.tolist())


def overhang_height(stages: Stages, section: str, curve: Floats) -> float:
    """Return the height [mm] below which a breast hangs over, at rest or as wished; -inf if it does not.

    The ``curve`` (k, 2) [mm] is what is wished: heights, upwards, and how far out. From there down the
    foremost place jumps from the breast to the chest: no slope leads over that.
    """
    points, top = stages.control.mesh.vertices, stages.rest_marks
    below = curve[curve[:, 0] < min(top.bust_point_left_z, top.bust_point_right_z)]
    rest, _ = skin_of(stages, section, below[:, 0])(points)
    found = -np.inf
    for outs in (below[:, 1], rest):
        steep = np.abs(np.diff(outs)) > _STEEP * np.diff(below[:, 0])
        found = max(found, *below[1:, 0][steep], -np.inf)
    return found


def profile_maximum(curve: Floats, step: float) -> Floats:
    """Return how far a ``curve`` (k, 2) [mm] of heights and outs stands out at heights a ``step`` apart."""
    return _foremost(curve[:-1], curve[1:], step)


def _foremost(a: Floats, b: Floats, step: float) -> Floats:
    """Return the largest out, with its height, (r, 2) [mm], of pieces from ``a`` to ``b``, (k, 2)."""
    low, high = min(a[:, 0].min(), b[:, 0].min()), max(a[:, 0].max(), b[:, 0].max())
    found = []
    for height in np.arange(np.ceil(low / step) * step, high, step):
        crossing = (a[:, 0] <= height) != (b[:, 0] <= height)
        if crossing.any():
            start, way = a[crossing], (b - a)[crossing]
            found.append((height, (start[:, 1] + (height - start[:, 0]) / way[:, 0] * way[:, 1]).max()))
    return np.array(found).reshape(-1, 2)


def _outline(path: str, head: Sequence[str], rows: Sequence[Sequence[str]]) -> Floats:
    """Return the foremost outline of an exported section, every few millimetres."""
    bodies = [row[head.index("body")] for row in rows] if "body" in head else ["after"] * len(rows)
    wanted = "after" if "after" in bodies else bodies[0] if bodies else ""
    kept = [row for row, body in zip(rows, bodies, strict=True) if body == wanted]
    y, z = (np.array([_number(path, row, head.index(name)) for row in kept]) for name in ("y_mm", "z_mm"))
    curve = [row[head.index("curve")] if "curve" in head else "" for row in kept]
    joined = np.array([one == other for one, other in pairwise(curve)], dtype=bool)
    if not joined.any():
        raise UserError(Message("{path} contains no curve.", path=path), Message("Export the section again."))
    a, b = (np.stack([z[each], -y[each]], axis=1)[joined] for each in (slice(None, -1), slice(1, None)))
    return _in_order(path, _foremost(a, b, _STEP))


def _number(path: str, row: Sequence[str], column: int) -> float:
    text = row[column] if column < len(row) else ""
    try:
        value = float(text.replace(",", ".").replace("\N{MINUS SIGN}", "-"))
    except ValueError:
        value = np.nan
    if not np.isfinite(value) or abs(value) > 10_000.0:
        raise UserError(
            Message("'{text}' in {path} is not a length.", text=text, path=path),
            Message("Enter millimetres, one number per cell."),
        )
    return value


def _in_order(path: str, found: Floats) -> Floats:
    if not len(found):
        raise UserError(
            Message("{path} contains no heights.", path=path), Message("Enter one row for each height.")
        )
    found = found[np.argsort(found[:, 0])]
    if len(found) > 1 and np.diff(found[:, 0]).min() < 1e-6:
        raise UserError(
            Message("{path} contains a duplicate height.", path=path),
            Message("Enter one row for each height."),
        )
    return np.asarray(found)
