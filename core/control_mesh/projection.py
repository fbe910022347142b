"""Laying the rows and columns of a template on the front of a body, point by point on the skin."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np

from core.control_mesh.fitting_frame import FittingFrame
from core.control_mesh.fold_rows import Crease
from core.control_mesh.missing_points import interpolate_in_row, interpolate_missing
from core.control_mesh.radial_profiles import azimuth_direction, ray_exits
from core.geometry.mesh import Flags, Floats, Mesh, Points, unit
from core.landmarks.types import Landmarks

FORWARD = np.array([0.0, -1.0, 0.0])

BREAST = np.radians(72.0)
"""Up to this azimuth the breast may lie in front of the chest on a level ray [rad] ..."""

OVERHANG = 90.0
"""... by so much at most [mm, reference size]."""

BEHIND = 120.0
"""Rays to the upper breast start so far behind the place where the skin is expected [mm, reference size]."""

SPACE = 16.0
"""The line row keeps so far from the rows of fold and bust points, where there is that much room [mm]."""

PROBES = (8.0, -8.0, 16.0, -16.0, 24.0, -24.0, 32.0, -32.0, 40.0, -40.0)
"""Where the collar has no skin, it lies as the skin so much higher or lower does [mm]."""


def project_border(ground: FittingFrame, landmarks: Landmarks) -> tuple[Points, Flags]:
    """Project lower collar, bust row, upper edge and upper collar; holes are bridged.

    Returns all points, shape (rows, columns, 3) [mm], NaN in the other rows, and which had no skin.
    """
    template, axis = ground.template, ground.axis
    points = np.full((len(template.rows), len(ground.column), 3), np.nan)
    bust = template.row_of("bust point")
    points[bust] = _level_exits(ground, ground.bust, np.abs(ground.azimuth) <= BREAST)
    for side, sign in (("left", 1), ("right", -1)):
        mark = landmarks.position(f"bust_point_{side}")
        place = template.half + sign * template.bust_column
        at = _skin_nearest(ground.front, mark, azimuth_direction(ground.azimuth[place]), ground.torso.scale)
        points[bust, place] = mark if np.isnan(at).any() else at
    outer = axis[0] + np.array([[1.0], [0.97]]) * ground.across
    outline = [0, bust, -2, -1]
    first = _collar(ground, outer, 0.0)
    points[[0, -2, -1]] = first
    holes = np.isnan(points[..., 0])
    holes[[row for row in range(len(points)) if row not in (0, bust, len(points) - 2, len(points) - 1)]] = (
        False
    )
    points[outline] = interpolate_in_row(points[outline])
    for rise in PROBES:
        missing = np.isnan(points[[0, -2, -1], :, 0])
        if not missing.any():
            break
        found = _collar(ground, outer, rise * ground.torso.scale) - (0.0, 0.0, rise * ground.torso.scale)
        points[[0, -2, -1]] = np.where(missing[..., None], found, points[[0, -2, -1]])
    points[outline] = interpolate_missing(points[outline], float(axis[0]))
    return points, holes


def _collar(ground: FittingFrame, outer: Floats, rise: float) -> Points:
    """Lay the collar below, the upper edge and the collar above so much higher, shape (3, columns, 3) [mm].

    ``outer``, shape (2, columns) [mm], is x of the two upper ones.
    """
    none = np.zeros(len(ground.column), dtype=np.bool_)
    rows = [_level_exits(ground, ground.below + rise, none)]
    for x, height in zip(outer, (ground.edge, ground.above), strict=True):
        origins = np.column_stack([x, np.full_like(x, ground.axis[1]), height + rise])
        ways = ray_exits(ground.front, origins, np.broadcast_to(FORWARD, origins.shape))
        rows.append(origins + _firsts(ways)[:, None] * FORWARD)
    return np.array(rows)


def _level_exits(ground: FittingFrame, heights: Floats, outermost: Flags) -> Points:
    """Go out from the axis in each column at its height, shape (c,) [mm]; the places, shape (c, 3) [mm].

    The first exit keeps clear of the arms; in the columns ``outermost``, shape (c,), it is the one through
    the breast, if that hangs in front of the chest.
    """
    directions = np.array([azimuth_direction(azimuth) for azimuth in ground.azimuth])
    origins = ground.axis + heights[:, None] * (0.0, 0.0, 1.0)
    ways = ray_exits(ground.front, origins, directions)
    reach = _firsts(ways)
    limit = np.where(outermost, reach + OVERHANG * ground.torso.scale, reach)
    taken = [way[way <= most][-1] if len(way) else np.nan for way, most in zip(ways, limit, strict=True)]
    return np.asarray(origins + np.array(taken)[:, None] * directions)


def _firsts(ways: list[Floats]) -> Floats:
    return np.array([way[0] if len(way) else np.nan for way in ways])


def _skin_nearest(front: Mesh, expected: Points, direction: Points, scale: float) -> Points:
    """Return the place of the skin nearest to ``expected`` along ``direction``, both (3,) or (k, 3) [mm]."""
    expected, direction = np.atleast_2d(expected), np.atleast_2d(direction)
    origins = expected - BEHIND * scale * direction
    ways = ray_exits(front, origins, direction)
    reach = [way[np.argmin(np.abs(way - BEHIND * scale))] if len(way) else np.nan for way in ways]
    return np.squeeze(origins + np.array(reach)[:, None] * direction)


def project_interior(
    ground: FittingFrame, outline: Points, creases: Mapping[int, Crease], holed: Iterable[int]
) -> tuple[Points, Flags]:
    """Return ``outline`` with the rows of folds and upper breast too, shape (rows, columns, 3) [mm].

    The line row stays NaN. The columns ``holed`` take their fold from columns beside or opposite. Also
    returns which places had no skin.
    """
    points = outline.copy()
    fold, line, bust = (ground.template.row_of(rule) for rule in ("fold", "line", "bust point"))
    rise = (1.0 - _fold_shares(ground)) * (ground.bust - ground.below)
    points[fold] = _level_exits(ground, ground.bust - rise, np.abs(ground.azimuth) <= BREAST)
    for number, crease in creases.items():
        points[fold, number + ground.template.half] = crease.profile.at(crease.arc)
    for number in holed:
        if {number - 1, number + 1, -number} & set(creases):
            points[fold, number + ground.template.half] = np.nan
    radial = np.array([azimuth_direction(azimuth) for azimuth in ground.azimuth])
    for row, rule in enumerate(ground.template.rows):
        if rule.rule != "upper":
            continue
        expected = points[bust] + rule.value * (points[-2] - points[bust])
        direction = unit((1.0 - rule.value) * radial + rule.value * FORWARD)
        points[row] = _skin_nearest(ground.front, expected, direction, ground.torso.scale)
    others = np.arange(len(points)) != line
    holes = np.isnan(points[..., 0])
    points[others] = interpolate_missing(points[others], float(ground.axis[0]))
    return points, holes


def project_line(
    ground: FittingFrame, points: Points, creases: Mapping[int, Crease], line_height: float
) -> tuple[Points, Flags]:
    """Return the line row, shape (columns, 3) [mm], and which of its places had no skin.

    It runs at the part ``line_height`` [1] of the way along the skin from the fold to the bust row of
    ``points``, shape (rows, columns, 3) [mm]; where there is no fold, of the way up.
    """
    fold, bust = (ground.template.row_of(rule) for rule in ("fold", "bust point"))
    rise = (1.0 - _fold_shares(ground)) * (ground.bust - ground.below)
    heights = ground.bust - rise + _up_to_line(rise, line_height)
    row = _level_exits(ground, heights, np.abs(ground.azimuth) <= BREAST)
    for number, crease in creases.items():
        place = number + ground.template.half
        row[place] = crease.profile.at(crease.arc - float(_up_to_line(crease.arc, line_height)))
    holes = np.isnan(row[:, 0])
    row = interpolate_in_row(row[None])[0]
    between = points[fold] + line_height * (points[bust] - points[fold])
    return np.where(np.isnan(row), between, row), holes


def _up_to_line(way: Floats | float, line_height: float) -> Floats:
    """Return how far up the ``way`` from fold to bust row the line row lies, with space to both [mm]."""
    space = np.minimum(SPACE / way, 0.5)
    return np.asarray(way * np.clip(line_height, space, 1.0 - space))


def _fold_shares(ground: FittingFrame) -> Floats:
    """Return the height of the fold row without folds, from collar (0) to bust row (1), shape (c,) [1]."""
    rise = ground.bust - ground.below
    mean = 0.5 * (ground.torso.left.fold + ground.torso.right.fold)
    as_folds = 0.25 + 0.5 * np.clip((mean - ground.below) / rise, 0.5, 0.8)
    own = [ground.template.columns[abs(number)].without_fold for number in ground.column]
    return np.array([high if part is None else part for part, high in zip(own, as_folds, strict=True)])
