"""The ground that a template is laid on: where its columns and rows run round this body."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.control_mesh.skin_projection import SurfaceProjector
from core.control_mesh.template import Template
from core.control_mesh.torso_frame import Torso, cropped, measure_torso
from core.errors import FitError
from core.geometry.mesh import Floats, Indices, Mesh, Points
from core.landmarks.types import Landmarks
from core.messages import Length, Message

CLEAR = 15.0
"""Beside the bust points their row stays so far above the folds, however low they hang [mm, ref. size]."""


ENOUGH = 12.0
"""So high a row should be where the scan ends soon, and so far the collar lies under the folds [mm] ..."""

LEAST = 8.0
"""... and so high each row above the bust points must be [mm]."""


@dataclass(frozen=True, eq=False)
class FittingFrame:
    """The front of a body under a template.

    For each column from right to left, shape (c,): ``column`` number, ``azimuth`` [rad], heights of the
    collar below, of the bust row, of the upper edge and of the collar above it, ``below``, ``bust``, ``edge``
    and ``above`` [mm], and ``across`` [mm], where it ends across the upper edge, from the axis.
    """

    template: Template
    torso: Torso
    skin: SurfaceProjector
    column: Indices
    azimuth: Floats
    below: Floats
    bust: Floats
    edge: Floats
    above: Floats
    across: Floats

    @property
    def axis(self) -> Points:
        """Return a point on the axis of the torso, shape (3,) [mm]."""
        return self.torso.axis

    @property
    def front(self) -> Mesh:
        """Return the front of the body."""
        return self.skin.mesh


def fit_frame(template: Template, mesh: Mesh, landmarks: Landmarks) -> FittingFrame:
    """Find where the rows and columns of ``template`` run on a body. Raises FitError without a torso.

    Where the scan ends before the collar would lie, the collar keeps to what there is. Source: ours.
    """
    torso = measure_torso(mesh, landmarks)
    value = {row.rule: row.value * torso.scale for row in template.rows}
    column = np.arange(-template.half, template.half + 1)
    azimuth = np.array([_azimuth(template, torso, number) for number in column.tolist()])
    across = np.array([template.columns[abs(number)].upper_edge for number in column])
    across = np.sign(column) * across * 0.88 * torso.armpit_width
    edge = max(0.5 * (torso.left.fold + torso.right.fold) + value["edge"], torso.armpit + 25.0 * torso.scale)
    below = torso.height("lowest", azimuth) - value["below"]
    margin = 60.0 * torso.scale
    y, z = mesh.vertices[:, 1], mesh.vertices[:, 2]
    near = (y < torso.axis[1] + margin) & (z > below.min() - margin) & (z < edge + value["above"] + margin)
    front = cropped(mesh, near)
    bust = torso.height("bust", azimuth)
    beside = np.abs(column) != template.bust_column
    least = torso.height("fold", azimuth) + CLEAR * torso.scale
    bust = np.where(beside, np.maximum(bust, least), bust)
    below = np.minimum(
        np.maximum(below, _lowest_skin(front, torso, azimuth)),
        np.minimum(torso.height("lowest", azimuth), bust) - ENOUGH,
    )
    rows = sum(row.rule == "upper" for row in template.rows) + 2
    edges = _upper_levels(torso, front, across, edge, value["above"], bust, rows)
    return FittingFrame(
        template, torso, SurfaceProjector(front), column, azimuth, below, bust, *edges, across
    )


def _azimuth(template: Template, torso: Torso, number: int) -> float:
    column = template.columns[abs(number)]
    side, sign = (torso.left, 1.0) if number >= 0 else (torso.right, -1.0)
    return float(
        sign * (column.bust_point * side.azimuth + column.outer_root * side.root + np.radians(column.degrees))
    )


def _lowest_skin(front: Mesh, torso: Torso, azimuth: Floats) -> Floats:
    """Return how far down the scan reaches in each column, and a little less, shape (c,) [mm]."""
    place = front.vertices - torso.axis
    bearing = np.arctan2(place[:, 0], -place[:, 1])
    lowest = np.array(
        [place[np.abs(bearing - at) < np.radians(6.0), 2].min(initial=np.inf) for at in azimuth]
    )
    lowest[np.isinf(lowest)] = -np.inf
    return _with_neighbours(lowest, np.maximum) + 5.0


def _upper_levels(
    torso: Torso, front: Mesh, across: Floats, edge: float, collar: float, bust: Floats, rows: int
) -> tuple[Floats, Floats]:
    """Return the heights of the upper edge and of the collar above, as high as the scan allows, (c,) [mm]."""
    scale = torso.scale
    above = np.full(len(across), edge + collar)
    x, y, z = (front.vertices - torso.axis).T
    chest = (y < 0.0) & (z > bust.min())
    top = np.array([z[chest & (np.abs(x - at) < 12.0)].max(initial=-np.inf) for at in across])
    top[np.isinf(top)] = np.inf  # a hole, not the end of the scan
    short = top - 10.0 * scale < bust + rows * ENOUGH
    lowered = np.where(top < above + 3.0, top - np.where(short, 4.0, 10.0 * scale), above)
    above = np.minimum(above, _with_neighbours(lowered, np.minimum))
    rise = above - bust
    if np.median(rise) < rows * LEAST:
        raise FitError(
            Message(
                "The scan ends {rise} above the bust points, within the upper breast.",
                rise=Length(np.median(rise)),
            ),
            Message(
                "Open a scan that extends at least {need} above the bust points, or correct the bust points.",
                need=Length(rows * LEAST + 5.0),
            ),
        )
    above = bust + np.maximum(rise, rows * LEAST)
    edges = np.minimum(edge, above - 25.0 * scale)
    return np.maximum(edges, bust + np.minimum(45.0 * scale, (1.0 - 1.0 / rows) * (above - bust))), above


def _with_neighbours(values: Floats, choose: np.ufunc) -> Floats:
    """Return the chosen one of each value and its two neighbours, shape (c,)."""
    padded = np.concatenate([values[:1], values, values[-1:]])
    return np.asarray(choose(choose(padded[:-2], padded[2:]), values))
