"""From a curve drawn on the skin to a free line, which keeps its course beside the control points (ours)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from core.control_mesh.embedding import Cell, embed, locate_on_grid
from core.control_mesh.fit import ControlMesh
from core.control_mesh.path_snapping import STEP, max_deviation
from core.control_mesh.skin_projection import SurfaceProjector, locate_on_mesh, points_on_skin
from core.document.line_notation import DECIMALS
from core.document.lines import BUST, LOWER
from core.errors import LineError
from core.geometry.mesh import Flags, Floats, Mesh, Points
from core.geometry.plane_sections import resample
from core.messages import Message

_STEPS = (6.0, 3.0, 1.5)
"""How far apart the vertices of a free line are [mm]: the first that keeps the curve."""

HANGS = 0.05
"""A vertex hangs on control points that can move if their weights are more than this together [1]."""

_FINE = 2.0  # a curve is assigned to regions in steps of this length [mm]
_TIE = 2.0  # a place is in both regions if it is as near to both meshes as this [mm]
_FAR = 15.0  # a curve that is so much nearer to the other mesh has come back to it [mm]
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


def parts_by_region(
    meshes: Mapping[str, ControlMesh], pieces: Sequence[Points], closed: bool = False
) -> dict[str, list[Points]]:
    """Return the part of a curve that is laid in each region, in ``pieces`` (k, 3) [mm] from bend to bend.

    A curve that could pull in both regions is cut where it leaves the control mesh of the bust; any other is
    all in the region where more of it can pull, or is. ``closed`` ones are not cut. Raises LineError for a
    curve that goes to and fro between regions.
    """
    if len(meshes) == 1:
        return dict.fromkeys(meshes, list(pieces))
    fine = [resample(piece, _FINE) if len(piece) > 1 else piece for piece in pieces]
    curve = np.concatenate(fine)
    off = {region: _distances(control.mesh, curve) for region, control in meshes.items()}
    nearer = off[BUST] - off[LOWER]
    owned = {BUST: nearer < _TIE, LOWER: nearer > -_TIE}
    pulling = {region: owned[region] & _movable(control, curve) for region, control in meshes.items()}
    if closed or not all(pulls.any() for pulls in pulling.values()):
        most = max(meshes, key=lambda region: (pulling[region].sum(), owned[region].sum()))
        return {most: list(pieces)}
    at, order = _best_cut(nearer)
    first, last = _cut(fine, at)
    return dict(zip(order, (first, last), strict=True))


def _best_cut(nearer: Floats) -> tuple[int, tuple[str, str]]:
    """Return where a curve is cut best between two regions, and the regions of both parts in order.

    ``nearer`` (k,) [mm] is how much nearer each of its points is to the mesh below than to that of the bust.
    Raises LineError if a part of it is far away on the wrong side.
    """
    before = np.concatenate([[0.0], np.cumsum(nearer)])
    at = {True: int(before.argmin()), False: int(before.argmax())}  # beginning on the bust, or below
    from_bust = (
        before[at[True]] - (before[-1] - before[at[True]])
        < (before[-1] - before[at[False]]) - (before[at[False]])
    )
    cut = at[bool(from_bust)]
    sign = 1.0 if from_bust else -1.0
    if max((sign * nearer[:cut]).max(initial=0.0), (-sign * nearer[cut:]).max(initial=0.0)) > _FAR:
        raise LineError(
            Message("The line crosses between bust and waist more than once."),
            Message("Draw a separate line for each part."),
        )
    return cut, (BUST, LOWER) if from_bust else (LOWER, BUST)


def _distances(mesh: Mesh, points: Points) -> Floats:
    """Return how far places, (k, 3) [mm], are from a mesh, (k,) [mm]."""
    return np.asarray(np.linalg.norm(SurfaceProjector(mesh).project(points) - points, axis=1))


def _movable(control: ControlMesh, points: Points) -> Flags:
    """Return which places of the skin, (k, 3) [mm], hang on free points of a control mesh, (k,)."""
    found = locate_on_mesh(control.mesh, control.grid, points)
    corners, weights = locate_on_grid(control.grid, found.cells)
    return np.asarray(found.inside & ((weights * ~control.fixed[corners]).sum(axis=1) > HANGS))


def _cut(pieces: Sequence[Points], at: int) -> tuple[list[Points], list[Points]]:
    """Return the pieces of a curve up to its point ``at``, counted through all pieces, and those from it."""
    first: list[Points] = []
    last: list[Points] = []
    for piece in pieces:
        if at >= len(piece):
            first.append(piece)
        elif at <= 0:
            last.append(piece)
        else:
            first.append(piece[: at + 1])
            last.append(piece[at:])
        at -= len(piece)
    return [each for each in first if len(each) > 1], [each for each in last if len(each) > 1]


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
