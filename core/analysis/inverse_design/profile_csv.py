"""A profile from a table: how far the skin is to stand out at which heights, as goals (ours)."""

from __future__ import annotations

import csv
import errno
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np

from core.analysis.inverse_design.quantities import Goal, profile_name, skin_of
from core.errors import UserError
from core.files.regular_file import read_text
from core.geometry.mesh import Floats
from core.messages import LengthRange, Message
from core.pipeline.build import Stages

_MOST = 60
"""Heights of a profile that are asked for; of more every so manieth is."""

_STEEP = 3.0  # a skin that comes out so much faster than it rises hangs over [1]
_STEP = 5.0  # of the heights at which an exported section is read [mm]
_HEIGHT, _OUT = ("height_mm", "height"), ("out_mm", "out")
_BYTES = 5_000_000


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
                "Use these headings for two columns: the height on the body and the target depth "
                "of the skin there."
            ),
        )
    found = np.array([[_number(path, row, column) for column in columns] for row in rows[1:]])
    return _in_order(path, found)


def profile_goals(stages: Stages, section: str, curve: Floats) -> tuple[Goal, ...]:
    """Return the goals of a ``curve`` (k, 2) [mm] of a section, where the control mesh can move at all.

    The ``section`` is "left" or "right" or its x [mm]. Raises UserError if the curve lies elsewhere.
    """
    heights = stages.control.mesh.vertices[~stages.control.fixed, 2]
    low, high = float(heights.min()), float(heights.max())
    inside = curve[(curve[:, 0] >= low) & (curve[:, 0] <= high)]
    inside = inside[inside[:, 0] > overhang_height(stages, section, inside)]
    if not len(inside):
        raise UserError(
            Message(
                "All heights of the profile are outside the reshaped region, {range}.",
                range=LengthRange(low, high),
            ),
            Message("Use the heights of the body in Busk, in millimetres."),
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
