"""From a curve drawn on the skin to a free line, which keeps its course beside the control points (ours)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.control_mesh.embedding import Cell, embed
from core.control_mesh.fit import ControlMesh
from core.control_mesh.path_snapping import STEP, max_deviation
from core.control_mesh.skin_projection import locate_on_mesh, points_on_skin
from core.document.line_notation import DECIMALS
from core.errors import LineError
from core.geometry.mesh import Floats, Mesh, Points
from core.geometry.plane_sections import resample
from core.messages import Message

_STEPS = (6.0, 3.0, 1.5)
"""How far apart the vertices of a free line are [mm]: the first that keeps the curve."""

HANGS = 0.05
"""A vertex hangs on control points that can move if their weights are more than this together [1]."""

_KEPT = 0.5  # a line this near to the curve that was drawn keeps it [mm]


@dataclass(frozen=True, eq=False)
class FreeCurve:
    """A free line through ``places``, a closed one without its end, and how far the curve is off it [mm].

    ``shown`` (k, 3) [mm] is its course on the skin. ``is_movable`` is False where none of it can move: then
    it can only be measured. ``cut`` tells that some of the curve left the control mesh and was left out.
    """

    places: tuple[Cell, ...]
    closed: bool
    shown: Points
    deviation: float
    is_movable: bool
    cut: bool


def free_curve(skin: Mesh, control: ControlMesh, pieces: Sequence[Points], closed: bool = False) -> FreeCurve:
    """Return the free line that follows a curve on the ``skin``, in ``pieces`` (k, 3) [mm] from bend to bend.

    A ``closed`` curve ends where it begins. Raises LineError if it has no length or is not on the control
    mesh.
    """
    if sum(float(np.linalg.norm(np.diff(piece, axis=0), axis=1).sum()) for piece in pieces) < STEP:
        raise LineError(
            Message("The line has no length."),
            Message("Draw the line between two different points of the body."),
        )
    for step in _STEPS:
        found = _curve(skin, control, pieces, closed, step)
        if found.deviation < _KEPT:
            break
    return found


def _curve(
    skin: Mesh, control: ControlMesh, pieces: Sequence[Points], closed: bool, step: float
) -> FreeCurve:
    curve = np.concatenate([pieces[0][:1], *(resample(piece, step)[1:] for piece in pieces)])
    on_mesh = locate_on_mesh(control.mesh, control.grid, curve)
    kept = np.flatnonzero(on_mesh.inside)
    if len(kept) < 2 or (closed and len(kept) < len(curve)):
        raise LineError(
            Message("The line leaves the control mesh."),
            Message("Draw the line in the reshaped region. Below the bust, add waist, hips and seat first."),
        )
    inner = slice(int(kept[0]), int(kept[-1]) + 1)
    cells = _distinct(on_mesh.cells[inner])
    if closed:
        cells = cells[:-1]
    if len(cells) < (3 if closed else 2):
        raise LineError(
            Message("The line has no length."),
            Message("Draw the line between two different points of the body."),
        )
    places: tuple[Cell, ...] = tuple((float(row), float(column)) for row, column in cells)
    embedded = embed(control.grid, places + places[:1] * closed)
    shown = points_on_skin(skin, control.mesh, embedded.weights)
    free = np.flatnonzero(~control.fixed)
    pulls = bool(abs(embedded.weights[:, free]).sum(axis=1).max() > HANGS)
    off = max_deviation(resample(curve[inner], 1.0), shown)
    return FreeCurve(places, closed, shown, off, pulls, len(kept) < len(curve))


def _distinct(cells: Floats) -> Floats:
    """Return rounded ``cells`` (k, 2) without those that repeat the one before."""
    cells = np.round(cells, DECIMALS)
    return cells[np.r_[True, (np.diff(cells, axis=0) != 0.0).any(axis=1)]]
