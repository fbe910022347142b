"""Laying the rows and columns of a template on the front of a body, point by point on the skin."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from core.errors import FitError
from core.landmark import Landmarks
from core.mesh import Flags, Floats, Indices, Mesh, Points, unit
from core.profiles import Profile, exits, find_fold, heading, profile
from core.template import Template
from core.torso import Torso, cropped, measure_torso

FORWARD = np.array([0.0, -1.0, 0.0])

BREAST = np.radians(72.0)
"""Up to this azimuth the breast may lie in front of the chest on a level ray [rad] ..."""

OVERHANG = 90.0
"""... by so much at most [mm, reference size]."""

BEHIND = 120.0
"""Rays to the upper breast start so far behind the place where the skin is expected [mm, reference size]."""

CLEAR = 15.0
"""Beside the bust points their row stays so far above the folds, however low they hang [mm, ref. size]."""

SHALLOW = 2.0
"""A hollow less deep than this is no fold [mm]."""

SPACE = 16.0
"""The line row keeps so far from the rows of fold and bust points, where there is that much room [mm]."""

ALIKE = 3.0
"""The body counts as symmetric where landmarks of both sides mirror each other as well as this [mm]."""


@dataclass(frozen=True, eq=False)
class Ground:
    """The front of a body under a template.

    For each column from right to left, shape (c,): ``column`` number, ``azimuth`` [rad], height of the
    collar below and of the bust row, ``below`` and ``bust`` [mm]. ``edge`` and ``above`` [mm] are the heights
    of the upper edge and the collar above it.
    """

    template: Template
    torso: Torso
    front: Mesh
    column: Indices
    azimuth: Floats
    below: Floats
    bust: Floats
    edge: float
    above: float

    @property
    def axis(self) -> Points:
        """A point on the axis of the torso, shape (3,) [mm]."""
        return self.torso.axis


def survey_ground(template: Template, mesh: Mesh, landmarks: Landmarks) -> Ground:
    """Find where the rows and columns of ``template`` run on a body. Raises FitError without a torso."""
    torso = measure_torso(mesh, landmarks)
    value = {row.rule: row.value * torso.scale for row in template.rows}
    column = np.arange(-template.half, template.half + 1)
    azimuth = np.array([_azimuth(template, torso, number) for number in column.tolist()])
    below = torso.height("lowest", azimuth) - value["below"]
    edge, above = _upper_levels(torso, mesh, value["edge"], value["above"])
    y, z = mesh.vertices[:, 1], mesh.vertices[:, 2]
    margin = 60.0 * torso.scale
    near = (y < torso.axis[1] + margin) & (z > below.min() - margin) & (z < above + margin)
    front = cropped(mesh, near)
    bust = torso.height("bust", azimuth)
    beside = np.abs(column) != template.bust_column
    least = torso.height("fold", azimuth) + CLEAR * torso.scale
    bust = np.where(beside, np.maximum(bust, least), bust)
    return Ground(template, torso, front, column, azimuth, below, bust, edge, above)


def _azimuth(template: Template, torso: Torso, number: int) -> float:
    column = template.columns[abs(number)]
    side, sign = (torso.left, 1.0) if number >= 0 else (torso.right, -1.0)
    return float(
        sign * (column.bust_point * side.azimuth + column.outer_root * side.root + np.radians(column.degrees))
    )


def _upper_levels(torso: Torso, mesh: Mesh, rise: float, collar: float) -> tuple[float, float]:
    """Return the heights of the upper edge and of the collar above, as high as the scan allows [mm]."""
    scale = torso.scale
    edge = 0.5 * (torso.left.fold + torso.right.fold) + rise
    edge = max(edge, torso.armpit + 25.0 * scale)
    above = min(edge + collar, float(mesh.vertices[mesh.faces, 2].max()) - 10.0 * scale)
    edge = min(edge, above - 25.0 * scale)
    if edge < max(torso.left.bust, torso.right.bust) + 45.0 * scale:
        raise FitError(
            "The scan ends too close above the bust points.",
            "Open a scan that reaches to the collarbones, or correct the bust points.",
        )
    return edge, above


def bridged(points: Points) -> tuple[Points, int]:
    """Fill places without skin from their neighbours in the row, points of shape (rows, columns, 3) [mm].

    Returns the points and how many were filled. NaN stays where one of the two outermost columns, or more
    than two columns side by side, are missing.
    """
    filled = points.copy()
    for row in filled:
        missing = np.isnan(row[:, 0])
        known = np.flatnonzero(~missing)
        if len(known) < 2:
            continue
        for place in np.flatnonzero(missing):
            after = int(np.searchsorted(known, place))
            if 0 < after < len(known) and known[after] - known[after - 1] <= 3:
                low, high = known[after - 1], known[after]
                row[place] = row[low] + (row[high] - row[low]) * (place - low) / (high - low)
    return filled, int((np.isnan(points) & ~np.isnan(filled))[..., 0].sum())


def lay_outline(ground: Ground, landmarks: Landmarks) -> Points:
    """Lay the collar below, the bust row, the upper edge and the collar above.

    Returns all points, shape (rows, columns, 3) [mm]; NaN for the other rows and where there is no skin.
    """
    template, axis = ground.template, ground.axis
    points = np.full((len(template.rows), len(ground.column), 3), np.nan)
    points[0] = _level_exits(ground, ground.below, np.zeros(len(ground.column), dtype=np.bool_))
    bust = template.row_of("bust point")
    points[bust] = _level_exits(ground, ground.bust, np.abs(ground.azimuth) <= BREAST)
    for side, sign in (("left", 1), ("right", -1)):
        mark = landmarks.position(f"bust_point_{side}")
        place = template.half + sign * template.bust_column
        points[bust, place] = _skin_nearest(
            ground.front, mark, heading(ground.azimuth[place]), ground.torso.scale
        )
    across = np.array([template.columns[abs(number)].upper_edge for number in ground.column])
    across = np.sign(ground.column) * across * 0.88 * ground.torso.armpit_width
    for row, height, narrower in ((-2, ground.edge, 1.0), (-1, ground.above, 0.97)):
        x = axis[0] + narrower * across
        origins = np.column_stack([x, np.full_like(x, axis[1]), np.full_like(x, height)])
        ways = exits(ground.front, origins, np.broadcast_to(FORWARD, origins.shape))
        points[row] = origins + _firsts(ways)[:, None] * FORWARD
    return points


def _level_exits(ground: Ground, heights: Floats, outermost: Flags) -> Points:
    """Go out from the axis in each column at its height, shape (c,) [mm]; the places, shape (c, 3) [mm].

    The first exit keeps clear of the arms; in the columns ``outermost``, shape (c,), it is the one through
    the breast, if that hangs in front of the chest.
    """
    directions = np.array([heading(azimuth) for azimuth in ground.azimuth])
    origins = ground.axis + heights[:, None] * (0.0, 0.0, 1.0)
    ways = exits(ground.front, origins, directions)
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
    ways = exits(front, origins, direction)
    reach = [way[np.argmin(np.abs(way - BEHIND * scale))] if len(way) else np.nan for way in ways]
    return np.squeeze(origins + np.array(reach)[:, None] * direction)


@dataclass(frozen=True, eq=False)
class Crease:
    """The fold in one column: ``arc`` [mm] down ``profile`` from the bust row, ``depth`` [mm] deep."""

    profile: Profile
    arc: float
    depth: float


def find_creases(
    ground: Ground, outline: Points, landmarks: Landmarks
) -> tuple[dict[int, Crease], list[int]]:
    """Return the folds by column number, found on the profiles of the body, and the columns that lack one.

    A column lacks its fold if a hole ends its profile, or if the bust point has none below it; in the others
    the breast may pass into the trunk without a fold. On a symmetric body the folds of mirrored columns are
    made alike. Source: ours.
    """
    start = outline[ground.template.row_of("bust point")]
    creases: dict[int, Crease] = {}
    lacking = []
    for place, number in enumerate(ground.column.tolist()):
        column = ground.template.columns[abs(number)]
        if column.fold == "none" or np.isnan(start[place]).any():
            continue
        bottom = ground.below[place] - 2.0 * ground.torso.scale
        down = profile(ground.front, ground.axis, start[place], bottom)
        crease = None if down is None else _crease(ground, place, down)
        if crease is not None:
            creases[number] = crease
        elif down is None or abs(number) == ground.template.bust_column:
            lacking.append(number)
    if _symmetric(ground.axis, landmarks):
        pairs = [number for number in creases if -number in creases]
        mean = {number: 0.5 * (creases[number].arc + creases[-number].arc) for number in pairs}
        creases |= {number: replace(creases[number], arc=arc) for number, arc in mean.items()}
    return creases, lacking


def _crease(ground: Ground, place: int, down: Profile) -> Crease | None:
    """Return the fold on the profile of a column, None if no hollow lies where a fold may be."""
    column = ground.template.columns[abs(ground.column[place])]
    fold = find_fold(down, column.fold == "crease")
    torso, azimuth, bust = ground.torso, ground.azimuth[[place]], ground.bust[place]
    usual, lowest = torso.height("fold", azimuth)[0], torso.height("lowest", azimuth)[0]
    highest = usual + 0.35 * max(bust - usual, 0.0)
    if fold is None or fold.depth < SHALLOW or fold.z < min(usual, lowest) - 25.0 * torso.scale - 5.0:
        return None
    if fold.z > highest + 6.0 * torso.scale:
        return None
    arc = fold.arc if fold.z <= highest else down.next_below(fold.arc, highest)
    return Crease(down, max(arc, column.room * (bust - ground.below[place])), fold.depth)


def _symmetric(axis: Points, landmarks: Landmarks) -> bool:
    """Tell whether the bust points and folds of both sides mirror each other about the axis."""
    for what in ("bust_point", "fold"):
        left = landmarks.position(f"{what}_left") - axis
        right = (landmarks.position(f"{what}_right") - axis) * (-1.0, 1.0, 1.0)
        if np.linalg.norm(left - right) > ALIKE:
            return False
    return True


def lay_rest(ground: Ground, outline: Points, creases: Mapping[int, Crease], line_height: float) -> Points:
    """Return ``outline`` with the rows between laid too, shape (rows, columns, 3) [mm].

    The line row runs at the part ``line_height`` [1] of the way along the skin from the fold to the bust row;
    where there is no fold, of the way up.
    """
    points = outline.copy()
    fold, line, bust = (ground.template.row_of(rule) for rule in ("fold", "line", "bust point"))
    breast = np.abs(ground.azimuth) <= BREAST
    rise = (1.0 - _fold_shares(ground)) * (ground.bust - ground.below)
    points[fold] = _level_exits(ground, ground.bust - rise, breast)
    points[line] = _level_exits(ground, ground.bust - rise + _up_to_line(rise, line_height), breast)
    for number, crease in creases.items():
        place = number + ground.template.half
        points[fold, place] = crease.profile.at(crease.arc)
        points[line, place] = crease.profile.at(crease.arc - float(_up_to_line(crease.arc, line_height)))
    radial = np.array([heading(azimuth) for azimuth in ground.azimuth])
    for row, rule in enumerate(ground.template.rows):
        if rule.rule != "upper":
            continue
        expected = points[bust] + rule.value * (points[-2] - points[bust])
        direction = unit((1.0 - rule.value) * radial + rule.value * FORWARD)
        points[row] = _skin_nearest(ground.front, expected, direction, ground.torso.scale)
    return points


def _up_to_line(way: Floats | float, line_height: float) -> Floats:
    """Return how far up the ``way`` from fold to bust row the line row lies, with space to both [mm]."""
    space = np.minimum(SPACE / way, 0.5)
    return np.asarray(way * np.clip(line_height, space, 1.0 - space))


def _fold_shares(ground: Ground) -> Floats:
    """Return the height of the fold row without folds, from collar (0) to bust row (1), shape (c,) [1]."""
    rise = ground.bust - ground.below
    mean = 0.5 * (ground.torso.left.fold + ground.torso.right.fold)
    as_folds = 0.25 + 0.5 * np.clip((mean - ground.below) / rise, 0.5, 0.8)
    own = [ground.template.columns[abs(number)].without_fold for number in ground.column]
    return np.array([high if part is None else part for part, high in zip(own, as_folds, strict=True)])
